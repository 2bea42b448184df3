/// The pixels of a base that differ from a neighbour in their tile, and what the tiles around it compare.
#include "engine/base/alloc.h"
#include "engine/film/tone.h"
#include "engine/tile/refine.h"
#include "engine/tile/tile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(GLINT_TILE_WIDTH <= GLINT_DIFFER_PAIRS && GLINT_TILE_HEIGHT <= GLINT_DIFFER_PAIRS, "a bit a pixel");

struct glint_differ_work {
    _Alignas(64) float group[GLINT_DIFFER_VALUES][GLINT_TILE_SAMPLES]; ///< in the order of groups
    float row[GLINT_DIFFER_VALUES][GLINT_TILE_HEIGHT][GLINT_DIFFER_LENGTH];
};

struct glint_differ_work *glint_differ_work_create(void) { return glint_alloc(1, sizeof(struct glint_differ_work)); }

void glint_differ_work_destroy(struct glint_differ_work *work) { free(work); }

float *glint_differ_values(struct glint_differ_work *work, int value) { return work->group[value]; }

// ---- Pairs --------------------------------------------------------------------------------------------------------

/// Whether the codes of two pixels of the base are far enough apart.
static bool exceeds(const glint_refine *refine, size_t p, size_t q)
{
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        const float *light = refine->base->plane[GLINT_PASS_BEAUTY][c];
        sum += fabs(glint_tone_value(&refine->tone, (double)light[p]) - glint_tone_value(&refine->tone, (double)light[q]));
    }
    return sum > refine->least;
}

void glint_refine_compare(const glint_refine *refine, const glint_refine_lines *lines, uint32_t differ[GLINT_DIFFER_WAYS])
{
    glint_differ_args args = lines->args;
    glint_differences found;
    args.alpha = refine->coded && refine->base->channels > 3;
    args.low = refine->low;
    args.high = refine->high;
    args.cosine = GLINT_REFINE_NORMAL;
    refine->stages->differ(&args, &found);
    for (int way = 0; way < GLINT_DIFFER_WAYS; way++) {
        const size_t p = lines->first[0] + (way == GLINT_DIFFER_RISING ? lines->step : 0);
        const size_t q = lines->first[way != GLINT_DIFFER_ALONG] +
                         (way == GLINT_DIFFER_ALONG || way == GLINT_DIFFER_FALLING ? lines->step : 0);
        differ[way] = found.sure[way];
        for (uint32_t left = found.open[way] & ~found.sure[way]; left; left &= left - 1) {
            const size_t i = (size_t)__builtin_ctz(left) * lines->step;
            if (exceeds(refine, p + i, q + i))
                differ[way] |= left & -left;
        }
    }
}

// ---- A tile -------------------------------------------------------------------------------------------------------

/// The values of a tile, in the order of groups.
typedef struct tile_values {
    const float *of[GLINT_DIFFER_VALUES];
} tile_values;

/// Codes of the base as numbers.
static void take_codes(const glint_tile *tile, const glint_image *base, struct glint_differ_work *work)
{
    const size_t channels = (size_t)base->channels;
    for (uint32_t y = 0; y < tile->height; y++) {
        const size_t first = (size_t)(tile->y0 + y) * (size_t)base->width + tile->x0;
        const uint16_t *codes = (const uint16_t *)base->codes + channels * first;
        for (uint32_t x = 0; x < tile->width; x++)
            for (size_t c = 0; c < channels; c++)
                work->group[GLINT_DIFFER_CODE + c][glint_tile_place(tile, x, y)] = codes[x * channels + c];
    }
}

/// Brings values from the order of groups into rows.
static void make_rows(const glint_tile *tile, const tile_values *values, struct glint_differ_work *work)
{
    for (int v = 0; v < GLINT_DIFFER_VALUES; v++) {
        const float *from = values->of[v];
        for (uint32_t y = 0; from && y < tile->group_count / tile->groups_across; y++)
            for (uint32_t x = 0; x < tile->groups_across; x++, from += GLINT_GROUP)
#pragma GCC unroll 4
                for (uint32_t r = 0; r < 4; r++)
                    memcpy(&work->row[v][4 * y + r][4 * x], from + 4 * r, 4 * sizeof(float));
    }
}

/// Rows and columns of one value: four pixels of a group at a time.
static void copy_borders(const glint_tile *tile, const float *from, float *const edge[2], float *const side[2])
{
    for (int last = 0; last < 2; last++) {
        const uint32_t row = last ? tile->height - 1 : 0, column = last ? tile->width - 1 : 0;
        const float *across = from + glint_tile_place(tile, 0, row), *down = from + glint_tile_place(tile, column, 0);
        const size_t group_row = (size_t)tile->groups_across * GLINT_GROUP;
        const uint32_t whole = tile->width & ~3u;
        for (uint32_t x = 0; x < whole; x += 4, across += GLINT_GROUP)
            memcpy(edge[last] + x, across, 4 * sizeof *across);
        if (whole < tile->width)
            memcpy(edge[last] + whole, across, (tile->width - whole) * sizeof *across);
        for (uint32_t y = 0; y < tile->height; y += 4, down += group_row)
            for (uint32_t r = 0; r < 4; r++) // up to three below the image: there is room, and they are not read
                side[last][y + r] = down[4 * r];
    }
}

