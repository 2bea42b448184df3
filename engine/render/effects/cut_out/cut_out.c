/// Rays through holes: if a ray hits a hole, it is cast again from there. A ray leaves a hole like any other surface,
/// by the primitive that it starts on.
///
/// The distance of the surface finally hit is computed once more from the ray's first origin: surfaces behind holes
/// are where they would be without the holes, to the last bit. If the first hole is in a flat surface, the surface is
/// ignored from the eye on, so that another surface in the same plane shows in it. Surfaces in the plane of a later
/// hole are passed together with it.
#include "engine/render/effects/cut_out/cut_out.h"
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/render/pattern/work.h"
#include "engine/render/program/program.h"
#include "engine/render/paths/batch.h"

#include <stdlib.h>
#include <string.h>

#define HOLES_MAX 4096 ///< holes that one ray passes; the next one is hit

struct glint_cut_out {
    _Alignas(64) double origin[3][GLINT_TILE_SAMPLES]; ///< type: real, like all arrays that kernels read
    _Alignas(64) double direction[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double point[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double normal[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double t[GLINT_TILE_SAMPLES];
    _Alignas(64) double total_t[GLINT_TILE_SAMPLES]; ///< t from the ray's first origin
    _Alignas(64) double opacity[GLINT_PROGRAM_LANES];
    _Alignas(64) uint32_t prim[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t material[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t leaving[GLINT_TILE_SAMPLES];
    uint16_t active[GLINT_TILE_GROUPS], inward[GLINT_TILE_GROUPS];
    uint16_t hits[GLINT_TILE_GROUPS], back[GLINT_TILE_GROUPS], dark[GLINT_TILE_GROUPS];
    uint16_t holes[GLINT_TILE_GROUPS];
    uint16_t passed[GLINT_TILE_GROUPS]; ///< lanes that have passed a hole
    uint16_t begun[GLINT_TILE_GROUPS]; ///< lanes whose ray still starts at its first origin
};

static void *create(const glint_plan *plan)
{
    (void)plan;
    return glint_alloc(1, sizeof(struct glint_cut_out));
}

static struct glint_cut_out *own_of(const glint_tile *tile) { return tile->own[GLINT_STAGE_CUT_OUT]; }

// ---- Holes ----

static bool is_cut(const glint_plan_pattern *own, uint32_t fields)
{
    (void)fields;
    return own->cut;
}

/// Finds the holes of one material, in some groups that show it.
static void find_material_holes(glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_points *points,
                                const glint_pattern_lanes *entries, uint32_t count, uint16_t *holes)
{
    struct glint_pattern *pattern = tile->pattern;
    const glint_program *program = frame->plan->patterns->of[entries[0].material].program[GLINT_FIELD_OPACITY];
    uint16_t wanted[GLINT_PROGRAM_GROUPS];
    for (uint32_t k = 0; k < count; k++) {
        wanted[k] = entries[k].lanes;
        holes[entries[k].group] |= program ? 0 : entries[k].lanes; // its opacity is below one half
    }
    if (!program)
        return;
    glint_pattern_gather(&pattern->inputs, frame, points, program->inputs, entries, count);
    glint_program_args args = { .group_count = count, .wanted = wanted, .result = { own_of(tile)->opacity } };
    glint_pattern_call(pattern, frame, &program->code, 0, &args);
    for (uint32_t k = 0; k < count; k++)
        for (unsigned bits = wanted[k]; bits; bits &= bits - 1)
            if (!(own_of(tile)->opacity[k * GLINT_GROUP + (uint32_t)__builtin_ctz(bits)] >= 0.5))
                holes[entries[k].group] |= (uint16_t)(bits & -bits);
}

void glint_tile_find_holes(glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_points *points,
                           uint16_t *holes)
{
    memset(holes, 0, points->group_count * sizeof *holes);
    glint_pattern_find_lanes(tile->pattern, frame->plan->patterns, points, is_cut);
    const glint_pattern_lanes *entries;
    for (uint32_t taken; (taken = glint_pattern_take(tile->pattern, &entries));)
        find_material_holes(tile, frame, points, entries, taken, holes);
}

/// Reduces cut->hits to lanes whose materials have holes. Returns whether there are any.
static bool choose_cut(struct glint_cut_out *cut, const glint_tile *tile, const glint_tile_frame *frame)
{
    unsigned any = 0;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        for (unsigned bits = cut->hits[g]; bits; bits &= bits - 1) {
            const uint32_t prim = cut->prim[g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits)];
            if (!frame->plan->patterns->of[frame->geometry.prims[prim].material].cut)
                cut->hits[g] &= (uint16_t) ~(bits & -bits);
        }
        any |= cut->hits[g];
    }
    return any;
}

/// Selects the lanes of cut->hits whose points are in holes. seen: the hits are hits of the tile's own rays.
static void find_holes(struct glint_cut_out *cut, glint_tile *tile, const glint_tile_frame *frame, bool seen)
{
    glint_surface_args surfaces = { .group_count = tile->group_count,
                                    .hits = cut->hits,
                                    .prim = cut->prim,
                                    .prims = frame->geometry.prims,
                                    .mixed = frame->geometry.triangles || frame->geometry.solids,
                                    .scale = frame->geometry.scale,
                                    .solids = frame->geometry.solids,
                                    .corner_normals = frame->geometry.corner_normals,
                                    .t = cut->t,
                                    .material = cut->material,
                                    .back = cut->back,
                                    .dark = cut->dark };
    glint_pattern_points points = { .group_count = tile->group_count,
                                    .hits = cut->hits,
                                    .back = cut->back,
                                    .prim = cut->prim,
                                    .material = cut->material,
                                    .t = seen ? cut->total_t : NULL,
                                    .tile = tile };
    for (int c = 0; c < 3; c++) {
        surfaces.origin[c] = cut->origin[c];
        surfaces.direction[c] = points.direction[c] = cut->direction[c];
        surfaces.point[c] = cut->point[c];
        surfaces.normal[c] = cut->normal[c];
        points.point[c] = cut->point[c];
        points.normal[c] = cut->normal[c];
    }
    frame->stages->geometry[frame->plan->desc.precision].surface(&surfaces);
    glint_tile_find_holes(tile, frame, &points, cut->holes);
}

// ---- Rays ----

/// Returns whether the primitive is not a part of a combined solid. For a ray that starts on a part, the rest of its
/// path is decided from its exact origin.
static bool stands_alone(const glint_geometry_table *geometry, uint32_t prim) { return prim < geometry->prim_count; }

static bool is_flat(const glint_geometry_table *geometry, const glint_prim *prim)
{
    return prim->kind == GLINT_PRIM_TRIANGLE || prim->kind == GLINT_PRIM_PLANE ||
           (prim->kind == GLINT_PRIM_SOLID && geometry->solids[prim->item].form == GLINT_FORM_DISK);
}

/// Starts lane i at its hole or, with from_origin, at its first origin.
static void leave_hole(struct glint_cut_out *cut, const glint_tile_frame *frame, uint32_t i, bool from_origin)
{
    const uint16_t bit = (uint16_t)(1u << i % GLINT_GROUP);
    const uint32_t g = i / GLINT_GROUP;
    const bool inward = !from_origin && !(cut->back[g] & bit);
    for (int c = 0; c < 3 && !from_origin; c++)
        glint_real_put(cut->origin[c], frame->plan->desc.precision, i,
                       glint_real_at(cut->point[c], frame->plan->desc.precision, i));
    cut->leaving[i] = cut->prim[i];
    cut->inward[g] = (uint16_t)(inward ? cut->inward[g] | bit : cut->inward[g] & ~bit);
    if (!from_origin)
        cut->begun[g] &= (uint16_t)~bit;
}

static void cast(struct glint_cut_out *cut, glint_tile *tile, const glint_tile_frame *frame,
                 const glint_geometry_table *geometry, const uint16_t *active, bool leaving)
{
    glint_cast_args args = { .group_count = tile->group_count,
                             .active = active,
                             .geometry = geometry,
                             .stop = frame->cancelled,
                             .leaving = leaving ? cut->leaving : NULL,
                             .inward = leaving ? cut->inward : NULL,
                             .t = cut->t,
                             .prim = cut->prim,
                             .hits = cut->hits,
                             .tests = glint_tile_tests_of(tile, frame) };
    for (int c = 0; c < 3; c++) {
        args.origin[c] = cut->origin[c];
        args.direction[c] = cut->direction[c];
    }
    frame->stages->geometry[frame->plan->desc.precision].cast_rays(&args);
}

/// Gives lanes without a ray a dummy ray that ends at once.
static void clear_rays(struct glint_cut_out *cut, const glint_tile *tile, glint_precision precision)
{
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        cut->leaving[i] = GLINT_MISS;
        for (int c = 0; c < 3; c++) {
            glint_real_put(cut->origin[c], precision, i, 0);
            glint_real_put(cut->direction[c], precision, i, 1);
        }
    }
    for (uint32_t g = 0; g < tile->group_count; g++)
        cut->active[g] = cut->inward[g] = cut->passed[g] = cut->begun[g] = 0;
}

// ---- Visible surfaces ----

static void put_first_origin(struct glint_cut_out *cut, const glint_tile *tile, const glint_tile_frame *frame,
                             uint32_t i)
{
    const glint_precision precision = frame->plan->desc.precision;
    for (int c = 0; c < 3; c++)
        glint_real_put(cut->origin[c], precision, i,
                       glint_tile_has_arrays(tile) ? glint_real_at(tile->rays.origin[c], precision, i)
                                                   : frame->plan->camera.eye[c]);
}

/// Selects the tile's rays that hit a material with holes. Returns whether there are any.
static bool begin_seeing(struct glint_cut_out *cut, const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_precision precision = frame->plan->desc.precision;
    memcpy(cut->hits, tile->at.hits, tile->group_count * sizeof *cut->hits);
    memcpy(cut->prim, tile->at.prim, tile->group_count * GLINT_GROUP * sizeof *cut->prim);
    if (!choose_cut(cut, tile, frame))
        return false;
    clear_rays(cut, tile, precision);
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        if (!glint_has_lane(cut->hits, i))
            continue;
        const double t = glint_real_at(tile->at.t, precision, i);
        put_first_origin(cut, tile, frame, i);
        for (int c = 0; c < 3; c++)
            glint_real_put(cut->direction[c], precision, i, glint_tile_direction(tile, precision, c, i));
        glint_real_put(cut->t, precision, i, t);
        glint_real_put(cut->total_t, precision, i, t);
        cut->begun[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
    }
    return true;
}

/// Continues the rays in holes to the next surface, which is stored in the tile.
static void see_next(struct glint_cut_out *cut, glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_precision precision = frame->plan->desc.precision;
    const bool eye = tile->batch == NULL; // the eye's rays do not start on a surface
    for (uint32_t g = 0; g < tile->group_count; g++) {
        for (unsigned bits = cut->holes[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            const bool first = eye && !(cut->passed[g] & bits & -bits) && stands_alone(&frame->geometry, cut->prim[i]);
            leave_hole(cut, frame, i, first && is_flat(&frame->geometry, &frame->geometry.prims[cut->prim[i]]));
        }
        cut->active[g] = cut->holes[g];
        cut->passed[g] |= cut->holes[g];
    }
    cast(cut, tile, frame, &frame->geometry, cut->active, true);
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = cut->active[g]; bits; bits &= bits - 1) {
            const uint16_t bit = (uint16_t)(bits & -bits);
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            const double t = glint_real_at(cut->t, precision, i);
            const double before = cut->begun[g] & bit ? 0 : glint_real_at(cut->total_t, precision, i);
            glint_real_put(cut->total_t, precision, i, before + t);
            glint_real_put(tile->at.t, precision, i, before + t);
            tile->at.prim[i] = cut->prim[i];
            if (!(cut->hits[g] & bit))
                tile->at.hits[g] &= (uint16_t)~bit;
        }
}

/// Takes the distances of a cast that are nearer to the known distance than those taken before; without `any`, only
/// distances within rounding of the known one.
static void take_nearer(const struct glint_cut_out *cut, glint_tile *tile, const glint_tile_frame *frame, bool any,
                        double off[GLINT_TILE_SAMPLES])
{
    const glint_precision precision = frame->plan->desc.precision;
    const double rounding = precision == GLINT_PRECISION_FLOAT ? 0x1p-16 : 0x1p-40;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        const double t = glint_real_at(cut->t, precision, i);
        const double away = fabs(t - glint_real_at(cut->total_t, precision, i));
        if (!glint_has_lane(cut->hits, i) || !(away < off[i]) || !(any || away <= rounding * t))
            continue;
        glint_real_put(tile->at.t, precision, i, t);
        off[i] = away;
    }
}

/// Computes the distance of primitive `prim`, which the lanes in `active` see through holes, from the origins of
/// their rays. The candidates are the first and the second hit on the primitive. The candidate nearer to the known
/// distance is taken. For a sphere, whose point is exact from any distance, and for a torus, which may have two more
/// hits, the candidate must be within rounding of the known distance.
static void see_from_origin(struct glint_cut_out *cut, glint_tile *tile, const glint_tile_frame *frame, uint32_t prim,
                            double off[GLINT_TILE_SAMPLES])
{
    static const uint32_t only = 0;
    glint_prim seen = frame->geometry.prims[prim];
    const bool torus = seen.kind == GLINT_PRIM_SOLID && frame->geometry.solids[seen.item].form == GLINT_FORM_TORUS;
    const bool any = seen.kind != GLINT_PRIM_SPHERE && !torus;
    glint_geometry_table one = frame->geometry;
    seen.filter_bound = HUGE_VALF; // parts of combined solids have no filter, and these rays hit the primitive
    one.prims = &seen;
    one.prim_count = one.unbounded_count = 1;
    one.unbounded = &only;
    one.nodes = NULL;
    cast(cut, tile, frame, &one, cut->active, false);
    take_nearer(cut, tile, frame, any, off);
    if (is_flat(&frame->geometry, &seen))
        return;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++)
        cut->leaving[i] = glint_has_lane(cut->active, i) ? only : GLINT_MISS;
    memcpy(cut->inward, cut->active, sizeof cut->inward);
    cast(cut, tile, frame, &one, cut->active, true);
    take_nearer(cut, tile, frame, any, off);
}

