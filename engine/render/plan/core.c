/// The declarations of the core's stages.
#include "engine/render/plan/plan.h"

static bool has_surfaces(const glint_plan *plan) { return plan->geometry->table.prim_count > 0; }
static bool always(const glint_plan *plan) { return plan != NULL; }
static bool has_rays(const glint_plan *plan)
{
    return has_surfaces(plan) || plan->own[GLINT_STAGE_VISIBLE_LIGHT] || plan->environment;
}
static bool casts_shadows(const glint_plan *plan) { return glint_plan_is_lit(plan) && plan->shadow_count > 0; }
static bool accumulates(const glint_plan *plan) { return plan->accumulate; }
static bool has_codes(const glint_plan *plan) { return plan->desc.codes; }

const glint_stage glint_stage_camera = {
    .name = "camera",
    .doc = "rays of each sample",
    .called = has_rays,
    .reads = GLINT_READS(VIEW),
};

const glint_stage glint_stage_cast = {
    .name = "cast",
    .doc = "nearest object and distance of each ray",
    .called = has_surfaces,
    .reads = GLINT_READS(POSITIONS) | GLINT_READS_OWN(CUT_OUT),
};

const glint_stage glint_stage_surface = {
    .name = "surface",
    .doc = "point, normal and material of each hit",
    .called = has_surfaces,
    .reads = GLINT_READS(APPEARANCE),
};

const glint_stage glint_stage_light = {
    .name = "light",
    .doc = "direction, distance and highlight angle of each light",
    .called = glint_plan_is_lit,
    .reads = GLINT_READS(LIGHT_POSITIONS) | GLINT_READS(HIGHLIGHTS) | GLINT_READS_OWN(BUMP),
    .per_light = true,
};

const glint_stage glint_stage_occlude = {
    .name = "occlude",
    .doc = "which points each shadow-casting light reaches",
    .called = casts_shadows,
    .reads = GLINT_READS(SHADOWS) | GLINT_READS_OWN(TRANSPARENT_SHADOW),
    .per_light = true,
    .walks = true,
};

const glint_stage glint_stage_shade = {
    .name = "shade",
    .doc = "ambient, diffuse and specular terms",
    .called = always,
    .reads = GLINT_READS(LIGHT_COLORS) | GLINT_READS(MATERIALS) | GLINT_READS(BACKGROUND),
};

const glint_stage glint_stage_resolve = {
    .name = "resolve",
    .doc = "mean of samples and lights",
    .called = accumulates,
    .reads = GLINT_READS(PASSES),
};

const glint_stage glint_stage_tone = {
    .name = "tone",
    .doc = "light to 8-bit or 16-bit values",
    .called = has_codes,
    .reads = GLINT_READS(TONE),
};
