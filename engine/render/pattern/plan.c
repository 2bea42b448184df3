#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/effects/environment/plan.h"
#include "engine/render/plan/plan.h"
#include "engine/render/program/program.h"
#include "engine/render/scene/fields.h"

#include <stdlib.h>

// ---- A material's programs ----

#define PROGRAM(field, member) [GLINT_FIELD_##field] = offsetof(glint_material_desc, program.member)

/// The offsets of programs in the descriptions of materials.
static const size_t program_offsets[GLINT_FIELD_COUNT] = {
    PROGRAM(DIFFUSE, diffuse),     PROGRAM(AMBIENT, ambient),     PROGRAM(REST, ambient), PROGRAM(SPECULAR, specular),
    PROGRAM(MIRROR, mirror),       PROGRAM(TRANSMISSION, transmission), PROGRAM(SHININESS, shininess),
    PROGRAM(ROUGHNESS, roughness), PROGRAM(BUMP, bump),           PROGRAM(OPACITY, opacity), PROGRAM(CLEAR, opacity),   PROGRAM(SHADER, shader),
};

const char *glint_field_name(int field)
{
    for (const glint_object_field *f = glint_material_fields; f->name && field < GLINT_FIELD_COUNT; f++)
        if (f->program_offset == program_offsets[field])
            return f->name;
    return "background";
}

const glint_program *glint_pattern_program_of(const glint_material_desc *desc, int field)
{
    return field == GLINT_FIELD_REST || field == GLINT_FIELD_CLEAR ? NULL : *(glint_program *const *)(const void *)((const char *)desc + program_offsets[field]);
}

/// Returns whether the material's model reads a field.
static bool is_read(const glint_material_desc *desc, int field)
{
    const bool facets = desc->model == GLINT_MODEL_COOK_TORRANCE, shader = desc->program.shader;
    const bool shiny = shader || glint_material_is_shiny(desc);
    switch (field) {
    case GLINT_FIELD_SPECULAR:
        return shiny;
    case GLINT_FIELD_SHININESS:
        return shiny && (shader || !facets);
    case GLINT_FIELD_ROUGHNESS:
        return (shiny && !shader && facets) || glint_material_mirrors(desc) || glint_material_transmits(desc);
    default:
        return true;
    }
}

/// Returns the fields that have planes.
static uint32_t made_by(const glint_plan_pattern *pattern, bool indirect)
{
    const glint_material_desc *desc = &pattern->desc;
    uint32_t made = 0;
    for (int field = 0; field < GLINT_FIELD_COUNT; field++)
        made |= pattern->program[field] ? 1u << field : 0;
    if (made >> GLINT_FIELD_SHININESS & 1 && desc->normalized && !pattern->program[GLINT_FIELD_SHADER])
        made |= 1u << GLINT_FIELD_SPECULAR; // its factor depends on the exponent
    if (pattern->program[GLINT_FIELD_AMBIENT])
        made |= indirect ? 1u << GLINT_FIELD_REST : 0;
    else if (made >> GLINT_FIELD_DIFFUSE & 1 && indirect && !pattern->ambient_follows)
        made |= 1u << GLINT_FIELD_AMBIENT;
    return made;
}

/// Hashes the fields that are read in addition to the programs: by derived planes and by shaders.
static glint_key numbers_key(const glint_plan_pattern *pattern)
{
    const glint_material_desc *desc = &pattern->desc;
    const double kind[] = { desc->model, desc->matched, desc->normalized, pattern->ambient_follows, pattern->made };
    glint_key key = glint_key_add((glint_key) { 0 }, kind, sizeof kind);
    if (pattern->program[GLINT_FIELD_SHADER] || pattern->made >> GLINT_FIELD_SHININESS & 1)
        key = glint_key_add(key, desc->specular, sizeof desc->specular);
    if (pattern->program[GLINT_FIELD_SHADER] || pattern->made >> GLINT_FIELD_REST & 1)
        key = glint_key_add(key, desc->diffuse, sizeof desc->diffuse);
    if (pattern->program[GLINT_FIELD_SHADER])
        key = glint_key_add(key, &desc->shininess, sizeof desc->shininess);
    return pattern->made >> GLINT_FIELD_AMBIENT & 1 ? glint_key_add(key, desc->ambient, sizeof desc->ambient) : key;
}

