#include "engine/render/geometry/geometry.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

// ---- Equal primitives ----

#define LOOKUPS 32u ///< primitives that are looked up together

/// A slot of the hash table that finds primitives by position.
typedef struct record_slot {
    uint32_t number; ///< index of the primitive + 1; 0: the slot is free
    uint32_t tag; ///< bits of the hash that are not part of the slot's index
} record_slot;

static bool is_repeat(const glint_geometry *geometry, uint32_t i, uint32_t other)
{
    double record[GLINT_PRIM_RECORD_MAX], same[GLINT_PRIM_RECORD_MAX];
    const size_t bytes = (size_t)glint_prim_record(geometry, &geometry->prims[i], record) * sizeof *record;
    glint_prim_record(geometry, &geometry->prims[other], same);
    return memcmp(record, same, bytes) == 0; // the kind comes first, so records of different lengths differ there
}

/// Marks the primitives, `count` of them, that are bit-equal to an earlier one. Prefetches their slots first.
static void mark_repeats(glint_geometry *geometry, uint32_t first, uint32_t count, record_slot *slots, size_t mask)
{
    glint_key keys[LOOKUPS];
    for (uint32_t n = 0; n < count; n++) {
        double record[GLINT_PRIM_RECORD_MAX];
        const glint_prim *prim = &geometry->prims[first + n];
        if (prim->kind == GLINT_PRIM_TRIANGLE)
            continue; // triangles of one plane have their own rule
        keys[n] = glint_key_add((glint_key) { 0 }, record,
                                (size_t)glint_prim_record(geometry, prim, record) * sizeof *record);
        __builtin_prefetch(&slots[keys[n].low & mask]);
    }
    for (uint32_t n = 0; n < count; n++) {
        const uint32_t i = first + n, tag = (uint32_t)keys[n].high;
        if (geometry->prims[i].kind == GLINT_PRIM_TRIANGLE)
            continue;
        size_t at = keys[n].low & mask;
        while (slots[at].number && !(slots[at].tag == tag && is_repeat(geometry, i, slots[at].number - 1)))
            at = (at + 1) & mask;
        if (slots[at].number)
            geometry->prims[i].filter_bound = GLINT_REPEATED;
        else
            slots[at] = (record_slot) { i + 1, tag };
    }
}

/// Finds the primitives that are bit-equal to an earlier one.
static glint_status find_repeats(glint_geometry *geometry, glint_error *error)
{
    const uint32_t count = geometry->table.prim_count;
    size_t size = 16, unlike = count - geometry->table.triangles;
    while (size < 2 * unlike)
        size *= 2;
    record_slot *slots = glint_scratch_resize(NULL, 0, size * sizeof *slots);
    if (!slots)
        return glint_fail_nomem(error);
    memset(slots, 0, size * sizeof *slots);
    for (uint32_t i = 0; i < count && unlike; i += LOOKUPS)
        mark_repeats(geometry, i, count - i < LOOKUPS ? count - i : LOOKUPS, slots, size - 1);
    glint_scratch_free(slots, size * sizeof *slots);
    return GLINT_OK;
}

/// Computes the keys of the primitives' positions and materials.
static void make_keys(glint_geometry *geometry)
{
    enum { CHUNK = 32 };
    size_t smooth = 0, shared = 0;
    for (uint32_t i = 0; i < geometry->table.prim_count; i += CHUNK) {
        double record[CHUNK * GLINT_PRIM_RECORD_MAX];
        uint32_t look[CHUNK][2], n = 0;
        size_t numbers = 0;
        for (; n < CHUNK && i + n < geometry->table.prim_count; n++) {
            const glint_prim *prim = &geometry->prims[i + n];
            numbers += (size_t)glint_prim_record(geometry, prim, record + numbers);
            const bool triangle = prim->kind == GLINT_PRIM_TRIANGLE, flat = !triangle || prim->item == GLINT_MISS;
            const bool shading_points = triangle && prim->shading_points != GLINT_MISS;
            const uint32_t *part =
                // the positions alone do not show where one mesh ends and the next begins
                geometry->prim_part + prim->id;
            const bool other = triangle && i + n > 0 && prim[-1].kind == GLINT_PRIM_TRIANGLE && part[-1] != part[0];
            look[n][0] = prim->two_sided | (flat ? 0 : 2u) | (shading_points ? 4u : 0) | (other ? 8u : 0);
            look[n][1] = prim->material;
            smooth += !flat;
            shared += shading_points;
        }
        geometry->where = glint_key_add(geometry->where, record, numbers * sizeof *record);
        geometry->look = glint_key_add(geometry->look, look, n * sizeof look[0]);
    }
    for (uint32_t i = 0; i < geometry->member_count; i++) {
        const glint_prim *member = &geometry->members[i];
        const uint32_t look[3] = { member->two_sided, member->material, member->medium };
        geometry->look = glint_key_add(geometry->look, look, sizeof look);
        smooth += member->kind == GLINT_PRIM_TRIANGLE && member->item != GLINT_MISS;
    }
    geometry->look = glint_key_add(geometry->look, geometry->normals, smooth * sizeof *geometry->normals);
    if (shared)
        geometry->look =
            glint_key_add(geometry->look, geometry->shading_points, shared * sizeof *geometry->shading_points);
}

