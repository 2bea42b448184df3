/// Derivatives of a frame: from the slopes of described fields to the slopes of the numbers that shading reads.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/effects/derivative/slopes.h"
#include "engine/render/geometry/prims.h"
#include "engine/render/program/program.h"
#include "engine/render/scene/area_light.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 0x1.921fb54442d18p+1

// ---- Materials ----------------------------------------------------------------------------------------------------

/// Sets up the highlight of Phong or Blinn-Phong with its slopes, like power_init in plan/shading.c. even: the
/// exponent, and so the normalising factor, is a constant.
static void power_material(glint_derivative_material *out, const glint_material_desc *desc, bool even)
{
    const bool blinn = desc->model == GLINT_MODEL_BLINN_PHONG;
    const glint_dual s = out->shininess = blinn && desc->matched ? dual_scale(out->shininess, 4) : out->shininess;
    const glint_dual two = dual(2, 0), four = dual(4, 0);
    out->highlight = blinn ? GLINT_HIGHLIGHT_BLINN : GLINT_HIGHLIGHT_PHONG;
    out->lobe = desc->normalized ? GLINT_LOBE_POWER_COSINE : GLINT_LOBE_POWER;
    if (!desc->normalized || !even)
        return;
    glint_dual norm = dual_scale(dual_add(s, two), 0.5);
    if (blinn)
        norm = dual_div(dual_mul(dual_add(s, two), dual_add(s, four)),
                        dual_scale(dual_add(dual_exp2(dual_scale(s, -0.5)), s), 8));
    for (int c = 0; c < 3; c++)
        out->specular[c] = dual_mul(out->specular[c], norm);
}

static void facet_material(glint_derivative_material *out, const glint_material_desc *desc, const glint_dual f0[3],
                           glint_dual roughness)
{
    out->highlight = GLINT_HIGHLIGHT_FACETS;
    out->lobe = desc->distribution == GLINT_DISTRIBUTION_BECKMANN ? GLINT_LOBE_BECKMANN : GLINT_LOBE_GGX;
    out->alpha = dual_mul(roughness, roughness);
    if (out->alpha.value < 1e-18)
        out->alpha = dual(1e-18, 0);
    for (int c = 0; c < 3; c++) {
        const glint_dual ks = out->specular[c];
        out->specular[c] = dual_mul(ks, f0[c]);
        out->grazing[c] = dual_mul(ks, dual_sub(dual(1, 0), f0[c]));
    }
}

static void set_constant(double value[3], double slope[3])
{
    for (int c = 0; c < 3; c++) {
        value[c] = 1;
        slope[c] = 0;
    }
}

/// For a constant whose product with a program's result is in planes: sets it to 1 and scales its slope to match. A
/// constant 0 has no slope here; see is_lost in fields.c.
static void set_share(double value[3], double slope[3])
{
    for (int c = 0; c < 3; c++) {
        slope[c] = value[c] > 0 ? slope[c] / value[c] : 0;
        value[c] = 1;
    }
}

/// Sets the constants that are multiplied by planes to 1.
static void take_planes(uint32_t planes, glint_material_desc *d, glint_material_desc *slope)
{
    if (planes & (GLINT_PLANE_AMBIENT | GLINT_PLANE_AMBIENT_IS_DIFFUSE))
        set_constant(d->ambient, slope->ambient);
    if (planes & GLINT_PLANE_DIFFUSE)
        set_constant(d->diffuse, slope->diffuse);
    if (planes & GLINT_PLANE_SPECULAR && !d->program.specular)
        set_share(d->specular, slope->specular); // normalised highlights
    else if (planes & GLINT_PLANE_SPECULAR)
        set_constant(d->specular, slope->specular);
    if (planes & GLINT_PLANE_SHININESS)
        slope->shininess = 0;
    if (planes & GLINT_PLANE_ALPHA)
        slope->roughness = 0;
}

/// Computes f0 and its slope from a resolved description. If f0 is not set, it follows ior; see
/// glint_material_desc_resolve.
static void fill_f0(glint_dual out[3], const glint_material_desc *d, const glint_material_desc *slope, bool is_own)
{
    const double up = d->ior + 1, by_ior = is_own || !(d->ior < 1e300) ? 0 : 4 * (d->ior - 1) / up / up / up * slope->ior;
    for (int c = 0; c < 3; c++)
        out[c] = dual(d->f0[c], is_own ? slope->f0[c] : by_ior);
}

