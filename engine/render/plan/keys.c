/// The keys of a plan: hashes of the data that each stage declares to read. A stage's key includes the keys of the
/// stages before it, because it also reads their results. A new stage gets reuse from its declaration (plan/stage.h).
/// tests/engine/test_reuse.c changes every field of every description, and so detects inputs missing in a
/// declaration.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/render/effects/environment/plan.h"
#include "engine/render/effects/visible_light/plan.h"
#include "engine/render/program/program.h"

#include <stdlib.h>
#include <string.h>

static glint_key view_key(const glint_plan *plan, glint_key key)
{
    const glint_plan_camera *c = &plan->camera;
    const double frame[] = { plan->desc.width,     plan->desc.height, plan->desc.samples, plan->desc.seed,
                             plan->desc.precision, c->orthographic,   c->pixel_offset };
    GLINT_KEY_ADD(key, frame);
    GLINT_KEY_ADD(key, c->eye);
    GLINT_KEY_ADD(key, c->forward);
    GLINT_KEY_ADD(key, c->right);
    GLINT_KEY_ADD(key, c->up);
    if (c->span[0] != plan->desc.width || c->span[1] != plan->desc.height)
        GLINT_KEY_ADD(key, c->span);
    if (plan->lens) {
        const double lens[] = { c->aperture, c->focus, c->blades, c->blade_rotation };
        GLINT_KEY_ADD(key, lens);
    }
    return key;
}

static glint_key light_position_key(const glint_plan_light *l, glint_key key)
{
    const double numbers[] = { l->directional,     l->position[0],     l->position[1],
                               l->position[2],     l->coefficients[0], l->coefficients[1],
                               l->coefficients[2], l->is_spot,         l->sample_set_count };
    GLINT_KEY_ADD(key, numbers);
    if (l->is_spot) {
        const double cone[] = { l->spot.axis[0], l->spot.axis[1], l->spot.axis[2],
                                l->spot.outer,   l->spot.inverse, l->spot.exponent };
        GLINT_KEY_ADD(key, cone);
    }
    if (l->cap || l->hard) {
        const double shadow[] = { l->cap ? l->cap->radius : 0, l->radiant_cap, l->hard };
        GLINT_KEY_ADD(key, shadow);
    }
    return l->light_samples ? glint_key_add(key, l->light_samples, l->sample_set_count * sizeof *l->light_samples)
                            : key;
}

static glint_key light_color_key(const glint_plan_light *l, glint_key key)
{
    GLINT_KEY_ADD(key, l->diffuse);
    GLINT_KEY_ADD(key, l->specular);
    return key;
}

static glint_key highlights_key(const glint_plan *plan, glint_key key)
{
    GLINT_KEY_ADD(key, plan->powers);
    GLINT_KEY_ADD(key, plan->facets);
    for (uint32_t i = 0; i < plan->material_count; i++)
        GLINT_KEY_ADD(key, plan->materials[i].highlight);
    return key;
}

/// Continues a key with all programs of a material, and with the ambient light, which multiplies the programs'
/// results instead of the table's values.
static glint_key own_programs_key(const glint_plan *plan, uint32_t i, glint_key key)
{
    if (!plan->patterns)
        return key;
    if (plan->patterns->of[i].any)
        GLINT_KEY_ADD(key, plan->ambient);
    return glint_pattern_key(plan->patterns, i, UINT32_MAX, key);
}

static glint_key material_key(const glint_plan *plan, uint32_t i, glint_key key)
{
    const glint_shade_material *m = &plan->materials[i];
    const double exponent[] = { m->shininess, m->highlight, m->lobe, m->alpha };
    GLINT_KEY_ADD(key, m->diffuse);
    GLINT_KEY_ADD(key, m->specular);
    GLINT_KEY_ADD(key, m->ambient);
    GLINT_KEY_ADD(key, m->grazing);
    GLINT_KEY_ADD(key, exponent);
    return own_programs_key(plan, i, key);
}

/// Returns the key of the fields of a material that are read where the material has no highlight.
static glint_key matte_key(const glint_plan *plan, uint32_t i, glint_key key)
{
    GLINT_KEY_ADD(key, plan->materials[i].diffuse);
    GLINT_KEY_ADD(key, plan->materials[i].ambient);
    return own_programs_key(plan, i, key);
}

