#include "engine/frame/refine.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/film/tone.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CHANNELS_MAX 4 ///< of codes, which may have alpha
#define BAND 16 ///< rows that one thread compares, one after the other

/// Pixels that are compared at a time: the compiler makes vectors of loops of so many.
#define RUN 16

// ---- How far apart colours are ----
//
// A base without codes has their estimates, which need no table and are made by vectors: of the code before it is rounded, sRGB's power
// by a sum of three roots. That has sRGB's derivative but for a share of ESTIMATE_SHARE, so that the estimates of two colours are as far
// apart as their codes but for that share of it, and for the rounding of three codes and of float. Only where that leaves the
// choice open the codes are made, by their definition.

#define ESTIMATE_SHARE 0.004f
#define ESTIMATE_SLACK 4.0f ///< codes

typedef struct chooser {
    const glint_image *base;
    const glint_extent *extent;
    const glint_tone_desc *tone; ///< of the codes
    glint_refine *refine;
    uint32_t least; ///< sum of differences of codes that is not enough
    float low, high; ///< a sum of differences of estimates that is not enough for certain; that is enough if it is exceeded
} chooser;

/// The codes of `count` values of light after exposure as they would be without rounding, less or more. `rest`: room for as many, so
/// that both parts of sRGB are made by vectors.
static void estimate(float gain, const float *restrict light, size_t count, float *restrict rest, float *restrict out)
{
    for (size_t i = 0; i < count; i++) {
        float x = gain * light[i];
        x = x > 0 ? x : 0; // NaN gives 0
        out[i] = x < 1 ? x : 1;
    }
    for (size_t i = 0; i < count; i++) {
        const float second = sqrtf(out[i]), fourth = sqrtf(second), eighth = sqrtf(fourth);
        rest[i] = (float)(65535 * 0.5723742167) * second + (float)(65535 * 0.8301947475) * fourth -
                  (float)(65535 * 0.4193434603) * eighth + (float)(65535 * 0.01599656894);
    }
    for (size_t i = 0; i < count; i++) {
        const float dark = (float)(65535 * 12.92) * out[i], bright = rest[i];
        out[i] = dark <= (float)(65535 * 12.92 * 0.0031308) ? dark : bright;
    }
}

/// What is rendered of a row of the base, and its codes or their estimates as numbers, channel by channel.
typedef struct row_view {
    const float *id, *normal[3], *code[CHANNELS_MAX];
    size_t channels, first; ///< where the row begins in the planes
} row_view;

static void take_codes(const chooser *c, size_t first, float *memory)
{
    const size_t width = (size_t)c->extent->width, channels = (size_t)c->base->channels;
    const uint16_t *codes = (const uint16_t *)c->base->codes + first * channels;
    for (size_t k = 0; k < channels; k++)
        for (size_t x = 0; x < width; x++)
            memory[k * width + x] = codes[x * channels + k];
}

static void estimate_codes(const chooser *c, size_t first, float *memory)
{
    const size_t width = (size_t)c->extent->width;
    const float gain = glint_tone_gain(c->tone);
    for (size_t k = 0; k < 3; k++)
        estimate(gain, c->base->plane[GLINT_PASS_BEAUTY][k] + first, width, memory + 3 * width, memory + k * width);
}

static row_view view_row(const chooser *c, size_t y, float *memory)
{
    const glint_image *base = c->base;
    const size_t width = (size_t)c->extent->width;
    const size_t first = y * (size_t)base->width + (size_t)c->extent->x;
    row_view row = { .id = base->plane[GLINT_PASS_OBJECT_ID][0] + first,
                     .channels = base->codes ? (size_t)base->channels : 3,
                     .first = first };
    for (size_t k = 0; k < 3; k++)
        row.normal[k] = base->plane[GLINT_PASS_NORMAL][k] + first;
    for (size_t k = 0; k < row.channels; k++)
        row.code[k] = memory + k * width;
    if (base->codes)
        take_codes(c, first, memory);
    else
        estimate_codes(c, first, memory);
    return row;
}

