/// libpng callbacks for writing a PNG. libpng jumps to png_jmpbuf when something fails. Internal.
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

/// Treats every warning as an error. The arguments are checked, so a warning can only mean that memory is short, and
/// the file would lack a text.
static inline void glint_png_warn(png_structp png, png_const_charp message)
{
    if (strstr(message, "emory"))
        glint_png_fail(png, message);
}

#endif
