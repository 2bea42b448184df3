/// Random successive edits of a scene: a frame with reused results must equal a fresh one bit for bit.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "engine/base/alloc.h"
#include "engine/film/image.h"
#include "engine/glint_inspect.h"
#include "engine/render/stages/stages.h"
#include "engine/render/tile/tile.h"
#include "tests/engine/cases/step.h"

#define SHAPES 7
#define LIGHTS 6 ///< one of each kind

static uint64_t state;

static uint32_t draw(uint32_t below)
{
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)((state >> 33) % below);
}

static double uniform(double low, double high) { return low + (high - low) * (draw(1u << 30) / (double)(1u << 30)); }

typedef struct world {
    glint_scene *scene;
    glint_camera *camera;
    glint_material *materials[SHAPES];
    glint_shape *shapes[SHAPES];
    bool in_scene[SHAPES];
    glint_light *lights[LIGHTS];
    bool shining[LIGHTS];
    glint_render_desc render;
} world;

static void random_color(double c[3])
{
    for (int i = 0; i < 3; i++)
        c[i] = draw(4) ? uniform(0, 1) : 0;
}

// ---- Every field of every description -------------------------------------------------------------------------------

typedef enum kind {
    COLOR, ///< three numbers, some of which are 0
    VECTOR,
    NUMBER,
    WHOLE, ///< a whole number, int64_t
    FLAG,
    CHOICE, ///< an enumeration or int below `high`
    BITS, ///< a mask of `high` bits
    DEPTH, ///< bit depth: 8 or 16
    TRANSFORM,
    REGION, ///< x, y, width, height; or no region
    SKY, ///< one of the background patterns below, or none
    FIXED ///< a field that is not set here: a name, a kind, or a field that is set in another way
} kind;

typedef struct field {
    const char *name;
    size_t offset, size;
    kind kind;
    double low, high;
} field;

#define FIELD(type, member, kind, low, high) \
    { \
#member, offsetof(type, member), sizeof(((type *)0)->member), kind, low, high \
    }

#define COUNT(fields) (sizeof(fields) / sizeof *(fields))

typedef struct table {
    field of[64];
    size_t count;
} table;

static table material_table, light_table, camera_table, shape_table, scene_table;

/// Ranges of some members. With the range chosen from the engine's table, few pictures would show anything.
static const struct {
    const char *member;
    double low, high;
} ranges[] = {
    { "eye", -2, 8 },           { "at", -1, 1 },           { "fx", 10, 60 },         { "fy", 10, 60 },
    { "cx", -20, 90 },          { "cy", -20, 90 },         { "w", 20, 90 },          { "h", 20, 90 },
    { "height", 1, 10 },        { "aperture", 0, 0.4 },    { "focus", 0, 12 },       { "blades", 0, 7 },
    { "blade_rotation_rad", 0, 6 }, { "center", -3, 3 },   { "point", -3, 3 },       { "min", -3, -1 },
    { "max", -0.5, 2 },         { "base", -2, 2 },         { "top", -2, 2 },         { "depth_cue_near", 0, 6 },
    { "depth_cue_far", 4, 15 }, { "indirect_samples", 1, 3 }, { "indirect_bounces", 0, 3 },
    { "ambient_occlusion_samples", 1, 3 }, { "ambient_occlusion_distance", 0.5, 6 },
    { "reflection_samples", 0, 3 },
};

static void add_field(table *to, field f)
{
    for (size_t i = 0; i < to->count; i++)
        if (to->of[i].offset == f.offset)
            return;
    assert_true(to->count < COUNT(to->of));
    for (size_t i = 0; i < COUNT(ranges); i++)
        if (strcmp(ranges[i].member, f.name) == 0)
            f.low = ranges[i].low, f.high = ranges[i].high;
    to->of[to->count++] = f;
}

/// Adds each field of an object's rows once, with the field's flags and program. Numbers without a narrow range go up
/// to four times the default.
static void add_rows(const glint_object_field *rows, table *to)
{
    static const struct {
        enum kind kind;
        size_t size;
        double low, high;
    } of[GLINT_TYPE_OTHER + 1] = {
        [GLINT_TYPE_NUMBER] = { NUMBER, 8, 0, 0 },      [GLINT_TYPE_WHOLE] = { WHOLE, 8, 0, 0 },  [GLINT_TYPE_ANGLE] = { NUMBER, 8, 0, 0 },
        [GLINT_TYPE_FLAG] = { FLAG, 1, 0, 1 },          [GLINT_TYPE_VECTOR] = { VECTOR, 24, -6, 6 },
        [GLINT_TYPE_DIRECTION] = { VECTOR, 24, -1, 1 }, [GLINT_TYPE_COLOR] = { COLOR, 24, 0, 1 }, [GLINT_TYPE_CHOICE] = { CHOICE, 4, 0, 0 },
        [GLINT_TYPE_TEXT] = { FIXED, 64, 0, 0 },        [GLINT_TYPE_POINTS] = { FIXED, 16, 0, 0 },
        [GLINT_TYPE_OBJECT] = { FIXED, 8, 0, 0 },       [GLINT_TYPE_DISTANCE] = { NUMBER, 8, 0, 0 },
        [GLINT_TYPE_TRANSFORM] = { TRANSFORM, 96, 0, 0 },
    };
    for (const glint_object_field *f = rows; f->name; f++) {
        double low = of[f->type].low, high = of[f->type].high;
        for (int i = 0; f->type == GLINT_TYPE_CHOICE && f->names[i]; i++)
            high = i + 1;
        if (f->type == GLINT_TYPE_VECTOR && f->high > 0)
            low = 0, high = 1;
        if (f->type <= GLINT_TYPE_ANGLE) {
            low = fmax(f->low, f->low > 0 ? 0.3 * f->initial[0] : f->low);
            high = fmin(f->high, f->type == GLINT_TYPE_WHOLE ? 20 : f->initial[0] > 0 ? 4 * f->initial[0] : 9);
        }
        if (f->member)
            add_field(to, (field) { f->member, f->offset, of[f->type].size, of[f->type].kind, low, high });
        if (f->type == GLINT_TYPE_DISTANCE) {
            add_field(to, (field) { "", f->offset + 8, 1, FLAG, 0, 1 });
            add_field(to, (field) { "", f->offset + 16, 24, VECTOR, -1, 1 });
        }
        if (f->set_offset)
            add_field(to, (field) { "", f->set_offset, 1, FLAG, 0, 1 });
        if (f->program_offset)
            add_field(to, (field) { "", f->program_offset, sizeof(void *), to == &scene_table ? SKY : FIXED, 0, 0 });
        if (f->type == GLINT_TYPE_TABLE)
            add_rows(f->parts, to);
    }
}

