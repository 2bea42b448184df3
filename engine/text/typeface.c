#include "engine/text/typeface.h"

#include "engine/text/font.h"

#include <stdbool.h>
#include <string.h>

glint_typeface glint_typeface_open(glint_letters *letters, double em)
{
    glint_typeface typeface = { .letters = letters, .em = em };
    if (letters) {
        int below;
        glint_letters_measure(letters, em, &typeface.above, &below, &typeface.line);
        typeface.height = typeface.above + below;
        return typeface;
    }
    const int scale = (int)(em / GLINT_FONT_HEIGHT + 0.5);
    typeface.scale = scale < 1 ? 1 : scale;
    typeface.height = GLINT_FONT_HEIGHT * typeface.scale;
    typeface.line = (GLINT_FONT_HEIGHT + 2) * typeface.scale;
    return typeface;
}

int glint_typeface_width(const glint_typeface *typeface, const char *text, size_t size)
{
    if (typeface->letters)
        return glint_letters_width(typeface->letters, typeface->em, text, size);
    const size_t count = glint_font_count(text, size);
    return (count < GLINT_SIDE_MAX ? (int)count : GLINT_SIDE_MAX) * GLINT_FONT_WIDTH * typeface->scale;
}

bool glint_typeface_has(const glint_typeface *typeface, uint32_t code)
{
    return typeface->letters ? glint_letters_has(typeface->letters, code) : glint_font_has(code);
}

static void cover(glint_mask *mask, int x, int y, int size)
{
    for (int row = y < 0 ? 0 : y; row < y + size && row < mask->height; row++)
        for (int column = x < 0 ? 0 : x; column < x + size && column < mask->width; column++)
            mask->coverage[(size_t)row * (size_t)mask->width + (size_t)column] = 255;
}

void glint_typeface_draw(const glint_typeface *typeface, const char *text, size_t size, int x, int y, glint_mask *mask)
{
    if (typeface->letters) {
        glint_letters_draw(typeface->letters, typeface->em, text, size, x, y + typeface->above, mask);
        return;
    }
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
