/// Reads numbers from text with a decimal point, whatever locale the process uses.
#ifndef GLINT_BASE_NUMBER_H
#define GLINT_BASE_NUMBER_H

#include <locale.h>
#ifdef __APPLE__
#include <xlocale.h> // locale_t is there
#endif

/// Calls strtod in the locale `c`, made by newlocale(LC_ALL_MASK, "C", 0). The thread's locale is unchanged
/// afterwards.
double glint_read_double(const char *text, char **end, locale_t c);

#endif
