#include "tests/hard/oracle/judge.h"

#include <math.h>

const char *const verdict_name[] = { "right", "too close to tell", "wrong decision", "t too far off",
                                     "normal too far off" };

static double length(const double v[3]) { return hypot(hypot(v[0], v[1]), v[2]); }

double ulp_of(double x) { return nextafter(fabs(x), HUGE_VAL) - fabs(x); }

static double normal_error(const truth *want, const glint_hit *got)
{
    double error = 0;
    for (int c = 0; c < 3; c++) {
        const double e = fabs(got->normal[c] - want->n[c]);
        error = e <= error ? error : e; // keeps NaN
    }
    return error;
}

/// Returns whether t is within the checked range.
/// Outside the range of double, the engine's t must overflow or vanish as well.
static bool representable(double t) { return t > 0x1p-960 && t < 0x1p1020; }

static judgement judge(const truth *want, bool hit, const glint_hit *got, bool too_close, double t_allowed_ulp,
                       double normal_allowed)
{
    judgement j = { .verdict = RIGHT };
    if (too_close)
        return (judgement) { .verdict = TOO_CLOSE };
    if (hit != want->hit)
        return (judgement) { .verdict = WRONG_DECISION };
    if (!hit)
        return j;
    if (representable(want->t)) {
        j.ulp = fabs(got->t - want->t) / ulp_of(want->t);
        j.t_share = j.ulp / t_allowed_ulp;
        if (!(j.t_share <= 1))
            j.verdict = WRONG_T;
    }
    j.normal_share = normal_error(want, got) / normal_allowed;
    if (!(j.normal_share <= 1) && j.verdict == RIGHT)
        j.verdict = WRONG_NORMAL;
    return j;
}

judgement judge_sphere(const hard_ray *ray, const hard_sphere *sphere, const truth *want, bool hit,
                       const glint_hit *got)
{
    const bool exact = exact_difference(ray->o, sphere->c);
    const double f[3] = { ray->o[0] - sphere->c[0], ray->o[1] - sphere->c[1], ray->o[2] - sphere->c[2] };
    const double away = length(f), way = want->t * length(ray->d);
    // The relative change of the distance by half an ulp of d, of r (never more than by d, however short the
    // distance), and of o - c.
    const double magnified = (1 + fmin(1, sphere->r / way) + (exact ? 0 : away / way)) / want->cosine;
    // c = |f|^2 - r^2 is an error-free sum rounded to 106 bits. This is the relative error of c close to the surface.
    const double last_bits = 0x1p-51 / want->surface;
    const double normal = 8 * 0x1p-53 * (away + sphere->r) / sphere->r / want->cosine;
    return judge(want, hit, got, want->tangency < TANGENCY || (!exact && want->surface < SURFACE),
                 4 * fmax(1, magnified) + last_bits, fmax(1e-15, normal));
}

judgement judge_plane(const hard_ray *ray, const hard_plane *plane, const truth *want, bool hit, const glint_hit *got)
{
    const double n = length(plane->n), d = length(ray->d);
    double reach = 0, height = 0,
           climb = 0; // sums of the terms' sizes in n.(p - o) and n.d, relative to the results
    for (int c = 0; c < 3; c++) {
        const double place = fabs(ray->o[c]) + fabs(plane->p[c]), share = fabs(plane->n[c]) / n;
        reach += place;
        height += place * share;
        climb += fabs(ray->d[c]) / d * share;
    }
    height /= want->surface * reach;
    climb /= want->cosine;
    const bool parallel = fabs(want->cosine / PARALLEL - 1) < 1e-12;
    return judge(want, hit, got, parallel || !(height < 0x1p50) || !(climb < 0x1p50), 4 * fmax(1, fmax(height, climb)),
                 1e-15);
}