/// Clears the fields that the shader does not read.
static void shader_material(glint_derivative_material *out, uint32_t inputs)
{
    for (int c = 0; c < 3; c++) {
        if (!(inputs >> (GLINT_INPUT_KD_R + c) & 1))
            out->diffuse[c].slope = 0;
        if (!(inputs >> (GLINT_INPUT_KS_R + c) & 1))
            out->specular[c].slope = 0;
    }
    if (!(inputs >> GLINT_INPUT_SHININESS & 1))
        out->shininess.slope = 0;
}

/// Fills a material. planes: as in glint_shade_material. light: Ia.
static void fill_material(glint_derivative_material *out, const glint_material_desc *desc,
                          const glint_material_desc *slopes, uint32_t planes, const glint_dual light[3])
{
    glint_material_desc d = *desc, changes = *slopes, *slope = &changes;
    glint_dual f0[3];
    glint_material_desc_resolve(&d);
    if (!desc->has_ambient)
        memcpy(slope->ambient, slope->diffuse, sizeof slope->ambient);
    take_planes(planes, &d, slope);
    duals(out->diffuse, d.diffuse, slope->diffuse);
    duals(out->specular, d.specular, slope->specular);
    duals(out->ambient, d.ambient, slope->ambient);
    fill_f0(f0, &d, slope, desc->has_f0);
    for (int c = 0; c < 3; c++)
        out->ambient[c] = dual_mul(out->ambient[c], light[c]);
    out->shininess = dual(d.shininess, slope->shininess);
    bool shiny = glint_has_slope(out->specular, 3);
    for (int c = 0; c < 3; c++)
        shiny = shiny || d.specular[c] != 0;
    shiny = shiny && d.model != GLINT_MODEL_LAMBERT && !d.program.shader;
    if (d.program.shader)
        shader_material(out, d.program.shader->inputs);
    else if (shiny && d.model == GLINT_MODEL_COOK_TORRANCE)
        facet_material(out, &d, f0, dual(d.roughness, slope->roughness));
    else if (shiny)
        power_material(out, &d, !(planes & GLINT_PLANE_SHININESS));
    if (out->highlight == GLINT_HIGHLIGHT_NONE && !d.program.shader) // fields that are not read change nothing
        out->shininess = out->specular[0] = out->specular[1] = out->specular[2] = dual(0, 0);
    if (out->highlight == GLINT_HIGHLIGHT_FACETS)
        out->shininess = dual(0, 0);
    out->varies = glint_has_slope(out->diffuse, 3) || glint_has_slope(out->specular, 3) || glint_has_slope(out->grazing, 3) ||
                  glint_has_slope(out->ambient, 3) || glint_has_slope(&out->shininess, 1) || glint_has_slope(&out->alpha, 1);
}

/// Fills a material's glint_derivative_bounce. Fields that are not read get no slope.
static void fill_bounce(glint_derivative_bounce *out, const glint_material_desc *desc, const glint_material_desc *slope)
{
    const bool transmits = glint_material_transmits(desc);
    if (desc->has_mirror && !desc->program.mirror)
        memcpy(out->mirror, slope->mirror, sizeof out->mirror);
    if (!desc->program.transmission)
        memcpy(out->transmission, slope->transmission, sizeof out->transmission);
    for (int c = 0; c < 3 && transmits; c++)
        out->absorption[c] = slope->absorption[c];
    out->clear = -slope->opacity;
    out->ior = transmits || (desc->fresnel && glint_material_mirrors(desc)) ? slope->ior : 0;
}

// ---- Lights -------------------------------------------------------------------------------------------------------

static void fill_spot(glint_derivative_light *out, const glint_light_desc *desc, const glint_light_desc *slope)
{
    const glint_dual inner = dual_cos(dual(desc->inner_rad, slope->inner_rad));
    const glint_dual outer = dual_cos(dual(desc->outer_rad, slope->outer_rad));
    out->is_spot = inner.value > -1 || desc->exponent > 0 || slope->exponent != 0;
    out->outer = outer;
    out->inverse = inner.value > outer.value ? dual_div(dual(1, 0), dual_sub(inner, outer)) : dual(HUGE_VAL, 0);
    out->exponent = dual(desc->exponent, slope->exponent);
    duals(out->axis, desc->direction, slope->direction);
    dual_normalize(out->axis);
}

