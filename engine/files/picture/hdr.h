/// Radiance pictures (.hdr): 8-bit red, green and blue with a common exponent. Internal.
#ifndef GLINT_FILE_HDR_H
#define GLINT_FILE_HDR_H

#include "engine/files/picture/pfm.h"

/// Returns whether the bytes begin like a Radiance picture.
bool glint_is_hdr(const uint8_t *data, size_t size);

/// Decodes a picture of at most `most` pixels into three channels, divided by its EXPOSURE and COLORCORR lines: flat or
/// with runs of either kind, in any of the eight orientations. GLINT_ERR_FORMAT: the file is incomplete, larger or
/// XYZE. *out is written on success; the owner frees its values.
glint_status glint_hdr_decode(const uint8_t *data, size_t size, size_t most, glint_pfm *out, glint_error *error);

#endif
