/// Finds the pixels of a base that differ from a neighbour in their tile, and stores the pixels that neighbouring
/// tiles compare.
#include "engine/base/alloc.h"
#include "engine/film/tone.h"
#include "engine/render/adaptive/refine.h"
#include "engine/render/tile/tile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(GLINT_TILE_WIDTH <= GLINT_DIFFER_PAIRS && GLINT_TILE_HEIGHT <= GLINT_DIFFER_PAIRS, "a bit a pixel");

struct glint_differ_work {
    _Alignas(64) float group[GLINT_DIFFER_VALUES][GLINT_TILE_SAMPLES]; ///< in the order of groups; first: see
        ///< glint_differ_values
    float row[GLINT_DIFFER_VALUES][GLINT_TILE_HEIGHT][GLINT_DIFFER_LENGTH];
};

struct glint_differ_work *glint_differ_work_create(void) { return glint_alloc(1, sizeof(struct glint_differ_work)); }

void glint_differ_work_destroy(struct glint_differ_work *work) { free(work); }

// ---- Pairs --------------------------------------------------------------------------------------------------------

/// Returns the value of pixel i of a line, before rounding.
static double code_at(const glint_refine *refine, const glint_refine_lines *lines, int line, int c, size_t i)
{
    const size_t at = lines->grouped ? i / 4 * GLINT_GROUP + i % 4 : i;
    return glint_tone_value(&refine->tone, (double)lines->light[line][c][at]);
}

/// Returns whether the values of pixel i of one line and pixel k of another differ by more than the threshold.
static bool exceeds(const glint_refine *refine, const glint_refine_lines *lines, const int line[2], size_t i, size_t k)
{
    double sum = 0;
    for (int c = 0; c < 3; c++)
        sum += fabs(code_at(refine, lines, line[0], c, i) - code_at(refine, lines, line[1], c, k));
    return sum > refine->least;
}

void glint_refine_compare(const glint_refine *refine, const glint_refine_lines *lines,
                          uint32_t differ[GLINT_DIFFER_DIRECTIONS])
{
    glint_differ_args args = lines->args;
    glint_differences differences;
    args.alpha = refine->coded && refine->base->channels > 3;
    args.low = refine->low;
    args.high = refine->high;
    args.cosine = GLINT_REFINE_NORMAL;
    refine->stages->differ(&args, &differences);
    for (int direction = 0; direction < GLINT_DIFFER_DIRECTIONS; direction++) {
        const int line[2] = { 0, direction != GLINT_DIFFER_ALONG };
        const size_t p = direction == GLINT_DIFFER_RISING,
                     q = direction == GLINT_DIFFER_ALONG || direction == GLINT_DIFFER_FALLING;
        differ[direction] = differences.sure[direction];
        for (uint32_t bits = differences.undecided[direction] & ~differences.sure[direction]; bits; bits &= bits - 1) {
            const size_t i = (size_t)__builtin_ctz(bits);
            if (exceeds(refine, lines, line, p + i, q + i))
                differ[direction] |= bits & -bits;
        }
    }
}

// ---- A tile -------------------------------------------------------------------------------------------------------

/// The values of a tile, in the order of groups.
typedef struct tile_values {
    const float *of[GLINT_DIFFER_VALUES];
} tile_values;

/// Loads the pixel values of the base as numbers.
static void take_codes(const glint_tile *tile, const glint_image *base, struct glint_differ_work *work)
{
    const size_t channels = (size_t)base->channels;
    for (uint32_t y = 0; y < tile->height; y++) {
        const size_t first = (size_t)(tile->y0 + y) * (size_t)base->width + tile->x0;
        const uint16_t *codes = (const uint16_t *)base->codes + channels * first;
        for (uint32_t x = 0; x < tile->width; x++)
            for (size_t c = 0; c < channels; c++)
                work->group[GLINT_DIFFER_CODE + c][glint_tile_slot(tile, x, y)] = codes[x * channels + c];
    }
}

/// Reorders values from groups into rows.
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

/// Copies a column of one value: `from` is in the first group.
static void copy_column(const glint_tile *tile, const float *from, float *to)
{
    const size_t row = (size_t)tile->groups_across * GLINT_GROUP;
    for (uint32_t y = 0; y < tile->height; y += 4, from += row, to += 4) // up to 3 rows below the image are
        for (uint32_t r = 0; r < 4; r++) // copied, too; they are in memory, and nothing reads the copies
            to[r] = from[4 * r];
}

