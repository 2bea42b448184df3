#include "tests/hard/oracle/aim_solid.h"

#include <math.h>

const char *const solid_names[SOLID_KINDS] = { "sphere, transformed", "box", "disk", "cylinder", "cone", "torus", "triangle" };
static const glint_shape_kind kinds[] = { GLINT_SHAPE_SPHERE, GLINT_SHAPE_BOX, GLINT_SHAPE_DISK, GLINT_SHAPE_CYLINDER,
                                          GLINT_SHAPE_CONE,   GLINT_SHAPE_TORUS };

// ---- Shapes ----

static glint_transform random_map(double move)
{
    glint_transform map = glint_transform_identity(), next;
    double axis[3], by[3];
    for (int i = 0; i < 2; i++) { // scale, rotate, scale, rotate: together these shear
        for (int c = 0; c < 3; c++)
            by[c] = (chance(0.2) ? -1 : 1) * log_uniform(0.1, 10);
        next = glint_transform_scale(by);
        map = glint_transform_product(&next, &map);
        random_direction(axis);
        next = glint_transform_rotate_deg(axis, chance(0.3) ? 90 : uniform(0, 360));
        map = glint_transform_product(&next, &map);
    }
    for (int c = 0; c < 3; c++)
        by[c] = uniform(-1, 1) * move;
    next = glint_transform_translate(by);
    return glint_transform_product(&next, &map);
}

/// Returns a map that undoes the flattening of a cylinder or cone: the result is rotated, about `size` large, and
/// about as wide as high.
static glint_transform undoing_map(const glint_shape_desc *d, double size)
{
    double n[3], x[3], away[3], turn[3], length = 0;
    glint_transform map = glint_transform_identity();
    random_direction(away);
    random_direction(turn);
    for (int c = 0; c < 3; c++)
        length = hypot(length, n[c] = d->base[c] - d->top[c]);
    for (int c = 0; c < 3; c++)
        n[c] /= length;
    for (int c = 0; c < 3; c++)
        x[c] = n[(c + 1) % 3] * away[(c + 2) % 3] - n[(c + 2) % 3] * away[(c + 1) % 3];
    const double across = hypot(hypot(x[0], x[1]), x[2]);
    for (int c = 0; c < 3; c++)
        x[c] /= across;
    for (int c = 0; c < 3; c++) {
        map.m[0][c] = size / d->radius * x[c];
        map.m[1][c] = size / d->radius * (n[(c + 1) % 3] * x[(c + 2) % 3] - n[(c + 2) % 3] * x[(c + 1) % 3]);
        map.m[2][c] = size / length * n[c];
    }
    const glint_transform turned = glint_transform_rotate_deg(turn, uniform(0, 360));
    return glint_transform_product(&turned, &map);
}

static void place(double v[3], double at, double size)
{
    for (int c = 0; c < 3; c++)
        v[c] = (c == 0 ? at : -0.3 * at) + uniform(-1, 1) * size;
}

hard_solid solid_random(int kind, double *size)
{
    hard_solid s = { .is_triangle = kind == SOLID_KINDS - 1 };
    *size = log_uniform(1e-6, 1e6);
    const double at = chance(0.5) ? 0 : *size * log_uniform(1, 1e5);
    if (s.is_triangle) {
        for (int j = 0; j < 3; j++)
            place(s.corner[j], at, *size);
        if (chance(0.2)) // a sliver
            for (int c = 0; c < 3; c++)
                s.corner[2][c] = s.corner[1][c] + (s.corner[2][c] - s.corner[1][c]) * log_uniform(1e-6, 1e-1);
        return s;
    }
    s.desc = glint_shape_desc_default(kinds[kind]);
    place(s.desc.center, at, 0);
    place(s.desc.base, at, *size);
    place(s.desc.top, at, *size);
    random_direction(s.desc.normal);
    random_direction(s.desc.axis);
    s.desc.major = *size * uniform(0.3, 1);
    s.desc.minor = s.desc.major * (chance(0.3)   ? log_uniform(1e-6, 1)
                                   : chance(0.2) ? 1 - log_uniform(1e-3, 1)
                                                 : uniform(0.1, 0.9));
    s.desc.radius = *size * (chance(0.3) ? log_uniform(1e-3, 1) : uniform(0.3, 1));
    for (int c = 0; c < 3; c++) {
        s.desc.min[c] = s.desc.center[c] - *size * log_uniform(0.05, 1);
        s.desc.max[c] = s.desc.center[c] + *size * log_uniform(0.05, 1);
    }
    const bool pillar = kinds[kind] == GLINT_SHAPE_CYLINDER || kinds[kind] == GLINT_SHAPE_CONE;
    if (pillar && chance(0.3)) {
        const double flat = log_uniform(1e-5, 1);
        for (int c = 0; c < 3; c++)
            s.desc.base[c] = s.desc.top[c] + flat * (s.desc.base[c] - s.desc.top[c]);
        s.desc.transform = undoing_map(&s.desc, *size);
    } else if (kind == 0 || chance(0.6)) {
        s.desc.transform = random_map(chance(0.5) ? 0 : at);
    }
    return s;
}