/// Calls see_from_origin for all surfaces seen through holes.
static void see_all_from_origin(struct glint_cut_out *cut, glint_tile *tile, const glint_tile_frame *frame)
{
    double off[GLINT_TILE_SAMPLES];
    for (uint32_t g = 0; g < tile->group_count; g++)
        cut->passed[g] &= tile->at.hits[g];
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        off[i] = HUGE_VAL;
        if (glint_has_lane(cut->passed, i))
            put_first_origin(cut, tile, frame, i);
    }
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        if (!glint_has_lane(cut->passed, i))
            continue;
        const uint32_t prim = tile->at.prim[i];
        for (uint32_t g = 0; g < tile->group_count; g++) {
            cut->active[g] = 0;
            for (unsigned bits = cut->passed[g]; bits; bits &= bits - 1)
                if (tile->at.prim[g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits)] == prim)
                    cut->active[g] |= (uint16_t)(bits & -bits);
            cut->passed[g] &= (uint16_t)~cut->active[g];
        }
        see_from_origin(cut, tile, frame, prim, off);
    }
}

/// After a cast: continues the rays that hit holes. tile->at then has the surfaces finally hit.
static void see_through(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    (void)walk;
    struct glint_cut_out *cut = own_of(tile);
    if (!begin_seeing(cut, tile, frame))
        return;
    for (int k = 0; k < HOLES_MAX && !glint_tile_cancelled(frame); k++) {
        unsigned any = 0;
        find_holes(cut, tile, frame, true);
        for (uint32_t g = 0; g < tile->group_count; g++)
            any |= cut->holes[g];
        if (!any)
            break;
        see_next(cut, tile, frame);
        if (!choose_cut(cut, tile, frame))
            break;
    }
    see_all_from_origin(cut, tile, frame);
}

