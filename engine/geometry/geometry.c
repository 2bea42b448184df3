#include "engine/geometry/geometry.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

// ---- What is equal ----

static float float_up(double x)
{
    const float f = (float)x;
    return (double)f < x ? nextafterf(f, HUGE_VALF) : f;
}

static float float_down(double x) { return -float_up(-x); }

#define REPEATED (-1.0F) ///< in `filter_bound`: no ray meets the primitive, since one before it is bit-equal

/// Finds the primitives that are bit-equal to one before them.
static glint_status find_repeats(glint_geometry *geometry, glint_error *error)
{
    const uint32_t count = geometry->table.prim_count;
    size_t size = 16, unlike = 0;
    for (uint32_t i = 0; i < count; i++)
        unlike += geometry->prims[i].kind != GLINT_PRIM_TRIANGLE;
    while (size < 2 * unlike)
        size *= 2;
    uint32_t *slots = glint_scratch_resize(NULL, 0, size * sizeof *slots); // index + 1
    if (!slots)
        return glint_fail_nomem(error);
    memset(slots, 0, size * sizeof *slots);
    for (uint32_t i = 0; i < count; i++) {
        double place[GLINT_PLACE_MAX], other[GLINT_PLACE_MAX];
        if (geometry->prims[i].kind == GLINT_PRIM_TRIANGLE)
            continue; // has a rule for all triangles of its plane
        const size_t bytes = (size_t)glint_prim_place(geometry, &geometry->prims[i], place) * sizeof *place;
        size_t at = glint_key_add((glint_key) { 0 }, place, bytes).low & (size - 1);
        for (; slots[at]; at = (at + 1) & (size - 1)) {
            glint_prim_place(geometry, &geometry->prims[slots[at] - 1], other);
            if (memcmp(place, other, bytes) == 0) // the kind comes first: other counts differ there
                break;
        }
        if (slots[at])
            geometry->prims[i].filter_bound = REPEATED;
        else
            slots[at] = i + 1;
    }
    glint_scratch_free(slots, size * sizeof *slots);
    return GLINT_OK;
}

/// Keys of where the primitives are, and of what they look like.
static void make_keys(glint_geometry *geometry)
{
    enum { CHUNK = 32 };
    size_t smooth = 0, shared = 0;
    for (uint32_t i = 0; i < geometry->table.prim_count; i += CHUNK) {
        double place[CHUNK * GLINT_PLACE_MAX];
        uint32_t look[CHUNK][2], n = 0;
        size_t numbers = 0;
        for (; n < CHUNK && i + n < geometry->table.prim_count; n++) {
            const glint_prim *prim = &geometry->prims[i + n];
            numbers += (size_t)glint_prim_place(geometry, prim, place + numbers);
            const bool triangle = prim->kind == GLINT_PRIM_TRIANGLE, flat = !triangle || prim->item == GLINT_MISS;
            const bool shading_points = triangle && prim->shading_points != GLINT_MISS;
            const uint32_t *part =
                geometry->prim_part + prim->id; // where a mesh follows another, the places do not say it
            const bool other = triangle && i + n > 0 && prim[-1].kind == GLINT_PRIM_TRIANGLE && part[-1] != part[0];
            look[n][0] = prim->two_sided | (flat ? 0 : 2u) | (shading_points ? 4u : 0) | (other ? 8u : 0);
            look[n][1] = prim->material;
            smooth += !flat;
            shared += shading_points;
        }
        geometry->where = glint_key_add(geometry->where, place, numbers * sizeof *place);
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

// ---- The index's frame ----

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Around the middle of what there is (the median, so that one giant does not draw it away), in units of the largest
/// length: floats lose least there.
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
        const bool hull = member->kind == GLINT_PRIM_HULL; // whose box is that of all its triangles
        for (int k = hull ? 1 : 0; k < (hull ? 3 : 1); k++)
            table->extent = fmax(table->extent, vec_max_abs(glint_prim_has_corners(member) ? member->corner[k] : member->center));
    }
    table->scale = largest > 0 && isfinite(largest) ? power_of_two_scale(largest) : 1;
}

