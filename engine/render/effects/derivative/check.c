/// Refuses frames with effects that have no derivative.
#include "engine/base/status.h"
#include "engine/render/effects/bounce/plan.h"
#include "engine/render/effects/derivative/slopes.h"
#include "engine/render/program/program.h"

/// Returns whether a surface or the eye moves.
static bool moves(const glint_plan *plan, const glint_plan_derivative *d)
{
    bool any = d->view.moves;
    for (uint32_t i = 0; i < plan->geometry->part_count; i++)
        any = any || d->parts[i].moves;
    return any;
}

/// Returns whether something changes with a derivative.
static bool varies(const glint_plan *plan, const glint_plan_derivatives *all, const glint_plan_derivative *d)
{
    if (!d->materials)
        return false;
    bool any = moves(plan, d) || d->fades || glint_any_slope(d->background) || (d->weighs && plan->runs[GLINT_STAGE_BOUNCE]);
    for (size_t i = 0; i < plan->geometry->materials.count; i++)
        any = any || d->materials[i].varies || d->bounces[i].clear != 0 ||
              (plan->tints && glint_any_slope(d->bounces[i].transmission));
    for (size_t i = 0; i < all->light_count; i++)
        any = any || d->lights[i].varies;
    return any;
}

/// Returns the name of an effect without derivatives in the frame, or NULL.
static const char *find_obstacle(const glint_plan *plan)
{
    if (plan->runs[GLINT_STAGE_INDIRECT])
        return "scene.indirect: indirect light and ambient occlusion have no derivative; remove them";
    return NULL;
}

/// Returns whether a material has a pattern, or a shader that reads surface coordinates or footprints. Motion
/// changes these, and that is not differentiated.
static bool is_painted(const glint_plan_pattern *pattern)
{
    const uint32_t unknown = GLINT_READS_UV | 1u << GLINT_INPUT_FOOTPRINT;
    const glint_program *shader = pattern->program[GLINT_FIELD_SHADER];
    bool any = pattern->cut || (shader && shader->inputs & unknown);
    for (int field = 0; field < GLINT_FIELD_SHADER; field++)
        any = any || pattern->program[field];
    return any;
}

static bool is_any_painted(const glint_plan *plan)
{
    for (uint32_t i = 0; plan->patterns && i < plan->material_count; i++)
        if (is_painted(&plan->patterns->of[i]))
            return true;
    return false;
}

/// Returns whether the rays that a surface reflects or refracts change.
static bool sends_on_differently(const glint_derivative_bounce *slope)
{
    return glint_any_slope(slope->mirror) || glint_any_slope(slope->transmission) || slope->ior != 0;
}

/// Returns the name of an effect without derivatives beyond the first surface, or NULL.
static const char *find_bounce_obstacle(const glint_plan *plan, const glint_plan_derivative *d)
{
    bool absorbs = false;
    for (size_t i = 0; i < plan->geometry->materials.count; i++) {
        const glint_material_desc *desc = glint_plan_material(plan, i);
        if (glint_any_slope(d->bounces[i].mirror) && !glint_material_mirrors(desc))
            return "material.mirror: 0 has no derivative, because no ray is reflected; use a value above 0";
        if (glint_any_slope(d->bounces[i].transmission) && !glint_material_transmits(desc))
            return "material.transmission: 0 has no derivative, because no ray is transmitted; use a value above 0";
        if (plan->bouncing && plan->bouncing[i].rough && sends_on_differently(&d->bounces[i]))
            return "material.roughness: rays that a rough surface reflects or refracts have no derivative; make it "
                   "smooth";
        if (plan->tints && d->programs[i].of[GLINT_FIELD_TRANSMISSION])
            return "material.transmission: light through a patterned material has no derivative by the pattern; set "
                   "shadows = false for the lights";
        absorbs = absorbs || glint_any_slope(d->bounces[i].absorption);
    }
    if (d->bends && is_any_painted(plan))
        return "material: moving objects or bending rays has no derivative where materials have patterns or bumps, "
               "or shaders that read uv or footprint; use plain numbers in all materials";
    const int *plane = plan->patterns ? plan->patterns->plane : NULL;
    if (plan->tints && plane && plane[GLINT_FIELD_CLEAR] >= 0 && d->moves)
        return "material.opacity: light through a material with a pattern of opacity has no derivative by movement; "
               "set shadows = false for the lights";
    if (plan->tints && plane && plane[GLINT_FIELD_TRANSMISSION] >= 0 && d->moves)
        return "material.transmission: light through a patterned material has no derivative by movement; set shadows "
               "= false for the lights";
    if (plan->environment && d->bends && plan->runs[GLINT_STAGE_BOUNCE])
        return "background: moving objects or bending rays has no derivative where mirrors or glass may show a "
               "pattern or texture as the background; use a plain colour";
    if (plan->absorbs_transmitted && (absorbs || d->moves))
        return "absorption: light through an absorbing material has no derivative by absorption or movement; set "
               "shadows = false for the lights";
    const bool thins = plan->eye_medium.on && glint_any_slope(d->bounces[plan->eye_medium.material].absorption);
    if (plan->runs[GLINT_STAGE_DEPTH_CUE] && plan->runs[GLINT_STAGE_VISIBLE_LIGHT] && (d->bends || d->fades || thins))
        return "scene.depth_cue, absorption: movement and fading have no derivative where visible lights may be "
               "seen; set visible = false for the lights";
    if (plan->absorbs && plan->runs[GLINT_STAGE_VISIBLE_LIGHT] && d->bends)
        return "absorption: movement has no derivative where visible lights may be seen through an absorbing "
               "material; set visible = false for the lights";
    return NULL;
}

