/// Makes one primitive from its description, with its bounds.
#include "engine/base/vec.h"
#include "engine/render/geometry/prims.h"

#include <float.h>
#include <string.h>

void glint_sphere_init(glint_prim *prim, const double center[3], double radius)
{
    prim->kind = GLINT_PRIM_SPHERE;
    for (int c = 0; c < 3; c++)
        prim->center[c] = center[c] + 0.0; // -0 and 0 are the same position
    prim->radius = radius;
}

void glint_plane_init(glint_prim *prim, double buffer[4], const double point[3], const double normal[3],
                      const glint_placing *placing)
{
    glint_face face;
    glint_face_init(&face, placing, normal, point);
    prim->kind = GLINT_PRIM_PLANE;
    vec_copy(prim->center, face.at);
    prim->normal = buffer;
    vec_copy(buffer, face.normal);
    buffer[3] = 0;
    for (int c = 0; c < 3 && face.axis == 3; c++)
        buffer[3] += 2 * fabs(face.normal[c] * face.at[c]) + DBL_MIN;
}

static int copy_face(double *out, const glint_face *face)
{
    vec_copy(out, face->normal);
    vec_copy(out + 3, face->at);
    return 6;
}

/// Writes a key of the positions of all parts; it stands for the parts.
static int combined_record(const glint_geometry *geometry, const glint_combined *combined,
                           double out[GLINT_PRIM_RECORD_MAX])
{
    glint_key key = glint_key_add((glint_key) { 0 }, combined->program, combined->length);
    for (uint32_t j = 0; j < combined->count; j++) {
        double record[GLINT_PRIM_RECORD_MAX];
        const int count = glint_prim_record(geometry, &geometry->members[combined->first + j], record);
        key = glint_key_add(key, record, (size_t)count * sizeof *record);
    }
    memcpy(out + 1, &key, sizeof key);
    return 1 + (int)(sizeof key / sizeof *out);
}

/// Writes a key of the positions of a mesh's triangles; it stands for the triangles.
static int hull_record(const glint_geometry *geometry, const glint_prim *part, double out[GLINT_PRIM_RECORD_MAX])
{
    const glint_hull *hull = &geometry->hulls[part->item];
    glint_key key = { 0 };
    for (uint32_t i = 0; i < hull->count && part->face == 1; i++) {
        double record[GLINT_PRIM_RECORD_MAX];
        const int count = glint_prim_record(geometry, &geometry->members[hull->first + i], record);
        key = glint_key_add(key, record, (size_t)count * sizeof *record);
    }
    out[1] = part->face;
    memcpy(out + 2, &key, sizeof key);
    return 2 + (int)(sizeof key / sizeof *out);
}

int glint_prim_record(const glint_geometry *geometry, const glint_prim *prim, double out[GLINT_PRIM_RECORD_MAX])
{
    out[0] = prim->kind;
    if (prim->kind == GLINT_PRIM_TRIANGLE) {
        memcpy(out + 1, prim->corner, 9 * sizeof *out);
        return 10 + (prim->face ? copy_face(out + 10, &geometry->faces[prim->face - 1]) : 0);
    }
    if (prim->kind == GLINT_PRIM_COMBINED)
        return combined_record(geometry, &geometry->combined[prim->item], out);
    if (prim->kind == GLINT_PRIM_HULL)
        return hull_record(geometry, prim, out);
    vec_copy(out + 1, prim->center);
    if (prim->kind == GLINT_PRIM_SOLID) {
        const glint_solid *solid = &geometry->solids[prim->item];
        out[4] = solid->form;
        memcpy(out + 5, solid->inverse, sizeof solid->inverse);
        int count = 14;
        if (solid->form == GLINT_FORM_TORUS)
            out[count++] = solid->tube;
        for (int i = 0; i < 2 * glint_slab_count(solid->form); i++)
            count += copy_face(out + count, &solid->faces[i]);
        return count;
    }
    const bool plane = prim->kind == GLINT_PRIM_PLANE;
    for (int c = 0; c < 3; c++)
        out[4 + c] = plane ? prim->normal[c] : 0;
    out[7] = plane ? 0 : prim->radius;
    return 8;
}

