#include "engine/figures/overlay/layout.h"

#include "engine/base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PADDING 0.35 ///< between the text and the border of its background, in font sizes

/// Breaks the lines of a label that are wider than the picture without its margins. Lines break at spaces outside
/// formulas. A word that is wider stays whole.
static void wrap(glint_layout *layout, double margin)
{
    const int most = layout->overlays->width - 2 * layout->padding, space = most - 2 * (int)ceil(margin);
    for (char *line = layout->text; *line;) {
        const size_t size = strcspn(line, "\n");
        char *end = line + size, *fits = NULL;
        int height;
        const bool is_wide = glint_layout_line_size(layout, line, size, &height) > most;
        for (const char *blank = line; is_wide && (blank = glint_line_blank(line, blank, end)) != NULL; blank++) {
            if (fits && glint_layout_line_size(layout, line, (size_t)(blank - line), &height) > space)
                break;
            fits = line + (blank - line);
        }
        if (fits && (fits > line))
            *fits = '\n';
        line = fits ? fits + 1 : end + (*end == '\n');
    }
}

static void measure_label(glint_layout *layout)
{
    int advance;
    layout->width = glint_layout_measure(layout, layout->text, &advance);
    layout->height = advance - layout->typeface.line + layout->typeface.height;
}

static void draw_label(const glint_layout *layout, int x, int y)
{
    const glint_overlay_desc *desc = layout->desc;
    const double align = glint_overlay_points(desc) ? 0.5 : desc->has_position ? 0 : desc->at[0];
    glint_layout_text(layout, layout->text, x, y, layout->width, align, desc->color);
}

glint_layout glint_layout_begin(const glint_overlays *overlays, const glint_overlay_desc *desc, double dpi, glint_ink *ink)
{
    static const double lengths[] = { [GLINT_OVERLAY_COLORBAR] = 10, [GLINT_OVERLAY_AXES] = 2.5, [GLINT_OVERLAY_CHART] = 0 };
    glint_layout layout = { .overlays = overlays, .desc = desc, .dpi = dpi, .ink = ink };
    layout.em = overlays->enlarged * glint_layout_own_size(overlays, desc, dpi);
    layout.typeface = glint_typeface_open(ink->letters, layout.em);
    layout.typeface.least = overlays->least;
    if (desc->kind != GLINT_OVERLAY_LABEL)
        layout.length = desc->has_length ? glint_layout_pixels(desc->length, dpi) : lengths[desc->kind] * layout.em;
    layout.padding = desc->has_background ? (int)ceil(PADDING * layout.em) : 0;
    memcpy(layout.text, desc->text, sizeof layout.text);
    return layout;
}

glint_layout glint_layout_begin_at(const glint_overlays *overlays, size_t i, double dpi, glint_place *places, glint_ink *ink)
{
    glint_layout layout = glint_layout_begin(overlays, &overlays->of[i], dpi, ink);
    layout.places = places;
    layout.place = places ? &places[i] : NULL;
    layout.hidden = overlays->hidden ? &overlays->hidden[i] : NULL;
    return layout;
}

/// Stores the rectangle of an overlay, so that later texts do not cover it.
static void keep_place(glint_layout *layout)
{
    glint_place *place = layout->place;
    if (!place || !layout->width || (glint_overlay_points(layout->desc) && !glint_pointer_shows_text(layout)))
        return;
    place->has_rect = true;
    for (int i = 0; i < 2; i++) {
        place->low[i] = layout->corner[i];
        place->high[i] = layout->corner[i] + layout->size[i];
    }
}

