/// The stage vertex: computes the light of faces and vertices on first use, and interpolates it at each sample of
/// their triangles.
///
/// A shading point lies on a surface, but on none of its triangles. Surfaces that touch the point do not shadow it,
/// so that neighbours never shadow the middle of a face or a common vertex by rounding. Surfaces at a distance do, as
/// for any point.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/render/light_groups/light_groups.h"
#include "engine/render/effects/vertex_shading/shading_points.h"
#include "engine/render/paths/batch.h"

#include <float.h>
#include <sched.h>
#include <stdlib.h>

#define PREFETCHED 8 ///< number of points to prefetch ahead

struct glint_vertex {
    glint_batch batch; ///< the points of one block
    _Alignas(64) uint32_t no_owner[GLINT_SHADING_POINT_BLOCK]; ///< GLINT_MISS
    _Alignas(64) double nowhere[GLINT_SHADING_POINT_BLOCK]; ///< 0
    uint16_t wanted[GLINT_TILE_GROUPS];
};

static void *create(const glint_plan *plan)
{
    (void)plan;
    struct glint_vertex *vertex = glint_alloc(1, sizeof *vertex);
    for (int i = 0; vertex && i < GLINT_SHADING_POINT_BLOCK; i++)
        vertex->no_owner[i] = GLINT_MISS;
    return vertex;
}

static void destroy(void *memory)
{
    struct glint_vertex *vertex = memory;
    if (vertex)
        glint_tile_free_stage(&vertex->batch.tile, GLINT_STAGE_DERIVATIVE);
    free(vertex);
}

static bool fit(void *memory, const glint_plan *plan)
{
    struct glint_vertex *vertex = memory;
    return !plan->derivatives || glint_tile_fit_stage(&vertex->batch.tile, plan, GLINT_STAGE_DERIVATIVE);
}

static struct glint_vertex *own_of(const glint_tile *tile) { return tile->own[GLINT_STAGE_VERTEX_SHADING]; }

// ---- Positions ----

typedef struct shading_point {
    double point[3], normal[3]; ///< the normal of the front side
    double slack; ///< slack of the stage surface, divided by the relative rounding error
    uint32_t prim; ///< index of the triangle among the arranged primitives
} shading_point;

/// Computes the normal of a triangle with the length of twice its area, in units of the table.
static void area_of(const glint_prim *prim, double scale, double out[3])
{
    double f[3], g[3];
    vec_sub(f, prim->corner[1], prim->corner[0]);
    vec_sub(g, prim->corner[2], prim->corner[0]);
    vec_scale(f, f, scale);
    vec_scale(g, g, scale);
    vec_cross(out, f, g);
}

/// Puts a shading point on the triangle; w: weights of its second and third corner.
static void put_on(shading_point *s, const glint_prim *prim, const double w[2])
{
    double f[3], g[3];
    vec_sub(f, prim->corner[1], prim->corner[0]);
    vec_sub(g, prim->corner[2], prim->corner[0]);
    for (int c = 0; c < 3; c++)
        s->point[c] = prim->corner[0][c] + (w[0] * f[c] + w[1] * g[c]);
    s->slack = (vec_max_abs(f) + vec_max_abs(g)) + vec_max_abs(s->point);
}

/// Returns the number of triangles of a face, which are consecutive.
static uint32_t face_size(const glint_geometry *geometry, uint32_t first, uint32_t number)
{
    uint32_t count = 1;
    const glint_part *part = &geometry->parts[geometry->prim_part[first]];
    const uint32_t end = part->first_prim + (uint32_t)part->shape->count;
    if (number + 1 < geometry->table.shading_point_count && geometry->shading_point_prims[number + 1] == first + 1)
        return 1; // the next triangle begins the next face
    while (first + count < end &&
           geometry->shading_points[geometry->prims[geometry->index_of_id[first + count]].shading_points].at[0] ==
               number)
        count++;
    return count;
}

