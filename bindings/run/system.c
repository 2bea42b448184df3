#include "bindings/run/system.h"

#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <unistd.h>
#ifdef __APPLE__
#include <xlocale.h> // locale_t is there
#endif

#if defined(__linux__) && !defined(GLINT_PORTABLE)
#define HAS_LINUX 1
#include <sys/eventfd.h>
#include <sys/random.h>
#else
#define HAS_LINUX 0
#endif

#if !HAS_LINUX
// Makes a descriptor that child processes do not inherit, and that does not block unless `waits`.
static bool make_private(int fd, bool waits)
{
    const int flags = fcntl(fd, F_GETFL);
    return fcntl(fd, F_SETFD, FD_CLOEXEC) == 0 &&
           (waits || (flags >= 0 && fcntl(fd, F_SETFL, flags | O_NONBLOCK) == 0));
}

static int private_socket(int socket, bool waits)
{
#ifdef SO_NOSIGPIPE
    const int yes = 1;
    if (socket >= 0)
        setsockopt(socket, SOL_SOCKET, SO_NOSIGPIPE, &yes, sizeof yes);
#endif
    if (socket < 0 || make_private(socket, waits))
        return socket;
    const int why = errno;
    close(socket);
    errno = why;
    return -1;
}
#endif

// ---- Waking ----

bool glintL_wake_open(glintL_wake *wake)
{
#if HAS_LINUX
    wake->from = wake->to = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (wake->from >= 0)
        return true;
#else
    int ends[2];
    if (pipe(ends) == 0) {
        *wake = (glintL_wake) { ends[0], ends[1] };
        if (make_private(ends[0], false) && make_private(ends[1], false))
            return true;
        const int why = errno;
        close(ends[0]);
        close(ends[1]);
        errno = why;
    }
#endif
    *wake = (glintL_wake) { 0 };
    return false;
}

void glintL_wake_close(glintL_wake *wake)
{
    if (wake->from == 0 && wake->to == 0)
        return;
    close(wake->from);
    if (wake->to != wake->from)
        close(wake->to);
    *wake = (glintL_wake) { 0 };
}

void glintL_wake_call(const glintL_wake *wake)
{
    const uint64_t one = 1;
    if (write(wake->to, &one, sizeof one) < 0)
        return; // full: the thread will wake up
}

void glintL_wake_clear(const glintL_wake *wake)
{
    uint64_t calls[64];
    while (read(wake->from, calls, sizeof calls) == (ssize_t)sizeof calls)
        ;
}

// ---- Sockets ----

int glintL_socket(int domain, int type)
{
#if HAS_LINUX
    return socket(domain, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
#else
    return private_socket(socket(domain, type, 0), false);
#endif
}

int glintL_accept(int listener)
{
#if HAS_LINUX
    return accept4(listener, NULL, NULL, SOCK_NONBLOCK | SOCK_CLOEXEC);
#else
    return private_socket(accept(listener, NULL, NULL), false);
#endif
}

bool glintL_socket_pair(int ends[2])
{
#if HAS_LINUX
    return socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0;
#else
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
        return false;
    if (private_socket(ends[0], true) < 0) {
        close(ends[1]);
        return false;
    }
    if (private_socket(ends[1], true) < 0) {
        close(ends[0]);
        return false;
    }
    return true;
#endif
}

// ---- The machine ----

void glintL_cond_init(pthread_cond_t *cond)
{
#if HAS_LINUX
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, GLINTL_COND_CLOCK);
    pthread_cond_init(cond, &attributes);
    pthread_condattr_destroy(&attributes);
#else
    pthread_cond_init(cond, NULL);
#endif
}

const char *glintL_other_kind(const char *path)
{
    struct stat info;
    if (stat(path, &info) != 0 || S_ISREG(info.st_mode))
        return NULL;
    return S_ISDIR(info.st_mode)    ? "folder"
           : S_ISFIFO(info.st_mode) ? "pipe"
           : S_ISSOCK(info.st_mode) ? "socket"
                                    : "device";
}

bool glintL_random(void *bytes, size_t size)
{
#if HAS_LINUX
    return getrandom(bytes, size, 0) == (ssize_t)size;
#else
    FILE *file = fopen("/dev/urandom", "rb");
    const bool good = file && fread(bytes, 1, size, file) == size;
    if (file)
        fclose(file);
    return good;
#endif
}

bool glintL_make_folders(const char *folder)
{
    struct stat info;
    char *path = strdup(folder);
    if (!path)
        return false;
    for (char *at = path + 1; *path && *at; at++) {
        if (*at != '/')
            continue;
        *at = '\0';
        mkdir(path, 0777); // a failure shows in the check below
        *at = '/';
    }
    const int why = mkdir(path, 0777) == 0 ? 0 : errno;
    const bool exists = stat(path, &info) == 0;
    free(path);
    errno = exists ? ENOTDIR : why;
    return exists && S_ISDIR(info.st_mode);
}

void glintL_keep_points(void)
{
#ifndef __NetBSD__
    const locale_t numbers = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (numbers)
        uselocale(numbers);
#endif
}

#if !HAS_LINUX
// Finds a program as a shell does: a path with a folder as it is, another word in the folders of PATH. The caller frees
// it. NULL: not found.
static char *find_program(const char *started_as)
{
    char word[4096];
    if (strchr(started_as, '/'))
        return realpath(started_as, NULL);
    for (const char *at = getenv("PATH"); at && *at; at += *at == ':') {
        const int length = (int)strcspn(at, ":");
        snprintf(word, sizeof word, "%.*s/%s", length ? length : 1, length ? at : ".", started_as);
        if (access(word, X_OK) == 0)
            return realpath(word, NULL);
        at += length;
    }
    return NULL;
}
#endif

bool glintL_program_folder(const char *started_as, char *folder, size_t size)
{
#if HAS_LINUX
    (void)started_as;
    const ssize_t length = readlink("/proc/self/exe", folder, size - 1);
    folder[length > 0 ? length : 0] = '\0';
#else
    char *path = find_program(started_as);
    snprintf(folder, size, "%s", path && strlen(path) < size ? path : "");
    free(path);
#endif
    char *slash = strrchr(folder, '/');
    if (slash)
        slash[1] = '\0';
    return slash != NULL;
}

// Reads "model name : ..." from /proc/cpuinfo, which not all processors have.
static bool read_model(char out[128])
{
#if HAS_LINUX
    char line[256];
    bool found = false;
    FILE *file = fopen("/proc/cpuinfo", "re");
    while (file && !found && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        found = strncmp(line, "model name", 10) == 0 && colon && colon[1] == ' ';
        if (found)
            snprintf(out, 128, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
    }
    if (file)
        fclose(file);
    return found;
#else
    (void)out;
    return false;
#endif
}

void glintL_processor_name(char out[128])
{
    struct utsname names;
    if (!read_model(out))
        snprintf(out, 128, "%.100s", uname(&names) == 0 ? names.machine : "processor unknown");
}

long long glintL_peak_bytes(void)
{
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage))
        return 0;
#ifdef __APPLE__
    return usage.ru_maxrss;
#else
    return 1024LL * usage.ru_maxrss;
#endif
}
