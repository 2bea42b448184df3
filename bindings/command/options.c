// The options: how each is read, and checked before the script runs.
#include <errno.h>
#include <float.h>
#include <inttypes.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/command/cli.h"

#define SCRIPTED (CLI_RENDER | CLI_EXPLAIN | CLI_DUMP | CLI_DESCRIBE | CLI_COST)
#define SHOWN (SCRIPTED | CLI_WATCH)
#define FILES (CLI_COMPARE | CLI_SHEET | CLI_ASSEMBLE | CLI_REPRODUCE | CLI_NEW | CLI_JOIN | CLI_RELIGHT)
#define ALL (SHOWN | FILES | CLI_PUBLISH | CLI_COMPLETION | CLI_HELP)
#define MESSAGE GLINTL_MESSAGE_SIZE

// The fields of scene:render{} that relight accepts as options: the fields that convert light to a picture.
enum {
    RELIGHTS_samples, RELIGHTS_seed = 0, RELIGHTS_precision = 0, RELIGHTS_alpha = 0, RELIGHTS_outline = 0,
    RELIGHTS_visibility = 0, RELIGHTS_clamp = 0, RELIGHTS_rays = 0, RELIGHTS_dither = CLI_RELIGHT, RELIGHTS_bits = CLI_RELIGHT, RELIGHTS_transfer = CLI_RELIGHT, RELIGHTS_rounding = CLI_RELIGHT,
    RELIGHTS_tone = CLI_RELIGHT, RELIGHTS_encode = CLI_RELIGHT
};

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
    return glintL_complain(message, "whole number %" PRId64 " .. %" PRId64 " expected, got '%.200s'", min, max, text);
}

// Returns the member for the value, at the offset in the option's row.
static void *value_of(cli_options *options, const cli_option *option) { return (char *)options + option->at; }

static bool read_flag(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)text, (void)message;
    *(bool *)value_of(options, option) = true;
    return true;
}

static bool read_text(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)message;
    *(const char **)value_of(options, option) = text;
    return true;
}

static bool read_count(cli_options *options, const cli_option *option, char *text, char *message)
{
    return read_whole(text, (int64_t)option->min, (int64_t)option->max, value_of(options, option), message);
}

static bool read_int(cli_options *options, const cli_option *option, char *text, char *message)
{
    int64_t value = 0;
    bool good = read_whole(text, (int64_t)option->min, (int64_t)option->max, &value, message);
    if (good)
        *(int *)value_of(options, option) = (int)value;
    return good;
}

static bool read_real(cli_options *options, const cli_option *option, char *text, char *message)
{
    char *end;
    double value = strtod(text, &end);
    if (end > text && *end == '\0' && value >= option->min && value <= option->max) {
        *(double *)value_of(options, option) = value;
        return true;
    }
    return glintL_complain(message, "%s expected, got '%.200s'", option->expected, text);
}

// Returns which of the words "show|error|none" the text is, from 0; -1: none, and writes the message.
static int find_word(const cli_option *option, const char *text, char *message)
{
    const size_t length = strlen(text);
    size_t used = 0;
    int index = 0;
    for (const char *at = option->value; *at; at += *at == '|', index++) {
        size_t word = strcspn(at, "|");
        if (word == length && strncmp(at, text, length) == 0)
            return index;
        const char *before = at == option->value ? "" : at[word] ? ", " : " or ";
        used += (size_t)snprintf(message + used, MESSAGE - used, "%s%.*s", before, (int)word, at);
        at += word;
    }
    snprintf(message + used, MESSAGE - used, " expected, got '%.200s'", text);
    return -1;
}

static bool read_word(cli_options *options, const cli_option *option, char *text, char *message)
{
    return find_word(option, text, message) >= 0 && read_text(options, option, text, message);
}

