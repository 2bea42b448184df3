/// The BVH: complete, tight, identical for any number of threads, and of good quality, for easy and hard sets of boxes.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "engine/render/geometry/bvh.h"

// ---- Allocations that fail ----

static long allocations_left = -1; ///< allocations before the next one fails; -1: no limit

static bool runs_out(void)
{
    if (allocations_left < 0)
        return false;
    return allocations_left == 0 || allocations_left-- == 0;
}

/// Replace the C library's functions in this program. The build allocates only through these three.
void *aligned_alloc(size_t alignment, size_t size)
{
    void *(*real)(size_t, size_t);
    void *symbol = dlsym(RTLD_NEXT, "aligned_alloc");
    memcpy(&real, &symbol, sizeof real);
    return runs_out() ? NULL : real(alignment, size);
}

void *realloc(void *memory, size_t size)
{
    void *(*real)(void *, size_t);
    void *symbol = dlsym(RTLD_NEXT, "realloc");
    memcpy(&real, &symbol, sizeof real);
    return runs_out() ? NULL : real(memory, size);
}

void *mmap(void *at, size_t size, int protection, int flags, int file, off_t offset)
{
    void *(*real)(void *, size_t, int, int, int, off_t);
    void *symbol = dlsym(RTLD_NEXT, "mmap");
    memcpy(&real, &symbol, sizeof real);
    return runs_out() ? MAP_FAILED : real(at, size, protection, flags, file, offset);
}

// ---- Sets of boxes ----

static uint64_t state;

static double uniform(double low, double high)
{
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(state >> 33) / 0x1p31;
}

typedef void place_box(uint32_t i, uint32_t count, double center[3], double *radius);

/// Returns the radius of spheres in the unit cube whose mean distance is about three times their radius.
static double mean_radius(uint32_t count) { return 0.3 / cbrt(count); }

static void scattered(uint32_t i, uint32_t count, double center[3], double *radius)
{
    (void)i;
    for (int axis = 0; axis < 3; axis++)
        center[axis] = uniform(0, 1);
    *radius = mean_radius(count) * uniform(0.5, 1.5);
}

static void coincident(uint32_t i, uint32_t count, double center[3], double *radius)
{
    (void)i, (void)count;
    center[0] = center[1] = center[2] = 0.1;
    *radius = 0.01;
}

static void concentric(uint32_t i, uint32_t count, double center[3], double *radius)
{
    center[0] = center[1] = center[2] = 0;
    *radius = (i + 1.0) / count;
}

static void one_giant(uint32_t i, uint32_t count, double center[3], double *radius)
{
    scattered(i, count, center, radius);
    if (i == count / 2)
        *radius = 1000;
}

static void points(uint32_t i, uint32_t count, double center[3], double *radius)
{
    scattered(i, count, center, radius);
    *radius = 0;
}

static void points_on_line(uint32_t i, uint32_t count, double center[3], double *radius)
{
    points(i, count, center, radius);
    center[0] = center[2] = 7;
}

static void denormal(uint32_t i, uint32_t count, double center[3], double *radius)
{
    scattered(i, count, center, radius);
    for (int axis = 0; axis < 3; axis++)
        center[axis] *= 1e-39;
    *radius *= 1e-39;
}

static void one_place_at_1e30(uint32_t i, uint32_t count, double center[3], double *radius)
{
    scattered(i, count, center, radius);
    for (int axis = 0; axis < 3; axis++)
        center[axis] = center[axis] + 1e30;
    *radius *= 1e30;
}

static void all_of_float(uint32_t i, uint32_t count, double center[3], double *radius)
{
    points(i, count, center, radius);
    for (int axis = 0; axis < 3; axis++)
        center[axis] = (2 * center[axis] - 1) * 0x1.fffffep127;
}

static void every_magnitude(uint32_t i, uint32_t count, double center[3], double *radius)
{
    scattered(i, count, center, radius);
    for (int axis = 0; axis < 3; axis++)
        center[axis] = exp2(250 * center[axis] - 130);
    *radius = center[0] / 100;
}

