/// make bench: how long the workshop frame takes, by the C API. All variants are measured in turn, in an order shuffled
/// anew for every round; the first round is dropped; printed are the median and the quartiles of the others.
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include "engine/glint.h"

#define ROUNDS 15
#define WIDTH 1920
#define HEIGHT 1080
#define JOB_FRAMES 60
#define VARIANT_MAX 24

static void must(glint_status status, const glint_error *error)
{
    if (status == GLINT_OK)
        return;
    fprintf(stderr, "bench: %s\n", error->message);
    exit(1);
}

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

// ---- The scene: that of scripts/workshop.lua ----

typedef struct workshop {
    glint_scene *scene;
    glint_light *lamp;
} workshop;

static double shininess = 128; ///< of the balls that add_ball makes

static void add_ball(glint_scene *scene, const double center[3], double radius, const double color[3], double gloss)
{
    glint_error error;
    glint_material_desc m = glint_material_desc_default();
    glint_shape_desc s = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    for (int c = 0; c < 3; c++) {
        m.diffuse[c] = color[c];
        m.specular[c] = gloss;
        s.center[c] = center[c];
    }
    m.shininess = shininess;
    s.radius = radius;
    glint_material *material;
    glint_shape *shape;
    must(glint_material_create(&m, &material, &error), &error);
    s.material = material;
    must(glint_shape_create(&s, &shape, &error), &error);
    must(glint_scene_add_shape(scene, shape, &error), &error);
    glint_shape_release(shape);
    glint_material_release(material);
}

typedef struct setting {
    const char *isa;
    int threads;
    glint_precision precision;
    bool no_shadows;
    double samples;
    enum { FRESH, MOVED_LIGHT, CHANGED_SHININESS } reuse; ///< what changes from round to round; FRESH: no reuse
} setting;

/// `step` 0 or 1 is the scene before and after the change that the setting's `reuse` names.
static workshop make_workshop(const setting *set, int step)
{
    glint_error error;
    workshop w;
    shininess = set->reuse == CHANGED_SHININESS && step ? 64 : 128;
    must(glint_scene_create(&w.scene, &error), &error);
    add_ball(w.scene, (double[3]){0, -10000, 0}, 10000, (double[3]){0.42, 0.40, 0.37}, 0);
    add_ball(w.scene, (double[3]){-1.0, 4.0, -4.5}, 4.0, (double[3]){0.70, 0.10, 0.08}, 0.7);
    add_ball(w.scene, (double[3]){5.8, 3.0, -1.0}, 3.0, (double[3]){0.85, 0.55, 0.10}, 0.7);
    add_ball(w.scene, (double[3]){-6.6, 2.5, 0.5}, 2.5, (double[3]){0.10, 0.35, 0.62}, 0.7);
    add_ball(w.scene, (double[3]){0.6, 2.0, 4.2}, 2.0, (double[3]){0.16, 0.48, 0.20}, 0.7);

    glint_light_desc l = glint_light_desc_default(GLINT_LIGHT_POINT);
    l.position[0] = set->reuse == MOVED_LIGHT && step ? 1 : 0;
    l.position[1] = 20;
    l.shadows = !set->no_shadows;
    must(glint_light_create(&l, &w.lamp, &error), &error);
    must(glint_scene_add_light(w.scene, w.lamp, &error), &error);

    glint_camera_desc c = glint_camera_desc_default();
    memcpy(c.eye, (double[3]){0, 6.2, 20.5}, sizeof c.eye);
    memcpy(c.at, (double[3]){0, 3.8, 0}, sizeof c.at);
    c.fov_y_rad = 42 * acos(-1) / 180;
    glint_camera *camera;
    must(glint_camera_create(&c, &camera, &error), &error);
    glint_scene_desc s = *glint_scene_get(w.scene);
    s.camera = camera;
    memcpy(s.ambient, (double[3]){0.16, 0.17, 0.20}, sizeof s.ambient);
    memcpy(s.background, (double[3]){0.28, 0.45, 0.69}, sizeof s.background);
    must(glint_scene_set(w.scene, &s, &error), &error);
    glint_camera_release(camera);
    return w;
}

static void free_workshop(workshop *w)
{
    glint_light_release(w->lamp);
    glint_scene_release(w->scene);
}

