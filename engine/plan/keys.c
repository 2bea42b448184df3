/// The keys of a plan: what each stage declares to read, hashed. A stage's key holds the keys of the stages before it,
/// whose results it reads too. A new stage gets reuse by a row in `stages`; tests/engine/test_reuse.c changes every field of
/// every description and finds what a row forgets.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/effects/light_groups/plan.h"
#include "engine/program/program.h"

#include <stdlib.h>
#include <string.h>

/// What there is to read, described or derived.
typedef enum input {
    INPUT_VIEW, ///< camera, picture size, samples
    INPUT_PLACES, ///< where the surfaces are
    INPUT_VISIBLE_LIGHT_PLACES, ///< where lights are seen
    INPUT_LOOKS, ///< which material each has, and its sides
    INPUT_PATTERNS, ///< programs that give numbers of materials, and where the shapes' own spaces are
    INPUT_CUT_OUTS, ///< programs that say where surfaces have holes, and materials that are not there
    INPUT_BUMPS, ///< programs that turn normals
    INPUT_HIGHLIGHTS, ///< what kind of highlight each material has
    INPUT_LIGHT_PLACES, ///< kind, position, fall-off
    INPUT_SHADOWS, ///< which lights cast them
    INPUT_LIGHT_COLORS,
    INPUT_MATERIALS, ///< reflectances, exponents
    INPUT_BACKGROUND, ///< a colour or a program, and what lights look like
    INPUT_TINTS, ///< what light is left of by the transparent, where it tints shadows
    INPUT_INDIRECT, ///< how many paths of light are followed, how far, and what stands for the rest
    INPUT_BOUNCES, ///< what materials send on, how far, and through what
    INPUT_ADAPTIVE, ///< how much neighbours must differ, and how they are shown
    INPUT_DEPTH_CUE, ///< how light fades with the distance from the eye
    INPUT_DERIVATIVES, ///< slopes of what shading reads
    INPUT_PASSES,
    INPUT_TONE
} input;

#define READS(what) (1u << INPUT_##what)

static const uint32_t stages[GLINT_STAGE_COUNT] = {
    [GLINT_STAGE_CAMERA] = READS(VIEW),
    [GLINT_STAGE_CAST] = READS(PLACES) | READS(CUT_OUTS),
    [GLINT_STAGE_VISIBLE_LIGHT] = READS(VISIBLE_LIGHT_PLACES),
    [GLINT_STAGE_SURFACE] = READS(LOOKS),
    [GLINT_STAGE_PATTERN] = READS(PATTERNS),
    [GLINT_STAGE_VIEW] = READS(BUMPS),
    [GLINT_STAGE_LIGHT] = READS(LIGHT_PLACES) | READS(HIGHLIGHTS) | READS(BUMPS),
    [GLINT_STAGE_FACET] = 0,
    [GLINT_STAGE_OCCLUDE] = READS(SHADOWS) | READS(TINTS),
    [GLINT_STAGE_VERTEX] = READS(LIGHT_COLORS) | READS(MATERIALS),
    [GLINT_STAGE_SHADE] = READS(LIGHT_COLORS) | READS(MATERIALS) | READS(BACKGROUND),
    [GLINT_STAGE_SHADER] = 0,
    [GLINT_STAGE_ENVIRONMENT] = 0, // `shade` declares what it reads
    [GLINT_STAGE_INDIRECT] = READS(INDIRECT) | READS(BOUNCES),
    [GLINT_STAGE_BOUNCE] = READS(BOUNCES),
    [GLINT_STAGE_DEPTH_CUE] = READS(DEPTH_CUE),
    [GLINT_STAGE_REFINE] = READS(ADAPTIVE),
    [GLINT_STAGE_RESOLVE] = READS(PASSES),
    [GLINT_STAGE_TONE] = READS(TONE),
    [GLINT_STAGE_OUTLINE] = 0,
    [GLINT_STAGE_DERIVATIVE] = READS(DERIVATIVES),
};

#define ADD(key, value) ((key) = glint_key_add((key), &(value), sizeof(value)))