static glint_shape *make_shape(const hard_solid *s, glint_material *material)
{
    glint_shape *shape;
    glint_error error;
    if (!s->is_triangle) {
        glint_shape_desc desc = s->desc;
        desc.material = material;
        must(glint_shape_create(&desc, &shape, &error), &error);
        return shape;
    }
    const uint32_t corners[3] = { 0, 1, 2 }, three = 3;
    glint_mesh_desc desc = glint_mesh_desc_default();
    desc.material = material;
    desc.vertices = s->corner[0];
    desc.vertex_count = 3;
    desc.corners = corners;
    desc.face_sizes = &three;
    desc.face_count = 1;
    must(glint_mesh_create(&desc, &shape, &error), &error);
    return shape;
}

glint_scene *solid_alone(const hard_solid *s, glint_material *material)
{
    glint_error error;
    glint_scene *scene = scene_new();
    glint_shape *shape = make_shape(s, material);
    must(glint_scene_add_shape(scene, shape, &error), &error);
    glint_shape_release(shape);
    return scene;
}

// ---- Rays ----

/// Chooses a point on or next to the shape before its map: on its surface, silhouette, an edge or a corner.
static void some_point(const hard_solid *s, double p[3])
{
    const double turn = uniform(0, 6.3),
                 w = chance(0.3)   ? 0
                     : chance(0.1) ? 1 - log_uniform(1e-8, 1) // a point on a cone, next to the apex
                                   : uniform(0, 1),
                 v = chance(0.3) ? 0 : uniform(0, 1 - w);
    double k[3], a[3], b[3], along[3];
    const glint_shape_desc *d = &s->desc;
    random_direction(k);
    if (s->is_triangle) {
        const int j = (int)(random_bits() % 3);
        for (int c = 0; c < 3; c++)
            p[c] = s->corner[j][c] + w * (s->corner[(j + 1) % 3][c] - s->corner[j][c]) +
                   v * (s->corner[(j + 2) % 3][c] - s->corner[j][c]);
        return;
    }
    for (int c = 0; c < 3; c++)
        along[c] = d->kind == GLINT_SHAPE_DISK    ? d->normal[c]
                   : d->kind == GLINT_SHAPE_TORUS ? d->axis[c]
                                                  : d->top[c] - d->base[c];
    const double length = hypot(hypot(along[0], along[1]), along[2]);
    const int least = fabs(along[0]) < fabs(along[1]) ? 0 : 1;
    for (int c = 0; c < 3; c++)
        along[c] /= length;
    for (int c = 0; c < 3; c++) {
        const double axis[3] = { least == 0, least == 1, 0 };
        a[c] = axis[(c + 1) % 3] * along[(c + 2) % 3] - axis[(c + 2) % 3] * along[(c + 1) % 3];
    }
    const double al = hypot(hypot(a[0], a[1]), a[2]);
    for (int c = 0; c < 3; c++)
        a[c] /= al;
    for (int c = 0; c < 3; c++)
        b[c] = along[(c + 1) % 3] * a[(c + 2) % 3] - along[(c + 2) % 3] * a[(c + 1) % 3];
    const double taper = d->kind == GLINT_SHAPE_CONE                  ? 1 - w
                         : d->kind == GLINT_SHAPE_DISK && chance(0.7) ? sqrt(uniform(0, 1))
                                                                      : 1;
    const double within =
        (d->kind == GLINT_SHAPE_CONE || d->kind == GLINT_SHAPE_CYLINDER) && w == 0 ? uniform(0, 1) : 1;
    // around a torus's tube: often its outermost, highest, innermost or lowest circle
    const double across = chance(0.5) ? (double)(random_bits() % 4) * 1.5707963267948966 : uniform(0, 6.3);
    for (int c = 0; c < 3; c++) {
        const double from_axis = (d->major + d->minor * cos(across)) * (cos(turn) * a[c] + sin(turn) * b[c]);
        const double round = d->radius * taper * within * (cos(turn) * a[c] + sin(turn) * b[c]);
        const double box = chance(0.6) ? (chance(0.5) ? d->min[c] : d->max[c]) : uniform(d->min[c], d->max[c]);
        p[c] = d->kind == GLINT_SHAPE_SPHERE ? d->center[c] + d->radius * k[c]
               : d->kind == GLINT_SHAPE_BOX  ? box
               : d->kind == GLINT_SHAPE_DISK ? d->center[c] + round
               : d->kind == GLINT_SHAPE_TORUS ? d->center[c] + from_axis + d->minor * sin(across) * along[c]
                                              : d->base[c] + w * (d->top[c] - d->base[c]) + round;
    }
}

