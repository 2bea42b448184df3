/// The rendered picture: float planes of the requested passes, and integer pixel values. Internal.
#ifndef GLINT_IMAGE_IMAGE_H
#define GLINT_IMAGE_IMAGE_H

#include "engine/base/hash.h"
#include "engine/film/codes.h"
#include "engine/film/cover.h"
#include "engine/glint.h"
#include "engine/glint_programs.h"

#include <stdatomic.h>

#define GLINT_PLANE_COUNT (GLINT_PASS_COUNT + GLINT_DERIVATIVES_MAX) ///< passes and derivatives

/// The stamp of one tile's pixels.
typedef struct glint_film_stamp {
    glint_key key; ///< key of the pixels' inputs: equal keys mean equal pixels; all zero: unknown
    uint64_t codes; ///< stamp of the pixel values: equal stamps in two images of one size and tone mean equal values; 0:
        ///< unknown
    uint64_t base; ///< stamp for adaptive sampling. If this image is a base: equal stamps in two images of one size
                   ///< mean equal pixels. If it was made from a base: equal stamps mean that the bases have equal
                   ///< pixels and that the same pixels were refined. 0: unknown, or neither
} glint_film_stamp;

struct glint_image {
    atomic_int references;
    int width, height;
    float *plane[GLINT_PLANE_COUNT][3]; ///< width * height values, top row first, 64-byte aligned; NULL: not stored.
        ///< Passes of one channel have only [0]
    void *codes; ///< channels * width * height pixel values, uint8_t or uint16_t (native order), interleaved; NULL: none
    bool alpha; ///< beauty is light times coverage; an image with beauty then also has the pass `alpha`
    glint_outline_color outline; ///< colour of the outline, drawn over beauty in a PNG; then the image has the pass
        ///< `outline`
    char derivative[GLINT_DERIVATIVES_MAX][GLINT_DERIVATIVE_NAME_SIZE]; ///< names; "": unused
    float *(*light)[3]; ///< planes of the light passes, `light_count` of them; NULL: none. Owned, with their names
    char (*light_name)[GLINT_NAME_SIZE];
    size_t light_count;
    uint32_t *shadows; ///< for derivatives that move shadows, one number per pixel. In pixels with equal numbers, all
        ///< samples have the same set of occluded lights and, if shapes or the eye move, see the same surface. 0: the
        ///< samples of the pixel differ. NULL: not stored. Owned
    int channels; ///< channels of codes: 3: RGB; 4: RGBA
    glint_tone_desc code_tone; ///< the tone that made the codes
    double exposure; ///< exposure of the frame's tone, with or without codes
    glint_film_stamp *film; ///< one stamp for each tile, left to right, top to bottom; may be NULL. Owned
    uint64_t *row_stamp; ///< one stamp for every GLINT_TILE_HEIGHT rows of codes, top first; NULL: no codes. Equal
        ///< stamps in two images of one size and tone mean equal codes in these rows; 0: unknown
    glint_image *under; ///< the image without overlays, whose planes and codes this one shares; NULL: none. Owned
    glint_cover *cover; ///< overlays to draw over beauty in a PNG; NULL: none. Owned
    int part_x, part_y; ///< position of the first pixel in the whole picture, for overlays and dithering
};

/// Returns how many rows of tiles an image has: the number of its stamps.
static inline size_t glint_image_stamps(const glint_image *image)
{
    return ((size_t)image->height + GLINT_TILE_HEIGHT - 1) / GLINT_TILE_HEIGHT;
}

#define GLINT_PLANE_NAME_SIZE (GLINT_NAME_SIZE + 6) ///< bytes of a pass's name, including the NUL

/// Returns the name of a pass: "ambient", "d:lamp_x" for a derivative, "light:key" for a light pass. NULL: no such
/// pass.
const char *glint_plane_name(const glint_image *image, glint_pass pass, char buffer[GLINT_PLANE_NAME_SIZE]);

/// How a picture shows a pass, see GLINT_PASSES.
typedef enum glint_pass_look {
    GLINT_LOOK_LIGHT,
    GLINT_LOOK_SHARE,
    GLINT_LOOK_DEPTH,
    GLINT_LOOK_NORMAL,
    GLINT_LOOK_OBJECT,
    GLINT_LOOK_DERIVATIVE
} glint_pass_look;
glint_pass_look glint_look_of(glint_pass pass);

/// Returns the planes of a pass, a derivative or a light pass; NULL for planes that are not stored.
float *const *glint_image_planes(const glint_image *image, glint_pass pass);

/// Returns the bytes of the planes and codes.
size_t glint_image_bytes(const glint_image *image);

/// Makes an image with one reference. Its planes and codes are not initialised; its stamps are 0.
///
/// width, height  1 .. GLINT_SIDE_MAX, else GLINT_ERR_INVALID, before anything is allocated.
/// passes         bits 1u << GLINT_PASS_...
/// codes_tone     NULL: no codes.
/// Its codes have no alpha.
glint_status glint_image_create(int width, int height, uint32_t passes, const glint_tone_desc *codes_tone,
                                glint_image **out, glint_error *error);

/// Makes the image for a frame rendered with this description.
glint_status glint_image_create_for(const glint_render_desc *desc, glint_image **out, glint_error *error);

/// Adds light passes, not initialised, to an image that has none. On error only some are added; the image can still be
/// released.
glint_status glint_image_add_lights(glint_image *image, size_t count, const char (*names)[GLINT_NAME_SIZE], glint_error *error);

/// Copies a part of an image to a new image.
glint_status glint_image_crop(const glint_image *image, int x, int y, int width, int height, glint_image **out,
                              glint_error *error);

/// Makes an image of the same picture with overlays, and retains the overlays. x, y: position of the first pixel in the
/// whole picture. Takes over the reference to `under`, on error too.
glint_status glint_image_cover(glint_image *under, glint_cover *cover, int x, int y, glint_image **out,
                               glint_error *error);

/// Returns the bytes of one pixel's codes.
static inline size_t glint_image_pixel_bytes(const glint_image *image)
{
    return (size_t)image->channels * (image->code_tone.bits == 16 ? 2 : 1);
}

#endif
