/// Calls the stages of a tile: fills in the kernels' arguments from plan and memory.
#include "engine/base/sequence.h"
#include "engine/base/vec.h"
#include "engine/render/pattern/pattern.h"
#include "engine/render/stages/light/cone_sample.h"
#include "engine/render/stages/simd/coefficients.h"

#include <math.h>
#include <string.h>
#include <time.h>

uint64_t glint_tile_now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

/// Adds the time since the end of the last timed stage to a stage's time, when stages are timed.
static void lap(glint_tile *tile, const glint_tile_frame *frame, glint_stage_id stage)
{
    if (!frame->time_stages)
        return;
    const uint64_t now = glint_tile_now_ns();
    tile->counts.ns[stage] += now - tile->clock;
    tile->clock = now;
}

/// Counts a call of a stage; `reused`: its result was in the cache.
void glint_tile_count_stage(glint_tile *tile, const glint_tile_frame *frame, glint_stage_id stage, bool reused)
{
    if (reused)
        tile->counts.reuses[stage]++;
    else
        tile->counts.runs[stage]++;
    lap(tile, frame, stage);
}

void glint_tile_aim(glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    const glint_plan *plan = frame->plan;
    const glint_plan_camera *camera = &plan->camera;
    glint_camera_args *args = &tile->camera;
    *args = (glint_camera_args) { .group_count = tile->group_count,
                                  .groups_across = tile->groups_across,
                                  .x0 = tile->x0,
                                  .y0 = tile->y0,
                                  .width = camera->span[0],
                                  .height = camera->span[1],
                                  .beyond = { plan->desc.width - camera->span[0], plan->desc.height - camera->span[1] },
                                  .orthographic = camera->orthographic,
                                  .lens = plan->lens ? &tile->lens : NULL };
    tile->sample = k;
    if (plan->lens)
        glint_plan_lens_at(plan, k, &tile->lens);
    glint_plan_sample_offset(plan, k, args->offset);
    vec_copy(args->eye, camera->eye);
    vec_copy(args->forward, camera->forward);
    vec_copy(args->right, camera->right);
    vec_copy(args->up, camera->up);
    args->across = tile->rays.across;
    args->down = tile->rays.down;
    for (int c = 0; c < 3; c++) {
        args->origin[c] = tile->rays.origin[c];
        args->direction[c] = tile->rays.direction[c];
    }
}

void glint_tile_make_rays(glint_tile *tile, const glint_tile_frame *frame)
{
    frame->stages->geometry[frame->plan->desc.precision].camera(&tile->camera);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_CAMERA, false);
}

static void set_cast_args(glint_tile *tile, const glint_tile_frame *frame, glint_cast_args *args)
{
    *args = (glint_cast_args) { .group_count = tile->group_count,
                                .active = tile->active,
                                .geometry = &frame->geometry,
                                .stop = frame->cancelled,
                                .camera = &tile->camera,
                                .view = &tile->view,
                                .t = tile->at.t,
                                .prim = tile->at.prim,
                                .hits = tile->at.hits,
                                .tests = glint_tile_tests_of(tile, frame) };
    for (int c = 0; c < 3; c++) {
        args->origin[c] = tile->rays.origin[c];
        args->direction[c] = tile->rays.direction[c];
    }
}

bool glint_tile_in_sight(glint_tile *tile, const glint_tile_frame *frame)
{
    glint_cast_args args;
    if (frame->caster)
        return frame->caster->in_sight(tile, frame);
    if (glint_tile_has_arrays(tile))
        return true;
    set_cast_args(tile, frame, &args);
    return frame->stages->geometry[frame->plan->desc.precision].in_sight(&args);
}

/// Returns the number of sampled pixels.
static uint64_t count_active(const glint_tile *tile)
{
    uint64_t count = 0, four;
    uint32_t g = 0;
    for (; g + 4 <= tile->group_count; g += 4) {
        memcpy(&four, tile->active + g, sizeof four);
        count += (uint64_t)__builtin_popcountll(four);
    }
    for (; g < tile->group_count; g++)
        count += (uint64_t)__builtin_popcount(tile->active[g]);
    return count;
}

void glint_tile_cast(glint_tile *tile, const glint_tile_frame *frame)
{
    const struct glint_geometry_stages *stages = &frame->stages->geometry[frame->plan->desc.precision];
    glint_cast_args args;
    set_cast_args(tile, frame, &args);
    if (frame->caster)
        frame->caster->cast(tile, frame, &args);
    else if (glint_tile_has_arrays(tile))
        stages->cast_rays(&args);
    else
        stages->cast_bundle(&args);
    glint_tile_step(tile, frame, GLINT_AT_CAST, NULL);
    tile->counts.primary += count_active(tile);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_CAST, false);
}

