/// Frames whose materials have programs, against the same functions in plain C at the points that the contracts define.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/base/vec.h"
#include "engine/film/image.h"
#include "engine/render/plan/plan.h"
#include "engine/render/stages/stages.h"
#include "tests/engine/cases/builder_case.h"
#include "tests/engine/cases/random.h"

// ---- Programs ------------------------------------------------------------------------------------------------------

static glint_value mul(glint_value a, glint_value b) { return op(GLINT_OP_MUL, a, b, 0); }

/// Makes the program parity(scale p) ? a : b, where a and b are colours.
static glint_program *checker(double scale, const double a[3], const double b[3])
{
    glint_value out[3];
    begin_program(GLINT_PROGRAM_PATTERN);
    const glint_value k = num(scale);
    const glint_value odd =
        op(GLINT_OP_PARITY, mul(in(GLINT_INPUT_P_X), k), mul(in(GLINT_INPUT_P_Y), k), mul(in(GLINT_INPUT_P_Z), k));
    for (int c = 0; c < 3; c++)
        out[c] = op(GLINT_OP_SELECT, odd, num(a[c]), num(b[c]));
    return end_program(out, 3);
}

static bool is_odd(const double p[3], double scale)
{
    return fmod((floor(p[0] * scale) + floor(p[1] * scale)) + floor(p[2] * scale), 2) != 0;
}

// ---- Scenes --------------------------------------------------------------------------------------------------------

typedef struct world {
    glint_scene *scene;
    glint_render_desc render;
} world;

static world new_world(const double eye[3], const double at[3], int width, int height)
{
    world w = { .render = glint_render_desc_default() };
    glint_camera_desc camera = glint_camera_desc_default();
    glint_camera *made;
    memcpy(camera.eye, eye, sizeof camera.eye);
    memcpy(camera.at, at, sizeof camera.at);
    OK(glint_camera_create(&camera, &made, &error));
    OK(glint_scene_create(&w.scene, &error));
    glint_scene_desc desc = *glint_scene_get(w.scene);
    desc.struct_size = sizeof desc;
    desc.camera = made;
    desc.reflection_samples = 2;
    OK(glint_scene_set(w.scene, &desc, &error));
    glint_camera_release(made);
    w.render.width = width;
    w.render.height = height;
    w.render.passes = 1u << GLINT_PASS_BEAUTY | 1u << GLINT_PASS_ALBEDO;
    return w;
}

static glint_material *new_material(const glint_material_desc *desc)
{
    glint_material *material;
    OK(glint_material_create(desc, &material, &error));
    return material;
}

static void add_shape(world *w, glint_shape_desc *desc, glint_material *material)
{
    glint_shape *shape;
    desc->material = material;
    OK(glint_shape_create(desc, &shape, &error));
    OK(glint_scene_add_shape(w->scene, shape, &error));
    glint_shape_release(shape);
}

static glint_image *render(const world *w, const char *isa, int threads)
{
    glint_renderer_desc desc = { .struct_size = sizeof(glint_renderer_desc), .isa = isa, .threads = threads, .no_reuse = true };
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
    OK(glint_renderer_create(&desc, &renderer, &error));
    OK(glint_plan_create(w->scene, &w->render, &plan, &error));
    OK(glint_render(renderer, plan, &image, NULL, &error));
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    return image;
}

static void release_world(world *w) { glint_scene_release(w->scene); }

static const double white[3] = { 0.9, 0.9, 0.9 }, blue[3] = { 0.1, 0.1, 0.2 };

/// Compares a million pixels of a checkered floor at y = 0 with the colours computed here.
static void test_floor(void **state)
{
    (void)state;
    const double eye[3] = { 1.3, 3.7, 9.1 }, at[3] = { 0.2, 0, 0.1 };
    world w = new_world(eye, at, 1000, 1000);
    glint_material_desc desc = glint_material_desc_default();
    desc.program.diffuse = checker(1, white, blue);
    glint_material *material = new_material(&desc);
    glint_program_release(desc.program.diffuse);
    glint_shape_desc floor = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    add_shape(&w, &floor, material);
    glint_material_release(material);
    glint_image *image = render(&w, NULL, 0);
    glint_plan *plan;
    OK(glint_plan_create(w.scene, &w.render, &plan, &error));
    const glint_plan_camera *c = &plan->camera;
    long wrong = 0, hits = 0, odd = 0;
    for (int y = 0; y < 1000; y++)
        for (int x = 0; x < 1000; x++) {
            const double sx = 2 * (x + 0.5) - 1000, sy = 1000 - 2 * (y + 0.5);
            double d[3], p[3];
            float albedo[3];
            for (int k = 0; k < 3; k++)
                d[k] = (c->forward[k] + sx * c->right[k]) + sy * c->up[k];
            const double t = -c->eye[1] / d[1];
            OK(glint_image_pixel(image, GLINT_PASS_ALBEDO, x, y, albedo, &error));
            if (!(t > 0))
                continue;
            for (int k = 0; k < 3; k++)
                p[k] = k == 1 ? 0 : c->eye[k] + t * d[k];
            const bool is = is_odd(p, 1);
            wrong += albedo[0] != (float)(is ? white : blue)[0] || albedo[2] != (float)(is ? white : blue)[2];
            odd += is;
            hits++;
        }
    assert_int_equal(wrong, 0);
    assert_true(hits > 500000 && odd > hits / 4 && odd < 3 * hits / 4);
    glint_plan_destroy(plan);
    glint_image_release(image);
    release_world(&w);
}

