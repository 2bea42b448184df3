/// The plan of rays beyond the first surface: the materials that send rays on, and a bound of their light.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/effects/bounce/plan.h"
#include "engine/render/effects/environment/plan.h"
#include "engine/render/effects/visible_light/plan.h"

static double brightest_of(const double c[3]) { return fmax(c[0], fmax(c[1], c[2])); }

/// Returns the mirror of a material: if it was never set, it follows `fresnel`.
static const double *mirror_of(const glint_material_desc *desc)
{
    static const double black[3] = { 0 }, white[3] = { 1, 1, 1 };
    return desc->has_mirror ? desc->mirror : desc->fresnel || glint_material_has_facets(desc) ? white : black;
}

/// Fills the fields of a surface that spreads the rays that it reflects and refracts.
static void rough_init(glint_bounce_material *out, const glint_material_desc *desc)
{
    glint_material_desc d = *desc;
    glint_material_desc_resolve(&d);
    out->rough = true;
    out->alpha = fmax(d.roughness * d.roughness, 1e-18);
    out->beckmann = d.distribution == GLINT_DISTRIBUTION_BECKMANN;
    out->facets = glint_material_has_facets(&d);
    out->fresnel = d.fresnel || (out->facets && out->transmits);
    out->schlick = out->facets && !out->fresnel;
    vec_copy(out->f0, d.f0);
    for (int c = 0; c < 3 && out->facets; c++)
        out->specular[c] = d.program.specular ? 1 : fmin(d.specular[c], GLINT_STRENGTH_MAX);
}

/// reflects: whether rough surfaces reflect and refract rays.
static void bounce_material_init(glint_bounce_material *out, const glint_plan *plan, size_t index, bool reflects)
{
    const glint_material_desc *desc = glint_plan_material(plan, index);
    *out = (glint_bounce_material) { .ior = desc->ior, .fresnel = desc->fresnel, .specular = { 1, 1, 1 } };
    out->clear = plan->translucent ? plan->translucent[index].clear : 0;
    out->clears = plan->translucent && plan->translucent[index].blends;
    glint_plan_bounded(out->mirror, mirror_of(desc), 1);
    glint_plan_bounded(out->transmission, desc->transmission, 1);
    glint_plan_bounded(out->absorption, desc->absorption, 1);
    for (int c = 0; c < 3; c++) { // the same limits apply to programs' results
        out->mirror[c] = desc->program.mirror ? GLINT_REFLECTANCE_MAX : out->mirror[c];
        out->transmission[c] = desc->program.transmission ? GLINT_REFLECTANCE_MAX : out->transmission[c];
    }
    out->mirrors = glint_material_mirrors(desc);
    out->transmits = glint_material_transmits(desc);
    if (glint_material_is_rough(desc))
        rough_init(out, desc);
    if (out->rough && !reflects)
        out->mirrors = false;
}

/// Returns a bound of a translucent material as if it were opaque. A ray finds o times the light of the surface and
/// 1 - o times the light beyond, at most the larger of the two. So the bound holds however many translucent surfaces
/// a ray crosses.
static double opaque(const glint_bounce_material *m, double bound) { return bound / (1 - m->clear); }

/// Bounds the share of its rays' light that a material sends on, without total reflection.
static double gain(const glint_bounce_material *m)
{
    double most = 0;
    for (int c = 0; c < 3; c++) {
        const double mirror = m->mirrors ? m->mirror[c] * m->specular[c] : 0;
        most = fmax(most, m->fresnel ? fmax(mirror, m->transmission[c]) : mirror + m->transmission[c]);
    }
    return opaque(m, most);
}

/// Returns the bound for any ray, including total reflection, which does not dim.
static double gain_anywhere(const glint_bounce_material *m)
{
    return m->transmits && !m->fresnel ? fmax(gain(m), 1) : gain(m);
}

/// Returns a bound of a program's result: 1 without a program, as the table then has the value.
static double most_of(const glint_plan *plan, uint32_t i, glint_field field)
{
    return plan->patterns && plan->patterns->of[i].made >> field & 1 ? GLINT_REFLECTANCE_MAX : 1;
}