static bool read_warnings(cli_options *options, const cli_option *option, char *text, char *message)
{
    int word = find_word(option, text, message);
    options->request.warnings = (glintL_warnings)word;
    return word >= 0;
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

static bool read_shard(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    return glintL_selection_parse_shard(&options->request.selection, text, message);
}

// Reads an option that has the name of a field of scene:render{}. Without a text it is a switch.
// Returns the number of the field of scene:render{} that an option sets.
static int field_of(const cli_option *option)
{
    return glintL_render_find(strcmp(option->name, "max-depth") == 0 ? "max_depth" : option->name);
}

static bool read_render(cli_options *options, const cli_option *option, char *text, char *message)
{
    glintL_render scratch = glintL_render_default();
    int field = field_of(option);
    const char *value = text ? text : "true";
    options->request.render_text[field] = value;
    return glintL_render_set_text(&scratch, field, value, message);
}

// Reads --exposure, which also accepts "auto".
static bool read_exposure(cli_options *options, const cli_option *option, char *text, char *message)
{
    options->finds_exposure = strcmp(text, "auto") == 0;
    if (options->finds_exposure || read_render(options, option, text, message))
        return true;
    return glintL_complain(message, "number -32 .. 32 or auto expected, got '%.200s'", text);
}

// Reads --colormap. NAME:auto takes the range of all pictures.
static bool read_colormap(cli_options *options, const cli_option *option, char *text, char *message)
{
    char *colon = strchr(text, ':');
    options->finds_range = colon && strcmp(colon, ":auto") == 0;
    if (options->finds_range)
        *colon = '\0'; // ends the name
    return read_render(options, option, text, message);
}

static bool read_size(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    char *end;
    long width = strtol(text, &end, 10), height = 0;
    bool good = end > text && (*end == 'x' || *end == 'X') && end[1] >= '0' && end[1] <= '9';
    if (good)
        height = strtol(end + 1, &end, 10);
    if (!good || *end || width < 1 || width > GLINT_SIDE_MAX || height < 1 || height > GLINT_SIDE_MAX)
        return glintL_complain(message, "WxH with sides 1 .. %d expected, got '%.200s'", GLINT_SIDE_MAX, text);
    snprintf(options->width, sizeof options->width, "%ld", width);
    snprintf(options->height, sizeof options->height, "%ld", height);
    options->request.render_text[glintL_render_find("width")] = options->width;
    options->request.render_text[glintL_render_find("height")] = options->height;
    return true;
}

bool cli_add_set(glintL_request *request, const char *name, const char *text)
{
    glintL_set *grown = realloc(request->sets, (request->set_count + 1) * sizeof *grown);
    if (!grown)
        return false;
    request->sets = grown;
    grown[request->set_count++] = (glintL_set) { .name = name, .text = text };
    return true;
}

static bool read_set(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    char *equals = strchr(text, '=');
    if (!equals || equals == text)
        return glintL_complain(message, "name=value expected, got '%.200s'", text);
    if (!cli_add_set(&options->request, text, equals + 1))
        return glintL_complain(message, "out of memory");
    *equals = '\0'; // ends the name
    return true;
}

// Reads NAME=VALUE. bindings/relight checks the parts.
static bool read_light(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    const char *equals = strrchr(text, '=');
    if (!equals || equals == text || !equals[1])
        return glintL_complain(message, "NAME=STRENGTH or NAME=COLOUR expected, got '%.200s'", text);
    const char **grown = realloc(options->lights, (options->light_count + 1) * sizeof *grown);
    if (!grown)
        return glintL_complain(message, "out of memory");
    options->lights = grown;
    grown[options->light_count++] = text;
    return true;
}

static bool read_sweep(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    cli_sweep *grown = realloc(options->sweeps, (options->sweep_count + 1) * sizeof *grown);
    if (!grown)
        return glintL_complain(message, "out of memory");
    options->sweeps = grown;
    return cli_read_sweep(text, &grown[options->sweep_count++], message);
}

// Reads a size such as 512M, in bytes. 0 turns caching off.
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
    if (!good || !(size >= 0 && size <= 0x1p50))
        return glintL_complain(message, "size such as 512M or 4G expected, got '%.200s'", text);
    options->request.no_reuse = options->request.no_reuse || size < 1;
    options->request.reuse_memory = (size_t)size;
    return true;
}

// Reads the page's port; without a number, any free port.
static bool read_port(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option;
    int64_t port = 0;
    if (text && !read_whole(text, 0, 65535, &port, message))
        return false;
    options->http_port = (int)port;
    return true;
}

// Reads the time limit of the script, in seconds; without a number, one minute.
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

static bool read_live(cli_options *options, const cli_option *option, char *text, char *message)
{
    (void)option, (void)message;
    options->is_live = true;
    options->live_script = text;
    return true;
}

// ---- The table ----

#define AT(member) .at = offsetof(cli_options, member)
#define WITHIN(least, most) .min = (least), .max = (most)
#define LOOKED CLI_RENDER | CLI_EXPLAIN | CLI_DUMP | CLI_WATCH | CLI_COST | CLI_PUBLISH

