/// Limits of sizes and of distances from ray origins, so that the squares that kernels compute neither overflow nor
/// underflow.
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/geometry/geometry.h"

#include <stdio.h>

#define SIZE_LEAST 1e-150 ///< world units
#define SIZE_MOST 1e150 ///< largest size of a curved solid; a sphere is measured in its own units
#define AWAY_MOST 1e150 ///< largest distance of a ray's origin from a shape, in sizes of the shape

typedef struct extents {
    double least, most; ///< smallest and largest width that is squared
    double longest; ///< in any direction
} extents;

/// Computes the sizes that kernels square. False: there are none, because for boxes, planes and triangles kernels use
/// heights, which are not squared.
static bool extents_of(const glint_geometry *geometry, const glint_prim *prim, extents *out)
{
    *out = (extents) { prim->radius, 1, prim->radius };
    if (prim->kind == GLINT_PRIM_SPHERE)
        return true;
    if (prim->kind != GLINT_PRIM_SOLID || geometry->solids[prim->item].form == GLINT_FORM_BOX)
        return false;
    const glint_solid *solid = &geometry->solids[prim->item];
    const glint_form form = solid->form;
    *out = (extents) { HUGE_VAL, 0, 0 };
    for (int i = 0; i < 3; i++)
        out->longest = fmax(out->longest, vec_max_abs(solid->forward[i]));
    const bool flat = form == GLINT_FORM_DISK, round = form == GLINT_FORM_CYLINDER || form == GLINT_FORM_TUBE;
    for (int i = 0; i < (flat || round ? 2 : 3); i++) {
        const double width = 1 / vec_max_abs(solid->inverse[i]);
        out->least = width >= out->least ? out->least : width; // NaN stays
        out->most = flat ? 1 : fmax(out->most, width); // for a disk, only the position of the hit is squared
    }
    if (form == GLINT_FORM_TORUS)
        out->least *= solid->tube;
    return true;
}

/// Writes "sphere #3", or "spheres 'sky': sphere 12".
static void name_prim(const glint_geometry *geometry, const glint_prim *prim, char *out, size_t size)
{
    const uint32_t number = geometry->prim_part[prim->id];
    const glint_part *part = &geometry->parts[number];
    char owner[2 * GLINT_NAME_SIZE];
    glint_describe_shape(&part->shape->desc, number + 1, owner, sizeof owner);
    if (glint_shape_is_many(part->shape->desc.kind))
        snprintf(out, size, "%s: %s %u", owner, part->shape->desc.kind == GLINT_SHAPE_SPHERES ? "sphere" : "cylinder",
                 prim->id - part->first_prim + 1);
    else
        snprintf(out, size, "%s", owner);
}

/// Returns primitive i; the primitives that rays hit come first, then the parts of combined solids.
static const glint_prim *prim_at(const glint_geometry *geometry, uint32_t i)
{
    const uint32_t count = geometry->table.prim_count;
    return i < count ? &geometry->prims[i] : &geometry->members[i - count];
}

glint_status glint_geometry_check_sizes(glint_geometry *geometry, glint_error *error)
{
    geometry->thinnest = HUGE_VAL;
    for (uint32_t i = 0; i < geometry->table.prim_count + geometry->member_count; i++) {
        const glint_prim *prim = prim_at(geometry, i);
        char name[3 * GLINT_NAME_SIZE];
        extents e;
        if (!extents_of(geometry, prim, &e))
            continue;
        const double allowed = SIZE_LEAST * fmax(1, prim->kind == GLINT_PRIM_SOLID ? e.longest : 0);
        geometry->thinnest = fmin(geometry->thinnest, e.least);
        if (e.least >= allowed && e.most <= SIZE_MOST)
            continue;
        name_prim(geometry, prim, name, sizeof name);
        if (prim->kind == GLINT_PRIM_SPHERE)
            return glint_fail(error, GLINT_ERR_INVALID, "%s: radius >= %g in the world expected, got %.15g", name,
                              SIZE_LEAST, e.least);
        return glint_fail(error, GLINT_ERR_INVALID, "%s: half widths %g .. %g in the world expected, got %.15g", name,
                          e.most > SIZE_MOST ? SIZE_LEAST : allowed, SIZE_MOST, e.most > SIZE_MOST ? e.most : e.least);
    }
    return GLINT_OK;
}

glint_status glint_geometry_check_reach(const glint_geometry *geometry, const char *who, const double from[3],
                                        glint_error *error)
{
    if (vec_max_abs(from) + geometry->table.extent <= AWAY_MOST * geometry->thinnest)
        return GLINT_OK;
    for (uint32_t i = 0; i < geometry->table.prim_count + geometry->member_count; i++) {
        const glint_prim *prim = prim_at(geometry, i);
        char name[3 * GLINT_NAME_SIZE];
        double away[3];
        extents e;
        vec_sub(away, prim->center, from);
        if (!extents_of(geometry, prim, &e) || vec_max_abs(away) <= AWAY_MOST * e.least)
            continue;
        name_prim(geometry, prim, name, sizeof name);
        return glint_fail(error, GLINT_ERR_INVALID,
                          "%s: too small for rays from %s to hit it, at a distance of %.4g with a %s of %.4g; >= "
                          "%.4g expected",
                          name, who, vec_max_abs(away), prim->kind == GLINT_PRIM_SPHERE ? "radius" : "half width",
                          e.least, vec_max_abs(away) / AWAY_MOST);
    }
    return GLINT_OK;
}
