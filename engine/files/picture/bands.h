/// The zlib stream of a picture, in bands of rows that are filtered and deflated separately: several at a time, and
/// only bands whose pixel values differ from the last picture. Internal.
#ifndef GLINT_IMAGE_BANDS_H
#define GLINT_IMAGE_BANDS_H

#include "engine/files/picture/bytes.h"
#include "engine/files/picture/png.h"
#include "engine/glint_types.h"

/// glint_bands: threads, their buffers, and the deflated bands of the last picture that had stamps.
///
/// threads  1 .. 1024 threads that filter and deflate; 1: the thread that calls glint_bands_deflate.
glint_status glint_bands_create(int threads, glint_bands **out, glint_error *error);
void glint_bands_destroy(glint_bands *bands);

/// Returns the stream of the filtered rows. One caller at a time. The bytes do not depend on what `bands` has cached.
/// The limits of the bands depend only on width, bits and `encode`.
///
/// stream  out: owned by `bands`, until the next call.
/// reused  out, may be NULL: the share of bands that were not deflated again, 0 .. 1.
/// GLINT_ERR_NOMEM.
glint_status glint_bands_deflate(glint_bands *bands, const glint_png_source *source, glint_encode encode,
                                 const glint_bytes **stream, double *reused, glint_error *error);

#endif
