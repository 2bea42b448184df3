/// Attacks from a process inside the sandbox of --untrusted that runs arbitrary code: each attack is a function that
/// returns 0 when it succeeds, otherwise an errno. Prints TAP. Must run in its own folder.
#include "bindings/command/untrusted.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#define INHERITED 57 // a descriptor that the parent left open
#define DATA 41 // a descriptor that stays open in the sandbox

static pid_t parent;

static int errno_of(long result) { return result < 0 ? errno : 0; }

static int opens(const char *path, int flags)
{
    const int file = open(path, flags, 0600);
    if (file < 0)
        return errno;
    close(file);
    return 0;
}

static int reads_secret(void) { return opens("secret", O_RDONLY); }
static int reads_passwords(void) { return opens("/etc/passwd", O_RDONLY); }
static int reads_memory(void) { return opens("/proc/self/mem", O_RDWR); }
static int reads_folder(void) { return opens("pictures", O_RDONLY | O_DIRECTORY); }
static int writes_script(void) { return opens("scene.lua", O_WRONLY); }
static int writes_beside(void) { return opens("new", O_WRONLY | O_CREAT); }
static int cuts_by_opening(void) { return opens("secret", O_RDONLY | O_TRUNC); }
static int cuts_script(void) { return opens("scene.lua", O_RDONLY | O_TRUNC); }
static int cuts(void) { return errno_of(truncate("secret", 0)); }
static int removes(void) { return errno_of(unlink("secret")); }
static int moves_in(void) { return errno_of(rename("secret", "pictures/secret")); }
static int moves_out(void) { return errno_of(rename("pictures/own", "own")); }
static int links(void) { return errno_of(link("secret", "pictures/link")); }
static int links_by_name(void) { return errno_of(symlink("/etc/passwd", "pictures/name")); }
static int makes_folder(void) { return errno_of(mkdir("pictures/deep", 0700)); }
static int makes_pipe(void) { return errno_of(mkfifo("pictures/pipe", 0700)); }
static int changes_mode(void) { return errno_of(chmod("secret", 0777)); }

static int uses_inherited(void) { return errno_of(write(INHERITED, "x", 1)); }

static int reads_input(void)
{
    char byte;
    return read(STDIN_FILENO, &byte, 1) == 1 ? 0 : EBADF; // the input must be at its end immediately
}

// Returns 0 if a file can be mapped shared, to write to it without a call that is counted.
static int maps_shared(int protection)
{
    const int file = open("pictures/own", O_RDWR);
    if (file < 0 || ftruncate(file, 4096))
        return file < 0 ? 0 : errno; // own files may be opened
    void *bytes = mmap(NULL, 4096, protection, MAP_SHARED, file, 0);
    const int code = bytes == MAP_FAILED ? errno : 0;
    close(file);
    return code;
}

static int maps_to_write(void) { return maps_shared(PROT_READ | PROT_WRITE); }
static int maps_to_write_later(void) { return maps_shared(PROT_READ); }

static int starts_program(void)
{
    char *const nothing[] = { NULL };
    return errno_of(execve("/bin/true", nothing, nothing));
}

static int starts_process(void)
{
    const pid_t child = (pid_t)syscall(SYS_clone, (unsigned long)SIGCHLD, NULL, NULL, NULL, NULL);
    if (child == 0)
        _exit(0);
    return errno_of(child);
}

static int signals_parent(void) { return errno_of(kill(parent, 0)); }
static int signals_thread(void) { return errno_of(syscall(SYS_tgkill, parent, parent, 0)); }
static int traces(void) { return errno_of(ptrace(PTRACE_ATTACH, parent, NULL, NULL)); }
static int connects(void) { return errno_of(socket(AF_INET, SOCK_STREAM, 0)); }
static int joins(void) { return errno_of(socket(AF_UNIX, SOCK_STREAM, 0)); }
static int owns_signals(void) { return errno_of(fcntl(STDERR_FILENO, F_SETOWN, parent)); }
static int copies(void) { return errno_of(fcntl(STDERR_FILENO, F_DUPFD, 50)); }
static int leases(void) { return errno_of(fcntl(STDERR_FILENO, F_SETLEASE, F_RDLCK)); }
static int fakes_typing(void) { return errno_of(syscall(SYS_ioctl, STDERR_FILENO, 0x5412UL, "x")); }
static int makes_memory_file(void) { return errno_of(syscall(SYS_memfd_create, "x", 0U)); }

