/// Groups (shapes with a common transform) and combined solids. Groups, solids and their members may each be in
/// several other groups and solids.
#include "engine/base/hash.h"
#include "engine/base/status.h"
#include "engine/render/scene/objects.h"

#include <string.h>

/// Returns whether any shape would be nested deeper than allowed if `shape` were at `level`.
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

/// Records that a shape is nested at least `level` groups deep.
static void sink(glint_shape *shape, size_t level)
{
    if (shape->level >= level)
        return;
    shape->level = level;
    for (size_t i = 0; i < shape->children.count; i++)
        sink(shape->children.items[i], level + 1);
}

/// Returns whether `wanted` is inside a shape. `stamp` marks the shapes already visited.
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

/// Determines for each mesh in a part of a combined solid whether the mesh is closed.
static glint_status find_closures(const glint_shape *part, glint_error *error)
{
    glint_status status = part->mesh ? glint_mesh_find_closure(part->mesh, error) : GLINT_OK;
    for (size_t i = 0; i < part->children.count && !status; i++)
        status = find_closures(part->children.items[i], error);
    return status;
}

/// Returns what a message must expect if a part, or a shape in it, has no inside; `found` is that shape. NULL:
/// everything has an inside.
static const char *refusal_of(const glint_shape *part, const glint_shape **found)
{
    *found = part;
    switch (part->desc.kind) {
    case GLINT_SHAPE_CYLINDER:
    case GLINT_SHAPE_CONE:
        return part->desc.capped ? NULL : "capped = true";
    case GLINT_SHAPE_DISK:
    case GLINT_SHAPE_SPHERES:
    case GLINT_SHAPE_CYLINDERS:
        return "a sphere, box, cylinder, cone, torus, plane, closed mesh, group or combined solid";
    case GLINT_SHAPE_MESH:
        if (part->desc.shading == GLINT_SHADING_FLAT || part->desc.shading == GLINT_SHADING_GOURAUD)
            return "shading = \"faceted\" or \"phong\"";
        if (part->desc.terminator > 0)
            return "terminator = 0";
        return part->mesh->closure.triangles ? "a closed mesh" : NULL;
    default:
        break;
    }
    for (size_t i = 0; i < part->children.count; i++) {
        const char *refusal = refusal_of(part->children.items[i], found);
        if (refusal)
            return refusal;
    }
    return NULL;
}

/// Fails with a message that names the open edge of a mesh.
static glint_status fail_open(const char *who, const glint_shape *shape, glint_error *error)
{
    const glint_closure *open = &shape->mesh->closure;
    const double *a = open->edge[0], *b = open->edge[1];
    const char *name = shape->desc.name, *before = name[0] ? " '" : "", *after = name[0] ? "'" : "";
    return glint_fail(error, GLINT_ERR_INVALID,
                      "%s: parts with an inside expected: a closed mesh, got mesh%s%s%s: its edge from {%.15g, %.15g, %.15g} to "
                      "{%.15g, %.15g, %.15g} has %u triangle%s",
                      who, before, name, after, a[0], a[1], a[2], b[0], b[1], b[2], open->triangles,
                      open->triangles == 1       ? ""
                      : open->triangles % 2 == 0 ? "s, not equally many in each direction along it"
                                                 : "s");
}

glint_status glint_check_part(const char *who, const glint_shape *part, glint_error *error)
{
    const glint_shape *found;
    glint_status status = find_closures(part, error);
    if (status)
        return status;
    const char *expected = refusal_of(part, &found);
    if (!expected)
        return GLINT_OK;
    if (found->mesh && found->mesh->closure.triangles)
        return fail_open(who, found, error);
    return glint_fail(error, GLINT_ERR_INVALID, "%s: parts with an inside expected: %s, got %s%s", who, expected,
                      glint_shape_kind_name(part->desc.kind), part->desc.kind == GLINT_SHAPE_GROUP ? " with others" : "");
}

glint_status glint_group_add(glint_shape *group, glint_shape *child, glint_error *error)
{
    GLINT_REFUSE_NULL(group, error);
    GLINT_REFUSE_NULL(child, error);
    static uint64_t stamps;
    const char *kind = glint_shape_kind_name(group->desc.kind);
    if (!glint_shape_has_children(group))
        return glint_fail(error, GLINT_ERR_INVALID, "group: a group expected");
    if (holds(child, group, ++stamps))
        return glint_fail(error, GLINT_ERR_INVALID, "%s: a %s cannot contain itself", kind, strcmp(kind, "group") ? "solid" : kind);
    if (too_deep(child, group->level + 1, ++stamps))
        return glint_fail(error, GLINT_ERR_INVALID, "%s: at most %d nested groups expected", kind,
                          GLINT_GROUP_DEPTH);
    glint_status status = glint_shape_combines(group) ? glint_check_part(kind, child, error) : GLINT_OK;
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
    GLINT_REFUSE_NULL(group, error);
    GLINT_REFUSE_NULL(child, error);
    const size_t index = glint_list_find(&group->children, child);
    if (index == group->children.count)
        return glint_fail(error, GLINT_ERR_INVALID, "%s: not in the %s", glint_shape_kind_name(group->desc.kind),
                          glint_shape_kind_name(group->desc.kind));
    glint_list_remove(&group->children, index);
    glint_shape_changed(group);
    glint_shape_release(child);
    return GLINT_OK;
}

size_t glint_group_count(const glint_shape *group) { return group ? group->children.count : 0; }

glint_shape *glint_group_child(const glint_shape *group, size_t index)
{
    return group && index < group->children.count ? group->children.items[index] : NULL;
}
