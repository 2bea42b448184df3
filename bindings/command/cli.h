/// The `glint` command: its command line, its output, and its sub-commands. Private to bindings/.
///
/// stdout is for data, stderr is for people. The functions here print to the streams of a cli_output.
#ifndef GLINT_CLI_H
#define GLINT_CLI_H

#include <stdio.h>

#include "bindings/run/carried.h"
#include "bindings/run/run.h"
#include "engine/glint_files.h"
#include "engine/glint_inspect.h"

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
    CLI_RELIGHT = 16384,
    CLI_DUMP = 32768
} cli_command;

typedef enum cli_words { ///< words that follow a command's name
    CLI_SCRIPT,
    CLI_FILES, ///< any number; the command counts them
    CLI_FILE_SCRIPT
} cli_words;

typedef enum cli_needs { ///< requirements of a command
    CLI_NOTHING,
    CLI_SIGNALS, ///< a signal removes the drafts and ends the process
    CLI_RUN
} cli_needs;

typedef struct cli_options cli_options;
typedef struct cli_output cli_output;

typedef struct cli_command_name {
    const char *name;
    cli_command command;
    cli_words words;
    cli_needs needs;
    int (*run)(cli_options *options, cli_output *output, glintL_run *run); ///< returns the exit code
    const char *synopsis; ///< the arguments on the command line
    const char *help; ///< one line for people
} cli_command_name;
#define CLI_COMMAND_COUNT 16
extern const cli_command_name cli_command_list[CLI_COMMAND_COUNT];
const cli_command_name *cli_command_row(cli_command command); ///< returns the row of a command

typedef struct cli_sweep { ///< --sweep
    const char *name;
    int64_t count;
    const char **values; ///< owned: `count` texts, which point into `texts`
    char *texts; ///< owned
} cli_sweep;

#define CLI_DIALECT_OPTIONS 6 ///< number of options such as --gr-order

struct cli_options {
    cli_command command;
    bool has_command; ///< a command's name was given
    bool json, quiet, help, version, verbose;
    const char *program; ///< the name by which glint was started
    const char *script; ///< NULL: not given
    char **arguments; ///< file names, for a command that takes files; otherwise the script's arguments after `--`
    int argument_count;
    const char **lights; ///< for relight, owned: NAME=VALUE for each light
    size_t light_count;
    const char *file; ///< the file that reproduce compares
    const char *output; ///< the text of -o; NULL: not given
    const char *label, *names, *format, *title, *colorbar; ///< for sheet; `title` also for publish; NULL: not given
    const char *controls; ///< parameters that publish shows; NULL: all
    bool shows_source; ///< publish shows the script's source
    bool is_live; ///< --live
    const char *live_script; ///< script of --live; NULL: the script itself
    int64_t columns, difference; ///< for sheet; 0: not given
    double gain, label_size; ///< for sheet; 0: not given
    bool transparent; ///< the background of sheet is transparent
    int64_t frame; ///< number of the frame that explain describes
    double fail, warn, tolerance; ///< limits for compare; negative: not given
    cli_sweep *sweeps;
    size_t sweep_count;
    glintL_request request; ///< the run takes it over
    bool quick; ///< cost runs each setting fewer times
    bool programs; ///< explain lists the instructions of programs
    double budget_s; ///< time budget of cost; 0: none
    const char *report, *knobs; ///< for cost; NULL: no report, all knobs
    char width[16], height[16]; ///< the two numbers of --size
    bool finds_exposure; ///< --exposure auto
    bool finds_range; ///< --colormap MAP:auto
    char exposure[16], colormap[64]; ///< texts of the values that these options found
    int64_t start, end, jump; ///< -s -e -j; 0: not given
    bool has_frames;
    int http_port; ///< port of watch; 0: any free port, -1: no page
    const char *terminal; ///< graphics protocol for watch; NULL: query the terminal
    double untrusted_s; ///< time limit of an untrusted script; 0: the script is trusted
    const char *dialect; ///< dialect of the script; NULL: glint's own
    const char *dialect_text[CLI_DIALECT_OPTIONS]; ///< texts of --gr-order and so on; NULL: not given
};