/// Returns whether the box of the tile's points is known from an earlier frame. False with several samples per pixel,
/// because each sample has its own, smaller box.
static bool has_box(const glint_tile *tile, const glint_tile_frame *frame)
{
    return tile->cached && frame->plan->desc.samples == 1 &&
           glint_key_equal(tile->cached->boxed, frame->plan->keys[GLINT_STAGE_SURFACE]);
}

/// Stores the box that a call of the stage filled in, or the known one.
static void take_box(glint_tile *tile, const glint_tile_frame *frame, const glint_point_box *filled)
{
    if (filled)
        glint_tile_cache_box(tile, frame, filled);
    tile->at.box = filled ? filled : &tile->cached->box;
    if (!tile->at.only && tile->at.box->only != GLINT_MISS)
        tile->at.only = &tile->at.box->only;
}

static glint_surface_args surface_args(glint_tile *tile, const glint_tile_frame *frame)
{
    glint_surface_args args = { .group_count = tile->group_count,
                                .hits = tile->at.hits,
                                .prim = tile->at.prim,
                                .only = tile->at.only,
                                .prims = frame->geometry.prims,
                                .mixed = frame->geometry.triangles || frame->geometry.solids,
                                .scale = frame->geometry.scale,
                                .solids = frame->geometry.solids,
                                .corner_normals = frame->geometry.corner_normals,
                                .slack = frame->geometry.triangles ? tile->surface.slack : NULL,
                                .camera = glint_tile_rays_of(tile),
                                .t = tile->at.t,
                                .material = tile->surface.material,
                                .back = tile->hit.back,
                                .dark = tile->hit.dark,
                                .box = has_box(tile, frame) ? NULL : &tile->surface.box };
    for (int c = 0; c < 3; c++) {
        args.origin[c] = tile->rays.origin[c];
        args.direction[c] = tile->rays.direction[c];
        args.point[c] = tile->surface.point[c];
        args.normal[c] = tile->surface.normal[c];
    }
    return args;
}

void glint_tile_find_surfaces(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_surface_args args = surface_args(tile, frame);
    frame->stages->geometry[frame->plan->desc.precision].surface(&args);
    take_box(tile, frame, args.box);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_SURFACE, false);
    glint_tile_step(tile, frame, GLINT_AT_SURFACE, NULL);
}

void glint_tile_find_points(glint_tile *tile, const glint_tile_frame *frame, const uint16_t *hits)
{
    glint_surface_args args = surface_args(tile, frame);
    args.hits = hits;
    for (int c = 0; c < 3; c++)
        args.normal[c] = NULL;
    args.box = NULL;
    frame->stages->geometry[frame->plan->desc.precision].surface(&args);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_SURFACE, false);
}

void glint_tile_name_materials(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_prim *prims = frame->geometry.prims;
    uint32_t last = tile->at.only ? *tile->at.only : GLINT_MISS, material = tile->at.only ? prims[last].material : 0;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const uint32_t *prim = tile->at.prim + (size_t)g * GLINT_GROUP;
        uint32_t *to = tile->surface.material + (size_t)g * GLINT_GROUP;
        if (tile->at.only || glint_all_are(prim, last)) { // the common case
            for (int i = 0; i < GLINT_GROUP; i++)
                to[i] = material;
            continue;
        }
        for (int i = 0; i < GLINT_GROUP; i++) {
            if (prim[i] != last && prim[i] != GLINT_MISS)
                material = prims[last = prim[i]].material;
            to[i] = material;
        }
    }
}

/// Returns whether only this frame's shading reads the highlights.
static bool is_sparing(const glint_tile *tile, const glint_tile_frame *frame, const uint32_t *slot, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (tile->at.light[slot[i]].log2_specular != glint_tile_own_light(tile, slot[i])->log2_specular)
            return false;
    return !frame->count_work;
}