/// Coordinates of +0 and -0, which compare equal: which one a box stores must not depend on the number of threads.
static void signed_zeros(uint32_t i, uint32_t count, double center[3], double *radius)
{
    points(i, count, center, radius);
    for (int axis = 0; axis < 3; axis++)
        center[axis] = fmax(center[axis] - 0.5, 0) * (uniform(0, 1) < 0.5 ? -1 : 1);
}

static const struct boxes_kind {
    const char *name;
    place_box *place;
} kinds[] = {
    { "scattered", scattered },
    { "coincident", coincident },
    { "concentric", concentric },
    { "one giant", one_giant },
    { "points", points },
    { "points on a line", points_on_line },
    { "denormal", denormal },
    { "one place at 1e30", one_place_at_1e30 },
    { "all of float", all_of_float },
    { "every magnitude", every_magnitude },
    { "signed zeros", signed_zeros },
};
#define KINDS (sizeof kinds / sizeof *kinds)

static glint_box *make_boxes(place_box *place, uint32_t count)
{
    state = count;
    glint_box *boxes = calloc(count + 1, sizeof *boxes);
    assert_non_null(boxes);
    for (uint32_t i = 0; i < count; i++) {
        double center[3], radius;
        place(i, count, center, &radius);
        for (int axis = 0; axis < 3; axis++) {
            boxes[i].lower[axis] = (float)(center[axis] - radius);
            boxes[i].upper[axis] = (float)(center[axis] + radius);
        }
    }
    return boxes;
}

// ---- Properties of a tree ----

typedef struct walk {
    const glint_bvh *bvh;
    const glint_box *boxes;
    uint32_t count;
    uint8_t *seen; ///< how often each box occurred
    uint32_t nodes, slots;
    int depth; ///< longest path so far, in nodes
    double visits; ///< sum of the nodes' surface areas
} walk;

