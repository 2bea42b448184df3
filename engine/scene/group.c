/// Groups, shapes that share a transform, and combined solids. Each may be in several others, and so may what is in it.
#include "engine/base/hash.h"
#include "engine/base/status.h"
#include "engine/scene/objects.h"

#include <string.h>

/// Whether anything would be within more groups than allowed, were `shape` within `level`.
static bool too_deep(glint_shape *shape, size_t level, uint64_t stamp)
{
    if (level > GLINT_GROUP_DEPTH)
        return true;
    if (shape->level >= level || (shape->stamp == stamp && shape->probed >= level))
        return false;
    shape->stamp = stamp;
    shape->probed = level;
    for (size_t i = 0; i < shape->children.count; i++)
        if (too_deep(shape->children.items[i], level + 1, stamp))
            return true;
    return false;
}

/// A shape is `level` groups deep from now on, or deeper.
static void sink(glint_shape *shape, size_t level)
{
    if (shape->level >= level)
        return;
    shape->level = level;
    for (size_t i = 0; i < shape->children.count; i++)
        sink(shape->children.items[i], level + 1);
}

/// `stamp` marks what has been looked at.
static bool holds(glint_shape *shape, const glint_shape *wanted, uint64_t stamp)
{
    if (shape == wanted)
        return true;
    if (shape->stamp == stamp)
        return false;
    shape->stamp = stamp;
    for (size_t i = 0; i < shape->children.count; i++)
        if (holds(shape->children.items[i], wanted, stamp))
            return true;
    return false;
}

const char *glint_part_refusal(const glint_shape *child)
{
    switch (child->desc.kind) {
    case GLINT_SHAPE_CYLINDER:
    case GLINT_SHAPE_CONE:
        return child->desc.capped ? NULL : "capped = true";
    case GLINT_SHAPE_DISK:
    case GLINT_SHAPE_SPHERES:
    case GLINT_SHAPE_MESH:
        return "a sphere, box, cylinder, cone, torus, plane, group or combined solid";
    default:
        break;
    }
    for (size_t i = 0; i < child->children.count; i++) {
        const char *refusal = glint_part_refusal(child->children.items[i]);
        if (refusal)
            return refusal;
    }
    return NULL;
}

/// What a combined solid has no use for, found in a new part of it.
static glint_status check_part(const glint_shape *whole, const glint_shape *child, glint_error *error)
{
    const char *expected = glint_shape_combines(whole) ? glint_part_refusal(child) : NULL;
    if (!expected)
        return GLINT_OK;
    const char *kind = glint_shape_kind_name(whole->desc.kind);
    return glint_fail(error, GLINT_ERR_INVALID, "%s: parts with an inside expected: %s, got %s%s", kind, expected,
                      glint_shape_kind_name(child->desc.kind), child->desc.kind == GLINT_SHAPE_GROUP ? " with others" : "");
}

glint_status glint_group_add(glint_shape *group, glint_shape *child, glint_error *error)
{
    static uint64_t stamps;
    const char *kind = glint_shape_kind_name(group->desc.kind);
    if (!glint_shape_has_children(group))
        return glint_fail(error, GLINT_ERR_INVALID, "group: a group expected");
    if (holds(child, group, ++stamps))
        return glint_fail(error, GLINT_ERR_INVALID, "%s: a %s cannot be within itself", kind, strcmp(kind, "group") ? "solid" : kind);
    if (too_deep(child, group->level + 1, ++stamps))
        return glint_fail(error, GLINT_ERR_INVALID, "%s: at most %d groups one within the other expected", kind,
                          GLINT_GROUP_DEPTH);
    glint_status status = check_part(group, child, error);
    if (!status)
        status = glint_list_find(&group->children, child) < group->children.count
                     ? glint_fail(error, GLINT_ERR_INVALID, "%s: already in the %s", kind, kind)
                     : glint_list_add(&group->children, child, error);
    if (status)
        return status;
    glint_shape_retain(child);
    sink(child, group->level + 1);
    glint_shape_changed(group);
    return GLINT_OK;
}

glint_status glint_group_remove(glint_shape *group, glint_shape *child, glint_error *error)
{
    const size_t index = glint_list_find(&group->children, child);
    if (index == group->children.count)
        return glint_fail(error, GLINT_ERR_INVALID, "%s: not in the %s", glint_shape_kind_name(group->desc.kind),
                          glint_shape_kind_name(group->desc.kind));
    glint_list_remove(&group->children, index);
    glint_shape_changed(group);
    glint_shape_release(child);
    return GLINT_OK;
}

size_t glint_group_count(const glint_shape *group) { return group->children.count; }

glint_shape *glint_group_child(const glint_shape *group, size_t index) { return group->children.items[index]; }
