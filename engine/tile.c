#include "engine/tile.h"
#include "engine/base/vec.h"
#include "engine/cull.h"

#include <string.h>
#include <time.h>

static uint64_t now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

/// Books the time since the last call on a stage, when stages are timed.
static void lap(glint_tile *tile, const glint_tile_frame *frame, glint_stage_id stage)
{
    if (!frame->time_stages)
        return;
    const uint64_t now = now_ns();
    tile->counts.ns[stage] += now - tile->clock;
    tile->clock = now;
}

/// Counts a stage's call; `reused`: its result was at hand.
static void book(glint_tile *tile, const glint_tile_frame *frame, glint_stage_id stage, bool reused)
{
    if (reused)
        tile->counts.reuses[stage]++;
    else
        tile->counts.runs[stage]++;
    lap(tile, frame, stage);
}

static void place(glint_tile *tile, const glint_plan *plan, uint32_t column, uint32_t row)
{
    const uint32_t width = (uint32_t)plan->desc.width, height = (uint32_t)plan->desc.height;
    tile->x0 = column * GLINT_TILE_WIDTH;
    tile->y0 = row * GLINT_TILE_HEIGHT;
    tile->width = width - tile->x0 < GLINT_TILE_WIDTH ? width - tile->x0 : GLINT_TILE_WIDTH;
    tile->height = height - tile->y0 < GLINT_TILE_HEIGHT ? height - tile->y0 : GLINT_TILE_HEIGHT;
    tile->groups_across = (tile->width + 3) / 4;
    tile->group_count = tile->groups_across * ((tile->height + 3) / 4);
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const uint32_t columns = tile->width - 4 * (g % tile->groups_across);
        const uint32_t rows = tile->height - 4 * (g / tile->groups_across);
        const uint32_t in_row = columns < 4 ? (1u << columns) - 1 : 15;
        const uint32_t in_rows = rows < 4 ? (1u << 4 * rows) - 1 : 0xffff;
        tile->active[g] = (uint16_t)(in_row * 0x1111 & in_rows);
    }
}

/// Reverses the lower `bits` bits.
static uint32_t reverse(uint32_t k, int bits)
{
    uint32_t r = 0;
    for (int i = 0; i < bits; i++)
        r |= (k >> i & 1) << (bits - 1 - i);
    return r;
}

/// Where sample k of a pixel lies: Sobol's (0,2) sequence, so that any power-of-two number of first samples is
/// stratified in every way; centred in its cells, and shifted around the torus by the seed.
static void sample_offset(const glint_plan *plan, uint32_t k, double out[2])
{
    const uint32_t samples = (uint32_t)plan->desc.samples;
    int bits = 0;
    while (1u << bits < samples)
        bits++;
    uint32_t second = 0;
    for (uint32_t i = k, v = 1u << 31; i; i >>= 1, v ^= v >> 1)
        if (i & 1)
            second ^= v;
    const double cells = (double)(1u << bits), seed = plan->desc.seed;
    out[0] = (reverse(k, bits) + 0.5) / cells;
    out[1] = ((bits ? second >> (32 - bits) : 0) + 0.5) / cells;
    if (seed > 0) { // golden-ratio steps: neighbouring seeds fall far apart
        out[0] += fmod(seed * 0x1.3c6ef372fe95p-1, 1);
        out[1] += fmod(seed * 0x1.83b2b3de7cfacp-1, 1);
        out[0] -= floor(out[0]);
        out[1] -= floor(out[1]);
    }
    for (int i = 0; i < 2; i++)
        out[i] = fmin(fmax(out[i] + (plan->camera.pixel_offset - 0.5), 0), 1);
}