static glint_key view_key(const glint_plan *plan, glint_key key)
{
    const glint_plan_camera *c = &plan->camera;
    const double frame[] = { plan->desc.width,     plan->desc.height, plan->desc.samples, plan->desc.seed,
                             plan->desc.precision, c->orthographic,   c->pixel_offset };
    ADD(key, frame);
    ADD(key, c->eye);
    ADD(key, c->forward);
    ADD(key, c->right);
    ADD(key, c->up);
    if (plan->lens) {
        const double lens[] = { c->aperture, c->focus, c->blades, c->blade_rotation };
        ADD(key, lens);
    }
    return key;
}

static glint_key light_place_key(const glint_plan_light *l, glint_key key)
{
    const double numbers[] = { l->directional,     l->position[0],     l->position[1],
                               l->position[2],     l->coefficients[0], l->coefficients[1],
                               l->coefficients[2], l->is_spot,         l->turn_count };
    ADD(key, numbers);
    if (l->is_spot) {
        const double cone[] = { l->spot.axis[0], l->spot.axis[1], l->spot.axis[2],
                                l->spot.outer,   l->spot.inverse, l->spot.exponent };
        ADD(key, cone);
    }
    if (l->cap || l->hard) {
        const double shadow[] = { l->cap ? l->cap->radius : 0, l->radiant_cap, l->hard };
        ADD(key, shadow);
    }
    return l->light_samples ? glint_key_add(key, l->light_samples, l->turn_count * sizeof *l->light_samples) : key;
}

static glint_key light_color_key(const glint_plan_light *l, glint_key key)
{
    ADD(key, l->diffuse);
    ADD(key, l->specular);
    return key;
}

static glint_key visible_light_place_key(const glint_plan_visible_light *visible_light, glint_key key)
{
    const double kind[] = { visible_light->ball, visible_light->one_sided, visible_light->radius,
                            (double)visible_light->edge_count };
    ADD(key, kind);
    ADD(key, visible_light->center);
    ADD(key, visible_light->normal);
    return glint_key_add(key, visible_light->edges, visible_light->edge_count * sizeof *visible_light->edges);
}

static glint_key highlights_key(const glint_plan *plan, glint_key key)
{
    ADD(key, plan->powers);
    ADD(key, plan->facets);
    for (uint32_t i = 0; i < plan->material_count; i++)
        ADD(key, plan->materials[i].highlight);
    return key;
}

/// Of materials with programs: those of `fields`, a bit each, and where the shapes are that show them.
static glint_key programs_key(const glint_plan *plan, uint32_t fields, glint_key key)
{
    for (uint32_t i = 0; plan->patterns && i < plan->material_count; i++)
        key = glint_pattern_key(plan->patterns, i, fields, key);
    return key;
}

static glint_key cut_outs_key(const glint_plan *plan, glint_key key)
{
    for (uint32_t i = 0; i < plan->material_count; i++)
        ADD(key, plan->patterns->of[i].cut);
    ADD(key, plan->geometry->look); // which material a surface has
    return programs_key(plan, 1u << GLINT_FIELD_OPACITY, key);
}

/// All programs of a material; with them goes the ambient light, which is multiplied by what they give and not by its table.
static glint_key own_programs_key(const glint_plan *plan, uint32_t i, glint_key key)
{
    if (!plan->patterns)
        return key;
    if (plan->patterns->of[i].any)
        ADD(key, plan->ambient);
    return glint_pattern_key(plan->patterns, i, UINT32_MAX, key);
}

static glint_key material_key(const glint_plan *plan, uint32_t i, glint_key key)
{
    const glint_shade_material *m = &plan->materials[i];
    const double exponent[] = { m->shininess, m->highlight, m->lobe, m->alpha };
    ADD(key, m->diffuse);
    ADD(key, m->specular);
    ADD(key, m->ambient);
    ADD(key, m->grazing);
    ADD(key, exponent);
    return own_programs_key(plan, i, key);
}

/// What of a material is read where it has no highlight.
static glint_key matte_key(const glint_plan *plan, uint32_t i, glint_key key)
{
    ADD(key, plan->materials[i].diffuse);
    ADD(key, plan->materials[i].ambient);
    return own_programs_key(plan, i, key);
}

static glint_key transparent_shadow_key(const glint_bounce_material *m, glint_key key)
{
    ADD(key, m->transmission);
    ADD(key, m->absorption);
    return key;
}

