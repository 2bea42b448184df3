#include "tests/hard/oracle/drive.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool hard_table;
static bool listing; ///< whether each test prints a line of the table
uint64_t hard_rays = 1000000;

static struct {
    const char *id;
    char what[96];
    uint64_t checks, failures;
} test;

static int passed, failed, waiting, complaints;
static uint64_t state = 1;

void hard_begin(int argc, char **argv)
{
    const char *rays = getenv("HARD_RAYS");
    if (rays && atof(rays) > 0)
        hard_rays = (uint64_t)atof(rays);
    for (int i = 1; i < argc; i++) {
        char *end = "";
        if (!strcmp(argv[i], "--table")) {
            hard_table = true;
        } else if (!strcmp(argv[i], "--rays") && i + 1 < argc) {
            hard_rays = (uint64_t)strtod(argv[++i], &end);
        } else if (!strcmp(argv[i], "--seed") && i + 1 < argc) {
            state = strtoull(argv[++i], &end, 10);
        } else {
            end = argv[i];
        }
        if (*end) {
            fprintf(stderr, "usage: %s [--table] [--rays N] [--seed N]\n", argv[0]);
            exit(2);
        }
    }
}

static void end_test(void)
{
    if (!test.id)
        return;
    passed += test.failures == 0;
    failed += test.failures > 0;
    if (!hard_table)
        printf("%s %s: %s, %llu checks\n", test.failures ? "failed" : "passed", test.id, test.what,
               (unsigned long long)test.checks);
    else if (listing)
        printf("| %s | %s | %llu | %s |\n", test.id, test.what, (unsigned long long)test.checks,
               test.failures ? "**wrong**" : "right");
}

void hard_test(const char *id, const char *what)
{
    end_test();
    test.id = id;
    snprintf(test.what, sizeof test.what, "%s", what);
    test.checks = test.failures = 0;
}

int hard_check(bool ok, const char *format, ...)
{
    test.checks++;
    test.failures += !ok;
    if (!ok && complaints++ < 10) {
        va_list args;
        va_start(args, format);
        printf("not as expected: %s: ", test.id);
        vprintf(format, args);
        printf("\n");
        va_end(args);
    }
    return ok;
}

void hard_right(uint64_t checks) { test.checks += checks; }

void hard_absent(const char *id, const char *what)
{
    waiting++;
    if (hard_table)
        printf("| %s | %s | | |\n", id, what);
    else
        printf("skip: %s: %s\n", id, what);
}

void hard_list_tests(const char *title)
{
    listing = true;
    if (hard_table)
        printf("%s\n\n| case | what | checks | verdict |\n| --- | --- | --- | --- |\n", title);
}

void hard_columns(const char *title)
{
    if (hard_table)
        printf("%s\n\n| case | what | truth | double | float | textbook double | textbook float | verdict |\n"
               "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
               title);
}

void hard_row(const char *id, const char *what, const hard_values *values, bool right)
{
    if (!hard_table)
        return;
    const double list[] = { values->truth, values->in_double, values->in_float, values->naive_double,
                            values->naive_float };
    printf("| %s | %s |", id, what);
    for (int i = 0; i < 5; i++)
        if (list[i] == HARD_BLANK)
            printf(" |");
        else
            printf(isnan(list[i]) ? " **nan** |" : " %.10g |", list[i]);
    printf(" %s |\n", right ? "right" : "**wrong**");
}

int hard_end(void)
{
    end_test();
    printf("%s%d passed, %d failed, %d skipped\n", hard_table ? "\n" : "", passed, failed, waiting);
    return failed > 0;
}

void random_seed(uint64_t seed) { state = seed; }

