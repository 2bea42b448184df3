/// The parts of curves, and the points of labels, that surfaces hide, found by casting rays from the eye.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/frame/render.h"
#include "engine/overlay/pointer.h"

#include <stdlib.h>

#define STEPS 4.0 ///< number of casts for each pixel of a curve
#define MARGIN 1e-6 ///< a surface hides a point that is farther away than the surface by this fraction

typedef struct rays {
    _Alignas(64) double origin[3][GLINT_GROUP], direction[3][GLINT_GROUP], t[GLINT_GROUP];
    _Alignas(64) uint32_t prim[GLINT_GROUP];
    double scale[GLINT_GROUP]; ///< factor of the ray's direction; the point on the curve is at t = 1 / scale
    uint16_t active, hits;
} rays;

/// Sets a ray that ends at a point of the curve.
static void aim(const glint_overlays_camera *camera, const double point[3], rays *r, int lane)
{
    double to_point[3], origin[3], scaled[3];
    vec_copy(origin, camera->eye);
    vec_sub(to_point, point, origin);
    if (camera->orthographic) {
        const double depth = vec_dot(to_point, camera->view[2]);
        vec_scale(to_point, camera->view[2], depth);
        vec_sub(origin, point, to_point);
    }
    r->scale[lane] = vec_rescale(scaled, to_point);
    for (int c = 0; c < 3; c++) {
        r->origin[c][lane] = origin[c];
        r->direction[c][lane] = scaled[c];
    }
}

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

/// Casts a ray to the middle of each step of a part of a curve, `length` pixels long. Returns false if out of memory.
static bool find_parts(const glint_stages *stages, const glint_geometry_table *geometry, const glint_overlays *overlays,
                       const glint_pointer *p, const double range[2], double length, rays *r, glint_hidden_parts *out)
{
    const size_t count = (size_t)ceil(STEPS * length) + 1;
    const double step = (range[1] - range[0]) / (double)count;
    glint_cast_args cast = {
        .group_count = 1, .active = &r->active, .geometry = geometry, .t = r->t, .prim = r->prim, .hits = &r->hits
    };
    for (int c = 0; c < 3; c++) {
        cast.origin[c] = r->origin[c];
        cast.direction[c] = r->direction[c];
    }
    for (size_t i = 0; i < count; i += GLINT_GROUP) {
        const size_t lanes = count - i < GLINT_GROUP ? count - i : GLINT_GROUP;
        for (size_t lane = 0; lane < GLINT_GROUP; lane++) {
            double point[3];
            const double at = (double)(i + (lane < lanes ? lane : lanes - 1)) + 0.5;
            glint_pointer_at(p, overlays->camera.orthographic, range[0] + at * step, point);
            aim(&overlays->camera, point, r, (int)lane);
        }
        r->active = (uint16_t)((1u << lanes) - 1);
        r->hits = 0;
        stages->geometry[GLINT_PRECISION_DOUBLE].cast_rays(&cast);
        for (size_t lane = 0; lane < lanes; lane++) {
            const double from = range[0] + (double)(i + lane) * step;
            const bool hidden = (r->hits >> lane & 1) && r->t[lane] * r->scale[lane] < 1 - MARGIN;
            const size_t next = i + lane + 1; // the last step ends exactly where the next piece begins
            const double to = next < count ? range[0] + (double)next * step : range[1];
            if (hidden && !add_step(out, from, to))
                return false;
        }
    }
    return true;
}

static bool hides(const glint_overlay_desc *desc)
{
    return glint_overlay_points(desc) && desc->hidden != GLINT_HIDDEN_DRAWN;
}

static glint_status find_all(const glint_stages *stages, const glint_plan *plan, glint_overlays *overlays,
                             glint_error *error)
{
    glint_geometry_table table;
    glint_status status = glint_geometry_index(plan->geometry, NULL, &table, error);
    rays *r = glint_alloc(1, sizeof *r);
    glint_pointer *pointer = malloc(sizeof *pointer);
    if (!status && (!r || !pointer))
        status = glint_fail_nomem(error);
    for (size_t i = 0; i < overlays->count && !status; i++) {
        if (!hides(&overlays->of[i]))
            continue;
        const double point[2] = { 0, 0 };
        glint_pointer_find(overlays, &overlays->of[i], pointer);
        if (pointer->count == 1 && !find_parts(stages, &table, overlays, pointer, point, 0, r, &overlays->hidden[i]))
            status = glint_fail_nomem(error);
        for (int piece = 0; piece + 1 < pointer->count && !status; piece++) {
            double range[2];
            const double length = glint_pointer_piece(overlays, pointer, piece, range);
            if (length >= 0 && !find_parts(stages, &table, overlays, pointer, range, length, r, &overlays->hidden[i]))
                status = glint_fail_nomem(error);
        }
    }
    free(pointer);
    free(r);
    return status;
}

glint_status glint_hidden_find(const glint_stages *stages, const glint_plan *plan, glint_overlays **out,
                               glint_error *error)
{
    bool any = false;
    for (size_t i = 0; i < plan->overlays->count; i++)
        any = any || hides(&plan->overlays->of[i]);
    *out = any ? glint_overlays_copy(plan->overlays) : glint_overlays_retain(plan->overlays);
    if (!*out)
        return glint_fail_nomem(error);
    return any ? find_all(stages, plan, *out, error) : GLINT_OK;
}
