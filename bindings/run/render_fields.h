/// The fields that describe a frame and its file, each listed once. scene:render{}, animations and sweeps, the options
/// of the command with their help and completions, and the text entries of files are all generated from this list, in
/// its order.
#ifndef GLINT_L_RENDER_FIELDS_H
#define GLINT_L_RENDER_FIELDS_H

#include "engine/glint_files.h"

/// A view turned by hand; see orbit.c. All 0: not turned.
typedef struct glintL_orbit {
    bool is_allowed; ///< a page may turn the view
    double yaw, pitch; ///< degrees to the right and up
    double zoom; ///< the distance to the target is divided by it, > 0; 0: as 1
    double right, up; ///< shift of the picture, in its heights
} glintL_orbit;

/// The fields of scene:render{}, of animations and of sweeps that describe a frame and its file.
typedef struct glintL_render {
    glint_render_desc desc;
    char output[4096]; ///< "": not given
    glint_encode encode;
    int colormap; ///< colour map of the passes depth and d:NAME: 1 + a glint_colormap; 0: grey
    double range[2]; ///< range of the colormap: see glint_write_desc
    double dpi; ///< pixels per inch; 0: not given
    uint32_t file_passes; ///< passes written to files in addition to beauty: bits 1u << GLINT_PASS_...
    char derivative[GLINT_DERIVATIVES_MAX][GLINT_DERIVATIVE_NAME_SIZE]; ///< names of the passes d:NAME to write
    int derivative_count;
    char light_passes[4096]; ///< names of the passes light:NAME to write, separated by commas; see glintL_render_point
    glintL_orbit orbit;
    double own_samples; ///< samples of a pixel before the limits of a preview
} glintL_render;

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
    OPTION(rays, NUMBER, WHOLE, desc.rays, 0, GLINTL_SAMPLES_MAX, NULL, "N", "most rays of each kind from a sample; 0: no limit") \
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