static int make_tables(void **unused)
{
    (void)unused;
    add_rows(glint_object_fields(GLINT_OBJECT_MATERIAL, NULL), &material_table);
    add_rows(glint_object_fields(GLINT_OBJECT_CAMERA, NULL), &camera_table);
    add_rows(glint_object_fields(GLINT_OBJECT_SCENE, NULL), &scene_table);
    add_field(&light_table, (field) FIELD(glint_light_desc, kind, FIXED, 0, 0));
    for (int k = GLINT_OBJECT_POINT_LIGHT; k <= GLINT_OBJECT_SPHERE_LIGHT; k++)
        add_rows(glint_object_fields((glint_object_kind)k, NULL), &light_table);
    add_field(&shape_table, (field) FIELD(glint_shape_desc, kind, FIXED, 0, 0));
    for (int k = GLINT_OBJECT_SPHERE; k <= GLINT_OBJECT_DIFFERENCE; k++)
        add_rows(glint_object_fields((glint_object_kind)k, NULL), &shape_table);
    return 0;
}

static const field render_fields[] = {
#define R(...) FIELD(glint_render_desc, __VA_ARGS__)
    R(width, WHOLE, 60, 75),        R(height, WHOLE, 40, 55),
    R(samples, WHOLE, 1, 4),        R(adaptive, NUMBER, 0, 0.5),
    R(max_depth, WHOLE, 0, 4),      R(precision, CHOICE, 0, 2),
    R(seed, WHOLE, 0, 2),           R(passes, BITS, 0, GLINT_PASS_COUNT),
    R(codes, FLAG, 0, 1),           R(alpha, FLAG, 0, 1),
    R(outline, CHOICE, 0, 3),       R(tone.curve, CHOICE, 0, 3),
    R(tone.transfer, CHOICE, 0, 3), R(tone.rounding, CHOICE, 0, 2),
    R(tone.bits, DEPTH, 0, 0),      R(tone.exposure, NUMBER, -2, 3),
    R(tone.dither, FLAG, 0, 1),     R(clamp, NUMBER, 0, 0.3),
    R(rays, WHOLE, 0, 3),
    R(region, REGION, 0, 0),        R(light_passes, FIXED, 0, 0), // see tests/lua for light passes
    R(derivatives, FIXED, 0, 0),    R(derivative_count, FIXED, 0, 0),
#undef R
};

/// The identity, a similarity, or a map that makes ellipsoids.
static void set_transform(glint_transform *out)
{
    const double axis[3] = { uniform(-1, 1), uniform(-1, 1), 1 }, by[3] = { uniform(0.5, 1.5), -1, uniform(0.5, 1.5) };
    const glint_transform turn = glint_transform_rotate_deg(axis, uniform(0, 360)), scale = glint_transform_scale(by);
    const uint32_t which = draw(3);
    *out = which == 0 ? glint_transform_identity() : which == 1 ? turn : glint_transform_product(&turn, &scale);
}

/// Sets a region inside the smallest frame, or none.
static void set_region(int64_t out[4])
{
    const int64_t region[4] = { draw(30), draw(20), 1 + draw(30), 1 + draw(20) };
    for (int i = 0; i < 4; i++)
        out[i] = draw(2) ? region[i] : 0;
    for (int i = 0; i < 4; i++)
        out[i] = out[2] > 0 && out[3] > 0 ? out[i] : 0;
}

#define SKIES 3 ///< number of backgrounds; the first two differ only in a number
static glint_program *skies[SKIES];

/// Backgrounds that depend on the direction's height and on its position in a panorama.
static void make_skies(void)
{
    for (int k = 0; k < SKIES; k++) {
        glint_builder *b;
        glint_value in, by, out;
        assert_int_equal(glint_builder_create(GLINT_PROGRAM_PATTERN, &b, NULL), GLINT_OK);
        glint_builder_input(b, k < 2 ? GLINT_INPUT_P_Y : GLINT_INPUT_UV_U, &in, NULL);
        glint_builder_number(b, k == 0 ? 0.5 : 0.75, &by, NULL);
        glint_builder_op(b, GLINT_OP_MUL, (const glint_value[]) { in, by }, &out, NULL);
        assert_int_equal(glint_builder_finish(b, &out, 1, &skies[k], NULL), GLINT_OK);
        glint_builder_destroy(b);
    }
}

static void set_field(const field *f, void *desc)
{
    void *at = (char *)desc + f->offset;
    double numbers[3];
    int64_t count;
    int32_t whole;
    for (int c = 0; c < 3; c++)
        numbers[c] = uniform(f->low, f->high);
    switch (f->kind) {
    case COLOR:
        random_color(numbers);
        memcpy(at, numbers, sizeof numbers);
        break;
    case VECTOR:
        memcpy(at, numbers, sizeof numbers);
        break;
    case NUMBER:
        numbers[0] = draw(5) ? numbers[0] : f->low;
        memcpy(at, numbers, sizeof *numbers);
        break;
    case WHOLE:
        count = (int64_t)f->low + draw((uint32_t)(f->high - f->low) + 1);
        memcpy(at, &count, sizeof count);
        break;
    case FLAG:
        *(bool *)at = draw(2);
        break;
    case TRANSFORM:
        set_transform(at);
        break;
    case REGION:
        set_region(at);
        break;
    case SKY:
        memcpy(at, draw(3) ? &skies[draw(SKIES)] : &(glint_program *) { NULL }, sizeof *skies);
        break;
    default:
        whole = f->kind == CHOICE  ? (int32_t)draw((uint32_t)f->high)
                : f->kind == DEPTH ? (draw(2) ? 8 : 16)
                                   : (int32_t)draw(1u << (int)f->high);
        memcpy(at, &whole, sizeof whole);
    }
}

/// Picks a random settable field.
static const field *pick(const field *fields, size_t count)
{
    const field *f;
    do
        f = &fields[draw((uint32_t)count)];
    while (f->kind == FIXED);
    return f;
}

