#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/glint_programs.h"
#include "tests/bench/glint_side.h"

#define PI 3.14159265358979323846

void side_must(glint_status status, const glint_error *error)
{
    if (status != GLINT_OK)
        bench_fail("glint", error->message);
}

static void widen(const float from[3], double to[3])
{
    for (int c = 0; c < 3; c++)
        to[c] = (double)from[c];
}

/// Sets the program of the named pattern: "phong" as the shader of every material, the others as the diffuse
/// reflectance of the first material.
static void set_program(const side_scene *s, int material, double number, glint_material_desc *d)
{
    const bool shader = strcmp(s->pattern, "phong") == 0;
    glint_program *program = shader || material == 0 ? side_program_create(s->pattern, number) : NULL;
    if (shader)
        d->program.shader = program;
    else if (program)
        d->program.diffuse = program;
}

static void make_materials(side_scene *s)
{
    glint_error error;
    for (int m = 0; m < s->plain.material_count; m++) {
        const bench_material *p = &s->plain.materials[m];
        glint_material_desc d = glint_material_desc_default();
        widen(p->diffuse, d.diffuse);
        for (int c = 0; c < 3; c++) {
            d.specular[c] = (double)p->specular;
            d.mirror[c] = (double)p->mirror;
            d.transmission[c] = (double)p->transmission;
        }
        d.has_mirror = p->mirror > 0;
        d.ior = 1.5;
        d.shininess = (double)p->shininess;
        set_program(s, m, 0.05, &d);
        side_must(glint_material_create(&d, &s->materials[m], &error), &error);
        glint_program_release(d.program.shader ? d.program.shader : d.program.diffuse);
    }
}

static void add_shape(side_scene *s, glint_shape *shape)
{
    glint_error error;
    side_must(glint_scene_add_shape(s->scene, shape, &error), &error);
    glint_shape_release(shape);
}

/// Adds up to 100 spheres as separate shapes, as a script would create them. With more spheres, all except the last
/// are elements of one shape.
static void add_spheres(side_scene *s)
{
    const bench_scene *p = &s->plain;
    const size_t many = p->sphere_count > 100 ? p->sphere_count - 1 : 0;
    glint_error error;
    glint_shape *shape;
    if (many) {
        glint_spheres_desc d = { .struct_size = sizeof(glint_spheres_desc), .data = p->spheres,
                                 .count = many,
                                 .is_float = true,
                                 .materials = s->materials,
                                 .material_count = (size_t)p->material_count,
                                 .material_index = p->sphere_material,
                                 .two_sided = true };
        side_must(glint_spheres_create(&d, &shape, &error), &error);
        add_shape(s, shape);
    }
    for (size_t i = many; i < p->sphere_count; i++) {
        glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
        widen(p->spheres + 4 * i, d.center);
        d.radius = (double)p->spheres[4 * i + 3];
        d.material = s->materials[p->sphere_material[i]];
        side_must(glint_shape_create(&d, &shape, &error), &error);
        add_shape(s, shape);
        s->ball = shape;
    }
}

static glint_shape *new_shape(const glint_shape_desc *d)
{
    glint_error error;
    glint_shape *shape;
    side_must(glint_shape_create(d, &shape, &error), &error);
    return shape;
}

/// Adds a part to the CSG shape, or directly to the scene if `whole` is NULL.
static void add_part(side_scene *s, glint_shape *whole, glint_shape *part)
{
    glint_error error;
    if (!whole) {
        add_shape(s, part);
        return;
    }
    side_must(glint_group_add(whole, part, &error), &error);
    glint_shape_release(part);
}

/// Adds a cylinder or a cone.
static void add_rod(side_scene *s, const bench_solid *rod)
{
    glint_shape_desc d = glint_shape_desc_default(rod->kind == BENCH_ROD ? GLINT_SHAPE_CYLINDER : GLINT_SHAPE_CONE);
    widen(rod->center, d.base);
    widen(rod->ball, d.top);
    d.radius = (double)rod->size;
    d.material = s->materials[rod->material];
    add_shape(s, new_shape(&d));
}

