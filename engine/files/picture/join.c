/// glint_picture_join: joins the parts of a picture.
#include "engine/base/status.h"
#include "engine/files/picture/file.h"
#include "engine/files/picture/picture.h"
#include "engine/files/picture/png.h"

#include <stdlib.h>
#include <string.h>

typedef struct canvas {
    int width, height;
    size_t pixel; ///< bytes of one pixel
    uint8_t *codes, *filled; ///< filled: one byte per pixel
} canvas;

static glint_status check_part(const glint_picture_part *part, const glint_picture *first, size_t number,
                               const canvas *to, glint_error *error)
{
    const int channels = glint_picture_channels(part->picture), bits = glint_picture_bits(part->picture);
    if (!glint_picture_codes(part->picture) || (channels != 3 && channels != 4))
        return glint_fail(error, GLINT_ERR_INVALID, "parts[%zu]: a .png of three or four channels expected", number);
    if (channels != glint_picture_channels(first) || bits != glint_picture_bits(first))
        return glint_fail(error, GLINT_ERR_INVALID, "parts[%zu]: %d channels of %d bits expected, got %d of %d", number,
                          glint_picture_channels(first), glint_picture_bits(first), channels, bits);
    if (part->x < 0 || part->y < 0 || part->x > to->width - glint_picture_width(part->picture) ||
        part->y > to->height - glint_picture_height(part->picture))
        return glint_fail(error, GLINT_ERR_INVALID,
                          "parts[%zu]: a position within %d x %d expected, got %d, %d of %d x %d", number, to->width,
                          to->height, part->x, part->y, glint_picture_width(part->picture),
                          glint_picture_height(part->picture));
    return GLINT_OK;
}

/// Copies a part to its position, which must be empty.
static glint_status put_part(const glint_picture_part *part, size_t number, canvas *to, glint_error *error)
{
    const int width = glint_picture_width(part->picture), height = glint_picture_height(part->picture);
    const uint8_t *from = glint_picture_codes(part->picture);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, from += to->pixel) {
            const size_t at = (size_t)(part->y + y) * (size_t)to->width + (size_t)(part->x + x);
            if (to->filled[at] && memcmp(to->codes + at * to->pixel, from, to->pixel) != 0)
                return glint_fail(error, GLINT_ERR_INVALID,
                                  "parts[%zu]: it differs from an earlier part at pixel %d, %d", number, part->x + x,
                                  part->y + y);
            memcpy(to->codes + at * to->pixel, from, to->pixel);
            to->filled[at] = 1;
        }
    return GLINT_OK;
}

static glint_status check_whole(const canvas *to, glint_error *error)
{
    const size_t count = (size_t)to->width * (size_t)to->height;
    const uint8_t *hole = memchr(to->filled, 0, count);
    if (!hole)
        return GLINT_OK;
    const size_t at = (size_t)(hole - to->filled);
    return glint_fail(error, GLINT_ERR_INVALID, "parts: no part has pixel %zu, %zu of %d x %d", at % (size_t)to->width,
                      at / (size_t)to->width, to->width, to->height);
}

static const void *row_of_canvas(const void *user, int y, void *scratch)
{
    const canvas *from = user;
    (void)scratch;
    return from->codes + (size_t)y * (size_t)from->width * from->pixel;
}

static glint_status write_canvas(const canvas *from, const glint_picture *first, const glint_write_desc *desc,
                                 glint_error *error)
{
    glint_bytes bytes = { 0 };
    const glint_png_desc png = { desc->encode, desc->text, desc->text_count, desc->dpi };
    const glint_png_source source = { .width = from->width,
                                      .height = from->height,
                                      .alpha = glint_picture_channels(first) == 4,
                                      .tone = desc->tone,
                                      .row = row_of_canvas,
                                      .user = from };
    glint_status status = glint_png_encode(NULL, &source, &png, &bytes, NULL, error);
    if (!status)
        status = glint_file_write(desc->path, bytes.data, bytes.size, error);
    free(bytes.data);
    return status;
}

glint_status glint_picture_join(const glint_picture_part *parts, size_t count, int width, int height,
                                const glint_write_desc *given, glint_error *error)
{
    GLINT_REFUSE_NULL(parts, error);
    GLINT_TAKE_DESC(glint_write_desc, { 0 });
    if (!count)
        return glint_fail(error, GLINT_ERR_INVALID, "parts: one or more expected");
    status = glint_check_whole("width", width, 1, GLINT_SIDE_MAX, error);
    if (!status)
        status = glint_check_whole("height", height, 1, GLINT_SIDE_MAX, error);
    if (status)
        return status;
    const glint_picture *first = parts[0].picture;
    canvas to = { .width = width, .height = height };
    const size_t pixels = (size_t)width * (size_t)height;
    to.pixel = (size_t)glint_picture_channels(first) * (glint_picture_bits(first) == 16 ? 2 : 1);
    for (size_t i = 0; i < count && !status; i++)
        status = check_part(&parts[i], first, i + 1, &to, error);
    if (!status && (!(to.codes = malloc(pixels * to.pixel)) || !(to.filled = calloc(pixels, 1))))
        status = glint_fail_nomem(error);
    for (size_t i = 0; i < count && !status; i++)
        status = put_part(&parts[i], i + 1, &to, error);
    if (!status)
        status = check_whole(&to, error);
    if (!status)
        status = write_canvas(&to, first, desc, error);
    free(to.codes);
    free(to.filled);
    return status;
}
