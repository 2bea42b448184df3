#include "engine/render/adaptive/choose.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/film/tone.h"

#include <stdlib.h>
#include <string.h>

#define ESTIMATED ((GLINT_DIFFER_LENGTH + GLINT_GROUP - 1) / GLINT_GROUP * GLINT_GROUP) ///< numbers per line

static glint_refine_tile *tile_at(const glint_refine *refine, uint32_t column, uint32_t row)
{
    return &refine->tiles[(size_t)row * refine->across + column];
}

static glint_status ensure_capacity(glint_refine *refine, const glint_image *image, glint_error *error)
{
    const uint32_t across = ((uint32_t)image->width + GLINT_TILE_WIDTH - 1) / GLINT_TILE_WIDTH;
    const uint32_t down = (uint32_t)glint_image_stamps(image);
    if (refine->tiles && refine->edges && refine->across == across && refine->down == down)
        return GLINT_OK;
    free(refine->tiles);
    free(refine->edges);
    refine->across = across;
    refine->down = down;
    refine->edge_length = (size_t)across * GLINT_TILE_WIDTH + GLINT_DIFFER_LENGTH;
    refine->tiles = glint_alloc_large((size_t)across * down, sizeof *refine->tiles);
    refine->edges = glint_alloc_large((size_t)down * 2 * GLINT_DIFFER_VALUES, refine->edge_length * sizeof *refine->edges);
    for (size_t i = 0; refine->tiles && i < (size_t)across * down; i++)
        refine->tiles[i].pixels = 0;
    return refine->tiles && refine->edges ? GLINT_OK : glint_fail_nomem(error);
}

glint_status glint_refine_begin(glint_refine *refine, const glint_stages *stages, const glint_image *image,
                                const glint_render_desc *desc, glint_error *error)
{
    const glint_status status = ensure_capacity(refine, image, error);
    refine->stages = stages;
    refine->base = image;
    refine->tone = glint_plan_compared(desc);
    refine->coded = glint_plan_compares_codes(desc);
    refine->gain = glint_tone_gain(&refine->tone);
    refine->least = (uint32_t)(desc->adaptive * 65535);
    refine->low = refine->high = (float)refine->least;
    if (!refine->coded) {
        refine->low = (1 - 2 * GLINT_ESTIMATE_SHARE) * refine->low - GLINT_ESTIMATE_SLACK;
        refine->high = (1 + 2 * GLINT_ESTIMATE_SHARE) * refine->high + GLINT_ESTIMATE_SLACK;
    }
    return status;
}

// ---- Borders of tiles ---------------------------------------------------------------------------------------------

typedef struct joiner {
    glint_refine *refine;
    const glint_extent *extent;
} joiner;

/// Two lines at a border in the form for comparison: with pixel values, or with estimates.
typedef struct border {
    const float *line[2][GLINT_DIFFER_VALUES], *light[2][3];
    _Alignas(64) float code[2][3][ESTIMATED];
} border;

static void estimate_line(const glint_refine *refine, const float *line[GLINT_DIFFER_VALUES], float code[3][ESTIMATED])
{
    _Alignas(64) float light[ESTIMATED] = { 0 };
    for (int c = 0; c < 3; c++) {
        memcpy(light, line[GLINT_DIFFER_CODE + c], GLINT_DIFFER_LENGTH * sizeof *light);
        const glint_estimate_args args = { .count = ESTIMATED, .gain = refine->gain, .light = light, .code = code[c] };
        refine->stages->estimate(&args);
        line[GLINT_DIFFER_CODE + c] = code[c];
    }
}

static void estimate_border(const glint_refine *refine, border *b)
{
    for (int k = 0; k < 2 && !refine->coded; k++) {
        for (int c = 0; c < 3; c++)
            b->light[k][c] = b->line[k][GLINT_DIFFER_CODE + c];
        estimate_line(refine, b->line[k], b->code[k]);
    }
}

