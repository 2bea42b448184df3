#include "engine/base/open.h"

#include "engine/base/status.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PATH_SHOWN 400 // characters of a path in a message, from its end

static const char *shown(const char *path, const char **dots)
{
    const size_t length = strlen(path);
    *dots = length > PATH_SHOWN ? "..." : "";
    return length > PATH_SHOWN ? path + length - PATH_SHOWN : path;
}

glint_status glint_file_fail(glint_error *error, const char *path, int code)
{
    glint_status status = code == ENOSPC || code == EDQUOT ? GLINT_ERR_NO_SPACE
                          : code == ENOMEM                 ? GLINT_ERR_NOMEM
                                                           : GLINT_ERR_IO;
    char text[128];
#if defined(__GLIBC__) && defined(_GNU_SOURCE)
    const char *reason = strerror_r(code, text, sizeof text); // the GNU version may return a text outside `text`
#else
    const char *reason = strerror_r(code, text, sizeof text) == 0 ? text : "unknown error";
#endif
    const char *dots, *end = shown(path, &dots);
    return glint_fail(error, status, "%s%s: %s", dots, end, reason);
}

/// Returns GLINT_OK for a regular file, otherwise an error.
static glint_status check_kind(const char *path, mode_t mode, glint_error *error)
{
    const char *dots, *end = shown(path, &dots);
    if (S_ISREG(mode))
        return GLINT_OK;
    if (S_ISDIR(mode))
        return glint_file_fail(error, path, EISDIR);
    return glint_fail(error, GLINT_ERR_IO, "%s%s: a file expected, got a %s", dots, end,
                      S_ISFIFO(mode)   ? "pipe"
                      : S_ISSOCK(mode) ? "socket"
                                       : "device");
}

glint_status glint_open_file(const char *path, int *file, uint64_t *size, glint_error *error)
{
    struct stat info;
    int opened;
    do
        // O_NONBLOCK: does not wait for a pipe's writer
        opened = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    while (opened < 0 && errno == EINTR);
    if (opened < 0 && errno == ENXIO && stat(path, &info) == 0)
        return check_kind(path, info.st_mode, error); // a socket
    if (opened < 0)
        return glint_file_fail(error, path, errno);
    glint_status status =
        fstat(opened, &info) == 0 ? check_kind(path, info.st_mode, error) : glint_file_fail(error, path, errno);
    if (status) {
        close(opened);
        return status;
    }
    *file = opened;
    *size = (uint64_t)info.st_size;
    return GLINT_OK;
}

glint_status glint_check_file(const char *path, glint_error *error)
{
    int file;
    uint64_t size;
    glint_status status = glint_open_file(path, &file, &size, error);
    if (!status)
        close(file);
    return status;
}
