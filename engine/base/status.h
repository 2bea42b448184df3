/// Fills a glint_error. Internal.
#ifndef GLINT_BASE_STATUS_H
#define GLINT_BASE_STATUS_H

#include "engine/glint_types.h"

/// Fills `error` (when not NULL) with a formatted message and returns `status`, for `return glint_fail(...)`.
glint_status glint_fail(glint_error *error, glint_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/// Makes the function return GLINT_ERR_INVALID if a required pointer is NULL.
#define GLINT_REFUSE_NULL(argument, error) \
    do { \
        if (!(argument)) \
            return glint_fail(error, GLINT_ERR_INVALID, #argument ": pointer expected, got NULL"); \
    } while (0)

/// Copies the description of a program, which begins with its size and may be shorter or longer than the `size` bytes of
/// the library's, over the defaults in `full`, whose own size is `size`. Refuses a size of 0, and fields that the library
/// does not know unless they are 0.
glint_status glint_desc_read(void *full, size_t size, const void *desc, glint_error *error);
/// Begins a function with the parameters `given`, a description, and `error`: declares `desc`, a full copy over the
/// defaults, and `status`, or returns an error.
#define GLINT_TAKE_DESC(type, ...) \
    if (!given) \
        return glint_fail(error, GLINT_ERR_INVALID, "desc: pointer expected, got NULL"); \
    type full = __VA_ARGS__; \
    const type *const desc = &full; \
    glint_status status = glint_desc_read(&full, sizeof full, given, error); \
    if (status) \
    return status
/// Writes the defaults in `full`, a description of the library, to a program's of `size` bytes. desc: NULL: nothing.
void glint_desc_write(void *desc, size_t size, const void *full, size_t known);

/// Fails with "out of memory" and GLINT_ERR_NOMEM.
glint_status glint_fail_nomem(glint_error *error);

/// Check one field; on failure the message reads "<name>: <what is allowed> expected, got <value>".
glint_status glint_check_range(const char *name, double value, double min, double max, const char *allowed,
                               glint_error *error);
glint_status glint_check_whole(const char *name, int64_t value, int64_t min, int64_t max, glint_error *error);
glint_status glint_check_vector(const char *name, const double v[3], glint_error *error); ///< finite
glint_status glint_check_direction(const char *name, const double v[3], glint_error *error); ///< finite, not zero
glint_status glint_check_color(const char *name, const double v[3], glint_error *error); ///< finite, >= 0

#endif
