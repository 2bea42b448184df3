/// JPEG pictures, decoded by libjpeg if the build has it. Internal.
#ifndef GLINT_FILE_JPEG_H
#define GLINT_FILE_JPEG_H

#include "engine/files/picture/png.h"

/// Returns whether the bytes begin like a JPEG.
bool glint_is_jpeg(const uint8_t *data, size_t size);

/// Decodes a grey or colour JPEG of at most `most` pixels to 8 bits a channel. GLINT_ERR_FORMAT: the file is
/// incomplete, larger, has other colours, or the build has no libjpeg. *out is written on success; the owner frees its
/// codes.
glint_status glint_jpeg_decode(const uint8_t *data, size_t size, size_t most, glint_png *out, glint_error *error);

/// Returns the library's name and version: "libjpeg-turbo 2.1.5". NULL: the build has none.
const char *glint_jpeg_library(void);

#endif
