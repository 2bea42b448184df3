/// The `glint` command: its command line, what it prints, and its sub-commands. Private to bindings/.
///
/// stdout is data, stderr is for people. The functions here print to the streams of a cli_output.
#ifndef GLINT_CLI_H
#define GLINT_CLI_H

#include <stdio.h>

#include "bindings/run/run.h"

// ---- command_line.c, options.c ----

typedef enum cli_command {
    CLI_RENDER = 1,
    CLI_EXPLAIN = 2,
    CLI_DESCRIBE = 4,
    CLI_COMPARE = 8,
    CLI_COST = 16,
    CLI_SHEET = 32,
    CLI_ASSEMBLE = 64,
    CLI_REPRODUCE = 128,
    CLI_NEW = 256,
    CLI_WATCH = 512,
    CLI_COMPLETION = 1024,
    CLI_JOIN = 2048,
    CLI_HELP = 4096,
    CLI_PUBLISH = 8192,
    CLI_RELIGHT = 16384
} cli_command;

typedef enum cli_words { ///< that follow a command's name
    CLI_SCRIPT,
    CLI_FILES, ///< any number; the command counts them
    CLI_FILE_SCRIPT
} cli_words;

typedef struct cli_command_name {
    const char *name;
    cli_command command;
    cli_words words;
    const char *synopsis; ///< what follows it on the command line
    const char *help; ///< a line for people
} cli_command_name;
#define CLI_COMMAND_COUNT 15
extern const cli_command_name cli_command_list[CLI_COMMAND_COUNT];

typedef struct cli_sweep { ///< --sweep
    const char *name;
    int64_t count;
    const char **values; ///< owned; `count` texts, in `texts`
    char *texts; ///< owned
} cli_sweep;

#define CLI_DIALECT_OPTIONS 6 ///< --gr-order and the like

typedef struct cli_options {
    cli_command command;
    bool has_command; ///< its name was given
    bool json, quiet, help, version, verbose;
    const char *program; ///< what the command was started as
    const char *script; ///< NULL: none given
    char **arguments; ///< the file names of a command that takes files, or the script's arguments after `--`
    int argument_count;
    const char **lights; ///< owned; of relight: NAME=VALUE each
    size_t light_count;
    const char *file; ///< of reproduce
    const char *output; ///< -o as it was given; NULL: not given
    const char *label, *title, *colorbar; ///< of sheet, the title of publish, too; NULL: not given
    const char *controls; ///< of publish; NULL: all parameters
    bool shows_source; ///< of publish
    bool is_live; ///< --live
    const char *live_script; ///< of --live; NULL: the script itself
    int64_t columns, difference; ///< of sheet; 0: not given
    double gain, label_size; ///< of sheet; 0: not given
    bool transparent; ///< of sheet
    int64_t frame; ///< of explain
    double fail, warn; ///< of compare
    cli_sweep *sweeps;
    size_t sweep_count;
    glintL_request request; ///< moved into the run
    bool quick; ///< of cost
    bool programs; ///< of explain: list their instructions
    double budget_s; ///< of cost; 0: none
    const char *report, *knobs; ///< of cost; NULL: none, all
    char width[16], height[16]; ///< of --size
    bool finds_exposure; ///< --exposure auto
    bool finds_range; ///< --colormap MAP:auto
    char exposure[16], colormap[64]; ///< which these have found
    int64_t start, end, jump; ///< -s -e -j; 0: not given
    bool has_frames;
    int http_port; ///< of watch; 0: any free one, -1: no page
    const char *terminal; ///< of watch: NULL: what the terminal says
    double untrusted_s; ///< time that an untrusted script may take; 0: the script is trusted
    const char *dialect; ///< of the script; NULL: glint's own
    const char *dialect_text[CLI_DIALECT_OPTIONS]; ///< what --gr-order ... were given; NULL: nothing
} cli_options;

#define CLI_SUGGEST_FILES "/" ///< completions: names of files,
#define CLI_SUGGEST_PASSES "," ///< the names of the passes

