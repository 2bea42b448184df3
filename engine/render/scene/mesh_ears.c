/// Cuts ears off a polygon: corners for which no other corner lies in the triangle with both neighbours. The first
/// ear in the polygon's order is always cut. A corner that is not an ear remembers a corner that blocks it, and is
/// tested again when the blocking corner or a neighbour has been cut off. A tree over the corners finds the blocking
/// corners.
#include "engine/render/scene/mesh_ears.h"

#include "engine/base/status.h"
#include "engine/base/vec.h"

#include <stdlib.h>

#define NONE 0xffffffffu
#define LEAF_SIZE 64 ///< corners of a leaf
#define DEPTH_MAX 40

/// The corners form a ring. The corners that one corner blocks form a list.
typedef struct corner {
    double at[2]; ///< position in the polygon's plane, about -1 .. 1
    uint32_t previous, next;
    uint32_t blocker; ///< the corner that blocks this corner; NONE: none
    uint32_t first_blocked, list_previous, list_next;
    uint32_t leaf; ///< the leaf of the tree that contains this corner
    bool is_there, is_ear, is_queued;
} corner;

/// A node of the tree has a range of `order`; the children of node k are 2 k + 1 and 2 k + 2.
typedef struct node {
    double low[2], high[2];
    uint32_t first, count, remaining; ///< range of `order`; number of its corners that are not cut off yet
    bool is_leaf;
} node;

typedef struct cutting {
    glint_ears *ears;
    const glint_polygon *polygon;
    uint32_t heap_count;
} cutting;

void glint_ears_free(glint_ears *ears)
{
    free(ears->corners);
    free(ears->nodes);
    free(ears->order);
    free(ears->heap);
    free(ears->triangles);
}

static glint_status reserve(glint_ears *ears, size_t count, glint_error *error)
{
    if (count <= ears->capacity)
        return GLINT_OK;
    glint_ears_free(ears);
    *ears = (glint_ears) { 0 };
    size_t nodes = 1;
    while (nodes * LEAF_SIZE < count)
        nodes *= 2;
    ears->corners = malloc(count * sizeof *ears->corners);
    ears->nodes = malloc(2 * nodes * sizeof *ears->nodes);
    ears->order = malloc(count * sizeof *ears->order);
    ears->heap = malloc(count * sizeof *ears->heap);
    ears->triangles = malloc(count * sizeof *ears->triangles);
    ears->capacity = count;
    if (ears->corners && ears->nodes && ears->order && ears->heap && ears->triangles)
        return GLINT_OK;
    glint_ears_free(ears);
    *ears = (glint_ears) { 0 };
    return glint_fail_nomem(error);
}

static const double *position(const glint_polygon *polygon, uint32_t i)
{
    return polygon->vertices + 3 * (size_t)polygon->corners[i];
}

void glint_polygon_cross(const glint_polygon *polygon, uint32_t i, uint32_t j, uint32_t k, double out[3])
{
    double f[3], g[3];
    vec_sub(f, position(polygon, j), position(polygon, i));
    vec_sub(g, position(polygon, k), position(polygon, i));
    const double largest = fmax(vec_max_abs(f), vec_max_abs(g));
    const double scale = largest > 0 ? power_of_two_scale(largest) : 1;
    vec_scale(f, f, scale);
    vec_scale(g, g, scale);
    vec_cross(out, f, g);
}

// ---- The tree ----

/// Projects the corners to the polygon's plane.
static void flatten(const cutting *c)
{
    const glint_polygon *polygon = c->polygon;
    double normal[3], axes[2][3], away[3] = { 0 }, f[3], largest = 0;
    vec_normalize(normal, polygon->normal);
    away[fabs(normal[0]) < 0.6 ? 0 : 1] = 1;
    vec_cross(f, normal, away);
    vec_normalize(axes[0], f);
    vec_cross(axes[1], normal, axes[0]);
    for (uint32_t i = 0; i < polygon->size; i++) {
        vec_sub(f, position(polygon, i), position(polygon, 0));
        largest = fmax(largest, vec_max_abs(f));
    }
    const double scale = power_of_two_scale(largest);
    for (uint32_t i = 0; i < polygon->size; i++) {
        vec_sub(f, position(polygon, i), position(polygon, 0));
        vec_scale(f, f, scale);
        for (int axis = 0; axis < 2; axis++)
            c->ears->corners[i].at[axis] = vec_dot(f, axes[axis]);
    }
}

