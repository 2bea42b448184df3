/// Reading the channels of an OpenEXR file. Internal to file/; only for builds with the library.
#ifndef GLINT_IMAGE_EXR_CHUNKS_H
#define GLINT_IMAGE_EXR_CHUNKS_H

#include "engine/glint.h"

#include <openexr.h>

/// Where the values of channels are stored.
typedef struct glint_exr_planes {
    float **plane; ///< for each channel of the file, where to store its value of the upper left pixel; NULL: not needed
    size_t stride; ///< floats from one pixel to the next
} glint_exr_planes;

/// Returns how a context reads a file: without messages, because the caller returns the status.
exr_context_initializer_t glint_exr_reader(void);

/// Returns the channels and the size of the first part, that is, of its display window. GLINT_ERR_FORMAT: the part is
/// deep, or one of its windows has more than `most` pixels.
glint_status glint_exr_open(exr_context_t context, size_t most, const exr_attr_chlist_t **channels, int *width,
                            int *height, glint_error *error);
/// Reads the channels of the first part, scan lines or tiles, after glint_exr_open. Values outside the data window are
/// 0.
glint_status glint_exr_read(exr_context_t context, const glint_exr_planes *to, glint_error *error);

#endif
