// Pictures of a frame with 1, 2, 4 ... samples, which glint watch and the pages show while the full picture is rendered.
#include <math.h>

#include "bindings/run/run.h"

#define STEPS_LEAST_MS 100 // a picture that takes less time is shown without steps

double glintL_next_samples(double samples, double own_samples, double full_ms)
{
    const bool is_quick = full_ms > 0 && full_ms < STEPS_LEAST_MS;
    return is_quick ? own_samples : fmin(samples > 0 ? 2 * samples : 1, own_samples);
}

void glintL_run_limit(glintL_run *run, double samples, bool is_partner)
{
    if ((samples > 0) != (run->most_samples > 0)) {
        glint_renderer *other = run->other_renderer;
        run->other_renderer = run->renderer;
        run->renderer = other;
    }
    run->most_samples = samples;
    run->renders_partner = is_partner;
}
