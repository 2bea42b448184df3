/// The structure of glint_picture, shared by the files that read pictures. Internal.
#ifndef GLINT_IMAGE_PICTURE_H
#define GLINT_IMAGE_PICTURE_H

#include "engine/glint_types.h"
#include "engine/glint_files.h"

/// Returns the decoded pixel values of a .png, uint8_t or uint16_t (native order), interleaved, top row first. NULL: a
/// .pfm, or the pixels were not read.
const void *glint_picture_codes(const glint_picture *picture);

#endif
