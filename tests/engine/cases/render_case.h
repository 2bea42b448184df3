/// Renders a scene with one instruction set on one thread, and counts the pixels that differ between two pictures.
#ifndef GLINT_RENDER_CASE_H
#define GLINT_RENDER_CASE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "engine/glint.h"

/// Renders the scene. Returns NULL when this machine lacks the instruction set.
static inline glint_image *render_with(const glint_scene *scene, const char *isa, const glint_render_desc *desc)
{
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
    glint_error error;
    const glint_renderer_desc r = { .struct_size = sizeof(glint_renderer_desc), .threads = 1, .isa = isa };
    const glint_status status = glint_renderer_create(&r, &renderer, &error);
    if (status == GLINT_ERR_UNSUPPORTED)
        return NULL;
    assert_int_equal(status, GLINT_OK);
    assert_int_equal(glint_plan_create(scene, desc, &plan, &error), GLINT_OK);
    assert_int_equal(glint_render(renderer, plan, &image, NULL, &error), GLINT_OK);
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    return image;
}

/// Counts the pixels of a square whose bits differ.
static inline int differing(const glint_image *a, const glint_image *b, glint_pass pass, int size)
{
    int count = 0;
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            float p[3] = { 0 }, q[3] = { 0 };
            glint_image_pixel(a, pass, x, y, p, NULL);
            glint_image_pixel(b, pass, x, y, q, NULL);
            count += memcmp(p, q, sizeof p) != 0;
        }
    return count;
}

#endif