#define CLI_SUGGEST_FILES "/" ///< completions: file names
#define CLI_SUGGEST_PASSES "," ///< completions: names of passes

/// One option. Its row has all of its texts, except for the paragraph of the manual page.
typedef struct cli_option cli_option;
struct cli_option {
    const char *name;
    char letter; ///< 0: none
    /// The placeholder of the option's value in --help: "LIST"; "show|error|none": one of these words; "": the
    /// choices of the field of scene:render{}; "[PORT]": an optional number, without which `text` is NULL; NULL: the
    /// option takes no value.
    const char *value;
    unsigned commands; ///< the commands that accept the option
    /// Reads the option's text, and may change it. Returns false when the text is wrong, and writes the reason to
    /// `message`.
    bool (*read)(cli_options *options, const cli_option *option, char *text, char *message);
    const char *help; ///< one line for people
    size_t at; ///< offset of the member of cli_options, for readers of plain values
    double min, max; ///< range of a number
    const char *expected; ///< a number's range in messages
    const char *suggest; ///< completions if `value` has none: words separated by spaces, or CLI_SUGGEST_...
    bool repeats; ///< the option may be given several times
    const char *group; ///< heading in --help for this option and those after it
};
#define CLI_OPTION_COUNT 80
extern const cli_option cli_option_list[CLI_OPTION_COUNT];
bool cli_option_may_lack(const cli_option *option); ///< returns whether the option's value is optional
/// Pushes a table of the options that were given and whose values are flags, texts or numbers.
void cli_push_options(lua_State *L, const cli_options *options);
/// Adds a --set. False: out of memory.
bool cli_add_set(glintL_request *request, const char *name, const char *text);

/// Reads the command line. The options point into argv. False: `message` says what is wrong.
bool cli_read_options(int argc, char **argv, cli_options *options, char message[GLINTL_MESSAGE_SIZE]);
void cli_free_options(cli_options *options);
/// Returns the command with this name. NULL: there is none, and *near is the nearest name, or NULL.
const cli_command_name *cli_find_command(const char *word, const char **near);

// ---- dialect.c ----

extern const char *const cli_dialect_options[CLI_DIALECT_OPTIONS]; ///< without the prefix "gr-"
bool cli_check_dialect(const cli_options *options, char message[GLINTL_MESSAGE_SIZE]);
/// Makes the modules that the command carries available to `require`.
void cli_carry_dialect(lua_State *L);
/// Loads the dialect, if any, sets its global and passes the options on. May raise. Empties the stack.
void cli_open_dialect(lua_State *L, const cli_options *options);

// ---- sweep_points.c ----

/// Reads "name=a:b:n", "name=a:b:*n" or "name=v1,v2". The name stays in `text`. The caller frees the sweep, on failure
/// too.
bool cli_read_sweep(char *text, cli_sweep *sweep, char message[GLINTL_MESSAGE_SIZE]);
int64_t cli_sweep_points(const cli_options *options); ///< returns the product of the axes' counts; 0: no --sweep
/// Sets the swept parameters to their values at a point, 1 ..; the first --sweep changes fastest.
void cli_sweep_to(cli_options *options, glintL_run *run, int64_t point);
/// Writes the values of a point, "radius=2 plain=1", cut to fit.
void cli_spell_point(const cli_options *options, int64_t point, char *out, size_t size);
void cli_free_sweep(cli_sweep *sweep);

// ---- output.c, events.c, progress.c ----

typedef struct cli_progress cli_progress;

struct cli_output {
    FILE *data; ///< stdout, or with --json a copy of the original stdout
    bool json, quiet, color;
    bool data_failed, failure_printed;
    int data_errno;
    cli_progress *progress; ///< NULL: no bar
    glintL_run *run;
    double start_ms;
    int64_t kept_first, kept_last; ///< a range of kept frames not printed yet; 0: none
};

