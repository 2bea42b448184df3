/// Rays at tori where a quartic is hardest, against 113-bit arithmetic: thin and fat, from far away, tangent, along
/// the axis, in the equator's plane and across the highest circle. An answer is undecidable when rounding could
/// change it: rounding of the torus's numbers, or of the path to the torus, by 8 2^-53 times the condition of the
/// torus's map and the distance (oracle/oracle_solid.h). All other answers must be right.
#include "tests/hard/oracle/aim_solid.h"

#include <string.h>

#define ROUNDING 8

/// A torus and the axes of the torus's own space: x, y and the axis of rotation.
typedef struct ring {
    hard_solid solid;
    double axes[3][3];
    double tube; ///< minor radius / major radius
} ring;

/// Aims a ray at the torus in units of the major radius, with its axis along z.
typedef void aim_at(const ring *r, double o[3], double toward[3]);

typedef struct class_of {
    const char *name;
    double least, most; ///< range of minor radius / major radius, which is log-uniform
    aim_at *aim;
    double hits; ///< minimum share of rays that must hit
} class_of;

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

static ring random_ring(const class_of *k)
{
    ring r = { .solid = { .desc = glint_shape_desc_default(GLINT_SHAPE_TORUS) } };
    glint_shape_desc *d = &r.solid.desc;
    double other[3], length = 0;
    const double size = log_uniform(1e-4, 1e4);
    if (chance(0.5))
        random_direction(d->axis);
    random_direction(other);
    for (int c = 0; c < 3; c++) {
        d->center[c] = chance(0.5) ? 0 : size * uniform(-2, 2);
        r.axes[2][c] = d->axis[c];
    }
    cross(other, r.axes[2], r.axes[0]);
    for (int c = 0; c < 3; c++)
        length = hypot(length, r.axes[0][c]);
    for (int c = 0; c < 3; c++)
        r.axes[0][c] /= length;
    cross(r.axes[2], r.axes[0], r.axes[1]);
    r.tube = log_uniform(k->least, k->most);
    d->major = size;
    d->minor = size * r.tube;
    return r;
}

/// Computes a point on the torus and the outward normal there.
static void place_on(const ring *r, double across, double p[3], double n[3])
{
    const double around = uniform(0, 6.3);
    n[0] = cos(across) * cos(around);
    n[1] = cos(across) * sin(around);
    n[2] = sin(across);
    p[0] = cos(around) + r->tube * n[0];
    p[1] = sin(around) + r->tube * n[1];
    p[2] = r->tube * n[2];
}

static double past(const ring *r) { return chance(0.3) ? 0 : (chance(0.5) ? -1 : 1) * r->tube * log_uniform(1e-12, 1); }

static void from_anywhere(const ring *r, double o[3], double toward[3])
{
    double n[3];
    random_direction(o);
    place_on(r, uniform(0, 6.3), toward, n);
    const double way = log_uniform(0.1, 100);
    for (int c = 0; c < 3; c++)
        o[c] = toward[c] + o[c] * way;
}

static void from_afar(const ring *r, double o[3], double toward[3])
{
    double n[3];
    random_direction(o);
    place_on(r, uniform(0, 6.3), toward, n);
    const double way = log_uniform(1e5, 1e7);
    for (int c = 0; c < 3; c++) {
        o[c] = toward[c] + o[c] * way;
        toward[c] += past(r) * n[c];
    }
}

/// Aims along a tangent at a point: slightly outside or inside the surface, or exactly on it.
static void touching_at(const ring *r, double across, double o[3], double toward[3])
{
    double n[3], away[3], side[3], off = past(r);
    place_on(r, across, toward, n);
    random_direction(away);
    cross(n, away, side);
    const double way = log_uniform(0.01, 1000);
    for (int c = 0; c < 3; c++) {
        toward[c] += off * n[c];
        o[c] = toward[c] + side[c] * way;
    }
}

static void touching(const ring *r, double o[3], double toward[3]) { touching_at(r, uniform(0, 6.3), o, toward); }

static void over_the_top(const ring *r, double o[3], double toward[3])
{
    touching_at(r, chance(0.5) ? 1.5707963267948966 : -1.5707963267948966, o, toward);
}

static void along_axis(const ring *r, double o[3], double toward[3])
{
    double n[3];
    place_on(r, chance(0.5) ? 3.141592653589793 : uniform(0, 6.3), toward, n);
    const double off = past(r), way = log_uniform(0.1, 100);
    for (int c = 0; c < 3; c++) {
        toward[c] += off * n[c];
        o[c] = toward[c];
    }
    o[2] += way;
}

static void in_equator(const ring *r, double o[3], double toward[3])
{
    const double around = uniform(0, 6.3), off = past(r), way = log_uniform(0.1, 100);
    const bool touches = chance(0.5); // whether the ray is perpendicular to the radius at its nearest point
    const double reach = touches ? 1 + (chance(0.5) ? -1 : 1) * r->tube + off : uniform(0, 1.5);
    const double along = touches ? around + 1.5707963267948966 : uniform(0, 6.3);
    toward[0] = reach * cos(around);
    toward[1] = reach * sin(around);
    toward[2] = chance(0.7) ? 0 : off;
    o[0] = toward[0] + way * cos(along);
    o[1] = toward[1] + way * sin(along);
    o[2] = toward[2];
}

