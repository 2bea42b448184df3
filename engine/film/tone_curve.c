/// Tone curves, which map light of any brightness to 0 .. 1.
#include "engine/film/tone.h"

#include <math.h>

// Hable's curve, h(x) = (x (A x + C B) + D E) / (x (A x + B) + D F) - E / F, with the published numbers: shoulder
// strength A, linear strength B, linear angle C, toe strength D, toe numerator E, toe denominator F (J. Hable,
// "Uncharted 2: HDR Lighting", GDC 2010, and filmicworlds.com). With a common denominator the constant terms cancel, so
// that h(0) is 0.
#define HABLE_A 0.15
#define HABLE_B 0.50
#define HABLE_C 0.10
#define HABLE_D 0.20
#define HABLE_E 0.02
#define HABLE_F 0.30
#define HABLE_WHITE 11.2
#define HABLE_BIAS 2.0 // Hable's factor for the light

static double hable(double x)
{
    const double toe = HABLE_E / HABLE_F;
    return x * (HABLE_A * (1 - toe) * x + HABLE_B * (HABLE_C - toe)) /
           (x * (HABLE_A * x + HABLE_B) + HABLE_D * HABLE_F);
}

/// Returns the root of h(x) = h > 0 without cancellation.
static double hable_inverse(double h)
{
    const double f = h + HABLE_E / HABLE_F;
    const double a = HABLE_A * (1 - f), b = HABLE_B * (HABLE_C - f), c = -HABLE_D * HABLE_F * h;
    const double root = sqrt(b * b - 4 * a * c);
    return b > 0 ? -2 * c / (b + root) : (root - b) / (2 * a);
}

double glint_tone_curve_white(glint_tone_curve curve)
{
    switch (curve) {
    case GLINT_TONE_REINHARD:
        return HUGE_VAL;
    case GLINT_TONE_FILMIC:
        return HABLE_WHITE / HABLE_BIAS;
    default:
        return 1;
    }
}

double glint_tone_curve_value(glint_tone_curve curve, double linear)
{
    if (!(linear > 0)) // NaN gives 0
        return 0;
    if (linear >= glint_tone_curve_white(curve))
        return 1;
    switch (curve) {
    case GLINT_TONE_REINHARD:
        return linear / (1 + linear);
    case GLINT_TONE_FILMIC:
        return hable(HABLE_BIAS * linear) / hable(HABLE_WHITE);
    default:
        return linear;
    }
}

double glint_tone_curve_inverse(glint_tone_curve curve, double y)
{
    switch (curve) {
    case GLINT_TONE_REINHARD:
        return y < 1 ? y / (1 - y) : HUGE_VAL;
    case GLINT_TONE_FILMIC:
        return hable_inverse(y * hable(HABLE_WHITE)) / HABLE_BIAS;
    default:
        return y;
    }
}