/// Sets an upper bound for highlights that were not computed. They are too weak for shade to evaluate.
static void bound_brightest(glint_tile *tile, const glint_tile_frame *frame, const glint_light_args *args,
                            const uint32_t *slot)
{
    float bound = GLINT_NO_SPECULAR;
    if (!tile->cached || !args->sparing || !args->highlights)
        return;
    for (uint32_t i = 0; i < tile->cached->shown_count && i < GLINT_SHOWN_MAX; i++) {
        const glint_shade_material *material = &frame->plan->materials[tile->cached->shown[i]];
        if (material->least > 0) // half the logarithm of `least`, rounded up
            bound = fmaxf(bound, GLINT_EXP2_LOWEST / material->shininess - 5e-5f);
    }
    for (uint32_t i = 0; i < args->sample_count; i++)
        tile->at.light[slot[i]].brightest = fmaxf(tile->at.light[slot[i]].brightest, bound);
}

glint_light_args glint_tile_light_args(glint_tile *tile, const glint_tile_frame *frame, uint32_t first,
                                       const uint32_t *slot, uint32_t count)
{
    const glint_plan *plan = frame->plan;
    const glint_plan_light *light = &plan->lights[first + slot[0]];
    glint_light_args args = { .group_count = tile->group_count,
                              .hits = tile->at.sampled,
                              .camera = glint_tile_rays_of(tile),
                              .material = tile->surface.material,
                              .materials = plan->materials,
                              .dark = tile->hit.dark,
                              .directional = light->directional,
                              .scale = light->scale,
                              .spot = light->is_spot ? &light->spot : NULL,
                              .sample_count = count,
                              .attenuated = light->attenuated,
                              .highlights = plan->powers,
                              .sparing = is_sparing(tile, frame, slot, count) };
    vec_copy(args.position, light->position);
    vec_copy(args.coefficients, light->coefficients);
    for (uint32_t i = 0; i < count; i++) {
        args.light_sample[i] = glint_tile_light_sample_of(tile, &plan->lights[first + slot[i]]);
        args.positions[i] = plan->lights[first + slot[i]].position;
        args.lit[i] = tile->at.light[slot[i]].lit;
        args.cosine[i] = tile->at.light[slot[i]].cosine;
        args.attenuation[i] = tile->at.light[slot[i]].attenuation;
        args.log2_specular[i] = tile->at.light[slot[i]].log2_specular;
        args.brightest[i] = &tile->at.light[slot[i]].brightest;
    }
    for (int c = 0; c < 3; c++) {
        args.point[c] = tile->surface.point[c];
        args.normal[c] = tile->surface.normal[c];
        args.direction[c] = tile->rays.direction[c];
    }
    return args;
}

/// Writes the results of the stage light for a light that shines nowhere.
static void leave_unlit(const glint_tile *tile, const glint_light_args *args)
{
    memset(args->lit[0], 0, tile->group_count * sizeof *args->lit[0]);
    if (args->highlights)
        *args->brightest[0] = GLINT_NO_SPECULAR;
}

/// Lets stages remove lanes from those that a light shines on.
static void limit(glint_tile *tile, const glint_plan *plan, const glint_light_args *args)
{
    for (glint_stage_set bits = plan->limits; bits; bits &= bits - 1)
        glint_stage_table[__builtin_ctzll(bits)]->limit(tile, plan, args);
}

void glint_tile_shine(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, const uint32_t *slot,
                      uint32_t count)
{
    const glint_light_args args = glint_tile_light_args(tile, frame, first, slot, count);
    if (glint_tile_is_past_spot(tile, &frame->plan->lights[first + slot[0]]))
        leave_unlit(tile, &args);
    else
        frame->stages->geometry[frame->plan->desc.precision].light(&args);
    limit(tile, frame->plan, &args);
    bound_brightest(tile, frame, &args, slot);
    glint_tile_count_light(tile, frame, count);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_LIGHT, false);
    tile->counts.runs[GLINT_STAGE_LIGHT] += count - 1;
}

void glint_tile_find_lit_surfaces(glint_tile *tile, const glint_tile_frame *frame, uint32_t light, bool normals)
{
    const uint32_t slot = 0;
    glint_surface_args surface = surface_args(tile, frame);
    surface.all_normals = normals;
    const glint_light_args args = glint_tile_light_args(tile, frame, light, &slot, 1);
    frame->stages->geometry[frame->plan->desc.precision].lit_surface(&surface, &args);
    bound_brightest(tile, frame, &args, &slot);
    take_box(tile, frame, surface.box);
    glint_tile_count_light(tile, frame, 1);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_SURFACE, false);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_LIGHT, false);
}