static void solid_bounds(const glint_solid *solid, const double center[3], double lower[3], double upper[3])
{
    for (int c = 0; c < 3; c++) {
        const double *m = solid->forward[c], round = sqrt(m[0] * m[0] + m[1] * m[1]);
        double low = -round, high = round; // for a disk, and the cross-section of the others
        if (solid->form == GLINT_FORM_BALL)
            high = sqrt(vec_dot(m, m));
        else if (solid->form == GLINT_FORM_BOX)
            high = (fabs(m[0]) + fabs(m[1])) + fabs(m[2]);
        else if (solid->form == GLINT_FORM_CYLINDER || solid->form == GLINT_FORM_TUBE)
            high = round + fabs(m[2]);
        else if (solid->form == GLINT_FORM_TORUS)
            high = round + solid->tube * sqrt(vec_dot(m, m));
        if (solid->form == GLINT_FORM_CONE || solid->form == GLINT_FORM_FUNNEL) {
            low = fmin(0, m[2] - round);
            high = fmax(0, m[2] + round);
        } else {
            low = -high;
        }
        lower[c] = center[c] + low;
        upper[c] = center[c] + high;
    }
}

void glint_prim_bounds(const glint_solid *solids, const glint_prim *prim, double lower[3], double upper[3])
{
    if (prim->kind == GLINT_PRIM_SOLID) {
        solid_bounds(&solids[prim->item], prim->center, lower, upper);
        return;
    }
    if (prim->kind == GLINT_PRIM_COMBINED || prim->kind == GLINT_PRIM_HULL) {
        vec_copy(lower, prim->corner[1]);
        vec_copy(upper, prim->corner[2]);
        return;
    }
    for (int c = 0; c < 3; c++) {
        lower[c] = prim->center[c] - prim->radius;
        upper[c] = prim->center[c] + prim->radius;
        if (prim->kind == GLINT_PRIM_TRIANGLE) {
            lower[c] = fmin(prim->corner[0][c], fmin(prim->corner[1][c], prim->corner[2][c]));
            upper[c] = fmax(prim->corner[0][c], fmax(prim->corner[1][c], prim->corner[2][c]));
        }
    }
}

// ---- Solids: a unit shape, and the map to the described shape ----

/// Computes two unit vectors perpendicular to a unit vector (Duff et al., JCGT 6(1) 2017).
static void basis(const double n[3], double x[3], double y[3])
{
    const double sign = copysign(1, n[2]), a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
    x[0] = 1 + sign * n[0] * n[0] * a, x[1] = sign * b, x[2] = -sign * n[0];
    y[0] = b, y[1] = sign + n[1] * n[1] * a, y[2] = -n[1];
}

/// Makes a map whose x and y axes are perpendicular to `along` and have length `radius`; its z axis is `along`.
static void round_map(double m[3][4], const double origin[3], const double along[3], double radius)
{
    double n[3], x[3], y[3];
    vec_normalize(n, along);
    basis(n, x, y);
    for (int c = 0; c < 3; c++) {
        m[c][0] = radius * x[c];
        m[c][1] = radius * y[c];
        m[c][2] = along[c];
        m[c][3] = origin[c];
    }
}

static glint_form form_of(const glint_shape_desc *desc)
{
    switch (desc->kind) {
    case GLINT_SHAPE_BOX:
        return GLINT_FORM_BOX;
    case GLINT_SHAPE_DISK:
        return GLINT_FORM_DISK;
    case GLINT_SHAPE_CYLINDER:
        return desc->capped ? GLINT_FORM_CYLINDER : GLINT_FORM_TUBE;
    case GLINT_SHAPE_CONE:
        return desc->capped ? GLINT_FORM_CONE : GLINT_FORM_FUNNEL;
    case GLINT_SHAPE_TORUS:
        return GLINT_FORM_TORUS;
    default:
        return GLINT_FORM_BALL;
    }
}

