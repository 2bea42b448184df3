/// The error of a picture from the difference to its partner: an independent picture with four times the samples.
///
/// All pixels of a picture have the same sample positions, shifted by the seed, so two pictures with as many samples
/// may have the same error or opposite ones. The partner's own error is a quarter to a half of the picture's, and can
/// hide or add little. It makes the estimate 0 to 12 % too large.
#include "engine/base/sequence.h"
#include "engine/base/status.h"
#include "engine/film/image.h"
#include "engine/glint_compare.h"

#include <math.h>

#define SEEDS 0x400000 ///< partner seeds are below this, so that a shift keeps all of its digits

double glint_partner_seed(const glint_render_desc *desc)
{
    if (!desc)
        return 0;
    const uint64_t mixed = glint_sequence_mix((uint64_t)desc->seed, (uint64_t)desc->samples);
    const double seed = (double)(1 + mixed % (SEEDS - 2));
    return seed == desc->seed ? seed + 1 : seed;
}

/// Returns the squared difference of two pictures at a pixel, over the channels that are finite.
static double difference_at(const glint_image *image, const glint_image *partner, size_t pixel)
{
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        const double d =
            (double)image->plane[GLINT_PASS_BEAUTY][c][pixel] - partner->plane[GLINT_PASS_BEAUTY][c][pixel];
        sum += isfinite(d) ? d * d : 0;
    }
    return sum;
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
    for (size_t i = 0; i < pixels; i++)
        sum += difference_at(image, partner, i);
    *rmse = sqrt(sum / (3 * (double)pixels));
    return GLINT_OK;
}

double glint_estimate_pixels(const glint_image *image, const glint_image *partner)
{
    double rmse, squares = 0, fourths = 0;
    glint_error error;
    if (glint_estimate_error(image, partner, &rmse, &error))
        return 0;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++) {
        const double d = difference_at(image, partner, i);
        squares += d;
        fourths += d * d;
    }
    return fourths > 0 ? squares * squares / fourths : INFINITY;
}
