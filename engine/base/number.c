#include "engine/base/number.h"

#include <stdlib.h>

double glint_read_double(const char *text, char **end, locale_t c)
{
#if (defined(__linux__) && !defined(GLINT_PORTABLE)) || defined(__NetBSD__) // NetBSD has no uselocale
    return strtod_l(text, end, c);
#else
    const locale_t before = uselocale(c);
    const double number = strtod(text, end);
    uselocale(before);
    return number;
#endif
}
