// --sweep name=a:b:n: the script is run once for each value, and its frames are numbered through.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/command/cli.h"

bool cli_read_sweep(char *text, cli_sweep *sweep, char message[GLINTL_MESSAGE_SIZE])
{
    char *end = NULL;
    char *equals = strchr(text, '=');
    bool good = equals && equals > text;
    if (good) {
        sweep->from = strtod(equals + 1, &end);
        good = end > equals + 1 && *end == ':' && isfinite(sweep->from);
    }
    if (good) {
        const char *at = end + 1;
        sweep->to = strtod(at, &end);
        good = end > at && *end == ':' && isfinite(sweep->to);
    }
    if (good) {
        const char *at = end + 1;
        sweep->count = strtoll(at, &end, 10);
        good = end > at && *end == '\0' && sweep->count >= 1 && sweep->count <= 1000000;
    }
    if (!good) {
        snprintf(message, GLINTL_MESSAGE_SIZE,
                 "name=from:to:count with count 1 .. 1000000, such as radius=1:5:9, expected, got '%.200s'", text);
        return false;
    }
    *equals = '\0'; // the name ends there
    sweep->name = text;
    return true;
}

int64_t cli_sweep_points(const cli_options *options)
{
    int64_t points = options->sweep_count ? 1 : 0;
    for (size_t i = 0; i < options->sweep_count && points <= GLINTL_FRAMES_MAX; i++)
        points *= options->sweeps[i].count;
    return points;
}

// Rounds to 15 digits of `scale`, so that 0.1:0.9:9 has 0.3 and not 0.30000000000000004.
static double shorten(double value, double scale)
{
    char text[400];
    const int decimals = 14 - (int)floor(log10(scale));
    if (decimals < 1 || decimals > 330 || value == floor(value))
        return value;
    snprintf(text, sizeof text, "%.*f", decimals, value);
    return strtod(text, NULL);
}

// The ends exactly, and between them whole numbers where steps are whole: 1:50:50 has 28.
static double value_at(const cli_sweep *sweep, int64_t step)
{
    const double last = (double)(sweep->count - 1), at = (double)step;
    if (step == 0)
        return sweep->from;
    if (step == sweep->count - 1)
        return sweep->to;
    double value = (sweep->from * (last - at) + sweep->to * at) / last;
    if (!isfinite(value))
        value = sweep->from * ((last - at) / last) + sweep->to * (at / last);
    return shorten(value, fmax(fabs(sweep->from), fabs(sweep->to)));
}

void cli_sweep_to(cli_options *options, glintL_run *run, int64_t point)
{
    int64_t rest = point - 1;
    size_t first_set = run->request.set_count - options->sweep_count; // the sweeps' sets are the last
    for (size_t i = 0; i < options->sweep_count; i++) {
        cli_sweep *sweep = &options->sweeps[i];
        int64_t step = rest % sweep->count;
        glintL_format_number(sweep->text, value_at(sweep, step));
        run->request.sets[first_set + i] = (glintL_set) { .name = sweep->name, .text = sweep->text };
        rest /= sweep->count;
    }
}
