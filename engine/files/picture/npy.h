/// NPY: NumPy's arrays, format 1.0. Internal.
#ifndef GLINT_IMAGE_NPY_H
#define GLINT_IMAGE_NPY_H

#include "engine/files/picture/bytes.h"

/// Appends height x width x channels little-endian float32, top row first, with the values that a .pfm has.
///
/// plane     channels (1 or 3) pointers to width * height values, top row first.
/// False: out of memory.
bool glint_npy_encode(int width, int height, int channels, float *const plane[], glint_bytes *out);

#endif
