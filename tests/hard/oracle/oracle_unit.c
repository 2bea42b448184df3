#include "tests/hard/oracle/oracle_unit.h"

#include <math.h>

static quad size_of(quad x) { return x < 0 ? -x : x; }

static void cut(unit_span *s, quad from, quad to)
{
    s->t[0] = from > s->t[0] ? from : s->t[0];
    s->t[1] = to < s->t[1] ? to : s->t[1];
    s->hit = s->hit && s->t[0] <= s->t[1];
}

static void cut_slab(unit_span *s, quad f, quad e, quad low, quad high)
{
    if (e == 0) {
        s->hit = s->hit && f >= low && f <= high;
        return;
    }
    const quad a = (low - f) / e, b = (high - f) / e;
    cut(s, a < b ? a : b, a < b ? b : a);
}

/// Cuts the span to a t^2 + 2 b t + c <= 0.
static void cut_quadric(unit_span *s, quad a, quad b, quad c)
{
    const quad disc = b * b - a * c;
    if (a == 0) {
        s->hit = s->hit && c <= 0;
        return;
    }
    if (disc < 0) {
        s->hit = false;
        return;
    }
    const quad root = sqrtf128(disc), q = b > 0 ? -b - root : -b + root, t0 = q / a, t1 = q == 0 ? t0 : c / q;
    cut(s, t0 < t1 ? t0 : t1, t0 < t1 ? t1 : t0);
}

/// Cuts the span to one nappe of the double cone: x^2 + y^2 <= (z + g)^2 for z >= -g.
static void cut_cone(unit_span *s, const unit_ray *r, quad g)
{
    const quad z = r->f[2] + g, ez = r->e[2], huge = (quad)HUGE_VAL;
    const quad a = r->e[0] * r->e[0] + r->e[1] * r->e[1] - ez * ez, b = r->f[0] * r->e[0] + r->f[1] * r->e[1] - z * ez,
               c = r->f[0] * r->f[0] + r->f[1] * r->f[1] - z * z, disc = b * b - a * c;
    cut_slab(s, z, ez, 0, huge);
    if (!s->hit)
        return;
    if (a == 0 && b == 0) {
        s->hit = c <= 0;
    } else if (a == 0) {
        const quad t = -c / (2 * b);
        if (b > 0)
            cut(s, s->t[0], t);
        else
            cut(s, t, s->t[1]);
    } else if (a > 0 || disc < 0) {
        if (disc < 0)
            s->hit = s->hit && a < 0;
        else
            cut_quadric(s, a, b, c);
    } else { // steeper than the side: the ray is outside between the roots; z >= 0 leaves one of the two ends
        const quad root = sqrtf128(disc), q = b > 0 ? -b - root : -b + root, t0 = q / a, t1 = q == 0 ? t0 : c / q;
        if (ez > 0)
            cut(s, t0 < t1 ? t1 : t0, s->t[1]);
        else
            cut(s, s->t[0], t0 < t1 ? t0 : t1);
    }
}

/// Cuts with a disk. A plane that is offset by g moves the hit point in proportion to g and
/// to the ray's slope along the plane.
static void cut_disk(unit_span *s, const unit_ray *r, quad g)
{
    if (r->e[2] == 0) {
        s->hit = false;
        return;
    }
    const quad t = -r->f[2] / r->e[2], x = r->f[0] + t * r->e[0], y = r->f[1] + t * r->e[1];
    const quad radius = 1 + g + g * sqrtf128(r->e[0] * r->e[0] + r->e[1] * r->e[1]) / size_of(r->e[2]);
    *s = (unit_span) { radius >= 0 && x * x + y * y <= radius * radius, { t, t } };
}

// ---- The torus: a quartic along the ray, from the point nearest to the centre ----

#define DEGREE 4

static quad value_of(const quad *coefficient, int degree, quad x)
{
    quad sum = 0;
    for (int i = degree; i >= 0; i--)
        sum = sum * x + coefficient[i];
    return sum;
}

/// Finds a root between two points of opposite sign.
static quad root_between(const quad *coefficient, int degree, quad low, quad high)
{
    quad slope[DEGREE], x = (low + high) / 2;
    const bool rising = value_of(coefficient, degree, high) > 0;
    for (int i = 0; i < degree; i++)
        slope[i] = (i + 1) * coefficient[i + 1];
    for (int n = 0; n < 400; n++) {
        const quad y = value_of(coefficient, degree, x);
        *(((y > 0) == rising) ? &high : &low) = x;
        quad next = x - y / value_of(slope, degree - 1, x);
        if (!(next > low && next < high))
            next = (low + high) / 2;
        if (size_of(next - x) <= (quad)0x1p-108 * (1 + size_of(x)))
            break;
        x = next;
    }
    return x;
}

/// Computes the roots within -reach .. reach, in order: one between neighbouring roots of the derivative if the sign
/// changes. Returns the number of roots.
static int roots_of(const quad *coefficient, int degree, quad reach, quad *root)
{
    quad slope[DEGREE], turn[DEGREE + 2];
    int count = 0;
    if (degree == 0)
        return 0;
    for (int i = 0; i < degree; i++)
        slope[i] = (i + 1) * coefficient[i + 1];
    const int turns = roots_of(slope, degree - 1, reach, turn + 1);
    turn[0] = -reach;
    turn[turns + 1] = reach;
    for (int i = 0; i <= turns; i++)
        if ((value_of(coefficient, degree, turn[i]) > 0) != (value_of(coefficient, degree, turn[i + 1]) > 0))
            root[count++] = root_between(coefficient, degree, turn[i], turn[i + 1]);
    return count;
}

