/// The elements of overlays: lines of text, rectangles and strokes.
#include "engine/figures/overlay/layout.h"
#include "engine/glint.h"

#include <math.h>
#include <string.h>

double glint_layout_pixels(double points, double dpi) { return fmin(points * (dpi > 0 ? dpi / 72 : 1), GLINT_SIDE_MAX); }

int glint_layout_line_size(const glint_layout *layout, const char *text, size_t size, int *height)
{
    glint_line line;
    glint_line_set(&layout->typeface, text, size, &line);
    *height = line.above + line.below;
    return line.width;
}

/// Returns the distance from the top of a line to the top of the next line.
static int pitch(const glint_layout *layout, int height) { return layout->typeface.line + height - layout->typeface.height; }

int glint_layout_measure(const glint_layout *layout, const char *text, int *advance)
{
    int widest = 0, height;
    for (*advance = 0; *text; *advance += pitch(layout, height)) {
        const size_t size = strcspn(text, "\n");
        const int width = glint_layout_line_size(layout, text, size, &height);
        widest = width > widest ? width : widest;
        text += size + (text[size] == '\n');
    }
    return widest;
}

void glint_layout_text(const glint_layout *layout, const char *text, int x, int y, int width, double align,
                       const double color[3])
{
    for (int height; *text; y += pitch(layout, height)) {
        const size_t size = strcspn(text, "\n");
        const int wide = glint_layout_line_size(layout, text, size, &height);
        glint_ink_text(layout->ink, &layout->typeface, text, size, x + (int)floor((width - wide) * align), y, GLINT_LEVEL, color);
        text += size + (text[size] == '\n');
    }
}

void glint_layout_fill(const glint_layout *layout, int x, int y, int width, int height, const double color[3],
                       double opacity)
{
    glint_ink_fill(layout->ink, x, y, width, height, color, opacity);
}

void glint_layout_strokes(const glint_layout *layout, const glint_strokes *strokes, const double color[3])
{
    glint_ink_strokes(layout->ink, strokes, color);
}

void glint_layout_line(const glint_layout *layout, const double from[2], const double offset[2], double half,
                       const double color[3])
{
    glint_stroke stroke = { { from[0], from[1] }, { offset[0], offset[1] } };
    glint_layout_strokes(layout, &(glint_strokes) { .of = &stroke, .count = 1, .half = half }, color);
}