/// Computes which of the border's pixels differ.
static void compare_border(const glint_refine *refine, border *b, uint32_t count, uint32_t ahead,
                           uint32_t differ[GLINT_DIFFER_DIRECTIONS])
{
    estimate_border(refine, b);
    glint_refine_lines lines = { .args = { .p = b->line[0], .q = b->line[1], .count = count, .ahead = ahead } };
    memcpy(lines.light, b->light, sizeof lines.light);
    glint_refine_compare(refine, &lines, differ);
}

/// Compares the last column of a tile with the first of the tile to its right.
static void join_columns(const glint_refine *refine, glint_refine_tile *left, glint_refine_tile *right, uint32_t width,
                         uint32_t height)
{
    border b;
    uint32_t differ[GLINT_DIFFER_DIRECTIONS];
    for (int v = 0; v < GLINT_DIFFER_VALUES; v++) {
        b.line[0][v] = left->side[1][v];
        b.line[1][v] = right->side[0][v];
    }
    compare_border(refine, &b, height, height - 1, differ);
    const uint32_t across = differ[GLINT_DIFFER_ACROSS], falling = differ[GLINT_DIFFER_FALLING];
    const uint32_t rising = differ[GLINT_DIFFER_RISING];
    for (uint32_t own = across | falling | rising << 1; own; own &= own - 1)
        left->chosen[__builtin_ctz(own)] |= 1u << (width - 1);
    for (uint32_t other = across | falling << 1 | rising; other; other &= other - 1)
        right->chosen[__builtin_ctz(other)] |= 1;
}

/// Compares the pixels in `column` of the last row of pixels of a row of tiles with the pixels below.
static void join_rows(const joiner *j, uint32_t column, uint32_t row)
{
    glint_refine *refine = j->refine;
    const size_t x = (size_t)column * GLINT_TILE_WIDTH, end = (size_t)(j->extent->x + j->extent->width);
    const uint32_t count = end - x < GLINT_TILE_WIDTH ? (uint32_t)(end - x) : GLINT_TILE_WIDTH;
    border b;
    uint32_t differ[GLINT_DIFFER_DIRECTIONS];
    const bool ahead = x + count < end; // a tile on the right
    for (int v = 0; v < GLINT_DIFFER_VALUES; v++) {
        b.line[0][v] = glint_refine_edge(refine, row, 1, v) + x;
        b.line[1][v] = glint_refine_edge(refine, row + 1, 0, v) + x;
    }
    compare_border(refine, &b, count, ahead ? count : count - 1, differ);
    const uint32_t across = differ[GLINT_DIFFER_ACROSS], falling = differ[GLINT_DIFFER_FALLING];
    const uint32_t rising = differ[GLINT_DIFFER_RISING], last = GLINT_TILE_WIDTH - 1;
    tile_at(refine, column, row)->chosen[GLINT_TILE_HEIGHT - 1] |= across | falling | rising << 1;
    tile_at(refine, column, row + 1)->above |= across | falling << 1 | rising;
    if (rising >> last)
        tile_at(refine, column + 1, row)->chosen[GLINT_TILE_HEIGHT - 1] |= 1;
    if (falling >> last)
        tile_at(refine, column + 1, row + 1)->above |= 1;
}

/// Compares a row of tiles with each other and with the row below; writes only `above`.
static void join_row(void *context, size_t index, int worker)
{
    const joiner *j = context;
    const glint_extent *e = j->extent;
    const uint32_t row = e->tile_y + (uint32_t)index, end = e->tile_x + e->across, y = row * GLINT_TILE_HEIGHT;
    const uint32_t bottom = (uint32_t)(e->y + e->height), height = bottom - y < GLINT_TILE_HEIGHT ? bottom - y : GLINT_TILE_HEIGHT;
    (void)worker;
    for (uint32_t x = e->tile_x; x < end; x++) {
        glint_refine_tile *tile = tile_at(j->refine, x, row);
        memcpy(tile->chosen, tile->inside, sizeof tile->chosen);
        if (index == 0)
            tile->above = 0;
        if (index + 1 < e->down)
            tile_at(j->refine, x, row + 1)->above = 0;
    }
    for (uint32_t x = e->tile_x; x + 1 < end; x++)
        join_columns(j->refine, tile_at(j->refine, x, row), tile_at(j->refine, x + 1, row), GLINT_TILE_WIDTH, height);
    for (uint32_t x = e->tile_x; x < end && index + 1 < e->down; x++)
        join_rows(j, x, row);
}