static glint_plan *make_plan(const glint_scene *scene, glint_precision precision, double samples)
{
    glint_error error;
    glint_render_desc d = glint_render_desc_default();
    d.width = WIDTH;
    d.height = HEIGHT;
    d.samples = samples;
    d.precision = precision;
    d.passes = 0;
    d.codes = true;
    glint_plan *plan;
    must(glint_plan_create(scene, &d, &plan, &error), &error);
    return plan;
}

// ---- Variants of one frame ----

typedef struct variant {
    char name[64];
    glint_renderer *renderer;
    glint_plan *plans[2]; ///< rendered by turns; the same picture unless something is reused
    double render_ms[ROUNDS], tone_ms[ROUNDS];
} variant;

static variant variants[VARIANT_MAX];
static int variant_count;

/// Adds a variant; leaves it out when this machine lacks the instruction set.
static void add_variant(const char *name, setting set)
{
    glint_error error;
    glint_renderer_desc r = glint_renderer_desc_default();
    r.isa = set.isa;
    r.threads = set.threads;
    r.no_reuse = set.reuse == FRESH;
    variant *v = &variants[variant_count];
    glint_status status = glint_renderer_create(&r, &v->renderer, &error);
    if (status == GLINT_ERR_UNSUPPORTED)
        return;
    must(status, &error);
    for (int step = 0; step < 2; step++) {
        workshop w = make_workshop(&set, step);
        v->plans[step] = make_plan(w.scene, set.precision, set.samples ? set.samples : 1);
        free_workshop(&w);
    }
    snprintf(v->name, sizeof v->name, "%s", name);
    variant_count++;
}

static void measure(variant *v, int round)
{
    glint_error error;
    glint_image *image;
    glint_frame_stats stats;
    must(glint_render(v->renderer, v->plans[round & 1], &image, &stats, &error), &error);
    glint_image_release(image);
    if (round < 0) // the first one warms up
        return;
    v->render_ms[round] = stats.render_ms;
    v->tone_ms[round] = stats.tone_ms;
}

static void shuffle(int *order, int count)
{
    static uint64_t state = 0x9e3779b97f4a7c15u;
    for (int i = count - 1; i > 0; i--) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        int j = (int)((state >> 33) % (uint64_t)(i + 1));
        int kept = order[i];
        order[i] = order[j];
        order[j] = kept;
    }
}

