#include "engine/figures/text/typeface.h"
#include "engine/glint.h"

#include "engine/figures/text/font.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

int glint_typeface_scale(double em)
{
    const int scale = (int)(em / GLINT_FONT_HEIGHT + 0.5);
    return scale < 1 ? 1 : scale;
}

glint_typeface glint_typeface_open(glint_letters *letters, double em)
{
    glint_typeface typeface = { .letters = letters, .em = em };
    if (letters) {
        int below;
        glint_letters_measure(letters, em, &typeface.above, &below, &typeface.line);
        typeface.height = typeface.above + below;
        return typeface;
    }
    typeface.scale = glint_typeface_scale(em);
    typeface.above = GLINT_FONT_ABOVE * typeface.scale;
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

double glint_typeface_place(const glint_typeface *typeface, const glint_run *run, glint_letter *out)
{
    const char *text = run->text, *end = text + strnlen(text, run->size);
    double x = 0;
    if (typeface->letters)
        return glint_letters_place(typeface->letters, run, out);
    for (; text < end; x += GLINT_FONT_WIDTH * glint_typeface_scale(run->em)) {
        const uint32_t code = glint_font_code(&text);
        *out++ = (glint_letter) { code, code, x };
    }
    return x;
}

bool glint_typeface_has(const glint_typeface *typeface, uint32_t code)
{
    return typeface->letters ? glint_letters_has(typeface->letters, code) : glint_font_has(code);
}

double glint_typeface_advance(const glint_typeface *typeface, const glint_run *run)
{
    if (typeface->letters)
        return glint_letters_advance(typeface->letters, run);
    return (double)glint_font_count(run->text, run->size) * GLINT_FONT_WIDTH * glint_typeface_scale(run->em);
}

/// Writes the edges of the box around a glyph of the bitmap font, in pixels of that font: left, right, top and bottom.
/// False: the glyph is blank.
static bool glyph_box(const uint8_t *glyph, int box[4])
{
    box[0] = GLINT_FONT_WIDTH;
    box[1] = box[3] = 0;
    box[2] = GLINT_FONT_HEIGHT;
    for (int row = 0; row < GLINT_FONT_HEIGHT; row++)
        for (int column = 0; column < GLINT_FONT_WIDTH; column++)
            if (glyph[row] >> (GLINT_FONT_WIDTH - 1 - column) & 1) {
                box[0] = column < box[0] ? column : box[0];
                box[1] = column >= box[1] ? column + 1 : box[1];
                box[2] = row < box[2] ? row : box[2];
                box[3] = row + 1;
            }
    return box[3] > 0;
}

static glint_run_box bitmap_ink(const glint_run *run)
{
    const char *text = run->text, *end = text + strnlen(text, run->size);
    const double scale = glint_typeface_scale(run->em), tall = scale * run->stretch;
    glint_run_box ink = { 0 };
    bool has_ink = false;
    for (int i = 0, box[4]; text < end; i++) {
        if (!glyph_box(glint_font_next(&text), box))
            continue;
        const double left = (i * GLINT_FONT_WIDTH + box[0]) * scale, right = (i * GLINT_FONT_WIDTH + box[1]) * scale;
        const double above = (GLINT_FONT_ABOVE - box[2]) * tall, below = (box[3] - GLINT_FONT_ABOVE) * tall;
        ink.left = has_ink ? ink.left : left;
        ink.right = right;
        ink.above = has_ink ? fmax(ink.above, above) : above;
        ink.below = has_ink ? fmax(ink.below, below) : below;
        has_ink = true;
    }
    return ink;
}

glint_run_box glint_typeface_box(const glint_typeface *typeface, const glint_run *run)
{
    return typeface->letters ? glint_letters_box(typeface->letters, run) : bitmap_ink(run);
}

static void cover(glint_mask *mask, int x, int y, int width, int height)
{
    for (int row = y < 0 ? 0 : y; row < y + height && row < mask->height; row++)
        for (int column = x < 0 ? 0 : x; column < x + width && column < mask->width; column++)
            mask->coverage[(size_t)row * (size_t)mask->width + (size_t)column] = 255;
}

/// Draws a run of the bitmap font.
static void draw_bitmap(const glint_run *run, glint_mask *mask)
{
    const char *text = run->text, *end = text + strnlen(text, run->size);
    const int scale = glint_typeface_scale(run->em), wide = scale + (run->bold ? (scale + 1) / 2 : 0);
    const double tall = scale * run->stretch;
    double pen = floor(run->x + 0.5);
    for (; text < end && pen < mask->width; pen += GLINT_FONT_WIDTH * scale) {
        const int x = (int)pen;
        const uint8_t *glyph = glint_font_next(&text);
        for (int row = 0; row < GLINT_FONT_HEIGHT; row++) {
            const int y = (int)floor(run->y + (row - GLINT_FONT_ABOVE) * tall + 0.5);
            const int below = (int)floor(run->y + (row + 1 - GLINT_FONT_ABOVE) * tall + 0.5);
            for (int column = 0; column < GLINT_FONT_WIDTH; column++)
                if (glyph[row] >> (GLINT_FONT_WIDTH - 1 - column) & 1)
                    cover(mask, x + column * scale, y, wide, below - y);
        }
    }
}

void glint_typeface_draw(const glint_typeface *typeface, const glint_run *run, glint_mask *mask)
{
    if (typeface->letters)
        glint_letters_draw(typeface->letters, run, mask);
    else
        draw_bitmap(run, mask);
}
