/// The zlib stream of a picture, as bands of rows that are filtered and deflated on their own: several at a time, and
/// none whose codes the last picture had already. Internal.
#ifndef GLINT_IMAGE_BANDS_H
#define GLINT_IMAGE_BANDS_H

#include "engine/glint.h"
#include "engine/file/bytes.h"
#include "engine/file/png.h"

/// glint_bands: threads, their memory, and the deflated bands of the last picture that had stamps.
///
/// threads  1 .. 1024 that filter and deflate; 1: the thread that calls glint_bands_deflate does.
glint_status glint_bands_create(int threads, glint_bands **out, glint_error *error);
void glint_bands_destroy(glint_bands *bands);

/// The stream of the filtered rows, by `bands` (one caller at a time). The bytes are the same whatever it remembers. Where a band
/// begins depends on width, bits and `encode` alone.
///
/// stream  out: owned by `bands`, until the next call.
/// reused  out, may be NULL: the share of bands that were not deflated again, 0 .. 1.
/// GLINT_ERR_NOMEM.
glint_status glint_bands_deflate(glint_bands *bands, const glint_png_source *source, glint_encode encode,
                                 const glint_bytes **stream, double *reused, glint_error *error);

#endif
