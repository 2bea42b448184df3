#include "engine/render/plan/plan.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/film/tone.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

glint_status glint_choose_isa(const char *isa, const glint_stages **out, glint_error *error)
{
    const char *requested, *who = isa && *isa ? "isa" : "GLINT_ISA";
    bool unknown;
    *out = glint_stages_select(isa, &requested, &unknown);
    if (*out)
        return GLINT_OK;
    if (unknown)
        return glint_fail(error, GLINT_ERR_INVALID, "%s: ref, generic, avx2 or avx512 expected, got '%s'", who,
                          requested);
    return glint_fail(error, GLINT_ERR_UNSUPPORTED, "%s: this machine lacks '%s'", who, requested);
}

static glint_render_desc defaults(void)
{
    return (glint_render_desc) { .width = 1280,
                                 .height = 720,
                                 .samples = 1,
                                 .max_depth = 5,
                                 .passes = 1u << GLINT_PASS_BEAUTY,
                                 .tone = glint_tone_desc_default() };
}

void glint_render_desc_init(glint_render_desc *desc, size_t size)
{
    const glint_render_desc full = defaults();
    glint_desc_write(desc, size, &full, sizeof full);
}

static glint_status check_region(const glint_render_desc *desc, glint_error *error)
{
    const int64_t *r = desc->region, side[2] = { desc->width, desc->height };
    bool good = true;
    if (r[0] == 0 && r[1] == 0 && r[2] == 0 && r[3] == 0)
        return GLINT_OK;
    for (int i = 0; i < 2; i++)
        good = good && r[i] >= 0 && r[i] <= side[i] && r[i + 2] >= 1 && r[i + 2] <= side[i] - r[i];
    if (good)
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID,
                      "region: whole numbers x, y, width and height within the frame of %lld x %lld expected, got %lld, "
                      "%lld, %lld, %lld",
                      (long long)side[0], (long long)side[1], (long long)r[0], (long long)r[1], (long long)r[2], (long long)r[3]);
}

static glint_status check_render_desc(const glint_render_desc *desc, glint_error *error)
{
    glint_status status = glint_check_whole("width", desc->width, 1, GLINT_SIDE_MAX, error);
    if (!status)
        status = glint_check_whole("height", desc->height, 1, GLINT_SIDE_MAX, error);
    if (!status && desc->width * desc->height > INT32_MAX)
        status = glint_fail(error, GLINT_ERR_INVALID,
                            "width: at most 2147483647 pixels in an image expected, got %lld x %lld",
                            (long long)desc->width, (long long)desc->height);
    if (!status)
        status = check_region(desc, error);
    if (!status)
        status = glint_check_whole("samples", desc->samples, 1, 65536, error);
    if (!status)
        status = glint_check_range("adaptive", desc->adaptive, 0, 3, "number 0 .. 3", error);
    if (!status)
        status = glint_check_whole("max_depth", desc->max_depth, 0, INT64_C(1) << 31, error);
    if (!status)
        status = glint_check_whole("rays", desc->rays, 0, 65536, error);
    if (!status)
        status = glint_check_range("clamp", desc->clamp, 0, 1e9, "number 0 .. 1e9", error);
    if (!status)
        status = glint_check_whole("seed", desc->seed, 0, INT64_C(1) << 53, error);
    if (!status && desc->precision > GLINT_PRECISION_FLOAT)
        status = glint_fail(error, GLINT_ERR_INVALID, "precision: double or float expected");
    if (!status && desc->visibility > GLINT_VISIBILITY_SCAN)
        status = glint_fail(error, GLINT_ERR_INVALID, "visibility: auto, cast or scan expected");
    if (!status && desc->passes >> GLINT_PASS_COUNT)
        status = glint_fail(error, GLINT_ERR_INVALID, "passes: no such pass");
    if (!status && !desc->passes && !desc->codes && !desc->outline && !desc->derivative_count && !desc->light_passes)
        status = glint_fail(error, GLINT_ERR_INVALID, "passes: at least one pass expected, or `codes`; the frame would be empty");
    if (!status && desc->outline > GLINT_OUTLINE_WHITE)
        status = glint_fail(error, GLINT_ERR_INVALID, "outline: none, black or white expected");
    if (!status)
        status = glint_tone_check(&desc->tone, error);
    return status;
}

/// Returns whether all light comes from the stages shade (with one call per sample) and vertex.
static bool is_local(const glint_plan *plan)
{
    for (int id = 0; id < GLINT_STAGE_COUNT; id++)
        if (plan->runs[id] && glint_stage_table[id]->remote)
            return false;
    return plan->light_count <= GLINT_LIGHT_CHUNK;
}

