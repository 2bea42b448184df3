/// The rendered picture: float planes of the requested passes, and integer codes. Internal.
#ifndef GLINT_IMAGE_IMAGE_H
#define GLINT_IMAGE_IMAGE_H

#include "engine/base/hash.h"
#include "engine/glint.h"
#include "engine/overlay/overlay.h"
#include "engine/stages/stages.h"

#include <stdatomic.h>

#define GLINT_PLANE_COUNT (GLINT_PASS_COUNT + GLINT_DERIVATIVES_MAX) ///< passes and derivatives

/// The stamp of one tile's pixels.
typedef struct glint_film_stamp {
    glint_key key; ///< key of their inputs. Equal keys mean equal pixels; all zero: unknown
    uint64_t codes; ///< equal in two images of one size and tone: equal codes; 0: unknown
    uint64_t base; ///< of a base of adaptive sampling: equal in two of one size, equal pixels; of the picture over it: equal pixels of
                   ///< the base, and the same of them chosen; 0: unknown, or neither
} glint_film_stamp;

struct glint_image {
    atomic_int references;
    int width, height;
    float *plane[GLINT_PLANE_COUNT][3]; ///< width * height values, top row first, 64-byte aligned; NULL: not kept.
        ///< One-channel passes have [0] only
    void *codes; ///< channels * width * height uint8_t or uint16_t (native order), interleaved; NULL: none
    bool alpha; ///< beauty is light times coverage, and the pass `alpha` is there wherever beauty is
    glint_outline_color outline; ///< drawn over beauty in a PNG; the pass `outline` is then there
    char derivative[GLINT_DERIVATIVES_MAX][GLINT_DERIVATIVE_NAME_SIZE]; ///< names; "": there is none
    float *(*light)[3]; ///< planes of its light passes, `light_count` of them; NULL: it has none. Owned, as their names
    char (*light_name)[GLINT_NAME_SIZE];
    size_t light_count;
    uint32_t *shadows; ///< of frames whose derivatives move shadows, a number a pixel: in equal ones the same lights are
        ///< kept from all samples or from none, and where shapes or the eye move the same surface is seen; 0: that differs among the samples. NULL: none. Owned
    int channels; ///< of codes: 3, RGB; with alpha 4
    glint_tone_desc code_tone; ///< how the codes were made
    double exposure; ///< of the frame's tone, with codes or without
    glint_film_stamp *film; ///< one a tile, left to right, top to bottom. may be NULL. Owned
    uint64_t *row_stamp; ///< one for every GLINT_TILE_HEIGHT rows of codes, top first; NULL: no codes. Equal stamps in
        ///< two images of one size and tone promise equal codes in these rows; 0 promises nothing
    glint_image *under; ///< that this one shows with its overlays, and whose planes and codes it shares; NULL: none. Owned
    glint_overlays *overlays; ///< drawn over beauty in a PNG; NULL: none. Owned
    int part_x, part_y; ///< where in the whole picture its first pixel is, which the overlays are placed in
};

/// Stamps of an image: how many rows of tiles it has.
static inline size_t glint_image_stamps(const glint_image *image)
{
    return ((size_t)image->height + GLINT_TILE_HEIGHT - 1) / GLINT_TILE_HEIGHT;
}

#define GLINT_PLANE_NAME_SIZE (GLINT_NAME_SIZE + 6) ///< bytes of the name of a pass, with the ending NUL

/// "ambient"; "d:lamp_x" of the image's derivatives, "light:key" of its light passes; NULL: there is no such pass.
const char *glint_plane_name(const glint_image *image, glint_pass pass, char room[GLINT_PLANE_NAME_SIZE]);

/// Returns the planes of a pass, a derivative or a light pass; NULL for planes that are not stored.
float *const *glint_image_planes(const glint_image *image, glint_pass pass);

/// Bytes of its planes and codes.
size_t glint_image_bytes(const glint_image *image);

/// Makes an image with one reference; its planes and codes are not initialised, its stamps are 0.
///
/// width, height  1 .. GLINT_SIDE_MAX, else GLINT_ERR_INVALID, before anything is allocated.
/// passes         bits 1u << GLINT_PASS_...
/// codes_tone     NULL: no codes.
/// Its codes have no alpha.
glint_status glint_image_create(int width, int height, uint32_t passes, const glint_tone_desc *codes_tone,
                                glint_image **out, glint_error *error);

/// The same for a frame that is rendered so.
glint_status glint_image_create_for(const glint_render_desc *desc, glint_image **out, glint_error *error);

/// Adds light passes to an image that has none, not initialised. On error they are incomplete, and the image good to be released.
glint_status glint_image_add_lights(glint_image *image, size_t count, const char (*names)[GLINT_NAME_SIZE], glint_error *error);

/// A part of an image as an image of its own.
glint_status glint_image_crop(const glint_image *image, int x, int y, int width, int height, glint_image **out,
                              glint_error *error);

/// The same picture with overlays, of which it takes references; x, y: where in the whole picture its first pixel is.
/// Takes over the reference to `under`, in case of an error too.
glint_status glint_image_cover(glint_image *under, glint_overlays *overlays, int x, int y, glint_image **out,
                               glint_error *error);

/// Bytes of one pixel's codes.
static inline size_t glint_image_pixel_bytes(const glint_image *image)
{
    return (size_t)image->channels * (image->code_tone.bits == 16 ? 2 : 1);
}

#endif
