/// The scalar reference: every stage of stages.h for one sample at a time, in the order of operations of stages.h,
/// sharing nothing with the vector bodies. A difference from a vector body is a mistake in one of the two.
#include "engine/base/sequence.h"
#include "engine/render/pattern/kernel_coefficients.h"
#include "engine/render/stages/simd/coefficients.h"
#include "engine/render/stages/light/cone_sample.h"
#include "engine/render/stages/stages.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#if FLT_EVAL_METHOD != 0
#error "float arithmetic must round to float and double arithmetic to double"
#endif

// ---- elementary functions ----------------------------------------------------------------------------------------

/// Returns log2 of (1 + f) 2^e for f in [sqrt(1/2) - 1, sqrt(2) - 1].
static float log2_of_parts(float f, int e)
{
    static const float c[10] = { GLINT_LOG2_C0, GLINT_LOG2_C1, GLINT_LOG2_C2, GLINT_LOG2_C3, GLINT_LOG2_C4,
                                 GLINT_LOG2_C5, GLINT_LOG2_C6, GLINT_LOG2_C7, GLINT_LOG2_C8, GLINT_LOG2_C9 };
    float p = c[9];
    for (int i = 8; i >= 0; i--)
        p = p * f + c[i];
    return (float)e + f * p;
}

/// Returns log2 of the rounded x in [2^-126, 1]; `less_1` is x - 1, computed before rounding.
static float log2_of(float x, float less_1)
{
    if (x >= (float)GLINT_SQRT1_2)
        return log2_of_parts(less_1, 0);
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    int e = (int)(bits >> 23) - 127;
    bits = (bits & 0x007fffffu) | 0x3f800000u;
    float m;
    memcpy(&m, &bits, sizeof m);
    return m >= (float)GLINT_SQRT2 ? log2_of_parts(0.5f * m - 1, e + 1) : log2_of_parts(m - 1, e);
}

/// Returns 2^y for y in [-126, 0].
static float exp2_of(float y)
{
    static const float d[7] = { GLINT_EXP2_D0, GLINT_EXP2_D1, GLINT_EXP2_D2, GLINT_EXP2_D3,
                                GLINT_EXP2_D4, GLINT_EXP2_D5, GLINT_EXP2_D6 };
    float n = (y + 12582912.0f) - 12582912.0f;
    float f = y - n;
    float p = d[6];
    for (int i = 5; i >= 0; i--)
        p = p * f + d[i];
    uint32_t bits = (uint32_t)((int)n + 127) << 23;
    float power;
    memcpy(&power, &bits, sizeof power);
    return p * power;
}

/// Adds 1 to the number of decided pairs of a ray and a primitive; `tests` may be NULL.
static void note_test(uint64_t *tests)
{
    if (tests)
        ++*tests;
}

/// Returns x^exponent from log2(x) <= 0.
static float highlight_strength(float shininess, float log2_specular)
{
    float y = shininess * log2_specular;
    return y < GLINT_EXP2_LOWEST ? 0 : exp2_of(y);
}

// ---- rounding errors of sums and products ------------------------------------------------------------------------

typedef struct exact_pair {
    double value, error;
} exact_pair; ///< an exact number, as value + error; value is the rounded number

static exact_pair two_sum(double a, double b)
{
    double s = a + b, v = s - a;
    return (exact_pair) { s, (a - (s - v)) + (b - v) };
}

/// Returns the upper half of a number, by Veltkamp's split: the lower half, x - upper, fits into 26 bits, too.
static double upper_half(double x)
{
    double y = 134217729.0 * x; // 2^27 + 1
    return y - (y - x);
}

/// Returns x^2 with its rounding error, by Dekker's product: the partial products are exact.
static exact_pair two_square(double x)
{
    double p = x * x, upper = upper_half(x), lower = x - upper;
    double error = ((upper * upper - p) + 2 * (upper * lower)) + lower * lower;
    return (exact_pair) { p, error };
}

/// Returns |f|^2 - (radius scale)^2, rounded once.
static double exact_c_double(double fx, double fy, double fz, const glint_prim *prim)
{
    exact_pair p0 = two_square(fx), p1 = two_square(fy), p2 = two_square(fz);
    exact_pair x = two_sum(p0.value, p1.value);
    exact_pair y = two_sum(x.value, p2.value);
    exact_pair z = two_sum(y.value, -glint_sphere_r2(prim));
    double errors = (p0.error + p1.error) + p2.error;
    return z.value + (((x.error + y.error) + z.error) + (errors - glint_sphere_r2_low(prim)));
}