/// Returns whether all samples of a tile can be shaded together: the data of all samples fit into the tile's memory.
static bool shades_together(const glint_plan *plan)
{
    return plan->local && !plan->runs[GLINT_STAGE_VERTEX_SHADING] && plan->desc.samples > 1 && plan->desc.samples <= GLINT_LIGHT_CHUNK &&
           plan->desc.samples * plan->light_count <= GLINT_LIGHT_CHUNK;
}

_Static_assert(GLINT_STAGE_COUNT <= GLINT_STAGE_MAX, "a bit of glint_stage_set and a row of the statistics for each stage");

/// Lists the steps of the frame's stages in the walk of a tile, for each time of the walk.
static void list_steps(glint_plan *plan)
{
    for (int id = 0; id < GLINT_STAGE_COUNT; id++) {
        const glint_stage *stage = glint_stage_table[id];
        for (int time = 0; time < GLINT_TIME_COUNT; time++)
            plan->steps[time] |= (glint_stage_set)(plan->runs[id] && stage->step[time]) << id;
        plan->limits |= (glint_stage_set)(plan->runs[id] && stage->limit) << id;
        plan->admits |= (glint_stage_set)(plan->runs[id] && stage->admit) << id;
        plan->singles |= (glint_stage_set)(plan->runs[id] && stage->singles) << id;
        plan->before_shade |= (glint_stage_set)(plan->runs[id] && stage->before_shade) << id;
        plan->after_shade |= (glint_stage_set)(plan->runs[id] && stage->after_shade) << id;
        plan->reads_normals = plan->reads_normals || (plan->runs[id] && stage->normals);
    }
}

/// Lists the stages this frame needs.
static void choose_stages(glint_plan *plan)
{
    plan->tints = glint_plan_is_lit(plan) && (plan->transmits || plan->clears) && plan->shadow_count > 0;
    plan->absorbs_transmitted = plan->tints && plan->absorbs;
    plan->accumulate = plan->desc.samples > 1 || plan->light_count > GLINT_LIGHT_CHUNK;
    for (int id = 0; id < GLINT_STAGE_COUNT; id++)
        plan->accumulate = plan->accumulate || (glint_stage_table[id]->sums && glint_stage_table[id]->called(plan));
    for (int id = 0; id < GLINT_STAGE_COUNT; id++) {
        plan->runs[id] = glint_stage_table[id]->called(plan);
        plan->walks = plan->walks || (plan->runs[id] && glint_stage_table[id]->walks);
    }
    plan->needs_index = plan->walks || !plan->runs[GLINT_STAGE_RASTER] || glint_plan_cuts(plan);
    plan->local = is_local(plan);
    plan->together = shades_together(plan);
    list_steps(plan);
}

/// Lets each stage fill its tables.
static glint_status prepare_stages(glint_plan *plan, const glint_plan_input *from, glint_error *error)
{
    glint_status status = GLINT_OK;
    for (int id = 0; id < GLINT_STAGE_COUNT && !status; id++)
        if (glint_stage_table[id]->prepare)
            status = glint_stage_table[id]->prepare(plan, from, error);
    return status;
}

/// Lets each stage refuse the frame.
static glint_status check_stages(const glint_plan *plan, const glint_scene *scene, glint_error *error)
{
    glint_status status = GLINT_OK;
    for (int id = 0; id < GLINT_STAGE_COUNT && !status; id++)
        if (glint_stage_table[id]->check)
            status = glint_stage_table[id]->check(plan, scene, error);
    return status;
}

static glint_status fill(glint_plan *plan, const glint_plan_input *from, glint_error *error)
{
    const glint_scene *scene = from->scene;
    glint_plan_camera_init(&plan->camera, glint_camera_get(scene->desc.camera), plan->desc.width, plan->desc.height);
    glint_status status = glint_geometry_of(scene, &plan->geometry, error);
    if (!status)
        status = glint_geometry_check_reach(plan->geometry, "camera.eye", plan->camera.eye, error);
    if (!status)
        status = glint_plan_find_lens(plan, glint_camera_get(scene->desc.camera), error);
    if (!status)
        status = glint_plan_find_translucent(plan, error);
    if (!status)
        status = glint_plan_find_patterns(plan, glint_plan_has_indirect(&scene->desc), error);
    if (!status)
        status = glint_plan_shading(plan, scene, error);
    if (!status)
        status = prepare_stages(plan, from, error);
    if (status)
        return status;
    choose_stages(plan);
    status = check_stages(plan, scene, error);
    if (status)
        return status;
    plan->where = plan->geometry->where;
    status = glint_plan_keys(plan, error);
    return status ? status : glint_plan_explain(plan, scene, error);
}