/// Numbers beyond this are as good as infinite, and differences of such floats are still finite.
#define BOX_MAX 0x1p120

/// What a box has to be larger by, in the index's units: for rounding; for what a solid's inverse and the solid differ by; for
/// what a point may be off a triangle and still count as on it. That last is 13 slacks of the scene's coordinates at most:
/// twice what surface states of the point, of two edges and a coordinate, and one of the corners as the point sees them.
static double box_slack(const glint_geometry_table *table, const glint_prim *prim, double center, double half)
{
    const double rounding = 0x1p-50 * (fabs(center) + half);
    if (prim->kind == GLINT_PRIM_SOLID)
        return rounding + 0x1p-30 * half;
    if (prim->kind == GLINT_PRIM_TRIANGLE)
        return rounding + 16 * GLINT_POINT_SLACK_DOUBLE * table->extent * table->scale;
    return rounding;
}

/// The radius of a sphere around an ellipsoid or torus, in the world. The map stretches nothing by more than the root of the
/// largest sum in a row of its columns' products, which is exact where it keeps angles.
static double reach_of(const glint_solid *solid)
{
    const double unit = solid->form == GLINT_FORM_BALL ? 1 : solid->form == GLINT_FORM_TORUS ? 1 + solid->tube : HUGE_VAL;
    double most = 0;
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int j = 0; j < 3; j++)
            sum += fabs((solid->forward[0][i] * solid->forward[0][j] + solid->forward[1][i] * solid->forward[1][j]) +
                        solid->forward[2][i] * solid->forward[2][j]);
        most = fmax(most, sum);
    }
    return unit * sqrt(most);
}

/// The box of a primitive, where there is room for one, and a sphere around it, which becomes the primitive's: its own, or that of the
/// box, or a smaller one.
static void place_in_frame(const glint_geometry_table *table, glint_prim *prim, glint_box *box)
{
    double lower[3], upper[3], center[3], half[3];
    glint_prim_bounds(table->solids, prim, lower, upper);
    for (int c = 0; c < 3; c++) {
        half[c] = prim->kind == GLINT_PRIM_SPHERE ? prim->radius : 0.5 * upper[c] - 0.5 * lower[c];
        center[c] = prim->kind == GLINT_PRIM_SPHERE ? prim->center[c] : 0.5 * upper[c] + 0.5 * lower[c];
        center[c] = (center[c] - table->reference[c]) * table->scale;
        half[c] *= table->scale;
        const double loose = half[c] + box_slack(table, prim, center[c], half[c]);
        prim->filter_center[c] = (float)center[c];
        if (box) {
            box->lower[c] = float_down(fmax(center[c] - loose, -BOX_MAX));
            box->upper[c] = float_up(fmin(center[c] + loose, BOX_MAX));
        }
        half[c] = prim->kind == GLINT_PRIM_SPHERE ? half[c] : loose;
    }
    double radius = prim->kind == GLINT_PRIM_SPHERE ? half[0] : sqrt(vec_dot(half, half));
    if (prim->kind == GLINT_PRIM_SOLID)
        radius = fmin(radius, reach_of(&table->solids[prim->item]) * table->scale * (1 + 0x1p-20));
    prim->filter_bound = float_up(radius * (1 + 2e-6) + GLINT_FILTER_SLACK * sqrt(vec_dot(center, center)) + FLT_MIN);
}

