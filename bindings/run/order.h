/// The order in which the frames of a sweep are rendered. Private to bindings/.
#ifndef GLINT_L_ORDER_H
#define GLINT_L_ORDER_H

#include "bindings/run/run.h"

#define GLINTL_ORDER_AXES 32 ///< at most: 16 of a sweep, and those of --sweep

typedef struct glintL_order_axis {
    int64_t count; ///< values, at least 1
    int64_t stride; ///< by how much the frame number grows from one value to the next
    int64_t middle; ///< number of the value, from 0, that it has while other axes are looked at
    bool is_forward; ///< its values come in ascending order only
    bool may_fail; ///< a value whose frame cannot be planned is ignored
    double work; ///< mean of glint_plan_work_after over its steps
    char stages[192]; ///< the stages that a step runs: "light, occlude, shade"
    char name[2 * GLINT_NAME_SIZE]; ///< "lamp.position"; "": it has none
} glintL_order_axis;

typedef struct glintL_order {
    int axis_count;
    int64_t frames;
    bool is_found; ///< else frames are rendered as they are numbered
    glintL_order_axis axes[GLINTL_ORDER_AXES];
    int by_work[GLINTL_ORDER_AXES]; ///< numbers of axes, from the one that changes most often
} glintL_order;

/// An order without axes, of one frame.
void glintL_order_init(glintL_order *order);
/// Adds an axis that changes less often than those before it, until glintL_order_find. The order has room for it.
glintL_order_axis *glintL_order_add(glintL_order *order, int64_t count);
/// Whether several axes have several values.
bool glintL_order_is_grid(const glintL_order *order);
/// Plans frame n. The caller of the callback destroys the plan. NULL: the frame cannot be planned.
typedef glint_plan *glintL_plan_frame(void *context, int64_t n);
/// Finds what the axes cost, and the order that costs least. False: a frame cannot be planned, and the order is as it was.
bool glintL_order_find(glintL_order *order, glintL_plan_frame *plan_frame, void *context);
/// The frame, from 1, that is rendered at a place, from 0.
int64_t glintL_order_frame(const glintL_order *order, int64_t place);

#endif
