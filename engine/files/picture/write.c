#include "engine/files/picture/write.h"

#include "engine/base/status.h"
#include "engine/figures/ink/stamps.h"
#include "engine/figures/overlay/overlay.h"
#include "engine/files/picture/exr.h"
#include "engine/files/vector/figure.h"
#include "engine/files/picture/file.h"
#include "engine/files/picture/npy.h"
#include "engine/files/picture/pfm.h"
#include "engine/files/picture/png.h"
#include "engine/film/image.h"
#include "engine/film/tone.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/// The source of a row of pixel values.
typedef struct picture {
    const glint_image *image;
    float *const *plane;
    glint_tone_desc tone; ///< the tone of the file
    const glint_tone_table *table; ///< the tone table, for colour passes
    const float *alpha; ///< the coverage, for colour passes with alpha; otherwise NULL
    float gain; ///< for colour passes: the factor of light, see glint_tone_gain
    double nearest; ///< the smallest depth of the image
    double steepest; ///< the largest absolute slope of the image
    double range[2]; ///< for depth and slopes: the values at both ends of the colour scale; if equal, `nearest` and
        ///< `steepest` set the ends
    const uint32_t *map; ///< for depth and slopes: colours 0xrrggbb for 0 .. 1; NULL: greys
    const void *(*under)(const void *user, int y, void *scratch); ///< if there are outlines: returns the rows without
        ///< them
    const void *(*plain)(const void *user, int y, void *scratch); ///< if there are overlays: returns the rows without
        ///< them
    glint_stamps stamps; ///< the overlays
} picture;

/// Returns whether `path` is a pipe or a device. PNG is written there if the name has no known ending.
static bool is_special_file(const char *path)
{
    struct stat info;
    return path && stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

/// Finds the format of an ending. False: unknown ending.
static bool kind_by_ending(const char *path, glint_file_kind *kind)
{
    static const char *const endings[] = {
        [GLINT_FILE_PNG] = ".png", [GLINT_FILE_PFM] = ".pfm", [GLINT_FILE_NPY] = ".npy",
        [GLINT_FILE_EXR] = ".exr", [GLINT_FILE_SVG] = ".svg", [GLINT_FILE_PDF] = ".pdf"
    };
    const char *ending = path ? strrchr(path, '.') : NULL;
    for (size_t i = 0; ending && i < sizeof endings / sizeof *endings; i++)
        if (strcasecmp(ending, endings[i]) == 0) {
            *kind = (glint_file_kind)i;
            return true;
        }
    *kind = GLINT_FILE_PNG;
    return is_special_file(path);
}

glint_status glint_file_kind_of(const char *path, glint_file_kind *kind, glint_error *error)
{
    if (kind_by_ending(path, kind))
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "path: name ending in .png, .svg, .pdf, .pfm, .npy or .exr expected, got '%.400s'",
                      path ? path : "");
}

glint_status glint_file_kind_read(const char *path, glint_file_kind *kind, glint_error *error)
{
    if (kind_by_ending(path, kind) && (*kind == GLINT_FILE_PNG || *kind == GLINT_FILE_PFM))
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "path: name ending in .png or .pfm expected, got '%.400s'",
                      path ? path : "");
}

// ---- Rows of codes ------------------------------------------------------------------------------------------------

static const void *row_of_codes(const void *user, int y, void *scratch)
{
    (void)scratch;
    const picture *p = user;
    return (const uint8_t *)p->image->codes + (size_t)y * (size_t)p->image->width * glint_image_pixel_bytes(p->image);
}

/// Makes a row of light; a row of beauty has alpha if the picture has it.
static const void *row_of_color(const void *user, int y, void *scratch)
{
    const picture *p = user;
    const int first[2] = { p->image->part_x, p->image->part_y + y };
    size_t width = (size_t)p->image->width, at = (size_t)y * width;
    const float *const rgb[3] = { p->plane[0] + at, p->plane[1] + at, p->plane[2] + at };
    glint_tone_row(p->table, p->gain, rgb, p->alpha ? p->alpha + at : NULL, first, width, scratch, NULL);
    return scratch;
}