void glint_tile_sample_position(const glint_tile *tile, glint_precision precision,
                                const glint_light_sample *light_sample, double scale, uint32_t i, double out[3])
{
    double point[3], normal[3];
    for (int c = 0; c < 3; c++)
        out[c] = light_sample->position[c][i % GLINT_GROUP];
    if (light_sample->emission != GLINT_EMIT_CONE)
        return;
    for (int c = 0; c < 3; c++) {
        point[c] = glint_real_at(tile->surface.point[c], precision, i);
        normal[c] = glint_real_at(tile->surface.normal[c], precision, i);
    }
    const double slack = precision == GLINT_PRECISION_FLOAT ? GLINT_CONE_SLACK_FLOAT : GLINT_CONE_SLACK_DOUBLE;
    const glint_cone_sample sample = glint_cone_at(light_sample, scale, slack, point, normal, i % GLINT_GROUP);
    vec_copy(out, sample.position);
}

void glint_tile_light_target(const glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light,
                             uint32_t i, double out[3])
{
    const glint_light_sample *light_sample = glint_tile_light_sample_of(tile, light);
    if (light_sample)
        glint_tile_sample_position(tile, frame->plan->desc.precision, light_sample, light->scale, i, out);
    else
        vec_copy(out, light->position);
}

/// Computes the visible share of a light, times its attenuation. Inside its radius, a light with radiance is as
/// strong as on its surface.
static void weaken(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light, uint32_t slot)
{
    const glint_precision precision = frame->plan->desc.precision;
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = tile->at.light[slot].unoccluded[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            double to_light[3], most = HUGE_VAL;
            for (int c = 0; c < 3 && light->radiant_cap; c++)
                to_light[c] = light->position[c] - glint_real_at(tile->surface.point[c], precision, i);
            if (light->radiant_cap && vec_dot(to_light, to_light) < light->cap->radius * light->cap->radius)
                most = 1 / (light->cap->radius * light->cap->radius);
            if (light->attenuated)
                tile->at.light[slot].visible[i] *= (float)fmin(tile->at.light[slot].attenuation[i], most);
        }
}

/// Returns the lanes of a group whose surface faces the light's middle.
static uint16_t facing_lanes(const glint_tile *tile, const glint_plan *plan, const double middle[3], uint32_t g,
                             unsigned lanes)
{
    uint16_t facing = 0;
    for (; lanes; lanes &= lanes - 1) {
        const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(lanes);
        double to_light[3], normal[3];
        for (int c = 0; c < 3; c++) {
            to_light[c] = middle[c] - glint_real_at(tile->surface.point[c], plan->desc.precision, i);
            normal[c] = glint_real_at(tile->surface.normal[c], plan->desc.precision, i);
        }
        if (!(vec_dot(normal, to_light) < 0))
            facing |= (uint16_t)(lanes & -lanes);
    }
    return facing;
}

/// Lets stages add lanes to those that a light reaches.
static void admit(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light, bool middle, const uint16_t *lit,
                  uint16_t *unoccluded)
{
    for (glint_stage_set bits = frame->plan->admits; bits; bits &= bits - 1)
        glint_stage_table[__builtin_ctzll(bits)]->admit(tile, frame, light, middle, lit, unoccluded);
}

/// Casts one ray to the middle of an area light for all samples of the call.
static void occlude_middle(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light,
                           const glint_occlude_args *samples)
{
    uint16_t lit[GLINT_TILE_GROUPS] = { 0 }, unoccluded[GLINT_TILE_GROUPS];
    glint_occlude_args args = *samples;
    args.sample_count = 1;
    args.light_sample[0] = NULL;
    args.lit[0] = lit;
    args.unoccluded[0] = unoccluded;
    for (uint32_t s = 0; s < samples->sample_count; s++)
        for (uint32_t g = 0; g < args.group_count; g++)
            lit[g] |= samples->lit[s][g];
    for (uint32_t g = 0; g < args.group_count; g++)
        lit[g] = facing_lanes(tile, frame->plan, samples->position, g, lit[g]);
    frame->stages->geometry[frame->plan->desc.precision].occlude(&args);
    admit(tile, frame, light, true, lit, unoccluded);
    for (uint32_t s = 0; s < samples->sample_count; s++)
        for (uint32_t g = 0; g < args.group_count; g++)
            samples->unoccluded[s][g] = samples->lit[s][g] & unoccluded[g];
}

