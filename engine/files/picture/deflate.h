/// One interface to the deflate libraries of this build: ISA-L and libdeflate if present, otherwise zlib.
///
/// A zlib stream is glint_deflate_begin, then bands in order, then glint_deflate_end. Bands are compressed
/// independently (on any thread, in any order) and appended. The compressed bytes depend only on the band's bytes and
/// on `last`. libdeflate cannot flush, so its streams have one band: see glint_deflate_has_bands. Internal.
#ifndef GLINT_IMAGE_DEFLATE_H
#define GLINT_IMAGE_DEFLATE_H

#include "engine/files/picture/bytes.h"
#include "engine/glint_types.h"
#include "engine/glint_files.h"

/// Returns whether a stream may have several bands in this build.
bool glint_deflate_has_bands(glint_encode encode);

/// Creates the state of one thread's encoder, which does not affect its output. NULL: out of memory.
struct glint_deflate_memory *glint_deflate_memory_create(void);
void glint_deflate_memory_destroy(struct glint_deflate_memory *memory); ///< NULL: no effect

/// Appends one band as raw deflate, ending on a byte (a full flush, or the final block when `last`).
///
/// size    at most 2^31 when the setting has bands.
/// adler   out: the Adler-32 of only this band.
/// GLINT_ERR_NOMEM or GLINT_ERR_INVALID leave `out` as it was.
glint_status glint_deflate_band(struct glint_deflate_memory *memory, glint_encode encode, const uint8_t *data, size_t size,
                                bool last, glint_bytes *out, uint32_t *adler, glint_error *error);

/// Returns the Adler-32 of two consecutive pieces, the second with second_size bytes. It is 1 for no data.
uint32_t glint_deflate_join(uint32_t first, uint32_t second, size_t second_size);

bool glint_deflate_begin(glint_bytes *out); ///< appends the two-byte zlib header; false: out of memory
bool glint_deflate_end(glint_bytes *out, uint32_t adler); ///< appends the checksum of all bands

#endif
