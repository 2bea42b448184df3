#include "engine/text/typeface.h"

#include "engine/text/font.h"

#include <stdbool.h>
#include <string.h>

glint_typeface glint_typeface_open(double pixels)
{
    const int scale = (int)(pixels / GLINT_FONT_HEIGHT + 0.5);
    glint_typeface typeface = { .scale = scale < 1 ? 1 : scale };
    typeface.height = GLINT_FONT_HEIGHT * typeface.scale;
    typeface.line = (GLINT_FONT_HEIGHT + 2) * typeface.scale;
    return typeface;
}

int glint_typeface_width(const glint_typeface *typeface, const char *text, size_t size)
{
    return (int)glint_font_count(text, size) * GLINT_FONT_WIDTH * typeface->scale;
}

static void cover(glint_mask *mask, int x, int y, int size)
{
    for (int row = y < 0 ? 0 : y; row < y + size && row < mask->height; row++)
        for (int column = x < 0 ? 0 : x; column < x + size && column < mask->width; column++)
            mask->coverage[(size_t)row * (size_t)mask->width + (size_t)column] = 255;
}

void glint_typeface_draw(const glint_typeface *typeface, const char *text, size_t size, int x, int y, glint_mask *mask)
{
    const char *end = text + strnlen(text, size);
    const int scale = typeface->scale;
    for (; text < end; x += GLINT_FONT_WIDTH * scale) {
        const uint8_t *glyph = glint_font_next(&text);
        for (int row = 0; row < GLINT_FONT_HEIGHT; row++)
            for (int column = 0; column < GLINT_FONT_WIDTH; column++)
                if (glyph[row] >> (GLINT_FONT_WIDTH - 1 - column) & 1)
                    cover(mask, x + column * scale, y + row * scale, scale);
    }
}
