#include "engine/file/file.h"

#include "engine/base/status.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

glint_status glint_file_fail(glint_error *error, const char *path, int code)
{
    glint_status status = code == ENOSPC || code == EDQUOT ? GLINT_ERR_NO_SPACE
                          : code == ENOMEM                 ? GLINT_ERR_NOMEM
                                                           : GLINT_ERR_IO;
    char text[128];
#ifdef __GLIBC__
    const char *reason = strerror_r(code, text, sizeof text); // perhaps not in `text`
#else
    const char *reason = strerror_r(code, text, sizeof text) == 0 ? text : "unknown error";
#endif
    size_t length = strlen(path), most = 400;
    return glint_fail(error, status, "%s%s: %s", length > most ? "..." : "",
                      length > most ? path + length - most : path, reason);
}

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
    int file;
    do
        file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
    while (file < 0 && errno == EINTR);
    if (file < 0)
        return glint_file_fail(error, path, errno);
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
    return glint_file_fail(error, path, code);
}
