#include "engine/base/number.h"

#include <locale.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#ifdef __APPLE__
#include <xlocale.h> // locale_t is there
#endif

static locale_t points; // never freed; 0: out of memory, and numbers follow the locale of the process

static void make_points(void) { points = newlocale(LC_ALL_MASK, "C", (locale_t)0); }

static locale_t points_locale(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_points);
    return points;
}

double glint_read_double(const char *text, char **end)
{
    const locale_t c = points_locale();
    if (!c)
        return strtod(text, end);
#if (defined(__linux__) && !defined(GLINT_PORTABLE)) || defined(__NetBSD__) // NetBSD has no uselocale
    return strtod_l(text, end, c);
#else
    const locale_t before = uselocale(c);
    const double number = strtod(text, end);
    uselocale(before);
    return number;
#endif
}

int glint_print_list(char *out, size_t size, const char *format, va_list list)
{
    const locale_t c = points_locale();
#ifdef __NetBSD__
    return c ? vsnprintf_l(out, size, c, format, list) : vsnprintf(out, size, format, list);
#else
    const locale_t before = c ? uselocale(c) : (locale_t)0;
    const int length = vsnprintf(out, size, format, list);
    if (c)
        uselocale(before);
    return length;
#endif
}

int glint_print(char *out, size_t size, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const int length = glint_print_list(out, size, format, list);
    va_end(list);
    return length;
}
