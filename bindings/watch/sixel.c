// Pictures as sixels: with 256 colours chosen by libsixel for each picture or, without libsixel, with a cube of 216
// colours.
#include <stdlib.h>

#include "bindings/watch/watch.h"

#define SIXEL_SIDE 6 // levels of each primary

// ---- Without libsixel: a cube of colours; in bands of six rows, the dots of each colour ----

// Returns the cube's colour for a pixel, with ordered dithering by Bayer's 4 x 4 matrix.
static int sixel_color(const unsigned char *rgb, int x, int y)
{
    static const int bayer[4][4] = { { 0, 8, 2, 10 }, { 12, 4, 14, 6 }, { 3, 11, 1, 9 }, { 15, 7, 13, 5 } };
    int threshold = bayer[y % 4][x % 4] * 2 + 1, color = 0;
    for (int c = 0; c < 3; c++)
        color = color * SIXEL_SIDE + (rgb[c] * (SIXEL_SIDE - 1) * 32 / 255 + threshold) / 32;
    return color;
}

static void put_run(int dots, int count)
{
    if (count > 3)
        fprintf(stderr, "!%d%c", count, 63 + dots);
    else
        for (int i = 0; i < count; i++)
            fputc(63 + dots, stderr);
}

// Writes one colour's dots in a band of up to six rows.
static void put_band(const unsigned char *colors, int width, int rows, int color)
{
    int before = 0, count = 0;
    fprintf(stderr, "#%d", color);
    for (int x = 0; x < width; x++) {
        int dots = 0;
        for (int y = 0; y < rows; y++)
            dots |= (colors[(size_t)y * (size_t)width + (size_t)x] == color) << y;
        if (dots != before)
            put_run(before, count);
        count = dots == before ? count + 1 : 1;
        before = dots;
    }
    if (before)
        put_run(before, count);
    fputc('$', stderr);
}

static void put_sixels(const watch_small *small, unsigned char *colors)
{
    const int all = SIXEL_SIDE * SIXEL_SIDE * SIXEL_SIDE, level = 100 / (SIXEL_SIDE - 1);
    fprintf(stderr, "\033Pq\"1;1;%d;%d", small->width, small->height);
    for (int i = 0; i < all; i++)
        fprintf(stderr, "#%d;2;%d;%d;%d", i, i / (SIXEL_SIDE * SIXEL_SIDE) * level, i / SIXEL_SIDE % SIXEL_SIDE * level,
                i % SIXEL_SIDE * level);
    for (int top = 0; top < small->height; top += 6) {
        bool used[SIXEL_SIDE * SIXEL_SIDE * SIXEL_SIDE] = { false };
        int rows = small->height - top < 6 ? small->height - top : 6;
        for (int y = 0; y < rows; y++)
            for (int x = 0; x < small->width; x++) {
                size_t at = (size_t)y * (size_t)small->width + (size_t)x;
                int color = sixel_color(small->rgb + ((size_t)top * (size_t)small->width + at) * 3, x, top + y);
                colors[at] = (unsigned char)color;
                used[color] = true;
            }
        for (int i = 0; i < all; i++)
            if (used[i])
                put_band(colors, small->width, rows, i);
        fputc('-', stderr);
    }
    fputs("\033\\\n", stderr);
}

static void put_cube(const watch_small *small)
{
    unsigned char *colors = malloc((size_t)small->width * 6);
    if (colors)
        put_sixels(small, colors);
    free(colors);
}

// ---- With libsixel ----

#ifdef GLINT_HAVE_SIXEL

#include <sixel.h>

static int write_bytes(char *bytes, int size, void *context)
{
    (void)context;
    return (int)fwrite(bytes, 1, (size_t)size, stderr);
}

// Writes the picture with libsixel. False: it failed, and nothing was written.
static bool put_chosen(const watch_small *small)
{
    sixel_output_t *output = NULL;
    sixel_dither_t *dither = NULL;
    const bool good =
        SIXEL_SUCCEEDED(sixel_output_new(&output, write_bytes, NULL, NULL)) &&
        SIXEL_SUCCEEDED(sixel_dither_new(&dither, SIXEL_PALETTE_MAX, NULL)) &&
        SIXEL_SUCCEEDED(sixel_dither_initialize(dither, small->rgb, small->width, small->height, SIXEL_PIXELFORMAT_RGB888,
                                                SIXEL_LARGE_AUTO, SIXEL_REP_AUTO, SIXEL_QUALITY_HIGH)) &&
        SIXEL_SUCCEEDED(sixel_encode(small->rgb, small->width, small->height, 3, dither, output));
    sixel_dither_unref(dither);
    sixel_output_unref(output);
    return good;
}

#else

static bool put_chosen(const watch_small *small)
{
    (void)small;
    return false;
}

#endif

void watch_sixels_put(const watch_small *small)
{
    if (put_chosen(small))
        fputc('\n', stderr);
    else
        put_cube(small);
}
