/// Truth in multiple precision: 400 bits, and, where those do not decide,
/// enough bits for exact products of four doubles.
#include "tests/hard/oracle/oracle.h"

#include <math.h>
#include <mpfr.h>

#define BITS 400
#define BITS_EXACT 9000 ///< enough bits: 4 x 2098 between the smallest and the largest double, plus space for sums

#define RN MPFR_RNDN

typedef struct numbers {
    mpfr_t f[3], d[3], a, b, c, disc, rr, size, x, y;
} numbers;

static void numbers_init(numbers *n, int bits)
{
    for (int i = 0; i < 3; i++)
        mpfr_inits2(bits, n->f[i], n->d[i], (mpfr_ptr)0);
    mpfr_inits2(bits, n->a, n->b, n->c, n->disc, n->rr, n->size, n->x, n->y, (mpfr_ptr)0);
}

static void numbers_clear(numbers *n)
{
    for (int i = 0; i < 3; i++)
        mpfr_clears(n->f[i], n->d[i], (mpfr_ptr)0);
    mpfr_clears(n->a, n->b, n->c, n->disc, n->rr, n->size, n->x, n->y, (mpfr_ptr)0);
}

static void set_vector(mpfr_t out[3], const double v[3])
{
    for (int i = 0; i < 3; i++)
        mpfr_set_d(out[i], v[i], RN);
}

/// Computes sum = u . v.
static void dot(mpfr_t sum, mpfr_t u[3], mpfr_t v[3])
{
    mpfr_t p;
    mpfr_init2(p, mpfr_get_prec(sum));
    mpfr_mul(sum, u[0], v[0], RN);
    for (int i = 1; i < 3; i++) {
        mpfr_mul(p, u[i], v[i], RN);
        mpfr_add(sum, sum, p, RN);
    }
    mpfr_clear(p);
}

/// Returns whether |x| < 2^-k |y|.
static bool lost(mpfr_t x, mpfr_t y, int k)
{
    mpfr_t bound;
    mpfr_init2(bound, 64);
    mpfr_div_2ui(bound, y, (unsigned long)k, RN);
    const bool small = mpfr_cmpabs(x, bound) < 0;
    mpfr_clear(bound);
    return small;
}

static double rounded(mpfr_t x) { return mpfr_get_d(x, RN); }

/// Sets the equation a t^2 + 2 b t + c = 0 with a = d.d, b = f.d, c = f.f - r^2, and disc = b^2 - a c. Returns false
/// when more bits are needed.
static bool set_equation(numbers *k, const hard_ray *ray, const hard_sphere *sphere, int bits)
{
    set_vector(k->d, ray->d);
    for (int i = 0; i < 3; i++) {
        mpfr_set_d(k->f[i], ray->o[i], RN);
        mpfr_sub_d(k->f[i], k->f[i], sphere->c[i], RN);
    }
    dot(k->a, k->d, k->d);
    dot(k->b, k->f, k->d);
    dot(k->c, k->f, k->f);
    mpfr_set_d(k->rr, sphere->r, RN);
    mpfr_sqr(k->rr, k->rr, RN);
    mpfr_add(k->size, k->c, k->rr, RN);
    mpfr_sub(k->c, k->c, k->rr, RN);
    if (bits < BITS_EXACT && lost(k->c, k->size, bits - 120))
        return false;
    mpfr_sqr(k->disc, k->b, RN);
    mpfr_mul(k->x, k->a, k->c, RN);
    mpfr_sub(k->disc, k->disc, k->x, RN);
    mpfr_mul(k->size, k->size, k->a, RN);
    return bits == BITS_EXACT || !lost(k->disc, k->size, bits - 120);
}

/// Puts the nearest positive root into k->x, without subtracting nearly equal numbers.
/// Returns false when there is none.
static bool nearest_root(numbers *k)
{
    const int outside = mpfr_sgn(k->c), away = mpfr_sgn(k->b);
    if (mpfr_sgn(k->disc) < 0 || (outside >= 0 && away >= 0))
        return false;
    mpfr_sqrt(k->y, k->disc, RN);
    if (outside > 0) { // c / (-b + sqrt(disc))
        mpfr_sub(k->y, k->y, k->b, RN);
        mpfr_div(k->x, k->c, k->y, RN);
    } else if (away > 0) { // -c / (b + sqrt(disc))
        mpfr_add(k->y, k->y, k->b, RN);
        mpfr_div(k->x, k->c, k->y, RN);
        mpfr_neg(k->x, k->x, RN);
    } else { // (-b + sqrt(disc)) / a
        mpfr_sub(k->y, k->y, k->b, RN);
        mpfr_div(k->x, k->y, k->a, RN);
    }
    return mpfr_sgn(k->x) > 0;
}

