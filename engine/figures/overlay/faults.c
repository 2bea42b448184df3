/// Warnings about overlays that a picture cannot show as described.
#include "engine/base/number.h"
#include "engine/figures/overlay/layout.h"

#include "engine/figures/text/font.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SHOWN 40 ///< most characters of a text shown in a message

typedef struct check {
    const glint_layout *layout;
    void (*warns)(void *context, const char *message);
    void *context;
    char label[200]; ///< "label 'text'"
} check;

static void warn(const check *c, const char *message)
{
    char text[512];
    snprintf(text, sizeof text, "%s: %s", c->label, message);
    c->warns(c->context, text);
}

/// Writes the kind of an overlay and its name, or the beginning of its text.
static void describe(check *c)
{
    const glint_overlay_desc *desc = c->layout->desc;
    const char *name = desc->name[0] ? desc->name : desc->text, *end = name;
    for (int i = 0; i < SHOWN && *end && *end != '\n'; i++)
        glint_font_code(&end);
    snprintf(c->label, sizeof c->label, *name ? "%s '%.*s%s'" : "%s", glint_overlay_kinds[desc->kind], (int)(end - name),
             name, *end ? "..." : "");
}

/// Warns about the first character of a run that the font lacks. Returns whether there is one.
static bool check_run(const check *c, const glint_run *run)
{
    const char *end = run->text + strnlen(run->text, run->size);
    char message[200];
    for (const char *at = run->text, *letter = at; at < end; letter = at) {
        const uint32_t code = glint_font_code(&at);
        if (glint_typeface_has(&c->layout->typeface, code))
            continue;
        snprintf(message, sizeof message,
                 "the font has no letter '%.*s' (U+%04X), so a box is drawn; set GLINT_FONT to the file of another font",
                 (int)(at - letter), letter, (unsigned)code);
        warn(c, message);
        return true;
    }
    return false;
}

/// Warns about the first character of a text that the font lacks.
static void check_letters(const check *c, const char *text)
{
    glint_line line;
    for (size_t size; *text; text += size + (text[size] == '\n')) {
        size = strcspn(text, "\n");
        glint_line_set(&c->layout->typeface, text, size, &line);
        for (int i = 0; i < line.run_count; i++)
            if (check_run(c, &line.runs[i]))
                return;
    }
}

/// Returns the widest line of a label after wrapping.
static const char *find_widest(const glint_layout *layout, int *length)
{
    const char *found = layout->text;
    int widest = -1;
    for (const char *line = layout->text; *line;) {
        const size_t size = strcspn(line, "\n");
        int height;
        const int width = glint_layout_line_size(layout, line, size, &height);
        if (width > widest) {
            widest = width;
            found = line;
            *length = (int)size;
        }
        line += size + (line[size] == '\n');
    }
    return found;
}

static void check_position(const check *c)
{
    const glint_layout *l = c->layout;
    const int sides[2] = { l->overlays->width, l->overlays->height };
    const char *it = l->desc->kind >= GLINT_OVERLAY_ARROW && l->desc->kind != GLINT_OVERLAY_CHART ? "its label" : "it";
    char message[300];
    int beyond = 0, length = 0;
    for (int i = 0; i < 2; i++) {
        if (l->corner[i] >= sides[i] || l->corner[i] + l->size[i] <= 0) {
            snprintf(message, sizeof message, "%s lies outside the picture", it);
            warn(c, message);
            return;
        }
        const int before = -l->corner[i], behind = l->corner[i] + l->size[i] - sides[i];
        beyond = before > beyond ? before : beyond;
        beyond = behind > beyond ? behind : beyond;
    }
    const bool is_text = l->desc->kind == GLINT_OVERLAY_LABEL || glint_overlay_points(l->desc);
    if (!is_text || beyond <= l->em / 4) // at most the space around the letters is outside the picture
        return;
    const char *line = find_widest(l, &length);
    if (!l->desc->has_position && l->size[0] > sides[0])
        snprintf(message, sizeof message, "'%.*s' is %d pixels wide, the picture %d; use a smaller size or a wider "
                                          "picture to show all of it",
                 length < 100 ? length : 100, line, l->size[0], sides[0]);
    else
        snprintf(message, sizeof message, "%s extends %d pixels beyond the border of the picture", it, beyond);
    warn(c, message);
}