static float exact_c_float(float fx, float fy, float fz, const glint_prim *prim)
{
    return ((fx * fx + fy * fy) + fz * fz) - (float)glint_sphere_r2(prim);
}

// ---- The side of a primitive that a light is on -------------------------------------------------------------------

static int sign_of(double x) { return (x > 0) - (x < 0); }

static double dot_of(const double a[3], const double b[3]) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }

static int light_side_of_plane(bool directional, const double position[3], const glint_prim *prim)
{
    if (directional)
        return sign_of(dot_of(prim->normal, position));
    double away[3];
    for (int k = 0; k < 3; k++)
        away[k] = position[k] - prim->center[k];
    return sign_of(dot_of(prim->normal, away));
}

static int light_side_of_sphere(bool directional, const double position[3], const glint_prim *prim)
{
    if (directional)
        return 1;
    double f[3];
    for (int k = 0; k < 3; k++)
        f[k] = (position[k] - prim->center[k]) * glint_sphere_scale(prim);
    return isinf(dot_of(f, f)) ? 1 : sign_of(exact_c_double(f[0], f[1], f[2], prim));
}

static double height_over(const glint_face *face, const double position[3])
{
    double away[3];
    for (int c = 0; c < 3; c++)
        away[c] = position[c] - face->at[c];
    if (face->axis < 3)
        return face->normal[face->axis] * away[face->axis];
    double h = dot_of(face->normal, away);
    return fabs(h) <= GLINT_ON_FACE_DOUBLE * face->magnitude ? 0 : h;
}

static bool is_within(const glint_solid *solid, const glint_prim *prim, const double position[3])
{
    double away[3];
    for (int c = 0; c < 3; c++)
        away[c] = position[c] - prim->center[c];
    double x = dot_of(solid->inverse[0], away), y = dot_of(solid->inverse[1], away),
           z = dot_of(solid->inverse[2], away);
    if (solid->form == GLINT_FORM_BALL)
        return (x * x + y * y) + z * z < 1;
    if (solid->form == GLINT_FORM_TORUS) {
        double off = sqrt(x * x + y * y) - 1;
        return off * off + z * z < solid->tube * solid->tube;
    }
    bool between = true;
    for (int i = 0; i < (solid->form == GLINT_FORM_BOX ? 3 : 1); i++)
        between = between && height_over(&solid->faces[2 * i], position) > 0 &&
                  height_over(&solid->faces[2 * i + 1], position) < 0;
    if (solid->form == GLINT_FORM_BOX)
        return between;
    if (solid->form == GLINT_FORM_CYLINDER)
        return x * x + y * y < 1 && between;
    return solid->form == GLINT_FORM_CONE && x * x + y * y < z * z && between;
}

/// Returns 1 if the light is in front of a plane or outside a sphere, -1 if behind or inside, 0 if on it. The
/// arithmetic is double for both precisions.
static int light_side(bool directional, const double position[3], const glint_prim *prim, const glint_solid *solids)
{
    if (prim->kind == GLINT_PRIM_TRIANGLE || prim->kind == GLINT_PRIM_COMBINED)
        return 0; // decided lane by lane
    if (prim->kind == GLINT_PRIM_SOLID)
        return directional || !is_within(&solids[prim->item], prim, position) ? 1 : -1;
    return prim->kind == GLINT_PRIM_SPHERE ? light_side_of_sphere(directional, position, prim)
                                           : light_side_of_plane(directional, position, prim);
}

// ---- geometry, in float and in double ----------------------------------------------------------------------------

static float square_root_float(float x) { return sqrtf(x); }

static double square_root_double(double x) { return sqrt(x); }

#define PLANE_GRAZING_float 1e-30f
#define PLANE_GRAZING_double 1e-60
#define ON_FACE_float ((float)GLINT_ON_FACE_FLOAT)
#define ON_FACE_double GLINT_ON_FACE_DOUBLE
#define POINT_SLACK_float ((float)GLINT_POINT_SLACK_FLOAT)
#define POINT_SLACK_double GLINT_POINT_SLACK_DOUBLE
#define SPHERE_CLOSE_float GLINT_SPHERE_CLOSE_FLOAT
#define SPHERE_CLOSE_double GLINT_SPHERE_CLOSE_DOUBLE

