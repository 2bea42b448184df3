// --untrusted: a script that is not trusted runs in a process of its own, which may compute, and write pictures into one
// folder. The process is the wall (rlimits, Landlock, seccomp); the small Lua of untrusted_lua.c is comfort behind it.
#include "bindings/command/untrusted.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#ifdef GLINT_HAVE_SECCOMP

#include <fcntl.h>
#include <linux/landlock.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#pragma GCC diagnostic ignored "-Wmissing-field-initializers" // SCMP_A0 and the like leave fields out, says clang

#define MEMORY_LIMIT ((rlim_t)4 << 30) // of the process
#define FILE_LIMIT ((rlim_t)1 << 30) // of one file
#define OPEN_FILES_LIMIT 64
#define GRACE_S 2 // between the end of the time and the kill

// ---- The child: walls, from the inside ----

static bool fail(char *message, const char *what, const char *path)
{
    snprintf(message, GLINTL_MESSAGE_SIZE, "--untrusted: %s%.200s: %s", what, path, strerror(errno));
    return false;
}

static bool set_limit(int what, rlim_t most)
{
    struct rlimit limit = { most, most }, now;
    if (getrlimit(what, &now) == 0 && now.rlim_max < most)
        limit.rlim_cur = limit.rlim_max = now.rlim_max;
    return setrlimit(what, &limit) == 0;
}

static bool set_limits(double seconds, char *message)
{
    const rlim_t cpus = (rlim_t)sysconf(_SC_NPROCESSORS_ONLN);
    bool good = set_limit(RLIMIT_CPU, ((rlim_t)seconds + GRACE_S + 1) * cpus) && set_limit(RLIMIT_FSIZE, FILE_LIMIT) &&
                set_limit(RLIMIT_NOFILE, OPEN_FILES_LIMIT) && set_limit(RLIMIT_CORE, 0);
#ifndef __SANITIZE_ADDRESS__ // which maps terabytes
    good = good && set_limit(RLIMIT_AS, MEMORY_LIMIT);
#endif
    return good || fail(message, "the limits of the process", "");
}

static bool allow_beneath(int rules, const char *path, uint64_t access, char *message)
{
    struct landlock_path_beneath_attr beneath = { .allowed_access = access };
    beneath.parent_fd = open(path, O_PATH | O_CLOEXEC);
    if (beneath.parent_fd < 0)
        return fail(message, "", path);
    long failed = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &beneath, 0);
    if (failed)
        fail(message, "", path);
    close(beneath.parent_fd);
    return !failed;
}

// No file may be opened but the script, for reading, and those in the folder of the pictures.
static bool close_files(const char *script, const char *folder, char *message)
{
    const uint64_t in_folder = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE |
                               LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_REMOVE_FILE;
    struct landlock_ruleset_attr handled = { 0 };
    handled.handled_access_fs = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1; // all that the first version knows
    const size_t first_version = sizeof handled.handled_access_fs;
    int rules = (int)syscall(SYS_landlock_create_ruleset, &handled, first_version, 0);
    if (rules < 0)
        return fail(message, "Landlock, which keeps it to one folder", "");
    bool good = allow_beneath(rules, script, LANDLOCK_ACCESS_FS_READ_FILE, message) &&
                (!folder || allow_beneath(rules, folder, in_folder, message));
    if (good && syscall(SYS_landlock_restrict_self, rules, 0))
        good = fail(message, "Landlock", "");
    close(rules);
    return good;
}

