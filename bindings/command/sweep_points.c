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

void cli_sweep_to(cli_options *options, glintL_run *run, int64_t point)
{
    int64_t rest = point - 1;
    size_t first_set = run->request.set_count - options->sweep_count; // the sweeps' sets are the last
    for (size_t i = 0; i < options->sweep_count; i++) {
        cli_sweep *sweep = &options->sweeps[i];
        int64_t step = rest % sweep->count;
        double value = sweep->from;
        if (step > 0 && step == sweep->count - 1)
            value = sweep->to; // exactly
        else if (step > 0)
            value = sweep->from + (sweep->to - sweep->from) * ((double)step / (double)(sweep->count - 1));
        glintL_format_number(sweep->text, value);
        run->request.sets[first_set + i] = (glintL_set) { .name = sweep->name, .text = sweep->text };
        rest /= sweep->count;
    }
}
