// The options: what each takes, checked before the script runs.
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

#define SCRIPTED (CLI_RENDER | CLI_EXPLAIN | CLI_DESCRIBE | CLI_COST)
#define SHOWN (SCRIPTED | CLI_WATCH)
#define FILES (CLI_COMPARE | CLI_SHEET | CLI_ASSEMBLE | CLI_REPRODUCE | CLI_NEW)
#define ALL (SHOWN | FILES | CLI_COMPLETION)
#define MESSAGE GLINTL_MESSAGE_SIZE

// ---- Readers ----

static bool read_whole(const char *text, int64_t min, int64_t max, int64_t *out, char *message)
{
    char *end;
    errno = 0;
    long long value = strtoll(text, &end, 10);
    if (end > text && *end == '\0' && !errno && value >= min && value <= max) {
        *out = value;
        return true;
    }
    snprintf(message, MESSAGE, "whole number %" PRId64 " .. %" PRId64 " expected, got '%.200s'", min, max, text);
    return false;
}

static bool read_flag(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)text, (void)message;
    static const char *const names[] = { "json", "quiet", "help", "version", "force", "no-reuse", "apng", "quick" };
    bool *const flags[] = { &options->json,         &options->quiet,         &options->help,
                            &options->version,      &options->request.force, &options->request.no_reuse,
                            &options->request.apng, &options->quick };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(option->name, names[i]) == 0)
            *flags[i] = true;
    return true;
}

static bool read_frames(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    options->has_frames = true;
    return glintL_selection_parse(&options->request.selection, text, message);
}

static bool read_frame(cli_options *options, const cli_option *option, char *text, char *message)
{
    if (!read_whole(text, 1, GLINTL_FRAMES_MAX, &options->frame, message))
        return false;
    return read_frames(options, option, text, message);
}

static bool read_step(cli_options *options, const cli_option *option, char *text, char *message)
{
    int64_t *out = option->letter == 's' ? &options->start : option->letter == 'e' ? &options->end : &options->jump;
    return read_whole(text, 1, GLINTL_FRAMES_MAX, out, message);
}

static bool read_shard(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    return glintL_selection_parse_shard(&options->request.selection, text, message);
}

// An option of the same name as a field of scene:render{}.
static bool read_render(cli_options *options, const cli_option *option, char *text, char *message)
{
    glintL_render scratch = glintL_render_default();
    int field = glintL_render_find(option->name);
    options->request.render_text[field] = text;
    return glintL_render_set_text(&scratch, field, text, message);
}

// The same without a text.
static bool read_switch(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)text, (void)message;
    options->request.render_text[glintL_render_find(option->name)] = "true";
    return true;
}

// Which endings are right depends on the command, which is known when all is read.
static bool read_output(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option, (void)message;
    options->output = text;
    return true;
}

static bool read_fps(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    char *end;
    double fps = strtod(text, &end);
    if (end == text || *end || !(fps > 0 && fps <= 1e6)) {
        snprintf(message, MESSAGE, "frames a second > 0 expected, got '%.200s'", text);
        return false;
    }
    options->request.fps = fps;
    return true;
}

static bool read_sheet(cli_options *options, const cli_option *option, char *text, char *message)
{
    char *end;
    if (option->name[0] == 'c')
        return read_whole(text, 1, GLINT_SIDE_MAX, &options->columns, message);
    if (option->name[0] == 'd')
        return read_whole(text, 1, 1000000, &options->difference, message);
    if (option->name[0] == 'g') {
        options->gain = strtod(text, &end);
        if (end > text && *end == '\0' && options->gain >= 1e-3 && options->gain <= 1e6)
            return true;
        snprintf(message, MESSAGE, "number 0.001 .. 1000000 expected, got '%.200s'", text);
        return false;
    }
    *(option->name[0] == 'l' ? &options->label : &options->title) = text;
    return true;
}

static bool read_size(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    char *end;
    long width = strtol(text, &end, 10), height = 0;
    bool good = end > text && (*end == 'x' || *end == 'X') && end[1] >= '0' && end[1] <= '9';
    if (good)
        height = strtol(end + 1, &end, 10);
    if (!good || *end || width < 1 || width > GLINT_SIDE_MAX || height < 1 || height > GLINT_SIDE_MAX) {
        snprintf(message, MESSAGE, "WxH with sides 1 .. %d expected, got '%.200s'", GLINT_SIDE_MAX, text);
        return false;
    }
    snprintf(options->width, sizeof options->width, "%ld", width);
    snprintf(options->height, sizeof options->height, "%ld", height);
    options->request.render_text[glintL_render_find("width")] = options->width;
    options->request.render_text[glintL_render_find("height")] = options->height;
    return true;
}

