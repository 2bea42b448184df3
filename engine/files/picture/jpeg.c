/// JPEG pictures through libjpeg. Its slow integer transform gives the same pixel values on every machine.
#include "engine/files/picture/jpeg.h"

#include "engine/base/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool glint_is_jpeg(const uint8_t *data, size_t size)
{
    return size > 3 && data[0] == 0xff && data[1] == 0xd8 && data[2] == 0xff;
}

#ifdef GLINT_HAVE_JPEG
#include <setjmp.h>

#include <jpeglib.h>

#include <jerror.h>

/// The data of libjpeg's callbacks, found through its `err`.
typedef struct failing {
    struct jpeg_error_mgr manager; ///< must be the first member, because libjpeg has only its address
    jmp_buf back;
    char message[JMSG_LENGTH_MAX];
} failing;

static void fail(j_common_ptr info)
{
    failing *f = (failing *)info->err;
    f->manager.format_message(info, f->message);
    longjmp(f->back, 1);
}

/// Ignores warnings, except the one that the file ends early.
static void take_message(j_common_ptr info, int level)
{
    if (level < 0 && info->err->msg_code == JWRN_JPEG_EOF)
        fail(info);
}

// ---- Turned pictures ----

/// Reads a number of `bytes` bytes of an Exif block, whose byte order is "II" or "MM".
static unsigned exif_number(const uint8_t *at, int bytes, bool is_little)
{
    unsigned number = 0;
    for (int i = 0; i < bytes; i++)
        number = number << 8 | at[is_little ? bytes - 1 - i : i];
    return number;
}

/// Returns the Exif tag Orientation, 1 .. 8; 1 if there is none.
static unsigned find_orientation(const struct jpeg_decompress_struct *info)
{
    static const unsigned tag = 0x112;
    for (const struct jpeg_marker_struct *m = info->marker_list; m; m = m->next) {
        const uint8_t *block = m->data + 6;
        if (m->data_length < 14 || memcmp(m->data, "Exif\0", 6) != 0)
            continue;
        const bool is_little = block[0] == 'I';
        const size_t size = m->data_length - 6, first = exif_number(block + 4, 4, is_little);
        const size_t count = first + 2 <= size ? exif_number(block + first, 2, is_little) : 0;
        for (size_t i = 0; i < count && first + 2 + 12 * (i + 1) <= size; i++) {
            const uint8_t *entry = block + first + 2 + 12 * i;
            const unsigned value = exif_number(entry + 8, 2, is_little);
            if (exif_number(entry, 2, is_little) == tag && value >= 1 && value <= 8)
                return value;
        }
    }
    return 1;
}

/// Turns a picture according to its orientation: 2 mirrors it left to right, 3 in both directions, 4 top to bottom; 5
/// .. 8 also swap its axes.
static bool turn(glint_png *picture, unsigned orientation)
{
    const size_t width = (size_t)picture->width, height = (size_t)picture->height, bytes = (size_t)picture->channels;
    const bool swaps = orientation >= 5, is_left = strchr("2367", '0' + (int)orientation), is_down = strchr("3478", '0' + (int)orientation);
    uint8_t *codes = malloc(width * height * bytes);
    if (!codes)
        return false;
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++) {
            const size_t across = swaps ? (is_left ? height - 1 - y : y) : is_left ? width - 1 - x : x;
            const size_t down = swaps ? (is_down ? width - 1 - x : x) : is_down ? height - 1 - y : y;
            memcpy(codes + (down * (swaps ? height : width) + across) * bytes, (const uint8_t *)picture->codes + (y * width + x) * bytes,
                   bytes);
        }
    free(picture->codes);
    picture->codes = codes;
    picture->width = (int)(swaps ? height : width);
    picture->height = (int)(swaps ? width : height);
    return true;
}

// ---- The picture ----

static glint_status read_rows(struct jpeg_decompress_struct *info, failing *f, size_t most, glint_png *picture,
                              glint_error *error)
{
    if (setjmp(f->back))
        return glint_fail(error, GLINT_ERR_FORMAT, "not a whole JPEG: %.160s", f->message);
    jpeg_save_markers(info, JPEG_APP0 + 1, 0xffff);
    jpeg_read_header(info, TRUE);
    if ((size_t)info->image_width * info->image_height > most)
        return glint_fail(error, GLINT_ERR_FORMAT, "a picture of at most %zu pixels expected, got %u x %u", most,
                          info->image_width, info->image_height);
    if (info->num_components != 1 && info->num_components != 3)
        return glint_fail(error, GLINT_ERR_FORMAT, "expected a grey or RGB JPEG, got %s",
                          info->num_components == 4 ? "CMYK" : "other colours");
    info->out_color_space = info->num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    info->dct_method = JDCT_ISLOW;
    jpeg_start_decompress(info);
    const size_t row = (size_t)info->output_width * (size_t)info->output_components;
    *picture = (glint_png) { .width = (int)info->output_width,
                             .height = (int)info->output_height,
                             .channels = info->output_components,
                             .bits = 8,
                             .codes = malloc(row * info->output_height) };
    if (!picture->codes)
        return glint_fail_nomem(error);
    while (info->output_scanline < info->output_height) {
        JSAMPROW to = (JSAMPROW)picture->codes + row * info->output_scanline;
        jpeg_read_scanlines(info, &to, 1);
    }
    const unsigned orientation = find_orientation(info);
    jpeg_finish_decompress(info);
    return orientation == 1 || turn(picture, orientation) ? GLINT_OK : glint_fail_nomem(error);
}

glint_status glint_jpeg_decode(const uint8_t *data, size_t size, size_t most, glint_png *out, glint_error *error)
{
    struct jpeg_decompress_struct info = { 0 };
    failing f = { 0 };
    glint_png picture = { 0 };
    info.err = jpeg_std_error(&f.manager);
    f.manager.error_exit = fail;
    f.manager.emit_message = take_message;
    if (setjmp(f.back)) { // set before the first byte is read
        jpeg_destroy_decompress(&info);
        return glint_fail(error, GLINT_ERR_FORMAT, "not a whole JPEG: %.160s", f.message);
    }
    jpeg_create_decompress(&info);
    jpeg_mem_src(&info, data, size);
    glint_status status = read_rows(&info, &f, most, &picture, error);
    jpeg_destroy_decompress(&info);
    if (status)
        free(picture.codes);
    else
        *out = picture;
    return status;
}

#define SPELLED(...) #__VA_ARGS__
#define SPELL(...) SPELLED(__VA_ARGS__)
const char *glint_jpeg_library(void)
{
#ifdef LIBJPEG_TURBO_VERSION
    return "libjpeg-turbo " SPELL(LIBJPEG_TURBO_VERSION);
#else
    return "libjpeg " SPELL(JPEG_LIB_VERSION);
#endif
}
#else
const char *glint_jpeg_library(void) { return NULL; }

glint_status glint_jpeg_decode(const uint8_t *data, size_t size, size_t most, glint_png *out, glint_error *error)
{
    (void)data, (void)size, (void)most, (void)out;
    return glint_fail(error, GLINT_ERR_FORMAT,
                      "a JPEG, which this build of glint cannot read (libjpeg): save it as .png");
}
#endif