// The calls that rendering into files takes. Any other fails as if the caller were not allowed to.
static bool close_calls(char *message)
{
    static const int allowed[] = {
        SCMP_SYS(access),
        SCMP_SYS(arch_prctl),
        SCMP_SYS(brk),
        SCMP_SYS(clock_getres),
        SCMP_SYS(clock_gettime),
        SCMP_SYS(clock_nanosleep),
        SCMP_SYS(close),
        SCMP_SYS(dup),
        SCMP_SYS(exit),
        SCMP_SYS(exit_group),
        SCMP_SYS(faccessat),
        SCMP_SYS(faccessat2),
        SCMP_SYS(fcntl),
        SCMP_SYS(fdatasync),
        SCMP_SYS(fstat),
        SCMP_SYS(fsync),
        SCMP_SYS(ftruncate),
        SCMP_SYS(futex),
        SCMP_SYS(getcwd),
        SCMP_SYS(getpid),
        SCMP_SYS(getrandom),
        SCMP_SYS(getrlimit),
        SCMP_SYS(getrusage),
        SCMP_SYS(gettid),
        SCMP_SYS(gettimeofday),
        SCMP_SYS(lseek),
        SCMP_SYS(lstat),
        SCMP_SYS(madvise),
        SCMP_SYS(membarrier),
        SCMP_SYS(mmap),
        SCMP_SYS(mprotect),
        SCMP_SYS(mremap),
        SCMP_SYS(munmap),
        SCMP_SYS(nanosleep),
        SCMP_SYS(newfstatat),
        SCMP_SYS(open),
        SCMP_SYS(openat),
        SCMP_SYS(poll),
        SCMP_SYS(ppoll),
        SCMP_SYS(pread64),
        SCMP_SYS(pwrite64),
        SCMP_SYS(read),
        SCMP_SYS(readlink),
        SCMP_SYS(readlinkat),
        SCMP_SYS(readv),
        SCMP_SYS(rename),
        SCMP_SYS(renameat),
        SCMP_SYS(renameat2),
        SCMP_SYS(restart_syscall),
        SCMP_SYS(rseq),
        SCMP_SYS(rt_sigaction),
        SCMP_SYS(rt_sigprocmask),
        SCMP_SYS(rt_sigreturn),
        SCMP_SYS(sched_getaffinity),
        SCMP_SYS(sched_yield),
        SCMP_SYS(set_robust_list),
        SCMP_SYS(set_tid_address),
        SCMP_SYS(sigaltstack),
        SCMP_SYS(stat),
        SCMP_SYS(statx),
        SCMP_SYS(sysinfo),
        SCMP_SYS(time),
        SCMP_SYS(uname),
        SCMP_SYS(unlink),
        SCMP_SYS(unlinkat),
        SCMP_SYS(write),
        SCMP_SYS(writev),
    };
    const uint64_t thread = CLONE_VM | CLONE_FS | CLONE_FILES | CLONE_SIGHAND | CLONE_THREAD;
    int code = -ENOMEM;
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
    if (filter) {
        code = 0;
        for (size_t i = 0; i < sizeof allowed / sizeof *allowed && !code; i++)
            if (allowed[i] >= 0) // this machine has it
                code = seccomp_rule_add(filter, SCMP_ACT_ALLOW, allowed[i], 0);
        if (!code) // threads and no processes; glibc falls back from clone3, whose flags a filter cannot see
            code = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(clone), 1,
                                    SCMP_A0(SCMP_CMP_MASKED_EQ, thread, thread));
        if (!code)
            code = seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
        if (!code) // signals to itself: it ends by the one that ended it
            code =
                seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 1, SCMP_A0(SCMP_CMP_EQ, (uint64_t)getpid()));
        if (!code) // queries of a terminal
            code = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(ioctl), 1, SCMP_A1(SCMP_CMP_EQ, TCGETS));
        if (!code)
            code = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(ioctl), 1, SCMP_A1(SCMP_CMP_EQ, TIOCGWINSZ));
        if (!code) // its own limits alone
            code = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(prlimit64), 2, SCMP_A0(SCMP_CMP_EQ, 0),
                                    SCMP_A2(SCMP_CMP_EQ, 0));
        if (!code)
            code = seccomp_load(filter);
        seccomp_release(filter);
    }
    errno = -code;
    return !code || fail(message, "seccomp", "");
}