static void to_world(const hard_solid *s, double p[3])
{
    const double q[3] = { p[0], p[1], p[2] };
    for (int i = 0; i < 3 && !s->is_triangle; i++)
        p[i] =
            ((s->desc.transform.m[i][0] * q[0] + s->desc.transform.m[i][1] * q[1]) + s->desc.transform.m[i][2] * q[2]) +
            s->desc.transform.m[i][3];
}

/// Chooses a point close to the line from a point of a cone through the apex: on this side of the apex, or beyond it,
/// for a ray down the side of the other nappe of the double cone.
static void along_side(const hard_solid *s, const double p[3], double size, double out[3])
{
    const double way = (chance(0.3) ? -1 : 1) * log_uniform(0.1, 10), nudge = size * log_uniform(1e-9, 0.1);
    for (int c = 0; c < 3; c++)
        out[c] = s->desc.top[c] + way * (s->desc.top[c] - p[c]) + nudge * uniform(-1, 1);
}

/// Chooses a point on a tangent at a point of a torus, at distance `reach`,
/// so that a ray from there nearly touches the torus.
static void beside(const hard_solid *s, const double p[3], double reach, double out[3])
{
    const glint_shape_desc *d = &s->desc;
    double n[3], away[3], along = 0, off = 0, length = 0, round = 0, level = 0, from_axis[3];
    random_direction(away);
    for (int c = 0; c < 3; c++)
        level += d->axis[c] * (p[c] - d->center[c]); // random_solid makes the axis a unit vector
    for (int c = 0; c < 3; c++)
        round = hypot(round, from_axis[c] = p[c] - d->center[c] - level * d->axis[c]);
    for (int c = 0; c < 3; c++)
        off = hypot(off, n[c] = p[c] - d->center[c] - d->major / round * from_axis[c]);
    for (int c = 0; c < 3; c++)
        along += away[c] * n[c] / off;
    for (int c = 0; c < 3; c++)
        length = hypot(length, away[c] -= along * n[c] / off);
    for (int c = 0; c < 3; c++)
        out[c] = p[c] + away[c] / length * reach;
}

hard_ray solid_aim(const hard_solid *s, double size)
{
    hard_ray ray;
    double p[3], q[3], away[3], reach = size * (chance(0.3) ? uniform(0, 2) : log_uniform(1, 1e6));
    const double by = chance(0.3) ? 0 : size * log_uniform(1e-16, 1e-2);
    some_point(s, p);
    some_point(s, q);
    const bool along = !s->is_triangle && s->desc.kind == GLINT_SHAPE_CONE && chance(0.2);
    if (along)
        along_side(s, p, size, q);
    const bool touching = !s->is_triangle && s->desc.kind == GLINT_SHAPE_TORUS && chance(0.4);
    if (touching)
        beside(s, p, reach, q);
    to_world(s, p);
    to_world(s, q);
    random_direction(away);
    // all points of a flat shape are in one plane
    const bool flat = s->is_triangle || s->desc.kind == GLINT_SHAPE_DISK;
    const int way = along || touching ? 0 : flat && chance(0.8) ? 2 : (int)(random_bits() % 4);
    for (int c = 0; c < 3; c++) {
        p[c] += by * uniform(-1, 1);
        const double far = q[c] + (q[c] - p[c]) * log_uniform(1e-3, 1e3);
        ray.o[c] = way == 0 ? q[c] : way == 1 ? far : p[c] + away[c] * reach;
        ray.d[c] = p[c] - ray.o[c];
    }
    if (chance(0.1)) // a ray along an axis
        for (int c = 0, keep = (int)(random_bits() % 3); c < 3; c++)
            ray.d[c] = c == keep ? ray.d[c] : 0;
    if (ray.d[0] == 0 && ray.d[1] == 0 && ray.d[2] == 0)
        ray.d[2] = 1;
    const double length = chance(0.2) ? log_uniform(1e-30, 1e30) : 1;
    for (int c = 0; c < 3; c++)
        ray.d[c] *= length;
    return ray;
}