static double box_area(const glint_box *box)
{
    double size[3];
    for (int axis = 0; axis < 3; axis++)
        size[axis] = (double)box->upper[axis] - box->lower[axis];
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

static glint_box slot_box(const glint_node *node, int slot)
{
    glint_box box = { .unused = 0 };
    for (int axis = 0; axis < 3; axis++) {
        box.lower[axis] = node->lower[axis][slot];
        box.upper[axis] = node->upper[axis][slot];
    }
    return box;
}

static bool same_box(const glint_box *a, const glint_box *b)
{
    for (int axis = 0; axis < 3; axis++)
        if (a->lower[axis] != b->lower[axis] || a->upper[axis] != b->upper[axis])
            return false;
    return true;
}

static glint_box walk_node(walk *w, uint32_t index, int depth);

/// Checks a non-empty slot. Returns the bounds of everything below it.
static glint_box walk_slot(walk *w, uint32_t child, int depth)
{
    if (!(child & GLINT_NODE_PRIM))
        return walk_node(w, child, depth + 1);
    const uint32_t prim = child & ~GLINT_NODE_PRIM;
    assert_true(prim < w->count);
    w->seen[prim]++;
    return w->boxes[prim];
}

/// Checks a node and everything below it. Returns its bounds.
static glint_box walk_node(walk *w, uint32_t index, int depth)
{
    assert_true(index < w->bvh->node_count);
    const glint_node *node = &w->bvh->nodes[index];
    glint_box box = { .lower = { INFINITY, INFINITY, INFINITY }, .upper = { -INFINITY, -INFINITY, -INFINITY } };
    const glint_box empty = box;
    w->nodes++;
    w->depth = depth > w->depth ? depth : w->depth;
    assert_true(depth <= GLINT_BVH_DEPTH);
    for (int slot = 0; slot < GLINT_NODE_WIDTH; slot++) {
        const glint_box stored = slot_box(node, slot);
        if (same_box(&stored, &empty))
            continue;
        const glint_box below = walk_slot(w, node->child[slot], depth);
        assert_true(same_box(&stored, &below));
        for (int axis = 0; axis < 3; axis++) {
            box.lower[axis] = fminf(box.lower[axis], below.lower[axis]);
            box.upper[axis] = fmaxf(box.upper[axis], below.upper[axis]);
        }
        w->slots++;
    }
    w->visits += box_area(&box);
    return box;
}

/// Checks that each box occurs once, that each stored box is the exact bounds of its subtree, that the walk reaches
/// each node once, and that no path is too long.
static walk check_tree(const glint_bvh *bvh, const glint_box *boxes, uint32_t count)
{
    walk w = { .bvh = bvh, .boxes = boxes, .count = count, .seen = calloc(count, 1) };
    assert_non_null(w.seen);
    const glint_box root = walk_node(&w, 0, 1);
    w.visits /= box_area(&root);
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(w.seen[i], 1);
    assert_int_equal(w.nodes, bvh->node_count);
    assert_int_equal((uintptr_t)bvh->nodes % 64, 0);
    free(w.seen);
    return w;
}

/// Returns the boxes with their indices. The build sorts and frees them.
static glint_box *numbered(const glint_box *boxes, uint32_t count)
{
    glint_box *copy = glint_boxes_alloc(count);
    assert_non_null(copy);
    for (uint32_t i = 0; i < count; i++) {
        copy[i] = boxes[i];
        copy[i].item = i;
    }
    return copy;
}

static glint_bvh build(const glint_box *boxes, uint32_t count, glint_pool *pool)
{
    glint_bvh bvh;
    assert_int_equal(glint_bvh_build(numbered(boxes, count), count, pool, &bvh, NULL), GLINT_OK);
    return bvh;
}

// ---- Tests ----

static void test_no_boxes(void **unused)
{
    (void)unused;
    glint_bvh bvh = build(NULL, 0, NULL);
    assert_null(bvh.nodes);
    assert_int_equal(bvh.node_count, 0);
    glint_bvh_free(&bvh);
}

/// Up to 16 boxes fit in one node; 17 need two.
static void test_one_node(void **unused)
{
    (void)unused;
    glint_box *boxes = make_boxes(scattered, 17);
    for (uint32_t count = 1; count <= 17; count++) {
        glint_bvh bvh = build(boxes, count, NULL);
        check_tree(&bvh, boxes, count);
        assert_int_equal(bvh.node_count, count <= GLINT_NODE_WIDTH ? 1 : 2);
        glint_bvh_free(&bvh);
    }
    free(boxes);
}

/// Slots are filled in the order of the centres along the node's widest axis, starting at the first slot.
static void test_order(void **unused)
{
    (void)unused;
    const uint32_t count = 5000;
    glint_box *boxes = make_boxes(scattered, count);
    for (uint32_t i = 0; i < count; i++) {
        boxes[i].lower[1] *= 100;
        boxes[i].upper[1] *= 100;
    }
    glint_bvh bvh = build(boxes, count, NULL);
    for (uint32_t n = 0; n < bvh.node_count; n++) {
        const float *lower = bvh.nodes[n].lower[1], *upper = bvh.nodes[n].upper[1];
        for (int slot = 1; slot < GLINT_NODE_WIDTH; slot++) {
            const bool filled = lower[slot] <= upper[slot];
            assert_true(!filled || lower[slot - 1] <= upper[slot - 1]);
            assert_true(filled || bvh.nodes[n].child[slot] == 0);
            if (n == 0 && filled)
                assert_true(lower[slot - 1] + upper[slot - 1] <= lower[slot] + upper[slot]);
        }
    }
    glint_bvh_free(&bvh);
    free(boxes);
}

static void test_kinds(void **unused)
{
    (void)unused;
    static const uint32_t counts[] = { 17, 33, 300, 4097, 20000 };
    for (size_t k = 0; k < KINDS; k++)
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
            glint_box *boxes = make_boxes(kinds[k].place, counts[c]);
            glint_bvh bvh = build(boxes, counts[c], NULL);
            check_tree(&bvh, boxes, counts[c]);
            glint_bvh_free(&bvh);
            free(boxes);
        }
}

