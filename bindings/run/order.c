// The order in which a sweep's frames are rendered: the axis whose step costs least changes most often, and each frame
// differs from the one before by one step on one axis. Numbers and files of frames do not depend on it.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/order.h"

#define PROBES_MAX 4 // values of an axis whose plans are compared

// The axis of each digit, from the one that changes most often.
static void sort_axes(glintL_order *order)
{
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
}

glintL_order_axis *glintL_order_add(glintL_order *order, int64_t count)
{
    glintL_order_axis *axis = &order->axes[order->axis_count];
    *axis = (glintL_order_axis) { .count = count, .stride = order->frames };
    order->by_work[order->axis_count] = order->axis_count;
    order->axis_count++;
    order->frames *= count;
    return axis;
}

int64_t glintL_order_frame(const glintL_order *order, int64_t place)
{
    int64_t n = 1, below = order->frames; // below: frames of the digits not yet read, from the slowest
    bool back = false; // the number that the slower digits are is odd
    for (int i = order->axis_count - 1; i >= 0; i--) {
        const glintL_order_axis *axis = &order->axes[order->by_work[i]];
        below /= axis->count;
        const int64_t digit = place / below, step = back ? axis->count - 1 - digit % axis->count : digit % axis->count;
        n += step * axis->stride;
        back = digit % 2 != 0;
    }
    return n;
}

// ---- What each axis costs ----

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

// Adds the stages of a step. Every step ends with `resolve` and `tone`: they are named where nothing else runs.
static void add_stages(glintL_order_axis *axis, const glint_plan *plan, uint32_t runs)
{
    const glint_stage_info *stages;
    const size_t count = glint_plan_stages(plan, &stages);
    for (size_t i = 0; i < count && i < 32; i++)
        if (runs >> i & 1 && strcmp(stages[i].name, "resolve") != 0 && strcmp(stages[i].name, "tone") != 0)
            add_stage(axis, stages[i].name);
    for (size_t i = 0; i < count && i < 32 && !axis->stages[0]; i++)
        if (runs >> i & 1)
            add_stage(axis, stages[i].name);
}

// Compares the first values of an axis, at the first values of all others. False: a frame cannot be planned.
static bool probe_axis(glintL_order_axis *axis, const glint_plan *first, glintL_plan_frame *plan_frame, void *context)
{
    const int64_t steps = axis->count < PROBES_MAX ? axis->count - 1 : PROBES_MAX - 1;
    glint_plan *last = NULL;
    bool good = true;
    for (int64_t step = 1; step <= steps && good; step++) {
        uint32_t runs = 0;
        glint_plan *next = plan_frame(context, 1 + step * axis->stride);
        good = next != NULL;
        if (good) {
            axis->work += glint_plan_work_after(next, last ? last : first, &runs) / (double)steps;
            add_stages(axis, next, runs);
        }
        glint_plan_destroy(last);
        last = next;
    }
    glint_plan_destroy(last);
    return good;
}

bool glintL_order_find(glintL_order *order, glintL_plan_frame *plan_frame, void *context)
{
    glint_plan *first = plan_frame(context, 1);
    bool good = first != NULL;
    for (int i = 0; i < order->axis_count && good; i++)
        good = probe_axis(&order->axes[i], first, plan_frame, context);
    glint_plan_destroy(first);
    if (good)
        sort_axes(order);
    return good;
}
