#include "engine/render/geometry/bvh.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/render/geometry/bvh_split.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// A subtree becomes a task for one worker if it has at most 1 / TASK_SHARE of all boxes, and at least TASK_MIN.
#define TASK_SHARE 12
#define TASK_MIN 2048

#define RECORDS_A_NODE 12 ///< boxes per node; most trees have more

/// A growing array of nodes. A child index counts from the array's start.
typedef struct node_list {
    glint_node *nodes; ///< owned, unless `lent`
    uint32_t count, capacity;
    bool lent; ///< whether `nodes` is part of the builder's `node_block`
} node_list;

/// A subtree that one worker builds. Its first node is in the top; the others follow all earlier nodes.
typedef struct task {
    glint_record_set set;
    int depth; ///< most nodes on a path in the subtree
    uint32_t at; ///< index of the subtree's first node in the top
    uint32_t base; ///< index of the subtree's second node in the finished tree
    node_list list;
    bool failed;
} task;

typedef struct builder {
    glint_records records;
    node_list top;
    task *tasks; ///< owned
    size_t task_count, task_capacity;
    uint32_t task_max; ///< most boxes in a task; all workers together split larger sets
    glint_node *node_block; ///< owned block of nodes; the tasks' lists begin in it, and few lists outgrow it
    size_t block_bytes;
    glint_node *nodes; ///< the finished tree
} builder;

/// The contents of a node's slots. A set becomes a child node, or each of its records gets a slot of its own.
typedef struct node_plan {
    glint_record_set sets[GLINT_NODE_WIDTH];
    double area[GLINT_NODE_WIDTH];
    bool open[GLINT_NODE_WIDTH]; ///< each record gets a slot
    uint32_t count;
} node_plan;

/// A node's slots in the order of its sets.
typedef struct node_slots {
    const glint_bounds *boxes[GLINT_NODE_WIDTH];
    const glint_record_set *sets[GLINT_NODE_WIDTH]; ///< NULL: the box is a record
    uint32_t count;
} node_slots;

static void nodes_free(node_list *list)
{
    if (!list->lent)
        glint_scratch_free(list->nodes, list->capacity * sizeof *list->nodes);
    *list = (node_list) { .count = list->count };
}

/// Makes space for `count` more nodes and returns the index of the first; UINT32_MAX: out of memory.
static uint32_t nodes_add(node_list *list, uint32_t count)
{
    if (count > list->capacity - list->count) {
        const uint32_t capacity = list->capacity + list->capacity / 2 + 16;
        const size_t held = list->lent ? 0 : list->capacity * sizeof *list->nodes;
        glint_node *nodes = glint_scratch_resize(held ? list->nodes : NULL, held, (size_t)capacity * sizeof *nodes);
        if (!nodes)
            return UINT32_MAX;
        if (list->lent)
            memcpy(nodes, list->nodes, list->count * sizeof *nodes);
        *list = (node_list) { nodes, list->count, capacity, false };
    }
    list->count += count;
    return list->count - count;
}

