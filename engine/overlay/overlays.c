#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/overlay/curves.h"
#include "engine/overlay/overlay.h"
#include "engine/text/letters.h"

#include <stdlib.h>
#include <string.h>

double glint_overlays_project(const glint_overlays_camera *camera, const double p[3], double out[2])
{
    double d[3], s[2];
    vec_sub(d, p, camera->eye);
    const double depth = vec_dot(d, camera->view[2]), shift = 0.5 - camera->pixel_offset;
    for (int i = 0; i < 2; i++)
        s[i] = vec_dot(d, camera->view[i]) / vec_dot(camera->view[i], camera->view[i]) / (camera->orthographic ? 1 : depth);
    out[0] = (camera->span[0] + s[0]) / 2 + shift;
    out[1] = (camera->span[1] - s[1]) / 2 + shift;
    return depth;
}

/// Returns whether an overlay shows anything; a label without text does not.
static bool shows(const glint_overlay_desc *desc) { return desc->kind != GLINT_OVERLAY_LABEL || desc->text[0]; }

glint_status glint_overlays_take(const glint_scene *scene, int width, int height, const glint_overlays_camera *camera,
                                 glint_overlays **out, glint_error *error)
{
    const size_t count = glint_scene_overlay_count(scene);
    size_t shown = 0;
    for (size_t i = 0; i < count; i++)
        shown += shows(glint_overlay_get(glint_scene_overlay_at(scene, i)));
    *out = NULL;
    if (!shown)
        return GLINT_OK;
    glint_letters *letters;
    glint_status status = glint_letters_open(&letters, error);
    if (status)
        return status;
    const glint_key font = glint_letters_key(letters);
    glint_letters_close(letters);
    glint_overlays *overlays = malloc(sizeof *overlays + shown * sizeof *overlays->of);
    if (!overlays)
        return glint_fail_nomem(error);
    atomic_init(&overlays->references, 1);
    overlays->width = width;
    overlays->height = height;
    overlays->letters = font;
    overlays->least = 0;
    overlays->hidden = NULL;
    overlays->count = 0;
    for (int i = 0; i < 3; i++)
        vec_normalize(overlays->view[i], camera->view[i]);
    overlays->camera = *camera;
    for (size_t i = 0; i < count; i++) {
        const glint_overlay_desc *desc = glint_overlay_get(glint_scene_overlay_at(scene, i));
        if (!shows(desc))
            continue;
        overlays->of[overlays->count++] = *desc;
        glint_chart_retain(desc->chart);
    }
    *out = overlays;
    return GLINT_OK;
}

glint_overlays *glint_overlays_copy(const glint_overlays *overlays)
{
    const size_t size = sizeof *overlays + overlays->count * sizeof *overlays->of;
    glint_overlays *copy = malloc(size);
    if (!copy)
        return NULL;
    memcpy(copy, overlays, size);
    atomic_init(&copy->references, 1);
    copy->hidden = calloc(overlays->count, sizeof *copy->hidden);
    if (!copy->hidden) {
        free(copy);
        return NULL;
    }
    for (size_t i = 0; i < copy->count; i++)
        glint_chart_retain(copy->of[i].chart);
    return copy;
}

/// Copies the hidden parts of curves. Returns false if out of memory.
static bool copy_hidden(const glint_overlays *from, glint_overlays *to)
{
    for (size_t i = 0; from->hidden && i < from->count; i++) {
        const size_t count = from->hidden[i].count, bytes = count * sizeof *from->hidden[i].of;
        if (!count)
            continue;
        to->hidden[i].of = malloc(bytes);
        if (!to->hidden[i].of)
            return false;
        memcpy(to->hidden[i].of, from->hidden[i].of, bytes);
        to->hidden[i].count = count;
    }
    return true;
}

glint_overlays *glint_overlays_resize(const glint_overlays *overlays, const double factor[2], double scale, double least)
{
    glint_overlays *page = glint_overlays_copy(overlays);
    if (!page || !copy_hidden(overlays, page)) {
        glint_overlays_release(page);
        return NULL;
    }
    page->width = (int)ceil(overlays->width * factor[0] - 0.5);
    page->height = (int)ceil(overlays->height * factor[1] - 0.5);
    page->least = least;
    for (int i = 0; i < 2; i++) {
        vec_scale(page->camera.view[i], overlays->camera.view[i], 1 / factor[i]);
        page->camera.span[i] = overlays->camera.span[i] * factor[i];
    }
    page->camera.pixel_offset = 0.5 - (0.5 - overlays->camera.pixel_offset) * factor[0];
    for (size_t i = 0; i < page->count; i++)
        for (int c = 0; c < 2; c++)
            page->of[i].position[c] *= scale;
    return page;
}