/// Stores `value` (0 .. 1) as linear pixel value number `at` of a row.
static void put_linear(const picture *p, void *codes, size_t at, double value)
{
    double x = value > 0 ? value < 1 ? value : 1 : 0;
    if (p->tone.bits == 16)
        ((uint16_t *)codes)[at] = (uint16_t)(x * 65535 + 0.5);
    else
        ((uint8_t *)codes)[at] = (uint8_t)(x * 255 + 0.5);
}

/// Makes a row of beauty with its outlines, which are opaque.
static const void *row_of_outlined(const void *user, int y, void *scratch)
{
    const picture *p = user;
    const size_t width = (size_t)p->image->width, channels = p->image->alpha ? 4 : 3, size = p->tone.bits / 8;
    const float *line = p->image->plane[GLINT_PASS_OUTLINE][0] + (size_t)y * width;
    const void *row = p->under(user, y, scratch);
    const int ink = p->image->outline == GLINT_OUTLINE_WHITE ? 0xff : 0;
    uint8_t *out = scratch;
    if (row != scratch)
        memcpy(scratch, row, width * channels * size);
    for (size_t x = 0; x < width; x++) {
        if (line[x] == 0)
            continue;
        memset(out + x * channels * size, ink, 3 * size);
        if (channels == 4)
            memset(out + (x * channels + 3) * size, 0xff, size);
    }
    return scratch;
}

/// Makes a row of beauty with its overlays.
static const void *row_of_covered_up(const void *user, int y, void *scratch)
{
    const picture *p = user;
    const glint_image *image = p->image;
    const size_t channels = image->alpha ? 4 : 3;
    const void *row = p->plain(user, y, scratch);
    if (row != scratch)
        memcpy(scratch, row, (size_t)image->width * channels * (size_t)p->tone.bits / 8);
    glint_stamps_row(&p->stamps, image->part_x, image->part_y + y, image->width, (int)channels, scratch);
    return scratch;
}

/// Makes a row of shares, 0 .. 1.
static const void *row_of_shares(const void *user, int y, void *scratch)
{
    const picture *p = user;
    size_t width = (size_t)p->image->width;
    const float *share = p->plane[0] + (size_t)y * width;
    for (size_t x = 0; x < width; x++)
        for (size_t c = 0; c < 3; c++)
            put_linear(p, scratch, 3 * x + c, share[x]);
    return scratch;
}

/// Stores a number (0 .. 1) as a pixel: a linear grey, or its sRGB colour in the map.
static void put_number(const picture *p, void *codes, size_t x, double value)
{
    const uint32_t color = p->map ? p->map[(int)(fmin(fmax(value, 0), 1) * 255 + 0.5)] : 0;
    for (size_t c = 0; c < 3; c++)
        put_linear(p, codes, 3 * x + c, p->map ? (color >> (16 - 8 * c) & 255) / 255.0 : value);
}

static bool has_range(const picture *p) { return p->range[0] != p->range[1]; }

static double share_of(const picture *p, double value) { return (value - p->range[0]) / (p->range[1] - p->range[0]); }

/// Makes a row of depth. Without a range, brightness is the nearest distance over the distance: white at the nearest
/// point, half as bright at twice its distance. A far horizon then leaves contrast to the objects in front. The
/// background, at infinity, is black.
static const void *row_of_depth(const void *user, int y, void *scratch)
{
    const picture *p = user;
    size_t width = (size_t)p->image->width;
    const float *depth = p->plane[0] + (size_t)y * width;
    for (size_t x = 0; x < width; x++) {
        double value = has_range(p) ? share_of(p, depth[x]) : depth[x] > 0 ? p->nearest / depth[x] : 1;
        if ((p->map || has_range(p)) && isinf(depth[x]))
            for (size_t c = 0; c < 3; c++)
                put_linear(p, scratch, 3 * x + c, 0);
        else
            put_number(p, scratch, x, value);
    }
    return scratch;
}

