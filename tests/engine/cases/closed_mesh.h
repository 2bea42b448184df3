/// Random closed meshes with dents and peaks, and point-in-mesh tests that count crossings in 113-bit arithmetic.
#ifndef GLINT_TESTS_CLOSED_MESH_H
#define GLINT_TESTS_CLOSED_MESH_H

#include "engine/glint.h"

#include <string.h>

#include "tests/engine/cases/random.h"
#include "tests/engine/quad.h"

enum { CLOSED_TRIANGLES = 64 };

typedef struct closed_mesh {
    int count;
    double corner[CLOSED_TRIANGLES][3][3];
} closed_mesh;

static inline void add_closed_triangle(closed_mesh *mesh, const double a[3], const double b[3], const double c[3])
{
    double(*corner)[3] = mesh->corner[mesh->count++];
    memcpy(corner[0], a, 3 * sizeof *a);
    memcpy(corner[1], b, 3 * sizeof *b);
    memcpy(corner[2], c, 3 * sizeof *c);
}

/// A closed mesh of 32 triangles around `middle`: a subdivided octahedron whose 18 vertices have random distances.
static inline void make_star(closed_mesh *mesh, const double middle[3], double low, double high)
{
    double at[3][3][3][3]; // the vertices, indexed by 1 plus -1, 0 or 1 along each axis
    for (int i = 0; i < 27; i++) {
        const double way[3] = { i / 9 - 1.0, i / 3 % 3 - 1.0, i % 3 - 1.0 };
        const double far = between(low, high) / (1 + 0.4 * (way[0] * way[0] + way[1] * way[1] + way[2] * way[2] - 1));
        for (int c = 0; c < 3; c++)
            at[i / 9][i / 3 % 3][i % 3][c] = middle[c] + far * way[c];
    }
    for (int octant = 0; octant < 8; octant++) {
        const int x = octant & 1 ? 2 : 0, y = octant & 2 ? 2 : 0, z = octant & 4 ? 2 : 0;
        const bool odd = (x + y + z) / 2 % 2 == 0; // keeps the corners of every face counter-clockwise
        const double *tip[3] = { at[x][1][1], odd ? at[1][1][z] : at[1][y][1], odd ? at[1][y][1] : at[1][1][z] };
        const double *side[3] = { odd ? at[x][1][z] : at[x][y][1], at[1][y][z], odd ? at[x][y][1] : at[x][1][z] };
        for (int j = 0; j < 3; j++)
            add_closed_triangle(mesh, tip[j], side[j], side[(j + 2) % 3]);
        add_closed_triangle(mesh, side[0], side[1], side[2]);
    }
}

/// An axis-aligned box.
static inline void make_box(closed_mesh *mesh, const double low[3], const double high[3])
{
    static const int faces[6][4] = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };
    double at[8][3];
    for (int i = 0; i < 8; i++)
        for (int c = 0; c < 3; c++)
            at[i][c] = i >> c & 1 ? high[c] : low[c];
    for (int i = 0; i < 6; i++) {
        const int *f = faces[i];
        add_closed_triangle(mesh, at[f[0]], at[f[1]], at[f[2]]);
        add_closed_triangle(mesh, at[f[0]], at[f[2]], at[f[3]]);
    }
}

static inline void random_closed_mesh(closed_mesh *mesh)
{
    double middle[3], high[3];
    mesh->count = 0;
    for (int c = 0; c < 3; c++) {
        middle[c] = between(-0.5, 0.5);
        high[c] = middle[c] + between(0.5, 1.5);
    }
    if (one_in(3)) {
        make_box(mesh, middle, high);
        return;
    }
    make_star(mesh, middle, 0.3, 1.4);
    if (one_in(3)) { // adds a second box, separate or overlapping
        for (int c = 0; c < 3; c++)
            middle[c] += between(-1.5, 1.5);
        make_star(mesh, middle, 0.2, 0.8);
    }
}

/// Creates a shape from the mesh; `inverted` reverses the winding of the triangles. Every corner has its own vertex,
/// so that triangles are connected only by equal positions.
static inline glint_shape *closed_mesh_shape(const closed_mesh *mesh, bool inverted, glint_shading shading, const glint_transform *map)
{
    glint_shape *shape;
    glint_mesh_desc d = glint_mesh_desc_default();
    uint32_t corners[3 * CLOSED_TRIANGLES], sizes[CLOSED_TRIANGLES];
    for (int i = 0; i < 3 * mesh->count; i++) {
        corners[i] = (uint32_t)(inverted ? i / 3 * 3 + 2 - i % 3 : i);
        sizes[i / 3] = 3;
    }
    d.vertices = &mesh->corner[0][0][0];
    d.vertex_count = 3 * (size_t)mesh->count;
    d.corners = corners;
    d.face_sizes = sizes;
    d.face_count = (size_t)mesh->count;
    d.has_shading = true;
    d.shading = shading;
    d.transform = *map;
    return glint_mesh_create(&d, &shape, NULL) ? NULL : shape;
}

static inline quad corner_side(const quad p[3], const quad q[3], const double d[3])
{
    return (p[1] * q[2] - p[2] * q[1]) * d[0] + (p[2] * q[0] - p[0] * q[2]) * d[1] + (p[0] * q[1] - p[1] * q[0]) * d[2];
}

/// Returns 1 if the ray leaves the mesh through the triangle, -1 if it enters, 0 if it does not cross the triangle.
/// *t gets the distance. If the ray passes within 1e-9 of an edge, *sure becomes false.
static inline int quad_crossing(double corner[3][3], const quad from[3], const double d[3], quad *t, bool *sure)
{
    quad p[3][3], side[3], n[3], f[3], g[3], volume = 0, rise = 0;
    for (int j = 0; j < 3; j++)
        for (int c = 0; c < 3; c++)
            p[j][c] = (quad)corner[j][c] - from[c];
    for (int c = 0; c < 3; c++) {
        f[c] = p[1][c] - p[0][c];
        g[c] = p[2][c] - p[0][c];
    }
    for (int c = 0; c < 3; c++) {
        n[c] = f[(c + 1) % 3] * g[(c + 2) % 3] - f[(c + 2) % 3] * g[(c + 1) % 3];
        side[c] = corner_side(p[c], p[(c + 1) % 3], d);
    }
    for (int c = 0; c < 3; c++) {
        volume += n[c] * p[0][c];
        rise += n[c] * d[c];
        if (side[c] < 1e-9 && side[c] > -1e-9)
            *sure = false;
    }
    *t = rise != 0 ? volume / rise : 0;
    if (side[0] > 0 && side[1] > 0 && side[2] > 0)
        return 1;
    return side[0] < 0 && side[1] < 0 && side[2] < 0 ? -1 : 0;
}

/// Returns how many meshes contain the point (negative for inverted winding), using a ray that passes close to no edge.
static inline int times_inside(closed_mesh *mesh, const quad place[3])
{
    for (int attempt = 0; attempt < 64; attempt++) {
        const double d[3] = { 0.36 + 0.01 * attempt, 0.48 - 0.003 * attempt, 0.8 };
        bool sure = true;
        int exits = 0;
        for (int i = 0; i < mesh->count; i++) {
            quad t;
            const int way = quad_crossing(mesh->corner[i], place, d, &t, &sure);
            exits += t > 0 ? way : 0;
        }
        if (sure)
            return exits;
    }
    return 0;
}

#endif