/// The tables must name every byte of every description except padding. This check finds a field without a row; the
/// edits below check that the plan's keys include each field.
static void table_names_all(const char *what, const field *fields, size_t count, size_t size)
{
    char *named = calloc(1, size);
    assert_non_null(named);
    memset(named, 1, sizeof(size_t)); // struct_size
    for (size_t i = 0; i < count; i++)
        memset(named + fields[i].offset, 1, fields[i].size);
    for (size_t from = 0, to; from < size; from = to + 1) {
        for (to = from; to < size && !named[to]; to++)
            ;
        if (to - from >= 8)
            fail_msg("%s: bytes %zu .. %zu belong to a field that tests/engine/test_reuse.c does not edit", what, from,
                     to - 1);
    }
    free(named);
}

static void tables_name_every_field(void **unused)
{
    (void)unused;
    table_names_all("material", material_table.of, material_table.count, sizeof(glint_material_desc));
    table_names_all("light", light_table.of, light_table.count, sizeof(glint_light_desc));
    table_names_all("camera", camera_table.of, camera_table.count, sizeof(glint_camera_desc));
    table_names_all("shape", shape_table.of, shape_table.count, sizeof(glint_shape_desc));
    table_names_all("scene", scene_table.of, scene_table.count, sizeof(glint_scene_desc));
    table_names_all("render", render_fields, COUNT(render_fields), sizeof(glint_render_desc));
}

// ---- Edits: a refused value leaves the object unchanged -------------------------------------------------------------

static void edit_material(world *w)
{
    glint_material *material = w->materials[draw(SHAPES)];
    glint_material_desc d = *glint_material_get(material);
    d.struct_size = sizeof d;
    set_field(pick(material_table.of, material_table.count), &d);
    glint_material_set(material, &d, NULL);
}

static double corners[4][3] = { { -1, 5, -1 }, { 1, 5, -1 }, { 1, 5, 1 }, { -1, 5, 1 } };

static void edit_light(world *w)
{
    uint32_t i = draw(LIGHTS);
    glint_light_desc d = *glint_light_get(w->lights[i]);
    d.struct_size = sizeof d;
    if (draw(8) == 0) {
        if (w->shining[i])
            glint_scene_remove_light(w->scene, w->lights[i], NULL);
        else
            glint_scene_add_light(w->scene, w->lights[i], NULL);
        w->shining[i] = !w->shining[i];
        return;
    }
    if (d.kind == GLINT_LIGHT_POLYGON && draw(4) == 0) {
        corners[2][0] = corners[2][2] = uniform(0.5, 3);
        d.vertices = (const double(*)[3])corners;
        d.vertex_count = 3 + draw(2);
    } else {
        set_field(pick(light_table.of, light_table.count), &d);
        d.intensity = d.has_radiance ? 1 : d.intensity;
    }
    glint_light_set(w->lights[i], &d, NULL);
}

static void edit_shape(world *w)
{
    uint32_t i = draw(SHAPES);
    glint_shape *shape = w->shapes[i];
    if (glint_group_count(shape) && draw(2)) // sometimes edits a child of the group instead
        shape = glint_group_child(shape, draw((uint32_t)glint_group_count(shape)));
    glint_shape_desc d = *glint_shape_get(shape);
    d.struct_size = sizeof d;
    if (draw(6) == 0) {
        if (w->in_scene[i])
            glint_scene_remove_shape(w->scene, w->shapes[i], NULL);
        else
            glint_scene_add_shape(w->scene, w->shapes[i], NULL);
        w->in_scene[i] = !w->in_scene[i];
        return;
    }
    if (draw(5) == 0)
        d.material = w->materials[draw(SHAPES)];
    else
        set_field(pick(shape_table.of, shape_table.count), &d);
    glint_shape_set(shape, &d, NULL);
}

/// The focus must not be behind the eye: such a camera becomes a pinhole camera.
static void keep_focus(glint_camera_desc *c)
{
    const double *point = c->has_focus_point ? c->focus_point : c->at;
    double depth = 0;
    for (int k = 0; k < 3; k++)
        depth += (point[k] - c->eye[k]) * (c->has_direction ? c->direction[k] : c->at[k] - c->eye[k]);
    if (!(c->focus > 0) && (!(depth > 0) || (c->has_direction && !c->has_focus_point)))
        c->aperture = 0;
}

static void edit_frame(world *w)
{
    glint_camera_desc c = *glint_camera_get(w->camera);
    c.struct_size = sizeof c;
    glint_scene_desc s = *glint_scene_get(w->scene);
    s.struct_size = sizeof s;
    switch (draw(3)) {
    case 0:
        set_field(pick(camera_table.of, camera_table.count), &c);
        keep_focus(&c);
        break;
    case 1:
        set_field(pick(scene_table.of, scene_table.count), &s);
        break;
    default:
        set_field(pick(render_fields, COUNT(render_fields)), &w->render);
    }
    glint_camera_set(w->camera, &c, NULL);
    glint_scene_set(w->scene, &s, NULL);
}

static glint_shape *new_mesh(const glint_shape_desc *like)
{
    glint_mesh_desc d = glint_mesh_desc_default();
    glint_shape *shape = NULL;
    d.material = like->material;
    d.has_shading = true;
    d.shading = GLINT_SHADING_GOURAUD;
    assert_int_equal(glint_sphere_mesh_create(like->center, 1.5, 9, &d, &shape, NULL), GLINT_OK);
    return shape;
}

/// Makes a group with every solid, and with a smaller copy of all of them.
static glint_shape *new_group(const glint_shape_desc *like)
{
    glint_shape *outer, *inner, *part;
    const double by[3] = { -1, 0.5, 0.5 };
    glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_GROUP);
    assert_int_equal(glint_shape_create(&d, &outer, NULL), GLINT_OK);
    d.transform = glint_transform_scale(by);
    assert_int_equal(glint_shape_create(&d, &inner, NULL), GLINT_OK);
    for (int k = GLINT_SHAPE_BOX; k <= GLINT_SHAPE_TORUS; k++) {
        d = glint_shape_desc_default((glint_shape_kind)k);
        d.material = like->material;
        d.radius = 0.5;
        d.base[0] = d.center[2] = k;
        assert_int_equal(glint_shape_create(&d, &part, NULL), GLINT_OK);
        assert_int_equal(glint_group_add(outer, part, NULL), GLINT_OK);
        assert_int_equal(glint_group_add(inner, part, NULL), GLINT_OK);
        glint_shape_release(part);
    }
    assert_int_equal(glint_group_add(outer, inner, NULL), GLINT_OK);
    glint_shape_release(inner);
    return outer;
}

