#include "engine/files/picture/relight.h"
#include "engine/base/status.h"
#include "engine/glint_files.h"

#include <stdlib.h>
#include <string.h>

/// If the light passes leave less than this share of a pixel, the rest is rounding. One limit is for passes in float,
/// the other for passes in half.
#define ROUNDING 0x1p-20
#define ROUNDING_OF_HALF 0x1p-8

/// Subtracts the light passes from the beauty. Returns whether anything is left.
static bool take_off(const glint_image *image, double rounding)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    bool any = false;
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < pixels; i++) {
            float *all = &image->plane[GLINT_PASS_BEAUTY][c][i];
            double rest = *all;
            for (size_t k = 0; k < image->light_count; k++)
                rest -= image->light[k][c][i];
            *all = rest > rounding * *all ? (float)rest : 0; // NaN leaves nothing
            any = any || *all > 0;
        }
    return any;
}

glint_status glint_image_split_rest(glint_image *image, bool half, glint_error *error)
{
    float **beauty = image->plane[GLINT_PASS_BEAUTY];
    const size_t count = image->light_count + 1;
    if (!take_off(image, half ? ROUNDING_OF_HALF : ROUNDING)) {
        for (int c = 0; c < 3; c++) {
            free(beauty[c]);
            beauty[c] = NULL;
        }
        return GLINT_OK;
    }
    float *(*planes)[3] = realloc(image->light, count * sizeof *planes);
    if (planes)
        image->light = planes;
    char(*names)[GLINT_NAME_SIZE] = planes ? realloc(image->light_name, count * sizeof *names) : NULL;
    if (!names)
        return glint_fail_nomem(error);
    image->light_name = names;
    strcpy(names[image->light_count], GLINT_LIGHT_OTHER);
    memcpy(planes[image->light_count++], beauty, 3 * sizeof *beauty);
    memset(beauty, 0, 3 * sizeof *beauty);
    return GLINT_OK;
}

glint_status glint_image_relight(const glint_image *lights, const double (*factors)[3], glint_image **out,
                                 glint_error *error)
{
    GLINT_REFUSE_NULL(lights, error);
    GLINT_REFUSE_NULL(out, error);
    const size_t pixels = (size_t)lights->width * (size_t)lights->height;
    const bool alpha = lights->plane[GLINT_PASS_ALPHA][0];
    glint_image *image = NULL;
    glint_status status =
        glint_image_create(lights->width, lights->height, 1u << GLINT_PASS_BEAUTY | (uint32_t)alpha << GLINT_PASS_ALPHA,
                           NULL, &image, error);
    if (status)
        return status;
    image->alpha = lights->alpha;
    image->channels = lights->channels;
    if (alpha)
        memcpy(image->plane[GLINT_PASS_ALPHA][0], lights->plane[GLINT_PASS_ALPHA][0], pixels * sizeof(float));
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < pixels; i++) {
            double light = 0; // the page of the mixer adds in the same order
            for (size_t k = 0; k < lights->light_count; k++)
                light += factors[k][c] * (double)lights->light[k][c][i];
            image->plane[GLINT_PASS_BEAUTY][c][i] = (float)light;
        }
    *out = image;
    return GLINT_OK;
}
