/// PFM: float pictures, "PF" with three channels and "Pf" with one, bottom row first. Internal.
#ifndef GLINT_IMAGE_PFM_H
#define GLINT_IMAGE_PFM_H

#include "engine/files/picture/bytes.h"
#include "engine/glint_types.h"

/// Returns a value as stored in float files. With three channels, infinity becomes the largest float of its sign and
/// NaN becomes 0. A single channel is a distance and may be infinite.
float glint_pfm_value(int channels, float value);

/// Appends a whole little-endian PFM to `out`.
///
/// plane     channels (1 or 3) pointers to width * height values, top row first.
/// False: out of memory.
bool glint_pfm_encode(int width, int height, int channels, float *const plane[], glint_bytes *out);

typedef struct glint_pfm {
    int width, height, channels;
    float *values; ///< interleaved, top row first; the owner calls free
} glint_pfm;

/// Returns whether the bytes begin like a PFM, of a kind that is read or not.
static inline bool glint_is_pfm(const uint8_t *data, size_t size)
{
    return size >= 3 && data[0] == 'P' && (data[1] == 'F' || data[1] == 'f') && (data[2] <= ' ' || data[2] == '4');
}

/// Returns the size of a whole PFM with this beginning; 0: not a PFM.
uint64_t glint_pfm_bytes(const uint8_t *head, size_t size);
/// Decodes either byte order and ignores the magnitude of the scale. GLINT_ERR_FORMAT when the bytes are not a whole
/// PFM.
glint_status glint_pfm_decode(const uint8_t *data, size_t size, glint_pfm *out, glint_error *error);

#endif