/// Makes a box minus a cylinder and minus the intersection of a ball and a half-space.
static glint_shape *new_combined(const glint_shape_desc *like)
{
    static const glint_shape_kind kinds[] = { GLINT_SHAPE_BOX, GLINT_SHAPE_CYLINDER, GLINT_SHAPE_SPHERE, GLINT_SHAPE_PLANE };
    glint_shape *outer, *inner, *part;
    glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_DIFFERENCE);
    d.material = like->material;
    assert_int_equal(glint_shape_create(&d, &outer, NULL), GLINT_OK);
    d = glint_shape_desc_default(GLINT_SHAPE_INTERSECTION);
    assert_int_equal(glint_shape_create(&d, &inner, NULL), GLINT_OK);
    for (int k = 0; k < 4; k++) {
        d = glint_shape_desc_default(kinds[k]);
        d.material = k == 1 ? like->material : NULL;
        d.radius = 0.8;
        assert_int_equal(glint_shape_create(&d, &part, NULL), GLINT_OK);
        assert_int_equal(glint_group_add(k < 2 ? outer : inner, part, NULL), GLINT_OK);
        glint_shape_release(part);
    }
    assert_int_equal(glint_group_add(outer, inner, NULL), GLINT_OK);
    glint_shape_release(inner);
    return outer;
}

/// Makes a material a metal, a rough mirror or rough glass.
static void make_rough(glint_material_desc *m)
{
    m->model = draw(2) ? GLINT_MODEL_COOK_TORRANCE : m->model;
    m->distribution = draw(2) ? GLINT_DISTRIBUTION_BECKMANN : GLINT_DISTRIBUTION_GGX;
    m->has_roughness = true;
    m->roughness = uniform(0, 1);
    if (draw(2))
        random_color(m->transmission);
    else if (draw(2))
        random_color(m->mirror);
    m->fresnel = draw(2);
}

static void make_world(world *w)
{
    memset(w, 0, sizeof *w);
    make_skies();
    glint_camera_desc c = glint_camera_desc_default();
    c.eye[1] = 2;
    c.w = c.h = 40; // w and h must be set together
    assert_int_equal(glint_camera_create(&c, &w->camera, NULL), GLINT_OK);
    assert_int_equal(glint_scene_create(&w->scene, NULL), GLINT_OK);
    glint_scene_desc s = { .struct_size = sizeof(glint_scene_desc),
        .camera = w->camera, .ambient = { 0.1, 0.1, 0.1 }, .indirect_samples = 2, .indirect_bounces = 2,
        .ambient_occlusion_samples = 2, .ambient_occlusion_distance = 3, .reflection_samples = 2
    };
    assert_int_equal(glint_scene_set(w->scene, &s, NULL), GLINT_OK);
    for (int i = 0; i < SHAPES; i++) {
        glint_material_desc m = glint_material_desc_default();
        random_color(m.diffuse);
        random_color(m.specular);
        if (draw(3) == 0)
            make_rough(&m);
        assert_int_equal(glint_material_create(&m, &w->materials[i], NULL), GLINT_OK);
        glint_shape_desc d = glint_shape_desc_default(i == 0 ? GLINT_SHAPE_PLANE : GLINT_SHAPE_SPHERE);
        d.material = w->materials[i];
        d.point[1] = -2;
        for (int k = 0; k < 3; k++)
            d.center[k] = uniform(-2, 2);
        w->shapes[i] = i == 1 ? new_mesh(&d) : i == 2 ? new_group(&d) : i == 3 ? new_combined(&d) : NULL;
        if (!w->shapes[i])
            assert_int_equal(glint_shape_create(&d, &w->shapes[i], NULL), GLINT_OK);
        assert_int_equal(glint_scene_add_shape(w->scene, w->shapes[i], NULL), GLINT_OK);
        w->in_scene[i] = true;
    }
    for (int i = 0; i < LIGHTS; i++) {
        glint_light_desc d = glint_light_desc_default((glint_light_kind)i);
        d.vertices = (const double(*)[3])corners;
        d.vertex_count = 4;
        d.samples = 3;
        d.position[1] = 5;
        d.position[0] = i;
        assert_int_equal(glint_light_create(&d, &w->lights[i], NULL), GLINT_OK);
        assert_int_equal(glint_scene_add_light(w->scene, w->lights[i], NULL), GLINT_OK);
        w->shining[i] = true;
    }
    w->render = glint_render_desc_default();
    w->render.width = 70;
    w->render.height = 50;
}

static void free_world(world *w)
{
    for (int i = 0; i < SKIES; i++)
        glint_program_release(skies[i]);
    for (int i = 0; i < SHAPES; i++) {
        glint_material_release(w->materials[i]);
        glint_shape_release(w->shapes[i]);
    }
    for (int i = 0; i < LIGHTS; i++)
        glint_light_release(w->lights[i]);
    glint_camera_release(w->camera);
    glint_scene_release(w->scene);
}

static bool same_pixels(const glint_image *a, const glint_image *b, uint32_t passes)
{
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++) {
        if (!(passes >> pass & 1))
            continue;
        for (int y = 0; y < glint_image_height(a); y++)
            for (int x = 0; x < glint_image_width(a); x++) {
                float p[3], q[3];
                glint_image_pixel(a, (glint_pass)pass, x, y, p, NULL);
                glint_image_pixel(b, (glint_pass)pass, x, y, q, NULL);
                if (memcmp(p, q, sizeof p))
                    return false;
            }
    }
    return true;
}

static bool same_codes(const glint_image *a, const glint_image *b)
{
    if (!a->codes || !b->codes)
        return a->codes == b->codes;
    return a->channels == b->channels &&
           memcmp(a->codes, b->codes, (size_t)a->width * (size_t)a->height * glint_image_pixel_bytes(a)) == 0;
}