static void add_solid(side_scene *s, const bench_solid *solid)
{
    if (solid->kind == BENCH_ROD || solid->kind == BENCH_TIP) {
        add_rod(s, solid);
        return;
    }
    glint_shape_desc box = glint_shape_desc_default(GLINT_SHAPE_BOX), ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    glint_shape_desc torus = glint_shape_desc_default(GLINT_SHAPE_TORUS), cut = glint_shape_desc_default(GLINT_SHAPE_DIFFERENCE);
    box.material = ball.material = torus.material = cut.material = s->materials[solid->material];
    if (solid->kind == BENCH_TORUS) {
        widen(solid->center, torus.center);
        widen(solid->ball, torus.axis);
        torus.major = (double)solid->size;
        torus.minor = (double)solid->ball[3];
        add_shape(s, new_shape(&torus));
        return;
    }
    for (int c = 0; c < 3; c++) {
        box.min[c] = (double)solid->center[c] - (double)solid->size;
        box.max[c] = (double)solid->center[c] + (double)solid->size;
    }
    widen(solid->ball, ball.center);
    ball.radius = (double)solid->ball[3];
    glint_shape *whole = solid->kind == BENCH_CUT ? new_shape(&cut) : NULL;
    add_part(s, whole, new_shape(&box));
    add_part(s, whole, new_shape(&ball));
    if (whole)
        add_shape(s, whole);
}

static void add_mesh(side_scene *s)
{
    const bench_scene *p = &s->plain;
    glint_error error;
    glint_shape *shape;
    double *vertices = malloc(3 * p->vertex_count * sizeof *vertices);
    uint32_t *sizes = malloc(p->triangle_count * sizeof *sizes);
    if (!vertices || !sizes)
        bench_fail("glint", "out of memory");
    for (size_t i = 0; i < 3 * p->vertex_count; i++)
        vertices[i] = (double)p->vertices[i];
    for (size_t i = 0; i < p->triangle_count; i++)
        sizes[i] = 3;
    glint_mesh_desc d = glint_mesh_desc_default();
    d.vertices = vertices;
    d.vertex_count = p->vertex_count;
    d.corners = p->triangles;
    d.face_sizes = sizes;
    d.face_count = p->triangle_count;
    d.material = s->materials[0];
    side_must(glint_mesh_create(&d, &shape, &error), &error);
    add_shape(s, shape);
    free(vertices);
    free(sizes);
}

static void set_camera(side_scene *s, const bench_options *options)
{
    glint_error error;
    glint_camera_desc c = glint_camera_desc_default();
    widen(s->plain.eye, c.eye);
    widen(s->plain.at, c.at);
    c.fov_y_rad = (double)s->plain.fov_y_degrees * PI / 180;
    if (s->plain.height > 0) {
        c.projection = GLINT_PROJECTION_ORTHOGRAPHIC;
        c.height = (double)s->plain.height;
    }
    if (options->lens) {
        c.aperture = (double)s->plain.lens_radius;
        c.focus = (double)s->plain.lens_focus;
    }
    glint_camera *camera;
    side_must(glint_camera_create(&c, &camera, &error), &error);
    glint_scene_desc d = *glint_scene_get(s->scene);
    d.struct_size = sizeof d;
    d.camera = camera;
    widen(s->plain.ambient, d.ambient);
    widen(s->plain.background, d.background);
    d.has_indirect = options->indirect > 0;
    d.indirect_samples = options->indirect;
    d.indirect_bounces = 1;
    side_must(glint_scene_set(s->scene, &d, &error), &error);
    glint_camera_release(camera);
}

/// Adds light number `i` of the scene. `lamp` is the light that was added last.
static void add_lamp(side_scene *s, const bench_options *options, int i)
{
    glint_error error;
    glint_light_desc l = glint_light_desc_default(options->area ? GLINT_LIGHT_SPHERE : GLINT_LIGHT_POINT);
    bench_lamp(&s->plain, i, options->lamps, l.position);
    l.intensity = 1.0 / options->lamps;
    l.radius = (double)s->plain.light_radius;
    l.shadows = options->shadows;
    glint_light_release(s->lamp);
    side_must(glint_light_create(&l, &s->lamp, &error), &error);
    side_must(glint_scene_add_light(s->scene, s->lamp, &error), &error);
}

side_scene side_scene_create(const bench_options *options)
{
    glint_error error;
    side_scene s = { .pattern = options->pattern };
    if (!bench_scene_create(options->scene, &s.plain))
        bench_fail(options->scene, "no such scene");
    side_must(glint_scene_create(&s.scene, &error), &error);
    make_materials(&s);
    add_spheres(&s);
    for (size_t i = 0; i < s.plain.solid_count; i++)
        add_solid(&s, &s.plain.solids[i]);
    if (s.plain.triangle_count)
        add_mesh(&s);
    for (int i = 0; i < options->lamps; i++)
        add_lamp(&s, options, i);
    set_camera(&s, options);
    return s;
}

void side_scene_free(side_scene *s)
{
    for (int m = 0; m < s->plain.material_count; m++)
        glint_material_release(s->materials[m]);
    glint_light_release(s->lamp);
    glint_scene_release(s->scene);
    bench_scene_free(&s->plain);
}

