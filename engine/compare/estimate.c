/// The error of a picture from the difference to its partner: an independent picture with four times the samples.
///
/// All pixels of a picture have the same sample positions, shifted by the seed, so two pictures with as many samples
/// may have the same error or opposite ones. The partner's own error is a quarter to a half of the picture's, and can
/// hide or add little. It makes the estimate 0 to 12 % too large.
#include "engine/base/sequence.h"
#include "engine/base/status.h"
#include "engine/film/image.h"
#include "engine/film/tone.h"
#include "engine/glint_compare.h"

#include <math.h>

#define ROW 256 ///< pixels that are converted at a time
#define SEEDS 0x400000 ///< partner seeds are below this, so that a shift keeps all of its digits

int64_t glint_partner_seed(const glint_render_desc *desc)
{
    if (!desc)
        return 0;
    const uint64_t mixed = glint_sequence_mix((uint64_t)desc->seed, (uint64_t)desc->samples);
    const int64_t seed = (int64_t)(1 + mixed % (SEEDS - 2));
    return seed == desc->seed ? seed + 1 : seed;
}

/// Sums the squared differences d of the pixels, over their channels, and the squares of these sums. table: of the pixel
/// values to compare; NULL: linear light.
static void sum_differences(const glint_image *const pair[2], const glint_tone_table *table, float gain, double *squares, double *fourths)
{
    const size_t width = (size_t)pair[0]->width, pixels = width * (size_t)pair[0]->height;
    uint16_t codes[2][3 * ROW];
    *squares = *fourths = 0;
    for (size_t at = 0; at < pixels; at += ROW) {
        const size_t count = pixels - at < ROW ? pixels - at : ROW;
        for (int k = 0; table && k < 2; k++) {
            float *const *p = pair[k]->plane[GLINT_PASS_BEAUTY];
            const float *const light[3] = { p[0] + at, p[1] + at, p[2] + at };
            glint_tone_row(table, gain, light, NULL, (const int[2]) { 0, 0 }, count, codes[k], NULL);
        }
        for (size_t i = 0; i < count; i++) {
            double sum = 0;
            for (size_t c = 0; c < 3; c++) {
                float *const *a = pair[0]->plane[GLINT_PASS_BEAUTY], *const *b = pair[1]->plane[GLINT_PASS_BEAUTY];
                const double d = table ? (codes[0][3 * i + c] - codes[1][3 * i + c]) / 65535.0 : (double)a[c][at + i] - b[c][at + i];
                sum += isfinite(d) ? d * d : 0;
            }
            *squares += sum;
            *fourths += sum * sum;
        }
    }
}

/// Measures the difference of two pictures: see sum_differences.
static glint_status measure(const glint_image *image, const glint_image *partner, const glint_tone_desc *tone, double *squares,
                            double *fourths, glint_error *error)
{
    const glint_tone_table *table = NULL;
    GLINT_REFUSE_NULL(image, error);
    GLINT_REFUSE_NULL(partner, error);
    if (!glint_image_has_pass(image, GLINT_PASS_BEAUTY) || !glint_image_has_pass(partner, GLINT_PASS_BEAUTY))
        return glint_fail(error, GLINT_ERR_INVALID, "image: expected a picture with its beauty pass");
    if (image->width != partner->width || image->height != partner->height)
        return glint_fail(error, GLINT_ERR_INVALID, "partner: %d x %d pixels expected, got %d x %d", image->width,
                          image->height, partner->width, partner->height);
    const glint_tone_desc seen = { .curve = tone ? tone->curve : GLINT_TONE_CLAMP, .transfer = GLINT_TRANSFER_SRGB, .bits = 16,
                                   .exposure = tone ? tone->exposure : 0 };
    glint_tone_store_open();
    const glint_status status = tone ? glint_tone_table_shared(&seen, &table, error) : GLINT_OK;
    if (!status)
        sum_differences((const glint_image *const[2]) { image, partner }, table, glint_tone_gain(&seen), squares, fourths);
    glint_tone_store_close();
    return status;
}

glint_status glint_estimate_error(const glint_image *image, const glint_image *partner, const glint_tone_desc *tone, double *rmse,
                                  glint_error *error)
{
    double squares, fourths;
    GLINT_REFUSE_NULL(rmse, error);
    const glint_status status = measure(image, partner, tone, &squares, &fourths, error);
    if (!status)
        *rmse = sqrt(squares / (3 * ((double)image->width * image->height)));
    return status;
}

double glint_estimate_pixels(const glint_image *image, const glint_image *partner, const glint_tone_desc *tone)
{
    double squares, fourths;
    glint_error error;
    if (measure(image, partner, tone, &squares, &fourths, &error))
        return 0;
    return fourths > 0 ? squares * squares / fourths : INFINITY;
}
