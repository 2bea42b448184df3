#include "engine/figures/ink/ink.h"

#include "engine/base/status.h"

#include <stdlib.h>
#include <string.h>

glint_status glint_ink_open(int width, int height, glint_ink *out, glint_error *error)
{
    *out = (glint_ink) { 0 };
    glint_ink_resize(out, width, height);
    return glint_letters_open(&out->letters, error);
}

void glint_ink_resize(glint_ink *ink, int width, int height)
{
    ink->width = width;
    ink->height = height;
    ink->clip = (glint_rect) { 0, 0, width, height };
}

void glint_ink_close(glint_ink *ink)
{
    for (size_t i = 0; i < ink->count; i++) {
        free(ink->of[i].text);
        free(ink->of[i].strokes.of);
    }
    free(ink->of);
    glint_letters_close(ink->letters);
    *ink = (glint_ink) { 0 };
}

glint_status glint_ink_check(const glint_ink *ink, glint_error *error)
{
    return ink->lost || glint_letters_lost(ink->letters) ? glint_fail_nomem(error) : GLINT_OK;
}

/// Returns the common part of two rectangles; its size is 0 or negative if there is none.
static glint_rect common(const glint_rect *a, const glint_rect *b)
{
    const int x0 = a->x > b->x ? a->x : b->x, y0 = a->y > b->y ? a->y : b->y;
    const int ax = a->x + a->width, ay = a->y + a->height, bx = b->x + b->width, by = b->y + b->height;
    return (glint_rect) { x0, y0, (ax < bx ? ax : bx) - x0, (ay < by ? ay : by) - y0 };
}

void glint_ink_clip(glint_ink *ink, const glint_rect *rect)
{
    const glint_rect page = { 0, 0, ink->width, ink->height };
    ink->clip = rect ? common(rect, &page) : page;
}

/// Appends a mark and takes over its text and strokes, which are freed if memory is short.
static void add(glint_ink *ink, glint_ink_mark mark, const double color[3])
{
    if (ink->count == ink->capacity) {
        const size_t capacity = ink->capacity ? 2 * ink->capacity : 16;
        glint_ink_mark *of = realloc(ink->of, capacity * sizeof *of);
        if (!of) {
            free(mark.text);
            free(mark.strokes.of);
            ink->lost = true;
            return;
        }
        ink->of = of;
        ink->capacity = capacity;
    }
    memcpy(mark.color, color, sizeof mark.color);
    mark.clip = ink->clip;
    ink->of[ink->count++] = mark;
}

void glint_ink_fill(glint_ink *ink, int x, int y, int width, int height, const double color[3], double opacity)
{
    const glint_rect box = { x, y, width, height }, seen = common(&box, &ink->clip);
    if (seen.width > 0 && seen.height > 0)
        add(ink, (glint_ink_mark) { .kind = GLINT_MARK_FILL, .opacity = opacity, .box = box }, color);
}

void glint_ink_text(glint_ink *ink, const glint_typeface *typeface, const char *text, size_t size, int x, int y, glint_turn turn,
                    const double color[3])
{
    glint_line line;
    glint_line_set(typeface, text, size, &line);
    const int along = line.width + 2 * line.pad, across = line.above + line.below;
    x -= turn ? 0 : line.pad;
    y -= turn ? line.pad : 0;
    const glint_rect box = { x, y, turn ? across : along, turn ? along : across }, seen = common(&box, &ink->clip);
    if (seen.width <= 0 || seen.height <= 0)
        return;
    glint_ink_mark mark = { .kind = GLINT_MARK_TEXT, .opacity = 1, .box = box, .typeface = *typeface, .turn = turn };
    mark.text = strndup(text, size);
    ink->lost = ink->lost || !mark.text;
    if (mark.text)
        add(ink, mark, color);
}

void glint_ink_strokes(glint_ink *ink, const glint_strokes *strokes, const double color[3])
{
    glint_ink_mark mark = { .kind = GLINT_MARK_STROKES, .opacity = 1, .strokes = *strokes };
    const size_t bytes = strokes->count * sizeof *strokes->of;
    mark.strokes.of = malloc(bytes + 1); // no strokes are a shape too, if there is a head
    ink->lost = ink->lost || strokes->lost || !mark.strokes.of;
    if (!mark.strokes.of)
        return;
    if (bytes)
        memcpy(mark.strokes.of, strokes->of, bytes);
    mark.strokes.capacity = strokes->count;
    add(ink, mark, color);
}