// The folder that pictures go into, made when it is missing: that of -o, else the working directory. NULL: nothing is
// written, or the message is.
static char *make_folder(const cli_options *options, char *message)
{
    const char *output = options->output, *slash = output ? strrchr(output, '/') : NULL;
    if (options->command != CLI_RENDER || (output && strcmp(output, "none") == 0))
        return NULL;
    char *folder = slash ? strndup(output, slash == output ? 1 : (size_t)(slash - output)) : strdup(".");
    for (char *at = folder; at && *at; at++) {
        char next = at[1];
        if (next && next != '/')
            continue;
        at[1] = '\0';
        if (mkdir(folder, 0777) != 0 && errno != EEXIST && access(folder, F_OK) != 0) {
            fail(message, "", folder);
            free(folder);
            return NULL;
        }
        at[1] = next;
    }
    if (!folder)
        fail(message, "", "");
    return folder;
}

static bool build_walls(cli_options *options, char *message)
{
    message[0] = '\0';
    options->request.folder = make_folder(options, message);
    return !*message && set_limits(options->untrusted_s, message) &&
           (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 || fail(message, "no_new_privs", "")) &&
           close_files(options->script, options->request.folder, message) && close_calls(message);
}

// ---- The parent: the clock, and what became of the child ----

// Waits for the child until the time is over, then ends it. Signals go on to the child, and a second one kills it.
static int watch_child(pid_t child, const sigset_t *signals, double seconds, bool *is_late)
{
    const double end_ms = glintL_now_ms() + 1e3 * seconds;
    int status, told = 0;
    *is_late = false;
    for (;;) {
        double left_ms = end_ms + (*is_late ? 1e3 * GRACE_S : 0) - glintL_now_ms();
        left_ms = left_ms > 0 ? left_ms : 0;
        struct timespec left = { (time_t)(left_ms / 1e3), 0 };
        left.tv_nsec = (long)((left_ms - 1e3 * (double)left.tv_sec) * 1e6);
        int number = sigtimedwait(signals, NULL, &left);
        if (waitpid(child, &status, WNOHANG) == child)
            return status;
        if (number < 0 && errno == EAGAIN) {
            kill(child, *is_late ? SIGKILL : SIGTERM);
            *is_late = true;
        } else if (number > 0 && number != SIGCHLD) {
            kill(child, told++ ? SIGKILL : number);
        }
    }
}

// The exit code that the child's end means to the caller.
static int judge(int status, bool is_late, const cli_options *options, cli_output *output, int *signal_number)
{
    char message[GLINTL_MESSAGE_SIZE];
    const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (is_late || number == SIGXCPU)
        snprintf(message, sizeof message, "--untrusted: the script took longer than %g s", options->untrusted_s);
    else if (number == SIGINT || number == SIGTERM || number == SIGHUP || number == SIGPIPE)
        *signal_number = number;
    else if (number)
        snprintf(message, sizeof message, "--untrusted: the script's process ended by signal %d (%s)", number,
                 strsignal(number));
    else
        return WEXITSTATUS(status);
    if (*signal_number)
        return 128 + number;
    cli_report_error(output, 0, GLINTL_EXIT_USAGE, message);
    return GLINTL_EXIT_USAGE;
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
    if (child != 0) {
        bool is_late;
        *code = GLINTL_EXIT_FAILED;
        if (child > 0) {
            int status = watch_child(child, &signals, options->untrusted_s, &is_late);
            *code = judge(status, is_late, options, output, signal_number);
        } else {
            fail(message, "fork", "");
            cli_report_error(output, 0, *code, message);
        }
        sigprocmask(SIG_SETMASK, &before, NULL);
        return false;
    }
    sigprocmask(SIG_SETMASK, &before, NULL);
    setpgid(0, 0); // Ctrl-C reaches it through its parent alone
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() == parent && build_walls(options, message))
        return true;
    *code = GLINTL_EXIT_FAILED;
    cli_report_error(output, 0, *code, message);
    return false;
}

#else

bool cli_untrusted_begin(cli_options *options, cli_output *output, int *code, int *signal_number)
{
    (void)options, (void)signal_number;
    *code = GLINTL_EXIT_USAGE;
    cli_report_error(output, 0, *code, "--untrusted: this glint was built without libseccomp, which it needs");
    return false;
}

#endif