/// What the tiles around this one read.
static void note_borders(const glint_tile *tile, const glint_refine *refine, const tile_values *values)
{
    glint_refine_tile *own = &refine->tiles[tile->index];
    const uint32_t row = tile->y0 / GLINT_TILE_HEIGHT;
    for (int v = 0; v < GLINT_DIFFER_VALUES; v++)
        if (values->of[v])
            copy_borders(tile, values->of[v],
                         (float *const[2]) { glint_refine_edge(refine, row, 0, v) + tile->x0,
                                             glint_refine_edge(refine, row, 1, v) + tile->x0 },
                         (float *const[2]) { own->side[0][v], own->side[1][v] });
}

/// Whether all of the tile is so much alike that no two of its pixels can differ.
static bool is_even(const glint_tile *tile, const glint_refine *refine, const tile_values *values)
{
    _Alignas(64) float light[GLINT_GROUP] = { 0 }, code[GLINT_GROUP];
    glint_range_args args = { .count = tile->group_count * GLINT_GROUP, .gain = 1, .top = HUGE_VALF };
    float range[2], bend = 0, sum = 0;
    if (refine->coded || tile->width % 4 || tile->height % 4)
        return false;
    args.numbers = values->of[GLINT_DIFFER_ID];
    refine->stages->range(&args, range);
    if (range[0] < range[1])
        return false;
    args.floor = -1;
    args.top = 1;
    for (int c = 0; c < 3 && range[1] > 0; c++) {
        float along[2];
        args.numbers = values->of[GLINT_DIFFER_NORMAL + c];
        refine->stages->range(&args, along);
        bend += (along[1] - along[0]) * (along[1] - along[0]);
    }
    if (!(bend < 2 * (1 - GLINT_REFINE_NORMAL) - 0.01f)) // normals are unit but for rounding
        return false;
    args.floor = 0;
    args.gain = refine->gain;
    for (int c = 0; c < 3; c++) {
        args.numbers = values->of[GLINT_DIFFER_CODE + c];
        refine->stages->range(&args, light + 2 * c);
    }
    refine->stages->estimate(&(glint_estimate_args) { .count = GLINT_GROUP, .gain = 1, .light = light, .code = code });
    for (int c = 0; c < 3; c++)
        sum += code[2 * c + 1] - code[2 * c];
    return sum <= refine->low;
}

/// Compares the rows from the first down, each with itself and with the next.
static void compare_rows(const glint_tile *tile, const glint_refine *refine, const struct glint_differ_work *work,
                         uint32_t chosen[GLINT_TILE_HEIGHT])
{
    const size_t stride = (size_t)refine->base->width;
    for (uint32_t y = 0; y < tile->height; y++) {
        const bool next = y + 1 < tile->height;
        const float *p[GLINT_DIFFER_VALUES], *q[GLINT_DIFFER_VALUES];
        uint32_t differ[GLINT_DIFFER_WAYS];
        for (int v = 0; v < GLINT_DIFFER_VALUES; v++) {
            p[v] = work->row[v][y];
            q[v] = work->row[v][y + next];
        }
        const size_t first = (size_t)(tile->y0 + y) * stride + tile->x0;
        const glint_refine_lines lines = {
            .args = { .p = p, .q = next ? q : NULL, .count = tile->width, .ahead = tile->width - 1, .along = true },
            .first = { first, first + stride },
            .step = 1
        };
        glint_refine_compare(refine, &lines, differ);
        const uint32_t along = differ[GLINT_DIFFER_ALONG], across = differ[GLINT_DIFFER_ACROSS];
        const uint32_t falling = differ[GLINT_DIFFER_FALLING], rising = differ[GLINT_DIFFER_RISING];
        chosen[y] |= along | along << 1 | across | falling | rising << 1;
        chosen[y + next] |= across | falling << 1 | rising;
    }
}

void glint_tile_compare(glint_tile *tile, const glint_tile_frame *frame, glint_film_counts before)
{
    struct glint_differ_work *work = tile->differ;
    const glint_refine *refine = frame->refine;
    glint_refine_tile *own = &refine->tiles[tile->index];
    tile_values values = { .of = { NULL } };
    for (int v = 0; v < (refine->coded ? GLINT_DIFFER_CODE + refine->base->channels : GLINT_DIFFER_CODE); v++)
        values.of[v] = work->group[v];
    for (int c = 0; c < 3 && !refine->coded; c++)
        values.of[GLINT_DIFFER_CODE + c] = tile->film.beauty[c];
    if (refine->coded)
        take_codes(tile, refine->base, work);
    note_borders(tile, refine, &values);
    memset(own->inside, 0, sizeof own->inside);
    if (!is_even(tile, refine, &values)) {
        for (int c = 0; c < 3 && !refine->coded; c++) {
            const glint_estimate_args args = { .count = tile->group_count * GLINT_GROUP,
                                               .gain = refine->gain,
                                               .light = tile->film.beauty[c],
                                               .code = work->group[GLINT_DIFFER_CODE + c] };
            frame->stages->estimate(&args);
            values.of[GLINT_DIFFER_CODE + c] = args.code;
        }
        make_rows(tile, &values, work);
        compare_rows(tile, refine, work, own->inside);
    }
    own->clipped = tile->counts.clipped - before.clipped;
    own->nonfinite = tile->counts.nonfinite - before.nonfinite;
    own->key = (glint_key) { 0 }; // until the film is signed
    glint_tile_count_stage(tile, frame, GLINT_STAGE_REFINE, false);
}
