/// Exact results for light, in 400 bits.
#include "tests/hard/oracle/oracle_light.h"

#include <mpfr.h>

#define BITS 400
#define RN MPFR_RNDN

/// Rounds the result to double and frees it.
static double taken(mpfr_t x)
{
    const double out = mpfr_get_d(x, RN);
    mpfr_clear(x);
    return out;
}

static void dot_d(mpfr_t sum, const double u[3], const double v[3])
{
    mpfr_t p;
    mpfr_init2(p, BITS);
    mpfr_set_zero(sum, 1);
    for (int c = 0; c < 3; c++) {
        mpfr_set_d(p, u[c], RN);
        mpfr_mul_d(p, p, v[c], RN);
        mpfr_add(sum, sum, p, RN);
    }
    mpfr_clear(p);
}

/// Computes the cosine between two vectors of any length.
static void cosine_of(mpfr_t out, const double u[3], const double v[3])
{
    mpfr_t uu, vv;
    mpfr_inits2(BITS, uu, vv, (mpfr_ptr)0);
    dot_d(out, u, v);
    dot_d(uu, u, u);
    dot_d(vv, v, v);
    mpfr_mul(uu, uu, vv, RN);
    mpfr_sqrt(uu, uu, RN);
    mpfr_div(out, out, uu, RN);
    mpfr_clears(uu, vv, (mpfr_ptr)0);
}

// ---- Microfacets ----

/// Computes out = alpha^2 / (sin^2 + alpha^2 cos^2)^2, which is pi D.
static void ggx(mpfr_t out, mpfr_t alpha, mpfr_t cos2)
{
    mpfr_t sum;
    mpfr_init2(sum, BITS);
    mpfr_sqr(out, alpha, RN);
    mpfr_mul(sum, out, cos2, RN);
    mpfr_sub(sum, sum, cos2, RN);
    mpfr_add_ui(sum, sum, 1, RN);
    mpfr_sqr(sum, sum, RN);
    mpfr_div(out, out, sum, RN);
    mpfr_clear(sum);
}

double oracle_ggx(double alpha, double angle)
{
    mpfr_t a, c, out;
    mpfr_inits2(BITS, a, c, out, (mpfr_ptr)0);
    mpfr_set_d(a, alpha, RN);
    mpfr_set_d(c, angle, RN);
    mpfr_cos(c, c, RN);
    mpfr_sqr(c, c, RN);
    ggx(out, a, c);
    mpfr_const_pi(c, RN);
    mpfr_div(out, out, c, RN);
    mpfr_clears(a, c, (mpfr_ptr)0);
    return taken(out);
}

/// Computes out = exp(-tan^2 / alpha^2) / (alpha^2 cos^4), which is pi D.
static void beckmann_lobe(mpfr_t out, mpfr_t alpha, mpfr_t cos2)
{
    mpfr_t x, a2;
    mpfr_inits2(BITS, x, a2, (mpfr_ptr)0);
    mpfr_sqr(a2, alpha, RN);
    mpfr_ui_sub(x, 1, cos2, RN);
    mpfr_div(x, x, cos2, RN);
    mpfr_div(x, x, a2, RN);
    mpfr_neg(x, x, RN);
    mpfr_exp(out, x, RN);
    mpfr_div(out, out, a2, RN);
    mpfr_div(out, out, cos2, RN);
    mpfr_div(out, out, cos2, RN);
    mpfr_clears(x, a2, (mpfr_ptr)0);
}

/// Adds Smith's Lambda for a direction with this cosine to `sum`.
static void add_lambda(mpfr_t sum, bool beckmann, mpfr_t alpha, mpfr_t cosine)
{
    mpfr_t t, x, y; // t is alpha times the tangent
    mpfr_inits2(BITS, t, x, y, (mpfr_ptr)0);
    mpfr_sqr(x, cosine, RN);
    mpfr_ui_sub(t, 1, x, RN);
    mpfr_div(t, t, x, RN);
    mpfr_sqrt(t, t, RN);
    mpfr_mul(t, t, alpha, RN);
    if (!beckmann) { // (sqrt(1 + t^2) - 1) / 2
        mpfr_sqr(x, t, RN);
        mpfr_add_ui(x, x, 1, RN);
        mpfr_sqrt(x, x, RN);
        mpfr_sub_ui(x, x, 1, RN);
        mpfr_div_2ui(x, x, 1, RN);
        mpfr_add(sum, sum, x, RN);
    } else if (mpfr_cmp_d(t, 1 / 1.6) > 0) { // a = 1/t < 1.6: (1 - 1.259 a + 0.396 a^2) / (3.535 a + 2.181 a^2)
        mpfr_ui_div(t, 1, t, RN);
        mpfr_mul_d(x, t, 0.396, RN);
        mpfr_sub_d(x, x, 1.259, RN);
        mpfr_mul(x, x, t, RN);
        mpfr_add_ui(x, x, 1, RN);
        mpfr_mul_d(y, t, 2.181, RN);
        mpfr_add_d(y, y, 3.535, RN);
        mpfr_mul(y, y, t, RN);
        mpfr_div(x, x, y, RN);
        mpfr_add(sum, sum, x, RN);
    }
    mpfr_clears(t, x, y, (mpfr_ptr)0);
}

