/// From linear light to a PNG file, as fast as zlib goes: one filter for every row, deflate level 1.
#ifndef GLINT_BENCH_PICTURE_H
#define GLINT_BENCH_PICTURE_H

#include <stddef.h>
#include <stdint.h>

#include "tests/bench/packet.h"

/// 8-bit sRGB codes of a frame, three bytes a pixel; and one vector's worth of room behind them.
typedef struct picture {
    uint8_t bytes[BENCH_HEIGHT * BENCH_WIDTH * 3 + 64];
} picture;

/// Makes the codes of one band; `use` of packet_frame, with the picture as user.
void picture_tone(void *out, int y, const packet_band *band);

/// The state of one thread that writes PNGs.
typedef struct picture_writer picture_writer;

picture_writer *picture_writer_create(void);
void picture_writer_destroy(picture_writer *writer);

/// The file's bytes, valid until the next call.
const uint8_t *picture_encode(picture_writer *writer, const picture *codes, size_t *size);
/// The same by libpng with its defaults.
const uint8_t *picture_encode_libpng(picture_writer *writer, const picture *codes, size_t *size);

/// Ends the program when the file cannot be written.
void picture_write(const uint8_t *bytes, size_t size, const char *path);

#endif
