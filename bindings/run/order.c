// The order in which a sweep's frames are rendered. The axis with the cheapest step changes fastest, and consecutive
// frames differ by one step on one axis. The numbers and files of frames do not depend on the order.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/order.h"

#define PROBES_MAX 4 // values of an axis whose plans are compared

// Sorts the axes by the cost of a step, the cheapest first: it changes fastest.
static void sort_axes(glintL_order *order)
{
    order->is_found = true;
    for (int i = 0; i < order->axis_count; i++) {
        int at = i;
        for (; at > 0 && order->axes[order->by_work[at - 1]].work > order->axes[i].work; at--)
            order->by_work[at] = order->by_work[at - 1];
        order->by_work[at] = i;
    }
}

void glintL_order_init(glintL_order *order)
{
    order->axis_count = 0;
    order->frames = 1;
    order->is_found = false;
}

glintL_order_axis *glintL_order_add(glintL_order *order, int64_t count)
{
    glintL_order_axis *axis = &order->axes[order->axis_count];
    *axis = (glintL_order_axis) { .count = count, .stride = order->frames, .middle = count / 2 };
    order->by_work[order->axis_count] = order->axis_count;
    order->axis_count++;
    order->frames *= count;
    return axis;
}

bool glintL_order_is_grid(const glintL_order *order)
{
    int several = 0;
    for (int i = 0; i < order->axis_count; i++)
        several += order->axes[i].count > 1;
    return several > 1;
}

int64_t glintL_order_frame(const glintL_order *order, int64_t position)
{
    if (!order->is_found)
        return position + 1;
    int64_t n = 1, below = order->frames; // below: frames of the digits not yet read, from the slowest
    bool back = false; // the slower digits form an odd number, so this digit runs backwards
    for (int i = order->axis_count - 1; i >= 0; i--) {
        const glintL_order_axis *axis = &order->axes[order->by_work[i]];
        below /= axis->count;
        const int64_t digit = position / below,
                      step = back && !axis->is_forward ? axis->count - 1 - digit % axis->count : digit % axis->count;
        n += step * axis->stride;
        back = digit % 2 != 0;
    }
    return n;
}

// ---- The cost of each axis ----

static bool has_word(const char *list, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = strstr(list, word); at; at = strstr(at + 1, word))
        if ((at == list || at[-1] == ' ') && (at[length] == '\0' || at[length] == ','))
            return true;
    return false;
}

static void add_stage(glintL_order_axis *axis, const char *name)
{
    size_t used = strlen(axis->stages);
    if (!has_word(axis->stages, name))
        snprintf(axis->stages + used, sizeof axis->stages - used, "%s%s", used ? ", " : "", name);
}

// Adds the stages of a step. Every step ends with `resolve` and `tone`, which are named only if no other stage runs.
static void add_stages(glintL_order_axis *axis, const glint_plan *plan, uint64_t runs)
{
    const glint_stage_info *stages;
    const size_t count = glint_plan_stages(plan, &stages);
    for (size_t i = 0; i < count; i++)
        if (runs >> i & 1 && strcmp(stages[i].name, "resolve") != 0 && strcmp(stages[i].name, "tone") != 0)
            add_stage(axis, stages[i].name);
    for (size_t i = 0; i < count && !axis->stages[0]; i++)
        if (runs >> i & 1)
            add_stage(axis, stages[i].name);
}

// Compares plans of the axis's first values, with all other axes as in frame `middle`. False: a frame cannot be
// planned.
static bool probe_axis(glintL_order_axis *axis, int64_t middle, glintL_plan_frame *plan_frame, void *context)
{
    const int64_t count = axis->count < PROBES_MAX ? axis->count : PROBES_MAX, first = middle - axis->middle * axis->stride;
    glint_plan *last = NULL;
    bool good = true;
    for (int64_t i = 0; i < count && count > 1 && good; i++) {
        uint64_t runs = 0;
        glint_plan *next = plan_frame(context, first + i * axis->stride);
        good = next || axis->may_fail;
        if (next && last) {
            axis->work += glint_plan_work_after(next, last, &runs) / (double)(count - 1);
            add_stages(axis, next, runs);
        }
        if (!next)
            continue;
        glint_plan_destroy(last);
        last = next;
    }
    glint_plan_destroy(last);
    return good;
}

bool glintL_order_find(glintL_order *order, glintL_plan_frame *plan_frame, void *context)
{
    int64_t middle = 1;
    bool good = true;
    for (int i = 0; i < order->axis_count; i++) // an axis may have no effect at another's ends
        middle += order->axes[i].middle * order->axes[i].stride;
    for (int i = 0; i < order->axis_count && good; i++)
        good = probe_axis(&order->axes[i], middle, plan_frame, context);
    if (good)
        sort_axes(order);
    return good;
}