/// Computes out = f0 + (1 - f0) (1 - v.h)^5, with (v.h)^2 = (1 + l.v) / 2.
static void schlick(mpfr_t out, double f0, mpfr_t lv)
{
    mpfr_add_ui(out, lv, 1, RN);
    mpfr_div_2ui(out, out, 1, RN);
    mpfr_sqrt(out, out, RN);
    mpfr_ui_sub(out, 1, out, RN);
    mpfr_pow_ui(out, out, 5, RN);
    mpfr_mul_d(out, out, 1 - f0, RN);
    mpfr_add_d(out, out, f0, RN);
}

double oracle_facets(bool beckmann, double roughness, double f0, const double n[3], const double l[3],
                     const double v[3])
{
    mpfr_t alpha, nl, nv, lv, h2, x, out;
    mpfr_inits2(BITS, alpha, nl, nv, lv, h2, x, out, (mpfr_ptr)0);
    mpfr_set_d(alpha, roughness, RN);
    mpfr_sqr(alpha, alpha, RN);
    cosine_of(nl, n, l);
    cosine_of(nv, n, v);
    cosine_of(lv, l, v);
    const bool turned = mpfr_sgn(nv) < 0;
    mpfr_abs(nv, nv, RN);
    if (turned)
        mpfr_neg(nl, nl, RN);
    mpfr_set_zero(out, 1);
    mpfr_add_ui(x, lv, 1, RN);
    if (mpfr_sgn(nl) > 0 && mpfr_sgn(nv) > 0 && mpfr_sgn(x) > 0) {
        mpfr_add(h2, nl, nv, RN); // (n.h)^2 = (n.l + n.v)^2 / (2 (1 + l.v))
        mpfr_sqr(h2, h2, RN);
        mpfr_div(h2, h2, x, RN);
        mpfr_div_2ui(h2, h2, 1, RN);
        if (beckmann)
            beckmann_lobe(out, alpha, h2);
        else
            ggx(out, alpha, h2);
        mpfr_set_ui(x, 1, RN);
        add_lambda(x, beckmann, alpha, nl);
        add_lambda(x, beckmann, alpha, nv);
        mpfr_div(out, out, x, RN);
        schlick(x, f0, lv);
        mpfr_mul(out, out, x, RN);
        mpfr_div(out, out, nv, RN);
        mpfr_div_2ui(out, out, 2, RN);
    }
    mpfr_clears(alpha, nl, nv, lv, h2, x, (mpfr_ptr)0);
    return taken(out);
}

// ---- Lights ----

double oracle_spot(double inner_rad, double outer_rad, double exponent, const double axis[3], const double to_point[3])
{
    mpfr_t c, in, edge, out;
    mpfr_inits2(BITS, c, in, edge, out, (mpfr_ptr)0);
    cosine_of(c, axis, to_point);
    mpfr_set_d(in, inner_rad, RN);
    mpfr_cos(in, in, RN);
    mpfr_set_d(edge, outer_rad, RN);
    mpfr_cos(edge, edge, RN);
    if (mpfr_cmp(c, edge) <= 0) {
        mpfr_set_zero(out, 1);
    } else if (mpfr_cmp(c, in) >= 0) {
        mpfr_set_ui(out, 1, RN);
    } else { // x^2 (3 - 2 x)
        mpfr_sub(in, in, edge, RN);
        mpfr_sub(edge, c, edge, RN);
        mpfr_div(edge, edge, in, RN);
        mpfr_mul_2ui(out, edge, 1, RN);
        mpfr_ui_sub(out, 3, out, RN);
        mpfr_mul(out, out, edge, RN);
        mpfr_mul(out, out, edge, RN);
    }
    if (exponent > 0) {
        mpfr_set_d(in, exponent, RN);
        if (mpfr_sgn(c) < 0)
            mpfr_set_zero(c, 1);
        mpfr_pow(c, c, in, RN);
        mpfr_mul(out, out, c, RN);
    }
    mpfr_clears(c, in, edge, (mpfr_ptr)0);
    return taken(out);
}

double oracle_cap(double ratio)
{
    mpfr_t out;
    mpfr_init2(out, BITS);
    mpfr_set_d(out, ratio, RN);
    mpfr_sqr(out, out, RN);
    mpfr_ui_sub(out, 1, out, RN);
    mpfr_sqrt(out, out, RN);
    mpfr_ui_sub(out, 1, out, RN);
    return taken(out);
}

