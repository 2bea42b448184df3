/// Numbers of text, with decimal points whatever locale a script has set.
#ifndef GLINT_BASE_NUMBER_H
#define GLINT_BASE_NUMBER_H

#include <locale.h>
#ifdef __APPLE__
#include <xlocale.h> // locale_t is there
#endif

/// strtod in the locale `c`, which is that of newlocale(LC_ALL_MASK, "C", 0). The thread's locale is the same afterwards.
double glint_read_double(const char *text, char **end, locale_t c);

#endif
