#include "engine/figures/ink/stamps.h"
#include "engine/glint_math.h"

#include "engine/base/status.h"

#include <stdlib.h>

void glint_stamps_free(glint_stamps *stamps)
{
    for (size_t i = 0; i < stamps->count; i++)
        free(stamps->of[i].coverage);
    free(stamps->of);
    *stamps = (glint_stamps) { 0 };
}

uint16_t glint_ink_code(double linear, glint_transfer transfer, int bits)
{
    const double most = bits == 16 ? 65535 : 255, in = linear < 1 ? linear : 1;
    return (uint16_t)((transfer == GLINT_TRANSFER_SRGB ? glint_srgb_encode(in) : in) * most + 0.5);
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
        stamp.ink[c] = glint_ink_code(color[c], stamps->transfer, stamps->bits);
    stamps->of[stamps->count++] = stamp;
}

// ---- Marks as stamps ----------------------------------------------------------------------------------------------

bool glint_stamps_mask(glint_stamps *stamps, const glint_rect *clip, int x, int y, int width, int height, glint_stamp *stamp)
{
    const int x0 = x > clip->x ? x : clip->x, y0 = y > clip->y ? y : clip->y;
    const int right = clip->x + clip->width, bottom = clip->y + clip->height;
    const int x1 = x + width < right ? x + width : right, y1 = y + height < bottom ? y + height : bottom;
    if (x0 >= x1 || y0 >= y1)
        return false;
    *stamp = (glint_stamp) { .x = x0, .y = y0, .width = x1 - x0, .height = y1 - y0, .opacity = 255 };
    stamp->coverage = calloc((size_t)stamp->width, (size_t)stamp->height);
    if (!stamp->coverage)
        stamps->lost = true;
    return stamp->coverage != NULL;
}

static void add_fill(glint_stamps *stamps, const glint_ink_mark *mark)
{
    const glint_rect *box = &mark->box, *clip = &mark->clip;
    const int right = box->x + box->width, bottom = box->y + box->height;
    const int most_x = clip->x + clip->width, most_y = clip->y + clip->height;
    glint_stamp stamp = { .x = box->x > clip->x ? box->x : clip->x, .y = box->y > clip->y ? box->y : clip->y };
    stamp.opacity = (uint8_t)(mark->opacity * 255 + 0.5);
    stamp.width = (right < most_x ? right : most_x) - stamp.x;
    stamp.height = (bottom < most_y ? bottom : most_y) - stamp.y;
    glint_stamps_add(stamps, stamp, mark->color);
}

/// Draws a text that runs down or up into a stamp: draws it level into a mask of its own, which is then turned.
static void draw_turned(glint_stamps *stamps, const glint_ink_mark *mark, const glint_line *line, const glint_stamp *stamp)
{
    const glint_rect *box = &mark->box;
    const bool down = mark->turn == GLINT_DOWN;
    const int first = down ? stamp->y - box->y : box->y + box->height - stamp->y - stamp->height;
    glint_mask level = { stamp->height, box->width, calloc((size_t)stamp->height, (size_t)box->width) };
    stamps->lost = stamps->lost || !level.coverage;
    if (!level.coverage)
        return;
    glint_line_draw(&mark->typeface, line, line->pad - first, line->above, &level);
    for (int y = 0; y < stamp->height; y++)
        for (int x = 0; x < stamp->width; x++) {
            const int across = stamp->x + x - box->x, row = down ? box->width - 1 - across : across;
            const int column = down ? y : stamp->height - 1 - y;
            stamp->coverage[(size_t)y * (size_t)stamp->width + (size_t)x] =
                level.coverage[(size_t)row * (size_t)level.width + (size_t)column];
        }
    free(level.coverage);
}

static void add_text(glint_stamps *stamps, const glint_ink_mark *mark)
{
    const glint_rect *box = &mark->box;
    glint_stamp stamp;
    glint_line line;
    if (!glint_stamps_mask(stamps, &mark->clip, box->x, box->y, box->width, box->height, &stamp))
        return;
    glint_line_set(&mark->typeface, mark->text, SIZE_MAX, &line);
    glint_mask mask = { stamp.width, stamp.height, stamp.coverage };
    if (mark->turn)
        draw_turned(stamps, mark, &line, &stamp);
    else
        glint_line_draw(&mark->typeface, &line, box->x + line.pad - stamp.x, box->y + line.above - stamp.y, &mask);
    glint_stamps_add(stamps, stamp, mark->color);
}

glint_status glint_stamps_make(const glint_ink *ink, glint_transfer transfer, int bits, glint_stamps *out, glint_error *error)
{
    static void (*const adds[])(glint_stamps *, const glint_ink_mark *) = { add_fill, add_text, glint_stamps_strokes };
    *out = (glint_stamps) { .transfer = transfer, .bits = bits };
    for (size_t i = 0; i < ink->count; i++)
        adds[ink->of[i].kind](out, &ink->of[i]);
    const glint_status status = out->lost ? glint_fail_nomem(error) : glint_ink_check(ink, error);
    if (status)
        glint_stamps_free(out);
    return status;
}

// ---- Rows ---------------------------------------------------------------------------------------------------------

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
