/// Sizes for a page: legible letters in the relations that the script gives, and texts and bars that fit the page.
#include "engine/figures/overlay/layout.h"

#include <math.h>
#include <string.h>

#define LEAST_SIZE 10.0 ///< smallest default font size, pixels of the script's own picture
#define SIZE_SHARE 36.0 ///< the default font size is the picture's height divided by this
#define SCRIPT_RATIO (7 / 6.0) ///< smallest letters with scripts, in sizes of the smallest letters
#define BAR 2.0 ///< length of the shortest colour bar, in font sizes

double glint_layout_own_size(const glint_overlays *overlays, const glint_overlay_desc *desc, double dpi)
{
    return desc->has_size ? glint_layout_pixels(desc->size, dpi) : fmax(overlays->height / SIZE_SHARE, LEAST_SIZE * overlays->scale);
}

/// Returns whether a text may have scripts, which must be smaller than their base and not smaller than the least size.
static bool has_scripts(const char *text) { return strchr(text, '$') && strpbrk(text, "_^"); }

static bool shows_scripts(const glint_overlay_desc *desc)
{
    const glint_curve *curve;
    bool found = has_scripts(desc->text);
    for (int i = 0; i < 3 && desc->kind == GLINT_OVERLAY_AXES; i++)
        found = found || has_scripts(desc->names[i]);
    if (desc->kind != GLINT_OVERLAY_CHART)
        return found;
    for (size_t i = 0; !found && (curve = glint_chart_curve(desc->chart, i)) != NULL; i++)
        found = has_scripts(curve->label);
    return found || has_scripts(desc->titles[0]) || has_scripts(desc->titles[1]);
}

double glint_overlays_enlargement(const glint_overlays *overlays, double dpi)
{
    double most = 1;
    for (size_t i = 0; i < overlays->count; i++) {
        const glint_overlay_desc *desc = &overlays->of[i];
        const double least = overlays->least * (shows_scripts(desc) ? SCRIPT_RATIO : 1);
        if (desc->text[0] || !glint_overlay_points(desc))
            most = fmax(most, least / glint_layout_own_size(overlays, desc, dpi));
    }
    return most;
}

/// Makes the letters of a text that is wider than the page smaller, but not smaller than `least`.
static void shrink(glint_layout *layout, int most, double least)
{
    int advance;
    const int width = glint_layout_measure(layout, layout->text, &advance);
    if (width <= most)
        return;
    layout->em = fmax(1, fmax(layout->em * (most - 1) / width, fmin(layout->em, least)));
    layout->typeface = glint_typeface_open(layout->ink->letters, layout->em);
    layout->typeface.least = layout->overlays->least;
}

/// Breaks a line that is wider than the page before the last sign of its formulas that leaves the first part narrow
/// enough; otherwise before the first one.
static void break_line(glint_layout *layout, char *line, int most)
{
    char first[GLINT_OVERLAY_TEXT_SIZE + 1];
    const size_t size = strcspn(line, "\n"), used = strlen(layout->text);
    const char *best = NULL;
    int height;
    if (glint_layout_line_size(layout, line, size, &height) <= most || used + sizeof "$\n$" > sizeof layout->text)
        return;
    for (const char *at = line; (at = glint_line_operator(line, at, line + size)) != NULL; at++) {
        const size_t part = (size_t)(at - line);
        memcpy(first, line, part);
        first[part] = '$';
        if (best && glint_layout_line_size(layout, first, part + 1, &height) > most)
            break;
        best = at;
    }
    if (!best)
        return;
    char *at = line + (best - line), *end = at;
    while (end[-1] == ' ') // no blank stands before a closing dollar sign
        end--;
    memmove(end + 3, at, strlen(at) + 1);
    memcpy(end, "$\n$", 3);
}

void glint_layout_fit_text(glint_layout *layout)
{
    const int most = layout->overlays->width - 2 * layout->padding;
    shrink(layout, most, SCRIPT_RATIO * layout->overlays->least);
    for (char *line = layout->text; *line; line += strspn(line, "\n")) {
        break_line(layout, line, most);
        line += strcspn(line, "\n");
    }
    shrink(layout, most, 0);
}

void glint_layout_measure_bar(glint_layout *layout, double margin)
{
    glint_colorbar_measure(layout);
    const glint_overlays *page = layout->overlays;
    const double over = layout->desc->orientation == GLINT_ORIENTATION_HORIZONTAL ? layout->width - page->width : layout->height - page->height;
    const double excess = over + 2 * (margin + layout->padding);
    if (page->least <= 0 || excess <= 0)
        return;
    layout->length = fmax(layout->length - excess, fmin(layout->length, BAR * layout->em));
    glint_colorbar_measure(layout);
}
