/// The fields that describe a frame and its file, each listed once. scene:render{}, animations and sweeps, the options
/// of the command with their help and completions, and the text entries of files are all generated from this list, in
/// its order.
#ifndef GLINT_L_RENDER_FIELDS_H
#define GLINT_L_RENDER_FIELDS_H

#include "engine/glint.h"

/// FIELD(name, kind, sort, member of glintL_render, least, most, words)
/// OPTION(the same, value, help): a field whose option has the same name and is described completely by this row.
/// `value` is the option's value in --help; "": the words; NULL: the option is a switch. The options of the other
/// fields are in bindings/command/options.c.
#define GLINTL_RENDER_LIST(FIELD, OPTION)                                                                               \
    FIELD(width, NUMBER, WHOLE, desc.width, 1, GLINT_SIDE_MAX, NULL)                                                    \
    FIELD(height, NUMBER, WHOLE, desc.height, 1, GLINT_SIDE_MAX, NULL)                                                  \
    OPTION(samples, NUMBER, WHOLE, desc.samples, 1, GLINTL_SAMPLES_MAX, NULL, "N", "samples per pixel")                       \
    OPTION(seed, NUMBER, WHOLE, desc.seed, 0, SEED_MAX, NULL, "N", "chooses another sample pattern")                   \
    OPTION(clamp, NUMBER, REAL, desc.clamp, 0, 1e9, NULL, "LIGHT", "most light that one random path brings; 0: no limit") \
    FIELD(max_depth, NUMBER, WHOLE, desc.max_depth, 0, DEPTH_MAX, NULL)                                                 \
    OPTION(bits, NUMBER, BITS, desc.tone.bits, 0, 0, NULL, "8|16", "bits of a colour channel")                         \
    OPTION(precision, CHOICE, CHOICE, desc.precision, 0, 0, precisions, "", "precision of hits and shadows")           \
    OPTION(transfer, CHOICE, CHOICE, desc.tone.transfer, 0, 0, transfers, "", "encoding of linear light in pixels")    \
    OPTION(rounding, CHOICE, CHOICE, desc.tone.rounding, 0, 0, roundings, "", "rounding to pixel values")              \
    OPTION(tone, CHOICE, CHOICE, desc.tone.curve, 0, 0, glintL_tone_curves, "", "tone curve for bright light")         \
    OPTION(dither, FLAG, FLAG, desc.tone.dither, 0, 0, NULL, NULL, "ordered dithering of 8-bit pixel values")            \
    OPTION(encode, CHOICE, CHOICE, encode, 0, 0, encodes, "", "compression: fast to write or small on disk")           \
    FIELD(colormap, CHOICE, COLORS, colormap, 0, 0, glintL_pass_colormaps)                                                \
    FIELD(dpi, NUMBER, REAL, dpi, 0, 1e6, NULL)                                                                         \
    FIELD(output, TEXT, OUTPUT, output, 0, 0, NULL)                                                                   \
    FIELD(passes, TEXT, PASSES, file_passes, 0, 0, NULL)                                                              \
    FIELD(exposure, NUMBER, REAL, desc.tone.exposure, -GLINT_EXPOSURE_MAX, GLINT_EXPOSURE_MAX, NULL)                    \
    OPTION(alpha, FLAG, FLAG, desc.alpha, 0, 0, NULL, NULL, "transparent background")                                \
    OPTION(outline, CHOICE, CHOICE, desc.outline, 0, 0, outlines, "", "lines where objects end or have an edge")          \
    OPTION(visibility, CHOICE, CHOICE, desc.visibility, 0, 0, visibilities, "",                                           \
           "how visible surfaces are found; the pictures are the same")                                                \
    FIELD(adaptive, NUMBER, REAL, desc.adaptive, 0, 3, NULL)                                                            \
    FIELD(region, TEXT, REGION, desc.region, 0, 0, NULL)                                                                \
    FIELD(orbit, TEXT, ORBIT, orbit, 0, 0, NULL)

#endif
