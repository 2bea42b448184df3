// The sandbox of an untrusted script's process, set up from the inside: process limits, Landlock for files, seccomp for
// system calls. A table in ../README.md says what each of them stops.
#include "bindings/command/untrusted.h"

#ifdef GLINT_HAVE_SECCOMP

#include <errno.h>
#include <fcntl.h>
#include <linux/landlock.h>
#include <malloc.h>
#include <sched.h>
#include <seccomp.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <termios.h>
#include <unistd.h>

#pragma GCC diagnostic ignored "-Wmissing-field-initializers" // SCMP_A0 and similar macros omit fields

#define MEMORY_LIMIT ((rlim_t)4 << 30) // limit of the address space of the process
#define ARENAS 4 // malloc reserves 64 MiB of addresses for each
#define WRITE_LIMIT ((uint64_t)64 << 20) // bytes of one write call; the parent sees them only when the call has ended
#define OPEN_FILES_LIMIT 64
#define CPU_SLACK_S 2 // processor time beyond the parent's time limit, which ends the child first

static bool fail(char *message, const char *name)
{
    snprintf(message, GLINTL_MESSAGE_SIZE, "--untrusted: %.200s: %s", name, strerror(errno));
    return false;
}

// ---- Limits ----

static bool set_limit(int name, rlim_t most)
{
    struct rlimit limit = { most, most }, now;
    if (getrlimit(name, &now) == 0 && now.rlim_max < most)
        limit.rlim_cur = limit.rlim_max = now.rlim_max;
    return setrlimit(name, &limit) == 0;
}

static bool set_limits(double seconds, char *message)
{
    const rlim_t cpus = (rlim_t)sysconf(_SC_NPROCESSORS_ONLN);
    bool good = set_limit(RLIMIT_CPU, ((rlim_t)seconds + CPU_SLACK_S) * cpus) &&
                set_limit(RLIMIT_FSIZE, CLI_UNTRUSTED_FILE) && set_limit(RLIMIT_NOFILE, OPEN_FILES_LIMIT) &&
                set_limit(RLIMIT_CORE, 0);
#ifndef __SANITIZE_ADDRESS__ // the address sanitizer maps terabytes
    good = good && set_limit(RLIMIT_AS, MEMORY_LIMIT);
#endif
#ifdef M_MMAP_THRESHOLD
    mallopt(M_MMAP_THRESHOLD, 128 << 10); // so that a large block grows by remapping instead of copying
    mallopt(M_ARENA_MAX, ARENAS);
#endif
    return good || fail(message, "setting the limits of the process");
}

// ---- Descriptors ----

static bool close_range_of(unsigned from, unsigned to)
{
#ifdef SYS_close_range
    if (from > to || syscall(SYS_close_range, from, to, 0) == 0)
        return true;
#endif
    const long most = sysconf(_SC_OPEN_MAX);
    for (unsigned fd = from; fd <= to && (long)fd < most; fd++)
        close((int)fd);
    return true;
}

// Closes all inherited descriptors except stdout, stderr and `data`. stdin becomes empty.
static bool close_descriptors(int data, char *message)
{
    const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (nothing < 0 || dup2(nothing, STDIN_FILENO) < 0)
        return fail(message, "/dev/null");
    if (data <= STDERR_FILENO)
        return close_range_of(3, ~0u);
    return close_range_of(3, (unsigned)data - 1) && close_range_of((unsigned)data + 1, ~0u);
}

// ---- Files ----

// struct landlock_ruleset_attr up to version 6, for headers older than the kernel.
typedef struct rights {
    uint64_t files, network, scopes;
} rights;

// Returns all rights that the kernel's Landlock can restrict. *size: the size of the structure that it knows.
static rights all_rights(long version, size_t *size)
{
    static const int file_rights[] = { 13, 14, 15, 15 }; // number of rights in versions 1 .. 4; version 5 adds ioctl of devices
    rights all = { .files = (UINT64_C(1) << (version < 5 ? file_rights[version - 1] : 16)) - 1 };
    all.network = version >= 4 ? 3 : 0; // TCP bind and connect
    all.scopes = version >= 6 ? 3 : 0; // abstract sockets, and signals to other processes
    *size = version >= 6 ? sizeof all : version >= 4 ? 2 * sizeof all.files : sizeof all.files;
    return all;
}

static bool allow_beneath(int rules, const char *path, uint64_t access, char *message)
{
    struct landlock_path_beneath_attr beneath = { .allowed_access = access };
    beneath.parent_fd = open(path, O_PATH | O_CLOEXEC);
    if (beneath.parent_fd < 0)
        return fail(message, path);
    long failed = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &beneath, 0);
    if (failed)
        fail(message, path);
    close(beneath.parent_fd);
    return !failed;
}