/// Opens the output. With --json everything else written to stdout, by the script or its child processes, goes to
/// stderr.
bool cli_output_open(cli_output *output, const cli_options *options);
/// Flushes the output and returns the exit code. If something could not be written, prints a message and returns its
/// exit code.
int cli_output_close(cli_output *output);
void cli_print_error(cli_output *output, const char *message);
void cli_print_warning(cli_output *output, const char *message);

glintL_reporter cli_reporter(cli_output *output);
void cli_print_rays(FILE *out, const glint_ray_counts *rays); ///< prints "rays":{...}
/// Reports the error as an event and for people. Returns the exit code.
int cli_report_error(cli_output *output, int64_t index, int exit_code, const char *message);
void cli_warning_event(cli_output *output, const char *message); ///< only with --json
/// Warns when many pixels of the run are above white.
void cli_warn_clipped(glintL_run *run);
/// Reports the end of a run that did everything requested.
void cli_report_end(cli_output *output);
/// Ends a line of data and flushes it. If the reader has gone, the run ends.
void cli_end_line(cli_output *output);

/// Returns NULL when there is no terminal to draw on.
cli_progress *cli_progress_create(bool color);
void cli_progress_destroy(cli_progress *progress);
void cli_progress_update(cli_progress *progress, const glintL_run *run, bool rendering);
/// Shows that the current frame has been rendered with so many samples, and its error.
void cli_progress_samples(cli_progress *progress, const glintL_step *step);
/// Shows the current step of a study, the time spent so far, and the expected time of this step and of the rest.
void cli_progress_step(cli_progress *progress, const char *what, double done_ms, double step_ms, double remaining_ms);
/// Shows that a film is being made and has `done` of `count` frames. NULL: the film is finished, and the bar counts
/// frames again.
void cli_progress_film(cli_progress *progress, const char *film, size_t done, size_t count);
/// Sets the renderer whose progress the bar shows. It must live until the bar is gone or another renderer is set.
void cli_progress_watch(cli_progress *progress, glint_renderer *renderer);
/// Erases the bar so that a line can be printed. The next update draws it again.
void cli_progress_clear(cli_progress *progress);

// ---- script.c ----

typedef struct cli_lua_memory { ///< memory of one Lua state
    size_t used, most; ///< bytes
} cli_lua_memory;

typedef struct cli_script {
    lua_State *state;
    int64_t frames; ///< number of frames of the jobs that the script returned
    bool has_jobs;
    int jobs; ///< reference to the list of jobs, in the mode GLINTL_MODE_WATCH
    cli_lua_memory memory; ///< memory of an untrusted script
} cli_script;

/// Runs the script and renders what it returns. Returns false when the run failed or was interrupted.
bool cli_run_script(cli_script *script, const cli_options *options, glintL_run *run);
/// Runs the selected frames of the jobs that a script returned in GLINTL_MODE_WATCH. May be called repeatedly.
bool cli_run_jobs(cli_script *script, glintL_run *run);
void cli_close_script(cli_script *script);
/// Sets the state that a signal stops; NULL: none. signals.c
void cli_set_state(lua_State *L);

// ---- measure.c ----

/// Makes the run render and measure every frame but write none. *request receives the original request.
void cli_begin_measuring(const cli_options *options, cli_output *output, glintL_run *run, glintL_request *request);
/// Ends measuring: restores the run and applies the results. good: the script ended well. Returns false if the run
/// failed.
bool cli_end_measuring(cli_options *options, cli_output *output, glintL_run *run, const glintL_request *request, bool good);
/// Stops the script in `L` from printing anything.
void cli_hush_script(lua_State *L);

// ---- describe.c ----

/// Prints the parameters of the script in `L` as a JSON list. May raise.
void cli_print_params(lua_State *L, FILE *out);

// ---- module.c ----