/// Returns a bound of the diffuse reflectance.
static double most_diffuse(const glint_plan *plan, uint32_t i)
{
    return most_of(plan, i, GLINT_FIELD_DIFFUSE) * brightest_of(glint_plan_diffuse(plan, i));
}

/// Returns the bound of `opaque` for material number i of a plan.
static double as_opaque(const glint_plan *plan, uint32_t i, double bound)
{
    return plan->bouncing ? opaque(&plan->bouncing[i], bound) : bound;
}

/// Returns a bound of the light that surfaces of a material themselves give to any ray.
static double surface_light(const glint_plan *plan, uint32_t i)
{
    const glint_shade_material *m = &plan->materials[i];
    const double diffuse = most_diffuse(plan, i), specular = most_of(plan, i, GLINT_FIELD_SPECULAR);
    double sum = brightest_of(m->ambient) + (plan->indirect.samples ? brightest_of(plan->indirect.rest[i]) : 0);
    if (plan->patterns && plan->patterns->of[i].made >> GLINT_FIELD_DIFFUSE & 1)
        sum += diffuse * brightest_of(plan->ambient);
    if (plan->patterns && plan->patterns->of[i].program[GLINT_FIELD_AMBIENT])
        sum += GLINT_REFLECTANCE_MAX * brightest_of(plan->ambient);
    for (uint32_t k = 0; k < plan->light_count; k++) {
        const glint_plan_light *light = &plan->lights[k];
        const double c0 = light->coefficients[0];
        const uint32_t emission = light->light_samples ? light->light_samples->emission : GLINT_EMIT_ALL;
        const bool known = c0 > 0 && (emission < GLINT_EMIT_RADIANT_FRONT || emission == GLINT_EMIT_CONE);
        const double near = !light->attenuated ? 1 : known ? (emission == GLINT_EMIT_CONE ? 2 : 1) / c0 : HUGE_VAL;
        double far = diffuse * brightest_of(light->diffuse) +
                     specular * brightest_of(m->specular) * brightest_of(light->specular);
        if (plan->patterns && plan->patterns->of[i].program[GLINT_FIELD_SHADER])
            far = GLINT_REFLECTANCE_MAX;
        if (far > 0)
            sum += near * far;
    }
    return as_opaque(plan, i, sum);
}

/// Returns a bound of the light of all surfaces, visible lights and the background.
static double brightest_surface(const glint_plan *plan)
{
    double most = plan->environment ? plan->environment->most : brightest_of(plan->background);
    const glint_visible_lights *lights = glint_visible_lights_of(plan);
    for (uint32_t i = 0; i < lights->count; i++)
        most = fmax(most, brightest_of(lights->of[i].shown));
    for (uint32_t i = 0; i < plan->material_count; i++)
        most = fmax(most, surface_light(plan, i));
    return most;
}

/// Returns a bound of the light along a chain without indirect light, if no material sends on more than it gets: the
/// own light of a material at each surface that sends on, and anything at the end.
static double brightest_chain(const glint_plan *plan, double depth)
{
    double each = 0;
    for (uint32_t i = 0; i < plan->material_count; i++)
        if (plan->bouncing[i].mirrors || plan->bouncing[i].transmits)
            each = fmax(each, surface_light(plan, i));
    return brightest_surface(plan) + (each > 0 ? each * depth : 0);
}

/// Returns a bound of 1 + g + g^2 + ... + g^depth.
static double geometric(double g, double depth)
{
    return g < 1 ? fmin(depth + 1, 1 / (1 - g)) : (depth + 1) * glint_pow(g, depth);
}

// ---- How bright ----

/// Computes a bound of the light along a ray, and from it the smallest weight of a path of indirect light. Such paths
/// may lose a quarter of the light that all rays of a sample may lose together. The rest is left to mirrored and
/// refracted rays.
static void bound_light(glint_plan *plan)
{
    double most = 0, depth = (double)plan->desc.max_depth + plan->indirect.bounces;
    for (uint32_t i = 0; i < plan->material_count; i++)
        most = fmax(most, (plan->bouncing ? gain_anywhere(&plan->bouncing[i]) : 0) +
                              (plan->indirect.samples ? as_opaque(plan, i, most_diffuse(plan, i)) : 0));
    plan->brightest = brightest_surface(plan) * geometric(most, depth);
    if (plan->bouncing && !plan->indirect.samples && most <= 1)
        plan->brightest = fmin(plan->brightest, brightest_chain(plan, depth));
    plan->indirect.least = GLINT_BOUNCE_LOSS / (4 * plan->brightest * geometric(most, depth));
}