/// Moves the n-th smallest element of a range of `order`, along an axis, to its sorted position. No element before it
/// is larger.
static void select_nth(const corner *corners, uint32_t *order, uint32_t count, uint32_t n, int axis)
{
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        // pseudo-random, so that no order of corners is a worst case
        const uint32_t any = low + (low * 2654435761u + high * 40503u) % (high - low);
        const double pivot = corners[order[any]].at[axis];
        uint32_t i = low, j = high;
        for (;; i++, j--) {
            while (corners[order[i]].at[axis] < pivot)
                i++;
            while (corners[order[j]].at[axis] > pivot)
                j--;
            if (i >= j)
                break;
            const uint32_t swapped = order[i];
            order[i] = order[j];
            order[j] = swapped;
        }
        if (n <= j)
            high = j;
        else
            low = j + 1;
    }
}

static void bound(const cutting *c, node *made)
{
    for (uint32_t i = 0; i < made->count; i++) {
        const double *at = c->ears->corners[c->ears->order[made->first + i]].at;
        for (int axis = 0; axis < 2; axis++) {
            made->low[axis] = i ? fmin(made->low[axis], at[axis]) : at[axis];
            made->high[axis] = i ? fmax(made->high[axis], at[axis]) : at[axis];
        }
    }
}

/// Builds node `k` over a range of `order`, and its subtree of `leaves` leaves, a power of two.
static void build(const cutting *c, uint32_t k, uint32_t first, uint32_t count, uint32_t leaves)
{
    glint_ears *ears = c->ears;
    node *made = &ears->nodes[k];
    *made = (node) { .first = first, .count = count, .remaining = count, .is_leaf = leaves == 1 };
    bound(c, made);
    if (made->is_leaf) {
        for (uint32_t i = 0; i < count; i++)
            ears->corners[ears->order[first + i]].leaf = k;
        return;
    }
    const int axis = made->high[0] - made->low[0] < made->high[1] - made->low[1];
    const uint32_t half = count / 2;
    select_nth(ears->corners, ears->order + first, count, half, axis);
    build(c, 2 * k + 1, first, half, leaves / 2);
    build(c, 2 * k + 2, first + half, count - half, leaves / 2);
}

/// Returns whether no corner of a node can lie in a triangle, apart from rounding.
static bool is_apart(const node *at, const corner *const triangle[3])
{
    const double slack = 1e-12;
    for (int axis = 0; axis < 2; axis++) {
        double low = triangle[0]->at[axis], high = low;
        for (int i = 1; i < 3; i++) {
            low = fmin(low, triangle[i]->at[axis]);
            high = fmax(high, triangle[i]->at[axis]);
        }
        if (at->low[axis] > high + slack || at->high[axis] < low - slack)
            return true;
    }
    for (int i = 0; i < 3; i++) {
        const double *a = triangle[i]->at, *b = triangle[(i + 1) % 3]->at;
        const double side[2] = { b[0] - a[0], b[1] - a[1] };
        const double x = side[1] < 0 ? at->high[0] : at->low[0], y = side[0] < 0 ? at->low[1] : at->high[1];
        if (side[0] * (y - a[1]) - side[1] * (x - a[0]) < -slack)
            return true;
    }
    return false;
}

// ---- Ears ----

/// Returns whether corner p is in the triangle of i, j and k or on its sides, as seen along the polygon's normal.
static bool covers(const glint_polygon *polygon, uint32_t i, uint32_t j, uint32_t k, uint32_t p)
{
    double cross[3];
    const uint32_t at[4] = { i, j, k, i };
    for (int side = 0; side < 3; side++) {
        glint_polygon_cross(polygon, at[side], at[side + 1], p, cross);
        if (vec_dot(cross, polygon->normal) < 0)
            return false;
    }
    return true;
}

/// Returns a corner of a leaf that is in the triangle; NONE: there is none.
static uint32_t find_in_leaf(const cutting *c, const node *leaf, uint32_t i, uint32_t j, uint32_t k)
{
    const uint32_t *v = c->polygon->corners;
    for (uint32_t m = 0; m < leaf->count; m++) {
        const uint32_t p = c->ears->order[leaf->first + m];
        if (c->ears->corners[p].is_there && v[p] != v[i] && v[p] != v[j] && v[p] != v[k] &&
            covers(c->polygon, i, j, k, p))
            return p;
    }
    return NONE;
}

/// Returns a corner that is in the triangle of i, j and k; NONE: there is none.
static uint32_t find_blocker(const cutting *c, uint32_t i, uint32_t j, uint32_t k)
{
    uint32_t stack[DEPTH_MAX], height = 0;
    const corner *corners = c->ears->corners, *const triangle[3] = { &corners[i], &corners[j], &corners[k] };
    stack[height++] = 0;
    while (height) {
        const uint32_t number = stack[--height];
        const node *at = &c->ears->nodes[number];
        if (!at->remaining || (number && is_apart(at, triangle)))
            continue;
        if (!at->is_leaf) {
            stack[height++] = 2 * number + 2;
            stack[height++] = 2 * number + 1;
            continue;
        }
        const uint32_t found = find_in_leaf(c, at, i, j, k);
        if (found != NONE)
            return found;
    }
    return NONE;
}