// The options that are fields of scene:render{} and are described completely by the list of fields.
#define FIELD(...)
#define OPTION(field, kind, sort, member, min, max, words, text, say) \
    { #field, 0, text, SHOWN | RELIGHTS_##field, read_render, .help = say },

const cli_option cli_option_list[CLI_OPTION_COUNT] = {
    { "frames", 'f', "LIST", CLI_RENDER | CLI_DUMP | CLI_SHEET | CLI_ASSEMBLE | CLI_RELIGHT, read_frames,
      .help = "frames to render: 1-3,5,7-20:2,90-; the first is 1", .group = "frames" },
    { "start", 's', "N", CLI_RENDER, read_count, .help = "first frame", AT(start), WITHIN(1, GLINTL_FRAMES_MAX) },
    { "end", 'e', "N", CLI_RENDER, read_count, .help = "last frame", AT(end), WITHIN(1, GLINTL_FRAMES_MAX) },
    { "jump", 'j', "N", CLI_RENDER, read_count, .help = "step from frame to frame", AT(jump),
      WITHIN(1, GLINTL_FRAMES_MAX) },
    { "shard", 0, "K/N", CLI_RENDER, read_shard, .help = "render only the K-th of N parts of the frames" },
    { "frame", 0, "N", LOOKED, read_frame, .help = "the frame to use" },
    { "sweep", 0, "NAME=VALUES", CLI_RENDER | CLI_EXPLAIN, read_sweep,
      .help = "run the script for each value of a parameter: A:B:N, A:B:*N or V,V,V",
      .repeats = true },
    { "output", 'o', "PATTERN", CLI_RENDER | CLI_EXPLAIN | CLI_DUMP | CLI_SHEET | CLI_ASSEMBLE | CLI_JOIN | CLI_PUBLISH | CLI_RELIGHT, read_text,
      .help = "output files: %04d or #### is the frame number; .png, .svg, .pdf, .pfm, .npy, .exr, a film, or none", AT(output), .suggest = CLI_SUGGEST_FILES,
      .group = "files" },
    { "passes", 0, "LIST", SCRIPTED, read_render, .help = "also write these:", .suggest = CLI_SUGGEST_PASSES },
    { "force", 0, NULL, CLI_RENDER | CLI_SHEET | CLI_ASSEMBLE, read_flag,
      .help = "render frames again that are already finished", AT(request.force) },
    { "fps", 0, "N", CLI_RENDER | CLI_ASSEMBLE | CLI_RELIGHT, read_real,
      .help = "frames per second of a film: .mp4, .webm, .gif, .apng", AT(request.fps), WITHIN(DBL_TRUE_MIN, 1e6),
      .expected = "frames a second > 0" },
    { "apng", 0, NULL, CLI_RENDER | CLI_ASSEMBLE | CLI_RELIGHT, read_flag, .help = "write an output in .png as an "
                                                                                   "animated PNG", AT(request.apng) },
    { "columns", 0, "N", CLI_SHEET, read_count, .help = "pictures in a row of the sheet", AT(columns),
      WITHIN(1, GLINT_SIDE_MAX), .group = "sheets" },
    { "label", 0, "TEXT", CLI_SHEET, read_text, .help = "text under each picture, with {name}, {file}, {frame}",
      AT(label) },
    { "names", 0, "LIST", CLI_SHEET, read_text, .help = "AXIS=NAME,VALUE=NAME,...: names of axes and values on the sheet", AT(names) },
    { "format", 0, "FORMAT", CLI_SHEET, read_text, .help = "format of numbers, such as %.2f; AXIS=FORMAT,... for some axes",
      AT(format) },
    { "title", 0, "TEXT", CLI_SHEET | CLI_PUBLISH | CLI_RELIGHT, read_text, .help = "text above the sheet or page", AT(title) },
    { "difference", 0, "N", CLI_SHEET, read_count, .help = "also show the difference from the N-th picture", AT(difference),
      WITHIN(1, 1000000) },
    { "gain", 0, "X", CLI_SHEET, read_real, .help = "multiply the difference by X", AT(gain), WITHIN(1e-3, 1e6),
      .expected = "number 0.001 .. 1000000" },
    { "label-size", 0, "POINTS", CLI_SHEET, read_real, .help = "size of the sheet's text, in 1/72 inch", AT(label_size),
      WITHIN(1, 10000), .expected = "points 1 .. 10000" },
    { "colorbar", 0, "BAR", CLI_SHEET, read_text, .help = "MAP,LOW,HIGH,TITLE: a colour bar of all pictures",
      AT(colorbar) },
    { "transparent", 0, NULL, CLI_SHEET, read_flag, .help = "transparent background of the sheet", AT(transparent) },
    { "set", 'D', "NAME=VALUE", SHOWN | CLI_PUBLISH, read_set, .help = "set a parameter of the script", .repeats = true,
      .group = "picture" },
    { "region", 0, "RECT", CLI_RENDER | CLI_EXPLAIN, read_render, .help = "X,Y,W,H: render only this part of the "
                                                                          "frame" },
    { "orbit", 0, "VIEW", CLI_RENDER, read_render,
      .help = "YAW,PITCH or YAW,PITCH,ZOOM,RIGHT,UP: move the camera around, in degrees to the right and up" },
    { "size", 0, "WxH", SHOWN | CLI_PUBLISH, read_size, .help = "width and height in pixels",
      .suggest = "640x360 1280x720 1920x1080 3840x2160" },
    { "dpi", 0, "N", SHOWN | CLI_SHEET | CLI_RELIGHT, read_render, .help = "pixels per inch, for print" },
    GLINTL_RENDER_LIST(FIELD, OPTION) { "max-depth", 0, "N", SHOWN, read_render,
                                        .help = "segments of a path through mirrors and glass" },
    { "adaptive", 0, "X", SHOWN, read_render,
                                        .help = "take all samples only where neighbouring pixels differ by more than X",
                                        .suggest = "0.3 0.1 0.03 0.01" },
    { "until", 0, "ERROR", CLI_RENDER, read_real, .help = "take samples until the picture's error is estimated at ERROR",
      AT(request.until), WITHIN(DBL_TRUE_MIN, DBL_MAX), .expected = "error, in fractions of white, > 0", .suggest = "0.01 0.003 0.001" },
    { "until-light", 0, "ERROR", CLI_RENDER, read_real, .help = "the same for the error of linear light, before the tone curve",
      AT(request.until_light), WITHIN(DBL_TRUE_MIN, DBL_MAX), .expected = "error of linear light > 0", .suggest = "0.01 0.003 0.001" },
    { "seconds", 0, "N", CLI_RENDER, read_real, .help = "take samples for at most N seconds a frame", AT(request.seconds),
      WITHIN(DBL_TRUE_MIN, 1e9), .expected = "seconds > 0", .suggest = "10 30 120" },
    { "colormap", 0, "MAP", SHOWN, read_colormap,
      .help = "colours of depth and d:NAME in a .png: viridis, magma, cividis, turbo, coolwarm, none; MAP:LOW:HIGH "
              "sets the range, MAP:auto finds one range for all frames",
      .suggest = "none viridis magma cividis turbo coolwarm viridis:auto" },
    { "exposure", 0, "STOPS", SHOWN | CLI_RELIGHT, read_exposure,
      .help = "stops brighter or darker; auto: one exposure for all frames, with nothing clipped", .suggest = "auto -2 -1 1 2" },
    { "threads", 't', "N", SHOWN | CLI_REPRODUCE | CLI_PUBLISH, read_int, .help = "worker threads", AT(request.threads),
      WITHIN(1, 1024), .group = "machine" },
    { "no-reuse", 0, NULL, CLI_RENDER | CLI_WATCH, read_flag, .help = "do not cache results between frames",
      AT(request.no_reuse) },
    { "reuse-memory", 0, "SIZE", CLI_RENDER | CLI_WATCH, read_memory, .help = "memory for cached results, such as "
                                                                              "512M or 4G" },
    { "repeat", 0, "N", CLI_RENDER, read_int, .help = "render each frame N times and report each time", AT(request.repeat),
      WITHIN(1, 1000000) },
    { "untrusted", 0, "[SECONDS]", CLI_RENDER | CLI_EXPLAIN | CLI_DESCRIBE, read_untrusted,
      .help = "the script can only compute and write pictures" },
    { "programs", 0, NULL, CLI_EXPLAIN, read_flag, .help = "also list the instructions of patterns and shaders",
      AT(programs), .group = "explain" },
    { "quick", 0, NULL, CLI_COST, read_flag, .help = "run each setting fewer times", AT(quick), .group = "cost" },
    { "budget", 0, "SECONDS", CLI_COST, read_real, .help = "how long the study may take", AT(budget_s),
      WITHIN(DBL_TRUE_MIN, 1e6), .expected = "seconds, a number above 0 and up to 1000000," },
    { "knobs", 0, "LIST", CLI_COST, read_text, .help = "only these knobs, such as samples,precision", AT(knobs) },
    { "report", 0, "DIR", CLI_COST, read_text, .help = "write a page with the plot and the pictures to DIR", AT(report),
      .suggest = CLI_SUGGEST_FILES },
    { "light", 0, "NAME=VALUE", CLI_RELIGHT, read_light, .help = "a light's strength, such as 2, or colour, such as "
                                                                 "#ffd9a0", .repeats = true,
      .group = "relight" },
    { "controls", 0, "LIST", CLI_PUBLISH, read_text, .help = "parameters that get a control; default: all", AT(controls),
      .group = "publish" },
    { "source", 0, NULL, CLI_PUBLISH, read_flag, .help = "the page shows the script", AT(shows_source) },
    { "live", 0, "[SCRIPT]", CLI_RENDER | CLI_COST | CLI_SHEET, read_live,
      .help = "pages also have a live figure of the script" },
    { "http", 0, "[PORT]", CLI_WATCH, read_port, .help = "also serve a page", .group = "watch" },
    { "terminal", 0, "kitty|sixel|blocks|text", CLI_WATCH, read_word, .help = "how to draw pictures in the terminal", AT(terminal) },
    { "dialect", 0, "gr", SHOWN | CLI_REPRODUCE, read_word, .help = "dialect that the script is written in", AT(dialect),
      .suggest = "gr", .group = "dialect" },
    { "gr-order", 0, "pre|post", SHOWN | CLI_REPRODUCE, read_text,
      .help = "order of transforms: the first acts first, or the last", AT(dialect_text[0]) },
    { "gr-pixel", 0, "0|0.5", SHOWN | CLI_REPRODUCE, read_text, .help = "where a ray passes through its pixel",
      AT(dialect_text[1]) },
    { "gr-specular", 0, "phong|blinn", SHOWN | CLI_REPRODUCE, read_text, .help = "how highlights fall off",
      AT(dialect_text[2]) },
    { "gr-background", 0, "COLOR", SHOWN | CLI_REPRODUCE, read_text, .help = "R,G,B from 0 to 1, or #rrggbb",
      AT(dialect_text[3]) },
    { "gr-plane", 0, "xz|xz-2|xz-corner|xy|xy-2|xy-corner", SHOWN | CLI_REPRODUCE, read_text,
      .help = "the square of gr.plane", AT(dialect_text[4]) },
    { "gr-axis", 0, "x|y|z", SHOWN | CLI_REPRODUCE, read_text, .help = "axis of cylinders and cones", AT(dialect_text[5]) },
    { "fail", 0, "X", CLI_COMPARE, read_real, .help = "difference above which the comparison fails", AT(fail), WITHIN(0, DBL_MAX),
      .expected = "number >= 0", .group = "compare" },
    { "warn", 0, "X", CLI_COMPARE, read_real, .help = "difference above which it warns", AT(warn), WITHIN(0, DBL_MAX),
      .expected = "number >= 0" },
    { "tolerance", 0, "N", CLI_COMPARE, read_real, .help = "instead of --fail: in steps of 8 bits, 1 of 255", AT(tolerance),
      WITHIN(0, 255), .expected = "number from 0 to 255" },
    { "json", 0, NULL, ALL, read_flag, .help = "print events on stdout as JSON, one per line", AT(json), .group = "report" },
    { "quiet", 'q', NULL, ALL, read_flag, .help = "do not report frames", AT(quiet) },
    { "warnings", 0, "show|error|none", CLI_RENDER | CLI_WATCH, read_warnings, .help = "what a warning does" },
    { "help", 'h', NULL, ALL, read_flag, .help = "print help; with a script, also its parameters", AT(help) },
    { "version", 0, NULL, ALL, read_flag, .help = "print the version", AT(version) },
    { "verbose", 0, NULL, ALL, read_flag, .help = "with --version: also libraries, kernels and limits", AT(verbose) },
};

// Adds the value of an option, if it was given, to the table on top of the stack.
static void add_value(lua_State *L, const cli_options *options, const cli_option *option)
{
    const char *at = (const char *)options + option->at;
    if (option->read == read_flag)
        glintL_set_flag(L, option->name, *(const bool *)at);
    else if (option->read == read_text || option->read == read_word)
        glintL_set_text(L, option->name, *(const char *const *)at);
    else if (option->read == read_render)
        glintL_set_text(L, option->name, options->request.render_text[field_of(option)]);
    else if (option->read == read_count && *(const int64_t *)at)
        glintL_set_whole(L, option->name, *(const int64_t *)at);
    else if (option->read == read_int && *(const int *)at)
        glintL_set_whole(L, option->name, *(const int *)at);
    else if (option->read == read_real && *(const double *)at > 0)
        glintL_set_number(L, option->name, *(const double *)at);
}

void cli_push_options(lua_State *L, const cli_options *options)
{
    lua_newtable(L);
    for (size_t i = 0; i < CLI_OPTION_COUNT; i++)
        add_value(L, options, &cli_option_list[i]);
    glintL_set_flag(L, "live", options->is_live);
    glintL_set_text(L, "live_script", options->live_script);
}

bool cli_option_may_lack(const cli_option *option) { return option->value && option->value[0] == '['; }
