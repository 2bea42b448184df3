/// Stands in for the effects that a build leaves out (make WITHOUT="indirect bounce"): declarations that no frame
/// calls for and that refuse scenes which need the effect, and the effects' public functions.
#include "engine/base/status.h"
#include "engine/effects/environment/sky.h"
#include "engine/effects/prepare.h"
#include "engine/plan/light_groups.h"
#include "engine/scene/objects.h"
#include <stdlib.h>

static bool never(const glint_plan *plan)
{
    (void)plan;
    return false;
}

static inline bool any_material(const glint_plan *plan, bool (*test)(const glint_material_desc *desc))
{
    bool any = false;
    for (size_t i = 0; i < plan->geometry->materials.count; i++)
        any = any || test(glint_plan_material(plan, i));
    return any;
}

static inline bool any_light_shows(const glint_scene *scene)
{
    double shown[3];
    bool any = false;
    for (size_t i = 0; i < scene->lights.count; i++)
        any = any || glint_light_shows(&glint_scene_light(scene, i)->desc, shown);
    return any;
}

static inline bool has_media(const glint_plan *plan)
{
    return plan->translucent || any_material(plan, glint_material_transmits);
}

#define MESSAGE(field, what, effect) field ": this build has no " what " (WITHOUT=" effect ")"

/// Declares the stage NAME of `effect`: `asked` is whether the plan needs it.
#define LEFT_OUT(name, effect, field, what, asked) \
    static glint_status refuse_##name(glint_plan *plan, const glint_plan_input *from, glint_error *error) \
    { \
        (void)plan, (void)from; \
        return (asked) ? glint_fail(error, GLINT_ERR_UNSUPPORTED, MESSAGE(field, what, effect)) : GLINT_OK; \
    } \
    const glint_stage glint_stage_##name = { .prepare = refuse_##name, .called = never };

#ifdef GLINT_LACKS_bounce
LEFT_OUT(bounce, "bounce", "material", "mirrors and transparent materials", has_media(plan) || any_material(plan, glint_material_mirrors))
#endif
#ifdef GLINT_LACKS_bump
LEFT_OUT(bump, "bump", "material.bump", "bumps", glint_plan_bumps(plan))
#endif
#ifdef GLINT_LACKS_cut_out
LEFT_OUT(cut_out, "cut_out", "material.opacity", "cut-outs", glint_plan_cuts(plan))
#endif
#ifdef GLINT_LACKS_depth_cue
LEFT_OUT(depth_cue, "depth_cue", "scene.depth_cue", "light that fades with the distance", from->scene->desc.has_depth_cue || plan->veil.on)
#endif
#ifdef GLINT_LACKS_derivative
LEFT_OUT(derivative, "derivative", "derivatives", "derivatives", from->desc->derivative_count > 0)
#endif
#ifdef GLINT_LACKS_environment
LEFT_OUT(environment, "environment", "scene.background", "pattern or texture as the background", from->scene->desc.background_program)

glint_status glint_sky_find(glint_plan *plan, glint_error *error)
{
    (void)plan, (void)error;
    return GLINT_OK;
}

void glint_sky_draw(const glint_sky *sky, const double u[2], double direction[3])
{
    (void)sky, (void)u, (void)direction;
}

double glint_sky_density(const glint_sky *sky, const double direction[3])
{
    (void)sky, (void)direction;
    return 0;
}
#endif
#ifdef GLINT_LACKS_indirect
LEFT_OUT(indirect, "indirect", "scene", "indirect light and ambient occlusion", glint_plan_has_indirect(&from->scene->desc))
#endif
#ifdef GLINT_LACKS_light_groups
LEFT_OUT(light_groups, "light_groups", "light_passes", "light passes", plan->light_groups)
#endif
#ifdef GLINT_LACKS_microfacet
LEFT_OUT(view, "microfacet", "material.model", "microfacets", plan->facets)
LEFT_OUT(facet, "microfacet", "material.model", "microfacets", plan->facets)
#endif
#ifdef GLINT_LACKS_outline
LEFT_OUT(outline, "outline", "outline", "outlines", plan->desc.passes >> GLINT_PASS_OUTLINE & 1)
#endif
#ifdef GLINT_LACKS_raster
LEFT_OUT(raster, "raster", "visibility", "scan conversion", plan->desc.visibility == GLINT_VISIBILITY_SCAN)
#endif
#ifdef GLINT_LACKS_rough
LEFT_OUT(rough, "rough", "material.roughness", "rays of rough surfaces", plan->rough_samples > 0)
#endif
#ifdef GLINT_LACKS_transparent_shadow
LEFT_OUT(tint, "transparent_shadow", "material", "light through transparent objects", has_media(plan) && plan->shadow_count > 0)
#endif
#ifdef GLINT_LACKS_vertex_shading
LEFT_OUT(vertex, "vertex_shading", "mesh.shading", "flat and Gouraud shading",
         glint_plan_is_lit(plan) && plan->geometry->table.shading_point_count > 0)
#endif
#ifdef GLINT_LACKS_visible_light
LEFT_OUT(visible_light, "visible_light", "light.visible", "visible lights", any_light_shows(from->scene))
#endif

#ifdef GLINT_LACKS_shutter
LEFT_OUT(shutter, "shutter", "camera.shutter", "shutter", from->times)

glint_render_desc glint_shutter_desc(const glint_render_desc *frame)
{
    return frame ? *frame : (glint_render_desc) { 0 };
}

glint_status glint_plan_create_exposed(const glint_scene *scene, const glint_render_desc *desc, glint_plan **times,
                                       size_t count, glint_plan **out, glint_error *error)
{
    (void)scene, (void)desc, (void)out;
    for (size_t i = 0; times && i < count; i++)
        glint_plan_destroy(times[i]);
    free(times);
    return glint_fail(error, GLINT_ERR_UNSUPPORTED, MESSAGE("camera.shutter", "shutter", "shutter"));
}
#endif