/// Returns the strength of one of a light's `count` samples, and its slope; see light_init in plan/shading.c.
static glint_dual strength_of(const glint_light_desc *desc, const glint_light_desc *slope, double count, bool is_cap)
{
    if (!desc->has_radiance)
        return dual_scale(dual(desc->intensity, slope->intensity), 1 / count);
    const glint_dual radiance = dual(desc->radiance, slope->radiance);
    if (is_cap)
        return dual_scale(radiance, PI * (desc->radius * desc->radius));
    return dual_scale(radiance, (desc->kind == GLINT_LIGHT_SPHERE ? PI : glint_light_sample_area(desc)) / count);
}

/// Fills a light. rows: the light's first row in the plan; NULL: it has none.
static void fill_light(glint_derivative_light *out, const glint_plan_light *rows, uint32_t count,
                       const glint_light_desc *desc, const glint_light_desc *slope)
{
    const bool is_cap = rows && rows->cap;
    const glint_dual strength = strength_of(desc, slope, count > 0 ? count : 1, is_cap);
    duals(out->diffuse, desc->has_diffuse ? desc->diffuse : desc->color,
          desc->has_diffuse ? slope->diffuse : slope->color);
    duals(out->specular, desc->has_specular ? desc->specular : desc->color,
          desc->has_specular ? slope->specular : slope->color);
    for (int c = 0; c < 3; c++) {
        out->diffuse[c] = dual_mul(out->diffuse[c], strength);
        out->specular[c] = dual_mul(out->specular[c], strength);
    }
    out->directional = desc->kind == GLINT_LIGHT_DIRECTIONAL;
    if (out->directional) {
        duals(out->position, desc->direction, slope->direction);
        dual_normalize(out->position);
        for (int c = 0; c < 3; c++)
            out->position[c] = dual_scale(out->position[c], -1);
        out->coefficients[0] = dual(1, 0);
    } else {
        duals(out->position, desc->position, slope->position);
        duals(out->coefficients, desc->attenuation, slope->attenuation);
    }
    if (desc->kind == GLINT_LIGHT_SPOT)
        fill_spot(out, desc, slope);
    out->attenuated = is_cap ? false : out->coefficients[0].value != 1 || out->coefficients[1].value != 0 ||
                      out->coefficients[2].value != 0 || glint_has_slope(out->coefficients, 3); // caps: the visible share has a slope
    out->moves = glint_has_slope(out->position, 3);
    out->turns = out->moves || glint_has_slope(out->axis, 3);
    out->shines = glint_has_slope(out->diffuse, 3) || glint_has_slope(out->specular, 3) ||
                  glint_has_slope(out->coefficients, 3) || out->outer.slope != 0 || out->inverse.slope != 0 ||
                  out->exponent.slope != 0;
    out->varies = out->turns || out->shines;
}

// ---- Surfaces -----------------------------------------------------------------------------------------------------

/// Computes the slope of a plane's unit normal in world space.
static void turn_normal(const glint_transform *map, const double normal[3], const double slope[3], double out[3])
{
    glint_dual own[3], turned[3];
    double linear[3][3], cofactors[3][3];
    duals(own, normal, slope);
    duals(turned, normal, slope);
    if (map) {
        glint_transform_linear(map, linear);
        glint_linear_scale(linear);
        const double side = glint_linear_cofactors(linear, cofactors) < 0 ? -1 : 1;
        for (int c = 0; c < 3; c++) {
            turned[c] = dual(0, 0);
            for (int i = 0; i < 3; i++)
                turned[c] = dual_add(turned[c], dual_scale(own[i], side * cofactors[c][i]));
        }
    }
    dual_normalize(turned);
    for (int c = 0; c < 3; c++)
        out[c] = turned[c].slope;
}