static void measure_all(void)
{
    int order[VARIANT_MAX];
    for (int i = 0; i < variant_count; i++)
        order[i] = i;
    for (int round = -1; round < ROUNDS; round++) {
        shuffle(order, variant_count);
        for (int i = 0; i < variant_count; i++)
            measure(&variants[order[i]], round);
    }
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

typedef struct quartiles {
    double least, low, median, high;
} quartiles;

static quartiles quartiles_of(const double *values, int count)
{
    double sorted[ROUNDS];
    memcpy(sorted, values, (size_t)count * sizeof *values);
    qsort(sorted, (size_t)count, sizeof *sorted, by_value);
    return (quartiles){sorted[0], sorted[count / 4], sorted[count / 2], sorted[count - 1 - count / 4]};
}

static void print_variants(void)
{
    printf("\n%-44s %8s %8s   %-17s %8s %8s\n", "frame 1920x1080, 8-bit codes, no file", "render", "least",
           "quartiles", "tone", "ns/pixel");
    for (int i = 0; i < variant_count; i++) {
        quartiles r = quartiles_of(variants[i].render_ms, ROUNDS), t = quartiles_of(variants[i].tone_ms, ROUNDS);
        printf("%-44s %8.2f %8.2f   %7.2f .. %6.2f %8.2f %8.2f\n", variants[i].name, r.median, r.least, r.low, r.high,
               t.median, r.median * 1e6 / (WIDTH * HEIGHT));
    }
}

/// 0 when there is no such variant here.
static double least_of(const char *name)
{
    for (int i = 0; i < variant_count; i++)
        if (strcmp(variants[i].name, name) == 0)
            return quartiles_of(variants[i].render_ms, ROUNDS).least;
    return 0;
}

/// Of the least times: what else the machine does can only add.
static void print_ratio(const char *what, const char *a, const char *b, double bar)
{
    double above = least_of(a), below = least_of(b);
    if (above > 0 && below > 0)
        printf("%-44s %8.2f   (to reach: %.2f)\n", what, above / below, bar);
}

static void bench_frames(void)
{
    add_variant("1 thread", (setting){.threads = 1});
    add_variant("2 threads", (setting){.threads = 2});
    add_variant("1 thread, --precision float", (setting){.threads = 1, .precision = GLINT_FLOAT});
    add_variant("2 threads, --precision float", (setting){.threads = 2, .precision = GLINT_FLOAT});
    add_variant("1 thread, no shadow", (setting){.threads = 1, .no_shadows = true});
    add_variant("1 thread, 4 samples", (setting){.threads = 1, .samples = 4});
    add_variant("1 thread, only the light moved", (setting){.threads = 1, .reuse = MOVED_LIGHT});
    add_variant("1 thread, only the shininess changed", (setting){.threads = 1, .reuse = CHANGED_SHININESS});
    add_variant("1 thread, avx512", (setting){.threads = 1, .isa = "avx512"});
    add_variant("1 thread, avx2", (setting){.threads = 1, .isa = "avx2"});
    add_variant("1 thread, sse2", (setting){.threads = 1, .isa = "sse2"});
    add_variant("1 thread, ref", (setting){.threads = 1, .isa = "ref"});
    measure_all();
    print_variants();
    puts("");
    print_ratio("two threads / one", "2 threads", "1 thread", 0.55);
    print_ratio("default precision / float", "1 thread", "1 thread, --precision float", 1.30);
    print_ratio("moved light / fresh frame", "1 thread, only the light moved", "1 thread", 0.65);
    print_ratio("changed shininess / fresh frame", "1 thread, only the shininess changed", "1 thread", 0.15);
    for (int i = 0; i < variant_count; i++) {
        glint_plan_destroy(variants[i].plans[0]);
        glint_plan_destroy(variants[i].plans[1]);
        glint_renderer_destroy(variants[i].renderer);
    }
}

// ---- Files ----

static char folder[] = "/tmp/glint-bench-XXXXXX";

static glint_write_desc write_desc(const char *path, glint_encode encode)
{
    return (glint_write_desc){
        .path = path, .pass = GLINT_PASS_BEAUTY, .tone = glint_tone_desc_default(), .encode = encode};
}

/// One frame to a file, by the writer, so that encoding and writing are told apart.
static void bench_encode(glint_encode encode, const char *name)
{
    glint_error error;
    glint_renderer_desc r = glint_renderer_desc_default();
    glint_renderer *renderer;
    glint_writer *writer;
    glint_image *image;
    workshop w = make_workshop(&(setting){0}, 0);
    glint_plan *plan = make_plan(w.scene, GLINT_DOUBLE, 1);
    must(glint_renderer_create(&r, &renderer, &error), &error);
    must(glint_writer_create(1, 1, &writer, &error), &error);
    must(glint_render(renderer, plan, &image, NULL, &error), &error);

    char path[sizeof folder + 16];
    snprintf(path, sizeof path, "%s/frame.png", folder);
    glint_write_desc d = write_desc(path, encode);
    double encode_ms[ROUNDS], write_ms[ROUNDS];
    for (int round = -1; round < ROUNDS; round++) {
        glint_write_result result;
        must(glint_writer_submit(writer, image, &d, NULL, &error), &error);
        glint_writer_collect(writer, true, &result);
        encode_ms[round < 0 ? 0 : round] = result.encode_ms;
        write_ms[round < 0 ? 0 : round] = result.write_ms;
    }
    FILE *file = fopen(path, "rb");
    long size = file && fseek(file, 0, SEEK_END) == 0 ? ftell(file) : 0;
    if (file)
        fclose(file);
    remove(path);
    quartiles e = quartiles_of(encode_ms, ROUNDS), s = quartiles_of(write_ms, ROUNDS);
    printf("--encode %-6s %-28s %8.2f   %7.2f .. %6.2f %8.2f %8ld\n", name, glint_encoder_name(encode), e.median, e.low,
           e.high, s.median, size / 1000);
    glint_image_release(image);
    glint_writer_destroy(writer);
    glint_renderer_destroy(renderer);
    glint_plan_destroy(plan);
    free_workshop(&w);
}

/// The whole job: a lamp goes round, every frame becomes a PNG. Returns its seconds.
static double run_job(int threads, glint_encode encode, bool no_reuse)
{
    glint_error error;
    glint_renderer_desc r = glint_renderer_desc_default();
    r.threads = threads;
    r.no_reuse = no_reuse;
    glint_renderer *renderer;
    glint_writer *writer;
    workshop w = make_workshop(&(setting){0}, 0);
    double start = now_ms();
    must(glint_renderer_create(&r, &renderer, &error), &error);
    must(glint_writer_create(2, threads, &writer, &error), &error);
    for (int i = 0; i < JOB_FRAMES; i++) {
        glint_light_desc l = *glint_light_get(w.lamp);
        double angle = 2 * acos(-1) * i / JOB_FRAMES;
        l.position[0] = 13 * glint_cos(angle);
        l.position[2] = 13 * glint_sin(angle);
        must(glint_light_set(w.lamp, &l, &error), &error);
        glint_plan *plan = make_plan(w.scene, GLINT_DOUBLE, 1);
        glint_image *image;
        must(glint_render(renderer, plan, &image, NULL, &error), &error);
        char path[sizeof folder + 16];
        snprintf(path, sizeof path, "%s/%04d.png", folder, i + 1);
        glint_write_desc d = write_desc(path, encode);
        must(glint_writer_submit(writer, image, &d, NULL, &error), &error);
        glint_image_release(image);
        glint_plan_destroy(plan);
    }
    for (glint_write_result result; glint_writer_collect(writer, true, &result);)
        if (result.status != GLINT_OK)
            fprintf(stderr, "bench: %s\n", result.message), exit(1);
    double seconds = (now_ms() - start) / 1e3;
    glint_writer_destroy(writer);
    glint_renderer_destroy(renderer);
    free_workshop(&w);
    for (int i = 0; i < JOB_FRAMES; i++) {
        char path[sizeof folder + 16];
        snprintf(path, sizeof path, "%s/%04d.png", folder, i + 1);
        remove(path);
    }
    return seconds;
}

static void bench_jobs(void)
{
    static const struct {
        const char *name;
        int threads;
        glint_encode encode;
        bool no_reuse;
    } jobs[] = {{"1 thread, fast", 1, GLINT_ENCODE_FAST, false},
                {"2 threads, fast", 2, GLINT_ENCODE_FAST, false},
                {"2 threads, fast, --no-reuse", 2, GLINT_ENCODE_FAST, true},
                {"2 threads, small", 2, GLINT_ENCODE_SMALL, false}};
    enum { COUNT = sizeof jobs / sizeof *jobs, TIMES = 5 };
    double seconds[COUNT][TIMES];
    for (int round = 0; round < TIMES; round++)
        for (int j = 0; j < COUNT; j++)
            seconds[j][round] = run_job(jobs[j].threads, jobs[j].encode, jobs[j].no_reuse);
    printf("\n%-44s %8s   %s\n", "job: 60 PNGs of a moving light, 1920x1080", "seconds", "quartiles");
    for (int j = 0; j < COUNT; j++) {
        quartiles q = quartiles_of(seconds[j], TIMES);
        printf("%-44s %8.2f   %7.2f .. %6.2f\n", jobs[j].name, q.median, q.low, q.high);
    }
}

// ---- Machine ----

static void print_machine(const char *flags)
{
    struct utsname u;
    char line[256], model[200] = "unknown processor";
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "model name : %199[^\n]", model) == 1)
            break;
    if (file)
        fclose(file);
    uname(&u);
    printf("glint %s on %s, %ld processors, %s %s\n%s\n", GLINT_VERSION, model, sysconf(_SC_NPROCESSORS_ONLN), u.sysname,
           u.machine, flags);
    printf("%d rounds, all variants in each, in random order; medians, in milliseconds\n", ROUNDS);
}

int main(int argc, char **argv)
{
    print_machine(argc > 1 ? argv[1] : "");
    if (!mkdtemp(folder)) {
        perror("bench: /tmp");
        return 1;
    }
    bench_frames();
    printf("\n%-44s %8s   %-17s %8s %8s\n", "one frame as PNG", "encode", "quartiles", "write", "kB");
    bench_encode(GLINT_ENCODE_FAST, "fast");
    bench_encode(GLINT_ENCODE_SMALL, "small");
    bench_jobs();
    rmdir(folder);
    return 0;
}