/// Returns the map from the unit shape to the described one.
static glint_transform unit_map(const glint_shape_desc *desc)
{
    glint_transform map = glint_transform_identity();
    double middle[3], along[3];
    for (int c = 0; c < 3; c++) {
        middle[c] = 0.5 * desc->base[c] + 0.5 * desc->top[c];
        along[c] = 0.5 * desc->top[c] - 0.5 * desc->base[c];
    }
    if (desc->kind == GLINT_SHAPE_CYLINDER) {
        round_map(map.m, middle, along, desc->radius);
    } else if (desc->kind == GLINT_SHAPE_CONE) {
        vec_sub(along, desc->base, desc->top);
        round_map(map.m, desc->top, along, desc->radius);
    } else if (desc->kind == GLINT_SHAPE_DISK) {
        vec_normalize(along, desc->normal);
        round_map(map.m, desc->center, along, desc->radius);
    } else if (desc->kind == GLINT_SHAPE_TORUS) {
        vec_normalize(along, desc->axis);
        vec_scale(along, along, desc->major);
        round_map(map.m, desc->center, along, desc->major);
    } else {
        for (int c = 0; c < 3; c++) {
            const bool box = desc->kind == GLINT_SHAPE_BOX;
            map.m[c][c] = box ? 0.5 * desc->max[c] - 0.5 * desc->min[c] : desc->radius;
            map.m[c][3] = box ? 0.5 * desc->max[c] + 0.5 * desc->min[c] : desc->center[c];
        }
    }
    return map;
}

/// Computes the magnitudes from which rounding errors are bounded: for the faces and for the curved side. The curved
/// side of the unit shape is near 1 in each direction.
static void bound_solid(const glint_prim *prim, const glint_placing *placing, const glint_transform *unit,
                        glint_solid *solid, glint_face *faces)
{
    double lower[3], upper[3], own[3];
    solid_bounds(solid, prim->center, lower, upper);
    for (int c = 0; c < 3; c++)
        own[c] = ((fabs(unit->m[c][0]) + fabs(unit->m[c][1])) + fabs(unit->m[c][2])) + fabs(unit->m[c][3]);
    for (int i = 0; i < 2 * glint_slab_count(solid->form); i++)
        glint_face_bound(&faces[i], placing, lower, upper, own);
    solid->faces = faces;
    solid->magnitude = 1;
    for (int i = 0; i < 9; i++)
        solid->magnitude += 2 * fabs(solid->inverse[i / 3][i % 3]) *
                            (fmax(fabs(lower[i % 3]), fabs(upper[i % 3])) + fabs(prim->center[i % 3]));
}

double glint_linear_scale(double m[3][3])
{
    const double scale = power_of_two_scale(fmax(vec_max_abs(m[0]), fmax(vec_max_abs(m[1]), vec_max_abs(m[2]))));
    for (int c = 0; c < 3; c++)
        vec_scale(m[c], m[c], scale);
    return scale;
}

/// Makes a solid. unit: the map from the unit shape to the shape's own space. faces: the solid's faces, without error
/// bounds so far.
static void solid_init(glint_prim *prim, glint_solid *solid, glint_form form, const glint_transform *unit,
                       const glint_placing *placing, glint_face *faces)
{
    const glint_transform map = placing->map ? glint_transform_product(placing->map, unit) : *unit;
    double cofactors[3][3], scaled[3][3];
    prim->kind = GLINT_PRIM_SOLID;
    solid->form = form;
    glint_transform_linear(&map, solid->forward);
    for (int c = 0; c < 3; c++)
        prim->center[c] = map.m[c][3] + 0.0;
    memcpy(scaled, solid->forward, sizeof scaled);
    const double scale = glint_linear_scale(scaled), determinant = glint_linear_cofactors(scaled, cofactors);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            solid->inverse[i][j] = cofactors[j][i] / determinant * scale;
    bound_solid(prim, placing, unit, solid, faces);
}

int glint_solid_init(glint_prim *prim, glint_solid *solid, const glint_shape_desc *desc, const glint_placing *placing,
                     glint_face *faces)
{
    const glint_transform unit = unit_map(desc);
    const glint_form form = form_of(desc);
    const int count = 2 * glint_slab_count(form);
    if (count > 0)
        glint_solid_faces(desc, form, placing, faces);
    solid->tube = form == GLINT_FORM_TORUS ? desc->minor / desc->major : 0;
    solid_init(prim, solid, form, &unit, placing, faces);
    return count;
}
