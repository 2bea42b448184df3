/// Reads decimal numbers from text. Internal.
#ifndef GLINT_DATA_DECIMAL_H
#define GLINT_DATA_DECIMAL_H

#include <stdbool.h>
#include <stddef.h>

/// Returns the double nearest to a text such as -1.5, 3e-7, 1.5D+03 or 1.5-103; independent of the locale. False: the
/// text is something else, or has more than 800 characters.
bool glint_read_decimal(const char *text, size_t length, double *out);

#endif