static void sphere_margins(numbers *k, const hard_sphere *sphere, truth *out)
{
    mpfr_add(k->size, k->c, k->rr, RN);
    mpfr_sqrt(k->size, k->size, RN);
    mpfr_add_d(k->size, k->size, sphere->r, RN); // |f| + r
    mpfr_sqr(k->y, k->size, RN);
    mpfr_div(k->y, k->c, k->y, RN); // (|f| - r) / (|f| + r)
    out->surface = fabs(rounded(k->y));
    mpfr_mul(k->x, k->rr, k->a, RN); // distance of the line from the centre: sqrt((r^2 a - disc) / a)
    mpfr_sub(k->x, k->x, k->disc, RN);
    mpfr_div(k->x, k->x, k->a, RN);
    mpfr_sqrt(k->x, k->x, RN);
    mpfr_add_d(k->x, k->x, sphere->r, RN);
    mpfr_mul(k->x, k->x, k->size, RN);
    mpfr_mul(k->x, k->x, k->a, RN);
    mpfr_div(k->x, k->disc, k->x, RN);
    out->tangency = fabs(rounded(k->x));
}

static bool solve_sphere(const hard_ray *ray, const hard_sphere *sphere, int bits, truth *out)
{
    numbers k;
    numbers_init(&k, bits);
    *out = (truth) { 0 };
    const bool decided = set_equation(&k, ray, sphere, bits);
    if (decided) {
        out->hit = nearest_root(&k);
        if (out->hit) {
            out->t = rounded(k.x);
            for (int i = 0; i < 3; i++) {
                mpfr_mul(k.y, k.x, k.d[i], RN);
                mpfr_add(k.y, k.y, k.f[i], RN);
                mpfr_div_d(k.y, k.y, sphere->r, RN);
                out->n[i] = rounded(k.y);
            }
            mpfr_mul(k.y, k.rr, k.a, RN);
            mpfr_div(k.y, k.disc, k.y, RN);
            mpfr_sqrt(k.y, k.y, RN);
            out->cosine = rounded(k.y);
        }
        sphere_margins(&k, sphere, out);
    }
    numbers_clear(&k);
    return decided;
}

truth oracle_sphere(const hard_ray *ray, const hard_sphere *sphere)
{
    truth out;
    if (!solve_sphere(ray, sphere, BITS, &out))
        solve_sphere(ray, sphere, BITS_EXACT, &out);
    return out;
}

truth oracle_plane(const hard_ray *ray, const hard_plane *plane)
{
    truth out = { 0 };
    numbers k;
    numbers_init(&k, BITS_EXACT);
    set_vector(k.d, ray->d);
    for (int i = 0; i < 3; i++) {
        mpfr_set_d(k.f[i], plane->p[i], RN);
        mpfr_sub_d(k.f[i], k.f[i], ray->o[i], RN);
    }
    mpfr_t n[3];
    for (int i = 0; i < 3; i++)
        mpfr_init2(n[i], BITS_EXACT);
    set_vector(n, plane->n);
    dot(k.a, k.d, k.d);
    dot(k.b, n, k.d);
    dot(k.c, n, k.f);
    dot(k.rr, n, n);
    mpfr_sqrt(k.rr, k.rr, RN);
    mpfr_sqrt(k.a, k.a, RN);
    mpfr_div(k.x, k.b, k.a, RN);
    mpfr_div(k.x, k.x, k.rr, RN);
    out.cosine = out.tangency = fabs(rounded(k.x));
    double reach = 0;
    for (int i = 0; i < 3; i++)
        reach += fabs(ray->o[i]) + fabs(plane->p[i]);
    mpfr_div(k.y, k.c, k.rr, RN);
    out.surface = fabs(rounded(k.y)) / (reach > 0 ? reach : 1);
    out.hit = mpfr_sgn(k.b) * mpfr_sgn(k.c) > 0 && out.cosine >= PARALLEL;
    if (out.hit) {
        mpfr_div(k.y, k.c, k.b, RN);
        out.t = rounded(k.y);
        for (int i = 0; i < 3; i++) {
            mpfr_div(k.y, n[i], k.rr, RN);
            out.n[i] = rounded(k.y);
        }
    }
    for (int i = 0; i < 3; i++)
        mpfr_clear(n[i]);
    numbers_clear(&k);
    return out;
}

