/// One interface over the deflate libraries of this build: ISA-L and libdeflate where present, zlib for either.
///
/// A zlib stream is glint_deflate_begin, then bands in order, then glint_deflate_end. Bands are compressed on their
/// own (any thread, any order) and joined by appending; what a band compresses to depends on its bytes and `last`
/// alone. libdeflate cannot flush, so there a stream has one band: see glint_deflate_has_bands. Internal.
#ifndef GLINT_IMAGE_DEFLATE_H
#define GLINT_IMAGE_DEFLATE_H

#include "engine/glint.h"
#include "engine/file/bytes.h"

/// Whether a stream may be cut into bands in this build.
bool glint_deflate_has_bands(glint_encode encode);

/// Creates the state of one thread's encoder, which does not affect its output. NULL: out of memory.
struct glint_deflate_memory *glint_deflate_memory_create(void);
void glint_deflate_memory_destroy(struct glint_deflate_memory *memory); ///< NULL: nothing

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
