/// Closed meshes that are parts of combined solids: the trees that find their triangles along a ray.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/geometry/geometry.h"

#include <stdlib.h>

/// Boxes are widened by this fraction of the mesh's size, because a ray must find all triangles that it crosses. If
/// the ray starts up to 2^30 mesh sizes away, rounding may turn a near miss of a box into a hit.
#define HULL_SLACK 0x1p-20

/// A tree that geometries share as long as the positions of the mesh and the BVH's frame do not change.
struct glint_hull_tree {
    atomic_size_t references;
    glint_key key;
    glint_bvh bvh;
};

static void tree_release(struct glint_hull_tree *tree)
{
    if (!tree || atomic_fetch_sub(&tree->references, 1) > 1)
        return;
    glint_bvh_free(&tree->bvh);
    free(tree);
}

void glint_geometry_release_hulls(glint_geometry *geometry)
{
    for (uint32_t i = 0; i < geometry->hull_count && geometry->hull_trees; i++)
        tree_release(geometry->hull_trees[i]);
    free(geometry->hull_trees);
    free(geometry->hulls);
}

static glint_key key_of(const glint_geometry *geometry, const glint_hull *hull)
{
    const glint_geometry_table *table = &geometry->table;
    const double frame[5] = { table->reference[0], table->reference[1], table->reference[2], table->scale, table->extent };
    glint_key key = glint_key_add((glint_key) { 0 }, frame, sizeof frame);
    for (uint32_t i = 0; i < hull->count; i++) {
        const glint_prim *prim = &geometry->members[hull->first + i];
        key = glint_key_add(key, prim->corner, 9 * sizeof prim->corner[0][0]);
    }
    return key;
}

/// Returns the distance by which the boxes of the hull are widened, in the BVH's frame.
static float slack_of(const glint_box *boxes, uint32_t count)
{
    float widest = 0;
    for (int c = 0; c < 3; c++) {
        float low = HUGE_VALF, high = -HUGE_VALF;
        for (uint32_t i = 0; i < count; i++) {
            low = fminf(low, boxes[i].lower[c]);
            high = fmaxf(high, boxes[i].upper[c]);
        }
        widest = fmaxf(widest, high - low);
    }
    return (float)HULL_SLACK * widest;
}

static glint_status tree_build(glint_geometry *geometry, const glint_hull *hull, glint_bvh *out, glint_error *error)
{
    glint_box *boxes = glint_boxes_alloc(hull->count);
    if (!boxes)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < hull->count; i++) {
        glint_prim *member = &geometry->members[hull->first + i];
        glint_prim_place_sphere(&geometry->table, member);
        glint_prim_place_box(&geometry->table, member, i, &boxes[i]);
    }
    const float slack = slack_of(boxes, hull->count);
    for (uint32_t i = 0; i < hull->count; i++)
        for (int c = 0; c < 3; c++) {
            boxes[i].lower[c] -= slack;
            boxes[i].upper[c] += slack;
        }
    return glint_bvh_build(boxes, hull->count, NULL, out, error);
}

static struct glint_hull_tree *find_tree(const glint_geometry *last, glint_key key)
{
    for (uint32_t i = 0; last && last->hull_trees && i < last->hull_count; i++)
        if (glint_key_equal(last->hull_trees[i]->key, key))
            return last->hull_trees[i];
    return NULL;
}

glint_status glint_geometry_hull_trees(glint_geometry *geometry, const glint_geometry *last, glint_error *error)
{
    if (geometry->hull_count == 0)
        return GLINT_OK;
    geometry->hull_trees = glint_alloc(geometry->hull_count, sizeof *geometry->hull_trees);
    if (!geometry->hull_trees)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < geometry->hull_count; i++) {
        glint_hull *hull = &geometry->hulls[i];
        const glint_key key = key_of(geometry, hull);
        struct glint_hull_tree *tree = find_tree(last, key);
        if (tree) {
            atomic_fetch_add(&tree->references, 1);
        } else {
            tree = calloc(1, sizeof *tree);
            if (!tree)
                return glint_fail_nomem(error);
            atomic_init(&tree->references, 1);
            tree->key = key;
            glint_status status = tree_build(geometry, hull, &tree->bvh, error);
            if (status) {
                tree_release(tree);
                return status;
            }
        }
        geometry->hull_trees[i] = tree;
        hull->nodes = tree->bvh.nodes;
    }
    return GLINT_OK;
}

/// Counts the triangle's edges that cross one half of an axis of the plane perpendicular to the ray. An edge has the
/// same numbers in both of its triangles.
int glint_prim_crossing(const glint_prim *triangle, const double from[3], const double d[3])
{
    int z = fabs(d[1]) > fabs(d[0]);
    z = fabs(d[2]) > fabs(d[z]) ? 2 : z;
    const int x = (z + 1) % 3, y = (z + 2) % 3;
    double seen[3][2], depth[3], weight[3], sum = 0, weighted_depth = 0;
    int orientation = 0;
    for (int j = 0; j < 3; j++) {
        double p[3];
        vec_sub(p, triangle->corner[j], from);
        seen[j][0] = p[x] * d[z] - p[z] * d[x];
        seen[j][1] = p[y] * d[z] - p[z] * d[y];
        depth[j] = p[z];
    }
    for (int j = 0; j < 3; j++) {
        const double *a = seen[j], *b = seen[(j + 1) % 3];
        const double side = a[0] * b[1] - a[1] * b[0];
        orientation += a[1] <= 0 && b[1] > 0 && side > 0;
        orientation -= b[1] <= 0 && a[1] > 0 && side < 0;
        weight[(j + 2) % 3] = side;
    }
    if (orientation == 0)
        return 0;
    for (int j = 0; j < 3; j++) {
        sum += weight[j];
        weighted_depth += weight[j] * depth[j];
    }
    if (!(weighted_depth / (sum * d[z]) > 0))
        return 0;
    return d[z] > 0 ? orientation : -orientation;
}