/// Makes the derivatives of a bump by p, by the world point and, if it reads them, by u and v.
static glint_status find_slope(glint_plan_patterns *patterns, glint_plan_pattern *pattern, glint_error *error)
{
    static const glint_input by[] = { GLINT_INPUT_P_X,     GLINT_INPUT_P_Y,     GLINT_INPUT_P_Z,  GLINT_INPUT_WORLD_X,
                                      GLINT_INPUT_WORLD_Y, GLINT_INPUT_WORLD_Z, GLINT_INPUT_UV_U, GLINT_INPUT_UV_V };
    const glint_program *bump = pattern->program[GLINT_FIELD_BUMP];
    if (!bump)
        return GLINT_OK;
    const size_t count = sizeof by / sizeof *by - (bump->inputs & GLINT_READS_UV ? 0 : 2);
    glint_status status = glint_program_slope(bump, by, count, &pattern->slope, error);
    if (!status && pattern->slope->code.row_count > patterns->row_count)
        patterns->row_count = pattern->slope->code.row_count;
    return status;
}

/// Returns the program of a field of material number i. NULL: none.
static const glint_program *program_of(const glint_plan *plan, size_t i, int field)
{
    if (field == GLINT_FIELD_CLEAR)
        return plan->translucent ? plan->translucent[i].program : NULL;
    return glint_pattern_program_of(glint_plan_material(plan, i), field);
}

static void add_material(const glint_plan *plan, size_t i, bool indirect)
{
    glint_plan_patterns *patterns = plan->patterns;
    glint_plan_pattern *pattern = &patterns->of[i];
    const glint_material_desc *desc = glint_plan_material(plan, i);
    pattern->desc = *desc;
    glint_material_desc_resolve(&pattern->desc);
    pattern->ambient_follows = !desc->has_ambient && !desc->program.ambient;
    for (int c = 0; c < 3; c++)
        pattern->desc.diffuse[c] = desc->program.diffuse ? 1 : fmin(desc->diffuse[c], GLINT_STRENGTH_MAX);
    for (int field = 0; field < GLINT_FIELD_COUNT; field++) {
        const glint_program *program = program_of(plan, i, field);
        if (!program || !is_read(desc, field))
            continue;
        pattern->program[field] = glint_program_retain((glint_program *)program);
        pattern->any = true;
        if (program->code.row_count > patterns->row_count)
            patterns->row_count = program->code.row_count;
        if (field < GLINT_FIELD_PLANES)
            pattern->reads |= program->inputs;
        if (field < GLINT_FIELD_PLANES || field == GLINT_FIELD_OPACITY)
            patterns->reads |= program->inputs;
    }
    pattern->cut = glint_material_is_cut(desc);
    patterns->cut_outs = patterns->cut_outs || pattern->cut;
    pattern->made = made_by(pattern, indirect);
    if (pattern->any)
        pattern->numbers = numbers_key(pattern);
    patterns->bumps = patterns->bumps || pattern->program[GLINT_FIELD_BUMP];
    patterns->shaders = patterns->shaders || pattern->program[GLINT_FIELD_SHADER];
    patterns->any = patterns->any || pattern->made & GLINT_FIELDS_PLANES;
}

/// Returns whether a material's field is one number for all channels, also after derived planes.
static bool is_grey(const glint_plan_pattern *pattern, int field)
{
    if (field == GLINT_FIELD_AMBIENT || field == GLINT_FIELD_REST)
        return false;
    if (field == GLINT_FIELD_SPECULAR && pattern->desc.normalized)
        return false;
    return pattern->program[field] && pattern->program[field]->code.output_count == 1;
}