glint_overlays *glint_overlays_retain(glint_overlays *overlays)
{
    if (overlays)
        atomic_fetch_add_explicit(&overlays->references, 1, memory_order_relaxed);
    return overlays;
}

void glint_overlays_release(glint_overlays *overlays)
{
    if (!overlays || atomic_fetch_sub_explicit(&overlays->references, 1, memory_order_acq_rel) > 1)
        return;
    for (size_t i = 0; overlays->hidden && i < overlays->count; i++)
        free(overlays->hidden[i].of);
    for (size_t i = 0; i < overlays->count; i++)
        glint_chart_release(overlays->of[i].chart);
    free(overlays->hidden);
    free(overlays);
}

#define ADD(key, value) ((key) = glint_key_add((key), &(value), sizeof(value)))

static glint_key position_key(const glint_overlay_desc *d, glint_key key)
{
    const double numbers[] = { d->kind,        d->at[0],         d->at[1],  d->has_position, d->position[0],
                               d->position[1], d->has_size,      d->size,   d->has_margin,   d->margin,
                               d->opacity,     d->has_length,    d->length, d->color[0],     d->color[1],
                               d->color[2],    d->has_background };
    ADD(key, numbers);
    ADD(key, d->background);
    return glint_key_add_string(key, d->text);
}

static glint_key camera_key(const glint_overlays *overlays, glint_key key)
{
    const glint_overlays_camera *c = &overlays->camera;
    const double seen[] = { c->orthographic, c->eye[0], c->eye[1], c->eye[2], c->pixel_offset };
    ADD(key, seen);
    ADD(key, c->view);
    if (c->span[0] != overlays->width || c->span[1] != overlays->height)
        ADD(key, c->span);
    return key;
}

/// Extends the key by the camera and the world points of an overlay that points. The geometry that may hide parts of it
/// is in the picture's key.
static glint_key pointer_key(const glint_overlays *overlays, const glint_overlay_desc *d, glint_key key)
{
    const double look[] = { d->has_point, d->has_radius, d->radius, d->has_width, d->width, d->hidden };
    key = camera_key(overlays, key);
    ADD(key, d->from);
    ADD(key, d->to);
    ADD(key, d->point);
    if (d->kind >= GLINT_OVERLAY_POLYLINE) {
        key = glint_key_add(key, d->points, d->point_count * sizeof *d->points);
        key = glint_key_add(key, d->point_flags, d->point_count);
    }
    return ADD(key, look);
}

static glint_key chart_key(const glint_overlay_desc *d, glint_key key)
{
    const double look[] = { d->is_log_axis[0], d->is_log_axis[1], d->has_range[0], d->has_range[1], d->has_extent };
    ADD(key, look);
    for (int i = 0; i < 2; i++) {
        key = glint_key_add_string(key, d->titles[i]);
        if (d->has_range[i])
            ADD(key, d->range[i]);
    }
    if (d->has_extent)
        ADD(key, d->extent);
    return glint_chart_key(d->chart, key);
}

/// Extends the key by the box's corners in the camera's view and the numbers of its axes.
static glint_key box_key(const glint_overlays *overlays, const glint_overlay_desc *d, glint_key key)
{
    key = camera_key(overlays, key);
    ADD(key, d->box);
    if (d->has_sides)
        ADD(key, d->sides);
    return d->has_values ? ADD(key, d->values) : key;
}

glint_key glint_overlays_key(const glint_overlays *overlays, glint_key key)
{
    ADD(key, overlays->letters);
    for (size_t i = 0; i < overlays->count; i++) {
        const glint_overlay_desc *d = &overlays->of[i];
        const double bar[] = { d->map, d->low, d->high, d->orientation, (double)d->tick_count };
        key = position_key(d, key);
        if (d->kind == GLINT_OVERLAY_COLORBAR)
            key = glint_key_add(glint_key_add(key, bar, sizeof bar), d->ticks, d->tick_count * sizeof *d->ticks);
        if (d->kind == GLINT_OVERLAY_COLORBAR && d->is_log)
            ADD(key, d->is_log);
        if (d->kind == GLINT_OVERLAY_COLORBAR && d->has_colors)
            ADD(key, d->colors);
        if (d->kind == GLINT_OVERLAY_CHART)
            key = chart_key(d, key);
        if (glint_overlay_points(d))
            key = pointer_key(overlays, d, key);
        if (d->kind != GLINT_OVERLAY_AXES)
            continue;
        ADD(key, overlays->view);
        for (int k = 0; k < 3; k++)
            key = glint_key_add_string(key, d->names[k]);
        if (d->has_box)
            key = box_key(overlays, d, key);
    }
    return key;
}