static void fill_part(glint_derivative_part *out, const glint_part *part, const glint_shape_desc *slope)
{
    const glint_shape_desc *desc = &part->shape->desc;
    const bool sphere = desc->kind == GLINT_SHAPE_SPHERE;
    const double *at = sphere ? desc->center : desc->point, *moved = sphere ? slope->center : slope->point;
    if (!sphere && desc->kind != GLINT_SHAPE_PLANE)
        return;
    for (int c = 0; c < 3; c++) {
        const double *row = part->map ? part->map->m[c] : NULL;
        out->position[c] = row ? vec_dot(row, moved) : moved[c];
        out->pivot[c] = row ? vec_dot(row, at) + row[3] : at[c];
    }
    if (sphere)
        out->growth = slope->radius / desc->radius;
    else
        turn_normal(part->map, desc->normal, slope->normal, out->normal);
    out->moves = glint_any_slope(out->position) || out->growth != 0 || glint_any_slope(out->normal);
}

/// Marks what changes with the programs that have derivatives.
static void take_programs(const glint_derivative_programs *programs, size_t material, glint_plan_derivative *out)
{
    for (int field = 0; field < GLINT_FIELD_COUNT; field++) {
        if (!programs->of[field])
            continue;
        out->repaints = out->repaints || field < GLINT_FIELD_PLANES;
        if (field == GLINT_FIELD_MIRROR || field == GLINT_FIELD_TRANSMISSION)
            out->weighs = true;
        else
            out->materials[material].varies = 1;
        out->everywhere = out->everywhere || field == GLINT_FIELD_AMBIENT || field == GLINT_FIELD_DIFFUSE; // diffuse may also be ambient
    }
}

// ---- A derivative ---------------------------------------------------------------------------------------------------

/// Computes Ia, the sum over the scene and all lights.
static void total_ambient(const glint_scene *scene, const glint_scene_slopes *slopes, glint_dual out[3])
{
    duals(out, scene->desc.ambient, slopes->scene.ambient);
    for (size_t i = 0; i < scene->lights.count; i++) {
        const glint_light_desc *desc = &glint_scene_light(scene, i)->desc, *slope = &slopes->lights[i];
        for (int c = 0; c < 3; c++)
            out[c] = dual_add(out[c], dual_mul(dual(desc->ambient[c], slope->ambient[c]),
                                               dual(desc->intensity, slope->intensity)));
    }
}

/// Fills the slopes of a depth cue, whose colour may be the background's.
static void fill_fade(const glint_scene_desc *desc, const glint_scene_desc *slope, glint_plan_derivative *out)
{
    if (desc->has_depth_cue) {
        vec_copy(out->fade.color, desc->has_depth_cue_color ? slope->depth_cue_color : slope->background);
        out->fade.near = slope->depth_cue_near;
        out->fade.far = slope->depth_cue_far;
    }
    out->fades = glint_any_slope(out->fade.color) || out->fade.near != 0 || out->fade.far != 0;
}

static void fill(const glint_plan *plan, const glint_scene *scene, const glint_scene_slopes *slopes,
                 glint_plan_derivative *out)
{
    const glint_list *list = &plan->geometry->materials;
    glint_dual ambient[3];
    total_ambient(scene, slopes, ambient);
    for (size_t i = 0; i < list->count; i++) {
        const glint_material_desc *desc = glint_plan_material(plan, i);
        const glint_derivative_bounce *bounce = &out->bounces[i];
        fill_material(&out->materials[i], desc, &slopes->materials[i], plan->materials[i].planes, ambient);
        fill_bounce(&out->bounces[i], desc, &slopes->materials[i]);
        take_programs(&out->programs[i], i, out);
        out->bends = out->bends || bounce->ior != 0;
        out->weighs = out->weighs || bounce->ior != 0 || bounce->clear != 0 || glint_any_slope(bounce->mirror) ||
                      glint_any_slope(bounce->transmission) || glint_any_slope(bounce->absorption);
    }
    for (size_t i = 0; i < scene->lights.count; i++) {
        const glint_light_desc *desc = &glint_scene_light(scene, i)->desc;
        const glint_plan_light *rows = NULL;
        uint32_t count = 0;
        for (uint32_t k = 0; k < plan->light_count; k++)
            if (plan->lights[k].source == i) {
                rows = rows ? rows : &plan->lights[k];
                count++;
            }
        fill_light(&out->lights[i], rows, count, desc, &slopes->lights[i]);
        out->moves = out->moves || out->lights[i].moves;
    }
    for (uint32_t i = 0; i < plan->geometry->part_count; i++) {
        fill_part(&out->parts[i], &plan->geometry->parts[i], &slopes->shapes[i]);
        out->bends = out->bends || out->parts[i].moves;
    }
    glint_derivative_fill_view(&out->view, plan, glint_camera_get(scene->desc.camera), &slopes->camera);
    out->bends = out->bends || out->view.moves;
    out->moves = out->moves || out->bends;
    fill_fade(&scene->desc, &slopes->scene, out);
    for (int c = 0; c < 3; c++) {
        out->background[c] = scene->desc.background_program ? 0 : slopes->scene.background[c];
        out->everywhere = out->everywhere || out->background[c] != 0;
    }
    for (size_t i = 0; i < list->count; i++)
        out->everywhere = out->everywhere || glint_has_slope(out->materials[i].ambient, 3);
}