/// Whether the codes of two pixels of the base are far enough apart.
static bool exceeds(const chooser *c, size_t p, size_t q)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const float *light = c->base->plane[GLINT_PASS_BEAUTY][k];
        sum += fabs(glint_tone_value(c->tone, (double)light[p]) - glint_tone_value(c->tone, (double)light[q]));
    }
    return sum > c->least;
}

enum { DIFFER = 1, MAY_DIFFER = 2 };

/// Which of `count` pixels, at most RUN, from p of a row on are worth a closer look, as are as many from q of another on: bits of the
/// above. Returns whether any is.
static inline int differ(const chooser *c, const row_view *a, size_t p, const row_view *b, size_t q, size_t count,
                         int *restrict out)
{
    float sum[RUN];
    int any = 0;
    for (size_t i = 0; i < count; i++)
        sum[i] = (fabsf(a->code[0][p + i] - b->code[0][q + i]) + fabsf(a->code[1][p + i] - b->code[1][q + i])) +
                 fabsf(a->code[2][p + i] - b->code[2][q + i]);
    for (size_t i = 0; a->channels > 3 && i < count; i++)
        sum[i] += fabsf(a->code[3][p + i] - b->code[3][q + i]);
    for (size_t i = 0; i < count; i++) {
        const float cosine = (a->normal[0][p + i] * b->normal[0][q + i] + a->normal[1][p + i] * b->normal[1][q + i]) +
                             a->normal[2][p + i] * b->normal[2][q + i];
        out[i] = (a->id[p + i] != b->id[q + i]) | (sum[i] > c->high) |
                 ((a->id[p + i] > 0) & (cosine < GLINT_REFINE_NORMAL)) | (sum[i] > c->low) << 1;
    }
    for (size_t i = 0; i < count; i++)
        any |= out[i];
    return any;
}

/// Marks both of each pair of pixels that differ: `count` pairs, from pixel p of a row and q of another on.
static void mark(const chooser *c, const row_view *a, size_t p, const row_view *b, size_t q, size_t count,
                 uint8_t *first, uint8_t *second)
{
    int differs[RUN];
    for (size_t x = 0; x < count; x += RUN) {
        const size_t run = count - x < RUN ? count - x : RUN;
        const int any = run == RUN ? differ(c, a, p + x, b, q + x, RUN, differs) : differ(c, a, p + x, b, q + x, run, differs);
        for (size_t i = 0; any && i < run; i++)
            if (differs[i] & DIFFER || (differs[i] && exceeds(c, a->first + p + x + i, b->first + q + x + i)))
                first[p + x + i] = second[q + x + i] = 1;
    }
}

/// Compares a row's pixels with each other and with those of the row below; marks of the latter are put aside, so that no
/// two rows write to one place.
static void choose_row(const chooser *c, size_t y, const row_view *here, const row_view *next)
{
    const size_t width = (size_t)c->extent->width, stride = (size_t)c->base->width, row = here->first;
    uint8_t *own = c->refine->chosen + row;
    memset(own, 0, width);
    if (y == (size_t)c->extent->y)
        memset(c->refine->below + row, 0, width);
    mark(c, here, 0, here, 1, width - 1, own, own);
    if (!next)
        return;
    uint8_t *below = c->refine->below + row + stride;
    memset(below, 0, width);
    mark(c, here, 0, next, 0, width, own, below);
    mark(c, here, 0, next, 1, width - 1, own, below);
    mark(c, here, 1, next, 0, width - 1, own, below);
}

/// The rows of band `index`, from above.
static void choose_band(void *context, size_t index, int worker)
{
    const chooser *c = context;
    const size_t length = CHANNELS_MAX * (size_t)c->extent->width, first = (size_t)c->extent->y,
                 end = first + (size_t)c->extent->height, from = first + index * BAND;
    float *memory = c->refine->rows + (size_t)worker * 2 * length;
    row_view here = view_row(c, from, memory), next;
    for (size_t y = from; y < from + BAND && y < end; y++, here = next) {
        if (y + 1 < end)
            next = view_row(c, y + 1, memory + ((y + 1 - from) % 2) * length);
        choose_row(c, y, &here, y + 1 < end ? &next : NULL);
    }
}

