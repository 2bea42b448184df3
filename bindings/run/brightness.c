// The brightness of a run's pictures: warns about clipped values in 16-bit linear files, and finds the largest value
// for --exposure auto.
#include "bindings/run/run.h"

bool glintL_tone_is_data(const glint_tone_desc *tone)
{
    return tone->bits == 16 && tone->transfer != GLINT_TRANSFER_SRGB && tone->curve == GLINT_TONE_CLAMP;
}

void glintL_warn_of_clipping(glintL_run *run)
{
    const glint_brightness *seen = &run->brightness;
    if (seen->clipped == 0)
        return;
    const double exposure = glint_exposure_for(seen->most);
    const double share = 100 * (double)seen->clipped / (double)seen->values;
    if (run->is_command)
        glintL_run_warn(
            run,
            "%.3g %% of the 16-bit linear values are clipped at 65535: the brightest would be %.4g times white; use "
            "--exposure %.2f to keep all values, or --exposure auto for one exposure of a whole set",
            share, seen->most, exposure);
    else
        glintL_run_warn(
            run,
            "%.3g %% of the 16-bit linear values are clipped at 65535: the brightest would be %.4g times white; set "
            "exposure = %.2f to keep all values",
            share, seen->most, exposure);
}

void glintL_look_at_brightness(glintL_run *run, const glint_image *image, const glint_tone_desc *tone)
{
    glint_error error;
    const bool first = run->brightness.clipped == 0;
    if (!run->measures && !glintL_tone_is_data(tone))
        return;
    glint_image_brightness(image, tone->exposure, &run->brightness,
                           &error); // without linear beauty there is nothing to measure
    if (first && !run->is_command) // the command reports the whole run at its end
        glintL_warn_of_clipping(run);
}
