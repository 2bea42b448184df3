#include "engine/base/number.h"
#include "engine/files/picture/hdr.h"

#include "engine/base/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE_BYTES 256 // of a line of the header, those that are looked at

/// A picture while it is read. Lines are rows, or columns in some orientations.
typedef struct hdr_input {
    const uint8_t *at, *end;
    double gain[3]; ///< product of the divisors in the header, for each channel
    uint32_t lines, pixels; ///< number of lines, and of pixels in each
    bool columns; ///< lines are columns
    bool from_bottom, from_right;
} hdr_input;

bool glint_is_hdr(const uint8_t *data, size_t size) { return size >= 2 && data[0] == '#' && data[1] == '?'; }

// ---- Header -------------------------------------------------------------------------------------------------------

/// Reads a line of the header without its end, or the beginning of a long one. False: the file ends.
static bool read_line(hdr_input *in, char line[LINE_BYTES])
{
    size_t length = 0;
    for (; in->at < in->end && *in->at != '\n'; in->at++)
        if (length + 1 < LINE_BYTES)
            line[length++] = (char)*in->at;
    if (in->at == in->end)
        return false;
    in->at++;
    if (length > 0 && line[length - 1] == '\r')
        length--;
    line[length] = '\0';
    return true;
}

/// Reads one line of the header's variables.
static glint_status read_variable(hdr_input *in, const char *line, glint_error *error)
{
    double by[3];
    if (strncmp(line, "FORMAT=", 7) == 0 && strcmp(line + 7, "32-bit_rle_rgbe") != 0)
        return glint_fail(error, GLINT_ERR_FORMAT, "FORMAT: 32-bit_rle_rgbe expected, got %.60s", line + 7);
    const bool exposure = strncmp(line, "EXPOSURE=", 9) == 0;
    if (!exposure && strncmp(line, "COLORCORR=", 10) != 0)
        return GLINT_OK;
    const char *at = line + (exposure ? 9 : 10);
    char *end;
    for (int c = 0; c < 3; c++, at = end) {
        by[c] = exposure && c > 0 ? by[0] : glint_read_double(at, &end);
        if (end == at && !(exposure && c > 0))
            return GLINT_OK;
    }
    for (int c = 0; c < 3; c++)
        in->gain[c] *= by[c];
    return GLINT_OK;
}

/// Reads the line of the resolution, such as "-Y 512 +X 1024".
static glint_status read_size(hdr_input *in, const char *line, size_t most, glint_error *error)
{
    char sign[2], axis[2];
    unsigned count[2];
    int length = 0;
    const bool read = sscanf(line, "%c%c %5u %c%c %5u%n", &sign[0], &axis[0], &count[0], &sign[1], &axis[1], &count[1], &length) == 6;
    const bool known = read && !line[length] && (sign[0] == '+' || sign[0] == '-') && (sign[1] == '+' || sign[1] == '-') &&
                       ((axis[0] == 'Y' && axis[1] == 'X') || (axis[0] == 'X' && axis[1] == 'Y'));
    if (!known || count[0] < 1 || count[1] < 1 || count[0] > 65535 || count[1] > 65535)
        return glint_fail(error, GLINT_ERR_FORMAT, "a size such as -Y 512 +X 1024 expected, got %.60s", line);
    if ((size_t)count[0] * count[1] > most)
        return glint_fail(error, GLINT_ERR_FORMAT, "a picture of at most %zu pixels expected, got %u x %u", most,
                          count[axis[0] == 'X' ? 0 : 1], count[axis[0] == 'X' ? 1 : 0]);
    in->lines = count[0];
    in->pixels = count[1];
    in->columns = axis[0] == 'X';
    in->from_bottom = sign[in->columns ? 1 : 0] == '+';
    in->from_right = sign[in->columns ? 0 : 1] == '-';
    return GLINT_OK;
}

static glint_status read_header(hdr_input *in, size_t most, glint_error *error)
{
    char line[LINE_BYTES];
    glint_status status = GLINT_OK;
    bool good = read_line(in, line);
    while (good && !status && *line) {
        good = read_line(in, line);
        status = good ? read_variable(in, line, error) : GLINT_OK;
    }
    if (status)
        return status;
    if (!good || !read_line(in, line))
        return glint_fail(error, GLINT_ERR_FORMAT, "not a whole Radiance picture: its header has no end");
    for (int c = 0; c < 3; c++)
        if (!(in->gain[c] > 0) || isinf(in->gain[c]))
            return glint_fail(error, GLINT_ERR_FORMAT, "EXPOSURE and COLORCORR: numbers > 0 expected");
    return read_size(in, line, most, error);
}