/// One option: its row has all of its texts, except the paragraph of the manual page.
typedef struct cli_option cli_option;
struct cli_option {
    const char *name;
    char letter; ///< 0: none
    /// The placeholder of its value in --help: "LIST"; "show|error|none": one of these; "": the choices of the field of
    /// scene:render{}; "[PORT]": a number that may be left out, and `text` is then NULL; NULL: it takes no text.
    const char *value;
    unsigned commands; ///< that know it
    /// Reads the option's text, and may change it. Returns false when the text is wrong; `message` then says why.
    bool (*read)(cli_options *options, const cli_option *option, char *text, char *message);
    const char *help; ///< a line for people
    size_t at; ///< of the member of cli_options, for readers of plain values
    double min, max; ///< of a number
    const char *expected; ///< of a number, in messages
    const char *suggest; ///< completions where `value` has none: words, blanks between, or CLI_SUGGEST_...
    bool repeats; ///< it may be given several times
    const char *group; ///< heading in --help of this and the options after it
};
#define CLI_OPTION_COUNT 69
extern const cli_option cli_option_list[CLI_OPTION_COUNT];
#define CLI_VALUE_SIZE 64
/// Returns the placeholder of the option's value in --help, or its choices; "" when it takes no value.
void cli_option_value(const cli_option *option, char out[CLI_VALUE_SIZE]);
bool cli_option_may_lack(const cli_option *option); ///< its text may be left out
/// Adds a --set. False: out of memory.
bool cli_add_set(glintL_request *request, const char *name, const char *text);

/// Reads the command line; the options point into argv. False: `message` says what is wrong.
bool cli_read_options(int argc, char **argv, cli_options *options, char message[GLINTL_MESSAGE_SIZE]);
void cli_free_options(cli_options *options);
/// The command of that name; NULL: none, and *near is the nearest name, or NULL.
const cli_command_name *cli_find_command(const char *word, const char **near);

// ---- dialect.c ----

extern const char *const cli_dialect_options[CLI_DIALECT_OPTIONS]; ///< their names after "gr-"
bool cli_check_dialect(const cli_options *options, char message[GLINTL_MESSAGE_SIZE]);
/// Has `require` find the modules that the command carries.
void cli_carry_dialect(lua_State *L);
/// Loads the dialect, if any, sets its global and passes the options on. May raise; empties the stack.
void cli_open_dialect(lua_State *L, const cli_options *options);

// ---- file_list.c ----

typedef struct cli_file_list {
    char **files; ///< owned
    int64_t *numbers; ///< owned; of the frames: the number before each file's ending; -1: there is none
    size_t count;
} cli_file_list;

/// The files that the command's words name: themselves, or, of one word with a place for a number, the selected files
/// that fit it. False: frames are missing, there are none, or options->output is one of them; the message names them. To
/// be freed also on failure.
bool cli_list_files(const cli_options *options, const glintL_selection *selection, cli_file_list *out,
                    char message[GLINTL_MESSAGE_SIZE]);
void cli_free_list(cli_file_list *list);

// ---- sweep_points.c ----

/// "name=a:b:n", "name=a:b:*n" or "name=v1,v2"; the name stays in `text`. To be freed also on failure.
bool cli_read_sweep(char *text, cli_sweep *sweep, char message[GLINTL_MESSAGE_SIZE]);
int64_t cli_sweep_points(const cli_options *options); ///< the product of the counts; 0: there is no --sweep
/// Gives the swept parameters their values at a point, 1 ..: the first --sweep changes fastest.
void cli_sweep_to(cli_options *options, glintL_run *run, int64_t point);
/// Writes the values of a point, "radius=2 plain=1", as far as there is room.
void cli_spell_point(const cli_options *options, int64_t point, char *out, size_t size);
void cli_free_sweep(cli_sweep *sweep);

// ---- output.c, events.c, progress.c ----

typedef struct cli_progress cli_progress;

typedef struct cli_output {
    FILE *data; ///< where data go: stdout, or under --json what stdout was
    bool json, quiet, color;
    bool data_failed, failure_printed;
    int data_errno;
    cli_progress *progress; ///< NULL: no bar
    glintL_run *run;
    double start_ms;
    int64_t kept_first, kept_last; ///< frames kept in a row and not printed yet; 0: none
} cli_output;

/// Under --json whatever else is printed on stdout, by the script or by programs it starts, goes to stderr.
bool cli_output_open(cli_output *output, const cli_options *options);
/// Flushes; false: something could not be written, and the message was printed. Returns the exit code for it.
int cli_output_close(cli_output *output);
void cli_print_error(cli_output *output, const char *message);
void cli_print_warning(cli_output *output, const char *message);

glintL_reporter cli_reporter(cli_output *output);
void cli_print_rays(FILE *out, const glint_ray_counts *rays); ///< "rays":{...}
/// The error as an event and for people.
void cli_report_error(cli_output *output, int64_t index, int exit_code, const char *message);
void cli_warning_event(cli_output *output, const char *message); ///< under --json
/// Warns when many pixels of the run are above white.
void cli_warn_clipped(glintL_run *run);
/// The end of a run that did all that was requested.
void cli_report_end(cli_output *output);
/// Ends a line of data and flushes it; a reader that has gone ends the run.
void cli_end_line(cli_output *output);