// ---- Properties: every configuration gives the same bits ------------------------------------------------------------

/// A program with one or three outputs that depend on the point, the normal,
/// the view and the surface, some with special values.
static glint_program *random_program(size_t count, double low, double high)
{
    glint_value out[3];
    begin_program(GLINT_PROGRAM_PATTERN);
    for (size_t i = 0; i < count; i++) {
        const glint_input inputs[] = { GLINT_INPUT_P_X,     GLINT_INPUT_P_Y,  GLINT_INPUT_P_Z,
                                       GLINT_INPUT_WORLD_Y, GLINT_INPUT_N_X,  GLINT_INPUT_V_Z,
                                       GLINT_INPUT_UV_U,    GLINT_INPUT_UV_V, GLINT_INPUT_UV_FOOTPRINT };
        const glint_value x = mul(in(inputs[below(9)]), num(between(1, 5))), y = in(inputs[below(9)]);
        const glint_value wave = op(GLINT_OP_SIN, op(GLINT_OP_ADD, x, y, 0), 0, 0);
        out[i] = op(GLINT_OP_MULADD, wave, num((high - low) / 2), num((high + low) / 2));
        if (below(6) == 0) // negative, or NaN
            out[i] = op(GLINT_OP_SELECT, op(GLINT_OP_LESS, wave, num(-0.9), 0), op(GLINT_OP_SQRT, wave, 0, 0),
                        op(GLINT_OP_SUB, out[i], num(low + 0.1), 0));
    }
    return end_program(out, count);
}

/// A shader with steps of n.l, and with a highlight of half the colour.
static glint_program *random_shader(void)
{
    glint_value out[6];
    begin_program(GLINT_PROGRAM_SHADER);
    glint_value nl = num(0), nv = num(0);
    for (int c = 0; c < 3; c++) {
        const glint_value n = in((glint_input)(GLINT_INPUT_N_X + c));
        nl = op(GLINT_OP_MULADD, n, in((glint_input)(GLINT_INPUT_L_X + c)), nl);
        nv = op(GLINT_OP_MULADD, n, in((glint_input)(GLINT_INPUT_V_X + c)), nv);
    }
    const glint_value step = op(GLINT_OP_SELECT, op(GLINT_OP_LESS, num(between(0.2, 0.6)), nl, 0), num(1), num(0.3));
    const glint_value shine = op(GLINT_OP_HIGHLIGHT, nv, in(GLINT_INPUT_SHININESS), 0);
    for (int c = 0; c < 3; c++) {
        const glint_value light = in((glint_input)(GLINT_INPUT_LIGHT_R + c));
        out[c] = mul(mul(in((glint_input)(GLINT_INPUT_KD_R + c)), light), step);
        out[3 + c] = mul(mul(in((glint_input)(GLINT_INPUT_KS_R + c)), light), shine);
    }
    return end_program(out, below(2) ? 3 : 6);
}

static void release_programs(const glint_material_programs *p)
{
    glint_program *const programs[] = { p->diffuse,   p->specular, p->mirror,  p->transmission, p->shininess,
                                        p->roughness, p->bump,     p->opacity, p->shader };
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        glint_program_release(programs[i]);
}

static glint_material *random_material(bool bouncing)
{
    glint_material_desc desc = glint_material_desc_default();
    desc.model = (glint_model)below(4);
    desc.normalized = below(3) == 0;
    desc.matched = below(3) == 0;
    desc.distribution = (glint_distribution)below(2);
    desc.has_ambient = below(3) == 0;
    for (int c = 0; c < 3; c++) {
        desc.specular[c] = below(2) ? between(0, 1) : 0;
        desc.diffuse[c] = between(0, 1);
        desc.ambient[c] = between(0, 0.5);
    }
    if (below(4))
        desc.program.diffuse = random_program(below(2) ? 3 : 1, 0, 1);
    if (below(2))
        desc.program.specular = random_program(below(2) ? 3 : 1, 0, 1);
    if (below(2))
        desc.program.shininess = random_program(1, 2, 100);
    if (below(2))
        desc.program.roughness = random_program(1, 0.05, 0.9);
    if (bouncing && below(2))
        desc.program.mirror = random_program(below(2) ? 3 : 1, 0, 0.6);
    if (bouncing && below(3) == 0)
        desc.program.transmission = random_program(below(2) ? 3 : 1, 0, 0.6);
    if (below(3) == 0)
        desc.program.bump = random_program(1, 0, 0.2);
    if (below(5) == 0)
        desc.program.opacity = random_program(1, 0.1, 1);
    if (below(4) == 0)
        desc.program.shader = random_shader();
    glint_material *material = new_material(&desc);
    release_programs(&desc.program);
    return material;
}