static const void *row_of_normals(const void *user, int y, void *scratch)
{
    const picture *p = user;
    size_t width = (size_t)p->image->width, at = (size_t)y * width;
    for (size_t x = 0; x < width; x++) {
        bool background = p->plane[0][at + x] == 0 && p->plane[1][at + x] == 0 && p->plane[2][at + x] == 0;
        for (size_t c = 0; c < 3; c++)
            put_linear(p, scratch, 3 * x + c, background ? 0 : p->plane[c][at + x] * 0.5 + 0.5);
    }
    return scratch;
}

/// Maps 24 bits one to one, 0 to 0, by invertible steps: odd multipliers and shifts.
static uint32_t color_of_id(uint32_t id)
{
    uint32_t h = id & 0xffffff;
    h = h * 0x9e3779b1u & 0xffffff;
    h ^= h >> 12;
    h = h * 0x85ebcbu & 0xffffff;
    return h ^ h >> 13;
}

static const void *row_of_ids(const void *user, int y, void *scratch)
{
    const picture *p = user;
    size_t width = (size_t)p->image->width;
    const float *id = p->plane[0] + (size_t)y * width;
    for (size_t x = 0; x < width; x++) {
        uint32_t color = id[x] >= 0 && id[x] < 0x1p32f ? color_of_id((uint32_t)id[x]) : 0;
        for (size_t c = 0; c < 3; c++)
            put_linear(p, scratch, 3 * x + c, (double)(color >> (8 * c) & 255) / 255);
    }
    return scratch;
}

/// Makes a row of signed values. Without a range: grey at 0, black and white at the largest slope of either sign.
static const void *row_of_slopes(const void *user, int y, void *scratch)
{
    const picture *p = user;
    const size_t width = (size_t)p->image->width, at = (size_t)y * width;
    for (size_t x = 0; x < width; x++) {
        double mean = 0;
        for (size_t c = 0; c < 3; c++) {
            const double slope = p->plane[c][at + x];
            mean += slope / 3;
            put_linear(p, scratch, 3 * x + c, has_range(p) ? share_of(p, slope) : 0.5 + 0.5 * slope / p->steepest);
        }
        if (p->map)
            put_number(p, scratch, x, has_range(p) ? share_of(p, mean) : 0.5 + 0.5 * mean / p->steepest);
    }
    return scratch;
}

// ---- Sources of rows ----------------------------------------------------------------------------------------------

static void find_nearest(picture *p)
{
    size_t count = (size_t)p->image->width * (size_t)p->image->height;
    p->nearest = HUGE_VAL;
    for (size_t i = 0; i < count; i++)
        p->nearest = p->plane[0][i] < p->nearest ? p->plane[0][i] : p->nearest;
    if (isinf(p->nearest))
        p->nearest = 0; // only background
}

static void find_steepest(picture *p)
{
    const size_t count = (size_t)p->image->width * (size_t)p->image->height;
    p->steepest = DBL_MIN; // so that a picture without any change is all grey
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < count; i++)
            p->steepest = fabs(p->plane[c][i]) > p->steepest ? fabs(p->plane[c][i]) : p->steepest;
}

static glint_status fail_not_stored(const glint_image *image, glint_pass pass, glint_error *error)
{
    if (pass == GLINT_PASS_BEAUTY && image->codes)
        return glint_fail(error, GLINT_ERR_INVALID, "tone: the image holds pixel values of another tone curve, and "
                                                    "no 'beauty' pass");
    if (pass >= GLINT_PASS_LIGHT)
        return glint_fail(error, GLINT_ERR_INVALID, "pass: this image has no light pass number %d", (int)pass - GLINT_PASS_LIGHT);
    if (pass >= GLINT_PASS_DERIVATIVE)
        return glint_fail(error, GLINT_ERR_INVALID, "pass: this image has no derivative number %d",
                          (int)pass - GLINT_PASS_DERIVATIVE);
    return glint_fail(error, GLINT_ERR_INVALID, "pass: '%s' is not stored in this image", glint_pass_name(pass));
}