void side_scene_set_frame(side_scene *s, const char *change, int frame)
{
    glint_error error;
    if (strcmp(change, "light") == 0) {
        glint_light_desc l = *glint_light_get(s->lamp);
        l.struct_size = sizeof l;
        bench_job_light(frame, l.position);
        side_must(glint_light_set(s->lamp, &l, &error), &error);
        return;
    }
    if (strcmp(change, "sphere") == 0) {
        glint_shape_desc d = *glint_shape_get(s->ball);
        d.struct_size = sizeof d;
        d.center[1] += 0.02 * (frame % 2 ? 1 : -1);
        side_must(glint_shape_set(s->ball, &d, &error), &error);
        return;
    }
    if (strcmp(change, "number") == 0) {
        glint_material_desc d = *glint_material_get(s->materials[0]);
        d.struct_size = sizeof d;
        set_program(s, 0, 0.05 + 0.01 * frame, &d);
        side_must(glint_material_set(s->materials[0], &d, &error), &error);
        glint_program_release(d.program.diffuse);
        return;
    }
    for (int m = 0; m < s->plain.material_count; m++) {
        glint_material_desc d = *glint_material_get(s->materials[m]);
        d.struct_size = sizeof d;
        if (d.specular[0] <= 0)
            continue;
        d.shininess = bench_job_shininess(frame);
        side_must(glint_material_set(s->materials[m], &d, &error), &error);
    }
}

glint_renderer *side_renderer_create(const bench_options *options)
{
    glint_error error;
    glint_renderer *renderer;
    glint_renderer_desc d = glint_renderer_desc_default();
    d.threads = options->threads;
    d.isa = options->isa;
    d.no_reuse = options->no_reuse;
    d.time_stages = strcmp(options->mode, "stages") == 0;
    glint_status status = glint_renderer_create(&d, &renderer, &error);
    if (status == GLINT_ERR_UNSUPPORTED)
        return NULL;
    side_must(status, &error);
    return renderer;
}

static glint_render_desc frame_desc(const bench_options *options)
{
    glint_render_desc d = glint_render_desc_default();
    d.width = BENCH_WIDTH;
    d.height = BENCH_HEIGHT;
    d.samples = options->samples;
    d.adaptive = options->adaptive ? 0.1 : 0;
    d.precision = options->is_float ? GLINT_PRECISION_FLOAT : GLINT_PRECISION_DOUBLE;
    d.passes = 0;
    d.codes = true;
    return d;
}

/// Sets the parameter of the derivative: a step of the eye or of the light to the right, or a step of the exponent of
/// all shiny materials. Returns the number of fields.
static size_t find_slopes(const side_scene *s, const char *derivative, glint_slope *out)
{
    size_t count = 0;
    if (strcmp(derivative, "eye") == 0)
        out[count++] = (glint_slope) { .camera = glint_scene_get(s->scene)->camera, .field = "eye", .slope = { 1, 0, 0 } };
    else if (strcmp(derivative, "lamp") == 0)
        out[count++] = (glint_slope) { .light = s->lamp, .field = "position", .slope = { 1, 0, 0 } };
    else if (strcmp(derivative, "shininess") != 0)
        bench_fail(derivative, "no such derivative");
    const bool shines = count == 0;
    for (int m = 0; m < s->plain.material_count && shines; m++)
        if (glint_material_get(s->materials[m])->specular[0] > 0)
            out[count++] = (glint_slope) { .material = s->materials[m], .field = "shininess", .slope = { 1 } };
    return count;
}

glint_plan *side_plan_create(const side_scene *s, const bench_options *options)
{
    glint_error error;
    glint_plan *plan;
    glint_render_desc d = frame_desc(options);
    glint_slope slopes[BENCH_MATERIALS] = { { .field = NULL } };
    glint_derivative derivative = { .name = options->derivative, .slopes = slopes };
    if (strcmp(options->derivative, "none") != 0) {
        derivative.slope_count = find_slopes(s, options->derivative, slopes);
        d.derivatives = &derivative;
        d.derivative_count = 1;
    }
    side_must(glint_plan_create(s->scene, &d, &plan, &error), &error);
    return plan;
}

glint_plan *side_plan_create_exposed(side_scene *s, const bench_options *options, int frame)
{
    glint_error error;
    glint_plan *plan, **times = calloc((size_t)options->times, sizeof *times);
    const glint_render_desc d = frame_desc(options);
    glint_render_desc each = d;
    glint_shutter_desc(&each);
    if (!times)
        bench_fail("times", "out of memory");
    for (int k = 0; k < options->times; k++) {
        side_scene_set_frame(s, options->change, frame * options->times + k);
        side_must(glint_plan_create(s->scene, &each, &times[k], &error), &error);
    }
    side_must(glint_plan_create_exposed(s->scene, &d, times, (size_t)options->times, &plan, &error), &error);
    return plan;
}