// ---- Lights ----

/// Starts sample i's ray to a light at the hole that it is in, or at its point.
static void aim(struct glint_cut_out *cut, const glint_tile_frame *frame, const glint_plan_light *light,
                const double target[3], const double point[3], uint32_t i)
{
    const glint_precision precision = frame->plan->desc.precision;
    for (int c = 0; c < 3; c++) {
        glint_real_put(cut->origin[c], precision, i, point[c]);
        glint_real_put(cut->direction[c], precision, i, light->directional ? target[c] : target[c] - point[c]);
    }
}

static void target_of(const glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light, bool middle,
                      uint32_t i, double out[3])
{
    if (middle)
        vec_copy(out, light->position);
    else
        glint_tile_light_target(tile, frame, light, i, out);
}

static bool begin_lighting(struct glint_cut_out *cut, const glint_tile *tile, const glint_tile_frame *frame,
                           const glint_plan_light *light, bool middle, const uint16_t *lit, const uint16_t *unoccluded)
{
    const glint_precision precision = frame->plan->desc.precision;
    bool any = false;
    clear_rays(cut, tile, precision);
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        const uint16_t bit = (uint16_t)(1u << i % GLINT_GROUP);
        const uint32_t g = i / GLINT_GROUP;
        double point[3], target[3];
        if (!(lit[g] & ~unoccluded[g] & bit))
            continue;
        for (int c = 0; c < 3; c++)
            point[c] = glint_real_at(tile->surface.point[c], precision, i);
        target_of(tile, frame, light, middle, i, target);
        aim(cut, frame, light, target, point, i);
        cut->leaving[i] = tile->at.prim[i];
        cut->inward[g] |= tile->hit.back[g] & bit;
        cut->active[g] |= bit;
        any = true;
    }
    return any;
}

