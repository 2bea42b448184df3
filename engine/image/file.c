#include "engine/image/file.h"

#include "engine/base/status.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define TEMPORARY_TRIES 100
#define TEMPORARY_ROOM 160 // what the temporary name adds to the file's: host, process, number

static glint_status fail_errno(glint_error *error, const char *path, int code)
{
    glint_status status = code == ENOSPC || code == EDQUOT ? GLINT_ERR_NO_SPACE
                          : code == ENOMEM                 ? GLINT_ERR_NOMEM
                                                           : GLINT_ERR_IO;
    char text[128];
    const char *reason = strerror_r(code, text, sizeof text); // the GNU one
    size_t length = strlen(path), most = 400;
    return glint_fail(error, status, "%s%s: %s", length > most ? "..." : "",
                      length > most ? path + length - most : path, reason);
}

/// 0 or an errno.
static int write_all(int file, const uint8_t *data, size_t size)
{
    while (size) {
        ssize_t done = write(file, data, size < SSIZE_MAX ? size : SSIZE_MAX);
        if (done < 0 && errno != EINTR)
            return errno;
        if (done == 0)
            return EIO;
        if (done > 0) {
            data += done;
            size -= (size_t)done;
        }
    }
    return 0;
}

static int close_after(int file, int code)
{
    // After EINTR the descriptor is closed all the same on Linux.
    if (close(file) != 0 && !code && errno != EINTR)
        return errno;
    return code;
}

static int open_again(const char *path, int flags, mode_t mode)
{
    int file;
    do
        file = open(path, flags, mode);
    while (file < 0 && errno == EINTR);
    return file;
}

/// Makes every folder `path` (which is changed and put back) lies in.
static int make_folders(char *path)
{
    for (char *at = path + 1; *path && *at; at++) {
        if (*at != '/' || at[-1] == '/')
            continue;
        *at = '\0';
        int code = mkdir(path, 0777) == 0 || errno == EEXIST ? 0 : errno;
        struct stat info;
        if (code && stat(path, &info) == 0) // it is there, say on a read-only file system
            code = 0;
        *at = '/';
        if (code)
            return code;
    }
    return 0;
}

/// Writes the name of a hidden file beside `path`, no other process or thread's.
static void make_temporary_name(const char *path, char *out, size_t room)
{
    static atomic_uint count;
    char host[48] = "host";
    gethostname(host, sizeof host);
    host[sizeof host - 1] = '\0';
    for (char *c = host; *c; c++)
        if (*c == '/')
            *c = '-';
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    unsigned number = atomic_fetch_add(&count, 1);
    snprintf(out, room, "%.*s.%.120s.%s.%ld.%u.tmp", (int)(name - path), path, name, host, (long)getpid(), number);
}

static int create_temporary(const char *path, char *temporary, size_t room, int *file)
{
    for (int i = 0; i < TEMPORARY_TRIES; i++) {
        make_temporary_name(path, temporary, room);
        *file = open_again(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (*file >= 0)
            return 0;
        if (errno != EEXIST)
            break;
    }
    return errno;
}

static int sync_again(int file)
{
    int result;
    do
        result = fsync(file);
    while (result != 0 && errno == EINTR);
    return result == 0 || errno == EINVAL || errno == ENOTSUP ? 0 : errno;
}

static int write_beside(char *path, const void *bytes, size_t size)
{
    size_t room = strlen(path) + TEMPORARY_ROOM;
    char *temporary = malloc(room);
    if (!temporary)
        return ENOMEM;
    int file = -1, code = create_temporary(path, temporary, room, &file);
    if (code == ENOENT) {
        code = make_folders(path);
        if (!code)
            code = create_temporary(path, temporary, room, &file);
    }
    if (!code) {
        code = write_all(file, bytes, size);
        if (!code)
            code = sync_again(file);
        code = close_after(file, code);
        if (!code && rename(temporary, path) != 0)
            code = errno;
        if (code)
            unlink(temporary);
    }
    free(temporary);
    return code;
}

static int write_in_place(const char *path, const void *bytes, size_t size)
{
    int file = open_again(path, O_WRONLY | O_CLOEXEC | O_NOCTTY, 0);
    return file < 0 ? errno : close_after(file, write_all(file, bytes, size));
}

/// Where a write to `path` ends up: the target of a symbolic link, else a copy of `path`. NULL: out of memory.
static char *target_of(const char *path)
{
    struct stat info;
    if (lstat(path, &info) == 0 && S_ISLNK(info.st_mode)) {
        char *target = realpath(path, NULL);
        if (target || errno == ENOMEM)
            return target;
    }
    return strdup(path);
}

static int write_path(const char *path, const void *bytes, size_t size)
{
    struct stat info;
    size_t length = strlen(path);
    if (length == 0)
        return ENOENT;
    if (path[length - 1] == '/')
        return EISDIR;
    bool exists = stat(path, &info) == 0;
    if (exists && S_ISDIR(info.st_mode))
        return EISDIR;
    if (exists && !S_ISREG(info.st_mode))
        return write_in_place(path, bytes, size);
    if (exists && access(path, W_OK) != 0) // a rename would not ask
        return errno;
    char *target = target_of(path);
    if (!target)
        return ENOMEM;
    int code = write_beside(target, bytes, size);
    free(target);
    return code;
}

glint_status glint_file_write(const char *path, const void *bytes, size_t size, glint_error *error)
{
    int code = write_path(path, bytes, size);
    return code ? fail_errno(error, path, code) : GLINT_OK;
}

// ---- Reading ------------------------------------------------------------------------------------------------------

static int read_all(int file, size_t limit, glint_bytes *out)
{
    struct stat info;
    size_t chunk = fstat(file, &info) == 0 && info.st_size > 0 && (uintmax_t)info.st_size <= limit
                       ? (size_t)info.st_size + 1
                       : 65536;
    for (;;) {
        if (!glint_bytes_reserve(out, chunk))
            return ENOMEM;
        ssize_t done = read(file, out->data + out->size, out->capacity - out->size);
        if (done == 0)
            return 0;
        if (done < 0 && errno != EINTR)
            return errno;
        if (done > 0)
            out->size += (size_t)done;
        if (out->size > limit)
            return EFBIG;
        chunk = out->capacity > out->size ? 1 : 65536;
    }
}

glint_status glint_file_read(const char *path, size_t limit, glint_bytes *out, glint_error *error)
{
    int file = open_again(path, O_RDONLY | O_CLOEXEC | O_NOCTTY, 0);
    if (file < 0)
        return fail_errno(error, path, errno);
    glint_bytes bytes = { 0 };
    int code = read_all(file, limit, &bytes);
    close(file);
    if (!code) {
        *out = bytes;
        return GLINT_OK;
    }
    free(bytes.data);
    if (code == EFBIG)
        return glint_fail(error, GLINT_ERR_FORMAT, "%.400s: larger than %zu bytes", path, limit);
    return fail_errno(error, path, code);
}
