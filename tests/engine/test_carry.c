/// A few of many objects move, appear or disappear, and the results of the others are reused: each frame must equal a
/// fresh one bit for bit.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "engine/film/image.h"
#include "engine/render/reuse/between.h"
#include "tests/engine/cases/random.h"

enum { SHAPES = 24, MATERIALS = 5, LIGHTS = 3, WORLDS = 20, EDITS = 20 };

typedef struct world {
    glint_scene *scene;
    glint_camera *camera;
    glint_material *material[MATERIALS];
    glint_light *light[LIGHTS];
    int light_count;
    glint_shape *ground, *shape[SHAPES];
    bool in_scene[SHAPES];
    double home[SHAPES][3], at[SHAPES][3];
} world;

static void random_place(double out[3])
{
    out[0] = between(-9, 9);
    out[1] = between(-0.5, 4);
    out[2] = between(-9, 9);
}

static void place(world *w, int i, const double at[3])
{
    glint_shape_desc d = *glint_shape_get(w->shape[i]);
    d.struct_size = sizeof d;
    memcpy(w->at[i], at, sizeof w->at[i]);
    if (d.kind == GLINT_SHAPE_SPHERE)
        memcpy(d.center, at, sizeof d.center);
    else
        d.transform = glint_transform_translate(at);
    assert_int_equal(glint_shape_set(w->shape[i], &d, NULL), GLINT_OK);
}

static glint_shape *random_shape(world *w)
{
    static const glint_shape_kind kinds[] = { GLINT_SHAPE_SPHERE, GLINT_SHAPE_SPHERE,   GLINT_SHAPE_SPHERE,
                                              GLINT_SHAPE_BOX,    GLINT_SHAPE_CYLINDER, GLINT_SHAPE_MESH,
                                              GLINT_SHAPE_TORUS };
    const double size = between(0.1, 0.8);
    glint_shape *shape;
    const glint_shape_kind kind = kinds[below(7)];
    glint_shape_desc d = glint_shape_desc_default(kind);
    d.material = w->material[below(MATERIALS)];
    d.radius = size;
    d.top[1] = size;
    d.major = 0.8 * size;
    d.minor = 0.3 * size;
    for (int c = 0; c < 3; c++) {
        d.min[c] = -size;
        d.max[c] = between(0, size);
    }
    if (kind == GLINT_SHAPE_MESH) {
        static const double middle[3];
        glint_mesh_desc mesh = glint_mesh_desc_default();
        mesh.material = d.material;
        mesh.has_shading = true;
        mesh.shading = one_in(3) ? GLINT_SHADING_GOURAUD : one_in(2) ? GLINT_SHADING_PHONG : GLINT_SHADING_FACETED;
        assert_int_equal(glint_sphere_mesh_create(middle, size, 6, &mesh, &shape, NULL), GLINT_OK);
    } else {
        assert_int_equal(glint_shape_create(&d, &shape, NULL), GLINT_OK);
    }
    return shape;
}

static glint_light *random_light(void)
{
    static const glint_light_kind kinds[] = { GLINT_LIGHT_POINT, GLINT_LIGHT_POINT, GLINT_LIGHT_DIRECTIONAL,
                                              GLINT_LIGHT_SPOT,  GLINT_LIGHT_DISK,  GLINT_LIGHT_SPHERE };
    glint_light_desc d = glint_light_desc_default(kinds[below(6)]);
    for (int c = 0; c < 3; c++) {
        d.position[c] = c == 1 ? between(1, 12) : between(-10, 10);
        d.direction[c] = c == 1 ? -1 : between(-1, 1);
    }
    d.radius = between(0.1, 2);
    d.samples = 1 + below(6);
    d.shadows = !one_in(5);
    d.shadow = d.kind == GLINT_LIGHT_SPHERE && one_in(2) ? GLINT_SHADOW_CAPS : d.shadow;
    glint_light *light;
    assert_int_equal(glint_light_create(&d, &light, NULL), GLINT_OK);
    return light;
}