/// Returns whether rows of tiles with equal stamps hold equal pixel values.
static bool stamps_hold(const glint_image *a, const glint_image *b)
{
    if (!a->codes || !b->codes || a->width != b->width || a->height != b->height || a->channels != b->channels ||
        memcmp(&a->code_tone, &b->code_tone, sizeof a->code_tone))
        return true;
    const size_t row = (size_t)a->width * glint_image_pixel_bytes(a);
    for (size_t i = 0; i < glint_image_stamps(a); i++) {
        const size_t from = i * GLINT_TILE_HEIGHT, rest = (size_t)a->height - from;
        const size_t rows = rest < GLINT_TILE_HEIGHT ? rest : GLINT_TILE_HEIGHT;
        if (a->row_stamp[i] && a->row_stamp[i] == b->row_stamp[i] &&
            memcmp((char *)a->codes + from * row, (char *)b->codes + from * row, rows * row))
            return false;
    }
    return true;
}

/// Creates a renderer that reuses results as `desc` says, and one that reuses nothing.
static void open_both(glint_renderer_desc desc, glint_renderer *both[2])
{
    for (int i = 0; i < 2; i++) {
        desc.no_reuse = i;
        assert_int_equal(glint_renderer_create(&desc, &both[i], NULL), GLINT_OK);
    }
}

static void clear_terminators(glint_shape *shape)
{
    glint_shape_desc d = *glint_shape_get(shape);
    d.struct_size = sizeof d;
    d.terminator = 0;
    glint_shape_set(shape, &d, NULL);
    for (size_t i = 0; i < glint_group_count(shape); i++)
        clear_terminators(glint_group_child(shape, i));
}

/// Plans a frame. Frames refuse a terminator on a material that light passes through: then no shape has one.
static glint_plan *plan_frame(const world *w)
{
    glint_plan *plan = NULL;
    glint_error error = { 0 };
    glint_status status = glint_plan_create(w->scene, &w->render, &plan, &error);
    if (status && strstr(error.message, ".terminator: expected 0")) {
        for (int i = 0; i < SHAPES; i++)
            clear_terminators(w->shapes[i]);
        status = glint_plan_create(w->scene, &w->render, &plan, &error);
    }
    if (status)
        fail_msg("%s", error.message);
    return plan;
}

/// Renders a frame with both renderers, which must give the same picture. *stats, unless NULL, gets the statistics of
/// the first renderer.
static void render_both(const world *w, glint_renderer *const both[2], glint_frame_stats *stats, int frame)
{
    glint_plan *plan = plan_frame(w);
    glint_image *image[2];
    for (int i = 0; i < 2; i++)
        assert_int_equal(glint_render(both[i], plan, &image[i], i ? NULL : stats, NULL), GLINT_OK);
    if (!same_pixels(image[0], image[1], w->render.passes) || !same_codes(image[0], image[1]))
        fail_msg("frame %d: the reused frame differs from the fresh one", frame);
    for (int i = 0; i < 2; i++)
        glint_image_release(image[i]);
    glint_plan_destroy(plan);
}

