/// The world's axes in the camera's view: three lines from one point, seen from far away, the nearest drawn last.
#include "engine/figures/overlay/layout.h"

#include "engine/base/vec.h"

#include <math.h>
#include <string.h>

#define THICK 0.18 ///< thickness of a line, in font sizes
#define NAME_GAP 0.75 ///< distance from an axis's end to the middle of its name, in font sizes

/// x, y and z: red, green and blue, linear.
static const double colors[3][3] = { { 0.80, 0.07, 0.05 }, { 0.10, 0.52, 0.06 }, { 0.07, 0.19, 0.90 } };

typedef struct axis {
    double end[2]; ///< vector from the origin of the axes to the end of this axis; pixels to the right and down
    double away; ///< component of this axis along the view, away from the eye, -1 .. 1
    double name[2]; ///< position of the middle of its name
} axis;

static axis find_axis(const glint_layout *layout, int i)
{
    const double(*view)[3] = layout->overlays->view;
    const double across = view[0][i], down = -view[1][i], shown = sqrt(across * across + down * down);
    const double gap = shown > 0 ? NAME_GAP * layout->em / shown : 0;
    axis a = { .away = view[2][i] };
    a.end[0] = across * layout->length;
    a.end[1] = down * layout->length;
    a.name[0] = a.end[0] + across * gap;
    a.name[1] = a.end[1] + down * gap;
    return a;
}

/// Returns half the side of the square that contains all axes in every view. The other overlays do not move when the
/// view turns.
static int reach(const glint_layout *layout)
{
    int most = 0;
    for (int i = 0; i < 3; i++) {
        int height;
        const int width = glint_layout_line_size(layout, layout->desc->names[i], SIZE_MAX, &height);
        most = width > most ? width : most;
        most = height > most ? height : most;
    }
    return (int)ceil(layout->length + NAME_GAP * layout->em + most / 2.0);
}

void glint_axes_measure(glint_layout *layout) { layout->width = layout->height = 2 * reach(layout) + 1; }

void glint_axes_draw(const glint_layout *layout, int x, int y)
{
    const int half = reach(layout);
    const double middle[2] = { x + half + 0.5, y + half + 0.5 };
    axis axes[3];
    int order[3] = { 0, 1, 2 };
    for (int i = 0; i < 3; i++)
        axes[i] = find_axis(layout, i);
    for (int i = 0; i < 2; i++) // the farthest axis first
        for (int k = 0; k < 2 - i; k++)
            if (axes[order[k]].away < axes[order[k + 1]].away) {
                const int swapped = order[k];
                order[k] = order[k + 1];
                order[k + 1] = swapped;
            }
    for (int i = 0; i < 3; i++) {
        const axis *a = &axes[order[i]];
        const char *name = layout->desc->names[order[i]];
        int height;
        const int wide = glint_layout_line_size(layout, name, SIZE_MAX, &height);
        glint_layout_line(layout, middle, a->end, fmax(THICK * layout->em / 2, 0.75), colors[order[i]]);
        glint_layout_text(layout, name, (int)floor(middle[0] + a->name[0] - wide / 2.0 + 0.5),
                          (int)floor(middle[1] + a->name[1] - height / 2.0 + 0.5), wide, 0, layout->desc->color);
    }
}
