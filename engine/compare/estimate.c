/// The error of a picture from the difference to a second, independent picture, its partner.
///
/// Two independent pictures of equal quality differ by sqrt(2) times the error of one. Light at random is independent
/// for any two seeds. Sample positions are not: all pixels have the same positions, shifted by the seed, so the error
/// along edges depends on the two shifts and not on chance. The partner's shift is therefore chosen.
#include "engine/base/sequence.h"
#include "engine/base/status.h"
#include "engine/film/image.h"

#include <math.h>

#define SEEDS 0x400000 ///< partner seeds are below this, so that a shift keeps all of its digits
#define TRIES 0x20000
#define CELL_TOLERANCE 0.05 ///< of the distance between neighbouring positions
#define PIXEL_TOLERANCE (1 / 32.0)

/// A shift of the sample positions.
typedef struct shift {
    double own[2]; ///< the frame's own shift, 0 .. 1
    double cells; ///< positions in each direction: the distance of neighbouring positions is 1 / cells
    double in_cell[2], in_pixel[2]; ///< the partner's shift from there: its part within a cell, in cells, and its whole cells
} shift;

/// Returns the partner's shift within a cell, -1 .. 1 cells, in one direction. `at` is the place of the frame's own
/// samples in their cells, 0 .. 1; 0.5: in the middle.
///
/// An edge parallel to the pixel's border, at a random place, has the mean squared error (1/12 + (at - 1/2)^2) / n^2.
/// A shift by s < 1 cells changes one of the n samples at a share s of the places, so half the mean squared difference
/// of the two pictures is s / (2 n^2). The shift makes both equal.
static double shift_in_cell(double at)
{
    const double off = at - 0.5, size = 1 / 6.0 + 2 * off * off;
    return off > 0 ? -size : size;
}

static shift shift_of(const glint_render_desc *desc)
{
    // Shifts by multiples of 1/2^k map parts of the sequence, and the samples of lights, to themselves and hide their
    // error. Thirds are as far from such shifts as possible, for all k.
    static const double in_pixel[2] = { 2 / 3.0, 1 / 3.0 };
    shift s = { .cells = ldexp(1, glint_sequence_bits((uint32_t)desc->samples)) };
    glint_sequence_shift(desc->seed, s.own);
    for (int i = 0; i < 2; i++) {
        const double at = s.own[i] * s.cells + 0.5;
        s.in_cell[i] = shift_in_cell(at - floor(at));
        s.in_pixel[i] = s.cells < 16 ? floor(in_pixel[i] * s.cells) / s.cells : in_pixel[i];
    }
    return s;
}

/// Returns how far a seed's shift is from the shift that is looked for: 1 is the tolerance.
static double distance(const shift *s, double seed)
{
    double of_seed[2], most = 0;
    glint_sequence_shift(seed, of_seed);
    for (int i = 0; i < 2; i++) {
        const double by = of_seed[i] - s->own[i], cells = (by - floor(by)) * s->cells - s->in_cell[i];
        const double whole = round(cells), off = whole / s->cells - s->in_pixel[i];
        most = fmax(most, fabs(cells - whole) / CELL_TOLERANCE);
        most = fmax(most, fabs(off - round(off)) / PIXEL_TOLERANCE);
    }
    return most;
}

double glint_partner_seed(const glint_render_desc *desc)
{
    if (!desc)
        return 0;
    const shift s = shift_of(desc);
    const uint64_t first = glint_sequence_mix((uint64_t)desc->seed, (uint64_t)desc->samples);
    double best = INFINITY, found = 0;
    for (uint64_t i = 0; i < TRIES && best >= 1; i++) {
        const double seed = (double)(1 + glint_sequence_mix(first, i) % (SEEDS - 1));
        const double far = seed == desc->seed ? INFINITY : distance(&s, seed);
        found = far < best ? seed : found;
        best = fmin(best, far);
    }
    return found;
}

glint_status glint_estimate_error(const glint_image *image, const glint_image *partner, double *rmse, glint_error *error)
{
    GLINT_REFUSE_NULL(image, error);
    GLINT_REFUSE_NULL(partner, error);
    GLINT_REFUSE_NULL(rmse, error);
    if (!glint_image_has_pass(image, GLINT_PASS_BEAUTY) || !glint_image_has_pass(partner, GLINT_PASS_BEAUTY))
        return glint_fail(error, GLINT_ERR_INVALID, "image: expected a picture with its beauty pass");
    if (image->width != partner->width || image->height != partner->height)
        return glint_fail(error, GLINT_ERR_INVALID, "partner: %d x %d pixels expected, got %d x %d", image->width,
                          image->height, partner->width, partner->height);
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    double sum = 0;
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < pixels; i++) {
            const double d = (double)image->plane[GLINT_PASS_BEAUTY][c][i] - partner->plane[GLINT_PASS_BEAUTY][c][i];
            sum += isfinite(d) ? d * d : 0;
        }
    *rmse = sqrt(sum / (6 * (double)pixels)); // the mean over 3 channels, divided by 2
    return GLINT_OK;
}
