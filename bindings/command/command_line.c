// The command line: words and options in any order.
#include <getopt.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/command/cli.h"
#include "bindings/run/film.h"

#define MESSAGE GLINTL_MESSAGE_SIZE

// Names of options in other programs, with glint's name.
static const char *const MEANINGS[][2] = {
    { "width", "size" }, { "height", "size" }, { "resolution", "size" }, { "param", "set" }, { "parameter", "set" },
    { "spp", "samples" }, { "antialias", "samples" }, { "aa", "samples" }, { "jobs", "threads" }, { "cores", "threads" },
    { "name", "output" }, { "overwrite", "force" }, { "silent", "quiet" }, { "crop", "region" }, { "gamma", "transfer" }, { "depth", "bits" },
};

// Returns the option that a misspelt name means, or NULL.
static const char *nearest_option(const char *name)
{
    const char *near = NULL;
    for (size_t i = 0; i < CLI_OPTION_COUNT; i++)
        near = glintL_nearer(name, near, cli_option_list[i].name);
    for (size_t i = 0; i < sizeof MEANINGS / sizeof *MEANINGS; i++)
        if (glintL_nearer(name, near, MEANINGS[i][0]) == MEANINGS[i][0])
            return MEANINGS[i][1];
    return near;
}

static bool complain_unknown(const char *text, char *message)
{
    char name[64];
    if (strncmp(text, "--", 2) != 0 || strlen(text) > 60)
        return glintL_complain(message, "%.100s: no such option; --help lists them", text);
    snprintf(name, sizeof name, "%.*s", (int)strcspn(text + 2, "="), text + 2);
    const char *near = nearest_option(name);
    if (near)
        snprintf(message, MESSAGE, "--%s: no such option; did you mean '--%s'?", name, near);
    else
        snprintf(message, MESSAGE, "--%s: no such option; --help lists them", name);
    return false;
}

// Writes the message when getopt_long returned '?' or ':'.
static bool complain(int what, const char *given, int code, char *message)
{
    if (code > 0xff) { // a long option of glint: its value is missing, or the option takes no value
        const char *name = cli_option_list[code - 0x100].name;
        return glintL_complain(message, "--%s: %s", name, what == ':' ? "a value is missing" : "it takes no value");
    }
    if (what == ':')
        return glintL_complain(message, "-%c: a value is missing", code);
    if (code && strncmp(given, "--", 2) != 0)
        return glintL_complain(message, "-%c: no such option; --help lists them", code);
    return complain_unknown(given, message);
}

static const cli_option *find_option(int code)
{
    if (code > 0xff)
        return &cli_option_list[code - 0x100];
    for (size_t i = 0; i < CLI_OPTION_COUNT; i++)
        if (cli_option_list[i].letter == code)
            return &cli_option_list[i];
    return NULL;
}

static int argument_of(const cli_option *option)
{
    return cli_option_may_lack(option) ? optional_argument : option->value ? required_argument : no_argument;
}

static bool is_number(const char *word) { return *word && word[strspn(word, "0123456789")] == '\0'; }

// Returns whether a second use of the option is an error: the user may have meant both values.
static bool is_given_once(const cli_option *option)
{
    static const char *const names[] = { "output", "frames", "shard", "passes", "region" };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(option->name, names[i]) == 0)
            return true;
    return false;
}

static bool read_argv(int argc, char **argv, cli_options *options, bool used[CLI_OPTION_COUNT], char *message)
{
    struct option list[CLI_OPTION_COUNT + 1] = { 0 };
    char letters[2 * CLI_OPTION_COUNT + 2] = ":", *letter = letters + 1, wrong[MESSAGE];
    for (size_t i = 0; i < CLI_OPTION_COUNT; i++) {
        list[i] = (struct option) { cli_option_list[i].name, argument_of(&cli_option_list[i]), NULL, 0x100 + (int)i };
        if (cli_option_list[i].letter) {
            *letter++ = cli_option_list[i].letter;
            if (cli_option_list[i].value)
                *letter++ = ':';
        }
    }
    *letter = '\0';
    opterr = 0;
    for (;;) {
        int at = optind, code = getopt_long(argc, argv, letters, list, NULL);
        if (code == -1)
            return true;
        if (code == '?' || code == ':')
            return complain(code, argv[optind > at ? optind - 1 : at], optopt, message);
        const cli_option *option = find_option(code);
        if (used[option - cli_option_list] && is_given_once(option))
            return glintL_complain(message, "--%s: given twice, so the first value would be lost; expected one value",
                                   option->name);
        used[option - cli_option_list] = true;
        if (cli_option_may_lack(option) && !optarg && optind < argc && is_number(argv[optind]))
            optarg = argv[optind++];
        if (!option->read(options, option, optarg, wrong))
            return glintL_complain(message, "--%s: %.1000s", option->name, wrong);
    }
}

