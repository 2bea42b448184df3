/// compare16 A.png B.png [MAX_SHARE]: compares two 16-bit RGB PNGs value by value. Prints every pixel with a channel
/// that differs by more than one, then a line of totals. Exits with 0 when their share is at most MAX_SHARE (default
/// 0.0001), with 1 when it is larger, with 2 when the files cannot be compared.
///
/// compare16 A.png B.png MOST blocks: for pictures with noise. The means of blocks of 4 x 4 pixels (incomplete blocks
/// at the borders are ignored) may differ by at most MOST of full scale, root mean square.
#include <math.h>
#include <png.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHANNELS 3
#define PRINTED_MAX 200 ///< most pixels that are printed; all are counted

typedef struct picture {
    png_structp png;
    png_infop info;
    png_bytepp rows;
    png_uint_32 width, height;
} picture;

static void fail(const char *path, const char *what)
{
    fprintf(stderr, "compare16: %s: %s\n", path, what);
    exit(2);
}

static picture read_picture(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        fail(path, "cannot be opened");
    picture p = {.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL)};
    p.info = p.png ? png_create_info_struct(p.png) : NULL;
    if (!p.info)
        fail(path, "out of memory");
    if (setjmp(png_jmpbuf(p.png)))
        fail(path, "cannot be read");
    png_init_io(p.png, file);
    png_read_png(p.png, p.info, PNG_TRANSFORM_STRIP_ALPHA, NULL);
    fclose(file);
    if (png_get_bit_depth(p.png, p.info) != 16 || png_get_channels(p.png, p.info) != CHANNELS)
        fail(path, "16-bit RGB expected");
    p.rows = png_get_rows(p.png, p.info);
    p.width = png_get_image_width(p.png, p.info);
    p.height = png_get_image_height(p.png, p.info);
    return p;
}

static int code(const png_byte *pixel, int channel)
{
    return pixel[2 * channel] << 8 | pixel[2 * channel + 1];
}

/// Returns the largest difference between the channels of two pixels, in 16-bit steps.
static int pixel_difference(const png_byte *a, const png_byte *b)
{
    int largest = 0;
    for (int c = 0; c < CHANNELS; c++) {
        int difference = abs(code(a, c) - code(b, c));
        largest = difference > largest ? difference : largest;
    }
    return largest;
}

typedef struct totals {
    unsigned long pixels, same, one_off, off;
    int largest;
} totals;

static totals compare(const picture *a, const picture *b)
{
    totals t = {.pixels = (unsigned long)a->width * a->height};
    for (png_uint_32 y = 0; y < a->height; y++) {
        for (png_uint_32 x = 0; x < a->width; x++) {
            const png_byte *p = a->rows[y] + 2 * CHANNELS * x, *q = b->rows[y] + 2 * CHANNELS * x;
            int difference = pixel_difference(p, q);
            t.same += difference == 0;
            t.one_off += difference == 1;
            t.largest = difference > t.largest ? difference : t.largest;
            if (difference > 1 && t.off++ < PRINTED_MAX)
                printf("  pixel %u,%u: %d %d %d against %d %d %d\n", (unsigned)x, (unsigned)y, code(p, 0), code(p, 1),
                       code(p, 2), code(q, 0), code(q, 1), code(q, 2));
        }
    }
    return t;
}

#define BLOCK 4

/// Sums a channel over the block at (x, y).
static double block_sum(const picture *p, png_uint_32 x, png_uint_32 y, int channel)
{
    double sum = 0;
    for (png_uint_32 i = 0; i < BLOCK * BLOCK; i++)
        sum += code(p->rows[y + i / BLOCK] + 2 * CHANNELS * (x + i % BLOCK), channel);
    return sum;
}

/// Returns the root mean square of the differences of block means, relative to full scale.
static double compare_blocks(const picture *a, const picture *b)
{
    double squares = 0, count = 0;
    for (png_uint_32 y = 0; y + BLOCK <= a->height; y += BLOCK)
        for (png_uint_32 x = 0; x + BLOCK <= a->width; x += BLOCK)
            for (int c = 0; c < CHANNELS; c++, count++) {
                const double off = (block_sum(a, x, y, c) - block_sum(b, x, y, c)) / (BLOCK * BLOCK * 65535.);
                squares += off * off;
            }
    return sqrt(squares / count);
}

int main(int argc, char **argv)
{
    const bool blocks = argc == 5 && strcmp(argv[4], "blocks") == 0;
    if (argc < 3 || (argc > 4 && !blocks))
        return fprintf(stderr, "usage: compare16 A.png B.png [MAX_SHARE | MOST blocks]\n"), 2;
    double max_share = argc >= 4 ? atof(argv[3]) : 1e-4;
    picture a = read_picture(argv[1]), b = read_picture(argv[2]);
    if (a.width != b.width || a.height != b.height)
        fail(argv[2], "another size");
    if (blocks) {
        const double off = compare_blocks(&a, &b);
        printf("  blocks are off by %.6f of full scale, root mean square\n", off);
        return !(off <= atof(argv[3]));
    }
    totals t = compare(&a, &b);
    double share = (double)t.off / (double)t.pixels;
    printf("  %lu pixels: %lu equal, %lu off by one code, %lu by more (%.5f %%), largest %d codes\n", t.pixels, t.same,
           t.one_off, t.off, 100 * share, t.largest);
    png_destroy_read_struct(&a.png, &a.info, NULL);
    png_destroy_read_struct(&b.png, &b.info, NULL);
    return share > max_share;
}
