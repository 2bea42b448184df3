/// OpenEXR through the C core of its library: all passes of an image as channels of one file. Internal.
///
///   beauty R, G, B and with alpha A       depth depth.Z       object_id object_id.ID
///   normal normal.X, .Y, .Z               other passes diffuse.R, .G, .B; of one channel outline.Y
#ifndef GLINT_IMAGE_EXR_H
#define GLINT_IMAGE_EXR_H

#include "engine/glint.h"
#include "engine/file/bytes.h"

/// Appends the file to `out`, scan lines deflated in blocks of 16. The values are as in .pfm files. With `half`, passes
/// of three channels and alpha are rounded to half. GLINT_ERR_UNSUPPORTED in a build without the library.
glint_status glint_exr_encode(const glint_image *image, bool half, const glint_text *text, size_t text_count,
                              glint_bytes *out, glint_error *error);

#endif