// Allows opening only the script, for reading, and files in the folder of the pictures.
static bool close_files(const char *script, const char *folder, char *message)
{
    const uint64_t in_folder = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE |
                               LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_REMOVE_FILE;
    size_t size;
    const long version = syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION);
    const rights handled = all_rights(version > 0 ? version : 1, &size);
    int rules = (int)syscall(SYS_landlock_create_ruleset, &handled, size, 0);
    if (rules < 0)
        return fail(message, "Landlock, which restricts the script to one folder");
    bool good = allow_beneath(rules, script, LANDLOCK_ACCESS_FS_READ_FILE, message) &&
                (!folder || allow_beneath(rules, folder, in_folder, message));
    if (good && syscall(SYS_landlock_restrict_self, rules, 0))
        good = fail(message, "Landlock");
    close(rules);
    return good;
}

// ---- Calls ----

// The system calls needed to render into files. Any other fails with a permission error.
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
    SCMP_SYS(fdatasync),
    SCMP_SYS(flock),
    SCMP_SYS(fstat),
    SCMP_SYS(fsync),
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
};

#define THREAD (CLONE_VM | CLONE_FS | CLONE_FILES | CLONE_SIGHAND | CLONE_THREAD)

// Returns 0 or a negative errno.
static int add_rules(scmp_filter_ctx filter, int data)
{
    int code = 0;
    for (size_t i = 0; i < sizeof allowed / sizeof *allowed && !code; i++)
        if (allowed[i] >= 0) // calls that this machine has
            code = seccomp_rule_add(filter, SCMP_ACT_ALLOW, allowed[i], 0);
    const struct scmp_arg_cmp thread = SCMP_A0(SCMP_CMP_MASKED_EQ, THREAD, THREAD), own = SCMP_A0(SCMP_CMP_EQ, 0),
                              self = SCMP_A0(SCMP_CMP_EQ, (uint64_t)getpid()), no_new = SCMP_A2(SCMP_CMP_EQ, 0),
                              flags = SCMP_A1(SCMP_CMP_EQ, F_GETFL), terminal = SCMP_A1(SCMP_CMP_EQ, TCGETS),
                              width = SCMP_A1(SCMP_CMP_EQ, TIOCGWINSZ), few = SCMP_A2(SCMP_CMP_LE, WRITE_LIMIT),
                              errors = SCMP_A0(SCMP_CMP_LE, STDERR_FILENO),
                              report = SCMP_A0(SCMP_CMP_EQ, (uint64_t)data),
                              unshared = SCMP_A3(SCMP_CMP_MASKED_EQ, MAP_SHARED, 0);
    const struct {
        int call;
        unsigned count;
        struct scmp_arg_cmp arguments[2];
    } rules[] = {
        { SCMP_SYS(clone), 1, { thread } }, // threads, not processes
        { SCMP_SYS(tgkill), 1, { self } }, // signals to itself: it ends by the signal that stopped it
        { SCMP_SYS(fcntl), 1, { flags } }, // a descriptor's mode; not its owner for signals
        { SCMP_SYS(ioctl), 1, { terminal } },
        { SCMP_SYS(ioctl), 1, { width } },
        { SCMP_SYS(prlimit64), 2, { own, no_new } }, // only to read its own limits
        { SCMP_SYS(mmap), 1, { unshared } }, // bytes stored through a mapping are not counted
        { SCMP_SYS(write), 1, { few } },
        { SCMP_SYS(pwrite64), 1, { few } },
        { SCMP_SYS(writev), 1, { errors } }, // not to pictures: a filter cannot see the number of bytes
        { SCMP_SYS(writev), 1, { report } },
    };
    for (size_t i = 0; i < sizeof rules / sizeof *rules && !code; i++)
        code = seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, rules[i].call, rules[i].count, rules[i].arguments);
    return code ? code // with ENOSYS glibc falls back from clone3, whose flags a filter cannot see
                : seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
}

static bool close_calls(int data, char *message)
{
    int code = -ENOMEM;
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
    if (filter) {
        code = add_rules(filter, data);
        if (!code)
            code = seccomp_load(filter);
        seccomp_release(filter);
    }
    errno = -code;
    return !code || fail(message, "seccomp");
}

bool cli_untrusted_walls(const cli_options *options, int data, char *message)
{
    return close_descriptors(data, message) && set_limits(options->untrusted_s, message) &&
           (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 || fail(message, "no_new_privs")) &&
           close_files(options->script, options->request.folder, message) && close_calls(data, message);
}

#endif
