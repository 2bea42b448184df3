/// Opens files for reading, and explains errno. Internal.
#ifndef GLINT_BASE_OPEN_H
#define GLINT_BASE_OPEN_H

#include "engine/glint_types.h"

/// Fills `error` with "<path>: <reason>" for an errno, and returns its status: GLINT_ERR_NO_SPACE, _NOMEM or _IO.
glint_status glint_file_fail(glint_error *error, const char *path, int code);

/// Opens a file for reading; the caller closes *file. *size is its size in bytes. A device, pipe or folder gives
/// GLINT_ERR_IO at once, because it may have no end or block its reader.
glint_status glint_open_file(const char *path, int *file, uint64_t *size, glint_error *error);

/// Returns GLINT_OK if glint_open_file can open the file: for libraries that open a path themselves.
glint_status glint_check_file(const char *path, glint_error *error);

#endif