// ---- Checks of words and options together ----

static bool read_words(int count, char **words, cli_options *options, char *message)
{
    const char *near = NULL;
    const cli_command_name *command = count > 0 ? cli_find_command(words[0], &near) : NULL;
    const cli_words kind = command ? command->words : CLI_SCRIPT;
    int used = command ? 1 : 0;
    if (command)
        options->command = command->command;
    options->has_command = command != NULL;
    if (kind == CLI_FILES) {
        options->arguments = words + used;
        options->argument_count = count - used;
        return true;
    }
    if (kind == CLI_FILE_SCRIPT && used < count)
        options->file = words[used++];
    if (used < count)
        options->script = words[used++];
    if (used == count)
        return true;
    if (near && used == 1)
        snprintf(message, MESSAGE, "%.200s: no such command; did you mean '%s'?", words[0], near);
    else
        snprintf(message, MESSAGE, "unexpected argument '%.200s'; put the script's own arguments after --", words[used]);
    return false;
}

// Checks -o for the commands whose output is a picture or a film.
static bool check_output(cli_options *options, char *message)
{
    char wrong[MESSAGE];
    glintL_render scratch = glintL_render_default();
    int field = glintL_render_find("output");
    if (!options->output || !(options->command & (CLI_RENDER | CLI_EXPLAIN)))
        return true;
    if (options->request.fps > 0 && glintL_film_kind_of(options->output, options->request.apng) == GLINTL_FILM_NONE)
        return glintL_complain(message, "--fps: only films have a frame rate; -o '%.200s' is a picture",
                               options->output);
    options->request.render_text[field] = options->output;
    if (glintL_render_set_text(&scratch, field, options->output, wrong))
        return true;
    return glintL_complain(message, "--output: %.1000s", wrong);
}

// Checks that an untrusted script writes its pictures to one folder.
static bool check_untrusted(const cli_options *options, char *message)
{
    const char *output = options->output;
    if (!options->untrusted_s || !output || strcmp(output, "none") == 0)
        return true;
    const char *slash = strrchr(output, '/');
    if (glintL_film_kind_of(output, options->request.apng) != GLINTL_FILM_NONE)
        snprintf(message, MESSAGE, "--untrusted: only pictures can be written; expected a picture's name, got "
                                   "'%.200s'; glint assemble makes a film of pictures",
                 output);
    else if (slash && memchr(output, '%', (size_t)(slash - output)))
        snprintf(message, MESSAGE, "--untrusted: expected a folder without a frame number, got '%.200s'; put the "
                                   "number into the file's name",
                 output);
    else if (glintL_name_is_special(output))
        snprintf(message, MESSAGE, "--untrusted: expected a regular file, got '%.200s'", output);
    else
        return true;
    return false;
}

// Rejects uses of standard input that need to read it twice or need its folder.
static bool check_input(const cli_options *options, char *message)
{
    if (!options->script || strcmp(options->script, "-") != 0 ||
        (options->command & (CLI_RENDER | CLI_EXPLAIN) && !options->sweep_count && !options->dialect &&
         !options->untrusted_s && !options->finds_exposure && !options->finds_range))
        return true;
    return glintL_complain(message, "-: expected a file; only render and explain read a script from standard input, "
                                    "and not with --sweep, --dialect, --untrusted or auto");
}

// Options that measure all pictures first belong only to commands that render.
static bool check_auto(const cli_options *options, char *message)
{
    if ((!options->finds_exposure && !options->finds_range) || options->command == CLI_RENDER || options->help)
        return true;
    return glintL_complain(message,
                           "--%s: auto works only with glint render, which measures all pictures first; expected %s",
                           options->finds_exposure ? "exposure" : "colormap",
                           options->finds_exposure ? "a number of stops" : "NAME:LOW:HIGH");
}