static void make_rays(glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    const glint_plan *plan = frame->plan;
    const glint_plan_camera *camera = &plan->camera;
    glint_camera_args args = { .group_count = tile->group_count,
                               .groups_across = tile->groups_across,
                               .x0 = tile->x0,
                               .y0 = tile->y0,
                               .width = plan->desc.width,
                               .height = plan->desc.height,
                               .orthographic = camera->orthographic };
    sample_offset(plan, k, args.offset);
    vec_copy(args.eye, camera->eye);
    vec_copy(args.forward, camera->forward);
    vec_copy(args.right, camera->right);
    vec_copy(args.up, camera->up);
    for (int c = 0; c < 3; c++) {
        args.origin[c] = tile->origin[c];
        args.direction[c] = tile->direction[c];
        args.direction_f[c] = tile->direction_f[c];
    }
    frame->stages->geometry[plan->desc.precision].camera(&args);
    book(tile, frame, GLINT_STAGE_CAMERA, false);
}

static void cast(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const struct glint_geometry_stages *stages = &frame->stages->geometry[plan->desc.precision];
    glint_cast_args args = { .group_count = tile->group_count,
                             .active = tile->active,
                             .prims = plan->prims,
                             .bundle = plan->bundle,
                             .candidates = tile->candidates,
                             .candidate_count = tile->candidate_count,
                             .filter_scale = plan->filter_scale,
                             .t = tile->at.t,
                             .prim = tile->at.prim,
                             .hits = tile->at.hits };
    vec_copy(args.reference, plan->reference);
    for (int c = 0; c < 3; c++) {
        args.origin[c] = tile->origin[c];
        args.direction[c] = tile->direction[c];
        args.direction_f[c] = tile->direction_f[c];
    }
    if (plan->bundle)
        stages->cast_bundle(&args);
    else
        stages->cast_rays(&args);
    tile->counts.primary += (uint64_t)tile->width * tile->height;
    book(tile, frame, GLINT_STAGE_CAST, false);
}

static void find_surfaces(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const struct glint_geometry_stages *stages = &frame->stages->geometry[plan->desc.precision];
    glint_surface_args args = { .group_count = tile->group_count,
                                .hits = tile->at.hits,
                                .prim = tile->at.prim,
                                .prims = plan->prims,
                                .bundle = plan->bundle,
                                .t = tile->at.t,
                                .material = tile->at.material,
                                .coincident = tile->coincident,
                                .side = tile->side };
    vec_copy(args.eye, plan->camera.eye);
    for (int c = 0; c < 3; c++) {
        args.origin[c] = tile->origin[c];
        args.direction[c] = tile->direction[c];
        args.point[c] = tile->point[c];
        args.normal[c] = tile->normal[c];
    }
    stages->surface(&args);
    if (plan->runs[GLINT_STAGE_OCCLUDE]) {
        glint_bounds_args box = { .group_count = tile->group_count, .hits = tile->at.hits };
        for (int c = 0; c < 3; c++)
            box.point[c] = tile->point[c];
        stages->bounds(&box);
        vec_copy(tile->lower, box.lower);
        vec_copy(tile->upper, box.upper);
    }
    book(tile, frame, GLINT_STAGE_SURFACE, false);
}

static void shine(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light, uint32_t slot)
{
    const glint_plan *plan = frame->plan;
    glint_light_args args = { .group_count = tile->group_count,
                              .hits = tile->at.hits,
                              .material = tile->at.material,
                              .side = tile->side,
                              .directional = light->directional,
                              .scale = light->scale,
                              .attenuated = light->attenuated,
                              .phong_end = plan->phong_end,
                              .blinn_end = plan->blinn_end,
                              .lit = tile->at.light[slot].lit,
                              .cosine = tile->at.light[slot].cosine,
                              .attenuation = tile->at.light[slot].attenuation,
                              .log2_specular = tile->at.light[slot].log2_specular };
    vec_copy(args.position, light->position);
    vec_copy(args.coefficients, light->coefficients);
    for (int c = 0; c < 3; c++) {
        args.point[c] = tile->point[c];
        args.normal[c] = tile->normal[c];
        args.direction[c] = tile->direction[c];
    }
    frame->stages->geometry[plan->desc.precision].light(&args);
    book(tile, frame, GLINT_STAGE_LIGHT, false);
}