static glint_status make_one(const glint_plan *plan, const glint_scene *scene, const glint_derivative *d,
                             glint_scene_slopes *slopes, glint_plan_derivative *out, glint_error *error)
{
    const size_t materials = plan->geometry->materials.count, lights = scene->lights.count;
    const size_t parts = plan->geometry->part_count;
    glint_status status = GLINT_OK;
    memset(slopes->materials, 0, (materials + 1) * sizeof *slopes->materials);
    memset(slopes->lights, 0, (lights + 1) * sizeof *slopes->lights);
    memset(slopes->shapes, 0, (parts + 1) * sizeof *slopes->shapes);
    memset(&slopes->camera, 0, sizeof slopes->camera);
    memset(&slopes->scene, 0, sizeof slopes->scene);
    slopes->programs = out->programs = calloc(materials + 1, sizeof *out->programs);
    if (!out->programs)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < d->slope_count && !status; i++)
        status = glint_derivative_add(plan, scene, d, &d->slopes[i], slopes, error);
    if (!status)
        status = glint_derivative_weigh(plan, d, slopes, error);
    if (status)
        return status;
    snprintf(out->name, sizeof out->name, "%s", d->name);
    out->materials = calloc(materials + 1, sizeof *out->materials);
    out->bounces = calloc(materials + 1, sizeof *out->bounces);
    out->lights = calloc(lights + 1, sizeof *out->lights);
    out->parts = calloc(parts + 1, sizeof *out->parts);
    if (!out->materials || !out->bounces || !out->lights || !out->parts)
        return glint_fail_nomem(error);
    fill(plan, scene, slopes, out);
    return GLINT_OK;
}

static glint_status check_names(const glint_render_desc *desc, glint_error *error)
{
    if (desc->derivative_count > GLINT_DERIVATIVES_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "derivative_count: at most %d derivatives of one frame expected, got %zu",
                          GLINT_DERIVATIVES_MAX, desc->derivative_count);
    for (size_t i = 0; i < desc->derivative_count; i++) {
        const char *name = desc->derivatives[i].name;
        if (!name || !*name || strlen(name) >= GLINT_DERIVATIVE_NAME_SIZE)
            return glint_fail(error, GLINT_ERR_INVALID, "derivatives[%zu].name: 1 .. %d bytes expected, got '%.64s'", i,
                              GLINT_DERIVATIVE_NAME_SIZE - 1, name ? name : "");
        for (size_t k = 0; k < i; k++)
            if (strcmp(name, desc->derivatives[k].name) == 0)
                return glint_fail(error, GLINT_ERR_INVALID, "derivative '%s': named twice", name);
    }
    return GLINT_OK;
}

/// Fills the level of a derivative: its slopes, with 1 for each that is 0. The lists are NULL if none is 0.
static glint_status make_level(const glint_plan *plan, const glint_scene *scene, const glint_derivative *d,
                               glint_scene_slopes *slopes, glint_plan_derivative *out, glint_error *error)
{
    glint_slope *steep = malloc((d->slope_count + 1) * sizeof *steep);
    glint_derivative all = { d->name, steep, 0 };
    glint_status status = steep ? GLINT_OK : glint_fail_nomem(error);
    for (size_t i = 0; steep && i < d->slope_count; i++)
        if (!d->slopes[i].program && !glint_any_slope(d->slopes[i].slope)) {
            steep[all.slope_count] = d->slopes[i];
            for (int c = 0; c < 3; c++)
                steep[all.slope_count].slope[c] = 1;
            all.slope_count++;
        }
    if (!status && all.slope_count)
        status = make_one(plan, scene, &all, slopes, out, error);
    free(steep);
    return status;
}