static void random_shape(world *w, glint_material *material)
{
    static const glint_shape_kind kinds[] = { GLINT_SHAPE_SPHERE, GLINT_SHAPE_BOX,  GLINT_SHAPE_CYLINDER,
                                              GLINT_SHAPE_CONE,   GLINT_SHAPE_DISK, GLINT_SHAPE_SPHERE,
                                              GLINT_SHAPE_TORUS };
    glint_shape_desc desc = glint_shape_desc_default(kinds[below(7)]);
    const double axis[3] = { between(-1, 1), 1, between(-1, 1) }, by[3] = { between(0.5, 1.5), between(0.5, 1.5), -1 };
    const double to[3] = { between(-3, 3), between(0, 2), between(-3, 3) };
    desc.transform = glint_transform_translate(to);
    if (below(2)) {
        const glint_transform turn = glint_transform_rotate_deg(axis, between(0, 360)), size = glint_transform_scale(by);
        const glint_transform both = glint_transform_product(&turn, &size);
        desc.transform = glint_transform_product(&desc.transform, &both);
    }
    desc.two_sided = below(3) > 0;
    add_shape(w, &desc, material);
}

#define SHEET 6 // number of quads along a side of a mesh

/// Makes a curved sheet of quads, with texture coordinates per vertex, or per corner with seams.
static glint_shape *new_sheet(const glint_mesh_desc *like, bool torn, double first)
{
    double vertices[SHEET + 1][SHEET + 1][3], uv[4 * SHEET * SHEET][2];
    uint32_t corners[4 * SHEET * SHEET], sizes[SHEET * SHEET], numbers[4 * SHEET * SHEET];
    glint_mesh_desc desc = *like;
    glint_shape *shape;
    for (int i = 0; i <= SHEET; i++)
        for (int j = 0; j <= SHEET; j++) {
            const double at[3] = { 2.0 * i / SHEET - 1, 0.3 * sin(i) * cos(j), 2.0 * j / SHEET - 1 };
            memcpy(vertices[i][j], at, sizeof at);
        }
    for (uint32_t k = 0; k < SHEET * SHEET; k++) {
        const uint32_t at = k / SHEET * (SHEET + 1) + k % SHEET;
        const uint32_t around[4] = { at, at + 1, at + SHEET + 2, at + SHEET + 1 };
        sizes[k] = 4;
        memcpy(corners + 4 * (size_t)k, around, sizeof around);
    }
    for (uint32_t i = 0; i < 4 * SHEET * SHEET; i++) {
        numbers[i] = (7 * i) % (4 * SHEET * SHEET);
        uv[i][0] = i == 0 ? first : sin(i);
        uv[i][1] = 1.5 * cos(3 * i);
    }
    desc.vertices = &vertices[0][0][0];
    desc.vertex_count = (SHEET + 1) * (SHEET + 1);
    desc.corners = corners;
    desc.face_sizes = sizes;
    desc.face_count = SHEET * SHEET;
    desc.uv = &uv[0][0];
    desc.uv_count = torn ? 4 * SHEET * SHEET : desc.vertex_count;
    desc.uv_corners = torn ? numbers : NULL;
    OK(glint_mesh_create(&desc, &shape, &error));
    return shape;
}

static void random_mesh(world *w, glint_material *material)
{
    glint_mesh_desc desc = glint_mesh_desc_default();
    const double to[3] = { between(-2, 2), 1, between(-2, 2) }, by[3] = { between(0.8, 1.5), 1, -1 };
    const glint_transform move = glint_transform_translate(to), size = glint_transform_scale(by);
    desc.transform = below(2) ? move : glint_transform_product(&move, &size);
    desc.has_shading = true;
    desc.shading = (glint_shading)below(4);
    desc.material = material;
    glint_shape *shape = new_sheet(&desc, below(2), 0.5);
    OK(glint_scene_add_shape(w->scene, shape, &error));
    glint_shape_release(shape);
}

