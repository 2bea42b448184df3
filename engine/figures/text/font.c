#include "engine/figures/text/font.h"

#include "engine/figures/text/font_table.h"

#define UNKNOWN 0xfffdu

/// Reads one character of UTF-8; an invalid byte counts as one character.
static uint32_t next_code(const uint8_t **at)
{
    uint32_t first = *(*at)++;
    int more = first < 0x80 ? 0 : first < 0xc2 ? -1 : first < 0xe0 ? 1 : first < 0xf0 ? 2 : first < 0xf5 ? 3 : -1;
    if (more < 0)
        return UNKNOWN;
    uint32_t code = more ? first & (0x3fu >> more) : first;
    for (int i = 0; i < more; i++) {
        if (((*at)[i] & 0xc0) != 0x80)
            return UNKNOWN;
        code = code << 6 | ((*at)[i] & 0x3fu);
    }
    *at += more;
    return code;
}

static const uint8_t *glyph_of(uint32_t code)
{
    for (size_t i = 0; i < sizeof font_ranges / sizeof *font_ranges; i++)
        if (code >= font_ranges[i].first && code <= font_ranges[i].last)
            return font_glyphs[font_ranges[i].glyph + (code - font_ranges[i].first)];
    return glyph_of(UNKNOWN);
}

bool glint_font_has(uint32_t code)
{
    for (size_t i = 0; i < sizeof font_ranges / sizeof *font_ranges; i++)
        if (code >= font_ranges[i].first && code <= font_ranges[i].last)
            return true;
    return false;
}

uint32_t glint_font_code(const char **text)
{
    const uint8_t *at = (const uint8_t *)*text;
    const uint32_t code = next_code(&at);
    *text = (const char *)at;
    return code;
}

size_t glint_font_encode(uint32_t code, char out[4])
{
    if (code < ' ' || (code >= 0x7f && code < 0xa0) || (code >= 0xd800 && code < 0xe000) || (code & 0xfffe) == 0xfffe || code > 0x10ffff)
        code = UNKNOWN;
    if (code < 0x80) {
        out[0] = (char)code;
        return 1;
    }
    const size_t size = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    for (size_t i = size - 1; i > 0; i--, code >>= 6)
        out[i] = (char)(0x80 | (code & 0x3f));
    out[0] = (char)((0xf0 << (4 - size) & 0xff) | code);
    return size;
}

const uint8_t *glint_font_next(const char **text) { return glyph_of(glint_font_code(text)); }

size_t glint_font_count(const char *text, size_t size)
{
    const uint8_t *at = (const uint8_t *)text;
    size_t count = 0;
    while (*at && (size_t)(at - (const uint8_t *)text) < size) {
        next_code(&at);
        count++;
    }
    return count;
}
