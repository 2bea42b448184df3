// --untrusted: runs a script that is not trusted in a separate process, which may only compute and write pictures to
// one folder. The process limits (walls.c) enforce this; the reduced Lua of untrusted_lua.c is a second line of
// defence; the parent enforces the time limit.
#include "bindings/command/untrusted.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#ifdef GLINT_HAVE_SECCOMP

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define FILES_LIMIT 4 // limit of all written bytes, in multiples of the limit of one file
#define BLOCK 4096 // disk space that a few bytes take
#define TICK_MS 50.0 // longest time between two checks of the written bytes
#define SHORTEST_TICK_MS 1.0
#define FASTEST 8e6 // bytes per millisecond: upper bound of writing, memory to memory, with several threads
#define GRACE_MS 500 // time from the signal that asks the child to end until SIGKILL

// ---- The folder ----

// Returns the folder for pictures: that of -o, otherwise the working directory. NULL: the command writes nothing, or
// out of memory.
static char *folder_of(const cli_options *options)
{
    const char *output = options->output, *slash = output ? strrchr(output, '/') : NULL;
    if (options->command != CLI_RENDER || (output && strcmp(output, "none") == 0))
        return NULL;
    return slash ? strndup(output, slash == output ? 1 : (size_t)(slash - output)) : strdup(".");
}

// Makes the folder if it is missing. False: the message says why.
static bool make_folder(char *folder, char *message)
{
    for (char *at = folder; at && *at; at++) {
        char next = at[1];
        if (next && next != '/')
            continue;
        at[1] = '\0';
        if (mkdir(folder, 0777) != 0 && errno != EEXIST && access(folder, F_OK) != 0)
            return glintL_complain(message, "--untrusted: %.200s: %s", folder, strerror(errno));
        at[1] = next;
    }
    return true;
}

// ---- The parent: watches the clock and the written bytes, and reports how the child ended ----

typedef enum end_cause { NONE_YET, LATE, TOO_MUCH, BY_SIGNAL } end_cause;

typedef struct watched {
    pid_t process;
    double until_ms; // time of SIGTERM, later of SIGKILL
    end_cause ended_by;
    int number; // BY_SIGNAL: the first signal
    uint64_t most; // limit of all bytes that the child writes
    double tick_ms; // time until the next check of the written bytes
} watched;

// Returns an upper bound for the disk space of the bytes that the child has written: each call to write() may end in a
// new block. 0 if the kernel does not count them.
static uint64_t bytes_written(pid_t child)
{
    char path[40], line[80];
    unsigned long long bytes = 0, calls = 0;
    snprintf(path, sizeof path, "/proc/%ld/io", (long)child);
    FILE *file = fopen(path, "re");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "wchar: %llu", &bytes) != 1)
            (void)sscanf(line, "syscw: %llu", &calls);
    if (file)
        fclose(file);
    return bytes + BLOCK * calls;
}

static uint64_t most_bytes(void)
{
    struct rlimit limit;
    const bool is_lower = getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_max < CLI_UNTRUSTED_FILE;
    return FILES_LIMIT * (is_lower ? limit.rlim_max : CLI_UNTRUSTED_FILE);
}

// Returns whether the child has written too much. The fewer bytes it has left, the sooner the next check.
static bool has_written_too_much(watched *child)
{
    const uint64_t written = bytes_written(child->process);
    const double remaining_ms = written < child->most ? (double)(child->most - written) / FASTEST : 0;
    child->tick_ms = remaining_ms > TICK_MS            ? TICK_MS
                     : remaining_ms > SHORTEST_TICK_MS ? remaining_ms
                                                       : SHORTEST_TICK_MS;
    return written > child->most;
}

// Sends the child a signal to end; at the second call, kills it.
static void end_child(watched *child, end_cause cause, int number)
{
    kill(child->process, child->ended_by ? SIGKILL : number);
    if (child->ended_by)
        return;
    child->ended_by = cause;
    child->number = number;
    child->until_ms = glintL_now_ms() + GRACE_MS;
}