static void occlude(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light, uint32_t slot)
{
    const glint_plan *plan = frame->plan;
    glint_occlude_args args = { .group_count = tile->group_count,
                                .lit = tile->at.light[slot].lit,
                                .coincident = tile->coincident,
                                .side = tile->side,
                                .directional = light->directional,
                                .scale = light->scale,
                                .prims = plan->prims,
                                .light_side = light->light_side,
                                .candidates = tile->candidates,
                                .filter_scale = plan->filter_scale,
                                .open = tile->at.light[slot].open,
                                .rays = &tile->counts.shadow };
    args.candidate_count = glint_cull_shadow(plan, light, tile->lower, tile->upper, tile->candidates);
    vec_copy(args.position, light->position);
    vec_copy(args.reference, plan->reference);
    for (int c = 0; c < 3; c++)
        args.point[c] = tile->point[c];
    frame->stages->geometry[plan->desc.precision].occlude(&args);
    book(tile, frame, GLINT_STAGE_OCCLUDE, false);
}

static void shade(glint_tile *tile, const glint_tile_frame *frame, uint32_t from, uint32_t count)
{
    const glint_plan *plan = frame->plan;
    glint_shade_light lights[GLINT_LIGHT_CHUNK];
    for (uint32_t i = 0; i < count; i++) {
        const glint_plan_light *light = &plan->lights[from + i];
        lights[i] = (glint_shade_light){ .lit = light->shadows ? tile->at.light[i].open : tile->at.light[i].lit,
                                         .cosine = tile->at.light[i].cosine,
                                         .attenuation = light->attenuated ? tile->at.light[i].attenuation : NULL,
                                         .log2_specular = tile->at.light[i].log2_specular };
        vec_copy(lights[i].diffuse, light->diffuse);
        vec_copy(lights[i].specular, light->specular);
    }
    glint_shade_args args = { .group_count = tile->group_count,
                              .active = tile->active,
                              .hits = tile->at.hits,
                              .material = tile->at.material,
                              .materials = plan->materials,
                              .has_specular = plan->blinn_end > 0,
                              .first = from == 0,
                              .lights = lights,
                              .light_count = count };
    vec_copy(args.background, plan->background);
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < GLINT_TERM_COUNT; k++) {
            args.sum[k][c] = plan->accumulate ? tile->sum[k][c] : NULL;
            args.film[k][c] = plan->desc.passes >> (GLINT_PASS_BACKGROUND + k) & 1 ? tile->film[k][c] : NULL;
        }
        args.beauty[c] = tile->beauty[c];
    }
    frame->stages->shade(&args);
    book(tile, frame, GLINT_STAGE_SHADE, false);
}

static void resolve(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    glint_resolve_args args = { .group_count = tile->group_count, .samples = plan->desc.samples };
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < GLINT_TERM_COUNT; k++) {
            args.sum[k][c] = tile->sum[k][c];
            args.film[k][c] = plan->desc.passes >> (GLINT_PASS_BACKGROUND + k) & 1 ? tile->film[k][c] : NULL;
        }
        args.beauty[c] = tile->beauty[c];
    }
    frame->stages->resolve(&args);
    book(tile, frame, GLINT_STAGE_RESOLVE, false);
}

