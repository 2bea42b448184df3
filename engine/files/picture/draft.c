/// A draft of a file: hidden next to its final name until it is complete.
#include "engine/base/status.h"
#include "engine/files/picture/file.h"
#include "engine/glint_files.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define TEMPORARY_TRIES 100
#define READER_TRIES 500
#define TEMPORARY_EXTRA 160 // bytes that the temporary name adds to the file's name: host, process, number
#define LINKS 40 // most links followed in a chain; the same limit as the system's
#define PIECE ((size_t)1 << 20) // bytes of one write, so that the growing size of the file shows progress

struct glint_draft {
    char *path; ///< path as the caller gave it
    char *target; ///< final path: the end of a symbolic link
    char *temporary; ///< NULL: the target is a pipe or a device, written in place
    int file; ///< -1: closed
};

/// Returns 0 or an errno.
static int write_all(int file, const uint8_t *data, size_t size)
{
    while (size) {
        ssize_t done = write(file, data, size < PIECE ? size : PIECE);
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
    // On Linux the descriptor is closed even after EINTR.
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

/// Opens a pipe for writing. Waits for a program that reads it, READER_TRIES times 10 ms at most.
static int open_pipe(const char *path)
{
    const struct timespec moment = { .tv_nsec = 10000000 };
    for (int i = 0;; i++) {
        const int file = open_again(path, O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK, 0);
        if (file >= 0)
            fcntl(file, F_SETFL, 0); // from now on, writes wait for the reader
        if (file >= 0 || errno != ENXIO || i == READER_TRIES)
            return file;
        nanosleep(&moment, NULL);
    }
}

/// Makes all parent folders of `path`, which is changed and restored.
static int make_folders(char *path)
{
    for (char *at = path + 1; *path && *at; at++) {
        if (*at != '/' || at[-1] == '/')
            continue;
        *at = '\0';
        int code = mkdir(path, 0777) == 0 || errno == EEXIST ? 0 : errno;
        struct stat info;
        if (code && stat(path, &info) == 0) // the folder exists already, for example on a read-only file system
            code = 0;
        *at = '/';
        if (code)
            return code;
    }
    return 0;
}

/// Writes the name of a hidden file next to `path`, unique to this process and thread.
static void make_temporary_name(const char *path, char *out, size_t capacity)
{
    static atomic_uint count;
    char host[GLINT_HOST_SIZE];
    glint_host_name(host);
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    unsigned number = atomic_fetch_add(&count, 1);
    snprintf(out, capacity, "%.*s.%.120s.%s.%ld.%u.tmp", (int)(name - path), path, name, host, (long)getpid(), number);
}

/// Registers the name before the file exists, so that a signal in between cannot leave the file behind.
static int create_temporary(const char *path, char *temporary, size_t capacity, int *file)
{
    for (int i = 0; i < TEMPORARY_TRIES; i++) {
        make_temporary_name(path, temporary, capacity);
        glint_draft_enlist(temporary);
        *file = open_again(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (*file >= 0) {
            flock(*file, LOCK_EX | LOCK_NB); // without file locks only the process number marks the owner
            return 0;
        }
        const int code = errno;
        glint_draft_delist(temporary);
        if (code != EEXIST)
            return code;
    }
    return EEXIST;
}

static int sync_again(int file)
{
    int result;
    do
        result = fsync(file);
    while (result != 0 && errno == EINTR);
    return result == 0 || errno == EINVAL || errno == ENOTSUP ? 0 : errno;
}

/// Returns where a write to `path` ends up: the target of a symbolic link, otherwise a copy of `path`. NULL: out of
/// memory.
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

/// Returns `name`, the target of a link at `path`, as a path from the current folder. NULL: out of memory.
static char *sibling(const char *path, const char *name)
{
    const char *slash = *name == '/' ? NULL : strrchr(path, '/');
    const size_t folder = slash ? (size_t)(slash + 1 - path) : 0, length = strlen(name) + 1;
    char *out = malloc(folder + length);
    if (out) {
        memcpy(out, path, folder);
        memcpy(out + folder, name, length);
    }
    return out;
}

/// Does the same as target_of, but also follows a link to a file that does not exist yet.
static char *end_of_links(const char *path)
{
    char link[PATH_MAX];
    char *end = target_of(path);
    for (int i = 0; end && i < LINKS; i++) {
        const ssize_t length = readlink(end, link, sizeof link - 1);
        if (length < 0)
            return end;
        link[length] = '\0';
        char *next = sibling(end, link);
        free(end);
        end = next;
    }
    return end;
}

/// Returns the canonical name of the innermost existing folder of `path`. *rest: the remaining part of `path`. NULL:
/// out of memory.
static char *folder_of(const char *path, const char **rest)
{
    char *folder = NULL;
    size_t length = strlen(path);
    do {
        while (length > 0 && path[length - 1] != '/')
            length--;
        *rest = path + length;
        char *head = length > 0 ? strndup(path, length) : strdup(".");
        if (!head)
            return NULL;
        folder = realpath(head, NULL);
        const bool short_of_memory = !folder && errno == ENOMEM;
        free(head);
        if (short_of_memory)
            return NULL;
        while (length > 0 && path[length - 1] == '/')
            length--;
    } while (!folder && length > 0);
    return folder ? folder : strdup(""); // the current folder was deleted
}

/// Appends the next name of `rest` to `out` (*length bytes) and returns the remaining names. It resolves `..` by
/// removing the last name of `out`, because folders that do not exist yet are not links.
static const char *add_name(const char *rest, char *out, size_t *length)
{
    const size_t size = strcspn(rest, "/");
    if (size == 2 && memcmp(rest, "..", 2) == 0) {
        while (*length > 0 && out[--*length] != '/')
            ;
    } else if (size > 0 && !(size == 1 && *rest == '.')) {
        out[(*length)++] = '/';
        memcpy(out + *length, rest, size);
        *length += size;
    }
    return rest + size + strspn(rest + size, "/");
}

char *glint_draft_place(const char *path)
{
    const char *rest;
    char *end = end_of_links(path);
    char *folder = end ? folder_of(end, &rest) : NULL;
    char *out = folder ? malloc(strlen(folder) + strlen(rest) + 2) : NULL;
    if (out) {
        size_t length = strlen(folder);
        memcpy(out, folder, length);
        length -= length == 1; // for "/"
        while (*rest)
            rest = add_name(rest, out, &length);
        out[length] = '\0';
    }
    free(folder);
    free(end);
    return out;
}

static int open_hidden(glint_draft *draft)
{
    size_t capacity = strlen(draft->target) + TEMPORARY_EXTRA;
    draft->temporary = malloc(capacity);
    if (!draft->temporary)
        return ENOMEM;
    int code = create_temporary(draft->target, draft->temporary, capacity, &draft->file);
    if (code == ENOENT) {
        code = make_folders(draft->target);
        if (!code)
            code = create_temporary(draft->target, draft->temporary, capacity, &draft->file);
    }
    if (code) { // there is no file to remove
        free(draft->temporary);
        draft->temporary = NULL;
        return code;
    }
    glint_drafts_collect_in_folder(draft->temporary);
    return 0;
}

/// Returns 0 or an errno.
static int open_draft(glint_draft *draft)
{
    struct stat info;
    const char *path = draft->path;
    size_t length = strlen(path);
    if (length == 0)
        return ENOENT;
    if (path[length - 1] == '/')
        return EISDIR;
    bool exists = stat(path, &info) == 0;
    if (exists && S_ISDIR(info.st_mode))
        return EISDIR;
    if (exists && !S_ISREG(info.st_mode)) {
        draft->file = S_ISFIFO(info.st_mode) ? open_pipe(path) : open_again(path, O_WRONLY | O_CLOEXEC | O_NOCTTY, 0);
        if (draft->file < 0 && errno == ENXIO && S_ISFIFO(info.st_mode))
            return EPIPE;
        return draft->file < 0 ? errno : 0;
    }
    if (exists && access(path, W_OK) != 0) // a rename does not check write permission
        return errno;
    draft->target = target_of(path);
    return draft->target ? open_hidden(draft) : ENOMEM;
}

glint_status glint_draft_create(const char *path, glint_draft **out, glint_error *error)
{
    GLINT_REFUSE_NULL(path, error);
    GLINT_REFUSE_NULL(out, error);
    glint_draft *draft = calloc(1, sizeof *draft);
    if (!draft)
        return glint_fail_nomem(error);
    draft->file = -1;
    draft->path = strdup(path);
    int code = draft->path ? open_draft(draft) : ENOMEM;
    if (code) {
        glint_draft_destroy(draft);
        if (code == EPIPE)
            return glint_fail(error, GLINT_ERR_IO, "%s: no program reads this pipe", path);
        return glint_file_fail(error, path, code);
    }
    *out = draft;
    return GLINT_OK;
}

const char *glint_draft_name(const glint_draft *draft)
{
    if (!draft)
        return NULL;
    return draft->temporary ? draft->temporary : draft->path;
}

glint_status glint_draft_append(glint_draft *draft, const void *bytes, size_t size, glint_error *error)
{
    GLINT_REFUSE_NULL(draft, error);
    if (size)
        GLINT_REFUSE_NULL(bytes, error);
    int code = write_all(draft->file, bytes, size);
    return code ? glint_file_fail(error, draft->path, code) : GLINT_OK;
}

glint_status glint_draft_finish(glint_draft *draft, glint_error *error)
{
    GLINT_REFUSE_NULL(draft, error);
    int code = draft->temporary ? sync_again(draft->file) : 0;
    code = close_after(draft->file, code);
    draft->file = -1;
    if (!code && draft->temporary) {
        code = rename(draft->temporary, draft->target) == 0 ? 0 : errno;
        if (!code) {
            glint_draft_delist(draft->temporary);
            free(draft->temporary);
            draft->temporary = NULL;
        }
    }
    return code ? glint_file_fail(error, draft->path, code) : GLINT_OK;
}

void glint_draft_destroy(glint_draft *draft)
{
    if (!draft)
        return;
    if (draft->file >= 0)
        close(draft->file);
    if (draft->temporary) {
        unlink(draft->temporary);
        glint_draft_delist(draft->temporary);
    }
    free(draft->temporary);
    free(draft->target);
    free(draft->path);
    free(draft);
}

glint_status glint_file_write(const char *path, const void *bytes, size_t size, glint_error *error)
{
    glint_draft *draft = NULL;
    glint_status status = glint_draft_create(path, &draft, error);
    if (!status)
        status = glint_draft_append(draft, bytes, size, error);
    if (!status)
        status = glint_draft_finish(draft, error);
    glint_draft_destroy(draft);
    return status;
}
