/// A picture of 8-bit RGB to draw on: fills, frames and text. What lies outside is cut off. Internal.
#ifndef GLINT_IMAGE_CANVAS_H
#define GLINT_IMAGE_CANVAS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct glint_canvas {
    int width, height;
    uint8_t *rgb; ///< 3 * width * height; the owner calls free
} glint_canvas;

/// Makes it white. False: out of memory.
bool glint_canvas_init(glint_canvas *canvas, int width, int height);
/// `color` is 0xRRGGBB here and below.
void glint_canvas_fill(glint_canvas *canvas, int x, int y, int width, int height, uint32_t color);
/// A frame of `thickness` pixels around the rectangle, outside it.
void glint_canvas_frame(glint_canvas *canvas, int x, int y, int width, int height, int thickness, uint32_t color);
/// The first `size` bytes of UTF-8 (to the end at most), the top left at x, y, each pixel of the font `scale` wide.
void glint_canvas_text(glint_canvas *canvas, int x, int y, int scale, const char *text, size_t size, uint32_t color);
/// The same, turned a quarter to the right: it reads downwards, and x, y is the top right of its column.
void glint_canvas_text_down(glint_canvas *canvas, int x, int y, int scale, const char *text, uint32_t color);

#endif