static glint_status check_light(const glint_plan *plan, const glint_plan_derivative *d, const glint_scene *scene,
                                size_t index, glint_error *error)
{
    const glint_light_desc *desc = &glint_scene_light(scene, index)->desc;
    char name[2 * GLINT_NAME_SIZE];
    double shown[3];
    const char *why = NULL;
    if (d->lights[index].varies && desc->visible && glint_light_shows(desc, shown))
        why = "visible: the appearance of a light itself has no derivative; set visible = false";
    for (uint32_t k = 0; k < plan->light_count; k++) {
        const glint_plan_light *row = &plan->lights[k];
        const bool moves = d->lights[index].moves || d->bends;
        if (row->source != index)
            continue;
        if (row->cap && (moves || glint_has_slope(d->lights[index].coefficients, 3)))
            why = "position, attenuation: movement has no derivative with shadow = \"caps\"; set shadow = \"rays\"";
        else if (moves && row->light_samples && row->light_samples->emission == GLINT_EMIT_CONE)
            why = "position: movement has no derivative with a sphere light that has a radiance; set its intensity "
                  "instead";
    }
    if (!why)
        return GLINT_OK;
    glint_describe_light(desc, index + 1, name, sizeof name);
    return glint_fail(error, GLINT_ERR_INVALID, "derivative '%s': %s: %s", d->name, name, why);
}

glint_status glint_derivative_check(const glint_plan *plan, const glint_scene *scene, glint_error *error)
{
    const glint_plan_derivatives *all = plan->derivatives;
    const char *why = all ? find_obstacle(plan) : NULL;
    glint_status status = GLINT_OK;
    if (why)
        return glint_fail(error, GLINT_ERR_INVALID, "derivative '%s': %s", all->of[0].name, why);
    for (size_t i = 0; all && i < all->count; i++) {
        const glint_plan_derivative *d = &all->of[i];
        if (d->view.moves && plan->environment)
            return glint_fail(error, GLINT_ERR_INVALID, "derivative '%s': background: a camera has no derivative "
                                                        "with a pattern or texture as the background; use a plain "
                                                        "colour", d->name);
        if ((why = find_bounce_obstacle(plan, d)))
            return glint_fail(error, GLINT_ERR_INVALID, "derivative '%s': %s", d->name, why);
        if (!varies(plan, all, d) && !varies(plan, all, &all->level[i])) // otherwise it is 0 here, but may not be elsewhere
            return glint_fail(error, GLINT_ERR_INVALID, "derivative '%s': nothing in the scene depends on it", d->name);
        for (size_t k = 0; k < all->light_count && !status; k++)
            status = d->lights[k].varies || d->bends ? check_light(plan, d, scene, k, error) : GLINT_OK;
        if (status)
            return status;
    }
    return status;
}
