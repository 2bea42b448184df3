/// How far pictures are from each other, from a reference, and from the picture of infinitely many samples.
#ifndef GLINT_COMPARE_H
#define GLINT_COMPARE_H

#include "glint.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

// ---- Two files -----------------------------------------------------------------------------------------------------

/// The difference of two pictures, over all pixels and channels.
typedef struct glint_compare_result {
    int width, height, channels; ///< size in pixels and channels of both pictures
    double mean_error, rms_error, peak_snr, max_error; ///< differences of values, which are in 0 .. 1 (PNG) or linear
        ///< (PFM); peak signal-to-noise ratio
    int max_x, max_y, max_channel; ///< position of max_error, from 0
    uint64_t failed, warned; ///< number of pixels whose difference exceeds `fail`; number of those that exceed `warn`
    uint64_t pixels; ///< width x height
} glint_compare_result;

/// Thresholds of differences.
typedef struct glint_compare_desc {
    double fail, warn; ///< default 1e-6, as in the program idiff
} glint_compare_desc;

/// Compares two .png or .pfm files. GLINT_ERR_INVALID if the sizes or channels differ (out->width is then -1),
/// GLINT_ERR_IO or GLINT_ERR_FORMAT if one cannot be read.
glint_status glint_compare_files(const char *a, const char *b, const glint_compare_desc *desc,
                                 glint_compare_result *out, glint_error *error);

// ---- A reference ---------------------------------------------------------------------------------------------------

/// A reference for measuring other pictures: the mean of pictures that should be identical. Immutable.
typedef struct glint_reference glint_reference;

/// The error of a picture relative to a reference.
typedef struct glint_picture_error {
    double rmse; ///< root of the mean squared difference of linear light, over pixels and channels
    double relmse; ///< mean of (x - r)^2 / (r^2 + 0.01)
    double max_code; ///< largest difference of pixel values, in steps of 8 bits; fractions at 16 bits
    double over1, over8; ///< share of the pixels with a channel that differs by more than 1 such step, and by more
        ///< than 8
    double flip; ///< mean LDR-FLIP, 0 .. 1 (Andersson et al. 2020), at 67 pixels per degree
} glint_picture_error;

/// Makes a reference.
///
/// images  `count` >= 1 images of the same size, each with the beauty pass; only read during the call.
/// tone    the conversion to the pixel values that are compared; its `bits` are ignored.
glint_status glint_reference_create(const glint_image *const *images, size_t count, const glint_tone_desc *tone,
                                    glint_reference **out, glint_error *error);
/// Frees the reference with its image. NULL: nothing.
void glint_reference_destroy(glint_reference *reference);
/// Returns the mean image, with the beauty pass; borrowed.
const glint_image *glint_reference_image(const glint_reference *reference);

/// Measures a picture that has the reference's size and the beauty pass.
///
/// file_bits  0: the linear light; 8 or 16: the light decoded from a file with such values, exposure and curve
///            undone. Light above white, which no file can hold, counts unchanged in both cases, so that the numbers
///            are comparable.
///
/// If a channel is not finite, neither are rmse and relmse.
glint_status glint_reference_measure(const glint_reference *reference, const glint_image *image, int file_bits,
                                     glint_picture_error *out, glint_error *error);

/// Makes a picture for viewing: `scale` times the difference of the 8-bit values in each channel, clamped to white.
glint_status glint_reference_difference(const glint_reference *reference, const glint_image *image, double scale,
                                        glint_image **out, glint_error *error);

// ---- The error of a picture from its own samples -------------------------------------------------------------------

/// Returns the seed of the frame's partner: an independent picture with four times the samples of the frame.
int64_t glint_partner_seed(const glint_render_desc *desc);
/// Estimates the error of a picture of at least 2 samples a pixel: the root of the mean squared difference to the
/// picture of infinitely many samples, over pixels and channels. Both images have the beauty pass.
///
/// partner  rendered from the same scene with the frame's partner seed and four times the samples; with fewer, the
///          estimate is larger.
/// tone     The error is of the picture that people see, in fractions of white: light after exposure, curve and sRGB's
///          transfer, whatever the tone's transfer and bits are. NULL: the error is of linear light, where channels
///          that are not finite do not count.
///
/// With one sample the estimate sees no edges, because the only sample is in the middle of the pixel. It never sees
/// details that both pictures miss.
glint_status glint_estimate_error(const glint_image *image, const glint_image *partner, const glint_tone_desc *tone, double *rmse,
                                  glint_error *error);
/// Returns the number of pixels that hold most of the squared difference of the two pictures, (sum d^2)^2 / sum d^4; 0
/// for pictures that glint_estimate_error refuses; infinite for equal pictures. With few pixels, fewer than 10 for example,
/// the estimate depends on chance: rare bright paths may be missing from it, or dominate it.
double glint_estimate_pixels(const glint_image *image, const glint_image *partner, const glint_tone_desc *tone);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