static void random_light(world *w)
{
    const glint_light_kind kinds[] = { GLINT_LIGHT_POINT, GLINT_LIGHT_DIRECTIONAL, GLINT_LIGHT_SPOT, GLINT_LIGHT_DISK,
                                       GLINT_LIGHT_SPHERE };
    glint_light_desc desc = glint_light_desc_default(kinds[below(5)]);
    glint_light *light;
    for (int c = 0; c < 3; c++) {
        desc.position[c] = between(-4, 4) + (c == 1 ? 6 : 0);
        desc.direction[c] = c == 1 ? -1 : between(-1, 1);
        desc.color[c] = between(0.2, 1);
    }
    if (desc.kind == GLINT_LIGHT_SPHERE && below(2))
        desc.shadow = GLINT_SHADOW_CAPS;
    desc.outer_rad = 1.2;
    desc.samples = 1 + below(6);
    OK(glint_light_create(&desc, &light, &error));
    OK(glint_scene_add_light(w->scene, light, &error));
    glint_light_release(light);
}

static world random_world(void)
{
    const double eye[3] = { 1, 4, 9 }, at[3] = { 0, 0.5, 0 };
    world w = new_world(eye, at, 80, 60);
    const bool bouncing = below(3) == 0, meshes = below(3) == 0;
    glint_shape_desc floor = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    glint_material *materials[4];
    for (int i = 0; i < 4; i++)
        materials[i] = random_material(bouncing);
    add_shape(&w, &floor, materials[0]);
    for (int i = 0; i < 5; i++)
        random_shape(&w, materials[below(4)]);
    if (meshes)
        random_mesh(&w, materials[below(4)]);
    for (uint32_t i = 0; i < 1 + below(3); i++)
        random_light(&w);
    for (int i = 0; i < 4; i++)
        glint_material_release(materials[i]);
    glint_scene_desc desc = *glint_scene_get(w.scene);
    desc.struct_size = sizeof desc;
    desc.ambient[0] = desc.ambient[1] = desc.ambient[2] = 0.1;
    desc.background[2] = 0.3;
    desc.has_indirect = below(5) == 0;
    desc.indirect_samples = 2;
    desc.indirect_bounces = 2;
    OK(glint_scene_set(w.scene, &desc, &error));
    w.render.samples = below(2) ? 1 : below(2) ? 4 : 20;
    w.render.adaptive = below(4) ? 0 : 0.1;
    w.render.precision = below(4) ? GLINT_PRECISION_DOUBLE : GLINT_PRECISION_FLOAT;
    w.render.passes = (1u << GLINT_PASS_COUNT) - 1;
    return w;
}

static void check_same(const glint_image *a, const glint_image *b, const char *what, int round)
{
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++)
        for (int c = 0; c < glint_pass_channels((glint_pass)pass); c++) {
            const float *x = a->plane[pass][c], *y = b->plane[pass][c];
            for (int i = 0; x && i < a->width * a->height; i++)
                if (memcmp(&x[i], &y[i], sizeof *x) != 0)
                    fail_msg("round %d, %s: pass %s differs at %d, %d: %.9g, %.9g", round, what,
                             glint_pass_name((glint_pass)pass), i % a->width, i / a->width, (double)x[i], (double)y[i]);
        }
}

static void test_same_bits(void **state)
{
    (void)state;
    for (int round = 0; round < 40; round += (int)case_step()) {
        random_state = 77 + (uint64_t)round;
        world w = random_world();
        glint_image *reference = render(&w, "ref", 1);
        for (const glint_stages *const *set = glint_stages_built; *set; set++) {
            if (!glint_stages_usable(*set) || *set == &glint_stages_ref)
                continue;
            glint_image *image = render(&w, (*set)->name, 2);
            check_same(reference, image, (*set)->name, round);
            glint_image_release(image);
        }
        glint_image_release(reference);
        release_world(&w);
    }
}

// ---- Bumps ----------------------------------------------------------------------------------------------------------

