/// The stages of a frame, in the order in which a frame runs them: STAGE(ID, name) for each one, declared as
/// glint_stage_NAME. Internal. A new stage is a folder and a row here.
///
/// A stage's key contains the keys of the stages before it, and the key of a picture is that of `adaptive`. So stages that
/// change light stand before `adaptive`; those that scale it stand after `depth_cue`, which adds up the light anew.
#ifndef GLINT_EFFECTS_LIST_H
#define GLINT_EFFECTS_LIST_H

#define GLINT_STAGES(STAGE) \
    STAGE(CAMERA, camera) \
    STAGE(CAST, cast) \
    STAGE(VISIBLE_LIGHT, visible_light) \
    STAGE(SURFACE, surface) \
    STAGE(PATTERN, pattern) \
    STAGE(MICROFACET_VIEW, microfacet_view) \
    STAGE(LIGHT, light) \
    STAGE(SHUTTER, shutter) \
    STAGE(MICROFACET, microfacet) \
    STAGE(OCCLUDE, occlude) \
    STAGE(VERTEX_SHADING, vertex_shading) \
    STAGE(SHADE, shade) \
    STAGE(SHADER, shader) \
    STAGE(ENVIRONMENT, environment) \
    STAGE(INDIRECT, indirect) \
    STAGE(BOUNCE, bounce) \
    STAGE(ROUGH, rough) \
    STAGE(DEPTH_CUE, depth_cue) \
    STAGE(ADAPTIVE, adaptive) \
    STAGE(RESOLVE, resolve) \
    STAGE(TONE, tone) \
    STAGE(OUTLINE, outline) \
    STAGE(DERIVATIVE, derivative) \
    STAGE(TRANSPARENT_SHADOW, transparent_shadow) \
    STAGE(CUT_OUT, cut_out) \
    STAGE(BUMP, bump) \
    STAGE(LIGHT_GROUPS, light_groups) \
    STAGE(RASTER, raster)

#endif
