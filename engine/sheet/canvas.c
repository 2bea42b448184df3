#include "engine/sheet/canvas.h"

#include "engine/overlay/overlay.h"

#include <stdlib.h>
#include <string.h>

bool glint_canvas_init(glint_canvas *canvas, int width, int height, bool alpha)
{
    const int channels = alpha ? 4 : 3;
    const size_t size = (size_t)width * (size_t)height * (size_t)channels;
    *canvas = (glint_canvas) { width, height, channels, malloc(size) };
    if (canvas->pixels)
        memset(canvas->pixels, alpha ? 0 : 255, size);
    return canvas->pixels != NULL;
}

static int clamp(int value, int most) { return value < 0 ? 0 : value > most ? most : value; }

void glint_canvas_fill(glint_canvas *canvas, int x, int y, int width, int height, uint32_t color)
{
    int x0 = clamp(x, canvas->width), x1 = clamp(x + width, canvas->width);
    int y0 = clamp(y, canvas->height), y1 = clamp(y + height, canvas->height);
    for (int row = y0; row < y1; row++) {
        uint8_t *at = canvas->pixels + ((size_t)row * (size_t)canvas->width + (size_t)x0) * (size_t)canvas->channels;
        for (int column = x0; column < x1; column++, at += canvas->channels) {
            at[0] = (uint8_t)(color >> 16);
            at[1] = (uint8_t)(color >> 8);
            at[2] = (uint8_t)color;
            if (canvas->channels == 4)
                at[3] = 255;
        }
    }
}

void glint_canvas_frame(glint_canvas *canvas, int x, int y, int width, int height, int thickness, uint32_t color)
{
    int t = thickness;
    glint_canvas_fill(canvas, x - t, y - t, width + 2 * t, t, color);
    glint_canvas_fill(canvas, x - t, y + height, width + 2 * t, t, color);
    glint_canvas_fill(canvas, x - t, y, t, height, color);
    glint_canvas_fill(canvas, x + width, y, t, height, color);
}

/// Draws a mask and frees it.
static void draw_mask(glint_canvas *canvas, int x, int y, glint_mask *mask, uint32_t color)
{
    glint_stamp stamp = { .x = x, .y = y, .width = mask->width, .height = mask->height, .coverage = mask->coverage, .opacity = 255 };
    const glint_stamps stamps = { .of = &stamp, .count = 1, .bits = 8 };
    for (int c = 0; c < 3; c++)
        stamp.ink[c] = color >> (16 - 8 * c) & 255;
    for (int row = y < 0 ? 0 : y; row < y + mask->height && row < canvas->height; row++)
        glint_stamps_row(&stamps, 0, row, canvas->width, canvas->channels,
                         canvas->pixels + (size_t)row * (size_t)canvas->width * (size_t)canvas->channels);
    free(mask->coverage);
}

/// Makes the mask of a text; `most` limits the text's length in pixels. False: out of memory.
static bool make_mask(const glint_typeface *typeface, const char *text, size_t size, int most, glint_mask *mask)
{
    const int width = glint_typeface_width(typeface, text, size);
    *mask = (glint_mask) { .width = width < most ? width : most, .height = typeface->height };
    mask->coverage = calloc((size_t)mask->width + 1, (size_t)mask->height);
    if (mask->coverage)
        glint_typeface_draw(typeface, text, size, 0, 0, mask);
    return mask->coverage != NULL;
}

bool glint_canvas_text(glint_canvas *canvas, const glint_typeface *typeface, int x, int y, const char *text, size_t size,
                       uint32_t color)
{
    glint_mask mask;
    if (!make_mask(typeface, text, size, canvas->width - (x < 0 ? x : 0), &mask))
        return false;
    draw_mask(canvas, x, y, &mask, color);
    return true;
}

bool glint_canvas_text_down(glint_canvas *canvas, const glint_typeface *typeface, int x, int y, const char *text,
                            uint32_t color)
{
    glint_mask along, down;
    if (!make_mask(typeface, text, SIZE_MAX, canvas->height - (y < 0 ? y : 0), &along))
        return false;
    down = (glint_mask) { along.height, along.width, calloc((size_t)along.width + 1, (size_t)along.height) };
    for (int row = 0; row < along.height && down.coverage; row++)
        for (int column = 0; column < along.width; column++)
            down.coverage[(size_t)column * (size_t)down.width + (size_t)(down.width - 1 - row)] =
                along.coverage[(size_t)row * (size_t)along.width + (size_t)column];
    free(along.coverage);
    if (!down.coverage)
        return false;
    draw_mask(canvas, x - down.width, y, &down, color);
    return true;
}
