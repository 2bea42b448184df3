/// Shared by the tests of derivatives: vectors in 113 bits, a picture with one derivative,
/// and the error of that derivative.
#ifndef GLINT_HARD_SLOPES_H
#define GLINT_HARD_SLOPES_H

#include "tests/hard/oracle/drive.h"
#include "tests/hard/oracle/quad.h"

#include <stddef.h>

/// A parameter of a test's `world`, with respect to which a derivative is taken.
typedef struct number {
    const char *object, *field;
    size_t offset;
    int components;
} number;

#define NUMBER(object, field, member, components) { object, field, offsetof(world, member), components }

#define STEP 1e-12 ///< step of the central differences, whose error is the squared step

static inline void fill(quad out[3], double low, double high)
{
    for (int c = 0; c < 3; c++)
        out[c] = uniform(low, high);
}

static inline quad dot(const quad a[3], const quad b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static inline void unit(quad v[3])
{
    const quad length = sqrtf128(dot(v, v));
    for (int c = 0; c < 3; c++)
        v[c] /= length;
}

static inline void cross(const quad a[3], const quad b[3], quad out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

static inline void put(double *out, const quad in[3], int count)
{
    for (int c = 0; c < count; c++)
        out[c] = (double)in[c];
}

/// Renders a picture with one derivative. `desc` has the size, and other fields that differ from the defaults. The
/// caller releases the image.
static inline glint_image *slope_picture(const glint_scene *scene, glint_render_desc desc, const glint_derivative *derivative)
{
    glint_renderer_desc r = glint_renderer_desc_default();
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
    glint_error error;
    desc.derivatives = derivative;
    desc.derivative_count = 1;
    r.threads = 1;
    must(glint_renderer_create(&r, &renderer, &error), &error);
    must(glint_plan_create(scene, &desc, &plan, &error), &error);
    must(glint_render(renderer, plan, &image, NULL, &error), &error);
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    return image;
}

/// Returns the largest error of the width * height pixels compared with `want`, relative to the guaranteed error
/// bound. *most gets the largest value of `want`, the steepest pixel. Pixels are rounded to float; before that, sums
/// in double have an error within 2^-40 of the steepest pixel.
static inline double slope_distance(const glint_image *image, int width, int height, double (*want)[3], double *most)
{
    double worst = 0;
    glint_error error;
    *most = 0;
    for (int i = 0; i < width * height; i++)
        for (int c = 0; c < 3; c++)
            *most = fmax(*most, fabs(want[i][c]));
    for (int i = 0; i < width * height; i++) {
        float got[3];
        must(glint_image_pixel(image, GLINT_PASS_DERIVATIVE, i % width, i / width, got, &error), &error);
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs(got[c] - want[i][c]) / (0x1p-23 * fabs(want[i][c]) + 0x1p-40 * *most));
    }
    return worst;
}

#endif