#define REAL float
#define ROUNDER GLINT_ROUNDER_FLOAT
#define NAME(x) x##_float
#include "engine/render/stages/ref/real.h"
#include "engine/render/effects/bounce/ref.h"
#include "engine/render/effects/indirect/ref.h"
#include "engine/render/effects/microfacet/ref.h"
#include "engine/render/effects/raster/ref.h"
#include "engine/render/effects/rough/ref.h"
#include "engine/render/effects/vertex_shading/ref.h"
#include "engine/render/stages/ref/soft.h"
#undef REAL
#undef ROUNDER
#undef NAME

#define REAL double
#define ROUNDER GLINT_ROUNDER_DOUBLE
#define NAME(x) x##_double
#include "engine/render/stages/ref/real.h"
#include "engine/render/effects/bounce/ref.h"
#include "engine/render/effects/indirect/ref.h"
#include "engine/render/effects/microfacet/ref.h"
#include "engine/render/effects/raster/ref.h"
#include "engine/render/effects/rough/ref.h"
#include "engine/render/effects/vertex_shading/ref.h"
#include "engine/render/stages/ref/soft.h"
#undef REAL
#undef ROUNDER
#undef NAME

#include "engine/render/stages/ref/shade.h"
#include "engine/render/effects/indirect/ref_sky.h"

// ---- resolve -----------------------------------------------------------------------------------------------------

static void resolve(const glint_resolve_args *args)
{
    unsigned further = 0;
    for (int term = GLINT_TERM_LOCAL; term < GLINT_TERM_COUNT; term++)
        further |= args->sum[term][0] ? 1u << term : 0;
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++) {
        terms mean = load_sums(args->sum, i);
        for (int term = 0; term < GLINT_TERM_COUNT; term++)
            for (int c = 0; c < 3; c++)
                mean.value[term][c] /= args->samples;
        write_film(&mean, further, args->film, args->beauty, i);
    }
}

static void resolve_samples(const glint_shade_args *sample, uint32_t count)
{
    for (uint32_t i = 0; i < sample->group_count * GLINT_GROUP; i++) {
        terms mean = { 0 };
        if (!sample->active[i / GLINT_GROUP])
            continue;
        for (uint32_t k = 0; k < count; k++)
            add_sample(&sample[k], i, &mean);
        for (int term = 0; term < GLINT_TERM_LOCAL; term++)
            for (int c = 0; c < 3; c++)
                mean.value[term][c] /= count;
        write_film(&mean, GLINT_TERM_LOCAL, sample->film, sample->beauty, i);
    }
}

#include "engine/render/pattern/ref.h"
#include "engine/render/effects/derivative/ref_bend.h"
#include "engine/render/effects/derivative/ref.h"
#include "engine/render/adaptive/ref.h"

// ---- tone --------------------------------------------------------------------------------------------------------

static uint32_t tone_code(const uint32_t *table, float top, float value)
{
    float x = min_float(max_float(value, 0), top);
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    if (bits < GLINT_TONE_FIRST << 16)
        return 0;
    uint32_t entry = table[(bits >> 16) - GLINT_TONE_FIRST];
    return (entry & 255) + ((bits & 0xffff) >= entry >> 8);
}

static void tone_sample(const glint_tone_args *args, uint32_t i)
{
    uint32_t group = i / GLINT_GROUP, lane = i % GLINT_GROUP;
    size_t x = group % args->groups_across * 4 + lane % 4, y = group / args->groups_across * 4 + lane / 4;
    bool clipped = false, finite = true;
    if (!(args->active[group] >> lane & 1))
        return;
    for (size_t c = 0; c < 3; c++) {
        float value = args->gain * args->beauty[c][i];
        clipped = clipped || value > args->white;
        finite = finite && isfinite(args->beauty[c][i]);
        args->codes[y * args->stride + 3 * x + c] = (uint8_t)tone_code(args->table, args->top, value);
    }
    *args->clipped += clipped;
    *args->nonfinite += !finite;
}

static void tone(const glint_tone_args *args)
{
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
        tone_sample(args, i);
}

// ------------------------------------------------------------------------------------------------------------------

#define ENTRY(with, result, name, parameters) .name = name,
#define ENTRY_DOUBLE(with, result, name, parameters) .name = name##_double,
#define ENTRY_FLOAT(with, result, name, parameters) .name = name##_float,

const glint_stages glint_stages_ref = {
    .name = "ref",
    .geometry = { { GLINT_GEOMETRY_KERNELS(ENTRY_DOUBLE) }, { GLINT_GEOMETRY_KERNELS(ENTRY_FLOAT) } },
    GLINT_SAMPLE_KERNELS(ENTRY)
};