/// A command whose logic is in Lua modules.
typedef struct cli_task {
    const char *name; ///< name of the command, at the start of messages; NULL: messages have no name
    const cli_options *options;
    cli_output *output;
    glintL_run *run; ///< NULL: the command needs none
    const luaL_Reg *functions; ///< C functions for the modules; upvalue 1 is the task
    void *own; ///< data of these functions
    int code; ///< the exit code
} cli_task;

/// Runs the modules and calls the function `run`, which returns the exit code or nothing. Its argument is a table: the
/// functions of the task, of files.c and of module.c, the options (see cli_push_options), `script`, `file` and the list
/// `arguments`. Returns the exit code.
int cli_run_module(cli_task *task, const glintL_carried *modules, size_t count);
int cli_read_number(lua_State *L); ///< number(text): returns the number that the text is; nothing if it is none
cli_task *cli_task_of(lua_State *L); ///< for C functions of a task
/// Reports the failure, or the signal that stopped the run, and raises nil.
int cli_task_fail(lua_State *L, int code, const char *message);

// ---- files.c ----

extern const glintL_carried cli_files_module; ///< lists the files that the command's words name
extern const luaL_Reg cli_files_functions[];
/// Pushes the list of file names at `index` as an array, which is valid as long as the list and the array.
char **cli_push_files(lua_State *L, int index, size_t *count);
/// Pushes a picture read from a file, which the Lua value owns. NULL: `error` gives the reason.
glint_picture *cli_push_picture(lua_State *L, const char *path, bool has_pixels, glint_error *error);
int cli_picture_text(lua_State *L); ///< text(picture, keyword): returns a text entry of a picture, or nil

// ---- signals.c ----

void cli_catch_signals(glintL_run *run);
/// Sets whether system calls continue after a signal, so that a line of data is written whole. Initially they do not.
void cli_restart_calls(bool restarts);
/// For a command without a run: after this a signal removes the drafts and ends the process.
void cli_leave_by_signals(void);
void cli_release_signals(void);

// ---- The sub-commands: each returns the exit code. `run` is NULL unless the command needs a run ----

int cli_render(cli_options *options, cli_output *output, glintL_run *run);
/// Writes the remaining frames and gives the last warnings. good: the script ended well. False: the run has failed.
bool cli_finish_frames(glintL_run *run, bool good);
int cli_explain(cli_options *options, cli_output *output, glintL_run *run);
int cli_dump(cli_options *options, cli_output *output, glintL_run *run);
int cli_describe(cli_options *options, cli_output *output, glintL_run *run);
int cli_cost(cli_options *options, cli_output *output, glintL_run *run);
int cli_watch(cli_options *options, cli_output *output, glintL_run *run);
/// glint publish. publish.c of bindings/publish.
int cli_publish(cli_options *options, cli_output *output, glintL_run *run);
/// Returns the HTML of a live figure of the script, which --live adds to a page; the caller frees it. Runs the script
/// for one frame with the parameters of `request`. NULL: *code and the message give the reason.
char *cli_live(const cli_options *options, const glintL_request *request, int *code, char message[GLINTL_MESSAGE_SIZE]);
/// glint relight. relight.c of bindings/relight.
int cli_relight(cli_options *options, cli_output *output, glintL_run *run);
int cli_completion(cli_options *options, cli_output *output, glintL_run *run); ///< options->script names the shell
int cli_compare(cli_options *options, cli_output *output, glintL_run *run);
int cli_sheet(cli_options *options, cli_output *output, glintL_run *run);
int cli_assemble(cli_options *options, cli_output *output, glintL_run *run);
int cli_reproduce(cli_options *options, cli_output *output, glintL_run *run);
int cli_new(cli_options *options, cli_output *output, glintL_run *run);
int cli_join(cli_options *options, cli_output *output, glintL_run *run);
int cli_version(const cli_options *options, cli_output *output);
int cli_help(cli_options *options, cli_output *output, glintL_run *run); ///< prints the help for a command or for glint

#endif
