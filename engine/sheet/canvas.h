/// A picture of 8-bit RGB or RGBA to draw figures on. Colours are 0xRRGGBB; drawing is clipped to the picture.
/// Internal.
#ifndef GLINT_IMAGE_CANVAS_H
#define GLINT_IMAGE_CANVAS_H

#include "engine/text/typeface.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct glint_canvas {
    int width, height;
    int channels; ///< 3 or 4
    uint8_t *pixels; ///< channels * width * height values, top row first; the owner frees them
} glint_canvas;

/// Fills the canvas with white; with alpha, with transparency. False: out of memory.
bool glint_canvas_init(glint_canvas *canvas, int width, int height, bool alpha);
void glint_canvas_fill(glint_canvas *canvas, int x, int y, int width, int height, uint32_t color);
/// Draws a frame just outside a rectangle.
void glint_canvas_frame(glint_canvas *canvas, int x, int y, int width, int height, int thickness, uint32_t color);
/// Draws the first `size` bytes of UTF-8 text, at most to its end, with its top left at x, y. False: out of memory.
bool glint_canvas_text(glint_canvas *canvas, const glint_typeface *typeface, int x, int y, const char *text, size_t size,
                       uint32_t color);
/// Draws text downwards, turned a quarter clockwise, with its top right at x, y. False: out of memory.
bool glint_canvas_text_down(glint_canvas *canvas, const glint_typeface *typeface, int x, int y, const char *text,
                            uint32_t color);

#endif