/// Gives planes to the fields that some material has.
static void lay_out(glint_plan_patterns *patterns, uint32_t material_count)
{
    for (int field = 0; field < GLINT_FIELD_PLANES; field++) {
        bool made = false, grey = true;
        for (uint32_t i = 0; i < material_count; i++) {
            const bool here = patterns->of[i].made >> field & 1;
            made = made || here;
            grey = grey && (!here || is_grey(&patterns->of[i], field));
        }
        patterns->plane[field] = made ? (int)patterns->plane_count : -1;
        patterns->planes[field] = grey ? 1 : glint_field_channels(field);
        patterns->plane_count += made ? (uint32_t)patterns->planes[field] : 0;
    }
}

// ---- Where shapes are ----

/// Returns the axis that a vector is parallel to; -1: none.
static int axis_of(const double v[3])
{
    for (int c = 0; c < 3; c++)
        if (v[(c + 1) % 3] == 0 && v[(c + 2) % 3] == 0)
            return c;
    return -1;
}

/// Returns the determinant of the map to the shape's own space.
static double determinant_of(const glint_pattern_space *space)
{
    double cross[3];
    vec_cross(cross, space->inverse[1], space->inverse[2]);
    return vec_dot(space->inverse[0], cross);
}

static void invert(glint_pattern_space *space, const glint_transform *map)
{
    double cofactors[3][3], scaled[3][3], largest = 0;
    glint_transform_linear(map, space->forward);
    for (int c = 0; c < 3; c++)
        largest = fmax(largest, vec_max_abs(space->forward[c]));
    const double scale = power_of_two_scale(largest);
    for (int c = 0; c < 3; c++)
        vec_scale(scaled[c], space->forward[c], scale);
    const double determinant = glint_linear_cofactors(scaled, cofactors);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            space->inverse[i][j] = cofactors[j][i] / determinant * scale;
        space->inverse[i][3] = -((space->inverse[i][0] * map->m[0][3] + space->inverse[i][1] * map->m[1][3]) +
                                 space->inverse[i][2] * map->m[2][3]);
    }
    space->mapped = true;
}

/// Computes two unit vectors perpendicular to a unit vector (Duff et al., JCGT 6(1), 2017).
static void sides_of(const double n[3], double side[2][3])
{
    const double sign = copysign(1, n[2]), a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
    const double x[3] = { 1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0] };
    const double y[3] = { b, sign + n[1] * n[1] * a, -n[1] };
    vec_copy(side[0], x);
    vec_copy(side[1], y);
}

/// Sets the origin and the axes of the surface coordinates.
static void surface_init(glint_pattern_space *space, const glint_shape_desc *desc)
{
    double along[3];
    switch (desc->kind) {
    case GLINT_SHAPE_PLANE:
    case GLINT_SHAPE_DISK:
        vec_copy(space->origin, desc->kind == GLINT_SHAPE_PLANE ? desc->point : desc->center);
        vec_normalize(along, desc->normal);
        sides_of(along, space->side);
        break;
    case GLINT_SHAPE_CYLINDER:
    case GLINT_SHAPE_CONE:
        vec_copy(space->origin, desc->base);
        vec_sub(along, desc->top, desc->base);
        space->length = sqrt(vec_dot(along, along));
        space->radius = desc->radius;
        vec_scale(space->along, along, 1 / (space->length * space->length));
        vec_normalize(along, along);
        sides_of(along, space->side);
        break;
    case GLINT_SHAPE_TORUS:
        vec_copy(space->origin, desc->center);
        vec_normalize(space->along, desc->axis);
        sides_of(space->along, space->side);
        space->radius = desc->minor;
        space->length = desc->major;
        break;
    default:
        break;
    }
}