/// Points the sample's results at kept memory where this frame keeps them or has them, else at the tile's own.
static void find_geometry_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k, bool *cast_known,
                                 bool *surface_known)
{
    const glint_plan *plan = frame->plan;
    glint_reuse *reuse = frame->reuse;
    glint_kept_tile *kept = tile->kept;
    const size_t first = (size_t)k * GLINT_TILE_SAMPLES;
    *cast_known = kept && glint_key_equal(kept->cast, plan->keys[GLINT_STAGE_CAST]);
    *surface_known = kept && glint_key_equal(kept->surface, plan->keys[GLINT_STAGE_SURFACE]);
    tile->at.t = tile->t;
    tile->at.prim = tile->prim;
    tile->at.hits = tile->hits;
    tile->at.material = tile->material;
    if (*cast_known || (kept && reuse->keep_cast && glint_reuse_hold_cast(reuse, kept))) {
        tile->at.t = (char *)kept->t + first * reuse->real_size;
        tile->at.prim = kept->prim + first;
        tile->at.hits = kept->hits + first / GLINT_GROUP;
    }
    if (*surface_known || (kept && reuse->keep_surface && glint_reuse_hold_surface(reuse, kept)))
        tile->at.material = kept->material + first;
}

static void find_light_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k, uint32_t light, uint32_t slot,
                              bool *light_known, bool *occlude_known)
{
    const glint_plan_light *l = &frame->plan->lights[light];
    glint_reuse *reuse = frame->reuse;
    glint_kept_light *kept = tile->kept && light < reuse->light_count ? &tile->kept->lights[light] : NULL;
    glint_tile_light *own = &tile->lights[slot];
    const size_t first = (size_t)k * GLINT_TILE_SAMPLES;
    *light_known = kept && glint_key_equal(kept->light, l->key);
    *occlude_known = kept && l->shadows && glint_key_equal(kept->occlude, l->occlude_key);
    tile->at.light[slot].cosine = own->cosine;
    tile->at.light[slot].attenuation = own->attenuation;
    tile->at.light[slot].log2_specular = own->log2_specular;
    tile->at.light[slot].lit = own->lit;
    tile->at.light[slot].open = own->open;
    if (*light_known || (kept && reuse->keep_light[light] && glint_reuse_hold_light(reuse, kept))) {
        tile->at.light[slot].cosine = kept->cosine + first;
        tile->at.light[slot].attenuation = kept->attenuation + first;
        tile->at.light[slot].log2_specular = kept->log2_specular + first;
        tile->at.light[slot].lit = kept->lit + first / GLINT_GROUP;
    }
    if (*occlude_known || (kept && l->shadows && reuse->keep_occlude[light] && glint_reuse_hold_occlude(reuse, kept)))
        tile->at.light[slot].open = kept->open + first / GLINT_GROUP;
}

/// Writes down what the kept arrays hold now. After the last sample, since the keys cover all of them.
static void sign_kept(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const glint_reuse *reuse = frame->reuse;
    glint_kept_tile *kept = tile->kept;
    if (!kept)
        return;
    if (reuse->keep_cast && kept->t)
        kept->cast = plan->keys[GLINT_STAGE_CAST];
    if (reuse->keep_surface && kept->material)
        kept->surface = plan->keys[GLINT_STAGE_SURFACE];
    for (uint32_t i = 0; i < reuse->light_count; i++) {
        if (reuse->keep_light[i] && kept->lights[i].cosine)
            kept->lights[i].light = plan->lights[i].key;
        if (reuse->keep_occlude[i] && kept->lights[i].open)
            kept->lights[i].occlude = plan->lights[i].occlude_key;
    }
}

static bool any_hit(const glint_tile *tile)
{
    unsigned any = 0;
    for (uint32_t g = 0; g < tile->group_count; g++)
        any |= tile->at.hits[g];
    return any;
}

/// Rays, hits and, as soon as somebody needs them, points: of one sample.
typedef struct walk {
    uint32_t sample;
    bool rays, points; ///< made already
} walk;

static void need_rays(glint_tile *tile, const glint_tile_frame *frame, walk *w)
{
    if (!w->rays)
        make_rays(tile, frame, w->sample);
    w->rays = true;
}

static void need_points(glint_tile *tile, const glint_tile_frame *frame, walk *w)
{
    if (w->points)
        return;
    need_rays(tile, frame, w);
    find_surfaces(tile, frame);
    w->points = true;
}

