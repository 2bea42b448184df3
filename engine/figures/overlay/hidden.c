/// The parts of curves, and the points of labels, that surfaces hide.
#include "engine/base/status.h"
#include "engine/figures/overlay/pointer.h"

#include <math.h>
#include <stdlib.h>

#define STEPS 4.0 ///< points asked for each pixel of a curve

/// Checks the next step of a curve, which ends at `to`, and adds it to the hidden parts if a surface hides it.
/// Returns false if out of memory.
static bool add_step(glint_hidden_parts *parts, double from, double to)
{
    if (parts->count && parts->of[parts->count - 1][1] >= from) {
        parts->of[parts->count - 1][1] = to;
        return true;
    }
    double(*of)[2] = realloc(parts->of, (parts->count + 1) * sizeof *of);
    if (!of)
        return false;
    parts->of = of;
    of[parts->count][0] = from;
    of[parts->count++][1] = to;
    return true;
}

/// Asks for the middle of each step of a part of a curve, `length` pixels long. Returns false if out of memory.
static bool find_parts(const glint_sights *sights, const glint_overlays *overlays, const glint_pointer *p, const double range[2],
                       double length, glint_hidden_parts *out)
{
    const size_t count = (size_t)ceil(STEPS * length) + 1;
    const double step = (range[1] - range[0]) / (double)count;
    double points[GLINT_SIGHTS][3];
    for (size_t i = 0; i < count; i += GLINT_SIGHTS) {
        const size_t some = count - i < GLINT_SIGHTS ? count - i : GLINT_SIGHTS;
        for (size_t k = 0; k < some; k++)
            glint_pointer_at(p, overlays->camera.orthographic, range[0] + ((double)(i + k) + 0.5) * step, points[k]);
        const uint32_t hidden = sights->hidden(sights->context, &overlays->camera, (const double(*)[3])points, some);
        for (size_t k = 0; k < some; k++) {
            const double from = range[0] + (double)(i + k) * step;
            const size_t next = i + k + 1; // the last step ends exactly where the next piece begins
            const double to = next < count ? range[0] + (double)next * step : range[1];
            if (hidden >> k & 1 && !add_step(out, from, to))
                return false;
        }
    }
    return true;
}

static bool hides(const glint_overlay_desc *desc)
{
    return glint_overlay_points(desc) && desc->hidden != GLINT_HIDDEN_DRAWN;
}

static glint_status find_all(const glint_sights *sights, glint_overlays *overlays, glint_error *error)
{
    glint_pointer *pointer = malloc(sizeof *pointer);
    bool good = pointer;
    for (size_t i = 0; i < overlays->count && good; i++) {
        if (!hides(&overlays->of[i]))
            continue;
        const double point[2] = { 0, 0 };
        glint_pointer_find(overlays, &overlays->of[i], pointer);
        if (pointer->count == 1)
            good = find_parts(sights, overlays, pointer, point, 0, &overlays->hidden[i]);
        for (int piece = 0; piece + 1 < pointer->count && good; piece++) {
            double range[2];
            const double length = glint_pointer_piece(overlays, pointer, piece, range);
            good = length < 0 || find_parts(sights, overlays, pointer, range, length, &overlays->hidden[i]);
        }
    }
    free(pointer);
    return good ? GLINT_OK : glint_fail_nomem(error);
}

glint_status glint_overlays_hide(glint_cover *cover, const glint_sights *sights, glint_cover **out, glint_error *error)
{
    const glint_overlays *overlays = (const glint_overlays *)cover;
    bool any = false;
    for (size_t i = 0; i < overlays->count; i++)
        any = any || hides(&overlays->of[i]);
    if (!any) {
        *out = glint_cover_retain(cover);
        return GLINT_OK;
    }
    glint_overlays *copy = glint_overlays_copy(overlays);
    if (!copy)
        return glint_fail_nomem(error);
    *out = &copy->base;
    return find_all(sights, copy, error);
}
