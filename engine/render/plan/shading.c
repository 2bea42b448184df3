#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/plan/plan.h"
#include "engine/render/scene/area_light.h"
#include "engine/render/stages/simd/coefficients.h"

#include <float.h>

#define PI 0x1.921fb54442d18p+1
#define SAMPLES_MAX 0x1p27 ///< most samples of all lights together, over all sets

static bool is_black(const double c[3]) { return c[0] == 0 && c[1] == 0 && c[2] == 0; }

/// Sets up the highlight of Phong or Blinn-Phong.
static void power_init(glint_shade_material *out, const glint_material_desc *desc)
{
    const bool blinn = desc->model == GLINT_MODEL_BLINN_PHONG;
    const double s = fmin(blinn && desc->matched ? 4 * desc->shininess : desc->shininess, FLT_MAX);
    double norm = 1;
    if (desc->normalized)
        norm = blinn ? (s + 2) * (s + 4) / (8 * (glint_pow(2, -s / 2) + s)) : (s + 2) / 2;
    out->highlight = blinn ? GLINT_HIGHLIGHT_BLINN : GLINT_HIGHLIGHT_PHONG;
    out->lobe = desc->normalized ? GLINT_LOBE_POWER_COSINE : GLINT_LOBE_POWER;
    out->shininess = (float)s;
    // exp2's argument is half the logarithm of x times the shininess; the margin of 1e-4 is far above all rounding
    out->least = (float)(glint_pow(2, 2 * GLINT_EXP2_LOWEST / s) * (1 - 1e-4));
    glint_plan_bounded(out->specular, desc->specular, norm);
}

static void facets_init(glint_shade_material *out, const glint_material_desc *desc)
{
    out->highlight = GLINT_HIGHLIGHT_FACETS;
    out->lobe = desc->distribution == GLINT_DISTRIBUTION_BECKMANN ? GLINT_LOBE_BECKMANN : GLINT_LOBE_GGX;
    out->alpha = (float)fmax(desc->roughness * desc->roughness, 1e-18);
    for (int c = 0; c < 3; c++) {
        const double ks = fmin(desc->specular[c], GLINT_STRENGTH_MAX);
        out->specular[c] = ks * desc->f0[c];
        out->grazing[c] = ks * (1 - desc->f0[c]);
    }
}

/// Marks the planes that programs compute, and sets the constants that multiply them to 1.
static void take_planes(glint_shade_material *out, glint_material_desc *d, bool ambient_follows)
{
    const glint_material_programs *programs = &d->program;
    if (programs->diffuse)
        out->planes |= GLINT_PLANE_DIFFUSE | (ambient_follows ? GLINT_PLANE_AMBIENT_IS_DIFFUSE : 0u);
    if (programs->ambient)
        out->planes |= GLINT_PLANE_AMBIENT;
    if (programs->specular)
        out->planes |= GLINT_PLANE_SPECULAR;
    for (int c = 0; c < 3; c++) {
        d->diffuse[c] = programs->diffuse ? 1 : d->diffuse[c];
        d->specular[c] = programs->specular ? 1 : d->specular[c];
    }
}

/// Sets up Phong and Blinn-Phong if programs compute the exponent and, with it, the normalising factor.
static void take_exponents(glint_shade_material *out, const glint_material_desc *d)
{
    out->planes |= GLINT_PLANE_SHININESS;
    out->least = 0;
    for (int c = 0; c < 3 && d->normalized; c++)
        out->specular[c] = 1;
    out->planes |= d->normalized ? GLINT_PLANE_SPECULAR : 0u;
}

void glint_shade_material_init(glint_shade_material *out, const glint_material_desc *desc, const double ambient[3])
{
    glint_material_desc d = *desc;
    glint_material_desc_resolve(&d);
    *out = (glint_shade_material) { 0 };
    take_planes(out, &d, !desc->has_ambient && !desc->program.ambient);
    for (int c = 0; c < 3 && !(out->planes & (GLINT_PLANE_AMBIENT_IS_DIFFUSE | GLINT_PLANE_AMBIENT)); c++)
        out->ambient[c] = d.ambient[c] == 0 ? 0 : fmin(d.ambient[c] * ambient[c], GLINT_STRENGTH_MAX);
    if (d.program.shader) {
        out->planes &= GLINT_PLANE_AMBIENT_IS_DIFFUSE | GLINT_PLANE_AMBIENT;
        out->planes |= GLINT_PLANE_SHADED;
        return;
    }
    glint_plan_bounded(out->diffuse, d.diffuse, 1);
    if (!glint_material_is_shiny(&d)) {
        out->planes &= ~(uint32_t)GLINT_PLANE_SPECULAR;
        return;
    }
    if (d.model == GLINT_MODEL_COOK_TORRANCE)
        facets_init(out, &d);
    else
        power_init(out, &d);
    if (d.program.roughness && d.model == GLINT_MODEL_COOK_TORRANCE)
        out->planes |= GLINT_PLANE_ALPHA;
    if (d.program.shininess && d.model != GLINT_MODEL_COOK_TORRANCE)
        take_exponents(out, &d);
}