// ---- Lines --------------------------------------------------------------------------------------------------------

/// Reads one of the four bytes of all pixels of a line, in runs. False: there is too little, or a run too long.
static bool read_runs(hdr_input *in, uint8_t (*line)[4], int part)
{
    for (uint32_t i = 0; i < in->pixels;) {
        if (in->end - in->at < 2)
            return false;
        const uint8_t code = *in->at++;
        const bool run = code > 128;
        const uint32_t count = run ? code - 128u : code;
        if (count == 0 || count > in->pixels - i || (!run && (size_t)(in->end - in->at) < count))
            return false;
        for (uint32_t k = 0; k < count; k++)
            line[i + k][part] = in->at[run ? 0 : k];
        in->at += run ? 1 : count;
        i += count;
    }
    return true;
}

/// Reads a line of whole pixels. A pixel 1, 1, 1, n repeats the one before it n times; several are digits, from the
/// lowest.
static bool read_pixels(hdr_input *in, uint8_t (*line)[4])
{
    int shift = 0;
    for (uint32_t i = 0; i < in->pixels;) {
        if (in->end - in->at < 4)
            return false;
        const uint8_t *p = in->at;
        in->at += 4;
        if (p[0] != 1 || p[1] != 1 || p[2] != 1) {
            memcpy(line[i++], p, 4);
            shift = 0;
            continue;
        }
        const uint64_t count = shift < 32 ? (uint64_t)p[3] << shift : UINT64_MAX;
        if (i == 0 || count > in->pixels - i)
            return false;
        for (uint64_t k = 0; k < count; k++, i++)
            memcpy(line[i], line[i - 1], 4);
        shift += 8;
    }
    return true;
}

static bool read_line_of_pixels(hdr_input *in, uint8_t (*line)[4])
{
    const uint8_t *p = in->at;
    if (in->end - p < 4 || p[0] != 2 || p[1] != 2 || p[2] > 127 || ((uint32_t)p[2] << 8 | p[3]) != in->pixels)
        return read_pixels(in, line);
    in->at += 4;
    for (int part = 0; part < 4; part++)
        if (!read_runs(in, line, part))
            return false;
    return true;
}

/// Stores line k in the picture.
static void store(const hdr_input *in, uint32_t k, uint8_t (*line)[4], glint_pfm *out)
{
    const size_t width = (size_t)out->width, height = (size_t)out->height;
    for (uint32_t i = 0; i < in->pixels; i++) {
        const size_t x = in->columns ? k : i, y = in->columns ? i : k;
        float *to = out->values + 3 * ((in->from_bottom ? height - 1 - y : y) * width + (in->from_right ? width - 1 - x : x));
        for (int c = 0; c < 3; c++)
            to[c] = line[i][3] ? (float)(ldexp(line[i][c], line[i][3] - 136) / in->gain[c]) : 0;
    }
}

glint_status glint_hdr_decode(const uint8_t *data, size_t size, size_t most, glint_pfm *out, glint_error *error)
{
    hdr_input in = { .at = data, .end = data + size, .gain = { 1, 1, 1 } };
    glint_status status = read_header(&in, most, error);
    if (status)
        return status;
    glint_pfm picture = { .width = (int)(in.columns ? in.lines : in.pixels), .height = (int)(in.columns ? in.pixels : in.lines), .channels = 3 };
    uint8_t(*line)[4] = malloc(in.pixels * sizeof *line);
    picture.values = malloc((size_t)in.lines * in.pixels * 3 * sizeof *picture.values);
    if (!line || !picture.values)
        status = glint_fail_nomem(error);
    for (uint32_t k = 0; k < in.lines && !status; k++) {
        if (read_line_of_pixels(&in, line))
            store(&in, k, line, &picture);
        else
            status = glint_fail(error, GLINT_ERR_FORMAT, "not a whole Radiance picture: line %u of %u cannot be read", k + 1, in.lines);
    }
    free(line);
    if (status)
        free(picture.values);
    else
        *out = picture;
    return status;
}