static void space_init(glint_pattern_space *space, const glint_part *part)
{
    const glint_shape_desc *desc = &part->shape->desc;
    const bool flat = desc->kind == GLINT_SHAPE_PLANE || desc->kind == GLINT_SHAPE_DISK;
    *space = (glint_pattern_space) { .kind = desc->kind, .axis = flat ? axis_of(desc->normal) : -1 };
    if (part->map)
        invert(space, part->map);
    if (space->axis >= 0)
        space->face = (desc->kind == GLINT_SHAPE_PLANE ? desc->point : desc->center)[space->axis];
    space->shrink = space->mapped ? glint_pow(fabs(determinant_of(space)), 1 / 3.0) : 1;
    surface_init(space, desc);
    vec_copy(space->lower, desc->min);
    vec_copy(space->upper, desc->max);
    space->first_prim = part->first_prim;
}

static glint_key space_key(const glint_pattern_space *space, uint32_t part, glint_key key)
{
    const double kind[] = { part, space->kind, space->mapped, space->axis, space->face };
    key = glint_key_add(key, kind, sizeof kind);
    key = glint_key_add(key, space->inverse, sizeof space->inverse);
    key = glint_key_add(key, space->forward, sizeof space->forward);
    key = glint_key_add(key, space->lower, sizeof space->lower);
    key = glint_key_add(key, space->origin, sizeof space->origin);
    key = glint_key_add(key, space->along, sizeof space->along);
    key = glint_key_add(key, space->side, sizeof space->side);
    key = glint_key_add(key, &space->radius, sizeof space->radius);
    key = glint_key_add(key, &space->length, sizeof space->length);
    if (space->mesh)
        key = glint_key_add(key, &space->mesh->uv_key, sizeof space->mesh->uv_key);
    return glint_key_add(key, space->upper, sizeof space->upper);
}

static bool reads_uv(const glint_plan_pattern *own)
{
    uint32_t reads = 0;
    for (int field = 0; field < GLINT_FIELD_COUNT; field++)
        reads |= own->program[field] ? own->program[field]->inputs : 0;
    return reads & GLINT_READS_UV;
}

/// Checks that all faces of a mesh with its `material`-th material have coordinates. Many cylinders have none.
static glint_status take_uv(glint_pattern_space *space, const glint_shape *shape, size_t material,
                            glint_error *error)
{
    const char *name = shape->desc.name, *before = name[0] ? " '" : "", *after = name[0] ? "'" : "";
    if (shape->desc.kind == GLINT_SHAPE_CYLINDERS)
        return glint_fail(error, GLINT_ERR_INVALID, "s.uv: cylinders%s%s%s have no texture coordinates; use p, or single cylinders",
                          before, name, after);
    space->mesh = shape->mesh;
    if (!shape->mesh)
        return GLINT_OK;
    if (!shape->mesh->uv)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "s.uv: mesh%s%s%s has no texture coordinates; set its uv, or add vt to its file", before,
                          name, after);
    if (shape->mesh->uv_missing[material])
        return glint_fail(error, GLINT_ERR_INVALID, "s.uv: mesh%s%s%s: faces[%zu] has no texture coordinates (vt)", before,
                          name, after, shape->mesh->uv_missing[material]);
    return GLINT_OK;
}

/// Fills the spaces of the shapes whose materials have programs.
static glint_status find_spaces(glint_plan_patterns *patterns, const glint_geometry *geometry, glint_error *error)
{
    patterns->spaces = glint_alloc(geometry->part_count, sizeof *patterns->spaces);
    if (!patterns->spaces)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < geometry->part_count; i++) {
        const glint_part *part = &geometry->parts[i];
        bool begun = false;
        for (size_t k = 0; k < part->dress->material_count; k++) {
            glint_plan_pattern *own = &patterns->of[glint_list_find(&geometry->materials, part->dress->materials[k])];
            if (!own->any)
                continue;
            if (!begun)
                space_init(&patterns->spaces[i], part);
            begun = true;
            glint_status status =
                reads_uv(own) ? take_uv(&patterns->spaces[i], part->shape, k, error) : GLINT_OK;
            if (status)
                return status;
            own->spaces = space_key(&patterns->spaces[i], i, own->spaces);
        }
    }
    return GLINT_OK;
}