// Checks the options that go with --until and --seconds, which choose the samples of each picture.
static bool check_samples(const cli_options *options, char *message)
{
    const glintL_request *request = &options->request;
    const char *name = request->until > 0 ? "until" : request->until_light > 0 ? "until-light" : "seconds";
    const char *samples = request->render_text[glintL_render_find("samples")];
    if (request->until == 0 && request->until_light == 0 && request->seconds == 0)
        return true;
    if (request->until > 0 && request->until_light > 0) {
        snprintf(message, MESSAGE, "--until-light: not with --until; expected one of the two");
        return false;
    }
    if (options->request.repeat > 1)
        snprintf(message, MESSAGE, "--%s: not with --repeat, which renders the same samples each time", name);
    else if (options->finds_exposure || options->finds_range)
        snprintf(message, MESSAGE, "--%s: not with --%s auto, which measures pictures with other samples; expected %s",
                 name, options->finds_exposure ? "exposure" : "colormap",
                 options->finds_exposure ? "a number of stops" : "NAME:LOW:HIGH");
    else if (samples && atoi(samples) < 2)
        snprintf(message, MESSAGE, "--samples: expected at least 2 with --%s, got '%.20s'; it is the most that a pixel gets",
                 name, samples);
    else
        return true;
    return false;
}

static bool check_together(const cli_options *options, const bool used[CLI_OPTION_COUNT], char *message)
{
    for (size_t i = 0; i < CLI_OPTION_COUNT; i++) {
        if (used[i] && !options->help && !(cli_option_list[i].commands & options->command))
            return glintL_complain(message, "--%s: this command does not have this option; --help lists its options",
                                   cli_option_list[i].name);
    }
    if (options->verbose && !options->version)
        return glintL_complain(message, "--verbose: expected together with --version");
    if (options->has_frames && options->command == CLI_RENDER && (options->start || options->end || options->jump))
        return glintL_complain(message, "--frames: use either --frames or --start, --end and --jump, not both");
    if (options->end && options->end < (options->start ? options->start : 1))
        return glintL_complain(message, "--end: expected a frame >= %" PRId64 ", got '%" PRId64 "'", options->start,
                               options->end);
    for (size_t i = 0; i < options->sweep_count; i++) {
        bool twice = false;
        for (size_t j = 0; j < options->request.set_count; j++)
            twice = twice || strcmp(options->request.sets[j].name, options->sweeps[i].name) == 0;
        for (size_t j = 0; j < i; j++)
            twice = twice || strcmp(options->sweeps[j].name, options->sweeps[i].name) == 0;
        if (twice)
            return glintL_complain(message, "--sweep %.200s: the parameter is set twice; set it only once",
                                   options->sweeps[i].name);
    }
    if (cli_sweep_points(options) > GLINTL_FRAMES_MAX)
        return glintL_complain(message, "--sweep: expected at most %d points in total", GLINTL_FRAMES_MAX);
    return check_auto(options, message) && check_samples(options, message) && cli_check_dialect(options, message);
}

// Adds the swept parameters to the set ones, and turns -s -e -j into a range. --help shows the defaults of the swept
// parameters.
static bool complete(cli_options *options, char *message)
{
    bool good = true;
    options->request.swept_count = options->help ? 0 : options->sweep_count;
    for (size_t i = 0; i < options->request.swept_count; i++)
        good = good && cli_add_set(&options->request, options->sweeps[i].name, "");
    if (options->start || options->end || options->jump) {
        glintL_range range = { options->start ? options->start : 1, options->end ? options->end : INT64_MAX,
                               options->jump ? options->jump : 1 };
        good = good && glintL_selection_add(&options->request.selection, range);
    }
    if (!good)
        snprintf(message, MESSAGE, "out of memory");
    return good;
}

bool cli_read_options(int argc, char **argv, cli_options *options, char message[GLINTL_MESSAGE_SIZE])
{
    bool used[CLI_OPTION_COUNT] = { false };
    memset(options, 0, sizeof *options);
    options->command = CLI_RENDER;
    options->program = argc > 0 ? argv[0] : "";
    options->request.repeat = 1;
    options->frame = 1;
    options->http_port = -1;
    options->fail = options->warn = options->tolerance = -1;
    int words = argc;
    for (int i = 1; i < words; i++) {
        if (strcmp(argv[i], "--") == 0)
            words = i; // the words after this belong to the script
        else if (strcmp(argv[i], "--json") == 0)
            options->json = true; // so that an error here is also an event
    }
    if (!read_argv(words, argv, options, used, message) ||
        !read_words(words - optind, argv + optind, options, message) || !check_together(options, used, message) ||
        !check_input(options, message) || !check_output(options, message) || !check_untrusted(options, message) ||
        !complete(options, message))
        return false;
    if (words < argc && !options->arguments) {
        options->arguments = argv + words + 1;
        options->argument_count = argc - words - 1;
    }
    return true;
}

void cli_free_options(cli_options *options)
{
    glintL_selection_clear(&options->request.selection);
    free(options->lights);
    free(options->request.sets);
    free(options->request.folder);
    for (size_t i = 0; i < options->sweep_count; i++)
        cli_free_sweep(&options->sweeps[i]);
    free(options->sweeps);
}
