/// glint relight: pictures and a page made of light passes. Private to bindings/.
#ifndef GLINT_RELIGHT_H
#define GLINT_RELIGHT_H

#include "bindings/command/cli.h"

/// What --light says of one light.
typedef struct relight_light {
    const char *name; ///< as it was written, `length` bytes of it
    size_t length;
    bool has_strength, has_color;
    double strength; ///< 1: as it is
    uint32_t color; ///< 0xRRGGBB, sRGB; white: as it is
} relight_light;

typedef struct relight_mix {
    relight_light *lights; ///< owned
    size_t count;
    glint_tone_desc tone;
} relight_mix;

/// The mix of light number `index` of an image; a neutral one where nothing was said of it.
relight_light relight_light_at(const relight_mix *mix, const glint_image *image, size_t index);

/// mixer.c: writes the page of one file. Returns the exit code; the message says what failed.
int relight_write_page(const cli_options *options, const relight_mix *mix, const char *file, const glint_image *image,
                       char message[GLINTL_MESSAGE_SIZE]);

#endif
