/// One pass of an image as the bytes of a file. Internal.
#ifndef GLINT_IMAGE_WRITE_H
#define GLINT_IMAGE_WRITE_H

#include "engine/files/picture/bands.h"
#include "engine/files/picture/bytes.h"
#include "engine/glint_types.h"

typedef enum glint_file_kind {
    GLINT_FILE_PNG,
    GLINT_FILE_PFM,
    GLINT_FILE_NPY,
    GLINT_FILE_EXR,
    GLINT_FILE_SVG,
    GLINT_FILE_PDF
} glint_file_kind;

/// Finds the format from the extension of `path`, in upper or lower case; GLINT_ERR_INVALID names the path and the
/// allowed extensions.
glint_status glint_file_kind_of(const char *path, glint_file_kind *kind, glint_error *error);

/// The same for a file to read: .png and .pfm are allowed.
glint_status glint_file_kind_read(const char *path, glint_file_kind *kind, glint_error *error);

/// Appends the bytes that glint_image_write would write to `out`, which may have grown on failure. For bands and reused
/// see glint_png_encode; *reused is written only for PNG.
glint_status glint_image_encode(const glint_image *image, const glint_write_desc *desc, glint_bands *bands,
                                glint_bytes *out, double *reused, glint_error *error);

#endif
