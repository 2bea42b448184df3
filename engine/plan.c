#include "engine/plan.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"

#include <stdlib.h>

const char *const glint_stage_names[GLINT_STAGE_COUNT] = { "camera",  "cast",  "surface", "light",
                                                           "occlude", "shade", "resolve", "tone" };

glint_status glint_choose_isa(const char *isa, const glint_stages **out, glint_error *error)
{
    const char *asked, *who = isa && *isa ? "isa" : "GLINT_ISA";
    bool unknown;
    *out = glint_stages_select(isa, &asked, &unknown);
    if (*out)
        return GLINT_OK;
    if (unknown)
        return glint_fail(error, GLINT_ERR_INVALID, "%s: ref, sse2, avx2 or avx512 expected, got '%s'", who, asked);
    return glint_fail(error, GLINT_ERR_UNSUPPORTED, "%s: this machine lacks '%s'", who, asked);
}

glint_render_desc glint_render_desc_default(void)
{
    return (glint_render_desc) {
        .width = 1280, .height = 720, .samples = 1, .passes = 1u << GLINT_PASS_BEAUTY, .tone = glint_tone_desc_default()
    };
}

static glint_status check_render_desc(const glint_render_desc *desc, glint_error *error)
{
    glint_status status = glint_check_whole("width", desc->width, 1, GLINT_SIDE_MAX, error);
    if (!status)
        status = glint_check_whole("height", desc->height, 1, GLINT_SIDE_MAX, error);
    if (!status && desc->width * desc->height > INT32_MAX)
        status = glint_fail(error, GLINT_ERR_INVALID,
                            "width: at most 2147483647 pixels in an image expected, got %.0f x %.0f", desc->width,
                            desc->height);
    if (!status)
        status = glint_check_whole("samples", desc->samples, 1, 65536, error);
    if (!status)
        status = glint_check_whole("seed", desc->seed, 0, 0x1p53, error);
    if (!status && desc->precision > GLINT_FLOAT)
        status = glint_fail(error, GLINT_ERR_INVALID, "precision: double or float expected");
    if (!status && desc->passes >> GLINT_PASS_COUNT)
        status = glint_fail(error, GLINT_ERR_INVALID, "passes: no such pass");
    if (!status && desc->codes && desc->tone.bits != 8 && desc->tone.bits != 16)
        status = glint_fail(error, GLINT_ERR_INVALID, "bits: 8 or 16 expected, got %d", desc->tone.bits);
    return status;
}

/// Lists the stages this frame needs.
static void choose_stages(glint_plan *plan)
{
    const bool surfaces = plan->prim_count > 0, lit = surfaces && plan->light_count > 0;
    plan->accumulate = plan->desc.samples > 1 || plan->light_count > GLINT_LIGHT_CHUNK;
    plan->runs[GLINT_STAGE_CAMERA] = plan->runs[GLINT_STAGE_CAST] = surfaces;
    plan->runs[GLINT_STAGE_SURFACE] = surfaces;
    plan->runs[GLINT_STAGE_LIGHT] = lit;
    plan->runs[GLINT_STAGE_OCCLUDE] = lit && plan->shadow_count > 0;
    plan->runs[GLINT_STAGE_SHADE] = true;
    plan->runs[GLINT_STAGE_RESOLVE] = plan->accumulate;
    plan->runs[GLINT_STAGE_TONE] = plan->desc.codes;
}

#define ADD(key, value) ((key) = glint_key_add((key), &(value), sizeof(value)))

static glint_key camera_key(const glint_plan *plan)
{
    glint_key key = { 0 };
    const glint_plan_camera *c = &plan->camera;
    const double frame[] = { plan->desc.width,     plan->desc.height, plan->desc.samples, plan->desc.seed,
                             plan->desc.precision, c->orthographic,   c->pixel_offset };
    ADD(key, frame);
    ADD(key, c->eye);
    ADD(key, c->forward);
    ADD(key, c->right);
    ADD(key, c->up);
    return key;
}

/// Where the primitives are, and (second) what they look like.
static void geometry_keys(const glint_plan *plan, glint_key *where, glint_key *look)
{
    for (uint32_t i = 0; i < plan->prim_count; i++) {
        const glint_prim *p = &plan->prims[i];
        const uint32_t shown[] = { p->two_sided, p->material };
        double place[8];
        glint_prim_place(p, place);
        ADD(*where, place);
        ADD(*look, shown);
    }
}

/// Keys of each light's own results, and of all of them together.
static void light_keys(glint_plan *plan)
{
    glint_key base = plan->keys[GLINT_STAGE_SURFACE];
    const uint32_t highlights[] = { plan->phong_end, plan->blinn_end };
    ADD(base, highlights);
    glint_key all = base;
    for (uint32_t i = 0; i < plan->light_count; i++) {
        glint_plan_light *l = &plan->lights[i];
        const double numbers[] = { l->directional,     l->position[0],     l->position[1],    l->position[2],
                                   l->coefficients[0], l->coefficients[1], l->coefficients[2] };
        l->key = glint_key_add(base, numbers, sizeof numbers);
        ADD(all, l->key);
    }
    plan->keys[GLINT_STAGE_LIGHT] = all;
    for (uint32_t i = 0; i < plan->light_count; i++)
        ADD(all, plan->lights[i].shadows);
    plan->keys[GLINT_STAGE_OCCLUDE] = all;
}