static int takes_memory(void)
{
#ifdef __SANITIZE_ADDRESS__ // AddressSanitizer maps terabytes, so there is no memory limit
    return ENOMEM;
#endif
    return mmap(NULL, (size_t)5 << 30, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == MAP_FAILED ? errno : 0;
}

static int raises_limit(void)
{
    const struct rlimit limit = { RLIM_INFINITY, RLIM_INFINITY };
    return errno_of(setrlimit(RLIMIT_AS, &limit));
}

static int opens_many(void)
{
    for (int i = 0; i < 100; i++)
        if (open("scene.lua", O_RDONLY) < 0)
            return errno;
    return 0;
}

static int writes_much(void)
{
    const int file = open("pictures/much", O_WRONLY | O_CREAT, 0600);
    signal(SIGXFSZ, SIG_IGN);
    return file < 0 ? 0 : errno_of(pwrite(file, "x", 1, (off_t)CLI_UNTRUSTED_FILE));
}

static int writes_at_once(void)
{
    const size_t size = (size_t)256 << 20;
    const int file = open("pictures/at_once", O_WRONLY | O_CREAT, 0600);
    void *zeros = mmap(NULL, size, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return file < 0 || zeros == MAP_FAILED ? 0 : errno_of(write(file, zeros, size));
}

static int writes_scattered(void)
{
    struct iovec piece = { (void *)"x", 1 };
    const int file = open("pictures/scattered", O_WRONLY | O_CREAT, 0600);
    return file < 0 ? 0 : errno_of(writev(file, &piece, 1));
}

// Checks that rendering still works in the sandbox.
static int works(void)
{
    struct iovec nothing = { (void *)"", 0 };
    const int file = open("pictures/.draft", O_WRONLY | O_CREAT | O_EXCL, 0600);
    const bool good = file >= 0 && write(file, "x", 1) == 1 && fsync(file) == 0 && fcntl(file, F_GETFL) >= 0 &&
                      close(file) == 0 && rename("pictures/.draft", "pictures/done") == 0 &&
                      opens("pictures/done", O_RDONLY) == 0 && opens("scene.lua", O_RDONLY) == 0 &&
                      write(DATA, "", 0) == 0 && writev(DATA, &nothing, 1) == 0;
    return good ? 0 : errno ? errno : EIO;
}

static const struct attack {
    const char *name;
    int (*run)(void);
} attacks[] = {
#define ATTACK(function) { #function, function }
    ATTACK(reads_secret),   ATTACK(reads_passwords), ATTACK(reads_memory),      ATTACK(reads_folder),
    ATTACK(writes_script),  ATTACK(writes_beside),   ATTACK(cuts_by_opening),   ATTACK(cuts_script),
    ATTACK(cuts),           ATTACK(removes),         ATTACK(moves_in),          ATTACK(moves_out),
    ATTACK(links),          ATTACK(links_by_name),   ATTACK(makes_folder),      ATTACK(makes_pipe),
    ATTACK(changes_mode),   ATTACK(uses_inherited),  ATTACK(reads_input),       ATTACK(maps_to_write), ATTACK(maps_to_write_later),       ATTACK(starts_program),
    ATTACK(starts_process), ATTACK(signals_parent),  ATTACK(signals_thread),    ATTACK(traces),
    ATTACK(connects),       ATTACK(joins),           ATTACK(owns_signals),      ATTACK(copies),
    ATTACK(leases),         ATTACK(fakes_typing),    ATTACK(makes_memory_file), ATTACK(takes_memory),
    ATTACK(raises_limit),   ATTACK(opens_many),      ATTACK(writes_much),       ATTACK(writes_at_once),
    ATTACK(writes_scattered),
};

static bool write_file(const char *path)
{
    FILE *file = fopen(path, "w");
    return file && fputs("text", file) >= 0 && fclose(file) == 0;
}

/// Runs an attack in a child process, inside the sandbox if `walls`. Returns 0 when the attack succeeds, otherwise
/// its errno; 255 when the sandbox could not be built.
static int result_of(int (*run)(void), bool walls)
{
    char message[GLINTL_MESSAGE_SIZE] = "", folder[] = "pictures", script[] = "scene.lua";
    cli_options options = { .script = script, .untrusted_s = 60 };
    options.request.folder = folder;
    int status;
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        errno = 0;
        if (walls && !cli_untrusted_walls(&options, DATA, message)) {
            fprintf(stderr, "# %s\n", message);
            _exit(255);
        }
        _exit(run());
    }
    return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

int main(void)
{
    int bad = 0;
    parent = getpid();
    mkdir("pictures", 0700);
    bool good = write_file("secret") && write_file("scene.lua") && write_file("pictures/own");
    const int secret = open("secret", O_RDWR);
    good = good && secret >= 0 && dup2(secret, INHERITED) == INHERITED && dup2(secret, DATA) == DATA;
    const int whole = good ? result_of(works, true) : 255;
    printf("%s - what a render does: %s\n", whole ? "not ok" : "ok", whole ? strerror(whole) : "goes on");
    bad += whole != 0;
    for (size_t i = 0; i < sizeof attacks / sizeof *attacks; i++) {
        const int code = result_of(attacks[i].run, true);
        const bool stopped = code != 0 && code != 255;
        printf("%s - %s: %s\n", stopped ? "ok" : "not ok", attacks[i].name, stopped ? strerror(code) : "not stopped");
        bad += !stopped;
    }
    const bool real = !result_of(uses_inherited, false) && !result_of(reads_passwords, false) && !result_of(copies, false);
    printf("%s - without walls attacks succeed\n", real ? "ok" : "not ok");
    return bad > 0 || !real;
}