static bool read_set(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    char *equals = strchr(text, '=');
    if (equals && equals > text && cli_add_set(&options->request, text, equals + 1)) {
        *equals = '\0'; // the name ends there
        return true;
    }
    snprintf(message, MESSAGE, "name=value expected, got '%.200s'", text);
    return false;
}

static bool read_sweep(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    cli_sweep *grown = realloc(options->sweeps, (options->sweep_count + 1) * sizeof *grown);
    if (!grown) {
        snprintf(message, MESSAGE, "out of memory");
        return false;
    }
    options->sweeps = grown;
    if (!cli_read_sweep(text, &grown[options->sweep_count], message))
        return false;
    options->sweep_count++;
    return true;
}

static bool read_count(cli_options *options, const cli_option *option, char *text, char *message)
{
    bool threads = option->letter == 't';
    int64_t count = 0;
    bool good = read_whole(text, 1, threads ? 1024 : 1000000, &count, message);
    if (good)
        *(threads ? &options->request.threads : &options->request.repeat) = (int)count;
    return good;
}

// A size such as 512M, in bytes. 0 keeps nothing.
static bool read_memory(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    static const char suffixes[] = "KMGT";
    char *end;
    double size = strtod(text, &end);
    bool good = end > text;
    const char *suffix = *end ? strchr(suffixes, *end) : NULL;
    for (const char *at = suffixes; suffix && at <= suffix; at++)
        size *= 1024;
    good = good && (*end == '\0' || (suffix && end[1] == '\0'));
    if (!good || !(size >= 0 && size <= 0x1p50)) {
        snprintf(message, MESSAGE, "size such as 512M or 4G expected, got '%.200s'", text);
        return false;
    }
    options->request.no_reuse = options->request.no_reuse || size < 1;
    options->request.reuse_memory = (size_t)size;
    return true;
}

// The page's port; without a number any free one.
static bool read_port(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    int64_t port = 0;
    if (text && !read_whole(text, 0, 65535, &port, message))
        return false;
    options->http_port = (int)port;
    return true;
}

static bool read_terminal(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    static const char *const known[] = { "kitty", "sixel", "blocks", "text" };
    for (int i = 0; i < 4; i++)
        if (strcmp(text, known[i]) == 0) {
            options->terminal = text;
            return true;
        }
    snprintf(message, MESSAGE, "kitty, sixel, blocks or text expected, got '%.200s'", text);
    return false;
}

// The seconds that the script may take; without a number a minute.
static bool read_untrusted(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    int64_t seconds = 60;
    if (text && !read_whole(text, 1, 1000000, &seconds, message))
        return false;
    options->untrusted_s = (double)seconds;
    options->request.is_untrusted = true;
    return true;
}

static bool read_warnings(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    static const char *const known[] = { "show", "error", "none" };
    for (int i = 0; i < 3; i++)
        if (strcmp(text, known[i]) == 0) {
            options->request.warnings = (glintL_warnings)i;
            return true;
        }
    snprintf(message, MESSAGE, "show, error or none expected, got '%.200s'", text);
    return false;
}

static bool read_threshold(cli_options *options, const cli_option *option, char *text, char *message)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || !(value >= 0) || !isfinite(value)) {
        snprintf(message, MESSAGE, "number >= 0 expected, got '%.200s'", text);
        return false;
    }
    *(option->name[0] == 'f' ? &options->fail : &options->warn) = value;
    return true;
}

static bool read_budget(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || !(value > 0 && value <= 1e6)) {
        snprintf(message, MESSAGE, "seconds, a number above 0 and up to 1000000, expected, got '%.200s'", text);
        return false;
    }
    options->budget_s = value;
    return true;
}

static bool read_report(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    options->report = text;
    return cost_report_check(text, message);
}

// The names are checked here, whether the scene responds later.
static bool read_knobs(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    options->knobs = text;
    return cost_knobs_check(text, message);
}