static glint_key shade_key(const glint_plan *plan, glint_key key)
{
    ADD(key, plan->background);
    for (uint32_t i = 0; i < plan->material_count; i++) {
        const glint_shade_material *m = &plan->materials[i];
        const double exponent[] = { m->shininess, m->has_specular };
        ADD(key, m->diffuse);
        ADD(key, m->specular);
        ADD(key, m->ambient);
        ADD(key, exponent);
    }
    for (uint32_t i = 0; i < plan->light_count; i++) {
        ADD(key, plan->lights[i].diffuse);
        ADD(key, plan->lights[i].specular);
    }
    return key;
}

static void make_keys(glint_plan *plan)
{
    glint_key *keys = plan->keys, where = { 0 }, look = { 0 };
    geometry_keys(plan, &where, &look);
    keys[GLINT_STAGE_CAMERA] = camera_key(plan);
    keys[GLINT_STAGE_CAST] = glint_key_add(keys[GLINT_STAGE_CAMERA], &where, sizeof where);
    keys[GLINT_STAGE_SURFACE] = glint_key_add(keys[GLINT_STAGE_CAST], &look, sizeof look);
    light_keys(plan);
    keys[GLINT_STAGE_SHADE] = shade_key(plan, keys[GLINT_STAGE_OCCLUDE]);
    keys[GLINT_STAGE_RESOLVE] = keys[GLINT_STAGE_SHADE];
    ADD(keys[GLINT_STAGE_RESOLVE], plan->desc.passes);
    const int tone[] = { plan->desc.tone.curve, plan->desc.tone.transfer, plan->desc.tone.rounding,
                         plan->desc.tone.bits };
    keys[GLINT_STAGE_TONE] = glint_key_add(keys[GLINT_STAGE_RESOLVE], tone, sizeof tone);
}

static glint_status fill(glint_plan *plan, const glint_scene *scene, glint_error *error)
{
    glint_list materials = { 0 };
    const glint_camera_desc *camera = glint_camera_get(scene->desc.camera);
    glint_plan_camera_init(&plan->camera, camera, &plan->desc);
    glint_status status = glint_plan_prims(plan, scene, &materials, error);
    if (!status)
        status = glint_plan_shading(plan, scene, &materials, error);
    glint_list_free(&materials);
    if (status)
        return status;
    if (!plan->camera.orthographic) {
        plan->bundle = glint_alloc(plan->prim_count, sizeof *plan->bundle);
        plan->cones = glint_alloc(plan->prim_count, sizeof *plan->cones);
        if (!plan->bundle || !plan->cones)
            return glint_fail_nomem(error);
        glint_plan_bundle(plan, plan->camera.eye, plan->bundle, plan->cones);
    }
    choose_stages(plan);
    make_keys(plan);
    return glint_plan_explain(plan, scene, error);
}

glint_status glint_plan_create(const glint_scene *scene, const glint_render_desc *desc, glint_plan **out,
                               glint_error *error)
{
    glint_status status = check_render_desc(desc, error);
    if (status)
        return status;
    if (!scene->desc.camera)
        return glint_fail(error, GLINT_ERR_INVALID, "camera: the scene has none; give it one with camera = ...");
    glint_plan *plan = calloc(1, sizeof *plan);
    if (!plan)
        return glint_fail_nomem(error);
    plan->desc = *desc;
    status = fill(plan, scene, error);
    if (status) {
        glint_plan_destroy(plan);
        return status;
    }
    *out = plan;
    return GLINT_OK;
}

void glint_plan_destroy(glint_plan *plan)
{
    if (!plan)
        return;
    for (uint32_t i = 0; i < plan->light_count; i++)
        free(plan->lights[i].light_side);
    free(plan->lights);
    free(plan->materials);
    free(plan->bundle);
    free(plan->cones);
    free(plan->prims);
    free(plan->prim_shape);
    free(plan->lines);
    free(plan->effects);
    free(plan);
}

const glint_render_desc *glint_plan_render_desc(const glint_plan *plan) { return &plan->desc; }

size_t glint_plan_effects(const glint_plan *plan, const glint_effect **list)
{
    *list = plan->effects;
    return plan->effect_count;
}

size_t glint_plan_stages(const glint_plan *plan, const glint_stage_info **list)
{
    *list = plan->stage_list;
    return plan->stage_count;
}

glint_ray_counts glint_plan_expected_rays(const glint_plan *plan)
{
    const uint64_t samples = (uint64_t)plan->desc.width * (uint64_t)plan->desc.height * (uint64_t)plan->desc.samples;
    glint_ray_counts rays = { 0 };
    if (plan->runs[GLINT_STAGE_CAST])
        rays.primary = samples;
    if (plan->runs[GLINT_STAGE_OCCLUDE])
        rays.shadow = samples * plan->shadow_count;
    return rays;
}

void glint_frame_key(const glint_plan *plan, const glint_write_desc *desc, char hex[33])
{
    const int options[] = { desc->pass,          desc->tone.curve, desc->tone.transfer,
                            desc->tone.rounding, desc->tone.bits,  desc->encode };
    glint_key key = glint_key_add(plan->keys[GLINT_STAGE_SHADE], options, sizeof options);
    key = glint_key_add_string(key, GLINT_VERSION);
    key = glint_key_add_string(key, glint_encoder_name(desc->encode));
    glint_key_hex(key, hex);
}