/// Normalises v.
static void make_unit(mpfr_t v[3])
{
    mpfr_t length;
    mpfr_init2(length, BITS);
    dot(length, v, v);
    mpfr_sqrt(length, length, RN);
    for (int i = 0; i < 3; i++)
        mpfr_div(v[i], v[i], length, RN);
    mpfr_clear(length);
}

/// Computes the cosine that the highlight raises to a power:
/// r.v = 2 (n.l)(n.v) - l.v, or n.h, or 0 where h is undefined.
static void highlight_cosine(mpfr_t out, bool blinn, mpfr_t n[3], mpfr_t l[3], mpfr_t v[3], mpfr_t nl, mpfr_t nv)
{
    if (!blinn) {
        mpfr_t lv;
        mpfr_init2(lv, BITS);
        dot(lv, l, v);
        mpfr_mul(out, nl, nv, RN);
        mpfr_mul_2ui(out, out, 1, RN);
        mpfr_sub(out, out, lv, RN);
        mpfr_clear(lv);
        return;
    }
    for (int i = 0; i < 3; i++)
        mpfr_add(l[i], l[i], v[i], RN);
    if (mpfr_zero_p(l[0]) && mpfr_zero_p(l[1]) && mpfr_zero_p(l[2])) {
        mpfr_set_zero(out, 1);
        return;
    }
    make_unit(l);
    dot(out, n, l);
}

reflection oracle_reflection(bool blinn, double shininess, const double normal[3], const double to_light[3],
                             const double to_eye[3])
{
    reflection out = { .log2_specular = -INFINITY };
    mpfr_t n[3], l[3], v[3], nl, nv, x;
    for (int i = 0; i < 3; i++)
        mpfr_inits2(BITS, n[i], l[i], v[i], (mpfr_ptr)0);
    mpfr_inits2(BITS, nl, nv, x, (mpfr_ptr)0);
    set_vector(n, normal);
    set_vector(l, to_light);
    set_vector(v, to_eye);
    make_unit(n);
    make_unit(l);
    make_unit(v);
    dot(nl, n, l);
    dot(nv, n, v);
    if (mpfr_sgn(nv) < 0) {
        mpfr_neg(nl, nl, RN);
        mpfr_neg(nv, nv, RN);
        for (int i = 0; i < 3; i++)
            mpfr_neg(n[i], n[i], RN);
    }
    if (mpfr_sgn(nl) > 0) {
        out.diffuse = rounded(nl);
        highlight_cosine(x, blinn, n, l, v, nl, nv);
        if (mpfr_sgn(x) > 0) {
            mpfr_log2(x, x, RN);
            mpfr_mul_d(x, x, shininess, RN);
            out.log2_specular = rounded(x);
            mpfr_exp2(x, x, RN);
            out.specular = rounded(x);
        }
    }
    for (int i = 0; i < 3; i++)
        mpfr_clears(n[i], l[i], v[i], (mpfr_ptr)0);
    mpfr_clears(nl, nv, x, (mpfr_ptr)0);
    return out;
}

int oracle_code(double linear, bool srgb, int range)
{
    mpfr_t x, power;
    mpfr_inits2(BITS, x, power, (mpfr_ptr)0);
    mpfr_set_d(x, linear < 0 ? 0 : linear > 1 ? 1 : linear, RN);
    mpfr_set_str(power, "0.0031308", 10, RN);
    if (srgb && mpfr_cmp(x, power) <= 0) {
        mpfr_set_str(power, "12.92", 10, RN);
        mpfr_mul(x, x, power, RN);
    } else if (srgb) {
        mpfr_set_str(power, "2.4", 10, RN);
        mpfr_ui_div(power, 1, power, RN);
        mpfr_pow(x, x, power, RN);
        mpfr_set_str(power, "1.055", 10, RN);
        mpfr_mul(x, x, power, RN);
        mpfr_set_str(power, "0.055", 10, RN);
        mpfr_sub(x, x, power, RN);
    }
    mpfr_mul_si(x, x, range, RN);
    mpfr_add_d(x, x, 0.5, RN);
    const long code = mpfr_get_si(x, MPFR_RNDD);
    mpfr_clears(x, power, (mpfr_ptr)0);
    return (int)code;
}