/// h = a sin(k . p) under a map that rotates, stretches and mirrors. The normal is compared with the formula, using
/// the inverse of the map. Light from below the geometric surface does not count.
static void test_bump(void **state)
{
    (void)state;
    const double eye[3] = { 0.5, 6, 4 }, at[3] = { 0, 0, 0 }, k[3] = { 3, 0.5, 1.5 }, a = 0.07;
    world w = new_world(eye, at, 120, 90);
    glint_material_desc desc = glint_material_desc_default();
    begin_program(GLINT_PROGRAM_PATTERN);
    glint_value phase = num(0);
    for (int c = 0; c < 3; c++)
        phase = op(GLINT_OP_MULADD, in((glint_input)(GLINT_INPUT_P_X + c)), num(k[c]), phase);
    const glint_value height = mul(op(GLINT_OP_SIN, phase, 0, 0), num(a));
    desc.program.bump = end_program(&height, 1);
    glint_material *material = new_material(&desc);
    glint_program_release(desc.program.bump);
    glint_shape_desc floor = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    const double axis[3] = { 0.2, 1, 0.1 }, by[3] = { 2, 1.5, -0.5 }, to[3] = { 0.3, -0.2, 0.7 };
    const glint_transform turn = glint_transform_rotate_deg(axis, 40), size = glint_transform_scale(by);
    const glint_transform both = glint_transform_product(&turn, &size), move = glint_transform_translate(to);
    floor.transform = glint_transform_product(&move, &both);
    add_shape(&w, &floor, material);
    glint_material_release(material);
    glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_DIRECTIONAL);
    const double travel[3] = { 1, -0.05, 0.2 };
    memcpy(light.direction, travel, sizeof travel);
    glint_light *sun;
    OK(glint_light_create(&light, &sun, &error));
    OK(glint_scene_add_light(w.scene, sun, &error));
    w.render.passes = (1u << GLINT_PASS_COUNT) - 1;
    glint_image *image = render(&w, NULL, 0);
    // Columns of the linear part: x_world = m p + t, so p and the gradient follow from the adjugate.
    double m[3][3], cross[3][3], t[3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            m[j][i] = floor.transform.m[i][j];
        t[i] = floor.transform.m[i][3];
    }
    for (int i = 0; i < 3; i++)
        vec_cross(cross[i], m[(i + 1) % 3], m[(i + 2) % 3]);
    const double determinant = vec_dot(m[0], cross[0]);
    double up[3], worst = 0;
    vec_normalize(up, cross[1]);
    if (up[1] < 0)
        vec_scale(up, up, -1);
    glint_plan *plan;
    OK(glint_plan_create(w.scene, &w.render, &plan, &error));
    const glint_plan_camera *c = &plan->camera;
    int bright = 0, dark = 0;
    for (int y = 0; y < 90; y++)
        for (int x = 0; x < 120; x++) {
            const double sx = 2 * (x + 0.5) - 120, sy = 90 - 2 * (y + 0.5);
            double d[3], away[3], g[3] = { 0 }, n[3], l[3], sum = 0;
            float normal[3], diffuse[3];
            for (int i = 0; i < 3; i++) {
                d[i] = (c->forward[i] + sx * c->right[i]) + sy * c->up[i];
                away[i] = t[i] - c->eye[i];
            }
            const double far = vec_dot(up, away) / vec_dot(up, d);
            OK(glint_image_pixel(image, GLINT_PASS_NORMAL, x, y, normal, &error));
            OK(glint_image_pixel(image, GLINT_PASS_DIFFUSE, x, y, diffuse, &error));
            if (!(far > 0))
                continue;
            for (int i = 0; i < 3; i++)
                away[i] = c->eye[i] + far * d[i] - t[i];
            for (int i = 0; i < 3; i++)
                sum += k[i] * vec_dot(cross[i], away) / determinant;
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    g[j] += a * cos(sum) * k[i] * cross[i][j] / determinant;
            const double along = vec_dot(g, up);
            for (int i = 0; i < 3; i++)
                n[i] = up[i] - (g[i] - along * up[i]);
            vec_normalize(n, n);
            for (int i = 0; i < 3; i++)
                worst = fmax(worst, fabs(n[i] - (double)normal[i]));
            vec_normalize(l, travel);
            vec_scale(l, l, -1);
            const double cosine = vec_dot(n, l), own = vec_dot(up, l);
            const double expected = cosine > 0 && own > 0 ? 0.8 * cosine : 0;
            if (fabs(cosine) > 1e-6 && fabs((double)diffuse[0] - expected) > 2e-6)
                fail_msg("%d, %d: %.9g expected, got %.9g", x, y, expected, (double)diffuse[0]);
            bright += expected > 0;
            dark += expected == 0;
        }
    assert_true(worst < 1e-6 && bright > 1000 && dark > 100);
    glint_plan_destroy(plan);
    glint_image_release(image);
    glint_light_release(sun);
    release_world(&w);
}

// ---- Shaders --------------------------------------------------------------------------------------------------------

