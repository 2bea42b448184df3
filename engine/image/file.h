/// Whole files: read into memory, written so that they appear whole or not at all. Internal.
#ifndef GLINT_IMAGE_FILE_H
#define GLINT_IMAGE_FILE_H

#include "engine/glint.h"
#include "engine/image/bytes.h"

/// Writes `path` by way of a temporary name beside it, fsync and rename; missing folders are made, a symbolic link is
/// followed. What exists and is not a regular file (a pipe, a device) is opened and written in place, never replaced.
///
/// On failure the temporary file is gone, an existing file is as it was, and the message reads
/// "<path>: <reason>"; GLINT_ERR_NO_SPACE for ENOSPC and EDQUOT, GLINT_ERR_NOMEM, GLINT_ERR_IO for the rest.
/// SIGXFSZ and SIGPIPE are the caller's to ignore; then EFBIG and EPIPE are reported like the others. Any thread.
glint_status glint_file_write(const char *path, const void *bytes, size_t size, glint_error *error);

/// Reads a whole file; *out is filled on success and its data is the caller's to free. More than `limit` bytes is
/// GLINT_ERR_FORMAT.
glint_status glint_file_read(const char *path, size_t limit, glint_bytes *out, glint_error *error);

#endif
