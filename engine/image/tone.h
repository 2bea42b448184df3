/// From linear light to integer codes. Internal.
#ifndef GLINT_IMAGE_TONE_H
#define GLINT_IMAGE_TONE_H

#include "engine/glint.h"
#include "engine/stages/stages.h"

#define GLINT_TONE16_FIRST 0x3500u ///< upper 16 bits of 2^-21; the floats below have code 0 at 16 bits
#define GLINT_TONE16_ENTRIES ((GLINT_TONE_LAST - GLINT_TONE16_FIRST) * 2 + 1)

typedef struct glint_tone_table {
    glint_tone_desc desc;
    uint32_t lut[GLINT_TONE_ENTRIES]; ///< 8 bits: the table of the tone stage, see stages.h
    glint_tone_fit fit; ///< 8 bits: likewise
    float *threshold; ///< 16 bits: [k] is the first float of code k, k = 0 .. 65535, then +inf
    float guess[GLINT_TONE16_ENTRIES][2]; ///< 16 bits: buckets of 2^15 floats: code at the first float, codes a step
} glint_tone_table;

/// GLINT_ERR_INVALID when a field is out of its range.
glint_status glint_tone_check(const glint_tone_desc *desc, glint_error *error);

bool glint_tone_same(const glint_tone_desc *a, const glint_tone_desc *b);

/// The code of one value, by definition: floor(f(clamp(x)) M + 0.5) or floor(f(clamp(x)) M) in double.
double glint_tone_value(const glint_tone_desc *desc, double linear);

/// Makes a table that gives exactly glint_tone_value for every float.
glint_status glint_tone_table_create(const glint_tone_desc *desc, glint_tone_table **out, glint_error *error);
void glint_tone_table_destroy(glint_tone_table *table);

/// The same from a store of the process: made at the first call, kept to its end. Any thread.
glint_status glint_tone_table_shared(const glint_tone_desc *desc, const glint_tone_table **out, glint_error *error);

/// Converts `count` pixels of three planes to interleaved codes. The table's bits must be 8 or 16 as the name says.
/// *clipped and *nonfinite (each may be NULL) grow by the pixels with a channel > 1, with one that is not finite.
void glint_tone_row8(const glint_tone_table *table, const float *r, const float *g, const float *b, size_t count,
                     uint8_t *rgb, uint64_t *clipped, uint64_t *nonfinite);
void glint_tone_row16(const glint_tone_table *table, const float *r, const float *g, const float *b, size_t count,
                      uint16_t *rgb, uint64_t *clipped, uint64_t *nonfinite);

#endif
