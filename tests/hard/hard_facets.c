/// Microfacets with roughness 1 down to 1e-4, against multiple precision. The textbook's float formula loses the lobe
/// of a smooth surface in 1 - cos^2.
#include "tests/hard/oracle/oracle_light.h"
#include "tests/hard/oracle/point.h"

#include <string.h>

static const double black[3] = { 0 };

static glint_material *facets(bool beckmann, double roughness, double f0)
{
    glint_material *material;
    glint_error error;
    glint_material_desc desc = glint_material_desc_default();
    desc.model = GLINT_MODEL_COOK_TORRANCE;
    desc.distribution = beckmann ? GLINT_DISTRIBUTION_BECKMANN : GLINT_DISTRIBUTION_GGX;
    desc.roughness = roughness;
    desc.has_f0 = desc.has_specular = true;
    memcpy(desc.diffuse, black, sizeof desc.diffuse);
    for (int c = 0; c < 3; c++) {
        desc.f0[c] = f0;
        desc.specular[c] = 1;
    }
    must(glint_material_create(&desc, &material, &error), &error);
    return material;
}

/// D by the textbook's formula: alpha^2 / (pi (c^2 (alpha^2 - 1) + 1)^2).
#define NAIVE(name, real, cosine) \
    static double name(double alpha, double angle) \
    { \
        const real a2 = (real)alpha * (real)alpha, c = cosine((real)angle), x = c * c * (a2 - 1) + 1; \
        return (double)(a2 / ((real)M_PI * x * x)); \
    }
NAIVE(naive_float, float, cosf)
NAIVE(naive_double, double, cos)

/// Returns the allowed error, the sum of three: roundings of 2^-24; the same for Beckmann's exponent, whose cosine is
/// 1 minus a squared sine; and the rounding of the directions, which moves the half vector by 2^-52, or 2^-22 in
/// float, relative to the width of the lobe.
static double allowed(bool beckmann, double roughness, double want, double tangent, bool in_float)
{
    const double alpha = roughness * roughness, moved = (in_float ? 0x1p-21 : 0x1p-51) / alpha, at = tangent / alpha;
    // the derivative of log D with respect to the half vector's angle over alpha
    const double steep = beckmann ? 2 * at : 4 * at / (1 + at * at);
    return want * (0x1p-24 * (40 + (beckmann ? 8 * at * at * (1 + tangent * tangent) : 0)) +
                   (steep + moved) * moved * 2 * (1 + tangent * tangent));
}

/// Returns the tangent of the angle between n and the half vector h.
static double half_tangent(const double n[3], const double l[3], const double v[3])
{
    double h[3], along = 0, across = 0, ll = hypot(hypot(l[0], l[1]), l[2]), vv = hypot(hypot(v[0], v[1]), v[2]);
    for (int c = 0; c < 3; c++)
        h[c] = l[c] / ll + v[c] / vv;
    for (int c = 0; c < 3; c++) {
        const int i = (c + 1) % 3, k = (c + 2) % 3;
        across = hypot(across, n[i] * h[k] - n[k] * h[i]);
        along += n[c] * h[c];
    }
    return across / along;
}

/// Compares one pair of directions, by `evaluate` and in a frame in double.
/// Returns the larger error, relative to the allowed one.
static double compare(bool beckmann, double roughness, double f0, const double n[3], const double l[3],
                      const double v[3], hard_values *shown)
{
    glint_error error;
    glint_reflection got;
    glint_material *material = facets(beckmann, roughness, f0);
    const double want = oracle_facets(beckmann, roughness, f0, n, l, v);
    must(glint_material_evaluate(material, n, l, v, &got, &error), &error);
    // Beckmann's exponential is 0 below 2^-126, and 4 n.v is at least 4e-3.
    const double dark = beckmann ? 250 * 0x1p-126 / pow(roughness, 4) + 1e-30 : 1e-30;
    const double limit = allowed(beckmann, roughness, want, half_tangent(n, l, v), false) + dark;
    const double off = fabs(got.specular[1] - want);
    hard_check(off <= limit, "%s, roughness %g: %.10g, truth %.10g, off by %g where %g is allowed",
               beckmann ? "Beckmann" : "GGX", roughness, got.specular[1], want, off, limit);
    if (shown) {
        shown->truth = want;
        shown->in_double = point_reflection(material, n, l, v, GLINT_PRECISION_DOUBLE).specular[1];
        shown->in_float = point_reflection(material, n, l, v, GLINT_PRECISION_FLOAT).specular[1];
        hard_check(fabs(shown->in_double - want) <= limit, "a frame in double: %.10g, truth %.10g", shown->in_double,
                   want);
        hard_check(fabs(shown->in_float - want) <=
                       allowed(beckmann, roughness, want, half_tangent(n, l, v), true) + dark,
                   "a frame in float: %.10g, truth %.10g", shown->in_float, want);
    }
    glint_material_release(material);
    return off / limit;
}

