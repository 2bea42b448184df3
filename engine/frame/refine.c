#include "engine/frame/refine.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct chooser {
    const glint_image *base;
    const glint_extent *extent;
    glint_refine *refine;
    uint32_t least; ///< sum of differences of codes that is not enough
} chooser;

#define CHANNELS_MAX 4 ///< of codes, which may have alpha

/// Pixels that are compared at a time: the compiler makes vectors of loops of so many.
#define RUN 16

/// What is rendered of a row of the base, and its codes as numbers, channel by channel.
typedef struct row_view {
    const float *id, *normal[3], *code[CHANNELS_MAX];
    size_t channels;
} row_view;

static row_view view_row(const chooser *c, size_t y, float *memory)
{
    const glint_image *base = c->base;
    const size_t width = (size_t)c->extent->width, channels = (size_t)base->channels;
    const size_t first = y * (size_t)base->width + (size_t)c->extent->x;
    const uint16_t *codes = (const uint16_t *)base->codes + first * channels;
    row_view row = { .id = base->plane[GLINT_PASS_OBJECT_ID][0] + first, .channels = channels };
    for (size_t k = 0; k < 3; k++)
        row.normal[k] = base->plane[GLINT_PASS_NORMAL][k] + first;
    for (size_t k = 0; k < channels; k++) {
        row.code[k] = memory + k * width;
        for (size_t x = 0; x < width; x++)
            memory[k * width + x] = codes[x * channels + k];
    }
    return row;
}

/// Which of `count` pixels, at most RUN, from p of a row on are worth a closer look, as are as many from q of another on.
static inline bool differ(const row_view *a, size_t p, const row_view *b, size_t q, float least, size_t count,
                          int *restrict out)
{
    float sum[RUN] = { 0 };
    int any = 0;
    for (size_t k = 0; k < a->channels; k++) {
        const float *x = a->code[k] + p, *y = b->code[k] + q;
        for (size_t i = 0; i < count; i++)
            sum[i] += fabsf(x[i] - y[i]);
    }
    for (size_t i = 0; i < count; i++) {
        const float cosine = (a->normal[0][p + i] * b->normal[0][q + i] + a->normal[1][p + i] * b->normal[1][q + i]) +
                             a->normal[2][p + i] * b->normal[2][q + i];
        out[i] =
            (a->id[p + i] != b->id[q + i]) | (sum[i] > least) | ((a->id[p + i] > 0) & (cosine < GLINT_REFINE_NORMAL));
    }
    for (size_t i = 0; i < count; i++)
        any |= out[i];
    return any;
}

/// Marks both of each pair of pixels that differ: `count` pairs, from pixel p of a row and q of another on.
static void mark(const chooser *c, const row_view *a, size_t p, const row_view *b, size_t q, size_t count,
                 uint8_t *first, uint8_t *second)
{
    const float least = (float)c->least;
    int differs[RUN];
    for (size_t x = 0; x < count; x += RUN) {
        const size_t run = count - x < RUN ? count - x : RUN;
        const bool any = run == RUN ? differ(a, p + x, b, q + x, least, RUN, differs)
                                    : differ(a, p + x, b, q + x, least, run, differs);
        for (size_t i = 0; any && i < run; i++)
            if (differs[i])
                first[p + x + i] = second[q + x + i] = 1;
    }
}

/// Compares a row's pixels with each other and with those of the row below; marks of the latter are put aside, so that no
/// two rows write to one place.
static void choose_row(void *context, size_t index, int worker)
{
    const chooser *c = context;
    const size_t width = (size_t)c->extent->width, length = CHANNELS_MAX * width, stride = (size_t)c->base->width;
    const size_t y = (size_t)c->extent->y + index, row = y * stride + (size_t)c->extent->x;
    float *memory = c->refine->rows + (size_t)worker * 2 * length;
    const row_view here = view_row(c, y, memory);
    uint8_t *own = c->refine->chosen + row;
    memset(own, 0, width);
    if (index == 0)
        memset(c->refine->below + row, 0, width);
    mark(c, &here, 0, &here, 1, width - 1, own, own);
    if (index + 1 == (size_t)c->extent->height)
        return;
    const row_view next = view_row(c, y + 1, memory + length);
    uint8_t *below = c->refine->below + row + stride;
    memset(below, 0, width);
    mark(c, &here, 0, &next, 0, width, own, below);
    mark(c, &here, 0, &next, 1, width - 1, own, below);
    mark(c, &here, 1, &next, 0, width - 1, own, below);
}

/// Brings the marks of two rows together.
static void join_chosen(glint_refine *refine, const glint_extent *extent, size_t stride)
{
    for (int y = extent->y; y < extent->y + extent->height; y++) {
        const size_t row = (size_t)y * stride + (size_t)extent->x;
        for (size_t i = row; i < row + (size_t)extent->width; i++)
            refine->chosen[i] |= refine->below[i];
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
        const size_t row = (size_t)y * stride + (size_t)extent->x;
        for (size_t i = row; i < row + (size_t)extent->width; i++)
            refine->count += refine->chosen[i];
    }
}

glint_status glint_refine_choose(glint_refine *refine, const glint_image *base, const glint_extent *extent,
                                 double threshold, bool lens, glint_pool *pool, glint_error *error)
{
    const size_t pixels = (size_t)base->width * (size_t)base->height;
    const size_t rows = 2 * CHANNELS_MAX * (size_t)base->width * (size_t)glint_pool_threads(pool);
    chooser c = { .base = base, .extent = extent, .refine = refine, .least = (uint32_t)(threshold * 65535) };
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
    glint_pool_run(pool, (size_t)extent->height, choose_row, &c);
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
