/// Draws the elements of overlays, lines of text and rectangles, as stamps.
#include "engine/overlay/layout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double glint_layout_pixels(double points, double dpi) { return fmin(points * (dpi > 0 ? dpi / 72 : 1), GLINT_SIDE_MAX); }

int glint_layout_measure(const glint_layout *layout, const char *text, int *lines)
{
    int widest = 0;
    for (*lines = 0; *text; ++*lines) {
        const size_t size = strcspn(text, "\n");
        const int width = glint_typeface_width(&layout->typeface, text, size);
        widest = width > widest ? width : widest;
        text += size + (text[size] == '\n');
    }
    return widest;
}

bool glint_layout_mask(const glint_layout *layout, int x, int y, int width, int height, glint_stamp *stamp)
{
    const int x0 = x > 0 ? x : 0, y0 = y > 0 ? y : 0;
    const int x1 = x + width < layout->overlays->width ? x + width : layout->overlays->width;
    const int y1 = y + height < layout->overlays->height ? y + height : layout->overlays->height;
    if (x0 >= x1 || y0 >= y1)
        return false;
    *stamp = (glint_stamp) { .x = x0, .y = y0, .width = x1 - x0, .height = y1 - y0, .opacity = 255 };
    stamp->coverage = calloc((size_t)stamp->width, (size_t)stamp->height);
    if (!stamp->coverage)
        layout->stamps->lost = true;
    return stamp->coverage != NULL;
}

void glint_layout_text(const glint_layout *layout, const char *text, int x, int y, int width, double align,
                       const double color[3])
{
    for (; *text; y += layout->typeface.line) {
        const size_t size = strcspn(text, "\n");
        const int wide = glint_typeface_width(&layout->typeface, text, size);
        const int at = x + (int)floor((width - wide) * align);
        glint_stamp stamp;
        if (glint_layout_mask(layout, at, y, wide, layout->typeface.height, &stamp)) {
            glint_mask mask = { stamp.width, stamp.height, stamp.coverage };
            glint_typeface_draw(&layout->typeface, text, size, at - stamp.x, y - stamp.y, &mask);
            glint_stamps_add(layout->stamps, stamp, color);
        }
        text += size + (text[size] == '\n');
    }
}

void glint_layout_fill(const glint_layout *layout, int x, int y, int width, int height, const double color[3],
                       double opacity)
{
    const int x1 = x + width, y1 = y + height, wide = layout->overlays->width, high = layout->overlays->height;
    glint_stamp stamp = { .x = x > 0 ? x : 0, .y = y > 0 ? y : 0, .opacity = (uint8_t)(opacity * 255 + 0.5) };
    stamp.width = (x1 < wide ? x1 : wide) - stamp.x;
    stamp.height = (y1 < high ? y1 : high) - stamp.y;
    if (stamp.width > 0 && stamp.height > 0)
        glint_stamps_add(layout->stamps, stamp, color);
}