/// Whether the index has it.
static bool is_in_tree(const glint_prim *prim)
{
    return prim->filter_bound != REPEATED && glint_prim_bounded(prim);
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
        if (prim->filter_bound == REPEATED)
            continue; // the first of equal ones wins every tie and casts every shadow
        prim->filter_bound = HUGE_VALF;
        if (glint_prim_bounded(prim)) {
            place_in_frame(&geometry->table, prim, NULL);
            index->box_count++;
        } else {
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

/// Numbers the primitives in the order in which the tree's nodes name them, and has the nodes say so.
static void order_by_tree(glint_index *index)
{
    uint32_t next = 0;
    for (uint32_t n = 0; n < index->bvh.node_count; n++) {
        glint_node *node = &index->bvh.nodes[n];
        for (int i = 0; i < GLINT_NODE_WIDTH; i++) {
            if (!(node->lower[0][i] <= node->upper[0][i]) || !(node->child[i] & GLINT_NODE_PRIM))
                continue;
            index->order[next] = node->child[i] & ~GLINT_NODE_PRIM;
            node->child[i] = GLINT_NODE_PRIM | next++;
        }
    }
}

/// The order of definition.
static glint_status make_order(const glint_geometry *geometry, glint_error *error)
{
    glint_index *index = geometry->index;
    uint32_t next = 0;
    index->order = malloc((index->box_count + 1) * sizeof *index->order);
    if (!index->order)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < geometry->table.prim_count; i++)
        if (is_in_tree(&geometry->prims[i]))
            index->order[next++] = i;
    index->plain = true;
    return GLINT_OK;
}

/// Boxes of what is in the tree, in the order of `prims`. solids: without triangles. NULL: no memory.
static glint_box *make_boxes(const glint_geometry *geometry, uint32_t count, bool solids)
{
    glint_box *boxes = glint_boxes_alloc(count);
    uint32_t next = 0;
    for (uint32_t i = 0; boxes && i < geometry->table.prim_count && next < count; i++) {
        glint_prim prim = geometry->prims[i]; // other threads may read those of the geometry
        if (!is_in_tree(&prim) || (solids && prim.kind == GLINT_PRIM_TRIANGLE))
            continue;
        boxes[next].item = i;
        boxes[next].unused = 0;
        place_in_frame(&geometry->table, &prim, &boxes[next++]);
    }
    return boxes;
}

/// The order becomes the tree's, unless there has been need of one before, which the primitives are in then.
static glint_status index_build(glint_geometry *geometry, glint_pool *pool, glint_error *error)
{
    glint_index *index = geometry->index;
    glint_box *boxes = make_boxes(geometry, index->box_count, false);
    if (!boxes)
        return glint_fail_nomem(error);
    glint_status status = glint_bvh_build(boxes, index->box_count, pool, &index->bvh, error);
    if (!status && !index->order) {
        index->order = malloc((index->box_count + 1) * sizeof *index->order);
        if (!index->order) {
            glint_bvh_free(&index->bvh);
            return glint_fail_nomem(error);
        }
        order_by_tree(index);
    }
    index->built = !status;
    return status;
}

/// Which primitive comes to each place: those of the index, then those without an end, then repeats.
typedef struct arrangement {
    const glint_geometry *geometry;
    uint32_t *rest; ///< from the index's last on
    uint64_t *done; ///< a bit a place
} arrangement;

static uint32_t comes_from(const arrangement *a, uint32_t place)
{
    const glint_index *index = a->geometry->index;
    return place < index->box_count ? index->order[place] : a->rest[place - index->box_count];
}

static bool arrangement_init(arrangement *a, const glint_geometry *geometry)
{
    const uint32_t count = geometry->table.prim_count, bounded = geometry->index->box_count;
    uint32_t at = geometry->table.unbounded_count;
    *a = (arrangement) { geometry, malloc((count - bounded + 1) * sizeof *a->rest),
                         calloc(count / 64 + 1, sizeof *a->done) };
    if (!a->rest || !a->done)
        return false;
    memcpy(a->rest, geometry->unbounded, at * sizeof *a->rest);
    for (uint32_t i = 0; i < count; i++)
        if (geometry->prims[i].filter_bound == REPEATED)
            a->rest[at++] = i;
    return true;
}

/// Moves the primitives around each cycle of the arrangement: there is no room for all of them twice.
static void move_prims(arrangement *a, glint_prim *prims, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (a->done[i / 64] >> i % 64 & 1)
            continue;
        const glint_prim first = prims[i];
        uint32_t to = i;
        for (uint32_t from; (from = comes_from(a, to)) != i; to = from) {
            prims[to] = prims[from];
            a->done[to / 64] |= UINT64_C(1) << to % 64;
        }
        prims[to] = first;
        a->done[to / 64] |= UINT64_C(1) << to % 64;
    }
}