// ---- The BVH's frame ----

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Chooses the BVH's frame: its origin is the median of the primitives' positions, which a single giant primitive
/// does not move, and its unit is about the largest length. Floats lose the least precision in this frame.
static void choose_frame(glint_geometry *geometry)
{
    enum { SAMPLES = 255 };
    glint_geometry_table *table = &geometry->table;
    const uint32_t count = table->prim_count, step = count / SAMPLES + 1;
    for (int c = 0; c < 3; c++) {
        double sample[SAMPLES + 1] = { 0 };
        size_t n = 0;
        for (uint32_t i = 0; i < count; i += step)
            sample[n++] = glint_prim_has_corners(&geometry->prims[i]) ? geometry->prims[i].corner[0][c] : geometry->prims[i].center[c];
        qsort(sample, n, sizeof *sample, by_value);
        table->reference[c] = n ? sample[n / 2] : 0;
    }
    double largest = 0;
    for (uint32_t i = 0; i < count; i++) {
        const glint_prim *prim = &geometry->prims[i];
        double lower[3], upper[3];
        if (!glint_prim_bounded(prim)) {
            table->extent = fmax(table->extent, vec_max_abs(prim->center));
            continue;
        }
        glint_prim_bounds(table->solids, prim, lower, upper);
        table->extent = fmax(table->extent, fmax(vec_max_abs(lower), vec_max_abs(upper)));
        vec_sub(lower, lower, table->reference);
        vec_sub(upper, upper, table->reference);
        largest = fmax(largest, fmax(vec_max_abs(lower), vec_max_abs(upper)));
    }
    for (uint32_t i = 0; i < geometry->member_count; i++) {
        const glint_prim *member = &geometry->members[i];
        const bool hull = member->kind == GLINT_PRIM_HULL; // its box contains all its triangles
        for (int k = hull ? 1 : 0; k < (hull ? 3 : 1); k++)
            table->extent = fmax(table->extent, vec_max_abs(glint_prim_has_corners(member) ? member->corner[k] : member->center));
    }
    table->scale = largest > 0 && isfinite(largest) ? power_of_two_scale(largest) : 1;
}

/// Stores the box of a solid or combined solid and, for a solid, the filter's data about its axis.
static void store_box(const glint_geometry *geometry, const glint_prim *prim)
{
    glint_box box;
    if (prim->kind != GLINT_PRIM_SOLID && prim->kind != GLINT_PRIM_COMBINED)
        return;
    const bool combined = prim->kind == GLINT_PRIM_COMBINED;
    float *lower = combined ? geometry->combined[prim->item].lower : geometry->solids[prim->item].lower;
    float *upper = combined ? geometry->combined[prim->item].upper : geometry->solids[prim->item].upper;
    glint_prim_place_box(&geometry->table, prim, 0, &box);
    memcpy(lower, box.lower, sizeof box.lower);
    memcpy(upper, box.upper, sizeof box.upper);
    if (!combined)
        glint_prim_place_axis(&geometry->table, prim, &geometry->solids[prim->item]);
}

static glint_status index_create(glint_geometry *geometry, glint_error *error)
{
    const uint32_t count = geometry->table.prim_count;
    glint_index *index = geometry->index = calloc(1, sizeof *index);
    uint32_t unbounded = 0;
    for (uint32_t i = 0; i < count; i++)
        unbounded += !glint_prim_bounded(&geometry->prims[i]);
    geometry->unbounded = glint_alloc(unbounded, sizeof *geometry->unbounded);
    if (!index || !geometry->unbounded)
        return glint_fail_nomem(error);
    atomic_init(&index->references, 1);
    pthread_mutex_init(&index->lock, NULL);
    for (uint32_t i = 0; i < count; i++) {
        glint_prim *prim = &geometry->prims[i];
        if (prim->filter_bound == GLINT_REPEATED)
            continue; // the first of several equal primitives wins every tie and casts every shadow
        prim->filter_bound = HUGE_VALF;
        if (glint_prim_bounded(prim)) {
            glint_prim_place_sphere(&geometry->table, prim);
            store_box(geometry, prim);
            index->box_count++;
        } else {
            for (int c = 0; c < 3 && prim->kind == GLINT_PRIM_COMBINED; c++) {
                geometry->combined[prim->item].lower[c] = -HUGE_VALF;
                geometry->combined[prim->item].upper[c] = HUGE_VALF;
            }
            geometry->unbounded[geometry->table.unbounded_count++] = i;
        }
    }
    geometry->table.unbounded = geometry->unbounded;
    return GLINT_OK;
}