/// Returns the grid of a light; NULL: it has none.
static const glint_light_grid *grid_of(const glint_tile_frame *frame, const glint_plan_light *light)
{
    for (uint32_t i = 0; i < frame->grid_count; i++) {
        const glint_light_grid *grid = frame->grids[i];
        if (grid && grid->directional == light->directional &&
            memcmp(grid->position, light->position, sizeof grid->position) == 0)
            return grid;
    }
    return NULL;
}

/// Sets the arguments that depend on one light, or on samples of one light.
static void aim_occlude(const glint_tile *tile, const glint_tile_frame *frame, uint32_t first, const uint32_t *slot,
                        glint_occlude_args *args)
{
    const glint_plan_light *lights = &frame->plan->lights[first], *light = &lights[slot[0]];
    args->directional = light->directional;
    args->scale = light->scale;
    args->grid = grid_of(frame, light);
    vec_copy(args->position, light->position);
    for (uint32_t i = 0; i < args->sample_count; i++) {
        args->light_sample[i] = glint_tile_light_sample_of(tile, &lights[slot[i]]);
        args->lit[i] = tile->at.light[slot[i]].lit;
        args->unoccluded[i] = tile->at.light[slot[i]].unoccluded;
    }
}

/// Returns the primitives that the tile's points are on, except the triangles off which their points have moved.
static const uint32_t *owners(glint_tile *tile, const glint_tile_frame *frame)
{
    if (tile->owner || !frame->geometry.moves)
        return tile->owner ? tile->owner : tile->at.prim;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        const bool hit = glint_has_lane(tile->at.hits, i);
        const glint_prim *prim = hit ? &frame->geometry.prims[tile->at.prim[i]] : NULL;
        const bool moved = hit && prim->kind == GLINT_PRIM_TRIANGLE && glint_real_at(tile->surface.slack, frame->plan->desc.precision, i) < 0;
        tile->moved[i] = moved ? GLINT_MISS : tile->at.prim[i];
    }
    return tile->moved;
}

glint_occlude_args glint_tile_occlude_args(glint_tile *tile, const glint_tile_frame *frame, uint32_t first,
                                           const uint32_t *slot, uint32_t count)
{
    glint_occlude_args args = { .group_count = tile->group_count,
                                .sample_count = count,
                                .prim = owners(tile, frame),
                                .back = tile->hit.back,
                                .geometry = &frame->geometry,
                                .stop = frame->cancelled,
                                .camera = glint_tile_rays_of(tile),
                                .slack = tile->surface.slack,
                                .scratch = tile->shadow_scratch,
                                .box = tile->at.box,
                                .rays = &tile->counts.shadow,
                                .tests = glint_tile_tests_of(tile, frame) };
    aim_occlude(tile, frame, first, slot, &args);
    for (int c = 0; c < 3; c++) {
        args.point[c] = tile->surface.point[c];
        args.normal[c] = tile->surface.normal[c];
        args.direction[c] = tile->viewed[c] ? tile->viewed[c] : tile->rays.direction[c];
    }
    return args;
}

/// Finds the lanes that one light, or samples of one light, reach. aim_occlude must have set the arguments.
static void occlude_light(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, const uint32_t *slot,
                          glint_occlude_args *args)
{
    const glint_plan *plan = frame->plan;
    const glint_plan_light *light = &plan->lights[first + slot[0]];
    const uint32_t count = args->sample_count;
    args->visible = light->cap ? tile->at.light[slot[0]].visible : NULL;
    if (light->cap) {
        args->light_sample[0] = light->cap;
        args->overlaps = &tile->counts.work.overlaps;
    }
    if (light->hard)
        occlude_middle(tile, frame, light, args);
    else
        frame->stages->geometry[plan->desc.precision].occlude(args);
    for (uint32_t i = 0; i < count && !light->hard; i++)
        admit(tile, frame, &plan->lights[first + slot[i]], false, args->lit[i], args->unoccluded[i]);
    if (light->cap)
        weaken(tile, frame, light, slot[0]);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_OCCLUDE, false);
    tile->counts.runs[GLINT_STAGE_OCCLUDE] += count - 1;
}

void glint_tile_occlude(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, const uint32_t *slot,
                        uint32_t count)
{
    const uint32_t together = frame->plan->lights[first + slot[0]].light_samples ? count : 1;
    glint_occlude_args args = glint_tile_occlude_args(tile, frame, first, slot, together);
    occlude_light(tile, frame, first, slot, &args);
    for (uint32_t i = together; i < count; i++) {
        aim_occlude(tile, frame, first, slot + i, &args);
        occlude_light(tile, frame, first, slot + i, &args);
    }
}