/// Computes the weights, as for put_on, of a point projected onto a triangle along the normal of a face. Returns the
/// smallest of all three weights.
static double weights_of(const glint_prim *prim, double scale, const double point[3], const double normal[3],
                         double w[2])
{
    double f[3], g[3], q[3], cross[3];
    vec_sub(f, prim->corner[1], prim->corner[0]);
    vec_sub(g, prim->corner[2], prim->corner[0]);
    vec_sub(q, point, prim->corner[0]);
    vec_scale(f, f, scale);
    vec_scale(g, g, scale);
    vec_scale(q, q, scale);
    vec_cross(cross, f, g);
    const double area = vec_dot(cross, normal);
    vec_cross(cross, q, g);
    w[0] = vec_dot(cross, normal) / area;
    vec_cross(cross, f, q);
    w[1] = vec_dot(cross, normal) / area;
    return fmin(fmin(w[0], w[1]), 1 - w[0] - w[1]);
}

/// Finds the middle of a polygon, on the triangle that contains it; if the middle is outside, the middle of the
/// largest triangle.
static void find_polygon_middle(const glint_geometry *geometry, uint32_t first, uint32_t count, shading_point *s)
{
    const double scale = geometry->table.scale;
    double total = 0, largest = 0, middle[3] = { 0 }, w[2] = { 1 / 3.0, 1 / 3.0 };
    const double *origin = geometry->prims[geometry->index_of_id[first]].corner[0];
    uint32_t best = first;
    vec_scale(s->normal, s->normal, 0);
    for (uint32_t id = first; id < first + count; id++) {
        const glint_prim *prim = &geometry->prims[geometry->index_of_id[id]];
        double area[3];
        area_of(prim, scale, area);
        const double size = sqrt(vec_dot(area, area));
        for (int c = 0; c < 3; c++) {
            s->normal[c] += area[c];
            middle[c] += size * (((prim->corner[0][c] - origin[c]) + (prim->corner[1][c] - origin[c])) +
                                 (prim->corner[2][c] - origin[c]));
        }
        total += size;
        best = size > largest ? id : best;
        largest = fmax(largest, size);
    }
    for (int c = 0; c < 3; c++)
        middle[c] = origin[c] + middle[c] / (3 * total);
    if (vec_max_abs(s->normal) > 0)
        vec_normalize(s->normal, s->normal);
    for (uint32_t id = first; id < first + count; id++) {
        double x[2];
        if (!(weights_of(&geometry->prims[geometry->index_of_id[id]], scale, middle, s->normal, x) >= -0x1p-40))
            continue;
        best = id;
        w[0] = x[0], w[1] = x[1];
        break;
    }
    s->prim = geometry->index_of_id[best];
    put_on(s, &geometry->prims[s->prim], w);
}

/// Finds the position of a vertex from a triangle.
static void find_corner(const glint_geometry *geometry, const glint_prim *prim, uint32_t number, shading_point *s)
{
    static const double corners[3][2] = { { 0, 0 }, { 1, 0 }, { 0, 1 } };
    const uint32_t *at = geometry->shading_points[prim->shading_points].at;
    const int j = at[0] == number ? 0 : at[1] == number ? 1 : 2;
    const double *normal = geometry->normals[prim->item].normal[j];
    put_on(s, prim, corners[j]);
    vec_copy(s->point, prim->corner[j]);
    const double length2 = vec_dot(normal, normal), side = vec_dot(normal, s->normal) < 0 ? -1 : 1;
    if (length2 > 0) // normals of length 1 within rounding are unchanged
        vec_scale(s->normal, normal, fabs(length2 - 1) < 1e-12 ? side : side / sqrt(length2));
}

static void find_shading_point(const glint_geometry *geometry, uint32_t number, shading_point *s)
{
    static const double middle[2] = { 1 / 3.0, 1 / 3.0 };
    const uint32_t first = geometry->shading_point_prims[number];
    s->prim = geometry->index_of_id[first];
    const glint_prim *prim = &geometry->prims[s->prim];
    area_of(prim, geometry->table.scale, s->normal);
    if (vec_max_abs(s->normal) > 0)
        vec_normalize(s->normal, s->normal);
    if (prim->item != GLINT_MISS) {
        find_corner(geometry, prim, number, s);
        return;
    }
    const uint32_t count = face_size(geometry, first, number);
    if (count == 1)
        put_on(s, prim, middle);
    else
        find_polygon_middle(geometry, first, count, s);
}

