/// glint relight: pictures and a page made from light passes. Private to bindings/.
#ifndef GLINT_RELIGHT_H
#define GLINT_RELIGHT_H

#include "bindings/command/cli.h"

/// The settings of --light for one light.
typedef struct relight_light {
    const char *name; ///< name as written in the option, `length` bytes
    size_t length;
    bool has_strength, has_color;
    double strength; ///< 1: unchanged
    uint32_t color; ///< 0xRRGGBB, sRGB; white: unchanged
} relight_light;

typedef struct relight_mix {
    relight_light *lights; ///< owned
    size_t count;
    glint_tone_desc tone;
} relight_mix;

/// Returns the mix of light number `index` of an image; a neutral one if --light does not name the light.
relight_light relight_light_at(const relight_mix *mix, const glint_image *image, size_t index);

/// mixer.c: writes the page in one file. Returns the exit code; the message says what failed.
int relight_write_page(const cli_options *options, const relight_mix *mix, const char *file, const glint_image *image,
                       char message[GLINTL_MESSAGE_SIZE]);

#endif