static void index_release(glint_index *index)
{
    if (!index || atomic_fetch_sub(&index->references, 1) > 1)
        return;
    glint_bvh_free(&index->bvh);
    free(index->order);
    pthread_mutex_destroy(&index->lock);
    free(index);
}

/// Returns the next position in the order; triangles come first. next: the next free position for triangles, and for
/// other primitives.
static inline uint32_t take_position(const glint_geometry *geometry, uint32_t i, uint32_t next[2])
{
    const glint_geometry_table *table = &geometry->table;
    const bool mixed = table->triangles && table->triangles < geometry->index->box_count;
    return next[mixed && geometry->prims[i].kind != GLINT_PRIM_TRIANGLE]++;
}

/// Numbers the primitives in the order in which the tree's nodes refer to them, and updates the nodes.
static void order_by_tree(const glint_geometry *geometry)
{
    glint_index *index = geometry->index;
    uint32_t next[2] = { 0, geometry->table.triangles };
    for (uint32_t n = 0; n < index->bvh.node_count; n++) {
        glint_node *node = &index->bvh.nodes[n];
        for (int i = 0; i < GLINT_NODE_WIDTH; i++) {
            if (!(node->lower[0][i] <= node->upper[0][i]) || !(node->child[i] & GLINT_NODE_PRIM))
                continue;
            const uint32_t from = node->child[i] & ~GLINT_NODE_PRIM, position = take_position(geometry, from, next);
            index->order[position] = from;
            node->child[i] = GLINT_NODE_PRIM | position;
        }
    }
}

/// Arranges primitives in order of definition, except that triangles come first.
static glint_status make_order(const glint_geometry *geometry, glint_error *error)
{
    glint_index *index = geometry->index;
    uint32_t next[2] = { 0, geometry->table.triangles };
    index->order = malloc((index->box_count + 1) * sizeof *index->order);
    if (!index->order)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < geometry->table.prim_count; i++)
        if (glint_prim_in_tree(&geometry->prims[i]))
            index->order[take_position(geometry, i, next)] = i;
    index->plain = true;
    return GLINT_OK;
}

/// Builds the BVH. The primitives get the tree's order, unless an earlier frame has already fixed another order.
static glint_status index_build(glint_geometry *geometry, glint_pool *pool, glint_error *error)
{
    glint_index *index = geometry->index;
    glint_box *boxes = glint_geometry_boxes(geometry, index->box_count, false, pool);
    if (!boxes)
        return glint_fail_nomem(error);
    glint_status status = glint_bvh_build(boxes, index->box_count, pool, &index->bvh, error);
    if (!status && !index->order) {
        index->order = malloc((index->box_count + 1) * sizeof *index->order);
        if (!index->order) {
            glint_bvh_free(&index->bvh);
            return glint_fail_nomem(error);
        }
        order_by_tree(geometry);
    }
    index->built = !status;
    return status;
}

glint_status glint_geometry_index(glint_geometry *geometry, glint_pool *pool, glint_geometry_table *table,
                                  glint_error *error)
{
    glint_index *index = geometry->index;
    pthread_mutex_lock(&index->lock);
    glint_status status = GLINT_OK;
    if (index->order && !geometry->arranged)
        status = glint_geometry_move(geometry, pool, error);
    if (!status && !index->built)
        status = index_build(geometry, pool, error);
    if (!status && !geometry->arranged)
        status = glint_geometry_move(geometry, pool, error);
    *table = geometry->table;
    table->nodes = index->bvh.nodes;
    pthread_mutex_unlock(&index->lock);
    return status;
}

glint_status glint_geometry_arrange(glint_geometry *geometry, glint_geometry_table *table, glint_error *error)
{
    glint_index *index = geometry->index;
    pthread_mutex_lock(&index->lock);
    glint_status status = GLINT_OK;
    if (!index->order)
        status = make_order(geometry, error);
    if (!status && !geometry->arranged)
        status = glint_geometry_move(geometry, NULL, error);
    *table = geometry->table;
    table->nodes = index->bvh.nodes;
    pthread_mutex_unlock(&index->lock);
    return status;
}

