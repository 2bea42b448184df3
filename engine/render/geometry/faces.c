#include "engine/render/geometry/faces.h"
#include "engine/base/vec.h"

void glint_place_point(const glint_placing *placing, const double p[3], double out[3])
{
    if (placing->map)
        glint_transform_point(placing->map, p, out);
    else
        vec_copy(out, p);
    for (int c = 0; c < 3; c++)
        out[c] += 0.0; // -0 and 0 are the same position
}

void glint_place_normal(const glint_placing *placing, const double n[3], double out[3])
{
    double turned[3] = { n[0], n[1], n[2] };
    for (int c = 0; c < 3 && placing->map; c++)
        turned[c] = vec_dot(placing->cofactors[c], n) * (placing->determinant < 0 ? -1 : 1);
    if (placing->map && vec_max_abs(turned) > 0)
        vec_normalize(turned, turned);
    vec_copy(out, turned);
}

void glint_face_init(glint_face *face, const glint_placing *placing, const double normal[3], const double point[3])
{
    double unit[3], from[3];
    vec_normalize(unit, normal);
    glint_place_normal(placing, unit, face->normal);
    face->axis = (uint32_t)glint_axis_along(face->normal);
    const int own = glint_axis_along(unit);
    for (int c = 0; c < 3; c++)
        from[c] = own == 3 || own == c || face->axis < 3 ? point[c] : 0;
    glint_place_point(placing, from, face->at);
    face->magnitude = 0;
}

/// Returns the magnitude of the terms of the sum that maps a point from the shape's own space to the world.
static double moved_by(const glint_placing *placing, int axis, const double own[3])
{
    const double *row = placing->map ? placing->map->m[axis] : NULL;
    return row ? ((fabs(row[0]) * own[0] + fabs(row[1]) * own[1]) + fabs(row[2]) * own[2]) + fabs(row[3]) : 0;
}

void glint_face_bound(glint_face *face, const glint_placing *placing, const double lower[3], const double upper[3],
                      const double own[3])
{
    double magnitude = 0;
    for (int c = 0; c < 3; c++) {
        const double moved = moved_by(placing, c, own);
        magnitude += fabs(face->normal[c]) * ((fmax(fabs(lower[c]), fabs(upper[c])) + fabs(face->at[c])) + moved);
    }
    face->magnitude = fmax(face->magnitude, magnitude);
}

void glint_solid_faces(const glint_shape_desc *desc, glint_form form, const glint_placing *placing, glint_face *out)
{
    double along[3];
    if (form == GLINT_FORM_BOX) {
        for (int i = 0; i < 6; i++) {
            for (int c = 0; c < 3; c++)
                along[c] = c == i / 2;
            glint_face_init(&out[i], placing, along, i % 2 ? desc->max : desc->min);
        }
        return;
    }
    if (form == GLINT_FORM_TORUS)
        return;
    const bool disk = form == GLINT_FORM_DISK, cone = form == GLINT_FORM_CONE || form == GLINT_FORM_FUNNEL;
    const double *low = disk ? desc->center : cone ? desc->top : desc->base;
    const double *high = disk ? desc->center : cone ? desc->base : desc->top;
    for (int c = 0; c < 3; c++)
        along[c] = disk ? desc->normal[c] : 0.5 * high[c] - 0.5 * low[c];
    glint_face_init(&out[0], placing, along, low);
    glint_face_init(&out[1], placing, along, high);
}

int glint_level_axis(const glint_mesh *mesh, size_t triangle)
{
    const uint32_t *at = mesh->triangles[triangle];
    const double *a = mesh->vertices[at[0]], *b = mesh->vertices[at[1]], *c = mesh->vertices[at[2]];
    for (int axis = 0; axis < 3; axis++)
        if (a[axis] == b[axis] && a[axis] == c[axis])
            return axis;
    return 3;
}

size_t glint_count_levels(const glint_mesh *mesh)
{
    int last_axis = 3;
    double last = 0;
    size_t count = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const int axis = glint_level_axis(mesh, i);
        if (axis == 3)
            continue;
        const double level = mesh->vertices[mesh->triangles[i][0]][axis];
        count += axis != last_axis || level != last;
        last_axis = axis;
        last = level;
    }
    return count;
}