static glint_key bounces_key(const glint_plan *plan, glint_key key)
{
    ADD(key, plan->desc.max_depth);
    for (uint32_t i = 0; i < plan->material_count; i++) {
        const glint_bounce_material *m = &plan->bouncing[i];
        const double numbers[] = { m->ior, m->fresnel };
        key = transparent_shadow_key(m, key);
        ADD(key, m->mirror);
        ADD(key, numbers);
    }
    return key;
}

static glint_key indirect_key(const glint_plan *plan, glint_key key)
{
    ADD(key, plan->indirect.samples);
    ADD(key, plan->indirect.bounces);
    if (plan->indirect.is_sky)
        ADD(key, plan->indirect.distance);
    return glint_key_add(key, plan->indirect.rest, plan->material_count * sizeof *plan->indirect.rest);
}

static glint_key output_key(const glint_plan *plan, uint32_t which, glint_key key)
{
    const glint_tone_desc *tone = &plan->desc.tone;
    const double numbers[] = {
        plan->desc.codes, tone->curve, tone->transfer, tone->rounding, tone->bits, tone->exposure
    };
    if (which & READS(PASSES))
        ADD(key, plan->desc.passes);
    if (which & READS(PASSES))
        key = glint_light_groups_key(plan, key);
    if (which & READS(PASSES) && plan->desc.outline)
        ADD(key, plan->desc.outline);
    if (which & READS(TONE))
        ADD(key, numbers);
    return key;
}

static glint_key background_key(const glint_plan *plan, glint_key key)
{
    ADD(key, plan->background);
    if (plan->environment) {
        ADD(key, plan->environment->program->structure);
        ADD(key, plan->environment->program->numbers);
    }
    return key;
}

/// Continues a key with everything in `which`.
static glint_key add_inputs(const glint_plan *plan, uint32_t which, glint_key key)
{
    const glint_geometry *geometry = plan->geometry;
    if (which & READS(VIEW))
        key = view_key(plan, key);
    if (which & READS(PLACES))
        ADD(key, plan->where);
    if (which & READS(LOOKS))
        ADD(key, geometry->look);
    if (which & READS(PATTERNS))
        key = programs_key(plan, GLINT_FIELDS_PLANES, key);
    if (which & READS(CUT_OUTS) && glint_plan_cuts(plan))
        key = cut_outs_key(plan, key);
    if (which & READS(BUMPS))
        key = programs_key(plan, 1u << GLINT_FIELD_BUMP, key);
    if (which & READS(HIGHLIGHTS))
        key = highlights_key(plan, key);
    for (uint32_t i = 0; i < plan->visible_light_count && which & READS(VISIBLE_LIGHT_PLACES); i++)
        key = visible_light_place_key(&plan->visible_lights[i], key);
    for (uint32_t i = 0; i < plan->light_count; i++) {
        if (which & READS(LIGHT_PLACES))
            key = light_place_key(&plan->lights[i], key);
        if (which & READS(SHADOWS))
            ADD(key, plan->lights[i].shadows);
        if (which & READS(LIGHT_COLORS))
            key = light_color_key(&plan->lights[i], key);
    }
    for (uint32_t i = 0; i < plan->material_count && which & READS(MATERIALS); i++)
        key = material_key(plan, i, key);
    for (uint32_t i = 0; i < plan->material_count && which & READS(TINTS) && plan->tints; i++)
        key = transparent_shadow_key(&plan->bouncing[i], key);
    if (which & READS(INDIRECT) && plan->runs[GLINT_STAGE_INDIRECT])
        key = indirect_key(plan, key);
    if (which & READS(BOUNCES) && plan->runs[GLINT_STAGE_BOUNCE])
        key = bounces_key(plan, key);
    if (which & READS(ADAPTIVE) && plan->runs[GLINT_STAGE_REFINE]) {
        const double seen[] = { plan->desc.adaptive, plan->desc.tone.curve, plan->desc.tone.exposure };
        ADD(key, seen);
    }
    if (which & READS(DEPTH_CUE) && plan->depth_cue.on) {
        ADD(key, plan->depth_cue.color);
        ADD(key, plan->depth_cue.near);
        ADD(key, plan->depth_cue.far);
    }
    if (which & READS(DEPTH_CUE) && plan->veil.on)
        ADD(key, plan->veil.absorption);
    for (size_t i = 0; which & READS(DERIVATIVES) && plan->derivatives && i < plan->derivatives->count; i++)
        key = glint_derivative_key(plan, i, key);
    if (which & READS(BACKGROUND))
        key = background_key(plan, key);
    if (which & (READS(BACKGROUND) | READS(TONE)) && plan->desc.alpha)
        ADD(key, plan->desc.alpha);
    for (uint32_t i = 0; i < plan->visible_light_count && which & READS(BACKGROUND); i++)
        ADD(key, plan->visible_lights[i].shown);
    return output_key(plan, which, key);
}

