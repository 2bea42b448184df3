/// Combined solids as sets: bounding boxes, and whether a point is inside.
#include "engine/base/vec.h"
#include "engine/render/geometry/geometry.h"

typedef struct corners {
    double lower[3], upper[3];
} corners;

/// Bounds a half-space, which is bounded on one side if its plane is perpendicular to an axis.
static corners box_behind(const glint_prim *plane)
{
    corners box = { { 0 }, { 0 } };
    const int axis = glint_axis_along(plane->normal);
    for (int c = 0; c < 3; c++) {
        const double at = plane->center[c], loose = 0x1p-50 * fabs(at);
        box.lower[c] = c == axis && plane->normal[c] < 0 ? at - loose : -HUGE_VAL;
        box.upper[c] = c == axis && plane->normal[c] > 0 ? at + loose : HUGE_VAL;
    }
    return box;
}

/// Bounds a solid, with a margin for its inverse and rounding.
static corners box_around(const glint_geometry *geometry, const glint_prim *part)
{
    corners box = { { 0 }, { 0 } };
    if (part->kind == GLINT_PRIM_PLANE)
        return box_behind(part);
    glint_prim_bounds(geometry->solids, part, box.lower, box.upper);
    for (int c = 0; c < 3; c++) {
        const double half = 0.5 * box.upper[c] - 0.5 * box.lower[c];
        const double loose = 0x1p-30 * half + 0x1p-50 * fmax(fabs(box.lower[c]), fabs(box.upper[c]));
        box.lower[c] -= loose;
        box.upper[c] += loose;
    }
    return box;
}

static bool is_empty(const corners *box)
{
    return box->lower[0] > box->upper[0] || box->lower[1] > box->upper[1] || box->lower[2] > box->upper[2];
}

static corners empty_box(void)
{
    return (corners) { { HUGE_VAL, HUGE_VAL, HUGE_VAL }, { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL } };
}

static corners combine_boxes(uint8_t operation, const corners *a, const corners *b)
{
    corners out = *a;
    if (operation == GLINT_COMBINE_DIFFERENCE)
        return out;
    const bool both = operation == GLINT_COMBINE_INTERSECTION;
    for (int c = 0; c < 3; c++) {
        out.lower[c] = both ? fmax(a->lower[c], b->lower[c]) : fmin(a->lower[c], b->lower[c]);
        out.upper[c] = both ? fmin(a->upper[c], b->upper[c]) : fmax(a->upper[c], b->upper[c]);
    }
    return is_empty(&out) ? empty_box() : out;
}

void glint_combined_box(const glint_geometry *geometry, const glint_combined *combined, double box[3][3])
{
    corners stack[GLINT_PARTS_MAX] = { { { 0 }, { 0 } } };
    int top = 0;
    bool ends = true;
    for (uint32_t k = 0; k < combined->length; k++) {
        const uint8_t p = combined->program[k];
        if (p < GLINT_PARTS_MAX) {
            stack[top++] = box_around(geometry, &geometry->members[combined->first + p]);
        } else if (p == GLINT_COMBINE_NOTHING) {
            stack[top++] = empty_box();
        } else {
            top--;
            stack[top - 1] = combine_boxes(p, &stack[top - 1], &stack[top]);
        }
    }
    for (int c = 0; c < 3; c++) {
        const bool empty = is_empty(&stack[0]);
        box[1][c] = empty ? 0 : stack[0].lower[c];
        box[2][c] = empty ? 0 : stack[0].upper[c];
        ends = ends && isfinite(box[1][c]) && isfinite(box[2][c]);
    }
    for (int c = 0; c < 3; c++) {
        box[1][c] = ends ? box[1][c] : -HUGE_VAL;
        box[2][c] = ends ? box[2][c] : HUGE_VAL;
        box[0][c] = ends ? 0.5 * box[1][c] + 0.5 * box[2][c] : 0;
    }
}

/// Roles of parts in a set operation, one bit each. needs: the parts that contain every point of the result. alone:
/// the parts that can contain a point of the result that no other part contains.
typedef struct roles {
    uint64_t needs, alone;
} roles;

static roles combine_roles(uint8_t operation, roles a, roles b)
{
    if (operation == GLINT_COMBINE_UNION)
        return (roles) { a.needs & b.needs, a.alone | b.alone };
    return operation == GLINT_COMBINE_INTERSECTION ? (roles) { a.needs | b.needs, 0 } : a;
}

void glint_combined_roles(glint_combined *combined)
{
    roles stack[GLINT_PARTS_MAX] = { { 0 } };
    int top = 0;
    bool whole = combined->count > 0;
    for (uint32_t k = 0; k < combined->length; k++) {
        const uint8_t p = combined->program[k];
        if (p < GLINT_PARTS_MAX) {
            stack[top++] = (roles) { (uint64_t)1 << p, (uint64_t)1 << p };
        } else if (p == GLINT_COMBINE_NOTHING) {
            stack[top++] = (roles) { ~(uint64_t)0, 0 };
            whole = false;
        } else {
            top--;
            stack[top - 1] = combine_roles(p, stack[top - 1], stack[top]);
        }
    }
    combined->all = whole ? ~(uint64_t)0 >> (GLINT_PARTS_MAX - combined->count) : 0;
    combined->needs = stack[0].needs;
    combined->alone = stack[0].alone;
}

/// Counts crossings along a fixed direction, which is unlikely to lie in a face or edge. The result does not depend
/// on the direction.
static bool hull_holds(const glint_geometry *geometry, const glint_prim *part, const double point[3])
{
    static const double direction[3] = { 0.36, 0.48, 0.8 };
    const glint_hull *hull = &geometry->hulls[part->item];
    int exits = 0;
    for (uint32_t i = 0; i < hull->count; i++)
        exits += glint_prim_crossing(&geometry->members[hull->first + i], point, direction);
    return part->inverted ? exits < 0 : exits > 0;
}

static bool part_holds(const glint_geometry *geometry, const glint_prim *part, const double point[3])
{
    double e[3];
    vec_sub(e, point, part->center);
    if (part->kind == GLINT_PRIM_HULL)
        return part->face == 1 && hull_holds(geometry, part, point);
    if (part->kind == GLINT_PRIM_PLANE)
        return vec_dot(part->normal, e) < 0;
    return glint_solid_holds(&geometry->solids[part->item], part->center, point);
}

bool glint_combined_holds(const glint_geometry *geometry, const glint_combined *combined, const double point[3])
{
    bool stack[GLINT_PARTS_MAX] = { false };
    int top = 0;
    for (uint32_t k = 0; k < combined->length; k++) {
        const uint8_t p = combined->program[k];
        if (p < GLINT_PARTS_MAX) {
            stack[top++] = part_holds(geometry, &geometry->members[combined->first + p], point);
        } else if (p == GLINT_COMBINE_NOTHING) {
            stack[top++] = false;
        } else {
            const bool b = stack[--top], a = stack[top - 1];
            stack[top - 1] = p == GLINT_COMBINE_UNION ? a || b : p == GLINT_COMBINE_INTERSECTION ? a && b : a && !b;
        }
    }
    return stack[0];
}