const cli_option cli_option_list[CLI_OPTION_COUNT] = {
    { "frames", 'f', true, CLI_RENDER | CLI_SHEET | CLI_ASSEMBLE, read_frames },
    { "start", 's', true, CLI_RENDER, read_step },
    { "end", 'e', true, CLI_RENDER, read_step },
    { "jump", 'j', true, CLI_RENDER, read_step },
    { "shard", 0, true, CLI_RENDER, read_shard },
    { "frame", 0, true, CLI_RENDER | CLI_EXPLAIN | CLI_WATCH | CLI_COST, read_frame },
    { "output", 'o', true, CLI_RENDER | CLI_EXPLAIN | CLI_SHEET | CLI_ASSEMBLE, read_output },
    { "fps", 0, true, CLI_RENDER | CLI_ASSEMBLE, read_fps },
    { "apng", 0, false, CLI_RENDER | CLI_ASSEMBLE, read_flag },
    { "columns", 0, true, CLI_SHEET, read_sheet },
    { "label", 0, true, CLI_SHEET, read_sheet },
    { "title", 0, true, CLI_SHEET, read_sheet },
    { "difference", 0, true, CLI_SHEET, read_sheet },
    { "gain", 0, true, CLI_SHEET, read_sheet },
    { "set", 'D', true, SHOWN, read_set },
    { "sweep", 0, true, CLI_RENDER, read_sweep },
    { "size", 0, true, SHOWN, read_size },
    { "samples", 0, true, SHOWN, read_render },
    { "adaptive", 0, true, SHOWN, read_render },
    { "precision", 0, true, SHOWN, read_render },
    { "visibility", 0, true, SHOWN, read_render },
    { "bits", 0, true, SHOWN, read_render },
    { "transfer", 0, true, SHOWN, read_render },
    { "rounding", 0, true, SHOWN, read_render },
    { "tone", 0, true, SHOWN, read_render },
    { "exposure", 0, true, SHOWN, read_render },
    { "alpha", 0, false, SHOWN, read_switch },
    { "outline", 0, true, SHOWN, read_render },
    { "passes", 0, true, SCRIPTED, read_render },
    { "encode", 0, true, SHOWN, read_render },
    { "seed", 0, true, SHOWN, read_render },
    { "threads", 't', true, SHOWN | CLI_REPRODUCE, read_count },
    { "no-reuse", 0, false, CLI_RENDER | CLI_WATCH, read_flag },
    { "reuse-memory", 0, true, CLI_RENDER | CLI_WATCH, read_memory },
    { "force", 0, false, CLI_RENDER | CLI_SHEET | CLI_ASSEMBLE, read_flag },
    { "repeat", 0, true, CLI_RENDER, read_count },
    { "quick", 0, false, CLI_COST, read_flag },
    { "budget", 0, true, CLI_COST, read_budget },
    { "report", 0, true, CLI_COST, read_report },
    { "knobs", 0, true, CLI_COST, read_knobs },
    { "dialect", 0, true, SHOWN | CLI_REPRODUCE, cli_read_dialect },
    { "gr-order", 0, true, SHOWN | CLI_REPRODUCE, cli_read_dialect },
    { "gr-pixel", 0, true, SHOWN | CLI_REPRODUCE, cli_read_dialect },
    { "gr-specular", 0, true, SHOWN | CLI_REPRODUCE, cli_read_dialect },
    { "gr-background", 0, true, SHOWN | CLI_REPRODUCE, cli_read_dialect },
    { "json", 0, false, ALL, read_flag },
    { "quiet", 'q', false, ALL, read_flag },
    { "warnings", 0, true, CLI_RENDER | CLI_WATCH, read_warnings },
    { "http", 0, CLI_MAY_HAVE_NUMBER, CLI_WATCH, read_port },
    { "terminal", 0, true, CLI_WATCH, read_terminal },
    { "untrusted", 0, CLI_MAY_HAVE_NUMBER, CLI_RENDER | CLI_EXPLAIN | CLI_DESCRIBE, read_untrusted },
    { "fail", 0, true, CLI_COMPARE, read_threshold },
    { "warn", 0, true, CLI_COMPARE, read_threshold },
    { "help", 'h', false, ALL, read_flag },
    { "version", 0, false, ALL, read_flag },
};