// ---- A block ----

/// Computes the unit vector from a point to the eye.
static void view_of(const glint_plan_camera *camera, const double point[3], double out[3])
{
    vec_sub(out, point, camera->eye);
    if (camera->orthographic || vec_max_abs(out) == 0)
        vec_copy(out, camera->forward);
    else
        vec_normalize(out, out);
}

static void put_shading_point(glint_tile *tile, const glint_tile_frame *frame, uint32_t i, const shading_point *s,
                              bool back)
{
    const glint_precision precision = frame->plan->desc.precision;
    const double rounding = precision == GLINT_PRECISION_FLOAT ? GLINT_POINT_SLACK_FLOAT : GLINT_POINT_SLACK_DOUBLE;
    double view[3];
    view_of(&frame->plan->camera, s->point, view);
    for (int c = 0; c < 3; c++) {
        glint_real_put(tile->surface.point[c], precision, i, s->point[c]);
        glint_real_put(tile->surface.normal[c], precision, i, back ? -s->normal[c] : s->normal[c]);
        glint_real_put(tile->rays.direction[c], precision, i, view[c]);
    }
    glint_real_put(tile->surface.slack, precision, i, rounding * s->slack);
    tile->hit.prim[i] = s->prim;
    tile->surface.material[i] = frame->geometry.prims[s->prim].material;
}

/// Prefetches a triangle, which can be anywhere in memory.
static void prefetch_prim(const glint_geometry *geometry, uint32_t number)
{
    const uint32_t first = geometry->shading_point_prims[number];
    if (first != GLINT_MISS)
        __builtin_prefetch(&geometry->prims[geometry->index_of_id[first]]);
}

/// Loads the points of a block into the arrays. The backs of one-sided surfaces have no light.
static void load_block(struct glint_vertex *vertex, const glint_tile_frame *frame, uint32_t block)
{
    glint_tile *tile = &vertex->batch.tile;
    const uint32_t blocks = glint_shading_points_of(frame)->blocks;
    const bool back = block >= blocks;
    const uint32_t first = (back ? block - blocks : block) * GLINT_SHADING_POINT_BLOCK;
    const uint32_t remaining = frame->geometry.shading_point_count - first;
    tile->group_count = GLINT_SHADING_POINT_BLOCK / GLINT_GROUP;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        tile->hit.mask[g] = tile->hit.dark[g] = 0;
        tile->hit.back[g] = back ? 0xffff : 0;
    }
    for (uint32_t i = 0; i < GLINT_SHADING_POINT_BLOCK; i++) {
        const bool there = i < remaining && frame->plan->geometry->shading_point_prims[first + i] != GLINT_MISS;
        if (i + PREFETCHED < remaining)
            prefetch_prim(frame->plan->geometry, first + i + PREFETCHED);
        shading_point s = { .point = { 0 }, .normal = { 0, 0, 1 }, .prim = 0 };
        if (there)
            find_shading_point(frame->plan->geometry, first + i, &s);
        put_shading_point(tile, frame, i, &s, back);
        if (there && (!back || frame->geometry.prims[s.prim].two_sided))
            tile->hit.mask[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
    }
    for (uint32_t g = 0; g < tile->group_count; g++)
        tile->active[g] = tile->hit.mask[g];
}

static void store_block(const struct glint_vertex *vertex, const glint_tile_frame *frame, uint32_t block)
{
    const glint_tile *tile = &vertex->batch.tile;
    glint_shading_point_light *light = glint_shading_points_of(frame)->light + (size_t)block * GLINT_SHADING_POINT_BLOCK;
    for (uint32_t i = 0; i < GLINT_SHADING_POINT_BLOCK; i++)
        for (int term = 0; term < 2; term++)
            for (int c = 0; c < 3; c++)
                light[i].term[term][c] = (float)fmin(tile->film.sum[GLINT_TERM_DIFFUSE + term][c][i], FLT_MAX);
}

