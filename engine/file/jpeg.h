/// JPEG pictures, decoded by libjpeg where the build has it. Internal.
#ifndef GLINT_FILE_JPEG_H
#define GLINT_FILE_JPEG_H

#include "engine/file/png.h"

/// Whether bytes begin as a JPEG does.
bool glint_is_jpeg(const uint8_t *data, size_t size);

/// Decodes a JPEG, grey or in colour, of at most `most` pixels, into 8 bits a channel. GLINT_ERR_FORMAT: it is not whole, is larger, has
/// other colours, or the build has no libjpeg. *out is written on success; the owner frees its codes.
glint_status glint_jpeg_decode(const uint8_t *data, size_t size, size_t most, glint_png *out, glint_error *error);

#endif