/// Returns pi r^2 / (d^2 + plus r^2).
static double pi_over(double radius, double distance, unsigned plus)
{
    mpfr_t r2, d2, out;
    mpfr_inits2(BITS, r2, d2, out, (mpfr_ptr)0);
    mpfr_set_d(r2, radius, RN);
    mpfr_sqr(r2, r2, RN);
    mpfr_set_d(d2, distance, RN);
    mpfr_sqr(d2, d2, RN);
    mpfr_const_pi(out, RN);
    mpfr_mul(out, out, r2, RN);
    mpfr_mul_ui(r2, r2, plus, RN);
    mpfr_add(d2, d2, r2, RN);
    mpfr_div(out, out, d2, RN);
    mpfr_clears(r2, d2, (mpfr_ptr)0);
    return taken(out);
}

double oracle_disk(double radius, double distance) { return pi_over(radius, distance, 1); }
double oracle_ball(double radius, double distance) { return pi_over(radius, distance, 0); }

/// Computes half the angle that a ball on the axis subtends at a point of the plane, `x` from the axis, and the angle
/// of the ball's centre from the axis.
static void seen_from(mpfr_t x, double radius, double height, mpfr_t half, mpfr_t centre)
{
    mpfr_t h;
    mpfr_init2(h, BITS);
    mpfr_set_d(h, height, RN);
    mpfr_atan2(centre, x, h, RN);
    mpfr_hypot(h, x, h, RN);
    mpfr_d_div(half, radius, h, RN);
    mpfr_asin(half, half, RN);
    mpfr_clear(h);
}

double oracle_shadow(bool umbra, double light, double height, double ball, double between)
{
    mpfr_t low, high, x, of_light, of_ball, to_light, to_ball;
    mpfr_inits2(BITS, low, high, x, of_light, of_ball, to_light, to_ball, (mpfr_ptr)0);
    mpfr_set_zero(low, 1);
    mpfr_set_d(high, 1e3 * height, RN);
    for (int i = 0; i < 120; i++) {
        mpfr_add(x, low, high, RN);
        mpfr_div_2ui(x, x, 1, RN);
        seen_from(x, light, height, of_light, to_light);
        seen_from(x, ball, between, of_ball, to_ball);
        mpfr_sub(to_ball, to_ball, to_light, RN);
        if (umbra)
            mpfr_sub(of_ball, of_ball, of_light, RN);
        else
            mpfr_add(of_ball, of_ball, of_light, RN);
        mpfr_set(mpfr_cmp(to_ball, of_ball) < 0 ? low : high, x, RN);
    }
    mpfr_clears(low, high, of_light, of_ball, to_light, to_ball, (mpfr_ptr)0);
    return taken(x);
}

// ---- Mirrors and glass ----

double oracle_snell(double ratio, double sine)
{
    mpfr_t out;
    mpfr_init2(out, BITS);
    mpfr_set_d(out, ratio, RN);
    mpfr_mul_d(out, out, sine, RN);
    return taken(out);
}

double oracle_fresnel(double ratio, double cosine)
{
    mpfr_t r, c, s, p, q, out;
    mpfr_inits2(BITS, r, c, s, p, q, out, (mpfr_ptr)0);
    mpfr_set_d(r, ratio, RN);
    mpfr_set_d(c, cosine, RN);
    mpfr_sqr(s, c, RN);
    mpfr_ui_sub(s, 1, s, RN);
    mpfr_mul(s, s, r, RN);
    mpfr_mul(s, s, r, RN);
    mpfr_ui_sub(s, 1, s, RN);
    mpfr_set_ui(out, 1, RN);
    if (mpfr_sgn(s) > 0) { // the mean of the two polarisations
        mpfr_sqrt(s, s, RN);
        mpfr_mul(p, r, c, RN);
        mpfr_sub(q, p, s, RN);
        mpfr_add(p, p, s, RN);
        mpfr_div(p, q, p, RN);
        mpfr_sqr(p, p, RN);
        mpfr_mul(s, s, r, RN);
        mpfr_sub(q, c, s, RN);
        mpfr_add(out, c, s, RN);
        mpfr_div(q, q, out, RN);
        mpfr_sqr(q, q, RN);
        mpfr_add(out, p, q, RN);
        mpfr_div_2ui(out, out, 1, RN);
    }
    mpfr_clears(r, c, s, p, q, (mpfr_ptr)0);
    return taken(out);
}

double oracle_facing_mirrors(double shine, double mirror, double depth)
{
    mpfr_t m, power, out;
    mpfr_inits2(BITS, m, power, out, (mpfr_ptr)0);
    mpfr_set_d(m, mirror, RN);
    mpfr_set_d(power, depth + 1, RN);
    if (mirror == 1) {
        mpfr_set(out, power, RN);
    } else {
        mpfr_pow(power, m, power, RN);
        mpfr_ui_sub(out, 1, power, RN);
        mpfr_ui_sub(m, 1, m, RN);
        mpfr_div(out, out, m, RN);
    }
    mpfr_mul_d(out, out, shine, RN);
    mpfr_clears(m, power, (mpfr_ptr)0);
    return taken(out);
}
