#include "engine/base/number.h"
#include "engine/files/picture/pfm.h"
#include "engine/glint.h"

#include "engine/base/status.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#define HEADER_FIELDS 4 // number of words in the header: "PF", width, height, scale

static void put_little_endian(float value, uint8_t *out)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(bits >> (8 * i));
}

/// Makes colours finite, because many programs that read pictures fail on infinity and NaN.
float glint_pfm_value(int channels, float value)
{
    if (channels == 1)
        return value;
    if (isnan(value))
        return 0;
    return isinf(value) ? copysignf(FLT_MAX, value) : value;
}

bool glint_pfm_encode(int width, int height, int channels, float *const plane[], glint_bytes *out)
{
    char header[64];
    int length = snprintf(header, sizeof header, "%s\n%d %d\n-1.0\n", channels == 3 ? "PF" : "Pf", width, height);
    size_t row = (size_t)width * (size_t)channels * 4;
    if (!glint_bytes_reserve(out, (size_t)length + row * (size_t)height))
        return false;
    memcpy(out->data + out->size, header, (size_t)length);
    uint8_t *at = out->data + out->size + length;
    for (int y = height - 1; y >= 0; y--)
        for (size_t i = (size_t)y * (size_t)width, end = i + (size_t)width; i < end; i++)
            for (int c = 0; c < channels; c++, at += 4)
                put_little_endian(glint_pfm_value(channels, plane[c][i]), at);
    out->size += (size_t)length + row * (size_t)height;
    return true;
}

// ---- Reading ------------------------------------------------------------------------------------------------------

static bool is_space(uint8_t c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Returns the position of the next word of the header. A comment runs from # to the end of its line.
static size_t skip_spaces(const uint8_t *data, size_t size, size_t i)
{
    for (bool comment = false; i < size && (comment || data[i] == '#' || is_space(data[i])); i++)
        comment = (comment || data[i] == '#') && data[i] != '\n';
    return i;
}

/// Splits the header into words. *at: the first byte of the values, after the one space that follows the last word.
static bool split_header(const uint8_t *data, size_t size, char word[HEADER_FIELDS][32], size_t *at)
{
    size_t i = 0;
    for (int field = 0; field < HEADER_FIELDS; field++) {
        size_t length = 0;
        if (field)
            i = skip_spaces(data, size, i);
        while (i < size && !is_space(data[i]) && length < 31)
            word[field][length++] = (char)data[i++];
        word[field][length] = '\0';
        if (!length || i >= size || !is_space(data[i]))
            return false;
    }
    if (data[i] == '\r' && i + 1 < size && data[i + 1] == '\n')
        i++;
    *at = i + 1;
    return true;
}

static bool parse_side(const char *word, int *side)
{
    char *end;
    long value = strtol(word, &end, 10);
    *side = (int)value;
    return *end == '\0' && word[0] >= '0' && word[0] <= '9' && value >= 1 && value <= GLINT_SIDE_MAX;
}

static bool parse_header(const uint8_t *data, size_t size, glint_pfm *pfm, bool *little, size_t *at)
{
    char word[HEADER_FIELDS][32];
    if (!split_header(data, size, word, at) || word[0][0] != 'P' || (word[0][1] != 'F' && word[0][1] != 'f') ||
        word[0][2] != '\0')
        return false;
    pfm->channels = word[0][1] == 'F' ? 3 : 1;
    char *end;
    double scale = glint_read_double(word[3], &end);
    *little = scale < 0;
    return parse_side(word[1], &pfm->width) && parse_side(word[2], &pfm->height) && *end == '\0' &&
           (scale < 0 || scale > 0);
}

uint64_t glint_pfm_bytes(const uint8_t *head, size_t size)
{
    glint_pfm pfm = { 0 };
    bool little;
    size_t at;
    if (!parse_header(head, size, &pfm, &little, &at))
        return 0;
    return at + (uint64_t)pfm.width * (uint64_t)pfm.height * (uint64_t)pfm.channels * 4;
}

static float get_value(const uint8_t *p, bool little)
{
    uint32_t bits = 0;
    for (int i = 0; i < 4; i++)
        bits |= (uint32_t)p[i] << (little ? 8 * i : 24 - 8 * i);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

glint_status glint_pfm_decode(const uint8_t *data, size_t size, glint_pfm *out, glint_error *error)
{
    glint_pfm pfm = { 0 };
    bool little = true;
    size_t at = 0;
    if (!parse_header(data, size, &pfm, &little, &at))
        return glint_fail(error, GLINT_ERR_FORMAT, "not a PFM: PF or Pf, width, height and scale expected");
    size_t row = (size_t)pfm.width * (size_t)pfm.channels, count = row * (size_t)pfm.height;
    if ((size - at) / 4 != count || (size - at) % 4)
        return glint_fail(error, GLINT_ERR_FORMAT, "not a whole PFM: %zu bytes of values expected, got %zu", count * 4,
                          size - at);
    pfm.values = malloc(count * sizeof *pfm.values);
    if (!pfm.values)
        return glint_fail_nomem(error);
    for (size_t y = 0; y < (size_t)pfm.height; y++) {
        const uint8_t *from = data + at + ((size_t)pfm.height - 1 - y) * row * 4;
        for (size_t i = 0; i < row; i++)
            pfm.values[y * row + i] = get_value(from + 4 * i, little);
    }
    *out = pfm;
    return GLINT_OK;
}