/// Returns whether a light's shadows use caps.
static bool is_cap(const glint_plan *plan, const glint_light_desc *desc)
{
    return plan->caps && desc->shadow == GLINT_SHADOW_CAPS && desc->shadows && desc->radius > 0;
}

/// Returns whether the light is sampled at points of its surface.
static bool is_area(const glint_plan *plan, const glint_light_desc *desc)
{
    if (is_cap(plan, desc))
        return false;
    switch (desc->kind) {
    case GLINT_LIGHT_DISK:
    case GLINT_LIGHT_POLYGON:
        return true;
    case GLINT_LIGHT_SPHERE:
        return desc->radius > 0 || desc->has_radiance;
    default:
        return false;
    }
}

uint32_t glint_plan_rays(const glint_plan *plan, int64_t samples)
{
    const int64_t most = plan->desc.rays;
    return (uint32_t)(most > 0 && most < samples ? most : samples);
}

/// Returns light number i of the scene with the samples that it gets in this frame.
static glint_light_desc limited_light(const glint_plan *plan, const glint_scene *scene, size_t i)
{
    glint_light_desc desc = glint_scene_light(scene, i)->desc;
    desc.samples = glint_plan_rays(plan, desc.samples);
    return desc;
}

/// Returns the number of samples; one for a disk without an area.
static uint32_t sample_count(const glint_plan *plan, const glint_light_desc *desc)
{
    return !is_area(plan, desc) || (desc->kind == GLINT_LIGHT_DISK && desc->radius == 0) ? 1 : (uint32_t)desc->samples;
}

static void spot_init(glint_plan_light *out, const glint_light_desc *desc)
{
    const double inner = glint_cos(desc->inner_rad), outer = glint_cos(desc->outer_rad);
    out->is_spot = inner > -1 || desc->exponent > 0; // otherwise it shines everywhere, like a point light
    if (!out->is_spot)
        return;
    out->attenuated = true;
    vec_normalize(out->spot.axis, desc->direction);
    out->spot.outer = outer;
    out->spot.inverse = inner > outer ? 1 / (inner - outer) : HUGE_VAL;
    out->spot.exponent = (float)fmin(desc->exponent, FLT_MAX);
}

bool glint_light_shows(const glint_light_desc *desc, double shown[3])
{
    const double area = glint_light_sample_area(desc), *a = desc->attenuation;
    if (!desc->visible || !(area > 0))
        return false;
    const double distance = desc->kind == GLINT_LIGHT_POLYGON ? sqrt(area / PI) : desc->radius;
    const double factor = desc->has_radiance
                              ? PI * desc->radiance
                              : desc->intensity / (a[0] + (a[1] * distance + a[2] * (distance * distance)));
    glint_plan_bounded(shown, desc->color, factor);
    return shown[0] > 0 || shown[1] > 0 || shown[2] > 0;
}

/// Returns the power of two that scales the largest distance from `position` to a bounded surface to about 1. Then no
/// square of a distance overflows a float, and no square of a distance above 2^-60 of the largest one underflows.
/// Distances near 1 are not scaled, because the kernels skip a product by 1.
static double distance_scale(const double position[3], const glint_geometry_table *geometry)
{
    double away[3];
    vec_sub(away, position, geometry->reference);
    const double distance = fmax(vec_max_abs(away), 1 / geometry->scale);
    const double scale = distance > 0 && isfinite(distance) ? power_of_two_scale(distance) : 1;
    return 0x1p-20 < scale && scale < 0x1p20 ? 1 : scale;
}

/// Computes the mean of a polygon's corners, which is inside the polygon.
static void middle_of_corners(const glint_light_desc *desc, double out[3])
{
    for (int c = 0; c < 3; c++) {
        out[c] = 0;
        for (size_t i = 0; i < desc->vertex_count; i++)
            out[c] += desc->vertices[i][c] / (double)desc->vertex_count;
    }
}