static void cut_torus(unit_span *s, const unit_ray *r, quad tube)
{
    quad p[3], root[DEGREE], along = 0, length2 = 0, away2 = 0;
    for (int c = 0; c < 3; c++) {
        along += r->f[c] * r->e[c];
        length2 += r->e[c] * r->e[c];
    }
    const quad length = sqrtf128(length2), start = -along / length2;
    for (int c = 0; c < 3; c++) {
        p[c] = r->f[c] + start * r->e[c];
        away2 += p[c] * p[c];
    }
    // (s^2 + a)^2 - 4 (x^2 + y^2)
    const quad a = away2 + 1 - tube * tube, ux = r->e[0] / length, uy = r->e[1] / length;
    const quad quartic[DEGREE + 1] = { a * a - 4 * (p[0] * p[0] + p[1] * p[1]), -8 * (p[0] * ux + p[1] * uy),
                                       2 * a - 4 * (ux * ux + uy * uy), 0, 1 };
    const int count = tube > 0 ? roots_of(quartic, DEGREE, 4, root) : 0;
    s->hit = false;
    for (int i = 0; i + 1 < count; i += 2)
        if (!s->hit || s->t[1] <= 0)
            *s = (unit_span) { true, { start + root[i] / length, start + root[i + 1] / length } };
}

int unit_parts(const glint_shape_desc *desc)
{
    return desc->kind == GLINT_SHAPE_BOX                                          ? 3
           : desc->kind == GLINT_SHAPE_CYLINDER || desc->kind == GLINT_SHAPE_CONE ? 2
                                                                                  : 1;
}

/// Cuts with one part: a slab of a box; for other shapes first the curved side, then the slab between the ends.
static void cut_part(unit_span *s, const glint_shape_desc *desc, int part, const unit_ray *r, quad g)
{
    const quad one = 1 + g;
    const quad aa = r->e[0] * r->e[0] + r->e[1] * r->e[1], bb = r->f[0] * r->e[0] + r->f[1] * r->e[1],
               cc = r->f[0] * r->f[0] + r->f[1] * r->f[1];
    if (desc->kind == GLINT_SHAPE_BOX)
        cut_slab(s, r->f[part], r->e[part], -one, one);
    else if (part == 1) // a cone has only one end; its side includes the apex
        cut_slab(s, r->f[2], r->e[2], desc->kind == GLINT_SHAPE_CONE ? -(quad)HUGE_VAL : -one, one);
    else if (desc->kind == GLINT_SHAPE_SPHERE)
        cut_quadric(s, aa + r->e[2] * r->e[2], bb + r->f[2] * r->e[2], cc + r->f[2] * r->f[2] - one * one);
    else if (desc->kind == GLINT_SHAPE_CYLINDER)
        cut_quadric(s, aa, bb, cc - one * one);
    else if (desc->kind == GLINT_SHAPE_CONE)
        cut_cone(s, r, g);
    else if (desc->kind == GLINT_SHAPE_TORUS)
        cut_torus(s, r, (quad)desc->minor / desc->major + g);
    else
        cut_disk(s, r, g);
}

static unit_span everywhere(void) { return (unit_span) { true, { -(quad)HUGE_VAL, (quad)HUGE_VAL } }; }

unit_span unit_meet(const glint_shape_desc *desc, const unit_ray *r, quad g)
{
    unit_span s = everywhere();
    for (int part = 0; part < unit_parts(desc); part++)
        cut_part(&s, desc, part, r, g);
    return s;
}

bool unit_may_end(const glint_shape_desc *desc, int part, const unit_ray *r, quad g, int end, const unit_span *grown)
{
    unit_span s = everywhere();
    cut_part(&s, desc, part, r, -g);
    return s.hit && (end == 0 ? s.t[0] >= grown->t[0] : s.t[1] <= grown->t[1]);
}

int unit_first_ahead(const unit_span *s) { return !s->hit ? 2 : s->t[0] > 0 ? 0 : s->t[1] > 0 ? 1 : 2; }

void unit_normal(const glint_shape_desc *desc, int part, const unit_ray *r, int end, quad t, quad n[3])
{
    quad k[3];
    for (int c = 0; c < 3; c++) {
        k[c] = r->f[c] + t * r->e[c];
        n[c] = 0;
    }
    if (desc->kind == GLINT_SHAPE_SPHERE) {
        for (int c = 0; c < 3; c++)
            n[c] = k[c];
    } else if (desc->kind == GLINT_SHAPE_TORUS) {
        const quad round = sqrtf128(k[0] * k[0] + k[1] * k[1]);
        n[0] = k[0] - k[0] / round;
        n[1] = k[1] - k[1] / round;
        n[2] = k[2];
    } else if (desc->kind == GLINT_SHAPE_DISK) {
        n[2] = 1;
    } else if (desc->kind == GLINT_SHAPE_BOX || part == 1) {
        const int axis = desc->kind == GLINT_SHAPE_BOX ? part : 2;
        n[axis] = (r->e[axis] > 0) == (end == 1) ? 1 : -1; // the normal points against the ray where the ray enters
    } else {
        const quad round = sqrtf128(k[0] * k[0] + k[1] * k[1]);
        n[0] = k[0] / round;
        n[1] = k[1] / round;
        n[2] = desc->kind == GLINT_SHAPE_CONE ? -1 : 0;
    }
}

quad unit_bend(const glint_shape_desc *desc, int part, const unit_ray *r, quad t)
{
    if (part != 0 || desc->kind == GLINT_SHAPE_BOX || desc->kind == GLINT_SHAPE_DISK)
        return 0;
    if (desc->kind == GLINT_SHAPE_TORUS)
        return desc->major / desc->minor + desc->major / (desc->major - desc->minor);
    return desc->kind == GLINT_SHAPE_CONE ? 1 / (r->f[2] + t * r->e[2]) : 1;
}