// ---- Marks ----

/// Brings the marks of two rows together.
static void join_chosen(glint_refine *refine, const glint_extent *extent, size_t stride)
{
    for (int y = extent->y; y < extent->y + extent->height; y++) {
        const size_t row = (size_t)y * stride + (size_t)extent->x, width = (size_t)extent->width;
        uint8_t *restrict to = refine->chosen + row;
        const uint8_t *restrict from = refine->below + row;
        for (size_t i = 0; i < width; i++)
            to[i] |= from[i];
    }
}

/// Of `count` marks that are `step` apart, those that are near one of `from`.
static void spread_line(const uint8_t *from, uint8_t *to, int count, size_t step)
{
    int last = -GLINT_REFINE_SPREAD - 1; // the last mark up to here, and as far ahead as matters
    for (int i = 0; i < count + GLINT_REFINE_SPREAD; i++) {
        if (i < count && from[(size_t)i * step])
            last = i;
        const int at = i - GLINT_REFINE_SPREAD;
        if (at >= 0)
            to[(size_t)at * step] = at - last <= GLINT_REFINE_SPREAD;
    }
}

static void spread_chosen(glint_refine *refine, const glint_extent *extent, size_t stride)
{
    const size_t first = (size_t)extent->y * stride + (size_t)extent->x;
    for (size_t y = 0; y < (size_t)extent->height; y++)
        spread_line(refine->chosen + first + y * stride, refine->below + first + y * stride, extent->width, 1);
    for (size_t x = 0; x < (size_t)extent->width; x++)
        spread_line(refine->below + first + x, refine->chosen + first + x, extent->height, stride);
}

static void count_chosen(glint_refine *refine, const glint_extent *extent, size_t stride)
{
    refine->count = 0;
    for (int y = extent->y; y < extent->y + extent->height; y++) {
        const uint8_t *row = refine->chosen + (size_t)y * stride + (size_t)extent->x;
        uint32_t count = 0;
        for (size_t i = 0; i < (size_t)extent->width; i++)
            count += row[i];
        refine->count += count;
    }
}

glint_status glint_refine_choose(glint_refine *refine, const glint_image *base, const glint_extent *extent,
                                 const glint_render_desc *desc, double threshold, bool lens, glint_pool *pool,
                                 glint_error *error)
{
    const size_t pixels = (size_t)base->width * (size_t)base->height;
    const size_t rows = 2 * CHANNELS_MAX * (size_t)base->width * (size_t)glint_pool_threads(pool);
    chooser c = {
        .base = base, .extent = extent, .tone = &desc->tone, .refine = refine, .least = (uint32_t)(threshold * 65535)
    };
    c.low = c.high = (float)c.least;
    if (!base->codes) {
        c.low = (1 - 2 * ESTIMATE_SHARE) * c.low - ESTIMATE_SLACK;
        c.high = (1 + 2 * ESTIMATE_SHARE) * c.high + ESTIMATE_SLACK;
    }
    if (refine->capacity < pixels || refine->row_capacity < rows) {
        glint_refine_clear(refine);
        refine->chosen = malloc(pixels);
        refine->below = malloc(pixels);
        refine->rows = glint_alloc(rows, sizeof *refine->rows);
        if (!refine->chosen || !refine->below || !refine->rows)
            return glint_fail_nomem(error);
        refine->capacity = pixels;
        refine->row_capacity = rows;
    }
    glint_pool_run(pool, ((size_t)extent->height + BAND - 1) / BAND, choose_band, &c);
    join_chosen(refine, extent, (size_t)base->width);
    if (lens)
        spread_chosen(refine, extent, (size_t)base->width);
    count_chosen(refine, extent, (size_t)base->width);
    return GLINT_OK;
}

void glint_refine_clear(glint_refine *refine)
{
    free(refine->chosen);
    free(refine->below);
    free(refine->rows);
    *refine = (glint_refine) { 0 };
}