/// Makes the marks of overlays. On success the caller closes the ink.
static glint_status open_ink(const glint_cover *cover, double dpi, glint_ink *ink, glint_error *error)
{
    const glint_overlays *overlays = (const glint_overlays *)cover;
    glint_status status = glint_ink_open(overlays->width, overlays->height, ink, error);
    if (status)
        return status;
    status = glint_overlays_draw(overlays, dpi, ink, error);
    if (status)
        glint_ink_close(ink);
    return status;
}

/// Makes the stamps of an image's overlays.
static glint_status make_stamps(picture *p, double dpi, glint_error *error)
{
    glint_ink ink;
    glint_status status = open_ink(p->image->cover, dpi, &ink, error);
    if (status)
        return status;
    status = glint_stamps_make(&ink, p->tone.transfer, p->tone.bits, &p->stamps, error);
    glint_ink_close(&ink);
    return status;
}

/// Draws the overlays into the rows. The stamps of the rows of tiles under an overlay become 0.
/// stamps  written: the new stamps of the source; the caller frees them.
static glint_status lay_over(picture *p, glint_png_source *source, double dpi, uint64_t **stamps, glint_error *error)
{
    const glint_image *image = p->image;
    const size_t count = glint_image_stamps(image);
    const glint_status status = make_stamps(p, dpi, error);
    if (status)
        return status;
    p->plain = source->row;
    source->row = row_of_covered_up;
    if (!source->stamp)
        return GLINT_OK;
    if (!(*stamps = malloc(count * sizeof **stamps)))
        return glint_fail_nomem(error);
    for (size_t i = 0; i < count; i++)
        (*stamps)[i] = glint_stamps_touch(&p->stamps, image->part_y + (int)i * GLINT_TILE_HEIGHT, GLINT_TILE_HEIGHT)
                           ? 0
                           : source->stamp[i];
    source->stamp = *stamps;
    return GLINT_OK;
}

/// The rows of a pass as pixel values. Valid while the store of tone tables is open.
typedef struct code_rows {
    picture picture;
    glint_png_source source; ///< `source.user` points to `picture`
    uint64_t *stamps; ///< owned
} code_rows;

/// Opens the rows of a pass, without overlays. The caller closes them, on failure too.
static glint_status open_plain_rows(const glint_image *image, const glint_write_desc *desc, code_rows *rows,
                                    glint_error *error)
{
    picture *p = &rows->picture;
    glint_png_source *source = &rows->source;
    glint_status status = glint_tone_check(&desc->tone, error);
    memset(rows, 0, sizeof *rows);
    glint_tone_store_open();
    if (status)
        return status;
    *p = (picture) { .image = image, .plane = glint_image_planes(image, desc->pass), .tone = desc->tone };
    *source = (glint_png_source) { .width = image->width, .height = image->height, .tone = desc->tone, .user = p };
    source->alpha = desc->pass == GLINT_PASS_BEAUTY && image->alpha;
    const glint_pass_look look = glint_look_of(desc->pass);
    if (desc->colormap && (look == GLINT_LOOK_DEPTH || look == GLINT_LOOK_DERIVATIVE))
        p->map = glint_colormap_table((glint_colormap)(desc->colormap - 1));
    memcpy(p->range, desc->range, sizeof p->range);
    if (look != GLINT_LOOK_LIGHT)
        source->tone.transfer = p->map ? GLINT_TRANSFER_SRGB : GLINT_TRANSFER_LINEAR;
    if (desc->pass == GLINT_PASS_BEAUTY && image->codes && glint_tone_same(&image->code_tone, &desc->tone)) {
        source->row = row_of_codes;
        source->stamp = image->row_stamp;
    } else if (!p->plane[0]) {
        return fail_not_stored(image, desc->pass, error);
    } else if (look == GLINT_LOOK_LIGHT) {
        status = glint_tone_table_shared(&desc->tone, &p->table, error);
        p->gain = glint_tone_gain(&desc->tone);
        p->alpha = source->alpha ? image->plane[GLINT_PASS_ALPHA][0] : NULL;
        source->row = row_of_color;
    } else if (look == GLINT_LOOK_DEPTH) {
        find_nearest(p);
        source->row = row_of_depth;
    } else if (look == GLINT_LOOK_DERIVATIVE) {
        find_steepest(p);
        source->row = row_of_slopes;
    } else if (look == GLINT_LOOK_SHARE) {
        source->row = row_of_shares;
    } else {
        source->row = look == GLINT_LOOK_NORMAL ? row_of_normals : row_of_ids;
    }
    if (desc->pass == GLINT_PASS_BEAUTY && image->outline) {
        p->under = source->row;
        source->row = row_of_outlined;
        source->stamp = NULL; // the stamps belong to the codes without lines
    }
    return status;
}