static glint_status take_overlays(glint_plan *plan, const glint_scene *scene, glint_error *error)
{
    glint_overlay *const *overlays = (glint_overlay *const *)scene->overlays.items;
    const glint_cover_camera camera = glint_plan_cover_camera(&plan->camera);
    if (!scene->overlays.count)
        return GLINT_OK;
    return overlays[0]->maker->take(overlays, scene->overlays.count, (int)plan->desc.width, (int)plan->desc.height, &camera,
                                    &plan->cover, error);
}

glint_status glint_plan_make(const glint_plan_input *from, glint_plan **out, glint_error *error)
{
    const glint_scene *scene = from->scene;
    const glint_render_desc *desc = from->desc;
    glint_status status = check_render_desc(desc, error);
    if (status)
        return status;
    if (!scene->desc.camera)
        return glint_fail(error, GLINT_ERR_INVALID, "camera: the scene has none; give it one with camera = ...");
    glint_plan *plan = calloc(1, sizeof *plan);
    if (!plan)
        return glint_fail_nomem(error);
    plan->desc = *desc;
    plan->shutter_times = from->shutter_times;
    plan->desc.derivatives = NULL;
    plan->desc.passes |= ((1u << desc->derivative_count) - 1) << GLINT_PASS_DERIVATIVE;
    if (desc->alpha && desc->passes >> GLINT_PASS_BEAUTY & 1)
        plan->desc.passes |= 1u << GLINT_PASS_ALPHA;
    if (desc->outline)
        plan->desc.passes |= 1u << GLINT_PASS_OUTLINE;
    if (plan->desc.passes >> GLINT_PASS_OUTLINE & 1)
        plan->desc.passes |= GLINT_OUTLINE_READS;
    status = fill(plan, from, error);
    if (!status)
        status = take_overlays(plan, scene, error);
    if (!status && plan->runs[GLINT_STAGE_ADAPTIVE]) {
        glint_render_desc base = glint_plan_base(&plan->desc);
        base.derivatives = desc->derivatives;
        status = glint_plan_create(scene, &base, &plan->base, error);
        if (!status)
            plan->base->is_base = true;
    }
    if (status) {
        glint_plan_destroy(plan);
        return status;
    }
    *out = plan;
    return GLINT_OK;
}

glint_status glint_plan_create(const glint_scene *scene, const glint_render_desc *given, glint_plan **out,
                               glint_error *error)
{
    GLINT_REFUSE_NULL(scene, error);
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_render_desc, defaults());
    return glint_plan_make(&(glint_plan_input) { .scene = scene, .desc = desc }, out, error);
}

glint_status glint_plan_check_overlays(const glint_plan *plan, double dpi, void (*warns)(void *context, const char *message),
                                       void *context, glint_error *error)
{
    GLINT_REFUSE_NULL(plan, error);
    GLINT_REFUSE_NULL(warns, error);
    return plan->cover ? plan->cover->maker->check(plan->cover, dpi, warns, context, error) : GLINT_OK;
}

void glint_plan_destroy(glint_plan *plan)
{
    if (!plan)
        return;
    for (int id = 0; id < GLINT_STAGE_COUNT; id++) {
        if (glint_stage_table[id]->release)
            glint_stage_table[id]->release(plan);
        free(plan->own[id]);
    }
    glint_plan_destroy(plan->base);
    glint_plan_translucent_free(plan);
    glint_geometry_release(plan->geometry);
    glint_cover_release(plan->cover);
    free(plan->lens);
    free(plan->lights);
    free(plan->light_samples);
    free(plan->materials);
    free(plan->bouncing);
    glint_plan_patterns_free(plan->patterns);
    free(plan->material_keys);
    free(plan->matte_keys);
    free(plan->lines);
    free(plan->effects);
    free(plan);
}

const glint_render_desc *glint_plan_render_desc(const glint_plan *plan) { return plan ? &plan->desc : NULL; }

size_t glint_plan_effects(const glint_plan *plan, const glint_effect **list)
{
    if (!plan || !list)
        return 0;
    *list = plan->effects;
    return plan->effect_count;
}

size_t glint_plan_stages(const glint_plan *plan, const glint_stage_info **list)
{
    if (!plan || !list)
        return 0;
    *list = plan->stage_list;
    return plan->stage_count;
}

