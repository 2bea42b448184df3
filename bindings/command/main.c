// The glint command.
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "bindings/command/cli.h"
#include "bindings/run/film.h"
#include "bindings/run/system.h"
#include "bindings/command/untrusted.h"

#define STACK_LEAST ((rlim_t)80 << 10) // bytes for the loader and the libraries
#define STACK_ENOUGH ((rlim_t)1 << 20) // bytes; the deepest recursion that Lua allows takes half

// For a script that calls os.exit, which ends the process inside the run: finished pictures are still written.
static cli_output *open_output;

static void finish_early(void)
{
    cli_output *output = open_output;
    glintL_run *run = output ? output->run : NULL;
    if (!run)
        return;
    open_output = NULL;
    bool good = cli_finish_frames(run, glintL_call_settle(run));
    cli_progress_destroy(output->progress);
    output->progress = NULL;
    if (good && !run->exit_code)
        cli_report_end(output);
    else
        cli_report_error(output, run->failed_index, run->exit_code, run->message);
    int code = run->exit_code;
    int close_code = cli_output_close(output);
    if (code || close_code)
        _exit(code ? code : close_code);
}

// Runs a command that a signal may interrupt. *signal_number is the signal that ended it, or 0.
static int run_scripted(cli_options *options, cli_output *output, int *signal_number)
{
    glintL_run *run = glintL_run_create();
    if (!run)
        return cli_report_error(output, 0, GLINTL_EXIT_FAILED, "out of memory");
    run->is_command = true;
    run->times_stages = options->json && options->command == CLI_RENDER;
    snprintf(run->script, sizeof run->script, "%s", options->script ? glintL_base_name(options->script) : "");
    run->request = options->request; // now owns the memory that it points to
    options->request.sets = NULL;
    options->request.folder = NULL;
    options->request.selection.ranges = NULL;
    run->reporter = cli_reporter(output);
    output->run = run;
    open_output = output;
    atexit(finish_early);
    cli_catch_signals(run);
    int code = (options->help ? cli_describe : cli_command_row(options->command)->run)(options, output, run);
    cli_release_signals();
    *signal_number = run->interrupted;
    open_output = NULL;
    output->run = NULL;
    glintL_run_destroy(run);
    return code;
}

static int dispatch(cli_options *options, cli_output *output, int *signal_number)
{
    const cli_command_name *command = cli_command_row(options->command);
    if (options->version)
        return cli_version(options, output);
    if (options->help && !options->script)
        return cli_help(options, output, NULL);
    if (command->needs == CLI_SIGNALS)
        cli_leave_by_signals();
    if (command->needs != CLI_RUN)
        return command->run(options, output, NULL);
    if (!options->script && command->words != CLI_FILES)
        return cli_report_error(output, 0, GLINTL_EXIT_USAGE,
                                options->command == CLI_REPRODUCE
                                    ? "reproduce: a finished picture and its script expected"
                                    : "a script expected; glint --help lists the commands");
    int code;
    if (options->untrusted_s > 0 && !cli_untrusted_begin(options, output, &code, signal_number))
        return code;
    return run_scripted(options, output, signal_number);
}

static int run_program(int argc, char **argv)
{
    cli_options options;
    cli_output output;
    char message[GLINTL_MESSAGE_SIZE];
    int code = GLINTL_EXIT_USAGE, signal_number = 0;
    glintL_keep_points(); // a script may have called os.setlocale
    bool good = cli_read_options(argc, argv, &options, message);
    if (!cli_output_open(&output, &options))
        return GLINTL_EXIT_FAILED;
    if (good)
        code = dispatch(&options, &output, &signal_number);
    else
        cli_report_error(&output, 0, code, message);
    int close_code = cli_output_close(&output);
    cli_free_options(&options);
    if (signal_number) { // ends by the same signal, so that a shell sees it
        signal(signal_number, SIG_DFL);
        raise(signal_number);
    }
    return code ? code : close_code;
}

// ---- Small stacks ----

typedef struct program {
    int argc;
    char **argv;
    sigset_t mask;
    int code;
} program;

static void *run_in_thread(void *context)
{
    program *p = context;
    pthread_sigmask(SIG_SETMASK, &p->mask, NULL);
    p->code = run_program(p->argc, p->argv);
    return NULL;
}

// Runs the program in a thread with a larger stack, also for the threads that it starts. That thread handles the signals.
static int run_with_stack(program *p)
{
    sigset_t all;
    pthread_attr_t how;
    pthread_t thread;
    sigfillset(&all);
    bool good = pthread_attr_init(&how) == 0 && pthread_attr_setstacksize(&how, STACK_ENOUGH) == 0;
#if defined(__linux__) && defined(_GNU_SOURCE)
    good = good && pthread_setattr_default_np(&how) == 0;
#endif
    pthread_sigmask(SIG_SETMASK, &all, &p->mask);
    if (!good || pthread_create(&thread, &how, run_in_thread, p) != 0 || pthread_join(thread, NULL) != 0) {
        fputs("glint: error: out of memory for a stack\n", stderr);
        return GLINTL_EXIT_FAILED;
    }
    return p->code;
}

int main(int argc, char **argv)
{
    struct rlimit stack;
    if (getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur >= STACK_ENOUGH)
        return run_program(argc, argv);
    if (stack.rlim_cur < STACK_LEAST) {
        fprintf(stderr, "glint: error: the stack is limited to %d KiB; glint needs %d KiB (ulimit -s %d)\n",
                (int)(stack.rlim_cur >> 10), (int)(STACK_LEAST >> 10), (int)(STACK_LEAST >> 10));
        return GLINTL_EXIT_FAILED;
    }
    program p = { .argc = argc, .argv = argv };
    return run_with_stack(&p);
}
