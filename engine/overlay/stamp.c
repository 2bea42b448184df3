#include "engine/overlay/overlay.h"

#include <stdlib.h>

void glint_stamps_free(glint_stamps *stamps)
{
    for (size_t i = 0; i < stamps->count; i++)
        free(stamps->of[i].coverage);
    free(stamps->of);
    *stamps = (glint_stamps) { 0 };
}

static uint16_t code_of(const glint_stamps *stamps, double linear)
{
    const double most = stamps->bits == 16 ? 65535 : 255, in = linear < 1 ? linear : 1;
    return (uint16_t)((stamps->transfer == GLINT_TRANSFER_SRGB ? glint_srgb_encode(in) : in) * most + 0.5);
}

void glint_stamps_add(glint_stamps *stamps, glint_stamp stamp, const double color[3])
{
    if (stamps->count == stamps->capacity) {
        const size_t capacity = stamps->capacity ? 2 * stamps->capacity : 16;
        glint_stamp *of = realloc(stamps->of, capacity * sizeof *of);
        if (!of) {
            free(stamp.coverage);
            stamps->lost = true;
            return;
        }
        stamps->of = of;
        stamps->capacity = capacity;
    }
    for (int c = 0; c < 3; c++)
        stamp.ink[c] = code_of(stamps, color[c]);
    stamps->of[stamps->count++] = stamp;
}

bool glint_stamps_touch(const glint_stamps *stamps, int first, int count)
{
    for (size_t i = 0; i < stamps->count; i++)
        if (stamps->of[i].y < first + count && stamps->of[i].y + stamps->of[i].height > first)
            return true;
    return false;
}

/// Blends the ink into a pixel with values up to `most`, with the coverage `share` / 255. With alpha, both colours
/// are weighted by their alphas.
static void blend(uint32_t *pixel, const uint16_t ink[3], uint32_t share, int channels, uint32_t most)
{
    const uint64_t over = (uint64_t)share * most;
    const uint64_t under = (uint64_t)(255 - share) * (channels == 4 ? pixel[3] : most);
    const uint64_t sum = over + under;
    for (int c = 0; c < 3 && sum; c++)
        pixel[c] = (uint32_t)((ink[c] * over + pixel[c] * under + sum / 2) / sum);
    pixel[3] = (uint32_t)((sum + 127) / 255);
}

static uint32_t share_at(const glint_stamp *s, int x, int y)
{
    const uint32_t coverage =
        s->coverage ? s->coverage[(size_t)(y - s->y) * (size_t)s->width + (size_t)(x - s->x)] : 255;
    return (coverage * s->opacity + 127) / 255;
}

static void row8(const glint_stamp *s, int from, int to, int x, int y, int channels, uint8_t *codes)
{
    for (int i = from; i < to; i++) {
        uint8_t *at = codes + (size_t)(i - x) * (size_t)channels;
        uint32_t pixel[4] = { at[0], at[1], at[2], channels == 4 ? at[3] : 255 };
        blend(pixel, s->ink, share_at(s, i, y), channels, 255);
        for (int c = 0; c < channels; c++)
            at[c] = (uint8_t)pixel[c];
    }
}

static void row16(const glint_stamp *s, int from, int to, int x, int y, int channels, uint16_t *codes)
{
    for (int i = from; i < to; i++) {
        uint16_t *at = codes + (size_t)(i - x) * (size_t)channels;
        uint32_t pixel[4] = { at[0], at[1], at[2], channels == 4 ? at[3] : 65535 };
        blend(pixel, s->ink, share_at(s, i, y), channels, 65535);
        for (int c = 0; c < channels; c++)
            at[c] = (uint16_t)pixel[c];
    }
}

void glint_stamps_row(const glint_stamps *stamps, int x, int y, int width, int channels, void *codes)
{
    for (size_t i = 0; i < stamps->count; i++) {
        const glint_stamp *s = &stamps->of[i];
        const int from = s->x > x ? s->x : x, to = s->x + s->width < x + width ? s->x + s->width : x + width;
        if (y < s->y || y >= s->y + s->height)
            continue;
        if (stamps->bits == 16)
            row16(s, from, to, x, y, channels, codes);
        else
            row8(s, from, to, x, y, channels, codes);
    }
}
