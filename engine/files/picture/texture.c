/// Textures from picture files.
#include "engine/base/status.h"
#include "engine/files/picture/exr.h"
#include "engine/files/picture/file.h"
#include "engine/files/picture/hdr.h"
#include "engine/files/picture/jpeg.h"
#include "engine/files/picture/pfm.h"
#include "engine/files/picture/png.h"
#include "engine/film/tone.h"
#include "engine/glint_files.h"

#include <stdlib.h>
#include <string.h>

/// A picture as it was read: pixel values, or linear floats.
typedef struct picture {
    glint_png png;
    glint_pfm floats; ///< its `values` are NULL: `png` is the picture
    bool linear; ///< of `png`
    float *light; ///< the light of each pixel value of `png`
} picture;

// ---- Reading ------------------------------------------------------------------------------------------------------

/// The first bytes of other picture formats.
static const struct {
    size_t at;
    const char *begin, *kind;
} OTHERS[] = { { 0, "GIF8", "GIF" },       { 0, "BM", "BMP" },          { 0, "II*", "TIFF" },     { 0, "MM", "TIFF" },
               { 8, "WEBP", "WebP" },      { 0, "DDS ", "DDS" },        { 0, "8BPS", "Photoshop" },
               { 4, "jP  ", "JPEG 2000" },  { 4, "ftypavif", "AVIF" },  { 4, "ftyphei", "HEIF" }, { 0, "<", "SVG or another XML" }, { 0, "qoif", "QOI" },
               { 0, "P3", "PPM" },         { 0, "P5", "PGM" },          { 0, "P6", "PPM" } };

/// Refuses a picture of another format, and names the format.
static glint_status refuse_other(const glint_bytes *bytes, glint_error *error)
{
    for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++) {
        const size_t length = strlen(OTHERS[i].begin);
        if (bytes->size >= OTHERS[i].at + length && memcmp(bytes->data + OTHERS[i].at, OTHERS[i].begin, length) == 0)
            return glint_fail(error, GLINT_ERR_FORMAT, "is %s; textures are .png, .jpg, .hdr, .exr or .pfm", OTHERS[i].kind);
    }
    return GLINT_OK;
}

/// Decodes a picture of floats. *known is whether the bytes begin like one.
static glint_status decode_floats(const glint_bytes *bytes, glint_pfm *out, bool *known, glint_error *error)
{
    glint_status status = GLINT_OK;
    *known = true;
    if (glint_is_hdr(bytes->data, bytes->size))
        status = glint_hdr_decode(bytes->data, bytes->size, GLINT_TEXELS_MAX, out, error);
    else if (glint_is_exr(bytes->data, bytes->size))
        status = glint_exr_decode(bytes, GLINT_TEXELS_MAX, out, error);
    else if (glint_is_pfm(bytes->data, bytes->size))
        status = glint_pfm_decode(bytes->data, bytes->size, out, error);
    else
        *known = false;
    return status;
}

static glint_status decode(const glint_bytes *bytes, picture *out, glint_error *error)
{
    glint_png_head head;
    bool known;
    if (glint_is_jpeg(bytes->data, bytes->size))
        return glint_jpeg_decode(bytes->data, bytes->size, GLINT_TEXELS_MAX, &out->png, error);
    glint_status status = decode_floats(bytes, &out->floats, &known, error);
    if (status || known)
        return status;
    status = refuse_other(bytes, error);
    if (!status)
        status = glint_png_scan(bytes->data, bytes->size, &head, NULL, NULL, error);
    if (status)
        return status;
    if ((size_t)head.width * (size_t)head.height > GLINT_TEXELS_MAX)
        return glint_fail(error, GLINT_ERR_FORMAT, "a picture of at most %zu pixels expected, got %d x %d", GLINT_TEXELS_MAX,
                          head.width, head.height);
    out->linear = out->linear || head.transfer == GLINT_TRANSFER_LINEAR;
    return glint_png_decode(bytes->data, bytes->size, &out->png, error);
}

// ---- Rows ---------------------------------------------------------------------------------------------------------

/// Returns the linear light of each pixel value. NULL: out of memory.
static float *decoding(const glint_png *png, bool linear)
{
    const int last = png->bits == 16 ? 65535 : 255;
    float *table = malloc((size_t)(last + 1) * sizeof *table);
    for (int i = 0; table && i <= last; i++)
        table[i] = (float)(linear ? (double)i / last : glint_srgb_decode((double)i / last));
    return table;
}

static void copy_floats(void *context, int y, float *to)
{
    const glint_pfm *floats = &((const picture *)context)->floats;
    const size_t width = (size_t)floats->width, channels = (size_t)floats->channels;
    const float *from = floats->values + (size_t)y * width * channels;
    for (size_t i = 0; i < width; i++, from += channels, to += 4) {
        for (size_t c = 0; c < 3; c++)
            to[c] = from[channels == 3 ? c : 0];
        to[3] = 1;
    }
}

static void decode_codes(void *context, int y, float *to)
{
    const picture *from = context;
    const glint_png *png = &from->png;
    const size_t width = (size_t)png->width, channels = (size_t)png->channels, start = (size_t)y * width * channels;
    const bool gray = channels < 3, alpha = channels == 2 || channels == 4;
    const float most = png->bits == 16 ? 65535 : 255;
    for (size_t i = 0; i < width; i++, to += 4) {
        unsigned code[4] = { 0 };
        for (size_t c = 0; c < channels; c++)
            code[c] = png->bits == 16 ? ((const uint16_t *)png->codes)[start + i * channels + c]
                                      : ((const uint8_t *)png->codes)[start + i * channels + c];
        for (size_t c = 0; c < 3; c++)
            to[c] = from->light[code[gray ? 0 : c]];
        to[3] = alpha ? (float)code[channels - 1] / most : 1;
    }
}

static glint_status make(picture *from, const glint_texture_desc *how, glint_texture **out, glint_error *error)
{
    glint_texture_desc desc = *how;
    desc.struct_size = sizeof desc;
    const bool is_float = from->floats.values;
    desc.width = is_float ? from->floats.width : from->png.width;
    desc.height = is_float ? from->floats.height : from->png.height;
    desc.rgb = NULL;
    desc.row = is_float ? copy_floats : decode_codes;
    desc.context = from;
    from->light = is_float ? NULL : decoding(&from->png, from->linear);
    return is_float || from->light ? glint_texture_create(&desc, out, error) : glint_fail_nomem(error);
}

glint_status glint_texture_read(const char *path, const glint_texture_desc *given, glint_texture **out, glint_error *error)
{
    GLINT_REFUSE_NULL(path, error);
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_texture_desc, glint_texture_desc_default());
    picture from = { .linear = desc->linear };
    glint_bytes bytes = { 0 };
    glint_error inner;
    status = glint_file_read_picture(path, &bytes, error);
    if (status)
        return status;
    status = decode(&bytes, &from, &inner);
    free(bytes.data);
    if (!status)
        status = make(&from, desc, out, &inner);
    free(from.png.codes);
    free(from.floats.values);
    free(from.light);
    return status == GLINT_ERR_NOMEM ? glint_fail_nomem(error) :
           status ? glint_fail(error, status, "%.300s: %.200s", path, inner.message) : GLINT_OK;
}