static glint_key output_key(const glint_plan *plan, uint64_t which, glint_key key)
{
    const glint_tone_desc *tone = &plan->desc.tone;
    const double numbers[] = {
        plan->desc.codes, tone->curve, tone->transfer, tone->rounding, tone->bits, tone->exposure, tone->dither
    };
    if (which & GLINT_READS(PASSES))
        GLINT_KEY_ADD(key, plan->desc.passes);
    if (which & GLINT_READS(TONE))
        GLINT_KEY_ADD(key, numbers);
    return key;
}

static glint_key background_key(const glint_plan *plan, glint_key key)
{
    const glint_visible_lights *lights = glint_visible_lights_of(plan);
    for (uint32_t i = 0; i < lights->count; i++)
        GLINT_KEY_ADD(key, lights->of[i].shown);
    GLINT_KEY_ADD(key, plan->background);
    if (plan->environment) {
        GLINT_KEY_ADD(key, plan->environment->program->structure);
        GLINT_KEY_ADD(key, plan->environment->program->numbers);
    }
    return key;
}

/// Continues a key with all inputs whose bit is set in `which`.
static glint_key add_inputs(const glint_plan *plan, uint64_t which, glint_key key)
{
    const glint_geometry *geometry = plan->geometry;
    if (which & GLINT_READS(VIEW))
        key = view_key(plan, key);
    if (which & GLINT_READS(POSITIONS))
        GLINT_KEY_ADD(key, plan->where);
    if (which & GLINT_READS(APPEARANCE))
        GLINT_KEY_ADD(key, geometry->look);
    if (which & GLINT_READS(HIGHLIGHTS))
        key = highlights_key(plan, key);
    for (uint32_t i = 0; i < plan->light_count; i++) {
        if (which & GLINT_READS(LIGHT_POSITIONS))
            key = light_position_key(&plan->lights[i], key);
        if (which & GLINT_READS(SHADOWS))
            GLINT_KEY_ADD(key, plan->lights[i].shadows);
        if (which & GLINT_READS(LIGHT_COLORS))
            key = light_color_key(&plan->lights[i], key);
    }
    for (uint32_t i = 0; i < plan->material_count && which & GLINT_READS(MATERIALS); i++)
        key = material_key(plan, i, key);
    for (int id = 0; id < GLINT_STAGE_COUNT; id++)
        if (plan->runs[id] && (which >> (GLINT_PART_OWN + id) & 1 || (which & GLINT_READS(PASSES) && glint_stage_table[id]->passes)))
            key = glint_stage_table[id]->own(plan, key);
    if (which & GLINT_READS(BACKGROUND))
        key = background_key(plan, key);
    if (which & (GLINT_READS(BACKGROUND) | GLINT_READS(TONE)) && plan->desc.alpha)
        GLINT_KEY_ADD(key, plan->desc.alpha);
    return output_key(plan, which, key);
}

/// Returns the key of the light of faces and vertices. It includes the camera only if there are highlights.
static glint_key vertex_key(const glint_plan *plan)
{
    const glint_plan_camera *c = &plan->camera;
    const bool seen = plan->highlights || glint_patterns_see(plan->patterns) || plan->derivatives;
    const double frame[] = { plan->desc.precision, seen ? 1 + c->orthographic : 0 };
    glint_key key = { 0 };
    GLINT_KEY_ADD(key, frame);
    if (seen)
        key = c->orthographic ? glint_key_add(key, c->forward, sizeof c->forward)
                              : glint_key_add(glint_key_add(key, c->eye, sizeof c->eye), c->forward, sizeof c->forward);
    return add_inputs(plan,
                      GLINT_READS(POSITIONS) | GLINT_READS(APPEARANCE) | GLINT_READS_OWN(CUT_OUT) |
                          GLINT_READS(HIGHLIGHTS) | GLINT_READS(LIGHT_POSITIONS) | GLINT_READS(SHADOWS) |
                          GLINT_READS(LIGHT_COLORS) | GLINT_READS(MATERIALS) | GLINT_READS_OWN(TRANSPARENT_SHADOW) |
                          GLINT_READS_OWN(DERIVATIVE) | GLINT_READS_OWN(LIGHT_GROUPS),
                      key);
}