// ---- All of a plan ----

static bool has_any(const glint_plan *plan, size_t i)
{
    for (int field = 0; field < GLINT_FIELD_COUNT; field++)
        if (program_of(plan, i, field))
            return true;
    return glint_material_is_cut(glint_plan_material(plan, i));
}

glint_status glint_plan_find_patterns(glint_plan *plan, bool indirect, glint_error *error)
{
    const glint_list *list = &plan->geometry->materials;
    bool any = false;
    for (size_t i = 0; i < list->count && !any; i++)
        any = has_any(plan, i);
    if (!any)
        return GLINT_OK;
    glint_plan_patterns *patterns = plan->patterns = glint_alloc(1, sizeof *patterns);
    if (!patterns || !(patterns->of = glint_alloc(list->count, sizeof *patterns->of)))
        return glint_fail_nomem(error);
    patterns->material_count = (uint32_t)list->count;
    for (size_t i = 0; i < list->count; i++) {
        add_material(plan, i, indirect);
        glint_status status = find_slope(patterns, &patterns->of[i], error);
        if (status)
            return status;
    }
    lay_out(patterns, patterns->material_count);
    patterns->pixel = 2 * sqrt(vec_dot(plan->camera.right, plan->camera.right));
    patterns->parallel = plan->camera.orthographic;
    return find_spaces(patterns, plan->geometry, error);
}

void glint_plan_patterns_free(glint_plan_patterns *patterns)
{
    for (uint32_t i = 0; patterns && patterns->of && i < patterns->material_count; i++) {
        glint_program_release(patterns->of[i].slope);
        for (int field = 0; field < GLINT_FIELD_COUNT; field++)
            glint_program_release((glint_program *)patterns->of[i].program[field]);
    }
    if (patterns)
        free(patterns->spaces), free(patterns->of);
    free(patterns);
}

glint_key glint_pattern_key(const glint_plan_patterns *patterns, uint32_t material, uint32_t fields, glint_key key)
{
    for (uint32_t field = 0; patterns && field < GLINT_FIELD_COUNT; field++) {
        const glint_program *program = patterns->of[material].program[field];
        if (!program || !(fields >> field & 1))
            continue;
        const glint_key parts[] = { program->structure, program->numbers };
        key = glint_key_add(key, &field, sizeof field);
        key = glint_key_add(key, parts, sizeof parts);
        key = glint_key_add(key, &patterns->of[material].spaces, sizeof patterns->of[material].spaces);
        key = glint_key_add(key, &patterns->of[material].numbers, sizeof patterns->of[material].numbers);
    }
    return key;
}

glint_key glint_programs_key(const glint_plan *plan, uint32_t fields, glint_key key)
{
    for (uint32_t i = 0; plan->patterns && i < plan->material_count; i++)
        key = glint_pattern_key(plan->patterns, i, fields, key);
    return key;
}

bool glint_patterns_see(const glint_plan_patterns *patterns)
{
    const uint32_t eye = 1u << GLINT_INPUT_V_X | 1u << GLINT_INPUT_V_Y | 1u << GLINT_INPUT_V_Z;
    return patterns && (patterns->reads & eye || patterns->shaders);
}

bool glint_plan_program(const glint_plan *plan, size_t index, glint_program_use *out)
{
    if (!plan || !out)
        return false;
    const glint_plan_patterns *patterns = plan->patterns;
    for (uint32_t i = 0; patterns && i < patterns->material_count; i++)
        for (int field = 0; field < GLINT_FIELD_COUNT; field++) {
            const glint_program *program = patterns->of[i].program[field];
            if (!program || index-- > 0)
                continue;
            *out = (glint_program_use) { patterns->of[i].desc.name, glint_field_name(field), program };
            return true;
        }
    if (!plan->environment || index > 0)
        return false;
    *out = (glint_program_use) { NULL, glint_field_name(GLINT_FIELD_BACKGROUND), plan->environment->program };
    return true;
}