static void work_out(glint_tile *to, const glint_tile_frame *frame, uint32_t block)
{
    struct glint_vertex *vertex = own_of(to);
    glint_tile *tile = &vertex->batch.tile;
    glint_batch_begin(&vertex->batch, to, frame, GLINT_WALK_SHADING_POINTS);
    tile->sample = 0;
    tile->owner = vertex->no_owner;
    for (int c = 0; c < 3; c++)
        tile->viewed[c] = vertex->nowhere;
    load_block(vertex, frame, block);
    glint_tile_step(tile, frame, GLINT_AT_SURFACE, NULL);
    glint_batch_shine(&vertex->batch, frame, true);
    glint_batch_end(&vertex->batch, to);
    store_block(vertex, frame, block);
    glint_groups_store_block(tile, frame, block);
    if (frame->plan->derivatives)
        glint_derive_store_block(tile, frame, block);
    for (uint32_t g = 0; frame->count_work && g < tile->group_count; g++)
        to->counts.work.sites += (uint64_t)__builtin_popcount(tile->hit.mask[g]);
    to->counts.runs[GLINT_STAGE_VERTEX_SHADING]++;
}

// ---- A tile ----

/// Computes a block unless another worker has begun it. Returns whether the block is ready.
static bool request_block(glint_tile *tile, const glint_tile_frame *frame, uint32_t block)
{
    unsigned char state = atomic_load_explicit(&glint_shading_points_of(frame)->state[block], memory_order_acquire);
    if (state != GLINT_BLOCK_NONE ||
        !atomic_compare_exchange_strong(&glint_shading_points_of(frame)->state[block], &state, GLINT_BLOCK_CLAIMED))
        return state == GLINT_BLOCK_DONE;
    work_out(tile, frame, block);
    atomic_store_explicit(&glint_shading_points_of(frame)->state[block], GLINT_BLOCK_DONE, memory_order_release);
    return true;
}

static bool wait_for(glint_tile *tile, const glint_tile_frame *frame, uint32_t block)
{
    (void)tile;
    while (atomic_load_explicit(&glint_shading_points_of(frame)->state[block], memory_order_acquire) != GLINT_BLOCK_DONE)
        sched_yield();
    return true;
}

/// Calls a function for the block of each point that the wanted samples need. Returns whether all are ready.
static inline bool each_block(glint_tile *tile, const glint_tile_frame *frame,
                              bool (*act)(glint_tile *, const glint_tile_frame *, uint32_t))
{
    bool done = true;
    uint32_t last = GLINT_MISS, last_side = 0;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        if (glint_all_are(tile->at.prim + (size_t)g * GLINT_GROUP, last) && tile->hit.back[g] == (last_side ? 0xffff : 0))
            continue;
        for (unsigned bits = own_of(tile)->wanted[g]; bits; bits &= bits - 1) {
            const uint32_t lane = (uint32_t)__builtin_ctz(bits), prim = tile->at.prim[g * GLINT_GROUP + lane];
            const uint32_t side = tile->hit.back[g] >> lane & 1;
            if (prim == last && side == last_side)
                continue;
            const uint32_t *at = frame->geometry.shading_points[frame->geometry.prims[prim].shading_points].at;
            for (int j = 0; j < 3; j++)
                if (j == 0 || at[j] / GLINT_SHADING_POINT_BLOCK != at[j - 1] / GLINT_SHADING_POINT_BLOCK)
                    done &= act(tile, frame, side * glint_shading_points_of(frame)->blocks + at[j] / GLINT_SHADING_POINT_BLOCK);
            last = prim;
            last_side = side;
        }
    }
    return done;
}

static bool has_shading_points(const glint_prim *prim)
{
    return prim->kind == GLINT_PRIM_TRIANGLE && prim->shading_points != GLINT_MISS;
}

/// Sets at.sampled to the hits that are shaded per sample. Returns whether there are any.
static bool choose_sampled(glint_tile *tile, const glint_tile_frame *frame)
{
    uint32_t last = GLINT_MISS;
    unsigned any = 0;
    bool shading_points = false;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const bool same = last != GLINT_MISS && glint_all_are(tile->at.prim + (size_t)g * GLINT_GROUP, last);
        tile->own_light[g] = same && !shading_points ? tile->at.hits[g] : 0;
        for (unsigned bits = same ? 0 : tile->at.hits[g]; bits; bits &= bits - 1) {
            const uint32_t prim = tile->at.prim[g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits)];
            if (prim != last)
                shading_points = has_shading_points(&frame->geometry.prims[prim]);
            last = prim;
            tile->own_light[g] |= shading_points ? 0 : (uint16_t)(bits & -bits);
        }
        any |= tile->own_light[g];
    }
    tile->at.sampled = tile->own_light;
    return any;
}