/// Continues the rays in holes. Rays without a further surface before the light arrive.
static bool go_on(struct glint_cut_out *cut, glint_tile *tile, const glint_tile_frame *frame,
                  const glint_plan_light *light, bool middle, uint16_t *unoccluded)
{
    const glint_precision precision = frame->plan->desc.precision;
    unsigned any = 0;
    cast(cut, tile, frame, &frame->geometry, cut->active, true);
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = cut->active[g]; bits; bits &= bits - 1) {
            const uint16_t bit = (uint16_t)(bits & -bits);
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            const bool beyond = !light->directional && !(glint_real_at(cut->t, precision, i) < 1);
            tile->counts.shadow++;
            if (!(cut->hits[g] & bit) || beyond) {
                cut->hits[g] &= (uint16_t)~bit;
                unoccluded[g] |= cut->passed[g] & bit;
            }
        }
    if (!choose_cut(cut, tile, frame))
        return false;
    find_holes(cut, tile, frame, false);
    for (uint32_t g = 0; g < tile->group_count; g++) {
        cut->active[g] = cut->holes[g];
        cut->passed[g] |= cut->holes[g];
        any |= cut->holes[g];
        for (unsigned bits = cut->holes[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            double point[3], target[3];
            leave_hole(cut, frame, i, false);
            for (int c = 0; c < 3; c++)
                point[c] = glint_real_at(cut->origin[c], precision, i);
            target_of(tile, frame, light, middle, i, target);
            aim(cut, frame, light, target, point, i);
        }
    }
    return any;
}

