#include "engine/render/pattern/uv.h"
#include "engine/base/vec.h"
#include "engine/render/program/builder.h"

#define TURN 0x1.921fb54442d18p+2 // 2 pi
#define BELOW_1 0x1.fffffffffffffp-1

/// Returns the angle of x, z around an axis, 0 .. 1: from -z through -x, z and x.
static double around(double x, double z)
{
    const double operands[GLINT_OPERANDS_MAX] = { x, z };
    double angle[GLINT_RESULTS_MAX];
    glint_fold(GLINT_OP_ATAN2, NULL, operands, angle);
    return 0.5 + angle[0] / TURN;
}

/// Sphere: u grows eastwards, v from the south pole at y = -1 to the north pole.
static void ball_uv(const double d[3], glint_surface_uv *out)
{
    const double radius = sqrt(vec_dot(d, d)), operands[GLINT_OPERANDS_MAX] = { fmin(fmax(-d[1] / radius, -1), 1) };
    const double off_axis2 = d[0] * d[0] + d[2] * d[2], steep = 1 / (sqrt(off_axis2) * (TURN / 2));
    double angle[GLINT_RESULTS_MAX];
    glint_fold(GLINT_OP_ACOS, NULL, operands, angle);
    out->at[0] = around(d[0], d[2]);
    out->at[1] = angle[0] / (TURN / 2);
    out->unit = radius * (TURN / 2);
    out->slope[0][0] = d[2] / (off_axis2 * TURN);
    out->slope[0][2] = -d[0] / (off_axis2 * TURN);
    for (int c = 0; c < 3; c++)
        out->slope[1][c] = steep * ((c == 1) - d[1] / (radius * radius) * d[c]);
}

/// Box: 0 .. 1 on each face, seen from outside with y upwards; on the top and bottom faces with -z and z upwards.
static void box_uv(const glint_pattern_space *space, const glint_uv_point *point, glint_surface_uv *out)
{
    const int axis = point->axis, along[2] = { axis == 0 ? 2 : 0, axis == 1 ? 2 : 1 };
    const bool turned[2] = { axis == 0 ? point->upper : axis == 2 && !point->upper, axis == 1 && point->upper };
    for (int k = 0; k < 2; k++) {
        const double low = space->lower[along[k]], high = space->upper[along[k]], p = point->p[along[k]];
        out->at[k] = (turned[k] ? high - p : p - low) / (high - low);
        out->slope[k][along[k]] = (turned[k] ? -1 : 1) / (high - low);
        out->unit = k == 0 ? high - low : fmin(out->unit, high - low);
    }
}

/// Plane and disk: lengths from the point. Cylinder and cone: u around the axis, v from base to top.
static void axis_uv(const glint_pattern_space *space, const double p[3], glint_surface_uv *out)
{
    double d[3];
    vec_sub(d, p, space->origin);
    const double x = vec_dot(d, space->side[0]), y = vec_dot(d, space->side[1]), turn = (x * x + y * y) * TURN;
    if (space->length == 0) {
        *out = (glint_surface_uv) { { x, y }, .unit = 1 };
        vec_copy(out->slope[0], space->side[0]);
        vec_copy(out->slope[1], space->side[1]);
        return;
    }
    out->at[0] = around(x, -y);
    out->at[1] = fmin(fmax(vec_dot(d, space->along), 0), BELOW_1); // a cap shows one row of a texture despite rounding
    out->unit = fmin(TURN * space->radius, space->length);
    for (int c = 0; c < 3; c++)
        out->slope[0][c] = (x * space->side[1][c] - y * space->side[0][c]) / turn;
    vec_copy(out->slope[1], space->along);
}