static void close_both(glint_renderer *const both[2])
{
    for (int i = 0; i < 2; i++)
        glint_renderer_destroy(both[i]);
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

/// Renders after each of `count` edits (fewer where a test takes every n-th case) with two renderers, one of which
/// reuses nothing. adaptive: most frames take all samples only for some pixels. is_eager: hits are cached from the
/// first frame on.
static void edits(size_t memory, int threads, bool adaptive, bool is_eager, uint64_t count)
{
    world w;
    glint_renderer *reusing, *fresh;
    glint_renderer_desc desc = glint_renderer_desc_default();
    desc.threads = threads;
    desc.reuse_memory = memory;
    assert_int_equal(glint_renderer_create(&desc, &reusing, NULL), GLINT_OK);
    if (is_eager)
        glint_renderer_cache_hits(reusing);
    desc.no_reuse = true;
    assert_int_equal(glint_renderer_create(&desc, &fresh, NULL), GLINT_OK);
    make_world(&w);
    const char *soak = getenv("GLINT_SOAK_SECONDS"); // as many edits as a twentieth of this time allows
    const double end = soak ? seconds() + atof(soak) / 20 : 0;
    uint64_t reused = 0, edit = 0;
    glint_image *last = NULL; ///< a retained picture, into which the renderer must not write again
    void (*const kinds[])(world *) = { edit_material, edit_material, edit_light, edit_light, edit_shape, edit_frame };
    for (count = (count - 1) / case_step() + 1; soak ? seconds() < end : edit < count; edit++) {
        if (draw(8)) // sometimes nothing changes
            kinds[draw(edit % 4 ? 4 : 6)](&w);
        if (adaptive) {
            w.render.adaptive = edit / 16 % 4 == 3 ? 0 : edit / 64 % 2 ? 0.02 : 0.2;
            w.render.samples = w.render.samples > 1 ? w.render.samples : 3;
        }
        glint_plan *plan = plan_frame(&w);
        glint_image *a, *b;
        glint_frame_stats stats;
        assert_int_equal(glint_render(reusing, plan, &a, &stats, NULL), GLINT_OK);
        assert_int_equal(glint_render(fresh, plan, &b, NULL, NULL), GLINT_OK);
        for (int i = 0; i < stats.stage_count; i++)
            reused += stats.stage_reused[i] > 0;
        if (!same_pixels(a, b, w.render.passes) || !same_codes(a, b))
            fail_msg("edit %llu: the reused frame differs from the fresh one", (unsigned long long)edit);
        if (last && !stamps_hold(last, a))
            fail_msg("edit %llu: equal stamps, other codes", (unsigned long long)edit);
        glint_image_release(last);
        last = a;
        glint_image_release(b);
        glint_plan_destroy(plan);
    }
    print_message("%llu edits, %llu stage results reused\n", (unsigned long long)edit, (unsigned long long)reused);
    assert_true(soak || memory > 0 || reused > edit / 2);
    glint_image_release(last);
    free_world(&w);
    glint_renderer_destroy(reusing);
    glint_renderer_destroy(fresh);
}

/// Returns a separate seed for each test. `make soak` uses other seeds than `make check`.
static uint64_t seed(uint64_t test)
{
    const char *other = getenv("GLINT_SEED");
    return test + (other ? 1000 * strtoull(other, NULL, 10) : 0);
}

static void reused_equals_fresh(void **unused)
{
    (void)unused;
    state = seed(1);
    edits(0, 2, false, false, 150);
    state = seed(5);
    edits(0, 2, false, true, 120);
}

static void reused_equals_fresh_of_chosen_pixels(void **unused)
{
    (void)unused;
    state = seed(4);
    edits(0, 2, true, false, 80);
    state = seed(6);
    edits(0, 2, true, true, 120);
    state = seed(7);
    edits(1000000, 2, true, false, 12);
}

static void reused_equals_fresh_without_memory(void **unused)
{
    (void)unused;
    state = seed(2);
    edits(1, 2, false, true, 25);
}

static void reused_equals_fresh_with_little_memory(void **unused)
{
    (void)unused;
    state = seed(3);
    for (size_t memory = 20000; memory < 4000000; memory = memory * 3 / 2)
        edits(memory, 8, false, memory > 200000, 8);
}

/// Draws values for a field until one differs from its current value, at most 20 times.
static void set_other(const field *f, void *desc)
{
    char before[sizeof(glint_transform)];
    assert_true(f->size <= sizeof before);
    memcpy(before, (char *)desc + f->offset, f->size);
    for (int i = 0; i < 20 && memcmp(before, (char *)desc + f->offset, f->size) == 0; i++)
        set_field(f, desc);
}

/// Makes a mirror, clear glass, a metal, rough glass and a translucent material, visible lamps, indirect light and, if
/// `open`, a background by a program.
static void show_everything(world *w, bool open)
{
    for (int i = 2; i < SHAPES; i++) {
        glint_material_desc m = glint_material_desc_default();
        for (int c = 0; c < 3; c++) {
            m.specular[c] = 0.3;
            m.has_mirror = i == 2;
            m.mirror[c] = i == 2 ? 0.5 : 0;
            m.transmission[c] = i == 3 || i == 5 ? 0.8 : 0;
            m.absorption[c] = i == 3 ? 0.1 : 0;
        }
        m.model = i == 4 ? GLINT_MODEL_COOK_TORRANCE : i == 6 ? GLINT_MODEL_BLINN_PHONG : GLINT_MODEL_PHONG;
        m.fresnel = i == 3;
        m.has_roughness = i == 4 || i == 5;
        m.has_f0 = i == 4;
        m.opacity = i == 6 ? 0.5 : 1;
        assert_int_equal(glint_material_set(w->materials[i], &m, NULL), GLINT_OK);
    }
    for (int i = 0; i < LIGHTS; i++) {
        glint_light_desc d = *glint_light_get(w->lights[i]);
        d.struct_size = sizeof d;
        d.visible = d.kind == GLINT_LIGHT_SPHERE || d.kind == GLINT_LIGHT_POLYGON;
        d.radius = d.kind == GLINT_LIGHT_SPHERE ? 0.5 : d.radius;
        d.position[2] = d.kind == GLINT_LIGHT_SPHERE ? -3 : d.position[2];
        d.position[1] = d.kind == GLINT_LIGHT_SPHERE ? 2 : d.position[1];
        assert_int_equal(glint_light_set(w->lights[i], &d, NULL), GLINT_OK);
    }
    glint_scene_desc s = *glint_scene_get(w->scene);
    s.struct_size = sizeof s;
    s.background_program = open ? skies[0] : NULL;
    s.has_indirect = true;
    assert_int_equal(glint_scene_set(w->scene, &s, NULL), GLINT_OK);
    w->render.width = 40;
    w->render.height = 24;
    w->render.max_depth = 3;
    w->render.codes = true;
    w->render.alpha = open;
}

/// Sets a field of all objects of its kind, or of the frame, to new values. Returns whether any object took its value.
static bool set_everywhere(world *w, const table *of, const field *f)
{
    bool taken = false;
#define SET(type, object) \
    do { \
        glint_##type##_desc d = *glint_##type##_get(object); \
        d.struct_size = sizeof d; \
        set_other(f, &d); \
        taken |= glint_##type##_set(object, &d, NULL) == GLINT_OK; \
    } while (0)
    for (int i = 0; i < SHAPES && of == &material_table; i++)
        SET(material, w->materials[i]);
    for (int i = 0; i < LIGHTS && of == &light_table; i++)
        SET(light, w->lights[i]);
    for (int i = 0; i < SHAPES && of == &shape_table; i++) {
        SET(shape, w->shapes[i]);
        const bool group = glint_shape_get(w->shapes[i])->kind == GLINT_SHAPE_GROUP; // the parts of others must stay closed
        for (size_t k = 0; group && k < glint_group_count(w->shapes[i]); k++)
            SET(shape, glint_group_child(w->shapes[i], k));
    }
    if (of == &scene_table)
        SET(scene, w->scene);
#undef SET
    if (of == &camera_table) {
        glint_camera_desc c = *glint_camera_get(w->camera);
        c.struct_size = sizeof c;
        set_other(f, &c);
        keep_focus(&c);
        taken = glint_camera_set(w->camera, &c, NULL) == GLINT_OK;
    }
    if (!of)
        set_other(f, &w->render);
    return taken || !of;
}

/// Renders a frame three times, so that its results are cached, and then edits one field, twice. If a key lacks the
/// field, a wrong result is reused.
static void each_field_alone(void **unused)
{
    (void)unused;
    const table *const tables[] = { &material_table, &light_table, &camera_table, &shape_table, &scene_table, NULL };
    uint32_t count = 0, taken = 0;
    glint_renderer_desc desc = glint_renderer_desc_default();
    desc.threads = 2;
    for (size_t t = 0; t < COUNT(tables); t++) {
        const field *fields = tables[t] ? tables[t]->of : render_fields;
        const size_t end = tables[t] ? tables[t]->count : COUNT(render_fields);
        for (size_t i = 0; i < end; i++) {
            world w;
            glint_renderer *both[2];
            if (fields[i].kind == FIXED || count++ % case_step())
                continue;
            state = seed(100 + count);
            make_world(&w);
            show_everything(&w, count % 2);
            open_both(desc, both);
            for (int frame = 0; frame < 3; frame++)
                render_both(&w, both, NULL, frame);
            for (int edit = 0; edit < 2; edit++) {
                taken += set_everywhere(&w, tables[t], &fields[i]);
                render_both(&w, both, NULL, 3 + edit);
            }
            free_world(&w);
            close_both(both);
        }
    }
    print_message("%u of %u edits were accepted\n", taken, 2 * count);
    assert_true(taken * case_step() > count);
}

/// Each call of shade sums a chunk of an area light's samples. An earlier light inside a closed ball reaches nothing
/// visible, but shifts the start of these chunks.
static void a_lamp_that_reaches_nothing(void **unused)
{
    (void)unused;
    world w;
    glint_renderer *reusing, *fresh;
    glint_renderer_desc desc = glint_renderer_desc_default();
    assert_int_equal(glint_renderer_create(&desc, &reusing, NULL), GLINT_OK);
    desc.no_reuse = true;
    assert_int_equal(glint_renderer_create(&desc, &fresh, NULL), GLINT_OK);
    state = 5;
    make_world(&w);
    for (int i = 0; i < LIGHTS; i++)
        if (w.shining[i])
            glint_scene_remove_light(w.scene, w.lights[i], NULL);
    glint_shape_desc ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    glint_light_desc inner = glint_light_desc_default(GLINT_LIGHT_POINT);
    glint_light_desc outer = glint_light_desc_default(GLINT_LIGHT_SPHERE);
    ball.center[0] = inner.position[0] = 3;
    outer.position[1] = 6;
    outer.radius = 2;
    outer.samples = 20;
    glint_shape *shape;
    glint_light *hidden, *lamp;
    assert_int_equal(glint_shape_create(&ball, &shape, NULL), GLINT_OK);
    assert_int_equal(glint_light_create(&inner, &hidden, NULL), GLINT_OK);
    assert_int_equal(glint_light_create(&outer, &lamp, NULL), GLINT_OK);
    glint_scene_add_shape(w.scene, shape, NULL);
    for (int frame = 0; frame < 12; frame++) {
        const bool both = frame / 3 % 2;
        glint_plan *plan;
        glint_image *a, *b;
        glint_material_desc paint = *glint_material_get(w.materials[1]);
        paint.struct_size = sizeof paint;
        paint.diffuse[0] = frame / 12.0; // the colour of some tiles changes, the others stay the same
        glint_material_set(w.materials[1], &paint, NULL);
        if (both)
            glint_scene_add_light(w.scene, hidden, NULL);
        glint_scene_add_light(w.scene, lamp, NULL);
        assert_int_equal(glint_plan_create(w.scene, &w.render, &plan, NULL), GLINT_OK);
        assert_int_equal(glint_render(reusing, plan, &a, NULL, NULL), GLINT_OK);
        assert_int_equal(glint_render(fresh, plan, &b, NULL, NULL), GLINT_OK);
        if (!same_pixels(a, b, w.render.passes))
            fail_msg("frame %d: the reused frame differs from the fresh one", frame);
        glint_image_release(a);
        glint_image_release(b);
        glint_plan_destroy(plan);
        glint_scene_remove_light(w.scene, lamp, NULL);
        if (both)
            glint_scene_remove_light(w.scene, hidden, NULL);
    }
    glint_shape_release(shape);
    glint_light_release(hidden);
    glint_light_release(lamp);
    free_world(&w);
    glint_renderer_destroy(reusing);
    glint_renderer_destroy(fresh);
}

/// Changes one or two of a light's position, a ball's position and a colour, each among a few values, and whether
/// there is a second light.
static void go_back(world *w)
{
    glint_material_desc paint = *glint_material_get(w->materials[1]);
    paint.struct_size = sizeof paint;
    glint_shape_desc place = *glint_shape_get(w->shapes[4]);
    place.struct_size = sizeof place;
    glint_light_desc lamp = *glint_light_get(w->lights[0]);
    lamp.struct_size = sizeof lamp;
    for (uint32_t left = 1 + draw(2); left > 0; left--) {
        const uint32_t what = draw(5), value = draw(2);
        if (what == 4) {
            w->shining[1] = !w->shining[1];
            assert_int_equal((w->shining[1] ? glint_scene_add_light : glint_scene_remove_light)(w->scene, w->lights[1], NULL),
                             GLINT_OK);
        } else if (what == 0)
            place.center[1] = 0.5 * value;
        else if (what == 1)
            lamp.position[0] = 4.0 * value;
        else
            paint.diffuse[0] = 0.9 * value;
    }
    assert_int_equal(glint_material_set(w->materials[1], &paint, NULL), GLINT_OK);
    assert_int_equal(glint_light_set(w->lights[0], &lamp, NULL), GLINT_OK);
    assert_int_equal(glint_shape_set(w->shapes[4], &place, NULL), GLINT_OK);
}

/// Renders frames in which a few positions and colours return in any order. A result that is still in its slot is used
/// again, and must fit the frame.
static void frames_that_come_back(void **unused)
{
    (void)unused;
    for (int round = 0; round < 6; round++) {
        world w;
        glint_renderer *both[2];
        open_both(glint_renderer_desc_default(), both);
        state = 700 + (uint64_t)round;
        make_world(&w);
        for (int i = 1; i < LIGHTS && round >= 2; i++) { // with a single light, edits hardly change the chosen pixels
            assert_int_equal(glint_scene_remove_light(w.scene, w.lights[i], NULL), GLINT_OK);
            w.shining[i] = false;
        }
        w.render.samples = 4;
        w.render.adaptive = round % 2 ? 0.03 : 0.3;
        w.render.codes = round % 3 < 2;
        for (int frame = 0; frame < 60 / (int)case_step(); frame++) {
            go_back(&w);
            render_both(&w, both, NULL, frame);
        }
        free_world(&w);
        close_both(both);
    }
}

static double reused_share(const glint_frame_stats *stats, const char *stage)
{
    for (int i = 0; i < stats->stage_count; i++)
        if (strcmp(stats->stage_name[i], stage) == 0)
            return stats->stage_reused[i];
    fail_msg("no stage %s", stage);
    return 0;
}

/// Sweeps the shininess of a ball that is lit from the side. Only the few tiles with the highlight run again. When
/// the exponent is so low that the highlight covers all lit tiles, the other lit tiles run too. `adaptive` is the
/// threshold, with four samples per pixel, where the first frame caches no base; 0: off.
static void sweep_shininess(double adaptive)
{
    static const double shininess[] = { 2000, 2500, 3000, 1, 2 };
    glint_scene *scene;
    glint_camera *camera;
    glint_shape *ball;
    glint_light *lamp;
    glint_material *paint;
    glint_renderer *renderers[2];
    glint_shape_desc place = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_DIRECTIONAL);
    glint_material_desc look = glint_material_desc_default();
    glint_renderer_desc desc = glint_renderer_desc_default();
    glint_render_desc render = glint_render_desc_default();
    glint_camera_desc view = glint_camera_desc_default();
    view.eye[2] = 4;
    for (int c = 0; c < 3; c++) {
        view.at[c] = 0;
        light.direction[c] = -1;
        look.specular[c] = 1;
    }
    render.width = render.height = 480;
    render.codes = true;
    render.adaptive = adaptive;
    render.samples = adaptive > 0 ? 4 : 1;
    assert_int_equal(glint_scene_create(&scene, NULL), GLINT_OK);
    assert_int_equal(glint_camera_create(&view, &camera, NULL), GLINT_OK);
    assert_int_equal(glint_light_create(&light, &lamp, NULL), GLINT_OK);
    assert_int_equal(glint_material_create(&look, &paint, NULL), GLINT_OK);
    place.material = paint;
    assert_int_equal(glint_shape_create(&place, &ball, NULL), GLINT_OK);
    glint_scene_desc whole = *glint_scene_get(scene);
    whole.struct_size = sizeof whole;
    whole.camera = camera;
    assert_int_equal(glint_scene_set(scene, &whole, NULL), GLINT_OK);
    glint_scene_add_shape(scene, ball, NULL);
    glint_scene_add_light(scene, lamp, NULL);
    for (int i = 0; i < 2; i++) {
        desc.no_reuse = i;
        assert_int_equal(glint_renderer_create(&desc, &renderers[i], NULL), GLINT_OK);
    }
    for (int frame = 0; frame < 5; frame++) {
        glint_plan *plan;
        glint_image *image[2];
        glint_frame_stats stats;
        look.shininess = shininess[frame];
        assert_int_equal(glint_material_set(paint, &look, NULL), GLINT_OK);
        assert_int_equal(glint_plan_create(scene, &render, &plan, NULL), GLINT_OK);
        assert_int_equal(glint_render(renderers[1], plan, &image[1], NULL, NULL), GLINT_OK);
        assert_int_equal(glint_render(renderers[0], plan, &image[0], &stats, NULL), GLINT_OK);
        const double share = reused_share(&stats, "shade");
        if (frame == 2 || (frame == 1 && adaptive == 0))
            assert_true(share > 0.95 && share < 1);
        if (frame == 4)
            assert_true(share < 0.8);
        assert_true(same_pixels(image[0], image[1], render.passes));
        for (int i = 0; i < 2; i++)
            glint_image_release(image[i]);
        glint_plan_destroy(plan);
    }
    for (int i = 0; i < 2; i++)
        glint_renderer_destroy(renderers[i]);
    glint_material_release(paint);
    glint_light_release(lamp);
    glint_shape_release(ball);
    glint_camera_release(camera);
    glint_scene_release(scene);
}

