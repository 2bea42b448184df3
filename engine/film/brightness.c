/// Measures pictures: the brightest value, the exposure at which it is at most white, the range of depth and
/// derivatives.
#include "engine/base/status.h"
#include "engine/film/image.h"
#include "engine/film/tone.h"
#include "engine/glint_inspect.h"

#include <math.h>

#define STEPS 100 ///< steps of exposure in one stop

double glint_image_exposure(const glint_image *image) { return image ? image->exposure : 0; }

static void add_plane(const float *light, size_t count, float gain, glint_brightness *sum)
{
    float most = 0;
    uint64_t clipped = 0;
    for (size_t i = 0; i < count; i++) {
        const float x = light[i] < INFINITY ? light[i] : 0; // NaN counts as no light, too
        most = x > most ? x : most;
        clipped += gain * x > 1;
    }
    sum->most = most > sum->most ? most : sum->most;
    sum->clipped += clipped;
    sum->values += count;
}

glint_status glint_image_brightness(const glint_image *image, double exposure, glint_brightness *sum,
                                    glint_error *error)
{
    GLINT_REFUSE_NULL(image, error);
    GLINT_REFUSE_NULL(sum, error);
    if (!image->plane[GLINT_PASS_BEAUTY][0])
        return glint_fail(error, GLINT_ERR_INVALID, "image: it does not store linear beauty");
    const glint_tone_desc tone = { .exposure = exposure };
    const size_t count = (size_t)image->width * (size_t)image->height;
    sum->pictures++;
    for (int c = 0; c < 3; c++)
        add_plane(image->plane[GLINT_PASS_BEAUTY][c], count, glint_tone_gain(&tone), sum);
    return GLINT_OK;
}

glint_status glint_image_range(const glint_image *image, glint_pass pass, double range[2], glint_error *error)
{
    GLINT_REFUSE_NULL(image, error);
    GLINT_REFUSE_NULL(range, error);
    float *const *plane = glint_image_planes(image, pass);
    const bool slopes = glint_look_of(pass) == GLINT_LOOK_DERIVATIVE;
    if ((glint_look_of(pass) != GLINT_LOOK_DEPTH && !slopes) || !plane[0])
        return glint_fail(error, GLINT_ERR_INVALID, "pass: depth or a derivative that the image has expected");
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (int c = 0; c < glint_pass_channels(pass); c++)
        for (size_t i = 0; i < count; i++) {
            const double x = plane[c][i];
            if (!isfinite(x))
                continue;
            range[0] = fmin(range[0], slopes ? -fabs(x) : x);
            range[1] = fmax(range[1], slopes ? fabs(x) : x);
        }
    return GLINT_OK;
}

static bool fits(double most, int hundredths)
{
    const glint_tone_desc tone = { .exposure = (double)hundredths / STEPS };
    return glint_tone_gain(&tone) * (float)most <= 1;
}

double glint_exposure_for(double most)
{
    // `least` steps of exposure fit, `above` steps do not
    int least = -GLINT_EXPOSURE_MAX * STEPS, above = GLINT_EXPOSURE_MAX * STEPS + 1;
    if (!(most > 0))
        return 0;
    while (above - least > 1) {
        const int middle = (least + above) / 2;
        if (fits(most, middle))
            least = middle;
        else
            above = middle;
    }
    return (double)least / STEPS;
}
