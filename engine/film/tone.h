/// From linear light to integer codes. Internal.
#ifndef GLINT_IMAGE_TONE_H
#define GLINT_IMAGE_TONE_H

#include "engine/film/codes.h"
#include "engine/glint.h"

#define GLINT_TONE16_FIRST 0x3500u ///< upper 16 bits of the float 2^-21; smaller floats have code 0 at 16 bits

/// The codes of one curve, for light after exposure.
typedef struct glint_tone_table {
    glint_tone_desc desc; ///< with exposure 0; with `dither`, the steps are those of 16 bits, truncated
    float white, top; ///< light above `white` is clipped; light above `top` (at most `white`) gets the value of `top`
    uint32_t *lut; ///< 8 bits: see codes.h
    bool has_fit; ///< 8 bits: whether the fit of the tone stage exists, which only the curve `clamp` has
    glint_tone_fit fit; ///< the fit, if `has_fit`
    float *threshold; ///< 16 bits: [k] is the first float of code k, k = 0 .. 65535, then +inf
    float (*guess)[2]; ///< 16 bits, for each bucket of 2^15 floats: the code at its first float, and codes per step
} glint_tone_table;

/// GLINT_ERR_INVALID when a field is out of its range.
glint_status glint_tone_check(const glint_tone_desc *desc, glint_error *error);

bool glint_tone_same(const glint_tone_desc *a, const glint_tone_desc *b);

/// Returns the factor of light: 2^exposure, rounded to float.
float glint_tone_gain(const glint_tone_desc *desc);

/// Return the value of the curve, 0 .. 1, and the light at which the curve reaches y (+inf: it never does).
/// tone_curve.c.
double glint_tone_curve_value(glint_tone_curve curve, double linear);
double glint_tone_curve_inverse(glint_tone_curve curve, double y);
double glint_tone_curve_white(glint_tone_curve curve); ///< light from which the curve is 1

/// Returns the code of one value by definition: with x the float product of gain and value (the value itself at
/// exposure 0), floor(f(curve(x)) M + 0.5) or floor(f(curve(x)) M) in double.
double glint_tone_value(const glint_tone_desc *desc, double linear);

/// Makes a table that gives exactly glint_tone_value for every float. The caller applies the exposure.
glint_status glint_tone_table_create(const glint_tone_desc *desc, glint_tone_table **out, glint_error *error);
void glint_tone_table_destroy(glint_tone_table *table);

/// Every user of the process's store of tables opens it first and closes it at the end. The last one to close it frees
/// the tables, so that an unloaded module leaves none behind. Any thread.
void glint_tone_store_open(void);
void glint_tone_store_close(void);

/// Returns a table of the open store. The first call makes it. Valid until the caller closes the store. Any thread.
glint_status glint_tone_table_shared(const glint_tone_desc *desc, const glint_tone_table **out, glint_error *error);

/// Converts `count` pixels of three planes to interleaved codes, uint8_t or uint16_t. at: the position of the first pixel in
/// the whole frame, for dithering. alpha: NULL, or the coverage, 0 .. 1, for codes of four channels: `light` is then light
/// times coverage, and is divided by the coverage before conversion. Where it is 0, all four codes are 0. Alpha is linear
/// and rounded to nearest. The two counts (NULL: not wanted) grow by the number of pixels with a channel brighter than
/// white, and with a channel that is not finite.
void glint_tone_row(const glint_tone_table *table, float gain, const float *const light[3], const float *alpha,
                    const int at[2], size_t count, void *codes, uint64_t counts[2]);

#endif