static void a_highlight_that_a_tile_does_not_show(void **unused)
{
    (void)unused;
    sweep_shininess(0);
    sweep_shininess(0.1);
}

/// Moves a light over several frames: hits are reused, and the pictures equal a fresh renderer's.
/// adaptive: the threshold, with four samples per pixel; 0: off. is_eager: hits are cached from the first frame on.
static void move_the_light(double adaptive, bool is_eager, int frames, glint_frame_stats *stats)
{
    world w;
    glint_renderer *both[2];
    glint_renderer_desc desc = glint_renderer_desc_default();
    open_both(desc, both);
    state = 6;
    make_world(&w);
    for (int i = 0; i < SHAPES; i++) { // without mirrors and glass
        glint_material_desc m = glint_material_desc_default();
        glint_material_set(w.materials[i], &m, NULL);
    }
    w.render.adaptive = adaptive;
    w.render.samples = adaptive > 0 ? 4 : w.render.samples;
    if (is_eager)
        glint_renderer_cache_hits(both[0]);
    for (int frame = 0; frame < frames; frame++) {
        glint_light_desc lamp = *glint_light_get(w.lights[0]);
        lamp.struct_size = sizeof lamp;
        lamp.position[0] = lamp.direction[0] = 0.01 * frame;
        assert_int_equal(glint_light_set(w.lights[0], &lamp, NULL), GLINT_OK);
        render_both(&w, both, stats, frame);
    }
    free_world(&w);
    close_both(both);
}