static uint32_t move_corners_of(glint_prim *prims, uint32_t count, double (*to)[3][3])
{
    uint32_t next = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!glint_prim_has_corners(&prims[i]))
            continue;
        memcpy(to[next], prims[i].corner, sizeof *to);
        prims[i].corner = to[next++];
    }
    return next;
}

/// Has the corners follow the primitives: neighbours in space are neighbours in memory. corners: room for them.
static void move_corners(glint_geometry *geometry, double (*corners)[3][3])
{
    const uint32_t first = move_corners_of(geometry->prims, geometry->table.prim_count, corners);
    move_corners_of(geometry->members, geometry->member_count, corners + first);
    free(geometry->corners);
    geometry->corners = corners;
}

/// Puts the primitives into the order of the index, those without an end last; repeats are gone.
static glint_status arrange(glint_geometry *geometry, glint_error *error)
{
    const uint32_t bounded = geometry->index->box_count;
    arrangement a;
    double(*corners)[3][3] = NULL;
    bool room = arrangement_init(&a, geometry);
    if (geometry->corners)
        room = (corners = glint_alloc_large(geometry->corner_count, sizeof *corners)) && room;
    if (geometry->shading_points && !geometry->places)
        room = (geometry->places = glint_alloc(geometry->id_count, sizeof *geometry->places)) && room;
    if (room) {
        move_prims(&a, geometry->prims, geometry->table.prim_count);
        if (corners)
            move_corners(geometry, corners);
        for (uint32_t i = 0; geometry->places && i < bounded; i++)
            geometry->places[geometry->prims[i].id] = i;
        for (uint32_t i = 0; i < geometry->table.unbounded_count; i++)
            geometry->unbounded[i] = bounded + i;
        geometry->table.prim_count = bounded + geometry->table.unbounded_count;
        if (geometry->member_count)
            memcpy(geometry->prims + geometry->table.prim_count, geometry->members,
                   geometry->member_count * sizeof *geometry->members);
        geometry->arranged = true;
    }
    free(a.rest);
    free(a.done);
    if (!room)
        free(corners);
    return room ? GLINT_OK : glint_fail_nomem(error);
}

glint_status glint_geometry_index(glint_geometry *geometry, glint_pool *pool, glint_geometry_table *table,
                                  glint_error *error)
{
    glint_index *index = geometry->index;
    pthread_mutex_lock(&index->lock);
    glint_status status = GLINT_OK;
    if (index->order && !geometry->arranged)
        status = arrange(geometry, error);
    if (!status && !index->built)
        status = index_build(geometry, pool, error);
    if (!status && !geometry->arranged)
        status = arrange(geometry, error);
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
        status = arrange(geometry, error);
    *table = geometry->table;
    table->nodes = index->bvh.nodes;
    pthread_mutex_unlock(&index->lock);
    return status;
}

/// A tree of what is neither triangle nor plane.
static glint_status build_others(glint_geometry *geometry, glint_pool *pool, glint_error *error)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < geometry->index->box_count; i++)
        count += geometry->prims[i].kind != GLINT_PRIM_TRIANGLE;
    glint_box *boxes = make_boxes(geometry, count, true);
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

// ---- The scene's ----

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
    free(geometry->places);
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
        status = glint_geometry_hull_trees(geometry, last, place_in_frame, error);
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
    return part->first_object + (part->shape->mesh ? 0 : id - part->first_prim); // a part of a combined solid has one id
}

/// Every change of a shape gives it a number that no other state of any shape has.
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
        ((glint_scene *)scene)->geometry = geometry; // a cache: invisible from outside
    }
    *out = glint_geometry_retain(scene->geometry);
    return GLINT_OK;
}