/// NULL when there is no terminal to draw on.
cli_progress *cli_progress_create(bool color);
void cli_progress_destroy(cli_progress *progress);
void cli_progress_update(cli_progress *progress, const glintL_run *run, bool rendering);
/// Shows the current step of a study, the time spent so far, and the expected time of this step and of the rest.
void cli_progress_step(cli_progress *progress, const char *what, double done_ms, double step_ms, double left_ms);
/// A film is being made, `done` of `count` frames are in it; NULL: it is made, frames are counted again.
void cli_progress_film(cli_progress *progress, const char *film, size_t done, size_t count);
/// Names the renderer whose progress the bar shows. It must live until the bar is gone or another renderer is named.
void cli_progress_watch(cli_progress *progress, glint_renderer *renderer);
/// Wipes the bar, so that a line can be printed; it comes back with the next update.
void cli_progress_clear(cli_progress *progress);

// ---- script.c ----

typedef struct cli_lua_memory { ///< of one Lua state
    size_t used, most; ///< bytes
} cli_lua_memory;

typedef struct cli_script {
    lua_State *state;
    int64_t frames; ///< of the jobs it returned
    bool has_jobs;
    int jobs; ///< reference to the list of jobs, when the run's mode is GLINTL_MODE_WATCH
    cli_lua_memory memory; ///< of an untrusted script
} cli_script;

/// Runs the script and renders what it returns. Returns false when the run failed or was interrupted.
bool cli_run_script(cli_script *script, const cli_options *options, glintL_run *run);
/// Runs the selected frames of the jobs that a script run in GLINTL_MODE_WATCH has returned, once more each time.
bool cli_run_jobs(cli_script *script, glintL_run *run);
const char *cli_base_name(const char *path);
void cli_close_script(cli_script *script);
/// The state that a signal stops; NULL: none. signals.c
void cli_set_state(lua_State *L);

// ---- measure.c ----

/// Has the run render every frame, look at it and write none; *request is how it was.
void cli_begin_measuring(const cli_options *options, cli_output *output, glintL_run *run, glintL_request *request);
/// Ends measuring, after a script that ended well if `good`: restores the run, and applies the results. Returns false if the run failed.
bool cli_end_measuring(cli_options *options, cli_output *output, glintL_run *run, const glintL_request *request, bool good);
/// Has the script in `L` print nothing.
void cli_hush_script(lua_State *L);

// ---- describe.c ----

/// The parameters of the script in `L` as a JSON list. May raise.
void cli_print_params(lua_State *L, FILE *out);

// ---- signals.c ----

void cli_catch_signals(glintL_run *run);
/// For a command without a run: a signal removes the drafts and ends the process.
void cli_leave_by_signals(void);
void cli_release_signals(void);

// ---- The sub-commands: each returns the exit code ----

int cli_render(cli_options *options, cli_output *output, glintL_run *run);
/// Writes what is still to be written and gives the last warnings, after a script that ended well when `good`. False: the run
/// has failed.
bool cli_finish_frames(glintL_run *run, bool good);
int cli_explain(cli_options *options, cli_output *output, glintL_run *run);
int cli_describe(cli_options *options, cli_output *output, glintL_run *run);
int cli_cost(cli_options *options, cli_output *output, glintL_run *run);
int cli_watch(cli_options *options, cli_output *output, glintL_run *run);
/// glint publish. publish.c of bindings/publish.
int cli_publish(cli_options *options, cli_output *output, glintL_run *run);
/// Makes what --live adds to a page: a live figure of the script, with all that it needs, as HTML for the caller to free. Runs the script
/// for one frame with the parameters of `request`. NULL: *code and the message say why.
char *cli_live(const cli_options *options, const glintL_request *request, int *code, char message[GLINTL_MESSAGE_SIZE]);
/// glint relight. relight.c of bindings/relight.
int cli_relight(cli_options *options, cli_output *output, glintL_run *run);
int cli_completion(const cli_options *options, cli_output *output); ///< its shell is options->script
int cli_compare(const cli_options *options, cli_output *output);
int cli_sheet(const cli_options *options, cli_output *output);
int cli_assemble(cli_options *options, cli_output *output, glintL_run *run);
int cli_reproduce(cli_options *options, cli_output *output, glintL_run *run);
int cli_new(const cli_options *options, cli_output *output);
int cli_join(const cli_options *options, cli_output *output);
int cli_version(const cli_options *options, cli_output *output);
int cli_help(const cli_options *options, cli_output *output); ///< of a command, or of glint as a whole

#endif