/// Lambert's and Phong's models as a program, against the built-in models.
static void test_shader(void **state)
{
    (void)state;
    glint_value out[6], rv, nl, nv, lv;
    begin_program(GLINT_PROGRAM_SHADER);
    nl = nv = lv = num(0);
    for (int c = 0; c < 3; c++) {
        const glint_value n = in((glint_input)(GLINT_INPUT_N_X + c)), l = in((glint_input)(GLINT_INPUT_L_X + c));
        const glint_value v = in((glint_input)(GLINT_INPUT_V_X + c));
        nl = op(GLINT_OP_MULADD, n, l, nl);
        nv = op(GLINT_OP_MULADD, n, v, nv);
        lv = op(GLINT_OP_MULADD, l, v, lv);
    }
    rv = op(GLINT_OP_MULSUB, mul(nl, num(2)), nv, lv);
    for (int c = 0; c < 3; c++) {
        const glint_value light = in((glint_input)(GLINT_INPUT_LIGHT_R + c));
        out[c] = mul(mul(in((glint_input)(GLINT_INPUT_KD_R + c)), light), nl);
        out[3 + c] = mul(mul(in((glint_input)(GLINT_INPUT_KS_R + c)), light),
                         op(GLINT_OP_HIGHLIGHT, rv, in(GLINT_INPUT_SHININESS), 0));
    }
    glint_program *phong = end_program(out, 6);
    for (int round = 0; round < 12; round += (int)case_step()) {
        glint_image *images[2];
        for (int which = 0; which < 2; which++) {
            random_state = 900 + (uint64_t)round;
            const double eye[3] = { 1, 4, 9 }, at[3] = { 0, 0.5, 0 };
            world w = new_world(eye, at, 80, 60);
            glint_material_desc desc = glint_material_desc_default();
            desc.specular[0] = desc.specular[1] = 0.4;
            desc.shininess = 20;
            desc.program.diffuse = random_program(3, 0, 1);
            desc.program.shininess = random_program(1, 4, 60);
            desc.program.shader = which ? phong : NULL;
            glint_material *material = new_material(&desc);
            glint_program_release(desc.program.diffuse);
            glint_program_release(desc.program.shininess);
            glint_shape_desc floor = glint_shape_desc_default(GLINT_SHAPE_PLANE);
            add_shape(&w, &floor, material);
            for (int i = 0; i < 5; i++)
                random_shape(&w, material);
            if (round % 3 == 0)
                random_mesh(&w, material);
            for (int i = 0; i < 1 + round % 3; i++)
                random_light(&w);
            glint_material_release(material);
            w.render.samples = round % 2 ? 4 : 1;
            w.render.passes = (1u << GLINT_PASS_COUNT) - 1;
            images[which] = render(&w, NULL, 2);
            release_world(&w);
        }
        for (int pass = GLINT_PASS_BEAUTY; pass <= GLINT_PASS_SPECULAR; pass++)
            for (int c = 0; c < 3; c++)
                for (int i = 0; i < 80 * 60; i++) {
                    const float x = images[0]->plane[pass][c][i], y = images[1]->plane[pass][c][i];
                    if (fabsf(x - y) > 4e-6f * (1 + fabsf(x)))
                        fail_msg("round %d, pass %s, %d, %d: %.9g built in, %.9g by the program", round,
                                 glint_pass_name((glint_pass)pass), i % 80, i / 80, (double)x, (double)y);
                }
        glint_image_release(images[0]);
        glint_image_release(images[1]);
    }
    glint_program_release(phong);
}

// ---- Reuse ----------------------------------------------------------------------------------------------------------

/// A program a sin(b p.x) + c p.y, or with another operation instead of the sine.
/// The tests change one number at a time.
typedef struct wave {
    double a, b, c;
    bool other;
} wave;

static glint_program *wave_program(const wave *v)
{
    begin_program(GLINT_PROGRAM_PATTERN);
    const glint_value x = mul(in(GLINT_INPUT_P_X), num(v->b));
    const glint_value s = op(v->other ? GLINT_OP_COS : GLINT_OP_SIN, x, 0, 0);
    const glint_value out =
        op(GLINT_OP_MULADD, s, num(v->a), op(GLINT_OP_MULADD, in(GLINT_INPUT_P_Y), num(v->c), num(0.5)));
    return end_program(&out, 1);
}

/// The number of programs of a material, one for each field.
enum { WAVES = 8 };

static void set_waves(glint_material *material, const wave waves[WAVES])
{
    glint_material_desc desc = *glint_material_get(material);
    desc.struct_size = sizeof desc;
    glint_program **const programs[WAVES] = { &desc.program.diffuse,      &desc.program.specular,  &desc.program.mirror,
                                              &desc.program.shininess,    &desc.program.roughness, &desc.program.bump,
                                              &desc.program.transmission, &desc.program.opacity };
    for (int i = 0; i < WAVES; i++)
        *programs[i] = wave_program(&waves[i]);
    OK(glint_material_set(material, &desc, &error));
    release_programs(&desc.program);
}

static glint_image *render_with(glint_renderer *renderer, const world *w, glint_frame_stats *stats)
{
    glint_plan *plan;
    glint_image *image;
    OK(glint_plan_create(w->scene, &w->render, &plan, &error));
    OK(glint_render(renderer, plan, &image, stats, &error));
    glint_plan_destroy(plan);
    return image;
}

/// Changes one number or the operation of one program, rotates the ball in place, or moves a light, in turn.
static void edit(uint32_t turn, wave waves[WAVES], glint_material *material, world *w)
{
    wave *v = &waves[turn / 4 % WAVES];
    glint_shape *ball = glint_scene_shape_at(w->scene, 1);
    glint_shape_desc desc = *glint_shape_get(ball);
    desc.struct_size = sizeof desc;
    glint_light *light = glint_scene_light_at(w->scene, 0);
    glint_light_desc lamp = *glint_light_get(light);
    lamp.struct_size = sizeof lamp;
    const double axis[3] = { 0, 1, 0 };
    switch (turn % 4) {
    case 0:
        v->a += 0.05;
        break;
    case 1:
        v->b += 0.5;
        break;
    case 2:
        v->c += 0.1;
        break;
    default:
        v->other = !v->other;
    }
    if (turn % 5 == 4) { // the ball's surface stays the same
        desc.transform = glint_transform_rotate_deg(axis, 37.0 * turn);
        OK(glint_shape_set(ball, &desc, &error));
    } else if (turn % 5 == 3) {
        lamp.position[0] += 0.3;
        OK(glint_light_set(light, &lamp, &error));
    } else {
        set_waves(material, waves);
    }
}