static void make_ground(world *w)
{
    glint_shape_desc d = glint_shape_desc_default(one_in(2) ? GLINT_SHAPE_PLANE : GLINT_SHAPE_SPHERE);
    d.material = w->material[0];
    d.normal[0] = d.normal[2] = d.center[0] = d.center[2] = d.point[0] = d.point[1] = d.point[2] = 0;
    d.normal[1] = 1;
    d.radius = 1000;
    d.center[1] = -1000;
    assert_int_equal(glint_shape_create(&d, &w->ground, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_shape(w->scene, w->ground, NULL), GLINT_OK);
}

static void make_world(world *w)
{
    memset(w, 0, sizeof *w);
    glint_camera_desc view = glint_camera_desc_default();
    view.eye[0] = between(-4, 4);
    view.eye[1] = between(0.5, 9);
    view.eye[2] = 16;
    if (one_in(4)) {
        view.projection = GLINT_PROJECTION_ORTHOGRAPHIC;
        view.height = between(4, 14);
    }
    if (one_in(3))
        view.aperture = between(0.05, 0.8);
    assert_int_equal(glint_camera_create(&view, &w->camera, NULL), GLINT_OK);
    assert_int_equal(glint_scene_create(&w->scene, NULL), GLINT_OK);
    glint_scene_desc s = *glint_scene_get(w->scene);
    s.struct_size = sizeof s;
    s.camera = w->camera;
    assert_int_equal(glint_scene_set(w->scene, &s, NULL), GLINT_OK);
    const bool glass = one_in(4);
    for (int i = 0; i < MATERIALS; i++) {
        glint_material_desc m = glint_material_desc_default();
        for (int c = 0; c < 3; c++) {
            m.diffuse[c] = between(0, 1);
            m.specular[c] = 0.4;
            m.mirror[c] = glass && i == 1 ? 0.5 : 0;
            m.transmission[c] = glass && i == 2 ? 0.7 : 0;
        }
        assert_int_equal(glint_material_create(&m, &w->material[i], NULL), GLINT_OK);
    }
    if (!one_in(5))
        make_ground(w);
    for (int i = 0; i < SHAPES; i++) {
        w->shape[i] = random_shape(w);
        random_place(w->home[i]);
        place(w, i, w->home[i]);
        w->in_scene[i] = true;
        assert_int_equal(glint_scene_add_shape(w->scene, w->shape[i], NULL), GLINT_OK);
    }
    w->light_count = 1 + (int)below(LIGHTS);
    for (int i = 0; i < w->light_count; i++) {
        w->light[i] = random_light();
        assert_int_equal(glint_scene_add_light(w->scene, w->light[i], NULL), GLINT_OK);
    }
}

static void free_world(world *w)
{
    for (int i = 0; i < SHAPES; i++)
        glint_shape_release(w->shape[i]);
    for (int i = 0; i < w->light_count; i++)
        glint_light_release(w->light[i]);
    for (int i = 0; i < MATERIALS; i++)
        glint_material_release(w->material[i]);
    glint_shape_release(w->ground);
    glint_camera_release(w->camera);
    glint_scene_release(w->scene);
}

static void move_one(world *w)
{
    const int i = (int)below(SHAPES);
    double to[3];
    random_place(to);
    for (int c = 0; c < 3 && !one_in(4); c++)
        to[c] = w->at[i][c] + between(-0.3, 0.3);
    if (one_in(4))
        memcpy(to, w->home[i], sizeof to);
    if (one_in(20))
        memcpy(to, w->at[below(SHAPES)], sizeof to); // turns it into another shape, or puts it on an identical one
    place(w, i, to);
}

/// Makes a random edit. Returns whether only positions of shapes changed.
static bool edit(world *w)
{
    const uint32_t kind = below(12);
    if (kind == 0) {
        const int i = one_in(2) ? SHAPES - 1 : (int)below(SHAPES);
        if (w->in_scene[i])
            glint_scene_remove_shape(w->scene, w->shape[i], NULL);
        else
            glint_scene_add_shape(w->scene, w->shape[i], NULL);
        w->in_scene[i] = !w->in_scene[i];
    } else if (kind == 1) {
        glint_light *light = w->light[below((uint32_t)w->light_count)];
        glint_light_desc d = *glint_light_get(light);
        d.struct_size = sizeof d;
        d.position[0] += between(-1, 1);
        assert_int_equal(glint_light_set(light, &d, NULL), GLINT_OK);
    } else if (kind == 2) {
        glint_material *material = w->material[below(MATERIALS)];
        glint_material_desc d = *glint_material_get(material);
        d.struct_size = sizeof d;
        d.shininess = between(1, 100);
        assert_int_equal(glint_material_set(material, &d, NULL), GLINT_OK);
    } else if (kind == 3) {
        glint_camera_desc d = *glint_camera_get(w->camera);
        d.struct_size = sizeof d;
        d.eye[0] += 0.1;
        assert_int_equal(glint_camera_set(w->camera, &d, NULL), GLINT_OK);
    }
    for (uint32_t moves = kind < 4 ? below(2) : 1 + below(3); moves > 0; moves--)
        move_one(w);
    return kind > 3;
}

static bool same_picture(const glint_image *a, const glint_image *b)
{
    const size_t pixels = (size_t)a->width * (size_t)a->height;
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++)
        for (int c = 0; c < 3; c++)
            if (a->plane[pass][c] && memcmp(a->plane[pass][c], b->plane[pass][c], pixels * sizeof(float)))
                return false;
    return memcmp(a->codes, b->codes, pixels * glint_image_pixel_bytes(a)) == 0;
}

