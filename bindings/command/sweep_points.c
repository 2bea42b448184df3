// The values of a sweep. The script runs once for each point, and the frames are numbered consecutively.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/command/cli.h"

#define POINTS_MAX 1000000
#define NUMBER_SIZE 32 // bytes of a number's text

// ---- name=from:to:count and name=from:to:*count ----

typedef struct range {
    double from, to;
    int64_t count;
    bool has_factor; // a geometric sequence: each value is the previous one times a factor
} range;

static bool read_range(const char *text, range *out)
{
    char *end;
    out->from = strtod(text, &end);
    if (end == text || *end != ':' || !isfinite(out->from))
        return false;
    text = end + 1;
    out->to = strtod(text, &end);
    if (end == text || *end != ':' || !isfinite(out->to))
        return false;
    text = end + 1;
    out->has_factor = *text == '*';
    text += out->has_factor;
    out->count = strtoll(text, &end, 10);
    return end > text && *end == '\0' && out->count >= 1 && out->count <= POINTS_MAX;
}

// Rounds to 15 significant digits of `scale`, so that 0.1:0.9:9 has 0.3 and not 0.30000000000000004.
static double shorten(double value, double scale)
{
    char text[400];
    if (value == floor(value)) // also if the scale is 0
        return value;
    const int decimals = 14 - (int)floor(log10(scale));
    if (decimals < 1 || decimals > 330)
        return value;
    snprintf(text, sizeof text, "%.*f", decimals, value);
    return strtod(text, NULL);
}

// Returns value number `step`. The ends are exact, and so are whole numbers if steps are whole: 1:50:50 contains 28.
static double value_at(const range *r, int64_t step)
{
    const double last = (double)(r->count - 1), at = (double)step;
    if (step == 0)
        return r->from;
    if (step == r->count - 1)
        return r->to;
    if (r->has_factor) {
        const double value = r->from * glint_pow(r->to / r->from, at / last);
        return shorten(value, fabs(value));
    }
    double value = (r->from * (last - at) + r->to * at) / last;
    if (!isfinite(value))
        value = r->from * ((last - at) / last) + r->to * (at / last);
    return shorten(value, fmax(fabs(r->from), fabs(r->to)));
}

static bool ensure_capacity(cli_sweep *sweep, int64_t count, size_t bytes, char *message)
{
    sweep->count = count;
    sweep->values = malloc((size_t)count * sizeof *sweep->values);
    sweep->texts = malloc(bytes);
    if (!sweep->values || !sweep->texts)
        snprintf(message, GLINTL_MESSAGE_SIZE, "out of memory");
    return sweep->values && sweep->texts;
}

static bool list_range(cli_sweep *sweep, const range *r, char *message)
{
    if (r->has_factor && !(r->to / r->from > 0 && isfinite(r->to / r->from)))
        return glintL_complain(message,
                               "%s: expected two ends of the same sign, neither of them 0, for steps of equal factors",
                               sweep->name);
    if (!ensure_capacity(sweep, r->count, (size_t)r->count * NUMBER_SIZE, message))
        return false;
    for (int64_t i = 0; i < r->count; i++) {
        char *text = sweep->texts + i * NUMBER_SIZE;
        glintL_format_number(text, value_at(r, i));
        sweep->values[i] = text;
    }
    return true;
}

// ---- name=value,value,... ----

static bool list_words(cli_sweep *sweep, const char *text, char *message)
{
    int64_t count = 1;
    for (const char *at = text; *at; at++)
        count += *at == ',';
    if (!ensure_capacity(sweep, count, strlen(text) + 1, message))
        return false;
    char *at = strcpy(sweep->texts, text);
    for (int64_t i = 0; i < count; i++) {
        sweep->values[i] = at;
        at += strcspn(at, ",");
        *at++ = '\0';
        if (*sweep->values[i] == '\0')
            return glintL_complain(message, "%s: a value expected before and after each comma, got '%.200s'",
                                   sweep->name, text);
    }
    return true;
}

// ---- The option ----

bool cli_read_sweep(char *text, cli_sweep *sweep, char message[GLINTL_MESSAGE_SIZE])
{
    range r;
    char *equals = strchr(text, '=');
    *sweep = (cli_sweep) { 0 };
    const bool is_list = equals && strchr(equals, ',');
    if (!equals || equals == text || (!is_list && !read_range(equals + 1, &r)))
        return glintL_complain(message,
                               "expected name=from:to:count with count 1 .. %d, such as radius=1:5:9, "
                               "name=from:to:*count for equal factors, or a list, name=1,5,9; got '%.200s'",
                               POINTS_MAX, text);
    *equals = '\0'; // ends the name
    sweep->name = text;
    return is_list ? list_words(sweep, equals + 1, message) : list_range(sweep, &r, message);
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
    size_t first_set = run->request.set_count - options->sweep_count; // the sets of --sweep come last
    for (size_t i = 0; i < options->sweep_count; i++) {
        const cli_sweep *sweep = &options->sweeps[i];
        run->request.sets[first_set + i] =
            (glintL_set) { sweep->name, sweep->values[rest % sweep->count], sweep->values, sweep->count, false };
        rest /= sweep->count;
    }
}

void cli_spell_point(const cli_options *options, int64_t point, char *out, size_t size)
{
    int64_t rest = point - 1;
    size_t used = 0;
    *out = '\0';
    for (size_t i = 0; i < options->sweep_count && used < size; i++) {
        const cli_sweep *sweep = &options->sweeps[i];
        used += (size_t)snprintf(out + used, size - used, "%s%s=%s", used ? " " : "", sweep->name,
                                 sweep->values[rest % sweep->count]);
        rest /= sweep->count;
    }
}

void cli_free_sweep(cli_sweep *sweep)
{
    free(sweep->values);
    free(sweep->texts);
}
