/// Small PNG files for tests, written only by libpng.
#ifndef GLINT_PNG_CASE_H
#define GLINT_PNG_CASE_H

#include <png.h>
#include <stdio.h>
#include <stdlib.h>

/// Writes a PNG. `color` is PNG_COLOR_TYPE_*. Samples are in rows from the top, 16-bit samples in native byte order.
/// With gamma 0, the file has no gAMA chunk. Aborts on failure.
static inline void write_png(const char *path, int width, int height, int color, int bits, double gamma,
                             const void *samples)
{
    FILE *file = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    if (!file || !info)
        abort();
    png_init_io(png, file);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, bits, color, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (gamma > 0)
        png_set_gAMA(png, info, gamma);
    if (color == PNG_COLOR_TYPE_PALETTE)
        png_set_PLTE(png, info, (png_color[]) { { 255, 0, 0 }, { 0, 255, 0 }, { 0, 0, 255 }, { 9, 9, 9 } }, 4);
    png_write_info(png, info);
    if (bits == 16)
        png_set_swap(png);
    const size_t row = png_get_rowbytes(png, info);
    for (int y = 0; y < height; y++)
        png_write_row(png, (png_const_bytep)samples + (size_t)y * row);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    fclose(file);
}

#endif