/// Returns whether there are other hits, with light computed per face or vertex.
static bool shows_shading_points(const glint_tile *tile)
{
    unsigned any = 0;
    for (uint32_t g = 0; g < tile->group_count; g++)
        any |= tile->at.hits[g] & ~(unsigned)tile->own_light[g];
    return any;
}

/// Adds the interpolated light of the points of each sample's triangle to `sum`: diffuse and specular.
static void spread(glint_tile *tile, const glint_tile_frame *frame, double (*sum)[3][GLINT_TILE_SAMPLES])
{
    const glint_plan *plan = frame->plan;
    const glint_shading_points_cached *shading_points = glint_shading_points_of(frame);
    glint_vertex_args args = { .group_count = tile->group_count,
                               .wanted = own_of(tile)->wanted,
                               .back = tile->hit.back,
                               .prim = tile->at.prim,
                               .prims = frame->geometry.prims,
                               .scale = frame->geometry.scale,
                               .shading_points = frame->geometry.shading_points,
                               .light = { shading_points->light,
                                          shading_points->light +
                                              (size_t)shading_points->blocks * GLINT_SHADING_POINT_BLOCK },
                               .camera = glint_tile_rays_of(tile) };
    for (int c = 0; c < 3; c++) {
        args.origin[c] = tile->rays.origin[c];
        args.direction[c] = tile->rays.direction[c];
        for (int term = 0; term < (plan->highlights || plan->runs[GLINT_STAGE_SHADER] ? 2 : 1); term++)
            args.sum[term][c] = sum[term][c];
    }
    frame->stages->geometry[plan->desc.precision].vertex(&args);
    glint_groups_spread(tile, frame, &args);
}

/// Adds the light of faces and vertices to the given sums: diffuse and specular.
static void add_to(glint_tile *tile, const glint_tile_frame *frame, double (*to)[3][GLINT_TILE_SAMPLES])
{
    for (uint32_t g = 0; g < tile->group_count; g++)
        own_of(tile)->wanted[g] = (uint16_t)(tile->at.hits[g] & ~(tile->own_light[g] | tile->hit.dark[g]));
    if (!each_block(tile, frame, request_block))
        each_block(tile, frame, wait_for);
    spread(tile, frame, to);
    if (frame->plan->derivatives)
        glint_derive_vertex(tile, frame, own_of(tile)->wanted);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_VERTEX_SHADING, false);
    tile->counts.runs[GLINT_STAGE_VERTEX_SHADING]--; // blocks are counted, not calls
}

static bool called(const glint_plan *plan)
{
    return glint_plan_is_lit(plan) && plan->geometry->table.shading_point_count > 0;
}

static void choose(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    walk->shines = walk->any && choose_sampled(tile, frame);
}

/// Adds the light of faces and vertices.
static void add(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (!walk->any || !shows_shading_points(tile))
        return;
    glint_tile_need_points(tile, frame, walk);
    add_to(tile, frame, walk->gathered ? glint_tile_gathered_points(tile) : tile->film.sum + GLINT_TERM_DIFFUSE);
}

const glint_stage glint_stage_vertex_shading = {
    .name = "vertex",
    .doc = "light computed once for each face or vertex",
    .calls = "derivative",
    .called = called,
    .begin = glint_shading_points_begin,
    .end = glint_shading_points_end,
    .reads = GLINT_READS(LIGHT_COLORS) | GLINT_READS(MATERIALS),
    .sums = true,
    .step = { [GLINT_AFTER_PRIMARY] = choose, [GLINT_AFTER_LIGHTS] = add },
    .adds = glint_tile_adds_to_hits,
    .create = create,
    .destroy = destroy,
    .fit = fit,
    .shared = true,
};
