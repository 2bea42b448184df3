/// OpenEXR through the C core of its library: all passes of an image as channels of one file. Internal.
///
///   beauty R, G, B and with alpha A       depth depth.Z       object_id object_id.ID
///   normal normal.X, .Y, .Z               other passes diffuse.R, .G, .B; of one channel outline.Y
#ifndef GLINT_IMAGE_EXR_H
#define GLINT_IMAGE_EXR_H

#include "engine/files/picture/bytes.h"
#include "engine/files/picture/pfm.h"
#include "engine/glint_types.h"
#include "engine/glint_files.h"

/// Appends the file to `out`, scan lines deflated in blocks of 16. The values are as in .pfm files. With `half`, passes
/// of three channels and alpha are rounded to half. GLINT_ERR_UNSUPPORTED in a build without the library.
glint_status glint_exr_encode(const glint_image *image, bool half, const glint_text *text, size_t text_count,
                              glint_bytes *out, glint_error *error);

/// Decodes the picture of a whole file, of at most `most` pixels: scan lines or tiles of its first part; R, G and B, of
/// a layer if need be, or Y. GLINT_ERR_FORMAT: the file is incomplete, larger or has other contents.
/// GLINT_ERR_UNSUPPORTED in a build without the library. *out is written on success; the owner frees its values.
glint_status glint_exr_decode(const glint_bytes *bytes, size_t most, glint_pfm *out, glint_error *error);

/// Returns whether the bytes begin like an OpenEXR file.
static inline bool glint_is_exr(const uint8_t *data, size_t size)
{
    return size >= 4 && data[0] == 0x76 && data[1] == 0x2f && data[2] == 0x31 && data[3] == 0x01;
}

#endif