// ---- A lens -------------------------------------------------------------------------------------------------------

static uint32_t *word_at(const glint_refine *refine, uint32_t column, int y)
{
    return &tile_at(refine, column, (uint32_t)y / GLINT_TILE_HEIGHT)->chosen[y % GLINT_TILE_HEIGHT];
}

/// Returns the pixels of a row that are near a chosen one.
static void spread_row(const glint_refine *refine, const glint_extent *e, int y)
{
    uint32_t before = 0;
    for (uint32_t x = e->tile_x; x < e->tile_x + e->across; x++) {
        uint32_t *word = word_at(refine, x, y);
        const uint32_t after = x + 1 < e->tile_x + e->across ? *word_at(refine, x + 1, y) : 0;
        const uint32_t columns = (uint32_t)(e->x + e->width) - x * GLINT_TILE_WIDTH, own = *word;
        for (int step = 1; step <= GLINT_REFINE_SPREAD; step++)
            *word |= own << step | own >> step | before >> (GLINT_TILE_WIDTH - step) | after << (GLINT_TILE_WIDTH - step);
        if (columns < GLINT_TILE_WIDTH)
            *word &= (1u << columns) - 1;
        before = own;
    }
}

/// Adds the pixels of a column of tiles that are near a chosen one above or below.
static void spread_column(const glint_refine *refine, const glint_extent *e, uint32_t column)
{
    uint32_t before[GLINT_REFINE_SPREAD] = { 0 }; // rows above before the change, the nearest first
    const int end = e->y + e->height;
    for (int y = e->y; y < end; y++) {
        uint32_t *word = word_at(refine, column, y);
        const uint32_t own = *word;
        for (int step = 1; step <= GLINT_REFINE_SPREAD; step++)
            *word |= before[step - 1] | (y + step < end ? *word_at(refine, column, y + step) : 0);
        memmove(before + 1, before, sizeof before - sizeof *before);
        before[0] = own;
    }
}

static void spread(const glint_refine *refine, const glint_extent *e)
{
    for (int y = e->y; y < e->y + e->height; y++)
        spread_row(refine, e, y);
    for (uint32_t x = e->tile_x; x < e->tile_x + e->across; x++)
        spread_column(refine, e, x);
}

// -------------------------------------------------------------------------------------------------------------------

void glint_refine_choose(glint_refine *refine, const glint_extent *extent, bool lens, glint_pool *pool)
{
    joiner j = { refine, extent };
    glint_pool_run(pool, extent->down, join_row, &j);
    for (uint32_t y = extent->tile_y; y < extent->tile_y + extent->down; y++)
        for (uint32_t x = extent->tile_x; x < extent->tile_x + extent->across; x++)
            tile_at(refine, x, y)->chosen[0] |= tile_at(refine, x, y)->above;
    if (lens)
        spread(refine, extent);
    refine->count = 0;
    for (uint32_t y = extent->tile_y; y < extent->tile_y + extent->down; y++)
        for (uint32_t x = extent->tile_x; x < extent->tile_x + extent->across; x++)
            for (int k = 0; k < GLINT_TILE_HEIGHT; k++)
                refine->count += (uint64_t)__builtin_popcount(tile_at(refine, x, y)->chosen[k]);
}

void glint_refine_clear(glint_refine *refine)
{
    free(refine->tiles);
    free(refine->edges);
    *refine = (glint_refine) { 0 };
}