/// Builds a tree of the primitives that are neither triangles nor planes.
static glint_status build_others(glint_geometry *geometry, glint_pool *pool, glint_error *error)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < geometry->index->box_count; i++)
        count += geometry->prims[i].kind != GLINT_PRIM_TRIANGLE;
    glint_box *boxes = glint_geometry_boxes(geometry, count, true, pool);
    glint_status status = boxes ? glint_bvh_build(boxes, count, pool, &geometry->others, error) : glint_fail_nomem(error);
    geometry->has_others = !status;
    return status;
}

glint_status glint_geometry_others(glint_geometry *geometry, glint_pool *pool, glint_geometry_table *table, bool *any,
                                   glint_error *error)
{
    pthread_mutex_lock(&geometry->index->lock);
    glint_status status = geometry->has_others ? GLINT_OK : build_others(geometry, pool, error);
    *table = geometry->table;
    table->nodes = geometry->others.nodes;
    *any = table->nodes || table->unbounded_count > 0;
    pthread_mutex_unlock(&geometry->index->lock);
    return status;
}

// ---- The geometry of a scene ----

glint_geometry *glint_geometry_retain(glint_geometry *geometry)
{
    atomic_fetch_add(&geometry->references, 1);
    return geometry;
}

void glint_geometry_release(glint_geometry *geometry)
{
    if (!geometry || atomic_fetch_sub(&geometry->references, 1) > 1)
        return;
    index_release(geometry->index);
    glint_bvh_free(&geometry->others);
    glint_list_free(&geometry->materials);
    free(geometry->prims);
    free(geometry->corners);
    free(geometry->planes);
    free(geometry->prim_part);
    free(geometry->parts);
    free(geometry->maps);
    free(geometry->normals);
    free(geometry->solids);
    free(geometry->combined);
    free(geometry->members);
    glint_geometry_release_hulls(geometry);
    free(geometry->faces);
    free(geometry->unbounded);
    free(geometry->shading_points);
    free(geometry->shading_point_prims);
    free(geometry->index_of_id);
    free(geometry);
}

static glint_status fill(glint_geometry *geometry, const glint_scene *scene, glint_error *error)
{
    const glint_geometry *last = scene->geometry;
    glint_status status = glint_geometry_fill(geometry, scene, error);
    if (!status)
        status = glint_geometry_check_sizes(geometry, error);
    if (!status)
        status = find_repeats(geometry, error);
    if (status)
        return status;
    make_keys(geometry);
    choose_frame(geometry);
    status = index_create(geometry, error);
    if (!status)
        status = glint_geometry_hull_trees(geometry, last, error);
    if (!status && last && glint_key_equal(last->where, geometry->where)) {
        index_release(geometry->index);
        geometry->index = last->index;
        atomic_fetch_add(&geometry->index->references, 1);
    }
    return status;
}

uint32_t glint_geometry_object(const glint_geometry *geometry, uint32_t id)
{
    const glint_part *part = &geometry->parts[geometry->prim_part[id]];
    // a part of a combined solid has only one id, so the difference is 0
    return part->first_object + (part->shape->mesh ? 0 : id - part->first_prim);
}

/// Returns a key of the states of all shapes: every change gives the shape a revision number that is never used again
/// for any shape.
static glint_key revision_of(const glint_scene *scene)
{
    enum { CHUNK = 64 };
    glint_key key = { 0 };
    for (size_t i = 0; i < scene->shapes.count; i += CHUNK) {
        uint64_t revision[CHUNK];
        size_t n = 0;
        for (; n < CHUNK && i + n < scene->shapes.count; n++)
            revision[n] = glint_shape_revision(glint_scene_shape(scene, i + n));
        key = glint_key_add(key, revision, n * sizeof *revision);
    }
    return key;
}

glint_status glint_geometry_of(const glint_scene *scene, glint_geometry **out, glint_error *error)
{
    const glint_key revision = revision_of(scene);
    if (!scene->geometry || !glint_key_equal(scene->geometry->revision, revision)) {
        glint_geometry *geometry = calloc(1, sizeof *geometry);
        if (!geometry)
            return glint_fail_nomem(error);
        atomic_init(&geometry->references, 1);
        geometry->revision = revision;
        glint_status status = fill(geometry, scene, error);
        if (status) {
            glint_geometry_release(geometry);
            return status;
        }
        glint_geometry_release(scene->geometry);
        // The cache may be changed in a constant scene, because no caller can see it.
        ((glint_scene *)scene)->geometry = geometry;
    }
    *out = glint_geometry_retain(scene->geometry);
    return GLINT_OK;
}
