#include "engine/sheet/canvas.h"

#include "engine/text/font.h"

#include <stdlib.h>
#include <string.h>

bool glint_canvas_init(glint_canvas *canvas, int width, int height)
{
    size_t size = (size_t)width * (size_t)height * 3;
    *canvas = (glint_canvas) { width, height, malloc(size) };
    if (canvas->rgb)
        memset(canvas->rgb, 255, size);
    return canvas->rgb != NULL;
}

static int clamp(int value, int most) { return value < 0 ? 0 : value > most ? most : value; }

void glint_canvas_fill(glint_canvas *canvas, int x, int y, int width, int height, uint32_t color)
{
    int x0 = clamp(x, canvas->width), x1 = clamp(x + width, canvas->width);
    int y0 = clamp(y, canvas->height), y1 = clamp(y + height, canvas->height);
    for (int row = y0; row < y1; row++) {
        uint8_t *at = canvas->rgb + ((size_t)row * (size_t)canvas->width + (size_t)x0) * 3;
        for (int column = x0; column < x1; column++, at += 3) {
            at[0] = (uint8_t)(color >> 16);
            at[1] = (uint8_t)(color >> 8);
            at[2] = (uint8_t)color;
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

void glint_canvas_text(glint_canvas *canvas, int x, int y, int scale, const char *text, size_t size, uint32_t color)
{
    const char *end = text + strnlen(text, size);
    for (; text < end; x += GLINT_FONT_WIDTH * scale) {
        const uint8_t *glyph = glint_font_next(&text);
        for (int row = 0; row < GLINT_FONT_HEIGHT; row++)
            for (int column = 0; column < GLINT_FONT_WIDTH; column++)
                if (glyph[row] >> (GLINT_FONT_WIDTH - 1 - column) & 1)
                    glint_canvas_fill(canvas, x + column * scale, y + row * scale, scale, scale, color);
    }
}

void glint_canvas_text_down(glint_canvas *canvas, int x, int y, int scale, const char *text, uint32_t color)
{
    for (; *text; y += GLINT_FONT_WIDTH * scale) {
        const uint8_t *glyph = glint_font_next(&text);
        for (int row = 0; row < GLINT_FONT_HEIGHT; row++)
            for (int column = 0; column < GLINT_FONT_WIDTH; column++)
                if (glyph[row] >> (GLINT_FONT_WIDTH - 1 - column) & 1)
                    glint_canvas_fill(canvas, x - (row + 1) * scale, y + column * scale, scale, scale, color);
    }
}
