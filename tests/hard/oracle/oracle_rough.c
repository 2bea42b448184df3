/// The integral over the slopes of facets, by the midpoint rule on rings, which are finer where slopes are steep and rare.
/// It shares no formula with the engine's rays, which draw the facets that the eye sees.
#include "tests/hard/oracle/oracle_rough.h"
#include "tests/hard/oracle/quad.h"

static quad dot(const quad a[3], const quad b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Returns Smith's Lambda at a cosine.
static quad lambda(bool beckmann, quad alpha, quad cosine)
{
    const quad t = alpha * sqrtf128(1 - cosine * cosine) / cosine, a = 1 / t;
    if (!beckmann)
        return (sqrtf128(1 + t * t) - 1) / 2;
    return a < (quad)1.6 ? (1 - (quad)1.259 * a + (quad)0.396 * a * a) / ((quad)3.535 * a + (quad)2.181 * a * a) : 0;
}

/// Finds a basis whose last axis is n.
static void basis_of(const double n[3], quad axis[3][3])
{
    const int least = fabs(n[0]) < fabs(n[1]) ? (fabs(n[0]) < fabs(n[2]) ? 0 : 2) : fabs(n[1]) < fabs(n[2]) ? 1 : 2;
    quad up[3] = { 0 }, length = 0;
    up[least] = 1;
    for (int c = 0; c < 3; c++)
        axis[2][c] = (quad)n[c];
    length = sqrtf128(dot(axis[2], axis[2]));
    for (int c = 0; c < 3; c++)
        axis[2][c] /= length;
    for (int c = 0; c < 3; c++)
        axis[0][c] = axis[2][(c + 1) % 3] * up[(c + 2) % 3] - axis[2][(c + 2) % 3] * up[(c + 1) % 3];
    length = sqrtf128(dot(axis[0], axis[0]));
    for (int c = 0; c < 3; c++)
        axis[0][c] /= length;
    for (int c = 0; c < 3; c++)
        axis[1][c] = axis[2][(c + 1) % 3] * axis[0][(c + 2) % 3] - axis[2][(c + 2) % 3] * axis[0][(c + 1) % 3];
}

static void along(quad axis[3][3], const double v[3], quad out[3])
{
    const quad wide[3] = { (quad)v[0], (quad)v[1], (quad)v[2] };
    for (int k = 0; k < 3; k++)
        out[k] = dot(axis[k], wide);
}

double oracle_step(bool beckmann, double roughness, const double n[3], const double v[3], const double toward[3], int rings)
{
    const quad alpha = (quad)roughness * (quad)roughness, pi = acosf128(-1), ln2 = 1 / log2f128(expf128(1));
    quad axis[3][3], eye[3], white[3], sum = 0;
    basis_of(n, axis);
    along(axis, v, eye);
    along(axis, toward, white);
    const quad length = sqrtf128(dot(eye, eye));
    for (int k = 0; k < 3; k++)
        eye[k] /= length;
    const quad masked = 1 + lambda(beckmann, alpha, eye[2]);
    for (int k = 0; k < 2 * rings; k++) {
        const quad turn = pi * ((quad)k + 0.5) / rings, x = cosf128(turn), y = sinf128(turn);
        for (int i = 0; i < rings; i++) {
            const quad t = ((quad)i + 0.5) / rings, steeper = t * t * t; // share of facets with a larger slope
            const quad slope = alpha * sqrtf128(beckmann ? -log2f128(steeper) * ln2 : (1 - steeper) / steeper);
            const quad size = sqrtf128(1 + slope * slope), h[3] = { slope * x / size, slope * y / size, 1 / size };
            const quad c = dot(h, eye), l[3] = { 2 * c * h[0] - eye[0], 2 * c * h[1] - eye[1], 2 * c * h[2] - eye[2] };
            if (c > 0 && l[2] > 0 && dot(l, white) > 0)
                sum += 3 * t * t * c * size / (eye[2] * (masked + lambda(beckmann, alpha, l[2])));
        }
    }
    return (double)(sum / (2 * (quad)rings * rings));
}