/// Width in pixels of the border around a region on which the region's pixels depend: the pixels that adaptive
/// sampling compares, and GLINT_REFINE_SPREAD more
#define APRON 4

/// Computes the pixels of a range along an axis of `of` pixels, and the tiles of `size` pixels that contain them.
static void find_range(double from, double count, double of, int size, uint32_t *first, uint32_t *tiles, int *pixel,
                       int *pixels)
{
    const int low = count > 0 ? (int)fmax(from - APRON, 0) : 0;
    const int high = (int)(count > 0 ? fmin(from + count + APRON, of) : of);
    *first = (uint32_t)(low / size);
    *tiles = (uint32_t)((high + size - 1) / size) - *first;
    *pixel = (int)*first * size;
    *pixels = (int)fmin(*pixel + (double)*tiles * size, of) - *pixel;
}

glint_extent glint_plan_extent(const glint_render_desc *desc)
{
    glint_extent e;
    const int64_t *r = desc->region;
    find_range(r[0], r[2], desc->width, GLINT_TILE_WIDTH, &e.tile_x, &e.across, &e.x, &e.width);
    find_range(r[1], r[3], desc->height, GLINT_TILE_HEIGHT, &e.tile_y, &e.down, &e.y, &e.height);
    return e;
}

static void add_rays(glint_ray_counts *to, glint_ray_counts more)
{
    to->primary += more.primary;
    to->shadow += more.shadow;
    to->mirror += more.mirror;
    to->refraction += more.refraction;
    to->indirect += more.indirect;
}

glint_ray_counts glint_plan_expected_rays(const glint_plan *plan)
{
    if (!plan)
        return (glint_ray_counts) { 0 };
    const glint_extent extent = glint_plan_extent(&plan->desc);
    const uint64_t each = (uint64_t)plan->desc.samples + (plan->base ? 1 : 0);
    const uint64_t samples = (uint64_t)extent.width * (uint64_t)extent.height * each;
    const uint64_t sides = 2 * (uint64_t)plan->geometry->table.shading_point_count;
    glint_ray_counts rays = { 0 };
    for (uint32_t k = 0; plan->times && k < plan->shutter_times; k++)
        add_rays(&rays, glint_plan_expected_rays(plan->times[k]));
    if (plan->times)
        return rays;
    if (plan->runs[GLINT_STAGE_CAMERA])
        rays.primary = samples;
    if (plan->runs[GLINT_STAGE_OCCLUDE])
        rays.shadow = (samples + sides) * (plan->shadow_count - plan->spared_count);
    if (plan->runs[GLINT_STAGE_BOUNCE] && plan->mirrors && plan->sharp)
        rays.mirror = samples;
    if (plan->runs[GLINT_STAGE_BOUNCE] && ((plan->transmits && plan->sharp) || plan->clears))
        rays.refraction = samples;
    if (plan->runs[GLINT_STAGE_ROUGH])
        rays.mirror += samples * plan->rough_samples;
    rays.indirect = samples * plan->indirect.samples;
    return rays;
}

glint_key glint_plan_picture_key(const glint_plan *plan, glint_stage_id stage)
{
    glint_key key = plan->keys[stage];
    for (uint32_t k = 0; plan->times && k < plan->shutter_times; k++)
        key = glint_key_add(key, &plan->times[k]->keys[plan->derivatives ? GLINT_STAGE_DERIVATIVE : GLINT_STAGE_OUTLINE], sizeof key);
    return key;
}

void glint_plan_key(const glint_plan *plan, uint64_t key[2])
{
    if (!plan || !key)
        return;
    const glint_key own = glint_plan_picture_key(plan, GLINT_STAGE_ADAPTIVE);
    key[0] = own.high;
    key[1] = own.low;
}

void glint_plan_add_pass_key(const glint_plan *plan, int pass, uint64_t key[2])
{
    if (!plan || !key)
        return;
    glint_key own = { key[0], key[1] };
    if (pass == GLINT_PASS_BEAUTY && plan->cover)
        own = plan->cover->maker->key(plan->cover, own);
    if (pass < GLINT_PASS_COUNT && GLINT_CENTRE_PASSES >> pass & 1 && glint_plan_casts_centres(plan))
        own = glint_key_add_string(own, "centres"); // earlier versions computed these passes from the first sample
    for (int id = 0; id < GLINT_STAGE_COUNT; id++)
        if (plan->runs[id] && glint_stage_table[id]->pass_key)
            own = glint_stage_table[id]->pass_key(plan, (int)pass, own);
    key[0] = own.high;
    key[1] = own.low;
}
