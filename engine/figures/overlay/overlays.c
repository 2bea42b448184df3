#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/figures/overlay/curves.h"
#include "engine/figures/overlay/overlay.h"
#include "engine/figures/text/letters.h"

#include <stdlib.h>
#include <string.h>

/// Returns whether an overlay shows anything; a label without text does not.
static bool shows(const glint_overlay_desc *desc) { return desc->kind != GLINT_OVERLAY_LABEL || desc->text[0]; }

glint_status glint_overlays_take(glint_overlay *const *all, size_t count, int width, int height, const glint_cover_camera *camera,
                                 glint_cover **out, glint_error *error)
{
    size_t shown = 0;
    for (size_t i = 0; i < count; i++)
        shown += shows(glint_overlay_get(all[i]));
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
    overlays->base.maker = &glint_overlay_maker;
    atomic_init(&overlays->base.references, 1);
    overlays->width = width;
    overlays->height = height;
    overlays->letters = font;
    overlays->least = 0;
    overlays->scale = overlays->enlarged = 1;
    overlays->hidden = NULL;
    overlays->count = 0;
    for (int i = 0; i < 3; i++)
        vec_normalize(overlays->view[i], camera->view[i]);
    overlays->camera = *camera;
    for (size_t i = 0; i < count; i++) {
        const glint_overlay_desc *desc = glint_overlay_get(all[i]);
        if (!shows(desc))
            continue;
        overlays->of[overlays->count++] = *desc;
        glint_chart_retain(desc->chart);
    }
    *out = &overlays->base;
    return GLINT_OK;
}

glint_overlays *glint_overlays_copy(const glint_overlays *overlays)
{
    const size_t size = sizeof *overlays + overlays->count * sizeof *overlays->of;
    glint_overlays *copy = malloc(size);
    if (!copy)
        return NULL;
    memcpy(copy, overlays, size);
    atomic_init(&copy->base.references, 1);
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

glint_overlays *glint_overlays_resize(const glint_overlays *overlays, const double factor[2], double scale, double least, double dpi)
{
    glint_overlays *page = glint_overlays_copy(overlays);
    if (!page || !copy_hidden(overlays, page)) {
        if (page)
            glint_cover_release(&page->base);
        return NULL;
    }
    page->width = (int)ceil(overlays->width * factor[0] - 0.5);
    page->height = (int)ceil(overlays->height * factor[1] - 0.5);
    page->least = least;
    page->scale = scale;
    for (int i = 0; i < 2; i++) {
        vec_scale(page->camera.view[i], overlays->camera.view[i], 1 / factor[i]);
        page->camera.span[i] = overlays->camera.span[i] * factor[i];
    }
    page->camera.pixel_offset = 0.5 - (0.5 - overlays->camera.pixel_offset) * factor[0];
    for (size_t i = 0; i < page->count; i++)
        for (int c = 0; c < 2; c++)
            page->of[i].position[c] *= scale;
    page->enlarged = glint_overlays_enlargement(page, dpi);
    return page;
}

void glint_overlays_free(glint_cover *cover)
{
    glint_overlays *overlays = (glint_overlays *)cover;
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
    const glint_cover_camera *c = &overlays->camera;
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

glint_key glint_overlays_key(const glint_cover *cover, glint_key key)
{
    const glint_overlays *overlays = (const glint_overlays *)cover;
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
