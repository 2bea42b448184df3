/// Truth in 113 bits, with a bound on its own error. It is an order of magnitude faster than multiple precision, and
/// sufficient except for the few rays that are closer than 2^-46 to the border between hit and miss.
#include "tests/hard/oracle/oracle.h"
#include "tests/hard/oracle/quad.h"

/// A sum of products of the sizes below has an error below 16 roundings of 2^-113. A difference must be larger than
/// this error by the factor below to be accurate to 2^-63.
#define ENOUGH (16 * 0x1p-113 * 0x1p63)

static quad dot(const quad u[3], const quad v[3]) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

static quad magnitude(quad x) { return x < 0 ? -x : x; }

bool quick_sphere(const hard_ray *ray, const hard_sphere *sphere, truth *out)
{
    quad f[3], d[3];
    for (int i = 0; i < 3; i++) {
        f[i] = (quad)ray->o[i] - sphere->c[i];
        d[i] = ray->d[i];
    }
    const quad a = dot(d, d), b = dot(f, d), ff = dot(f, f), rr = (quad)sphere->r * sphere->r, c = ff - rr;
    const quad disc = b * b - a * c, size = ff + rr;
    if (magnitude(c) < (quad)ENOUGH * size || magnitude(disc) < (quad)ENOUGH * (size * a))
        return false;
    *out = (truth) { 0 };
    const quad reach = sqrtf128(ff) + sphere->r, distance = sqrtf128(ff > b * b / a ? ff - b * b / a : 0);
    out->surface = (double)(magnitude(c) / (reach * reach));
    out->tangency = (double)(magnitude(disc) / (a * (distance + sphere->r) * reach));
    if (disc < 0 || (c > 0 && b >= 0))
        return true;
    const quad s = sqrtf128(disc);
    const quad t = c > 0 ? c / (s - b) : b > 0 ? -c / (b + s) : (s - b) / a;
    out->hit = true;
    out->t = (double)t;
    for (int i = 0; i < 3; i++)
        out->n[i] = (double)((f[i] + t * d[i]) / sphere->r);
    out->cosine = (double)(s / (sqrtf128(a) * sphere->r));
    return true;
}

bool quick_plane(const hard_ray *ray, const hard_plane *plane, truth *out)
{
    quad f[3], n[3], d[3], f_size = 0, d_size = 0;
    double reach = 0;
    for (int i = 0; i < 3; i++) {
        f[i] = (quad)plane->p[i] - ray->o[i];
        n[i] = plane->n[i];
        d[i] = ray->d[i];
        f_size += magnitude(n[i] * f[i]);
        d_size += magnitude(n[i] * d[i]);
        reach += fabs(ray->o[i]) + fabs(plane->p[i]);
    }
    const quad h = dot(n, f), nd = dot(n, d), length = sqrtf128(dot(n, n));
    if (magnitude(h) < (quad)ENOUGH * f_size || magnitude(nd) < (quad)ENOUGH * d_size)
        return false;
    *out = (truth) { 0 };
    out->cosine = out->tangency = (double)(magnitude(nd) / (length * sqrtf128(dot(d, d))));
    out->surface = (double)(magnitude(h) / length) / (reach > 0 ? reach : 1);
    out->hit = ((h > 0 && nd > 0) || (h < 0 && nd < 0)) && out->cosine >= PARALLEL;
    if (out->hit) {
        out->t = (double)(h / nd);
        for (int i = 0; i < 3; i++)
            out->n[i] = (double)(n[i] / length);
    }
    return true;
}

truth true_sphere(const hard_ray *ray, const hard_sphere *sphere)
{
    truth out;
    return quick_sphere(ray, sphere, &out) ? out : oracle_sphere(ray, sphere);
}

truth true_plane(const hard_ray *ray, const hard_plane *plane)
{
    truth out;
    return quick_plane(ray, plane, &out) ? out : oracle_plane(ray, plane);
}

bool exact_difference(const double o[3], const double c[3])
{
    for (int i = 0; i < 3; i++) { // Knuth's error term of a difference
        const double s = o[i] - c[i], v = s - o[i];
        if ((o[i] - (s - v)) - (c[i] + v) != 0)
            return false;
    }
    return true;
}