/// Returns whether anything is hit.
static bool find_hits(glint_tile *tile, const glint_tile_frame *frame, walk *w)
{
    const glint_plan *plan = frame->plan;
    bool cast_known, surface_known;
    find_geometry_memory(tile, frame, w->sample, &cast_known, &surface_known);
    if (!plan->runs[GLINT_STAGE_CAST]) {
        memset(tile->at.hits, 0, sizeof tile->hits);
    } else if (cast_known) {
        book(tile, frame, GLINT_STAGE_CAST, true);
    } else {
        const double x[2] = { tile->x0, tile->x0 + tile->width }, y[2] = { tile->y0, tile->y0 + tile->height };
        need_rays(tile, frame, w);
        tile->candidate_count = glint_cull_primary(plan, x, y, tile->candidates);
        cast(tile, frame);
    }
    const bool any = any_hit(tile);
    if (any && (!surface_known || (w->sample == 0 && glint_tile_wants_geometry(plan))))
        need_points(tile, frame, w);
    else if (any)
        book(tile, frame, GLINT_STAGE_SURFACE, true);
    if (w->sample == 0 && glint_tile_wants_geometry(plan)) {
        need_rays(tile, frame, w);
        glint_tile_store_geometry(tile, frame);
    }
    return any;
}

/// What one light does to this sample.
static void find_light(glint_tile *tile, const glint_tile_frame *frame, walk *w, uint32_t index, uint32_t slot)
{
    const glint_plan_light *light = &frame->plan->lights[index];
    bool light_known, occlude_known;
    find_light_memory(tile, frame, w->sample, index, slot, &light_known, &occlude_known);
    if (light_known) {
        book(tile, frame, GLINT_STAGE_LIGHT, true);
    } else {
        need_points(tile, frame, w);
        shine(tile, frame, light, slot);
    }
    if (!light->shadows)
        return;
    if (occlude_known) {
        book(tile, frame, GLINT_STAGE_OCCLUDE, true);
    } else {
        need_points(tile, frame, w);
        occlude(tile, frame, light, slot);
    }
}

/// One sample of every pixel: hits, then the lights, a chunk at a time.
static void sample(glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    walk w = { .sample = k };
    const uint32_t lights = find_hits(tile, frame, &w) ? frame->plan->light_count : 0;
    uint32_t from = 0;
    do {
        const uint32_t count = lights - from < GLINT_LIGHT_CHUNK ? lights - from : GLINT_LIGHT_CHUNK;
        for (uint32_t i = 0; i < count; i++)
            find_light(tile, frame, &w, from + i, i);
        shade(tile, frame, from, count);
        from += count;
    } while (from < lights);
}

void glint_tile_render(glint_tile *tile, const glint_tile_frame *frame, uint32_t column, uint32_t row)
{
    const glint_plan *plan = frame->plan;
    const uint64_t start = now_ns();
    const uint32_t across = ((uint32_t)plan->desc.width + GLINT_TILE_WIDTH - 1) / GLINT_TILE_WIDTH;
    tile->clock = start;
    tile->kept = frame->reuse->tile_count ? &frame->reuse->tiles[(size_t)row * across + column] : NULL;
    place(tile, plan, column, row);
    if (plan->accumulate)
        memset(tile->sum, 0, sizeof tile->sum);
    for (uint32_t k = 0; k < (uint32_t)plan->desc.samples; k++)
        sample(tile, frame, k);
    sign_kept(tile, frame);
    if (plan->accumulate)
        resolve(tile, frame);
    glint_tile_store_light(tile, frame);
    const uint64_t rendered = now_ns();
    if (plan->runs[GLINT_STAGE_TONE])
        glint_tile_tone(tile, frame);
    const uint64_t done = now_ns();
    tile->counts.ns[GLINT_STAGE_TONE] += done - rendered;
    tile->counts.tile_ns += done - start;
}