void glint_layout_place(glint_layout *layout, double dpi)
{
    const glint_overlay_desc *desc = layout->desc;
    const double margin = desc->has_margin ? glint_layout_pixels(desc->margin, dpi) : layout->em / 2;
    const int sides[2] = { layout->overlays->width, layout->overlays->height };
    const bool points = glint_overlay_points(desc);
    if (points || (desc->kind == GLINT_OVERLAY_LABEL && !desc->has_position))
        wrap(layout, margin);
    if (layout->overlays->least > 0)
        glint_layout_fit_text(layout);
    for (int i = 0; i < 2; i++)
        layout->extent[i] = desc->has_extent ? glint_layout_pixels(desc->extent[i], dpi) : sides[i] - 2 * margin;
    if (desc->kind == GLINT_OVERLAY_COLORBAR)
        glint_layout_measure_bar(layout, margin);
    else if (desc->kind == GLINT_OVERLAY_AXES)
        glint_axes_measure(layout);
    else if (desc->kind == GLINT_OVERLAY_CHART)
        glint_chart_measure(layout);
    else
        measure_label(layout);
    layout->size[0] = layout->width + 2 * layout->padding;
    layout->size[1] = layout->height + 2 * layout->padding;
    for (int i = 0; i < 2; i++)
        layout->corner[i] = (int)floor(desc->has_position ? desc->position[i]
                                                          : margin + (sides[i] - 2 * margin - layout->size[i]) * desc->at[i]);
    if (points)
        glint_pointer_place(layout, margin);
    keep_place(layout);
}

glint_status glint_layout_places(const glint_overlays *overlays, double dpi, glint_ink *ink, glint_place **out,
                                 glint_error *error)
{
    bool points = false;
    for (size_t i = 0; i < overlays->count; i++)
        points = points || glint_overlay_points(&overlays->of[i]);
    *out = points ? calloc(overlays->count, sizeof **out) : NULL;
    if (points && !*out)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < overlays->count && points; i++) {
        const glint_overlay_desc *desc = &overlays->of[i];
        if (glint_overlay_points(desc)) {
            glint_pointer_find(overlays, desc, &(*out)[i].pointer);
        } else if (!desc->has_box) {
            glint_layout layout = glint_layout_begin_at(overlays, i, dpi, *out, ink);
            glint_layout_place(&layout, dpi);
        }
    }
    return GLINT_OK;
}

static void draw(glint_layout *layout, double dpi)
{
    const glint_overlay_desc *desc = layout->desc;
    const int *corner = layout->corner, *size = layout->size;
    if (desc->kind == GLINT_OVERLAY_AXES && desc->has_box) {
        glint_box_axes_draw(layout);
        return;
    }
    glint_layout_place(layout, dpi);
    if (desc->kind == GLINT_OVERLAY_CHART && layout->overlays->least > 0 && !glint_chart_fits(layout))
        return;
    if (glint_overlay_points(desc)) {
        glint_pointer_draw(layout, dpi);
        if (!glint_pointer_shows_text(layout))
            return;
    }
    if (desc->has_background)
        glint_layout_fill(layout, corner[0], corner[1], size[0], size[1], desc->background, desc->opacity);
    const int x = corner[0] + layout->padding, y = corner[1] + layout->padding;
    if (desc->kind == GLINT_OVERLAY_COLORBAR)
        glint_colorbar_draw(layout, x, y);
    else if (desc->kind == GLINT_OVERLAY_AXES)
        glint_axes_draw(layout, x, y);
    else if (desc->kind == GLINT_OVERLAY_CHART)
        glint_chart_draw(layout, x, y);
    else
        draw_label(layout, x, y);
}

glint_status glint_overlays_draw(const glint_overlays *overlays, double dpi, glint_ink *ink, glint_error *error)
{
    glint_place *places;
    glint_status status = glint_layout_places(overlays, dpi, ink, &places, error);
    for (size_t i = 0; i < overlays->count && !status; i++) {
        glint_layout layout = glint_layout_begin_at(overlays, i, dpi, places, ink);
        draw(&layout, dpi);
    }
    free(places);
    return status ? status : glint_ink_check(ink, error);
}

void glint_colorbar_measure_alone(const glint_overlay_desc *desc, glint_ink *ink, int size[2])
{
    const glint_overlays overlays = { .width = ink->width, .height = ink->height, .scale = 1, .enlarged = 1 };
    glint_layout layout = glint_layout_begin(&overlays, desc, 0, ink);
    glint_colorbar_measure(&layout);
    size[0] = layout.width;
    size[1] = layout.height;
}

void glint_colorbar_draw_alone(const glint_overlay_desc *desc, glint_ink *ink, int x, int y)
{
    const glint_overlays overlays = { .width = ink->width, .height = ink->height, .scale = 1, .enlarged = 1 };
    glint_layout layout = glint_layout_begin(&overlays, desc, 0, ink);
    glint_colorbar_measure(&layout);
    glint_colorbar_draw(&layout, x, y);
}
