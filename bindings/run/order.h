/// The order in which the frames of a sweep are rendered. Private to bindings/.
#ifndef GLINT_L_ORDER_H
#define GLINT_L_ORDER_H

#include "bindings/run/run.h"

#define GLINTL_ORDER_AXES 32 ///< 16 axes of a sweep, and those of --sweep

typedef struct glintL_order_axis {
    int64_t count; ///< number of values, at least 1
    int64_t stride; ///< difference in frame number between consecutive values
    int64_t middle; ///< index of the value, from 0, used while other axes are compared
    bool is_forward; ///< the values are rendered only in ascending order
    bool may_fail; ///< a value whose frame cannot be planned is ignored
    double work; ///< mean of glint_plan_work_after over its steps
    char stages[192]; ///< the stages that a step runs: "light, occlude, shade"
    char name[2 * GLINT_NAME_SIZE]; ///< "lamp.position"; "": no name
} glintL_order_axis;

typedef struct glintL_order {
    int axis_count;
    int64_t frames;
    bool is_found; ///< otherwise frames are rendered in the order of their numbers
    glintL_order_axis axes[GLINTL_ORDER_AXES];
    int by_work[GLINTL_ORDER_AXES]; ///< indices of the axes, fastest first
} glintL_order;

/// Makes an order with one frame and no axes.
void glintL_order_init(glintL_order *order);
/// Adds an axis. Until glintL_order_find is called, it changes more slowly than the axes added before it. The caller
/// makes sure that there is space.
glintL_order_axis *glintL_order_add(glintL_order *order, int64_t count);
/// Returns whether several axes have several values.
bool glintL_order_is_grid(const glintL_order *order);
/// A callback that plans frame n. The caller destroys the plan. NULL: the frame cannot be planned.
typedef glint_plan *glintL_plan_frame(void *context, int64_t n);
/// Compares the costs of the axes and finds the cheapest order. False: a frame cannot be planned, and the order is
/// unchanged.
bool glintL_order_find(glintL_order *order, glintL_plan_frame *plan_frame, void *context);
/// Returns the frame, from 1, that is rendered at a position, from 0.
int64_t glintL_order_frame(const glintL_order *order, int64_t position);

#endif
