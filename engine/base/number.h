/// Reads and writes numbers with a decimal point, whatever locale the process uses.
#ifndef GLINT_BASE_NUMBER_H
#define GLINT_BASE_NUMBER_H

#include <stdarg.h>
#include <stddef.h>

/// Does what strtod does in the locale C.
double glint_read_double(const char *text, char **end);

/// Do what snprintf and vsnprintf do in the locale C.
__attribute__((format(printf, 3, 4))) int glint_print(char *out, size_t size, const char *format, ...);
int glint_print_list(char *out, size_t size, const char *format, va_list list);

#endif