// Waits for the child's end and returns its status. Signals are passed on to the child; a second one kills it.
static int watch_child(watched *child, const sigset_t *signals)
{
    int status;
    for (;;) {
        const double remaining_ms = child->until_ms - glintL_now_ms();
        const double wait_ms = remaining_ms < child->tick_ms ? remaining_ms : child->tick_ms;
        const struct timespec wait = { 0, wait_ms > 0 ? (long)(1e6 * wait_ms) : 0 };
        const int number = sigtimedwait(signals, NULL, &wait);
        if (waitpid(child->process, &status, WNOHANG) == child->process)
            return status;
        if (number > 0 && number != SIGCHLD)
            end_child(child, BY_SIGNAL, number);
        else if (glintL_now_ms() >= child->until_ms)
            end_child(child, LATE, SIGTERM);
        else if (!child->ended_by && has_written_too_much(child))
            end_child(child, TOO_MUCH, SIGKILL); // with a mere signal it would continue to write
    }
}

// Returns the exit code for the child's status.
static int judge(int status, const watched *child, const cli_options *options, cli_output *output, int *signal_number)
{
    char message[GLINTL_MESSAGE_SIZE];
    const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (child->ended_by == LATE || number == SIGXCPU)
        snprintf(message, sizeof message, "--untrusted: the script took longer than %g s", options->untrusted_s);
    else if (child->ended_by == TOO_MUCH)
        snprintf(message, sizeof message, "--untrusted: the script wrote more than %llu bytes; each write counts as "
                                          "4096 bytes more than its length",
                 (unsigned long long)child->most);
    else if (child->ended_by == BY_SIGNAL && number)
        *signal_number = child->number; // whether the child handled the signal or was killed
    else if (number == SIGINT || number == SIGTERM || number == SIGHUP || number == SIGPIPE)
        *signal_number = number;
    else if (number)
        snprintf(message, sizeof message, "--untrusted: the script's process ended by signal %d (%s)", number,
                 strsignal(number));
    else
        return WEXITSTATUS(status);
    if (*signal_number)
        return 128 + *signal_number;
    return cli_report_error(output, 0, GLINTL_EXIT_USAGE, message);
}

// Waits for the child, in the parent. Removes the incomplete files of a killed child.
static int await_child(pid_t process, const sigset_t *signals, const cli_options *options, cli_output *output,
                       int *signal_number)
{
    watched child = { .process = process, .until_ms = glintL_now_ms() + 1e3 * options->untrusted_s };
    child.most = most_bytes();
    child.tick_ms = SHORTEST_TICK_MS;
    const int status = watch_child(&child, signals);
    char *folder = WIFSIGNALED(status) ? folder_of(options) : NULL;
    if (folder)
        glint_drafts_collect(folder);
    free(folder);
    return judge(status, &child, options, output, signal_number);
}

// Enters the sandbox, in the child. False: the message says why.
static bool enter(cli_options *options, const cli_output *output, char *message)
{
    options->request.folder = folder_of(options);
    return make_folder(options->request.folder, message) &&
           cli_untrusted_walls(options, fileno(output->data), message);
}

bool cli_untrusted_begin(cli_options *options, cli_output *output, int *code, int *signal_number)
{
    char message[GLINTL_MESSAGE_SIZE];
    sigset_t signals, before;
    sigemptyset(&signals);
    sigaddset(&signals, SIGCHLD);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGHUP);
    sigprocmask(SIG_BLOCK, &signals, &before);
    fflush(NULL);
    const pid_t parent = getpid(), child = fork();
    *code = GLINTL_EXIT_FAILED;
    if (child > 0)
        *code = await_child(child, &signals, options, output, signal_number);
    else if (child < 0)
        snprintf(message, sizeof message, "--untrusted: fork: %s", strerror(errno));
    sigprocmask(SIG_SETMASK, &before, NULL);
    if (child > 0)
        return false;
    if (child == 0) {
        setpgid(0, 0); // so that Ctrl-C reaches it only through its parent
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        snprintf(message, sizeof message, "--untrusted: the parent process has ended");
        if (getppid() == parent && enter(options, output, message))
            return true;
    }
    cli_report_error(output, 0, *code, message);
    return false;
}

#else

bool cli_untrusted_begin(cli_options *options, cli_output *output, int *code, int *signal_number)
{
    (void)options, (void)signal_number;
    *code = GLINTL_EXIT_USAGE;
    cli_report_error(output, 0, *code, "--untrusted: this glint was built without libseccomp, which --untrusted needs");
    return false;
}

#endif