/// Copies rows and columns of one value, four pixels of a group at a time.
static void copy_borders(const glint_tile *tile, const float *from, float *const edge[2], float *const side[2])
{
    for (int last = 0; last < 2; last++) {
        const float *across = from + glint_tile_slot(tile, 0, last ? tile->height - 1 : 0);
        const uint32_t whole = tile->width & ~3u;
        for (uint32_t x = 0; x < whole; x += 4, across += GLINT_GROUP)
            memcpy(edge[last] + x, across, 4 * sizeof *across);
        if (whole < tile->width)
            memcpy(edge[last] + whole, across, (tile->width - whole) * sizeof *across);
        copy_column(tile, from + glint_tile_slot(tile, last ? tile->width - 1 : 0, 0), side[last]);
    }
}

void glint_tile_prefetch_borders(const glint_tile *tile, const glint_refine *refine)
{
    glint_refine_tile *own = &refine->tiles[tile->index];
    const uint32_t row = tile->y0 / GLINT_TILE_HEIGHT;
    glint_prefetch(own, sizeof *own);
    for (int v = 0; v < (refine->coded ? GLINT_DIFFER_CODE + refine->base->channels : GLINT_DIFFER_CODE + 3); v++)
        for (int last = 0; last < 2; last++)
            glint_prefetch(glint_refine_edge(refine, row, last, v) + tile->x0, tile->width * sizeof(float));
}

/// Stores the pixels that neighbouring tiles read.
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

/// Compares the rows, first to last: the pixels of each with each other, and with the next row.
static void compare_rows(const glint_tile *tile, const glint_refine *refine, const struct glint_differ_work *work,
                         uint32_t chosen[GLINT_TILE_HEIGHT])
{
    for (uint32_t y = 0; y < tile->height; y++) {
        const bool next = y + 1 < tile->height;
        const float *p[GLINT_DIFFER_VALUES], *q[GLINT_DIFFER_VALUES];
        uint32_t differ[GLINT_DIFFER_DIRECTIONS];
        for (int v = 0; v < GLINT_DIFFER_VALUES; v++) {
            p[v] = work->row[v][y];
            q[v] = work->row[v][y + next];
        }
        glint_refine_lines lines = {
            .args = { .p = p, .q = next ? q : NULL, .count = tile->width, .ahead = tile->width - 1, .along = true },
            .grouped = true
        };
        for (int c = 0; c < 3; c++)
            for (uint32_t k = 0; k < 2; k++)
                lines.light[k][c] = tile->film.beauty[c] + glint_tile_slot(tile, 0, y + k * next);
        glint_refine_compare(refine, &lines, differ);
        const uint32_t along = differ[GLINT_DIFFER_ALONG], across = differ[GLINT_DIFFER_ACROSS];
        const uint32_t falling = differ[GLINT_DIFFER_FALLING], rising = differ[GLINT_DIFFER_RISING];
        chosen[y] |= along | along << 1 | across | falling | rising << 1;
        chosen[y + next] |= across | falling << 1 | rising;
    }
}

/// Estimates the tile's pixel values.
static void estimate_codes(const glint_tile *tile, const glint_refine *refine, tile_values *values)
{
    for (int c = 0; c < 3; c++) {
        float *code = glint_differ_values(tile->differ, GLINT_DIFFER_CODE + c);
        values->of[GLINT_DIFFER_CODE + c] = code;
        refine->stages->estimate(&(glint_estimate_args) {
            .count = tile->group_count * GLINT_GROUP, .gain = refine->gain, .light = tile->film.beauty[c], .code = code });
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
    if (!refine->coded)
        estimate_codes(tile, refine, &values);
    make_rows(tile, &values, work);
    compare_rows(tile, refine, work, own->inside);
    own->clipped = tile->counts.clipped - before.clipped;
    own->nonfinite = tile->counts.nonfinite - before.nonfinite;
    own->pixels = 0; // until the film is signed
    glint_tile_count_stage(tile, frame, GLINT_STAGE_ADAPTIVE, false);
}