static void hits_under_a_moved_light_are_kept(void **unused)
{
    (void)unused;
    glint_frame_stats stats;
    move_the_light(0, false, 5, &stats);
    assert_true(reused_share(&stats, "cast") == 1);
    move_the_light(0, false, 2, &stats);
    assert_true(reused_share(&stats, "cast") == 0);
    move_the_light(0, true, 2, &stats);
    assert_true(reused_share(&stats, "cast") == 1);
    move_the_light(0.1, false, 9, &stats); // this run reuses the hits of the first sample of each pixel
    assert_true(reused_share(&stats, "cast") > 0);
}

/// The key of a picture is that of `refine`, and `depth_cue` adds up the light anew.
static void stages_that_scale_light_stand_between_depth_cue_and_refine(void **unused)
{
    (void)unused;
    for (int id = 0; id < GLINT_STAGE_COUNT; id++) {
        const glint_stage *stage = glint_stage_table[id];
        assert_true(!stage->scales || (id >= GLINT_STAGE_DEPTH_CUE && id < GLINT_STAGE_ADAPTIVE && stage->own));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_name_every_field),
        cmocka_unit_test(stages_that_scale_light_stand_between_depth_cue_and_refine),
        cmocka_unit_test(a_lamp_that_reaches_nothing),
        cmocka_unit_test(frames_that_come_back),
        cmocka_unit_test(a_highlight_that_a_tile_does_not_show),
        cmocka_unit_test(hits_under_a_moved_light_are_kept),
        cmocka_unit_test(each_field_alone),
        cmocka_unit_test(reused_equals_fresh),
        cmocka_unit_test(reused_equals_fresh_of_chosen_pixels),
        cmocka_unit_test(reused_equals_fresh_without_memory),
        cmocka_unit_test(reused_equals_fresh_with_little_memory),
    };
    return cmocka_run_group_tests(tests, make_tables, NULL);
}
