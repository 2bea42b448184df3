/// Straight strokes with round ends and arrowheads, as one shape with smooth edges.
#include "engine/figures/ink/stamps.h"

#include <math.h>
#include <stdlib.h>

/// side of a stamp, pixels. Stamps are small because a slanting stroke fills little of its bounding rectangle.
#define TILE 64

void glint_strokes_add(glint_strokes *strokes, const double from[2], const double to[2])
{
    if (strokes->count == strokes->capacity) {
        const size_t capacity = strokes->capacity ? 2 * strokes->capacity : 16;
        glint_stroke *of = realloc(strokes->of, capacity * sizeof *of);
        if (!of) {
            strokes->lost = true;
            return;
        }
        strokes->of = of;
        strokes->capacity = capacity;
    }
    strokes->of[strokes->count++] = (glint_stroke) { { from[0], from[1] }, { to[0] - from[0], to[1] - from[1] } };
}

/// Returns the distance of a point from the line from 0 to `end`.
static double distance_to(const double end[2], double x, double y)
{
    const double square = end[0] * end[0] + end[1] * end[1];
    const double along = square > 0 ? fmin(fmax((x * end[0] + y * end[1]) / square, 0), 1) : 0;
    const double dx = x - along * end[0], dy = y - along * end[1];
    return sqrt(dx * dx + dy * dy);
}

/// Returns the signed distance of a point from a triangle, negative inside. Near a corner it is the distance from the
/// edges.
static double distance_to_head(const double head[3][2], double x, double y)
{
    double most = -INFINITY;
    for (int i = 0; i < 3; i++) {
        const double *a = head[i], *b = head[(i + 1) % 3], *c = head[(i + 2) % 3];
        const double out[2] = { b[1] - a[1], a[0] - b[0] };
        const double inside = out[0] * (c[0] - a[0]) + out[1] * (c[1] - a[1]);
        const double across = (out[0] * (x - a[0]) + out[1] * (y - a[1])) / sqrt(out[0] * out[0] + out[1] * out[1]);
        most = fmax(most, inside > 0 ? -across : across);
    }
    return most;
}

/// Returns the signed distance of a point from the edge of shape number `i`, negative inside. Number i counts the
/// strokes, then the head.
static double distance_from(const glint_strokes *strokes, size_t i, double x, double y)
{
    if (i == strokes->count)
        return distance_to_head(strokes->head, x, y);
    const glint_stroke *s = &strokes->of[i];
    return distance_to(s->offset, x - s->from[0], y - s->from[1]) - strokes->half;
}

/// Computes the rows or columns of a stamp that shape number `i` can cover, as first and last + 1.
/// c      0 for columns, 1 for rows.
/// start  the stamp's first row or column.
static void limit_pixels(const glint_strokes *strokes, size_t i, int c, int start, int size, int range[2])
{
    const glint_stroke *s = &strokes->of[i];
    range[0] = 0;
    range[1] = size;
    if (i == strokes->count) // the corners of a thin head reach far beyond its points
        return;
    const double reach = strokes->half + 1, end = s->from[c] + s->offset[c];
    const double low = (s->from[c] < end ? s->from[c] : end) - reach - start;
    const double high = (s->from[c] < end ? end : s->from[c]) + reach - start;
    range[0] = low > 0 ? low < size ? (int)low : size : 0;
    range[1] = high < size ? high > 0 ? (int)high + 1 : 0 : size;
}

static void add_tile(glint_stamps *stamps, const glint_ink_mark *mark, int left, int top)
{
    const glint_strokes *strokes = &mark->strokes;
    glint_stamp stamp = { .coverage = NULL };
    for (size_t i = 0; i < strokes->count + strokes->has_head; i++) {
        // the shape is farther from the stamp's middle than half the stamp's diagonal
        if (distance_from(strokes, i, left + TILE / 2.0, top + TILE / 2.0) > TILE)
            continue;
        if (!stamp.coverage && !glint_stamps_mask(stamps, &mark->clip, left, top, TILE, TILE, &stamp))
            return;
        int across[2], down[2];
        limit_pixels(strokes, i, 0, stamp.x, stamp.width, across);
        limit_pixels(strokes, i, 1, stamp.y, stamp.height, down);
        for (int y = down[0]; y < down[1]; y++)
            for (int x = across[0]; x < across[1]; x++) {
                const double d = distance_from(strokes, i, stamp.x + x + 0.5, stamp.y + y + 0.5);
                const uint8_t covered = (uint8_t)(fmin(fmax(0.5 - d, 0), 1) * 255 + 0.5);
                uint8_t *at = &stamp.coverage[(size_t)y * (size_t)stamp.width + (size_t)x];
                *at = covered > *at ? covered : *at;
            }
    }
    if (stamp.coverage)
        glint_stamps_add(stamps, stamp, mark->color);
}

static void add_to_range(double range[2], double value, double reach)
{
    range[0] = fmin(range[0], value - reach);
    range[1] = fmax(range[1], value + reach);
}

void glint_stamps_strokes(glint_stamps *stamps, const glint_ink_mark *mark)
{
    const glint_strokes *strokes = &mark->strokes;
    const int low[2] = { mark->clip.x, mark->clip.y };
    const int high[2] = { low[0] + mark->clip.width, low[1] + mark->clip.height };
    int first[2], last[2];
    for (int c = 0; c < 2; c++) {
        double range[2] = { INFINITY, -INFINITY };
        for (size_t i = 0; i < strokes->count; i++) {
            add_to_range(range, strokes->of[i].from[c], strokes->half + 1);
            add_to_range(range, strokes->of[i].from[c] + strokes->of[i].offset[c], strokes->half + 1);
        }
        for (int i = 0; i < 3 && strokes->has_head; i++)
            add_to_range(range, strokes->head[i][c], 1);
        first[c] = (int)fmin(fmax(range[0], low[c]), high[c]);
        last[c] = (int)ceil(fmax(fmin(range[1], high[c]), low[c]));
    }
    for (int y = first[1]; y < last[1]; y += TILE)
        for (int x = first[0]; x < last[0]; x += TILE)
            add_tile(stamps, mark, x, y);
}