static bool has_overlays(const glint_image *image, const glint_write_desc *desc)
{
    return desc->pass == GLINT_PASS_BEAUTY && image->cover;
}

/// Opens the rows of a pass with its overlays. The caller closes them, on failure too.
static glint_status open_rows(const glint_image *image, const glint_write_desc *desc, code_rows *rows,
                              glint_error *error)
{
    glint_status status = open_plain_rows(image, desc, rows, error);
    if (!status && has_overlays(image, desc))
        status = lay_over(&rows->picture, &rows->source, desc->dpi, &rows->stamps, error);
    return status;
}

static void close_rows(code_rows *rows)
{
    glint_stamps_free(&rows->picture.stamps);
    free(rows->stamps);
    glint_tone_store_close();
}

static glint_status encode_png(const glint_image *image, const glint_write_desc *desc, glint_bands *bands,
                               glint_bytes *out, double *reused, glint_error *error)
{
    code_rows rows;
    const glint_png_desc png = { desc->encode, desc->text, desc->text_count, desc->dpi };
    glint_status status = open_rows(image, desc, &rows, error);
    if (!status)
        status = glint_png_encode(bands, &rows.source, &png, out, reused, error);
    close_rows(&rows);
    return status;
}

/// Encodes a .svg or .pdf.
static glint_status encode_figure(const glint_image *image, const glint_write_desc *desc, glint_file_kind kind, glint_bytes *out,
                                  glint_error *error)
{
    code_rows rows;
    glint_ink ink;
    glint_figure figure = { .source = &rows.source, .x = image->part_x, .y = image->part_y };
    const glint_png_desc png = { desc->encode, desc->text, desc->text_count, desc->dpi };
    glint_status status = open_plain_rows(image, desc, &rows, error);
    if (!status && has_overlays(image, desc)) {
        status = open_ink(image->cover, desc->dpi, &ink, error);
        figure.ink = status ? NULL : &ink;
    }
    if (!status)
        status = glint_figure_encode(&figure, kind, &png, out, error);
    if (figure.ink)
        glint_ink_close(&ink);
    close_rows(&rows);
    return status;
}

/// Copies a row of 8-bit codes as RGBA.
static void copy_rgba(const glint_png_source *source, const uint8_t *row, uint8_t *out)
{
    const size_t width = (size_t)source->width;
    if (source->alpha)
        memcpy(out, row, 4 * width);
    for (size_t x = 0; x < width && !source->alpha; x++) {
        for (size_t c = 0; c < 3; c++)
            out[4 * x + c] = row[3 * x + c];
        out[4 * x + 3] = 0xff;
    }
}

glint_status glint_image_rgba(const glint_image *image, const glint_write_desc *given, uint8_t *out, glint_error *error)
{
    GLINT_REFUSE_NULL(image, error);
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_write_desc, { 0 });
    code_rows rows;
    if (desc->tone.bits != 8)
        return glint_fail(error, GLINT_ERR_INVALID, "tone.bits: 8 expected, got %d", desc->tone.bits);
    if (!glint_pass_channels(desc->pass))
        return glint_fail(error, GLINT_ERR_INVALID, "pass: one of the %d passes expected, got %d", GLINT_PASS_COUNT,
                          (int)desc->pass);
    const size_t stride = 4 * (size_t)image->width;
    status = open_rows(image, desc, &rows, error);
    uint8_t *scratch = malloc(stride);
    for (int y = 0; y < image->height && !status && scratch; y++)
        copy_rgba(&rows.source, rows.source.row(rows.source.user, y, scratch), out + (size_t)y * stride);
    if (!status && !scratch)
        status = glint_fail_nomem(error);
    free(scratch);
    close_rows(&rows);
    return status;
}