/// What sites are lit by. Where no material has a highlight, nothing of the camera.
static glint_key vertex_key(const glint_plan *plan)
{
    const glint_plan_camera *c = &plan->camera;
    const bool seen = plan->highlights || glint_patterns_see(plan->patterns) || plan->derivatives;
    const double frame[] = { plan->desc.precision, seen ? 1 + c->orthographic : 0 };
    glint_key key = { 0 };
    ADD(key, frame);
    key = glint_light_groups_key(plan, key);
    if (seen)
        key = c->orthographic ? glint_key_add(key, c->forward, sizeof c->forward)
                              : glint_key_add(glint_key_add(key, c->eye, sizeof c->eye), c->forward, sizeof c->forward);
    return add_inputs(plan,
                      READS(PLACES) | READS(LOOKS) | READS(CUT_OUTS) | READS(HIGHLIGHTS) | READS(LIGHT_PLACES) |
                          READS(SHADOWS) | READS(LIGHT_COLORS) | READS(MATERIALS) | READS(TINTS) | READS(DERIVATIVES),
                      key);
}

/// The keys of the parts that a tile may depend on alone.
static glint_status part_keys(glint_plan *plan, glint_error *error)
{
    const glint_key none = { 0 };
    const glint_key light_base =
        add_inputs(plan, stages[GLINT_STAGE_LIGHT] & ~READS(LIGHT_PLACES), plan->keys[GLINT_STAGE_SURFACE]);
    for (uint32_t i = 0; i < plan->light_count; i++) {
        glint_plan_light *light = &plan->lights[i];
        light->key = light_place_key(light, light_base);
        light->place_key = glint_key_add(light->key, &light->shadows, sizeof light->shadows);
        const uint32_t place = i % GLINT_LIGHT_CHUNK; // samples of a lamp are added up a call of shade at a time
        light->look_key = glint_key_add(light_color_key(light, light->place_key), &place, sizeof place);
    }
    plan->material_keys = glint_alloc(plan->material_count, sizeof *plan->material_keys);
    plan->matte_keys = glint_alloc(plan->material_count, sizeof *plan->matte_keys);
    if (!plan->material_keys || !plan->matte_keys)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < plan->material_count; i++) {
        plan->material_keys[i] = material_key(plan, i, none);
        plan->matte_keys[i] = matte_key(plan, i, none);
    }
    plan->all_materials_key =
        add_inputs(plan, READS(MATERIALS) | READS(TINTS) | READS(INDIRECT) | READS(BOUNCES), none);
    plan->all_lights_key = add_inputs(plan, READS(LIGHT_PLACES) | READS(SHADOWS) | READS(LIGHT_COLORS), light_base);
    plan->background_key = add_inputs(plan, READS(BACKGROUND), none);
    plan->setting_key =
        add_inputs(plan, READS(VIEW) | READS(LIGHT_PLACES) | READS(SHADOWS) | READS(LIGHT_COLORS), none);
    plan->output_key = add_inputs(plan, READS(DEPTH_CUE) | READS(DERIVATIVES) | READS(PASSES) | READS(TONE), none);
    return GLINT_OK;
}

glint_status glint_plan_keys(glint_plan *plan, glint_error *error)
{
    glint_key key = { 0 };
    for (int id = 0; id < GLINT_STAGE_COUNT; id++) {
        plan->keys[id] = add_inputs(plan, stages[id], key);
        if (id != GLINT_STAGE_PATTERN) // the next stages do not read it; those that do read the materials
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
