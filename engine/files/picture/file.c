#include "engine/files/picture/file.h"

#include "engine/base/status.h"
#include "engine/files/picture/exr.h"
#include "engine/files/picture/hdr.h"
#include "engine/files/picture/jpeg.h"
#include "engine/files/picture/pfm.h"
#include "engine/files/picture/png.h"

#include <errno.h>
#include <unistd.h>

#define JPEG_LIMIT ((size_t)1 << 28) ///< bytes
#define FLOATS_LIMIT ((size_t)1 << 29) ///< bytes of an .hdr or .exr
#define PICTURE_LIMIT ((size_t)1 << (sizeof(size_t) > 4 ? 34 : 31))
#define HEAD_BYTES ((size_t)65536) // enough to hold the size of the picture
#define SLACK_BYTES ((size_t)64 << 20) // allowance for everything in a picture file except pixels
// largest file size relative to the bytes of its pixels: a byte of pixels takes 13 if it has a chunk of its own
#define STORED_TIMES 16

/// Reads until there are `most` bytes, or the end of the file. Returns 0 or an errno.
static int read_up_to(int file, size_t most, glint_bytes *out)
{
    if (most > out->size && !glint_bytes_reserve(out, most - out->size))
        return ENOMEM;
    while (out->size < most) {
        ssize_t done = read(file, out->data + out->size, most - out->size);
        if (done == 0)
            return 0;
        if (done < 0 && errno != EINTR)
            return errno;
        if (done > 0)
            out->size += (size_t)done;
    }
    return 0;
}

/// Returns an upper bound for the bytes of a whole picture that begins like this. 0: no known picture format.
static size_t picture_bound(const glint_bytes *head)
{
    const uint64_t pfm = glint_pfm_bytes(head->data, head->size);
    const uint64_t png = glint_png_raw_bytes(head->data, head->size);
    if (pfm)
        return (size_t)pfm + SLACK_BYTES;
    if (glint_is_hdr(head->data, head->size) || glint_is_exr(head->data, head->size) || glint_is_pfm(head->data, head->size))
        return FLOATS_LIMIT;
    if (!png)
        return glint_is_jpeg(head->data, head->size) ? JPEG_LIMIT : 0;
    return png < PICTURE_LIMIT / STORED_TIMES ? (size_t)png * STORED_TIMES + SLACK_BYTES : PICTURE_LIMIT;
}

/// Reads an open file of `size` bytes, at most `limit`, into `bytes`, which is freed on failure.
static glint_status read_whole(const char *path, int file, uint64_t size, size_t limit, glint_bytes *bytes,
                               glint_error *error)
{
    const int code = size > limit ? 0 : read_up_to(file, (size_t)size, bytes);
    if (!code && size <= limit)
        return GLINT_OK;
    free(bytes->data);
    return code ? glint_file_fail(error, path, code)
                : glint_fail(error, GLINT_ERR_FORMAT, "%.400s: larger than %zu bytes", path, limit);
}

glint_status glint_file_read(const char *path, size_t limit, glint_bytes *out, glint_error *error)
{
    int file;
    uint64_t size;
    glint_bytes bytes = { 0 };
    glint_status status = glint_open_file(path, &file, &size, error);
    if (status)
        return status;
    status = read_whole(path, file, size, limit, &bytes, error);
    close(file);
    if (!status)
        *out = bytes;
    return status;
}

glint_status glint_file_read_picture(const char *path, glint_bytes *out, glint_error *error)
{
    int file;
    uint64_t size;
    glint_bytes bytes = { 0 };
    glint_status status = glint_open_file(path, &file, &size, error);
    if (status)
        return status;
    const int code = read_up_to(file, size < HEAD_BYTES ? (size_t)size : HEAD_BYTES, &bytes);
    const size_t limit = code ? 0 : picture_bound(&bytes);
    if (code) {
        free(bytes.data);
        status = glint_file_fail(error, path, code);
    } else if (limit) { // the beginning is enough for a decoder to report that the file is no picture
        status = read_whole(path, file, size, limit, &bytes, error);
    }
    close(file);
    if (!status)
        *out = bytes;
    return status;
}