static void test_reuse(void **state)
{
    (void)state;
    for (int round = 0; round < 4; round++) {
        const double eye[3] = { 1, 4, 9 }, at[3] = { 0, 0.5, 0 };
        world w = new_world(eye, at, 48, 36);
        wave waves[WAVES] = { { 0.3, 3, 0.05, false }, { 0.3, 5, 0.1, false }, { 0.1, 2, 0, true },
                              { 5, 3, 9, false },      { 0.2, 3, 0.1, false }, { 0.1, 6, 0, false },
                              { 0.1, 3, 0, false },    { 0.3, 4, 0.2, false } };
        glint_material_desc desc = glint_material_desc_default();
        desc.model = round % 2 ? GLINT_MODEL_COOK_TORRANCE : GLINT_MODEL_PHONG;
        desc.normalized = round == 2;
        glint_material *material = new_material(&desc);
        random_state = 5 + (uint64_t)round;
        glint_shape_desc floor = glint_shape_desc_default(GLINT_SHAPE_PLANE);
        glint_shape_desc ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
        add_shape(&w, &floor, material);
        add_shape(&w, &ball, material);
        random_light(&w);
        set_waves(material, waves);
        w.render.samples = round == 3 ? 4 : 1;
        w.render.passes = (1u << GLINT_PASS_COUNT) - 1;
        glint_renderer_desc options = { .struct_size = sizeof(glint_renderer_desc), .threads = 2 };
        glint_renderer *renderer;
        OK(glint_renderer_create(&options, &renderer, &error));
        for (uint32_t turn = 0; turn < 5 * WAVES * 4; turn += case_step()) {
            edit(turn, waves, material, &w);
            for (int again = 0; again < 2; again++) { // the renderer caches results when a frame repeats unchanged
                glint_image *reused = render_with(renderer, &w, NULL), *fresh = render(&w, NULL, 2);
                check_same(reused, fresh, "reused", (int)turn);
                glint_image_release(reused);
                glint_image_release(fresh);
            }
        }
        glint_renderer_destroy(renderer);
        glint_material_release(material);
        release_world(&w);
    }
}

/// Changes one texture coordinate of a mesh whose surface stays the same.
static void test_reuse_uv(void **state)
{
    (void)state;
    const double eye[3] = { 0, 3, 2 }, at[3] = { 0, 0, 0 };
    world w = new_world(eye, at, 64, 48);
    glint_mesh_desc mesh = glint_mesh_desc_default();
    glint_material_desc desc = glint_material_desc_default();
    begin_program(GLINT_PROGRAM_PATTERN);
    const glint_value u = op(GLINT_OP_ABS, in(GLINT_INPUT_UV_U), 0, 0);
    desc.program.diffuse = end_program(&u, 1);
    mesh.material = new_material(&desc);
    glint_program_release(desc.program.diffuse);
    glint_renderer_desc options = { .struct_size = sizeof(glint_renderer_desc), .threads = 2 };
    glint_renderer *renderer;
    OK(glint_renderer_create(&options, &renderer, &error));
    glint_image *before = NULL;
    for (int turn = 0; turn < 6; turn++) {
        glint_shape *sheet = new_sheet(&mesh, turn >= 3, turn / 2);
        OK(glint_scene_add_shape(w.scene, sheet, &error));
        glint_image *reused = render_with(renderer, &w, NULL), *fresh = render(&w, NULL, 2);
        check_same(reused, fresh, "reused", turn);
        const size_t bytes = sizeof(float) * 64 * 48;
        const bool same =
            before && memcmp(before->plane[GLINT_PASS_ALBEDO][0], fresh->plane[GLINT_PASS_ALBEDO][0], bytes) == 0;
        assert_int_equal(same, turn == 1 || turn == 5);
        OK(glint_scene_remove_shape(w.scene, sheet, &error));
        glint_shape_release(sheet);
        glint_image_release(reused);
        glint_image_release(before);
        before = fresh;
    }
    glint_image_release(before);
    glint_renderer_destroy(renderer);
    glint_material_release(mesh.material);
    release_world(&w);
}