glint_status glint_image_encode(const glint_image *image, const glint_write_desc *desc, glint_bands *bands,
                                glint_bytes *out, double *reused, glint_error *error)
{
    glint_file_kind kind = GLINT_FILE_PNG;
    glint_status status = glint_file_kind_of(desc->path, &kind, error);
    if (status)
        return status;
    int channels = glint_pass_channels(desc->pass);
    if (!channels)
        return glint_fail(error, GLINT_ERR_INVALID, "pass: one of the %d passes expected, got %d", GLINT_PASS_COUNT,
                          (int)desc->pass);
    if (desc->encode != GLINT_ENCODE_FAST && desc->encode != GLINT_ENCODE_SMALL)
        return glint_fail(error, GLINT_ERR_INVALID, "encode: fast or small expected, got %d", (int)desc->encode);
    if (!(desc->dpi >= 0 && desc->dpi <= 1e6))
        return glint_fail(error, GLINT_ERR_INVALID, "dpi: number 0 .. 1000000 expected, got %g", desc->dpi);
    if (desc->colormap < 0 || desc->colormap > GLINT_COLORMAP_COUNT)
        return glint_fail(error, GLINT_ERR_INVALID, "colormap: 0 .. %d expected, got %d", GLINT_COLORMAP_COUNT,
                          desc->colormap);
    if (!isfinite(desc->range[0]) || !isfinite(desc->range[1]))
        return glint_fail(error, GLINT_ERR_INVALID, "range: finite numbers expected, got %g and %g", desc->range[0], desc->range[1]);
    if (kind == GLINT_FILE_PNG)
        return encode_png(image, desc, bands, out, reused, error);
    if (glint_file_is_vector(kind))
        return encode_figure(image, desc, kind, out, error);
    if (kind == GLINT_FILE_EXR)
        return glint_exr_encode(image, desc->tone.bits == 16, desc->text, desc->text_count, out, error);
    float *const *plane = glint_image_planes(image, desc->pass);
    if (!plane[0])
        return fail_not_stored(image, desc->pass, error);
    const bool done = kind == GLINT_FILE_NPY ? glint_npy_encode(image->width, image->height, channels, plane, out)
                                             : glint_pfm_encode(image->width, image->height, channels, plane, out);
    return done ? GLINT_OK : glint_fail_nomem(error);
}

glint_status glint_image_write(const glint_image *image, const glint_write_desc *given, glint_error *error)
{
    GLINT_REFUSE_NULL(image, error);
    GLINT_TAKE_DESC(glint_write_desc, { 0 });
    glint_bytes bytes = { 0 };
    status = glint_image_encode(image, desc, NULL, &bytes, NULL, error);
    if (!status)
        status = glint_file_write(desc->path, bytes.data, bytes.size, error);
    free(bytes.data);
    return status;
}

glint_status glint_image_to_bytes(const glint_image *image, const glint_write_desc *given, uint8_t **data, size_t *size,
                                  glint_error *error)
{
    GLINT_REFUSE_NULL(image, error);
    GLINT_REFUSE_NULL(data, error);
    GLINT_REFUSE_NULL(size, error);
    GLINT_TAKE_DESC(glint_write_desc, { 0 });
    glint_bytes bytes = { 0 };
    status = glint_image_encode(image, desc, NULL, &bytes, NULL, error);
    if (status) {
        free(bytes.data);
        return status;
    }
    *data = bytes.data;
    *size = bytes.size;
    return GLINT_OK;
}

bool glint_file_has_key(const char *path, const char *key)
{
    if (!path || !key)
        return false;
    struct glint_bytes bytes = { 0 };
    glint_drafts_collect_in_folder(path); // a run that finds all its pictures finished opens no draft
    if (glint_file_read_picture(path, &bytes, NULL)) // for example a pipe, which stores nothing
        return false;
    bool has = glint_png_has_text(bytes.data, bytes.size, GLINT_PNG_KEY, key);
    free(bytes.data);
    return has;
}
