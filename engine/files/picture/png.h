/// PNG in memory. libpng writes the container; glint filters and deflates. Internal.
#ifndef GLINT_IMAGE_PNG_H
#define GLINT_IMAGE_PNG_H

#include "engine/files/picture/bytes.h"
#include "engine/glint_types.h"
#include "engine/glint_files.h"

#define GLINT_PNG_TEXT_MAX 65536 ///< bytes of one text value
#define GLINT_PNG_KEY "glint:key" ///< tEXt keyword of a frame's key

/// A source of RGB or RGBA pixel values, row by row.
typedef struct glint_png_source {
    int width, height; ///< 1 .. GLINT_SIDE_MAX
    bool alpha; ///< four channels instead of three
    glint_tone_desc tone; ///< bits: 8 or 16; sRGB: an sRGB chunk; linear: gAMA 1.0
    /// Returns row y, from 0 at the top: 3 * width pixel values, with alpha 4 * width (uint8_t, or uint16_t in native
    /// order). They are written to `scratch`, which is large enough, or stay where they are. Rows may be read in any
    /// order and by several threads.
    const void *(*row)(const void *user, int y, void *scratch);
    const void *user;
    const uint64_t *stamp; ///< stamps of the rows of tiles, as in glint_image; NULL: the pixel values are unknown
} glint_png_source;

/// Returns the bytes of one pixel.
static inline size_t glint_png_pixel_bytes(const glint_png_source *source)
{
    return (source->alpha ? 4 : 3) * (source->tone.bits == 16 ? 2 : 1);
}

typedef struct glint_bands glint_bands; ///< bands.h

typedef struct glint_png_desc {
    glint_encode encode;
    const glint_text *text;
    size_t text_count;
    double dpi; ///< pixels per inch; 0: not stored
} glint_png_desc;

/// Appends a whole PNG to `out`. The bytes depend only on source, desc and the deflate library; there are no dates.
/// bands and reused: see glint_bands_deflate; bands NULL: temporary ones for this picture, on one thread.
/// GLINT_ERR_INVALID for a bad keyword or a value that is too long; GLINT_ERR_NOMEM. `out` may have grown on failure.
glint_status glint_png_encode(glint_bands *bands, const glint_png_source *source, const glint_png_desc *desc,
                              glint_bytes *out, double *reused, glint_error *error);

typedef struct glint_png {
    int width, height;
    int channels; ///< 1 .. 4: grey, grey and alpha, RGB, RGB and alpha
    int bits; ///< bits per channel after decoding, 8 or 16: fewer are widened to 8, and palettes become RGB
    void *codes; ///< uint8_t or uint16_t (native order), interleaved; the owner calls free
} glint_png;

/// Decodes a PNG whose CRCs are all right and that ends in IEND; otherwise GLINT_ERR_FORMAT. *out is written on
/// success.
glint_status glint_png_decode(const uint8_t *data, size_t size, glint_png *out, glint_error *error);

/// Returns an upper bound for the uncompressed pixel bytes of a PNG with this beginning, of all its frames; 0: not a
/// PNG.
uint64_t glint_png_raw_bytes(const uint8_t *head, size_t size);

/// Returns whether the bytes are a whole PNG (chunks from IHDR to IEND with right CRCs, nothing after) with this text.
bool glint_png_has_text(const uint8_t *data, size_t size, const char *keyword, const char *value);

typedef struct glint_png_head {
    int width, height;
    int bits; ///< bits per channel after decoding: 8 or 16
    int channels; ///< channels after decoding, 1 .. 4
    glint_transfer transfer; ///< linear: gAMA is 1.0; otherwise sRGB is assumed
    bool is_animated; ///< several frames
} glint_png_head;

/// Reads everything except the pixels, and calls `text` (unless NULL) for each tEXt. Its bytes, Latin-1, are borrowed
/// for the call; if it returns false, the scan ends. GLINT_ERR_FORMAT when the bytes are not a whole PNG,
/// GLINT_ERR_NOMEM after false.
glint_status glint_png_scan(const uint8_t *data, size_t size, glint_png_head *out,
                            bool (*text)(void *user, const uint8_t *bytes, size_t size), void *user,
                            glint_error *error);

#endif