/// Fills a light, or the common fields of all its samples.
static void light_init(const glint_plan *plan, glint_plan_light *out, const glint_light_desc *desc)
{
    const glint_geometry_table *geometry = &plan->geometry->table;
    *out = (glint_plan_light) { .hard = desc->shadow == GLINT_SHADOW_HARD && is_area(plan, desc),
                                .directional = desc->kind == GLINT_LIGHT_DIRECTIONAL,
                                .shadows = desc->shadows,
                                .scale = 1 };
    double strength = desc->intensity / sample_count(plan, desc);
    if (out->directional) {
        vec_normalize(out->position, desc->direction);
        vec_scale(out->position, out->position, -1);
        out->coefficients[0] = 1;
    } else {
        const double *a = desc->attenuation;
        const double *position = desc->kind == GLINT_LIGHT_POLYGON ? desc->vertices[0] : desc->position;
        vec_copy(out->position, desc->position);
        if (desc->kind == GLINT_LIGHT_POLYGON)
            middle_of_corners(desc, out->position);
        vec_copy(out->coefficients, a);
        out->attenuated = a[0] != 1 || a[1] != 0 || a[2] != 0;
        out->scale = distance_scale(position, geometry);
    }
    if (desc->kind == GLINT_LIGHT_SPOT)
        spot_init(out, desc);
    if (desc->has_radiance && is_cap(plan, desc)) {
        out->attenuated = out->radiant_cap = true;
        out->coefficients[0] = 0;
        out->coefficients[2] = 1;
        strength = desc->radiance * (PI * (desc->radius * desc->radius));
    // weighted by the solid angle over pi in which a point sees the sphere
    } else if (desc->has_radiance && desc->kind == GLINT_LIGHT_SPHERE) {
        out->attenuated = true;
        strength = PI * desc->radiance / desc->samples;
    } else if (desc->has_radiance) { // the kernels' cos' / distance^2 is in units of the light's size
        const double size = glint_light_sample_size(desc);
        out->attenuated = true;
        out->scale = size > 0 ? power_of_two_scale(size) : 1;
        strength = desc->radiance * (glint_light_sample_area(desc) / desc->samples) * (out->scale * out->scale);
    }
    glint_plan_bounded(out->diffuse, desc->has_diffuse ? desc->diffuse : desc->color, strength);
    glint_plan_bounded(out->specular, desc->has_specular ? desc->specular : desc->color, strength);
}

/// Computes Ia: the ambient light of the scene and of every light.
static void total_ambient(glint_plan *plan, const glint_scene *scene)
{
    vec_copy(plan->ambient, scene->desc.ambient);
    for (size_t i = 0; i < scene->lights.count; i++) {
        const glint_light_desc *desc = &glint_scene_light(scene, i)->desc;
        for (int c = 0; c < 3; c++)
            plan->ambient[c] += desc->ambient[c] * desc->intensity;
    }
    glint_plan_bounded(plan->ambient, plan->ambient, 1);
    if (!scene->desc.background_program)
        glint_plan_bounded(plan->background, scene->desc.background, 1);
}

/// Fills the materials, and determines the kind of highlight of each.
static glint_status make_materials(glint_plan *plan, bool *powers, bool *facets, glint_error *error)
{
    const glint_list *list = &plan->geometry->materials;
    plan->materials = glint_alloc(list->count, sizeof *plan->materials);
    if (!plan->materials)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < list->count; i++) {
        glint_shade_material *material = &plan->materials[plan->material_count++];
        glint_shade_material_init(material, glint_plan_material(plan, i), plan->ambient);
        *powers =
            *powers || material->highlight == GLINT_HIGHLIGHT_PHONG || material->highlight == GLINT_HIGHLIGHT_BLINN;
        *facets = *facets || material->highlight == GLINT_HIGHLIGHT_FACETS;
    }
    return GLINT_OK;
}

/// Allocates rows for all lights, and sample patterns for area lights.
static glint_status ensure_capacity(glint_plan *plan, const glint_scene *scene, glint_error *error)
{
    double rows = 0, light_samples = 0;
    for (size_t i = 0; i < scene->lights.count; i++) {
        const glint_light_desc desc = limited_light(plan, scene, i);
        rows += sample_count(plan, &desc);
        if (is_area(plan, &desc))
            light_samples += (double)sample_count(plan, &desc) * glint_light_sample_sets(&desc, plan->desc.samples);
        else if (is_cap(plan, &desc))
            light_samples++;
    }
    if (fmax(rows, light_samples) > SAMPLES_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "lights: at most %.0f samples of all together expected, got %.0f",
                          SAMPLES_MAX, fmax(rows, light_samples));
    plan->lights = glint_alloc((size_t)rows, sizeof *plan->lights);
    plan->light_samples = glint_alloc((size_t)light_samples, sizeof *plan->light_samples);
    return plan->lights && plan->light_samples ? GLINT_OK : glint_fail_nomem(error);
}

