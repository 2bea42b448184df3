#include "engine/base/number.h"
#include "engine/base/status.h"
#include "engine/glint.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *glint_version(void) { return GLINT_VERSION; }

glint_status glint_fail(glint_error *error, glint_status status, const char *format, ...)
{
    if (error) {
        va_list args;
        va_start(args, format);
        glint_print_list(error->message, sizeof error->message, format, args);
        va_end(args);
        error->status = status;
    }
    return status;
}

#define DESC_MAX 65536 ///< bytes; larger sizes are mistakes

glint_status glint_desc_read(void *full, size_t size, const void *desc, glint_error *error)
{
    size_t given;
    memcpy(&given, desc, sizeof given);
    bool good = given > sizeof given && given <= DESC_MAX;
    for (size_t i = size; good && i < given; i++)
        good = ((const char *)desc)[i] == 0;
    if (!good && given > size && given <= DESC_MAX)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "desc.struct_size: a field that this version does not know: after %zu bytes, all must be 0", size);
    if (!good)
        return glint_fail(error, GLINT_ERR_INVALID, "desc.struct_size: sizeof the struct expected (%zu in this version), got %zu; _desc_init sets it",
                          size, given);
    memcpy(full, desc, given < size ? given : size);
    memcpy(full, &size, sizeof size);
    return GLINT_OK;
}

void glint_desc_write(void *desc, size_t size, const void *full, size_t known)
{
    if (!desc || size < sizeof size)
        return;
    memset(desc, 0, size);
    memcpy(desc, full, size < known ? size : known);
    memcpy(desc, &size, sizeof size);
}

glint_status glint_fail_nomem(glint_error *error) { return glint_fail(error, GLINT_ERR_NOMEM, "out of memory"); }

glint_status glint_check_range(const char *name, double value, double min, double max, const char *allowed,
                               glint_error *error)
{
    if (value >= min && value <= max)
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "%s: %s expected, got %.15g", name, allowed, value);
}

glint_status glint_check_whole(const char *name, int64_t value, int64_t min, int64_t max, glint_error *error)
{
    if (value >= min && value <= max)
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "%s: whole number %lld .. %lld expected, got %lld", name, (long long)min,
                      (long long)max, (long long)value);
}

glint_status glint_check_vector(const char *name, const double v[3], glint_error *error)
{
    if (isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]))
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "%s: finite numbers expected, got {%.15g, %.15g, %.15g}", name, v[0],
                      v[1], v[2]);
}

glint_status glint_check_direction(const char *name, const double v[3], glint_error *error)
{
    glint_status status = glint_check_vector(name, v, error);
    if (status || v[0] != 0 || v[1] != 0 || v[2] != 0)
        return status;
    return glint_fail(error, GLINT_ERR_INVALID, "%s: vector that is not zero expected, got {0, 0, 0}", name);
}

glint_status glint_check_color(const char *name, const double v[3], glint_error *error)
{
    glint_status status = glint_check_vector(name, v, error);
    if (status || (v[0] >= 0 && v[1] >= 0 && v[2] >= 0))
        return status;
    return glint_fail(error, GLINT_ERR_INVALID, "%s: colour >= 0 expected, got {%.15g, %.15g, %.15g}", name, v[0], v[1],
                      v[2]);
}