/// P12, P13, and the same for Beckmann: l is at an angle of 2 `angle` from v = n, so that h is at `angle` from n.
/// `stated` is the known value of D.
static void check_lobe(const char *id, double alpha, double angle, double stated)
{
    const double v[3] = { 0, 0, 1 }, l[3] = { sin(2 * angle), 0, cos(2 * angle) };
    const double want = oracle_ggx(alpha, angle);
    hard_values shown;
    char what[64];
    hard_test(id, "small roughness");
    if (stated > 0)
        hard_check(fabs(want / stated - 1) < 1e-9, "oracle D %.12g, stated %.12g", want, stated);
    for (int beckmann = 0; beckmann < 2; beckmann++) {
        const double share = compare(beckmann, sqrt(alpha), 1, v, l, v, &shown);
        const double rest = want > 0 ? shown.truth / want : 0; // pi F G / (4 n.v)
        shown.naive_double = beckmann ? HARD_BLANK : naive_double(alpha, angle) * rest;
        shown.naive_float = beckmann ? HARD_BLANK : naive_float(alpha, angle) * rest;
        snprintf(what, sizeof what, "%s, alpha %g, h at %g", beckmann ? "Beckmann" : "GGX", alpha, angle);
        hard_row(id, what, &shown, share <= 1);
    }
}

/// Tests random roughness and directions, half of them inside the lobe.
static void sweep(uint64_t count)
{
    double worst = 0;
    hard_test("P12, P13", "roughness 1e-4 .. 1");
    for (uint64_t i = 0; i < count; i++) {
        const double roughness = log_uniform(1e-4, 1), f0 = chance(0.3) ? 1 : uniform(0, 1);
        double n[3], l[3], v[3], off[3], nl = 0, nv = 0;
        random_direction(n);
        random_direction(l);
        random_direction(v);
        random_direction(off);
        for (int c = 0; c < 3; c++)
            nl += n[c] * l[c];
        for (int c = 0; c < 3; c++) {
            l[c] *= nl < 0 ? -1 : 1;
            if (i % 2)
                v[c] = 2 * fabs(nl) * n[c] - l[c] + off[c] * 3 * roughness * roughness;
            nv += n[c] * v[c];
        }
        for (int c = 0; c < 3; c++)
            v[c] *= nv < 0 ? -1 : 1;
        if (fabs(nl) < 1e-3 || fabs(nv) < 1e-3)
            continue; // the sign of n.l or n.v depends on the rounding of a normal
        worst = fmax(worst, compare(chance(0.5), roughness, f0, n, l, v, NULL));
    }
    if (hard_table)
        printf("\n%llu pairs of directions, roughness 1e-4 .. 1: worst error %.2f of the bound.\n",
               (unsigned long long)count, worst);
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_columns("Microfacets: S = pi D F G / (4 n.v), white; D is 318309.886 in P12, 795.880826 in P13.");
    check_lobe("P12", 1e-3, 0, 318309.886184);
    check_lobe("P12", 1e-4, 0, 0);
    check_lobe("P12", 1e-8, 0, 0);
    check_lobe("P12", 1e-3, 1e-3, 0);
    check_lobe("P12", 1e-4, 3e-4, 0);
    check_lobe("P13", 0.01, 0.01, 795.880826);
    check_lobe("P13", 0.01, 0.05, 0);
    check_lobe("P13", 0.09, 0.3, 0);
    sweep(hard_rays / 50);
    return hard_end();
}