/// Returns whether two lights have neither samples nor a cone, and the stage `light` reads the same data for both,
/// except the position.
static bool is_same_but_position(const glint_plan_light *a, const glint_plan_light *b)
{
    const bool plain = !a->light_samples && !b->light_samples && !a->is_spot && !b->is_spot;
    return plain && a->directional == b->directional && a->attenuated == b->attenuated && a->scale == b->scale &&
           memcmp(a->coefficients, b->coefficients, sizeof a->coefficients) == 0;
}

/// Adds the rows of one light: one row, or one row per sample. Returns the number of entries used from `light_samples`.
static size_t add_light(glint_plan *plan, const glint_plan_light *common, const glint_light_desc *desc,
                        glint_light_sample *light_samples)
{
    const uint32_t samples = sample_count(plan, desc), sets = glint_light_sample_sets(desc, plan->desc.samples);
    const bool area = is_area(plan, desc);
    if (area) {
        glint_light_desc taken = *desc;
        taken.samples = samples;
        glint_light_sample_fill(&taken, sets, plan->desc.seed, light_samples);
    }
    if (is_cap(plan, desc))
        glint_light_sample_whole(desc, light_samples);
    for (uint32_t i = 0; i < samples; i++) {
        glint_plan_light *light = &plan->lights[plan->light_count++];
        *light = *common;
        light->joined = i > 0;
        light->light_samples = area ? light_samples + (size_t)i * sets : NULL;
        light->sample_set_count = area ? sets : 0;
        light->cap = is_cap(plan, desc) ? light_samples : NULL;
    }
    return area ? (size_t)samples * sets : is_cap(plan, desc);
}

void glint_plan_count_lights(glint_plan *plan)
{
    uint32_t row = 0; // within its light
    plan->shadow_count = plan->spared_count = 0;
    for (uint32_t i = 0; i < plan->light_count; i++) {
        glint_plan_light *light = &plan->lights[i];
        row = light->joined ? row + 1 : 0;
        light->same_but_position = i > 0 && is_same_but_position(light, light - 1);
        plan->shadow_count += light->shadows;
        plan->spared_count += light->cap || (light->shadows && light->hard && row % GLINT_LIGHT_CHUNK > 0);
    }
}

/// Returns whether caps are possible: all shapes are spheres and planes, opaque everywhere and without holes.
static bool allows_caps(const glint_plan *plan)
{
    const glint_geometry_table *table = &plan->geometry->table;
    const glint_list *list = &plan->geometry->materials;
    bool opaque = !glint_plan_cuts(plan) && !plan->translucent;
    for (size_t i = 0; i < list->count; i++)
        opaque = opaque && !glint_material_transmits(&((const glint_material *)list->items[i])->desc);
    return opaque && !table->triangles && !table->solids;
}

glint_status glint_plan_shading(glint_plan *plan, const glint_scene *scene, glint_error *error)
{
    bool powers = false, facets = false, glossy_light = false;
    size_t light_samples = 0;
    plan->caps = allows_caps(plan);
    total_ambient(plan, scene);
    glint_status status = make_materials(plan, &powers, &facets, error);
    if (!status)
        status = ensure_capacity(plan, scene, error);
    if (status)
        return status;
    for (size_t i = 0; i < scene->lights.count; i++) {
        const glint_light_desc desc = limited_light(plan, scene, i);
        glint_plan_light light;
        light_init(plan, &light, &desc);
        if (is_black(light.diffuse) && is_black(light.specular) && !plan->desc.derivative_count)
            continue; // lights of strength 0 can have derivatives, too
        light.source = (uint32_t)i;
        glossy_light = glossy_light || !is_black(light.specular);
        light_samples += add_light(plan, &light, &desc, plan->light_samples + light_samples);
    }
    plan->powers = powers && glossy_light;
    plan->facets = facets && glossy_light;
    plan->highlights = plan->powers || plan->facets;
    glint_plan_count_lights(plan);
    return GLINT_OK;
}
