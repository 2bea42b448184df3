#include <errno.h>
#include <fcntl.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#include "tests/bench/picture.h"

enum { ROW = 3 * BENCH_WIDTH };

struct picture_writer {
    z_stream stream;
    uint8_t row[ROW + 1];
    size_t capacity, size;
    uint8_t *file;
};

// ---- Tone ----

/// Stores sixteen pixels in 48 bytes, but writes 64.
static inline void store_codes(vi r, vi g, vi b, uint8_t *out)
{
    const vi three_of_four =
        _mm512_broadcast_i32x4(_mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1));
    const vi together = _mm512_setr_epi32(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 3, 7, 11, 15);
    vi pixels = _mm512_or_si512(r, _mm512_or_si512(_mm512_slli_epi32(g, 8), _mm512_slli_epi32(b, 16)));
    pixels = _mm512_permutexvar_epi32(together, _mm512_shuffle_epi8(pixels, three_of_four));
    _mm512_storeu_si512(out, pixels);
}

void picture_tone(void *out, int y, const packet_band *band)
{
    picture *p = out;
    for (int row = 0; row < BAND; row++)
        for (int x = 0; x < BENCH_WIDTH; x += 16)
            store_codes(srgb_of(_mm512_loadu_ps(&band->rgb[0][row][x])),
                        srgb_of(_mm512_loadu_ps(&band->rgb[1][row][x])),
                        srgb_of(_mm512_loadu_ps(&band->rgb[2][row][x])), p->bytes + (y + row) * ROW + 3 * x);
}

// ---- PNG ----

picture_writer *picture_writer_create(void)
{
    picture_writer *w = calloc(1, sizeof *w);
    if (!w)
        bench_fail("png", "out of memory");
    if (deflateInit2(&w->stream, 1, Z_DEFLATED, 15, 9, Z_RLE) != Z_OK)
        bench_fail("zlib", "deflateInit2");
    w->capacity = deflateBound(&w->stream, (ROW + 1) * BENCH_HEIGHT) + 4096;
    w->file = malloc(w->capacity);
    if (!w->file)
        bench_fail("png", "out of memory");
    return w;
}

void picture_writer_destroy(picture_writer *w)
{
    deflateEnd(&w->stream);
    free(w->file);
    free(w);
}

static void put32(uint8_t *out, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(value >> (24 - 8 * i));
}

/// Adds the length, the type and the checksum around a chunk's `length` bytes of data. The data start at
/// file + size + 8.
static void close_chunk(picture_writer *w, const char *type, size_t length)
{
    uint8_t *chunk = w->file + w->size;
    put32(chunk, (uint32_t)length);
    memcpy(chunk + 4, type, 4);
    put32(chunk + 8 + length, (uint32_t)crc32(0, chunk + 4, (uInt)length + 4));
    w->size += length + 12;
}

static size_t deflate_rows(picture_writer *w, const picture *codes)
{
    z_stream *z = &w->stream;
    deflateReset(z);
    z->next_out = w->file + w->size + 8;
    z->avail_out = (uInt)(w->capacity - w->size - 8);
    w->row[0] = 1; // the filter "Sub"
    for (int y = 0; y < BENCH_HEIGHT; y++) {
        const uint8_t *row = codes->bytes + y * ROW;
        memcpy(w->row + 1, row, 3);
        for (int i = 3; i < ROW; i++)
            w->row[1 + i] = (uint8_t)(row[i] - row[i - 3]);
        z->next_in = w->row;
        z->avail_in = ROW + 1;
        if (deflate(z, y + 1 < BENCH_HEIGHT ? Z_NO_FLUSH : Z_FINISH) == Z_STREAM_ERROR)
            bench_fail("zlib", "deflate");
    }
    return z->total_out;
}

const uint8_t *picture_encode(picture_writer *w, const picture *codes, size_t *size)
{
    static const uint8_t signature[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
    static const uint8_t depth_and_kind[5] = { 8, 2, 0, 0, 0 };
    memcpy(w->file, signature, 8);
    w->size = 8;
    put32(w->file + 16, BENCH_WIDTH);
    put32(w->file + 20, BENCH_HEIGHT);
    memcpy(w->file + 24, depth_and_kind, 5);
    close_chunk(w, "IHDR", 13);
    close_chunk(w, "IDAT", deflate_rows(w, codes));
    close_chunk(w, "IEND", 0);
    *size = w->size;
    return w->file;
}

static void append(png_structp png, png_bytep bytes, png_size_t count)
{
    picture_writer *w = png_get_io_ptr(png);
    if (count > w->capacity - w->size)
        png_error(png, "too large");
    memcpy(w->file + w->size, bytes, count);
    w->size += count;
}

static void flush(png_structp png) { (void)png; }

const uint8_t *picture_encode_libpng(picture_writer *w, const picture *codes, size_t *size)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info || setjmp(png_jmpbuf(png)))
        bench_fail("libpng", "cannot write");
    w->size = 0;
    png_set_write_fn(png, w, append, flush);
    png_set_IHDR(png, info, BENCH_WIDTH, BENCH_HEIGHT, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (int y = 0; y < BENCH_HEIGHT; y++)
        png_write_row(png, codes->bytes + y * ROW);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    *size = w->size;
    return w->file;
}

void picture_write(const uint8_t *bytes, size_t size, const char *path)
{
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file < 0)
        bench_fail(path, strerror(errno));
    for (size_t done = 0; done < size;) {
        ssize_t count = write(file, bytes + done, size - done);
        if (count <= 0)
            bench_fail(path, strerror(errno));
        done += (size_t)count;
    }
    if (close(file))
        bench_fail(path, strerror(errno));
}