/// NaN and values below 0 are replaced by 0, counted, and reported with a point.
static void test_odd(void **state)
{
    (void)state;
    const double eye[3] = { 0, 4, 4 }, at[3] = { 0, 0, 0 };
    world w = new_world(eye, at, 64, 48);
    glint_material_desc desc = glint_material_desc_default();
    begin_program(GLINT_PROGRAM_PATTERN);
    const glint_value out = op(GLINT_OP_SQRT, in(GLINT_INPUT_P_X), 0, 0); // NaN where x < 0
    desc.program.diffuse = end_program(&out, 1);
    snprintf(desc.name, sizeof desc.name, "root");
    glint_material *material = new_material(&desc);
    glint_program_release(desc.program.diffuse);
    glint_shape_desc floor = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    add_shape(&w, &floor, material);
    glint_renderer_desc options = { .struct_size = sizeof(glint_renderer_desc), .threads = 2, .no_reuse = true };
    glint_renderer *renderer;
    glint_frame_stats stats;
    OK(glint_renderer_create(&options, &renderer, &error));
    glint_image *image = render_with(renderer, &w, &stats);
    float albedo[3];
    uint64_t black = 0;
    for (int i = 0; i < 64 * 48; i++) {
        OK(glint_image_pixel(image, GLINT_PASS_ALBEDO, i % 64, i / 64, albedo, &error));
        assert_true(albedo[0] >= 0);
        black += albedo[0] == 0;
    }
    assert_int_equal(black, 64 * 48 / 2);
    const glint_odd *odd = &stats.odd[GLINT_ODD_NAN];
    assert_int_equal(odd->count, 64 * 48 / 2);
    assert_string_equal(odd->field, "diffuse");
    assert_string_equal(odd->material, "root");
    assert_true(odd->point[0] < -1 && odd->point[1] == 0);
    assert_true(stats.odd[GLINT_ODD_NEGATIVE].count == 0 && stats.odd[GLINT_ODD_HUGE].count == 0);
    glint_image_release(image);
    glint_renderer_destroy(renderer);
    glint_material_release(material);
    release_world(&w);
}

static double share_reused(const glint_frame_stats *stats, const char *stage)
{
    for (int i = 0; i < stats->stage_count; i++)
        if (strcmp(stats->stage_name[i], stage) == 0)
            return stats->stage_reused[i];
    return -1;
}

/// A moved light does not run the pattern. A changed number does not affect hits, light and shadows. Without a
/// program the stage does not exist.
static void test_stages(void **state)
{
    (void)state;
    const double eye[3] = { 1, 4, 9 }, at[3] = { 0, 0.5, 0 };
    world w = new_world(eye, at, 96, 72);
    glint_material_desc desc = glint_material_desc_default();
    wave v = { 0.3, 3, 0.05, false };
    desc.program.diffuse = wave_program(&v);
    glint_material *material = new_material(&desc), *plain;
    glint_program_release(desc.program.diffuse);
    glint_shape_desc floor = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    add_shape(&w, &floor, material);
    glint_light_desc lamp = glint_light_desc_default(GLINT_LIGHT_POINT);
    glint_light *light;
    glint_renderer_desc options = { .struct_size = sizeof(glint_renderer_desc), .threads = 1 };
    glint_renderer *renderer;
    glint_frame_stats stats;
    lamp.position[1] = 5;
    OK(glint_light_create(&lamp, &light, &error));
    OK(glint_scene_add_light(w.scene, light, &error));
    OK(glint_renderer_create(&options, &renderer, &error));
    w.render.passes = 1u << GLINT_PASS_BEAUTY;
    for (int i = 0; i < 4; i++) {
        lamp.position[0] = i;
        OK(glint_light_set(light, &lamp, &error));
        glint_image_release(render_with(renderer, &w, &stats));
    }
    assert_true(share_reused(&stats, "pattern") == 1 && share_reused(&stats, "light") == 0);
    for (int i = 0; i < 4; i++) {
        v.a = 0.1 + 0.1 * i;
        desc.program.diffuse = wave_program(&v);
        OK(glint_material_set(material, &desc, &error));
        glint_program_release(desc.program.diffuse);
        glint_image_release(render_with(renderer, &w, &stats));
    }
    assert_true(share_reused(&stats, "pattern") == 0 && share_reused(&stats, "shade") == 0);
    assert_true(share_reused(&stats, "cast") == 1 && share_reused(&stats, "light") == 1 &&
                share_reused(&stats, "occlude") == 1);
    desc.program.diffuse = NULL;
    plain = new_material(&desc);
    OK(glint_material_set(material, glint_material_get(plain), &error));
    glint_image_release(render_with(renderer, &w, &stats));
    assert_true(share_reused(&stats, "pattern") == -1);
    glint_material_release(plain);
    glint_renderer_destroy(renderer);
    glint_light_release(light);
    glint_material_release(material);
    release_world(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_floor), cmocka_unit_test(test_same_bits),
                                        cmocka_unit_test(test_bump),  cmocka_unit_test(test_shader),
                                        cmocka_unit_test(test_reuse), cmocka_unit_test(test_stages),
                                        cmocka_unit_test(test_odd),   cmocka_unit_test(test_reuse_uv) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