/// Torus: u around its axis like a cylinder, v around its tube, 0 .. 1 from the inside of the ring through its lower
/// side.
static void torus_uv(const glint_pattern_space *space, const double p[3], glint_surface_uv *out)
{
    double d[3];
    vec_sub(d, p, space->origin);
    const double x = vec_dot(d, space->side[0]), y = vec_dot(d, space->side[1]), z = vec_dot(d, space->along);
    const double round2 = x * x + y * y, round = sqrt(round2), off = round - space->length, tube2 = off * off + z * z;
    out->at[0] = around(x, -y);
    out->at[1] = around(z, off);
    out->unit = TURN * fmin(round, space->radius);
    for (int c = 0; c < 3; c++) {
        const double outward = (x * space->side[0][c] + y * space->side[1][c]) / round;
        out->slope[0][c] = (x * space->side[1][c] - y * space->side[0][c]) / (round2 * TURN);
        out->slope[1][c] = (off * space->along[c] - z * outward) / (tube2 * TURN);
    }
}

/// Computes two sides of a triangle from its first corner, and the vector from there to p, scaled by a power of two.
/// Returns the scale.
static double sides_of(const glint_mesh *mesh, uint32_t triangle, const double p[3], double side[3][3])
{
    const uint32_t *at = mesh->triangles[triangle];
    const double *first = mesh->vertices[at[0]];
    vec_sub(side[0], mesh->vertices[at[1]], first);
    vec_sub(side[1], mesh->vertices[at[2]], first);
    vec_sub(side[2], p, first);
    const double scale = power_of_two_scale(fmax(vec_max_abs(side[0]), vec_max_abs(side[1])));
    for (int i = 0; i < 3; i++)
        vec_scale(side[i], side[i], scale);
    return scale;
}

/// Mesh: interpolated between the corners, u0 + (w1 (u1 - u0) + w2 (u2 - u0)). The result is clamped to the range of
/// the corners, because rounding can move a point beyond an edge. If the corners agree, the result is exactly their
/// value.
static void mesh_uv(const glint_pattern_space *space, const glint_uv_point *point, glint_surface_uv *out)
{
    const glint_mesh *mesh = space->mesh;
    const uint32_t *at = (mesh->triangle_uv ? mesh->triangle_uv : mesh->triangles)[point->triangle];
    const double *corner[3] = { mesh->uv[at[0]], mesh->uv[at[1]], mesh->uv[at[2]] };
    double side[3][3], n[3], across[2][3], steepest2 = 0;
    const double scale = sides_of(mesh, point->triangle, point->p, side);
    vec_cross(n, side[0], side[1]);
    vec_cross(across[0], side[1], n);
    vec_cross(across[1], n, side[0]);
    const double n2 = vec_dot(n, n), per = scale / n2, w1 = vec_dot(across[0], side[2]) / n2,
                 w2 = vec_dot(across[1], side[2]) / n2;
    for (int k = 0; k < 2; k++) {
        const double u0 = corner[0][k], d1 = corner[1][k] - u0, d2 = corner[2][k] - u0;
        const double low = fmin(u0, fmin(corner[1][k], corner[2][k])),
                     high = fmax(u0, fmax(corner[1][k], corner[2][k]));
        out->at[k] = fmin(fmax(u0 + (w1 * d1 + w2 * d2), low), high);
        for (int c = 0; c < 3; c++)
            out->slope[k][c] = (d1 * across[0][c] + d2 * across[1][c]) * per;
        steepest2 = fmax(steepest2, vec_dot(out->slope[k], out->slope[k]));
    }
    out->unit = 1 / sqrt(steepest2);
}

void glint_surface_uv_at(const glint_pattern_space *space, const glint_uv_point *point, glint_surface_uv *out)
{
    *out = (glint_surface_uv) { .unit = 1 };
    if (space->kind == GLINT_SHAPE_MESH)
        mesh_uv(space, point, out);
    else if (space->kind == GLINT_SHAPE_BOX)
        box_uv(space, point, out);
    else if (space->kind == GLINT_SHAPE_SPHERE || space->kind == GLINT_SHAPE_SPHERES)
        ball_uv(point->from_center, out);
    else if (space->kind == GLINT_SHAPE_TORUS)
        torus_uv(space, point->p, out);
    else
        axis_uv(space, point->p, out);
}