static const class_of classes[] = {
    { "thin, 1e-6 .. 1e-4", 1e-6, 1e-4, from_anywhere, 0.8 },
    { "thin, 1e-6 .. 1e-4, touched", 1e-6, 1e-4, touching, 0.1 },
    { "fat, 0.99 .. 0.9999", 0.99, 0.9999, from_anywhere, 0.8 },
    { "fat, 0.99 .. 0.9999, touched", 0.99, 0.9999, touching, 0.2 },
    { "from 1e5 .. 1e7 of its radii", 1e-2, 0.9, from_afar, 0.5 },
    { "touched anywhere", 1e-2, 0.9, touching, 0.2 },
    { "touched at its highest circles", 1e-2, 0.9, over_the_top, 0.1 },
    { "along the axis, at the hole's rim", 1e-3, 0.99, along_axis, 0.3 },
    { "in the equator's plane", 1e-3, 0.99, in_equator, 0.3 },
};

/// Returns the ray in world space, rounded.
static hard_ray ray_of(const ring *r, const double o[3], const double toward[3])
{
    const glint_shape_desc *d = &r->solid.desc;
    hard_ray ray;
    for (int c = 0; c < 3; c++) {
        double from = 0, to = 0;
        for (int k = 0; k < 3; k++) {
            from += r->axes[k][c] * o[k];
            to += r->axes[k][c] * toward[k];
        }
        ray.o[c] = d->center[c] + d->major * from;
        ray.d[c] = d->center[c] + d->major * to - ray.o[c];
    }
    if (ray.d[0] == 0 && ray.d[1] == 0 && ray.d[2] == 0)
        ray.d[0] = 1;
    return ray;
}

/// Returns the error in the engine's answer; NULL: none.
static const char *judge(const solid_truth *want, bool hit, const glint_hit *got)
{
    const double ulps = 4 * (nextafter(fabs(want->t), HUGE_VAL) - fabs(want->t));
    double off = 0;
    if (hit != want->hit)
        return "wrong decision";
    if (!hit)
        return NULL;
    if (!(got->t >= want->least - ulps && got->t <= want->most + ulps))
        return "t too far off";
    for (int c = 0; c < 3; c++)
        off = fmax(off, fabs(got->normal[c] - want->normal[0].n[c]));
    return off <= 1e-9 + want->normal[0].turn ? NULL : "normal too far off";
}

static void run(const class_of *k, uint64_t rays)
{
    uint64_t hits = 0, close = 0, wrong = 0;
    hard_test("torus", k->name);
    for (uint64_t i = 0; i < rays; i += 20) {
        const ring r = random_ring(k);
        glint_scene *scene = solid_alone(&r.solid, NULL);
        for (int n = 0; n < 20; n++) {
            double o[3], toward[3];
            glint_hit got = { 0 };
            k->aim(&r, o, toward);
            const hard_ray ray = ray_of(&r, o, toward);
            const bool hit = cast(scene, &ray, &got);
            const solid_truth want = oracle_solid(&ray, &r.solid, ROUNDING);
            const char *what = want.close ? NULL : judge(&want, hit, &got);
            close += want.close;
            hits += !want.close && want.hit;
            wrong += what != NULL;
            if (what)
                hard_check(false,
                           "%s: %a, %a, %a along %a, %a, %a at %a, %a, %a around %a, %a, %a, radii %a, %a: t %.17g "
                           "(%d), not %.17g (%d)",
                           what, ray.o[0], ray.o[1], ray.o[2], ray.d[0], ray.d[1], ray.d[2], r.solid.desc.center[0],
                           r.solid.desc.center[1], r.solid.desc.center[2], r.solid.desc.axis[0], r.solid.desc.axis[1],
                           r.solid.desc.axis[2], r.solid.desc.major, r.solid.desc.minor, got.t, hit, want.t, want.hit);
        }
        glint_scene_release(scene);
    }
    if (hard_table)
        printf("| %s | %llu | %llu | %llu | %llu |\n", k->name, (unsigned long long)rays, (unsigned long long)hits,
               (unsigned long long)close, (unsigned long long)wrong);
    hard_right(rays - wrong);
    hard_check((double)hits >= k->hits * (double)rays, "only %llu hits of %llu rays", (unsigned long long)hits,
               (unsigned long long)rays);
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    if (hard_table)
        printf("Tori, against 113 bits.\n\n| rays | how many | hits | too close to tell | wrong |\n"
               "| --- | --- | --- | --- | --- |\n");
    for (size_t i = 0; i < sizeof classes / sizeof *classes; i++)
        run(&classes[i], hard_rays / 200 / 20 * 20 + 20);
    return hard_end();
}