static glint_status make_all(glint_plan *plan, const glint_scene *scene, const glint_render_desc *desc,
                             glint_error *error)
{
    glint_plan_derivatives *all = plan->derivatives;
    glint_scene_slopes slopes = { .materials = malloc((plan->geometry->materials.count + 1) * sizeof *slopes.materials),
                                  .lights = malloc((scene->lights.count + 1) * sizeof *slopes.lights),
                                  .shapes = malloc((plan->geometry->part_count + 1) * sizeof *slopes.shapes) };
    glint_status status = slopes.materials && slopes.lights && slopes.shapes ? GLINT_OK : glint_fail_nomem(error);
    all->light_count = scene->lights.count;
    all->material_count = plan->geometry->materials.count;
    for (size_t i = 0; i < desc->derivative_count && !status; i++) {
        glint_plan_derivative *d = &all->of[all->count++];
        status = make_one(plan, scene, &desc->derivatives[i], &slopes, d, error);
        if (!status)
            status = make_level(plan, scene, &desc->derivatives[i], &slopes, &all->level[i], error);
        all->moves = all->moves || d->moves;
        all->bends = all->bends || d->bends;
        all->weighs = all->weighs || d->weighs;
        all->fades = all->fades || d->fades;
        all->everywhere = all->everywhere || d->everywhere;
        all->repaints = all->repaints || d->repaints;
    }
    free(slopes.materials);
    free(slopes.lights);
    free(slopes.shapes);
    return status ? status : glint_derivative_find_gradients(plan, error);
}

glint_status glint_derivative_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error)
{
    glint_status status = check_names(from->desc, error);
    if (status || !from->desc->derivative_count)
        return status;
    plan->derivatives = calloc(1, sizeof *plan->derivatives);
    return plan->derivatives ? make_all(plan, from->scene, from->desc, error) : glint_fail_nomem(error);
}

static void free_one(glint_plan_derivative *d, size_t materials)
{
    for (size_t i = 0; i < materials * GLINT_FIELD_COUNT && d->programs; i++)
        glint_program_release((glint_program *)(uintptr_t)d->programs[i / GLINT_FIELD_COUNT].of[i % GLINT_FIELD_COUNT]);
    free(d->programs);
    free(d->materials);
    free(d->bounces);
    free(d->lights);
    free(d->parts);
}

void glint_derivative_release(glint_plan *plan)
{
    glint_plan_derivatives *derivatives = plan->derivatives;
    for (size_t i = 0; derivatives && i < GLINT_DERIVATIVES_MAX; i++) {
        free_one(&derivatives->of[i], derivatives->material_count);
        free_one(&derivatives->level[i], derivatives->material_count);
    }
    for (size_t i = 0; derivatives && derivatives->gradients && i < derivatives->material_count; i++)
        glint_gradient_release(&derivatives->gradients[i]);
    if (derivatives)
        free(derivatives->gradients);
    free(derivatives);
}

glint_key glint_derivative_key(const glint_plan *plan, int pass, glint_key key)
{
    const size_t index = (size_t)pass - GLINT_PASS_DERIVATIVE;
    if (pass < GLINT_PASS_DERIVATIVE || index >= plan->derivatives->count)
        return key;
    const glint_plan_derivative *d = &plan->derivatives->of[index];
    key = glint_key_add_string(key, d->name);
    key = glint_key_add(key, d->materials, plan->geometry->materials.count * sizeof *d->materials);
    key = glint_key_add(key, d->bounces, plan->geometry->materials.count * sizeof *d->bounces);
    for (size_t i = 0; i < plan->geometry->materials.count * GLINT_FIELD_COUNT; i++) {
        const glint_program *program = d->programs[i / GLINT_FIELD_COUNT].of[i % GLINT_FIELD_COUNT];
        if (program) {
            key = glint_key_add(key, &i, sizeof i);
            key = glint_key_add(key, &program->structure, sizeof program->structure);
            key = glint_key_add(key, &program->numbers, sizeof program->numbers);
        }
    }
    key = glint_key_add(key, d->lights, plan->derivatives->light_count * sizeof *d->lights);
    key = glint_key_add(key, d->parts, plan->geometry->part_count * sizeof *d->parts);
    key = glint_key_add(key, &d->view, sizeof d->view);
    key = glint_key_add(key, &d->fade, sizeof d->fade);
    return glint_key_add(key, d->background, sizeof d->background);
}