static double share(const glint_frame_stats *stats, const char *stage)
{
    for (int i = 0; i < stats->stage_count; i++)
        if (strcmp(stats->stage_name[i], stage) == 0)
            return stats->stage_reused[i];
    return 0;
}

static void render_both(const world *w, const glint_render_desc *desc, glint_renderer *const renderers[2],
                        glint_frame_stats *stats)
{
    glint_plan *plan;
    glint_image *image[2];
    assert_int_equal(glint_plan_create(w->scene, desc, &plan, NULL), GLINT_OK);
    for (int i = 2; i-- > 0;)
        assert_int_equal(glint_render(renderers[i], plan, &image[i], stats, NULL), GLINT_OK);
    if (!same_picture(image[0], image[1]))
        fail_msg("the reused frame differs from the fresh one");
    for (int i = 0; i < 2; i++)
        glint_image_release(image[i]);
    glint_plan_destroy(plan);
}

static void some_things_move(void **unused)
{
    (void)unused;
    const char *other = getenv("GLINT_SEED"); // a seed, set by `make soak`
    const uint64_t first = other ? 1000 * strtoull(other, NULL, 10) : 0;
    double casts = 0, shadows = 0;
    int frames = 0;
    for (int seed = 0; seed < WORLDS; seed += (int)case_step()) {
        world w;
        glint_renderer *renderers[2];
        glint_renderer_desc desc = glint_renderer_desc_default();
        glint_render_desc render = glint_render_desc_default();
        random_state = first + (uint64_t)seed;
        make_world(&w);
        render.width = 224;
        render.height = 152;
        render.samples = one_in(3) ? 4 : 1;
        render.precision = one_in(8) ? GLINT_PRECISION_FLOAT : GLINT_PRECISION_DOUBLE;
        render.codes = true;
        render.passes = one_in(3) ? 1u << GLINT_PASS_BEAUTY | 1u << GLINT_PASS_DEPTH | 1u << GLINT_PASS_OBJECT_ID : 0;
        desc.threads = 2;
        for (int i = 0; i < 2; i++) {
            desc.no_reuse = i == 1;
            assert_int_equal(glint_renderer_create(&desc, &renderers[i], NULL), GLINT_OK);
        }
        for (int i = 0; i < EDITS; i++) {
            glint_frame_stats stats;
            const bool counts = i > 0 && edit(&w) && render.precision == GLINT_PRECISION_DOUBLE;
            render_both(&w, &render, renderers, &stats);
            frames += counts;
            casts += counts ? share(&stats, "cast") : 0;
            shadows += counts ? share(&stats, "occlude") : 0;
        }
        for (int i = 0; i < 2; i++)
            glint_renderer_destroy(renderers[i]);
        free_world(&w);
    }
    print_message("%d frames, %.2f of their hits and %.2f of their shadows reused\n", frames, casts / frames,
                  shadows / frames);
    if (case_step() == 1) // the shares of a few worlds may be far from the average
        assert_true(casts > 0.5 * frames && shadows > (first ? 0.4 : 0.65) * frames);
}