/// After occlude: opens lit points that are only occluded by surfaces that have holes at the occluding hits. middle:
/// towards the light's centre, for all samples.
static void open_holes(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light, bool middle, const uint16_t *lit,
                       uint16_t *unoccluded)
{
    struct glint_cut_out *cut = own_of(tile);
    if (!begin_lighting(cut, tile, frame, light, middle, lit, unoccluded))
        return;
    for (int k = 0; k < HOLES_MAX && go_on(cut, tile, frame, light, middle, unoccluded); k++)
        if (glint_tile_cancelled(frame))
            return;
}

static glint_key own_key(const glint_plan *plan, glint_key key)
{
    for (uint32_t i = 0; i < plan->material_count; i++)
        GLINT_KEY_ADD(key, plan->patterns->of[i].cut);
    GLINT_KEY_ADD(key, plan->geometry->look); // includes the materials of surfaces
    return glint_programs_key(plan, 1u << GLINT_FIELD_OPACITY, key);
}

/// Runs as a part of the stages cast and occlude.
const glint_stage glint_stage_cut_out = {
    .called = glint_plan_cuts,
    .own = own_key,
    .step[GLINT_AT_CAST] = see_through,
    .admit = open_holes,
    .create = create,
    .destroy = free,
    .shared = true,
};
