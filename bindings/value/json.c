// Writes numbers and strings as JSON, and text for people.
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/value/glintL.h"

void glintL_format_number(char out[32], double value)
{
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(out, 32, "%.*g", digits, value);
        if (strtod(out, NULL) == value)
            return;
    }
}

void glintL_json_number(FILE *out, double value)
{
    char text[32] = "null";
    if (isfinite(value))
        glintL_format_number(text, value);
    fputs(text, out);
}

// Returns the bytes of the UTF-8 character at `text`; 0: it is not well formed.
static size_t character_length(const unsigned char *text)
{
    static const unsigned least[5] = { 0, 0, 0x80, 0x800, 0x10000 };
    size_t length = text[0] < 0x80 ? 1 : text[0] >= 0xf0 ? 4 : text[0] >= 0xe0 ? 3 : 2;
    if (length == 1)
        return 1;
    if (text[0] < 0xc2 || text[0] > 0xf4)
        return 0;
    unsigned code = text[0] & (0xffu >> (length + 1));
    for (size_t i = 1; i < length; i++) {
        if ((text[i] & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (text[i] & 0x3fu);
    }
    return code < least[length] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000) ? 0 : length;
}

// Returns the code of a character of two or three bytes.
static unsigned code_of(const unsigned char *at, size_t length)
{
    return length == 2 ? (at[0] & 0x1fu) << 6 | (at[1] & 0x3fu)
                       : (at[0] & 0x0fu) << 12 | (at[1] & 0x3fu) << 6 | (at[2] & 0x3fu);
}

// Returns whether a character controls a terminal or the direction of text.
static bool is_control(unsigned code)
{
    return (code >= 0x80 && code < 0xa0) || (code >= 0x200e && code <= 0x200f) || (code >= 0x2028 && code <= 0x202e) ||
           (code >= 0x2066 && code <= 0x2069);
}

void glintL_put_text(FILE *out, const char *text, size_t size)
{
    const unsigned char *at = (const unsigned char *)text, *end = at + size, *plain = at;
    while (at < end) {
        const size_t length = character_length(at), step = length ? length : 1;
        const unsigned code = length == 2 || length == 3 ? code_of(at, length) : 0;
        const bool byte = (*at < 0x20 && *at != '\n' && *at != '\t') || *at == 0x7f || length == 0;
        if (byte || is_control(code)) {
            fwrite(plain, 1, (size_t)(at - plain), out);
            fprintf(out, byte ? "\\x%02x" : "\\u%04x", byte ? *at : code);
            plain = at + step;
        }
        at += step;
    }
    fwrite(plain, 1, (size_t)(at - plain), out);
}

void glintL_json_string(FILE *out, const char *text)
{
    fputc('"', out);
    for (const unsigned char *at = (const unsigned char *)text; *at;) {
        size_t length = character_length(at);
        if (*at == '"' || *at == '\\')
            fprintf(out, "\\%c", *at);
        else if (*at == '\n')
            fputs("\\n", out);
        else if (*at == '\t')
            fputs("\\t", out);
        else if (*at < 0x20 || *at == 0x7f)
            fprintf(out, "\\u%04x", *at);
        else if (length == 0)
            fputs("\\ufffd", out); // not UTF-8: paths may contain such bytes
        else
            fwrite(at, 1, length, out);
        at += length ? length : 1;
    }
    fputc('"', out);
}

void glintL_json(FILE *out, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    for (const char *at = format; *at; at++) {
        if (*at != '%') {
            fputc(*at, out);
        } else if (*++at == 'g') {
            glintL_json_number(out, va_arg(args, double));
        } else {
            const char *text = va_arg(args, const char *);
            if (text)
                glintL_json_string(out, text);
            else
                fputs("null", out);
        }
    }
    va_end(args);
}
