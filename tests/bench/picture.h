/// Converts linear light to a PNG file as fast as zlib allows: one filter for every row, and deflate level 1.
#ifndef GLINT_BENCH_PICTURE_H
#define GLINT_BENCH_PICTURE_H

#include <stddef.h>
#include <stdint.h>

#include "tests/bench/packet.h"

/// 8-bit sRGB values of a frame, three bytes per pixel, with one vector of padding at the end.
typedef struct picture {
    uint8_t bytes[BENCH_HEIGHT * BENCH_WIDTH * 3 + 64];
} picture;

/// Converts one band to 8-bit sRGB. Pass it to packet_frame as `use`, with the picture as user.
void picture_tone(void *out, int y, const packet_band *band);

/// The state of one thread that writes PNGs.
typedef struct picture_writer picture_writer;

picture_writer *picture_writer_create(void);
void picture_writer_destroy(picture_writer *writer);

/// Returns the file's bytes, valid until the next call.
const uint8_t *picture_encode(picture_writer *writer, const picture *codes, size_t *size);
/// Like picture_encode, but with libpng and its default settings.
const uint8_t *picture_encode_libpng(picture_writer *writer, const picture *codes, size_t *size);

/// Ends the program when the file cannot be written.
void picture_write(const uint8_t *bytes, size_t size, const char *path);

#endif