// ---- Between a light and the points of a tile ----

/// Chooses a random point that the tile shows. Returns whether the point is inside the box.
static bool random_seen(const glint_plan *plan, uint32_t column, uint32_t row, const glint_point_box *box, double out[3])
{
    const glint_plan_camera *camera = &plan->camera;
    const double x = (column + between(0, 1)) * GLINT_TILE_WIDTH, y = (row + between(0, 1)) * GLINT_TILE_HEIGHT;
    const double across = 2 * x - (double)plan->desc.width, up = (double)plan->desc.height - 2 * y, far = between(0, 30);
    bool inside = true;
    for (int c = 0; c < 3; c++) {
        const double aside = across * camera->right[c] + up * camera->up[c];
        out[c] = camera->eye[c] + far * camera->forward[c] + (camera->orthographic ? 1 : far) * aside;
        inside = inside && out[c] >= box->lower[c] && out[c] <= box->upper[c];
    }
    return inside;
}

/// Returns the squared distance from the ball's centre to the segment between the point
/// and the light, in squared radii.
static double way_past(const glint_ball *ball, const double from[3], const glint_plan_light *light)
{
    double way[3], line[3], along = 0, length2 = 0, across2 = 0;
    for (int c = 0; c < 3; c++) {
        way[c] = ball->center[c] - from[c];
        line[c] = light->directional ? light->position[c] : light->position[c] - from[c];
        along += way[c] * line[c];
        length2 += line[c] * line[c];
    }
    along = along < 0 ? 0 : !light->directional && along > length2 ? 1 : along / length2;
    for (int c = 0; c < 3; c++)
        across2 += (way[c] - along * line[c]) * (way[c] - along * line[c]);
    return across2 / (ball->radius * ball->radius);
}

/// When glint_may_shade rules out a ball, the ball shadows no visible point. glint_may_shade rules out nearly all
/// balls that shadow no point.
static void balls_between(void **unused)
{
    (void)unused;
    glint_render_desc desc = glint_render_desc_default();
    uint32_t clear = 0, said = 0;
    desc.width = 224;
    desc.height = 152;
    random_state = 5;
    for (int seed = 0; seed < 60; seed += (int)case_step()) {
        world w;
        glint_plan *plan;
        make_world(&w);
        assert_int_equal(glint_plan_create(w.scene, &desc, &plan, NULL), GLINT_OK);
        for (int i = 0; i < 200; i++) {
            const uint32_t column = below(7), row = below(6);
            const glint_plan_light *light = &plan->lights[below((uint32_t)plan->light_count)];
            glint_ball ball = { .radius = between(0.1, 1) };
            glint_point_box box = { .only = GLINT_MISS };
            for (int c = 0; c < 3; c++) {
                ball.center[c] = between(-9, 9);
                box.lower[c] = between(-9, 0);
                box.upper[c] = between(0, 9);
            }
            const bool may = glint_may_shade(plan, light, &box, &ball, 1, column, row);
            bool any = false, is = false;
            for (int k = 0; k < 200 && !light->light_samples && !light->cap && !plan->lens; k++) {
                double from[3];
                if (!random_seen(plan, column, row, &box, from))
                    continue;
                any = true;
                is = is || way_past(&ball, from, light) < 1;
            }
            assert_true(may || !is);
            clear += any && !is;
            said += any && !is && !may;
        }
        glint_plan_destroy(plan);
        free_world(&w);
    }
    print_message("%u of %u balls that are not between are known not to be\n", said, clear);
    assert_true(clear * case_step() > 500 && said > 0.95 * clear);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(some_things_move), cmocka_unit_test(balls_between) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