static void test_threads(void **unused)
{
    (void)unused;
    static const int threads[] = { 1, 2, 7 };
    const uint32_t count = 70000;
    for (size_t k = 0; k < KINDS; k++) {
        glint_box *boxes = make_boxes(kinds[k].place, count);
        glint_bvh want = build(boxes, count, NULL);
        check_tree(&want, boxes, count);
        for (size_t t = 0; t < sizeof threads / sizeof *threads; t++) {
            glint_pool *pool;
            assert_int_equal(glint_pool_create(threads[t], &pool, NULL), GLINT_OK);
            glint_bvh got = build(boxes, count, pool);
            if (got.node_count != want.node_count ||
                memcmp(got.nodes, want.nodes, want.node_count * sizeof *want.nodes))
                fail_msg("%s: another tree with %d threads", kinds[k].name, threads[t]);
            glint_bvh_free(&got);
            glint_pool_destroy(pool);
        }
        glint_bvh_free(&want);
        free(boxes);
    }
}

/// Returns the expected number of nodes that a random ray through the root visits, in a tree whose nodes are cubes
/// with 16^k boxes each.
static double visits_of_cubes(uint32_t count)
{
    double visits = 1;
    for (double held = GLINT_NODE_WIDTH; held < count; held *= GLINT_NODE_WIDTH) {
        const double side = cbrt(held / count) + 2 * mean_radius(count);
        visits += count / held * side * side;
    }
    return visits;
}

/// The number of nodes is close to its minimum, (count - 1) / 15 full nodes, and the number of visits close to that
/// of cubic nodes.
static void test_quality(void **unused)
{
    (void)unused;
    static const uint32_t counts[] = { 1000, 30000, 100000, 1000000 };
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        glint_box *boxes = make_boxes(scattered, counts[c]);
        glint_bvh bvh = build(boxes, counts[c], NULL);
        const walk w = check_tree(&bvh, boxes, counts[c]);
        const double fill = (double)w.slots / GLINT_NODE_WIDTH / w.nodes, cubes = visits_of_cubes(counts[c]);
        print_message("%u boxes: %u nodes, %.1f %% full, %d deep, %.2f visits (cubes: %.2f)\n", counts[c], w.nodes,
                      100 * fill, w.depth, w.visits, cubes);
        assert_true(fill > 0.7);
        assert_true(w.depth <= 7);
        assert_true(w.visits < 1.25 * cubes);
        glint_bvh_free(&bvh);
        free(boxes);
    }
}

/// A giant among small boxes is split off early: the only nodes of its size are the root and one or two below the root.
static void test_giant(void **unused)
{
    (void)unused;
    const uint32_t count = 10000;
    glint_box *boxes = make_boxes(one_giant, count);
    glint_bvh bvh = build(boxes, count, NULL);
    assert_true(check_tree(&bvh, boxes, count).visits < 3.01);
    glint_bvh_free(&bvh);
    free(boxes);
}

/// Each allocation fails in turn: the build reports the failure and leaves its output untouched.
static void test_out_of_memory(void **unused)
{
    (void)unused;
    const uint32_t count = 40000;
    glint_box *boxes = make_boxes(scattered, count);
    glint_error error;
    glint_bvh bvh = { NULL, 4711 };
    long fails = 0;
    for (;; fails++) {
        glint_box *copy = numbered(boxes, count);
        allocations_left = fails;
        const glint_status status = glint_bvh_build(copy, count, NULL, &bvh, &error);
        allocations_left = -1;
        if (status == GLINT_OK)
            break;
        assert_int_equal(status, GLINT_ERR_NOMEM);
        assert_string_equal(error.message, "out of memory");
        assert_null(bvh.nodes);
        assert_int_equal(bvh.node_count, 4711);
    }
    assert_true(fails > 5); // otherwise too few allocations were tested
    check_tree(&bvh, boxes, count);
    glint_bvh_free(&bvh);
    free(boxes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_boxes), cmocka_unit_test(test_one_node),      cmocka_unit_test(test_order),
        cmocka_unit_test(test_kinds),    cmocka_unit_test(test_threads),       cmocka_unit_test(test_quality),
        cmocka_unit_test(test_giant),    cmocka_unit_test(test_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