/// Computes the keys of each material and each light, for tiles that depend only on some of them.
static glint_status part_keys(glint_plan *plan, glint_error *error)
{
    const glint_key none = { 0 };
    const glint_key light_base =
        add_inputs(plan, glint_stage_table[GLINT_STAGE_LIGHT]->reads & ~GLINT_READS(LIGHT_POSITIONS),
                   plan->keys[GLINT_STAGE_SURFACE]);
    for (uint32_t i = 0; i < plan->light_count; i++) {
        glint_plan_light *light = &plan->lights[i];
        light->key = light_position_key(light, light_base);
        light->position_key = glint_key_add(light->key, &light->shadows, sizeof light->shadows);
        const uint32_t slot = i % GLINT_LIGHT_CHUNK; // one call of shade sums the samples of a light
        light->color_key = glint_key_add(light_color_key(light, light->position_key), &slot, sizeof slot);
    }
    plan->material_keys = glint_alloc(plan->material_count, sizeof *plan->material_keys);
    plan->matte_keys = glint_alloc(plan->material_count, sizeof *plan->matte_keys);
    if (!plan->material_keys || !plan->matte_keys)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < plan->material_count; i++) {
        plan->material_keys[i] = material_key(plan, i, none);
        plan->matte_keys[i] = matte_key(plan, i, none);
    }
    plan->all_materials_key = add_inputs(
        plan, GLINT_READS(MATERIALS) | GLINT_READS_OWN(TRANSPARENT_SHADOW) | GLINT_READS_OWN(INDIRECT) | GLINT_READS_OWN(BOUNCE) |
                  GLINT_READS_OWN(ROUGH),
        none);
    plan->all_lights_key =
        add_inputs(plan, GLINT_READS(LIGHT_POSITIONS) | GLINT_READS(SHADOWS) | GLINT_READS(LIGHT_COLORS), light_base);
    plan->background_key = add_inputs(plan, GLINT_READS(BACKGROUND), none);
    plan->setting_key = add_inputs(
        plan, GLINT_READS(VIEW) | GLINT_READS(LIGHT_POSITIONS) | GLINT_READS(SHADOWS) | GLINT_READS(LIGHT_COLORS),
        none);
    uint64_t output = GLINT_READS_OWN(DERIVATIVE) | GLINT_READS(PASSES) | GLINT_READS(TONE);
    for (int id = 0; id < GLINT_STAGE_COUNT; id++)
        output |= (uint64_t)glint_stage_table[id]->scales << (GLINT_PART_OWN + id);
    plan->output_key = add_inputs(plan, output, none);
    return GLINT_OK;
}

glint_status glint_plan_keys(glint_plan *plan, glint_error *error)
{
    glint_key key = { 0 };
    for (int id = 0; id < GLINT_STAGE_COUNT; id++) {
        plan->keys[id] = add_inputs(plan, glint_stage_table[id]->reads, key);
        if (!glint_stage_table[id]->aside)
            key = plan->keys[id];
    }
    plan->vertex_key = vertex_key(plan);
    return part_keys(plan, error);
}

bool glint_plan_twin_make(glint_plan_twin *twin, const glint_plan *plan, glint_key where)
{
    glint_error error;
    twin->plan = *plan;
    twin->plan.where = where;
    twin->plan.material_keys = twin->plan.matte_keys = NULL;
    twin->plan.lights = malloc((plan->light_count + 1) * sizeof *plan->lights);
    if (!twin->plan.lights)
        return false;
    if (plan->light_count)
        memcpy(twin->plan.lights, plan->lights, plan->light_count * sizeof *plan->lights);
    return glint_plan_keys(&twin->plan, &error) == GLINT_OK;
}

void glint_plan_twin_free(glint_plan_twin *twin)
{
    free(twin->plan.lights);
    free(twin->plan.material_keys);
    free(twin->plan.matte_keys);
}