/// Warns about a polyline if the picture shows it only in part or not at all.
static void check_polyline(const check *c)
{
    const glint_pointer *p = &c->layout->place->pointer;
    const bool is_cut = p->behind[0] || p->behind[1];
    bool shows = false;
    double range[2];
    for (int i = 0; i + 1 < p->count; i++)
        shows = shows || glint_pointer_piece(c->layout->overlays, p, i, range) >= 0;
    if (c->layout->desc->point_count < 2)
        warn(c, "it has no length; it is not drawn");
    else if (is_cut)
        warn(c, p->count ? "a part of it is behind the camera; this part is not drawn" : "it is behind the camera; it is not drawn");
    else if (!shows)
        warn(c, "it lies outside the picture");
    else if (c->layout->place->has_rect)
        check_position(c);
}

/// Warns about an arrow, line, arc or label at a point if the picture shows it only in part or not at all.
static void check_pointer(const check *c)
{
    const glint_layout *l = c->layout;
    const glint_pointer *p = &l->place->pointer;
    const glint_overlay_kind kind = l->desc->kind;
    const bool is_line = kind == GLINT_OVERLAY_ARROW || kind == GLINT_OVERLAY_LINE;
    char message[200];
    if (kind >= GLINT_OVERLAY_POLYLINE) {
        check_polyline(c);
        return;
    }
    if (is_line && glint_pointer_is_point(l->desc)) {
        glint_print(message, sizeof message, "to: expected a point other than from {%.15g, %.15g, %.15g}; it is not drawn", l->desc->from[0],
                 l->desc->from[1], l->desc->from[2]);
        warn(c, message);
    } else if (p->behind[0] || p->behind[1]) {
        const char *end = kind == GLINT_OVERLAY_ARC ? "at" : !is_line ? "at_point" : p->behind[0] ? "from" : "to";
        snprintf(message, sizeof message, "%s: expected a point in front of the camera; %s not drawn", end,
                 p->count ? "the part behind it is" : "it is");
        warn(c, message);
    } else if (!p->count) {
        warn(c, "it lies outside the picture");
    } else if (l->place->has_rect) {
        check_position(c);
    }
}

/// Warns about letters of a chart that the font lacks, and about a chart without space for its curves.
static void check_chart(const check *c)
{
    const glint_overlay_desc *desc = c->layout->desc;
    const glint_curve *curve;
    for (int i = 0; i < 2; i++)
        check_letters(c, desc->titles[i]);
    for (size_t i = 0; (curve = glint_chart_curve(desc->chart, i)) != NULL; i++)
        check_letters(c, curve->label);
    if (glint_chart_fits(c->layout))
        check_position(c);
    else
        warn(c, "there is no space for its curves, so it is not drawn; use a larger picture or extent, or a smaller size");
}

glint_status glint_overlays_check(const glint_cover *cover, double dpi, void (*warns)(void *context, const char *message),
                                  void *context, glint_error *error)
{
    const glint_overlays *overlays = (const glint_overlays *)cover;
    glint_ink ink;
    glint_place *places = NULL;
    glint_status status = glint_ink_open(overlays->width, overlays->height, &ink, error);
    if (status)
        return status;
    status = glint_layout_places(overlays, dpi, &ink, &places, error);
    for (size_t i = 0; i < overlays->count && !status; i++) {
        const glint_overlay_desc *desc = &overlays->of[i];
        glint_layout layout = glint_layout_begin_at(overlays, i, dpi, places, &ink);
        check c = { .layout = &layout, .warns = warns, .context = context };
        describe(&c);
        check_letters(&c, desc->text);
        for (int k = 0; k < 3 && desc->kind == GLINT_OVERLAY_AXES; k++)
            check_letters(&c, desc->names[k]);
        if (desc->has_box)
            continue;
        glint_layout_place(&layout, dpi);
        if (glint_overlay_points(desc))
            check_pointer(&c);
        else if (desc->kind == GLINT_OVERLAY_CHART)
            check_chart(&c);
        else
            check_position(&c);
    }
    free(places);
    glint_ink_close(&ink);
    return status;
}