static void push(cutting *c, uint32_t i)
{
    uint32_t *heap = c->ears->heap, at = c->heap_count++;
    for (; at && heap[(at - 1) / 2] > i; at = (at - 1) / 2)
        heap[at] = heap[(at - 1) / 2];
    heap[at] = i;
}

static uint32_t pop(cutting *c)
{
    uint32_t *heap = c->ears->heap, at = 0, child;
    const uint32_t top = heap[0], last = heap[--c->heap_count];
    for (; (child = 2 * at + 1) < c->heap_count; at = child) {
        child += child + 1 < c->heap_count && heap[child + 1] < heap[child];
        if (heap[child] >= last)
            break;
        heap[at] = heap[child];
    }
    heap[at] = last;
    return top;
}

static void set_blocker(cutting *c, uint32_t i, uint32_t blocker)
{
    corner *corners = c->ears->corners, *at = &corners[i];
    if (at->blocker != NONE) {
        *(at->list_previous == NONE ? &corners[at->blocker].first_blocked : &corners[at->list_previous].list_next) =
            at->list_next;
        if (at->list_next != NONE)
            corners[at->list_next].list_previous = at->list_previous;
    }
    at->blocker = blocker;
    at->list_previous = NONE;
    if (blocker == NONE)
        return;
    at->list_next = corners[blocker].first_blocked;
    if (at->list_next != NONE)
        corners[at->list_next].list_previous = i;
    corners[blocker].first_blocked = i;
}

/// Determines whether a corner can be cut off.
static void look_at(cutting *c, uint32_t i)
{
    corner *at = &c->ears->corners[i];
    double cross[3];
    uint32_t blocker = NONE;
    glint_polygon_cross(c->polygon, at->previous, i, at->next, cross);
    at->is_ear = !(vec_dot(cross, c->polygon->normal) < 0);
    // a corner whose triangle has no area can always be cut off
    if (at->is_ear && (cross[0] != 0 || cross[1] != 0 || cross[2] != 0))
        blocker = find_blocker(c, at->previous, i, at->next);
    set_blocker(c, i, blocker);
    at->is_ear = at->is_ear && blocker == NONE;
    if (at->is_ear && !at->is_queued)
        push(c, i);
    at->is_queued = at->is_queued || at->is_ear;
}

static void cut_off(cutting *c, uint32_t i)
{
    glint_ears *ears = c->ears;
    corner *corners = ears->corners, *at = &corners[i];
    double cross[3];
    glint_polygon_cross(c->polygon, at->previous, i, at->next, cross);
    if (cross[0] != 0 || cross[1] != 0 || cross[2] != 0) {
        uint32_t *triangle = ears->triangles[ears->triangle_count++];
        triangle[0] = at->previous;
        triangle[1] = i;
        triangle[2] = at->next;
    }
    at->is_there = false;
    corners[at->previous].next = at->next;
    corners[at->next].previous = at->previous;
    for (uint32_t k = at->leaf;; k = (k - 1) / 2) {
        ears->nodes[k].remaining--;
        if (!k)
            break;
    }
    look_at(c, at->previous);
    look_at(c, at->next);
    while (at->first_blocked != NONE)
        look_at(c, at->first_blocked);
}

glint_status glint_ears_cut(glint_ears *ears, const glint_polygon *polygon, bool *whole, glint_error *error)
{
    const uint32_t count = polygon->size;
    cutting c = { .ears = ears, .polygon = polygon };
    uint32_t leaves = 1, remaining = count;
    glint_status status = reserve(ears, count, error);
    if (status)
        return status;
    ears->triangle_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        ears->corners[i] = (corner) { .previous = i ? i - 1 : count - 1,
                                      .next = i + 1 < count ? i + 1 : 0,
                                      .blocker = NONE,
                                      .first_blocked = NONE,
                                      .list_previous = NONE,
                                      .list_next = NONE,
                                      .is_there = true };
        ears->order[i] = i;
    }
    while ((size_t)leaves * LEAF_SIZE < count)
        leaves *= 2;
    flatten(&c);
    build(&c, 0, 0, count, leaves);
    for (uint32_t i = 0; i < count; i++)
        look_at(&c, i);
    while (remaining > 2 && c.heap_count) {
        const uint32_t i = pop(&c);
        ears->corners[i].is_queued = false;
        if (!ears->corners[i].is_ear)
            continue;
        ears->corners[i].is_ear = false;
        cut_off(&c, i);
        remaining--;
    }
    *whole = remaining <= 2;
    return GLINT_OK;
}