uint64_t random_bits(void) // splitmix64
{
    uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

double uniform(double low, double high) { return low + (high - low) * ((double)(random_bits() >> 11) * 0x1p-53); }

double log_uniform(double low, double high) { return exp(uniform(log(low), log(high))); }

bool chance(double share) { return uniform(0, 1) < share; }

void random_direction(double v[3])
{
    double length2;
    do {
        for (int c = 0; c < 3; c++)
            v[c] = uniform(-1, 1);
        length2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    } while (length2 > 1 || length2 < 0.01);
    for (int c = 0; c < 3; c++)
        v[c] /= sqrt(length2);
}

void must(glint_status status, const glint_error *error)
{
    if (status == GLINT_OK)
        return;
    printf("not as expected: the engine refuses: %s\n", error->message);
    exit(1);
}

glint_scene *scene_new(void)
{
    glint_scene *scene;
    glint_error error;
    must(glint_scene_create(&scene, &error), &error);
    return scene;
}

void scene_light_up(glint_scene *scene, double ambient, const double background[3])
{
    glint_error error;
    glint_scene_desc desc = *glint_scene_get(scene);
    desc.struct_size = sizeof desc;
    for (int c = 0; c < 3; c++) {
        desc.ambient[c] = ambient;
        desc.background[c] = background[c];
    }
    must(glint_scene_set(scene, &desc, &error), &error);
}

void scene_camera(glint_scene *scene, const glint_camera_desc *desc)
{
    glint_error error;
    glint_scene_desc with = *glint_scene_get(scene);
    with.struct_size = sizeof with;
    must(glint_camera_create(desc, &with.camera, &error), &error);
    must(glint_scene_set(scene, &with, &error), &error);
    glint_camera_release(with.camera);
}

static glint_shape *add_shape(glint_scene *scene, const glint_shape_desc *desc)
{
    glint_shape *shape;
    glint_error error;
    must(glint_shape_create(desc, &shape, &error), &error);
    must(glint_scene_add_shape(scene, shape, &error), &error);
    glint_shape_release(shape);
    return shape;
}

glint_shape *scene_sphere(glint_scene *scene, const hard_sphere *sphere, glint_material *material)
{
    glint_shape_desc desc = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    memcpy(desc.center, sphere->c, sizeof desc.center);
    desc.radius = sphere->r;
    desc.material = material;
    return add_shape(scene, &desc);
}

glint_shape *scene_plane(glint_scene *scene, const hard_plane *plane, glint_material *material)
{
    glint_shape_desc desc = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    memcpy(desc.point, plane->p, sizeof desc.point);
    memcpy(desc.normal, plane->n, sizeof desc.normal);
    desc.material = material;
    return add_shape(scene, &desc);
}

void scene_light(glint_scene *scene, const glint_light_desc *desc)
{
    glint_light *light;
    glint_error error;
    must(glint_light_create(desc, &light, &error), &error);
    must(glint_scene_add_light(scene, light, &error), &error);
    glint_light_release(light);
}

glint_material *material_new(glint_model model, const double diffuse[3], double specular, double shininess)
{
    glint_material *material;
    glint_error error;
    glint_material_desc desc = glint_material_desc_default();
    desc.model = model;
    memcpy(desc.diffuse, diffuse, sizeof desc.diffuse);
    for (int c = 0; c < 3; c++)
        desc.specular[c] = specular;
    desc.shininess = shininess;
    must(glint_material_create(&desc, &material, &error), &error);
    return material;
}

void temporary_file(char path[64], const char *ending)
{
    snprintf(path, 64, "/tmp/glint-hard-XXXXXX%s", ending);
    const int file = mkstemps(path, (int)strlen(ending));
    if (file < 0) {
        perror(path);
        exit(1);
    }
    close(file);
}

bool cast(const glint_scene *scene, const hard_ray *ray, glint_hit *hit)
{
    bool found;
    glint_error error;
    must(glint_scene_cast(scene, ray->o, ray->d, &found, hit, &error), &error);
    return found;
}

bool isa_usable(const char *isa)
{
    glint_renderer_desc desc = glint_renderer_desc_default();
    glint_renderer *renderer;
    desc.isa = isa;
    desc.threads = 1;
    const bool usable = glint_renderer_create(&desc, &renderer, NULL) == GLINT_OK;
    if (usable)
        glint_renderer_destroy(renderer);
    return usable;
}

glint_image *frame_to_depth(const glint_scene *scene, const frame_desc *desc, double max_depth,
                            glint_frame_stats *stats)
{
    glint_error error;
    glint_render_desc render = glint_render_desc_default();
    render.width = desc->width;
    render.height = desc->height;
    render.precision = desc->precision;
    render.passes = desc->passes;
    render.codes = stats != NULL;
    render.max_depth = max_depth;
    glint_renderer_desc workers = glint_renderer_desc_default();
    workers.threads = desc->threads ? desc->threads : 1;
    workers.isa = desc->isa;
    workers.no_reuse = true;
    glint_plan *plan;
    glint_renderer *renderer;
    glint_image *image;
    must(glint_plan_create(scene, &render, &plan, &error), &error);
    must(glint_renderer_create(&workers, &renderer, &error), &error);
    must(glint_render(renderer, plan, &image, stats, &error), &error);
    glint_renderer_destroy(renderer);
    glint_plan_destroy(plan);
    return image;
}

glint_image *frame(const glint_scene *scene, const frame_desc *desc, glint_frame_stats *stats)
{
    return frame_to_depth(scene, desc, glint_render_desc_default().max_depth, stats);
}

glint_image *frame_of_ray(glint_scene *scene, const hard_ray *ray, glint_precision precision, uint32_t passes)
{
    glint_camera_desc camera = glint_camera_desc_default();
    camera.has_direction = true;
    memcpy(camera.eye, ray->o, sizeof camera.eye);
    memcpy(camera.direction, ray->d, sizeof camera.direction);
    scene_camera(scene, &camera);
    const frame_desc desc = { .width = 1, .height = 1, .precision = precision, .passes = passes };
    return frame(scene, &desc, NULL);
}

void pixel(const glint_image *image, glint_pass pass, int x, int y, float out[3])
{
    glint_error error;
    must(glint_image_pixel(image, pass, x, y, out, &error), &error);
}

long pixels_that_differ(const glint_image *a, const glint_image *b, glint_pass pass)
{
    long differ = 0;
    for (int y = 0; y < glint_image_height(a); y++)
        for (int x = 0; x < glint_image_width(a); x++) {
            float p[3], q[3];
            pixel(a, pass, x, y, p);
            pixel(b, pass, x, y, q);
            differ += !(p[0] == q[0] && p[1] == q[1] && p[2] == q[2]);
        }
    return differ;
}