/// Refuses a large max_depth if mirror and transmission add up to more than 1 (`most`): then the number of rays
/// doubles at each surface. Up to 1, they divide a ray's weight.
static glint_status check_depth(const glint_plan *plan, double most, glint_error *error)
{
    if (most <= 1 || plan->desc.max_depth <= GLINT_BOUNCE_DEPTH)
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID,
                      "max_depth: expected at most %d, because the mirror + transmission of a material is above 1 "
                      "(here %.9g), got %lld",
                      GLINT_BOUNCE_DEPTH, most, (long long)plan->desc.max_depth);
}

/// Refuses meshes whose points move off their faces, if rays go on through a face: they would pass it twice.
static glint_status check_moved(const glint_plan *plan, glint_error *error)
{
    for (uint32_t i = 0; i < plan->geometry->part_count; i++) {
        const glint_shape *shape = plan->geometry->parts[i].shape;
        for (size_t k = 0; shape->desc.terminator > 0 && k < shape->material_count; k++) {
            const glint_material_desc *desc = &shape->materials[k]->desc;
            if (glint_material_transmits(desc) || glint_material_blends(desc))
                return glint_fail(error, GLINT_ERR_INVALID, "mesh%s%s.terminator: expected 0, because its material %s, got %g",
                                  *shape->desc.name ? " " : "", shape->desc.name,
                                  glint_material_transmits(desc) ? "transmits light" : "is translucent", shape->desc.terminator);
        }
    }
    return GLINT_OK;
}

glint_status glint_bounce_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error)
{
    const glint_scene_desc *scene = glint_scene_get(from->scene);
    const glint_list *list = &plan->geometry->materials;
    double splitting = 0;
    if (!glint_bounce_is_needed(plan)) {
        if (plan->indirect.samples)
            bound_light(plan);
        return GLINT_OK;
    }
    plan->bouncing = glint_alloc(list->count, sizeof *plan->bouncing);
    if (!plan->bouncing)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < list->count; i++) {
        glint_bounce_material *m = &plan->bouncing[i];
        bounce_material_init(m, plan, i, scene->reflection_samples > 0);
        if (glint_is_spreading(m))
            plan->rough_samples = glint_plan_rays(plan, scene->reflection_samples);
        plan->sharp = plan->sharp || glint_is_sharp(m);
        plan->mirrors = plan->mirrors || m->mirrors;
        plan->transmits = plan->transmits || m->transmits;
        plan->clears = plan->clears || m->clears;
        plan->absorbs = plan->absorbs || (m->transmits && brightest_of(m->absorption) > 0);
        if (glint_is_sharp(m) && m->mirrors + m->transmits + m->clears > 1)
            splitting = fmax(splitting, gain(m));
    }
    bound_light(plan);
    glint_status status = check_depth(plan, splitting, error);
    if (!status)
        status = check_moved(plan, error);
    if (!status && plan->transmits && !plan->camera.orthographic)
        status = glint_plan_eye(plan, error);
    return status;
}

glint_key glint_bounce_key(const glint_plan *plan, glint_key key)
{
    GLINT_KEY_ADD(key, plan->desc.max_depth);
    for (uint32_t i = 0; i < plan->material_count; i++) {
        const glint_bounce_material *m = &plan->bouncing[i];
        const double numbers[] = { m->ior, m->fresnel };
        key = glint_transmission_key(m, key);
        GLINT_KEY_ADD(key, m->mirror);
        GLINT_KEY_ADD(key, numbers);
        if (!glint_is_spreading(m))
            continue;
        const double rough[] = { m->alpha, m->beckmann, m->facets, m->schlick };
        GLINT_KEY_ADD(key, rough);
        GLINT_KEY_ADD(key, m->specular);
        GLINT_KEY_ADD(key, m->f0);
    }
    return key;
}
