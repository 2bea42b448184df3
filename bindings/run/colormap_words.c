// The range in the text of a colour map: "viridis:1:9".
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bindings/run/run.h"

// Reads a finite number after a colon; NULL: there is none.
static const char *read_end(const char *text, double *out)
{
    char *end;
    if (*text != ':')
        return NULL;
    *out = strtod(text + 1, &end);
    return end > text + 1 && isfinite(*out) ? end : NULL;
}

bool glintL_read_range(const char *text, double range[2], char message[GLINTL_MESSAGE_SIZE])
{
    double read[2] = { 0, 0 };
    const char *end = *text ? read_end(text, &read[0]) : text;
    end = *text && end ? read_end(end, &read[1]) : end;
    if (!end || *end || (*text && read[0] == read[1]))
        return glintL_complain(
            message, "NAME:LOW:HIGH with two numbers that differ expected, got '%.200s' after the name", text);
    range[0] = read[0];
    range[1] = read[1];
    return true;
}

void glintL_spell_colormap(int colormap, const double range[2], char out[64])
{
    const char *name = glintL_pass_colormaps[colormap];
    if (range[0] == range[1])
        snprintf(out, 64, "%s", name);
    else
        snprintf(out, 64, "%s:%.17g:%.17g", name, range[0], range[1]);
}
