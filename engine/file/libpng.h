/// Callbacks of libpng for writing a PNG. It jumps to png_jmpbuf when something fails. Internal.
#ifndef GLINT_FILE_LIBPNG_H
#define GLINT_FILE_LIBPNG_H

#include <png.h>
#include <setjmp.h>
#include <string.h>

static inline void glint_png_flush(png_structp png) { (void)png; }

static inline void glint_png_fail(png_structp png, png_const_charp message)
{
    (void)message;
    png_longjmp(png, 1);
}

/// Arguments are checked, so that a warning too can only mean that memory is short: no file without its text.
static inline void glint_png_warn(png_structp png, png_const_charp message)
{
    if (strstr(message, "emory"))
        glint_png_fail(png, message);
}

#endif