/// Returns half the area of a box, in double, where products of floats do not overflow.
static double half_area(const glint_bounds *box)
{
    double size[3];
    for (int axis = 0; axis < 3; axis++)
        size[axis] = (double)box->upper[axis] - box->lower[axis];
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

/// Returns the number of nodes on the longest path if `count` boxes are split into halves by number.
static int least_depth(uint32_t count)
{
    int depth = 1;
    for (uint64_t held = GLINT_NODE_WIDTH; held < count; held *= GLINT_NODE_WIDTH)
        depth++;
    return depth;
}

/// Returns the set to split next: the one with the largest area or, if split by number, with the most boxes;
/// plan->count if each set fits into one node.
static uint32_t pick_set(const node_plan *plan, bool by_number)
{
    uint32_t best = plan->count;
    for (uint32_t i = 0; i < plan->count; i++) {
        if (plan->sets[i].count <= GLINT_NODE_WIDTH)
            continue;
        const bool same = best < plan->count && (by_number || plan->area[i] == plan->area[best]);
        if (best == plan->count ||
            (same ? plan->sets[i].count > plan->sets[best].count : plan->area[i] > plan->area[best]))
            best = i;
    }
    return best;
}

/// Splits until every slot is taken or every set fits into a node. depth: most nodes on a path from here on.
static void plan_sets(const builder *b, const glint_record_set *set, int depth, bool shared, node_plan *plan)
{
    const bool by_number = least_depth(set->count) >= depth;
    plan->sets[0] = *set;
    plan->area[0] = half_area(&set->box);
    plan->count = 1;
    uint32_t i;
    while (plan->count < GLINT_NODE_WIDTH && (i = pick_set(plan, by_number)) < plan->count) {
        glint_record_set *above = &plan->sets[plan->count];
        if (by_number)
            glint_records_halve(&b->records, &plan->sets[i], above);
        else
            glint_records_split(&b->records, &plan->sets[i], above, shared);
        plan->area[i] = half_area(&plan->sets[i].box);
        plan->area[plan->count] = half_area(&above->box);
        plan->count++;
    }
}

/// Gives free slots to the records of small sets, the largest sets first. Such sets need no node.
static void plan_open(node_plan *plan)
{
    uint32_t free_slots = GLINT_NODE_WIDTH - plan->count;
    for (uint32_t i = 0; i < plan->count; i++)
        plan->open[i] = plan->sets[i].count == 1;
    for (;;) {
        uint32_t best = plan->count;
        for (uint32_t i = 0; i < plan->count; i++)
            if (!plan->open[i] && plan->sets[i].count - 1 <= free_slots &&
                (best == plan->count || plan->area[i] > plan->area[best]))
                best = i;
        if (best == plan->count)
            return;
        plan->open[best] = true;
        free_slots -= plan->sets[best].count - 1;
    }
}

static int widest_axis(const glint_bounds *box)
{
    int widest = 0;
    for (int axis = 1; axis < 3; axis++)
        if ((double)box->upper[axis] - box->lower[axis] > (double)box->upper[widest] - box->lower[widest])
            widest = axis;
    return widest;
}

/// Fills the slots and returns how many of them are sets.
static uint32_t plan_slots(const builder *b, const node_plan *plan, node_slots *slots)
{
    uint32_t count = 0, sets = 0;
    for (uint32_t i = 0; i < plan->count; i++) {
        const glint_record *records = glint_records_of(&b->records, &plan->sets[i]);
        for (uint32_t k = 0; plan->open[i] && k < plan->sets[i].count; k++) {
            slots->boxes[count] = &records[k];
            slots->sets[count++] = NULL;
        }
        if (!plan->open[i]) {
            slots->boxes[count] = &plan->sets[i].box;
            slots->sets[count++] = &plan->sets[i];
            sets++;
        }
    }
    slots->count = count;
    return sets;
}

/// Ranks the slots by their centres along an axis; slots with equal centres keep their order.
static void rank_slots(const node_slots *slots, int axis, uint32_t ranks[GLINT_NODE_WIDTH])
{
    typedef int32_t int4 __attribute__((vector_size(16)));
    glint_float4 positions[GLINT_NODE_WIDTH / 4];
    for (uint32_t i = 0; i < GLINT_NODE_WIDTH; i++)
        positions[i / 4][i % 4] =
            i < slots->count ? slots->boxes[i]->lower[axis] * 0.5f + slots->boxes[i]->upper[axis] * 0.5f : INFINITY;
    for (uint32_t i = 0; i < slots->count; i++) {
        const float position = positions[i / 4][i % 4];
        int4 before = { 0 };
        for (int32_t k = 0; k < GLINT_NODE_WIDTH / 4; k++) {
            const int4 index = (int4) { 0, 1, 2, 3 } + 4 * k;
            before -= (positions[k] < position) | ((positions[k] == position) & (index < (int32_t)i));
        }
        ranks[i] = (uint32_t)(before[0] + before[1] + before[2] + before[3]);
    }
}

static uint32_t record_item(const glint_record *record)
{
    uint32_t item;
    memcpy(&item, (const char *)&record->lower + 3 * sizeof(float), sizeof item);
    return item;
}

static void fill_node(glint_node *node, const node_slots *slots, int axis, uint32_t child)
{
    uint32_t ranks[GLINT_NODE_WIDTH];
    rank_slots(slots, axis, ranks);
    for (uint32_t i = 0; i < slots->count; i++) {
        const glint_bounds *box = slots->boxes[i];
        for (int k = 0; k < 3; k++) {
            node->lower[k][ranks[i]] = box->lower[k];
            node->upper[k][ranks[i]] = box->upper[k];
        }
        node->child[ranks[i]] = slots->sets[i] ? child++ : GLINT_NODE_PRIM | record_item(box);
    }
    for (uint32_t i = slots->count; i < GLINT_NODE_WIDTH; i++) {
        for (int k = 0; k < 3; k++) {
            node->lower[k][i] = INFINITY;
            node->upper[k][i] = -INFINITY;
        }
        node->child[i] = 0;
    }
}

static bool add_task(builder *b, const glint_record_set *set, int depth, uint32_t at)
{
    if (b->task_count == b->task_capacity) {
        const size_t capacity = 2 * b->task_capacity + 16;
        task *tasks = realloc(b->tasks, capacity * sizeof *tasks);
        if (!tasks)
            return false;
        b->tasks = tasks;
        b->task_capacity = capacity;
    }
    b->tasks[b->task_count++] = (task) { .set = *set, .depth = depth, .at = at };
    return true;
}

/// Builds the node of `set` at list->nodes[at] and all nodes below it. In the top, subtrees of a suitable size become
/// tasks. False: out of memory.
static bool build_node(builder *b, node_list *list, uint32_t at, const glint_record_set *set, int depth)
{
    const bool top = list == &b->top;
    node_plan plan;
    node_slots slots;
    plan_sets(b, set, depth, top, &plan);
    plan_open(&plan);
    const uint32_t children = plan_slots(b, &plan, &slots);
    uint32_t child = nodes_add(list, children);
    if (child == UINT32_MAX)
        return false;
    fill_node(&list->nodes[at], &slots, widest_axis(&set->box), child);
    for (uint32_t i = 0; i < slots.count; i++) {
        const glint_record_set *below = slots.sets[i];
        if (!below)
            continue;
        const bool is_task = top && below->count >= TASK_MIN && below->count <= b->task_max;
        if (!(is_task ? add_task(b, below, depth - 1, child) : build_node(b, list, child, below, depth - 1)))
            return false;
        child++;
    }
    return true;
}

static void build_task(void *context, size_t index, int worker)
{
    (void)worker;
    builder *b = context;
    task *t = &b->tasks[index];
    t->failed = nodes_add(&t->list, 1) == UINT32_MAX || !build_node(b, &t->list, 0, &t->set, t->depth);
    glint_records_drop(&b->records, &t->set);
}

/// Copies a task's nodes to their final position.
static void join_task(void *context, size_t index, int worker)
{
    (void)worker;
    builder *b = context;
    task *t = &b->tasks[index];
    for (uint32_t i = 0; i < t->list.count; i++) {
        glint_node *node = i ? &b->nodes[t->base + i - 1] : &b->nodes[t->at];
        *node = t->list.nodes[i];
        for (int k = 0; k < GLINT_NODE_WIDTH; k++)
            if (node->child[k] && !(node->child[k] & GLINT_NODE_PRIM))
                node->child[k] += t->base - 1;
    }
    nodes_free(&t->list);
}

static uint32_t nodes_of(const task *t) { return t->set.count / RECORDS_A_NODE + GLINT_NODE_WIDTH; }

/// Lends each task the nodes that it will probably need, from one block of memory with large pages.
static bool ensure_capacity(builder *b)
{
    size_t total = 0, next = 0;
    for (size_t i = 0; i < b->task_count; i++)
        total += nodes_of(&b->tasks[i]);
    b->node_block = glint_scratch_resize(NULL, 0, total * sizeof *b->node_block);
    if (!b->node_block)
        return false;
    b->block_bytes = total * sizeof *b->node_block;
    for (size_t i = 0; i < b->task_count; i++) {
        const uint32_t count = nodes_of(&b->tasks[i]);
        b->tasks[i].list = (node_list) { b->node_block + next, 0, count, true };
        next += count;
    }
    return true;
}

static bool build_lists(builder *b, const glint_record_set *root)
{
    if (nodes_add(&b->top, 1) == UINT32_MAX || !build_node(b, &b->top, 0, root, GLINT_BVH_DEPTH) || !ensure_capacity(b))
        return false;
    glint_run_items(b->records.pool, b->task_count, build_task, b);
    for (size_t i = 0; i < b->task_count; i++)
        if (b->tasks[i].failed)
            return false;
    return true;
}

/// Joins the top and the remaining nodes of each task in order. Frees the records first, because they are not needed
/// any more.
static bool join(builder *b, glint_bvh *out)
{
    uint32_t count = b->top.count;
    glint_records_free(&b->records);
    for (size_t i = 0; i < b->task_count; i++) {
        b->tasks[i].base = count;
        count += b->tasks[i].list.count - 1;
    }
    b->nodes = glint_alloc_large(count, sizeof *b->nodes);
    if (!b->nodes)
        return false;
    memcpy(b->nodes, b->top.nodes, b->top.count * sizeof *b->nodes);
    glint_run_items(b->records.pool, b->task_count, join_task, b);
    *out = (glint_bvh) { b->nodes, count };
    return true;
}

static void builder_free(builder *b)
{
    glint_records_free(&b->records);
    for (size_t i = 0; i < b->task_count; i++)
        nodes_free(&b->tasks[i].list);
    free(b->tasks);
    nodes_free(&b->top);
    glint_scratch_free(b->node_block, b->block_bytes);
}

glint_box *glint_boxes_alloc(uint32_t count)
{
    return glint_scratch_resize(NULL, 0, count * sizeof(glint_box));
}

void glint_boxes_free(glint_box *boxes, uint32_t count) { glint_scratch_free(boxes, count * sizeof *boxes); }

glint_status glint_bvh_build(glint_box *boxes, uint32_t count, glint_pool *pool, glint_bvh *out,
                             glint_error *error)
{
    if (count == 0) {
        glint_boxes_free(boxes, count);
        *out = (glint_bvh) { 0 };
        return GLINT_OK;
    }
    builder b = { .task_max = count / TASK_SHARE };
    glint_record_set root;
    const bool built =
        glint_records_init(&b.records, boxes, count, pool, &root) && build_lists(&b, &root) && join(&b, out);
    builder_free(&b);
    return built ? GLINT_OK : glint_fail_nomem(error);
}

void glint_bvh_free(glint_bvh *bvh)
{
    free(bvh->nodes);
    *bvh = (glint_bvh) { 0 };
}
