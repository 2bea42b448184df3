/// JPEG pictures through libjpeg. Its slow integer transform gives the same codes on every machine.
#include "engine/file/jpeg.h"

#include "engine/base/status.h"

#include <stdio.h>
#include <stdlib.h>

bool glint_is_jpeg(const uint8_t *data, size_t size)
{
    return size > 3 && data[0] == 0xff && data[1] == 0xd8 && data[2] == 0xff;
}

#ifdef GLINT_HAVE_JPEG
#include <setjmp.h>

#include <jpeglib.h>

#include <jerror.h>

/// What libjpeg's callbacks find through its `err`.
typedef struct failing {
    struct jpeg_error_mgr manager; ///< first, as libjpeg has its address
    jmp_buf back;
    char message[JMSG_LENGTH_MAX];
} failing;

static void fail(j_common_ptr info)
{
    failing *f = (failing *)info->err;
    f->manager.format_message(info, f->message);
    longjmp(f->back, 1);
}

/// Warnings are passed over, except that the file ends early.
static void take_message(j_common_ptr info, int level)
{
    if (level < 0 && info->err->msg_code == JWRN_JPEG_EOF)
        fail(info);
}

static glint_status read_rows(struct jpeg_decompress_struct *info, failing *f, size_t most, glint_png *picture,
                              glint_error *error)
{
    if (setjmp(f->back))
        return glint_fail(error, GLINT_ERR_FORMAT, "not a whole JPEG: %.160s", f->message);
    jpeg_read_header(info, TRUE);
    if ((size_t)info->image_width * info->image_height > most)
        return glint_fail(error, GLINT_ERR_FORMAT, "a picture of at most %zu pixels expected, got %u x %u", most,
                          info->image_width, info->image_height);
    if (info->num_components != 1 && info->num_components != 3)
        return glint_fail(error, GLINT_ERR_FORMAT, "a JPEG of 1 or 3 components expected, got %d",
                          info->num_components);
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
    jpeg_finish_decompress(info);
    return GLINT_OK;
}

glint_status glint_jpeg_decode(const uint8_t *data, size_t size, size_t most, glint_png *out, glint_error *error)
{
    struct jpeg_decompress_struct info = { 0 };
    failing f = { 0 };
    glint_png picture = { 0 };
    info.err = jpeg_std_error(&f.manager);
    f.manager.error_exit = fail;
    f.manager.emit_message = take_message;
    if (setjmp(f.back)) { // before the first byte is read
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
#else
glint_status glint_jpeg_decode(const uint8_t *data, size_t size, size_t most, glint_png *out, glint_error *error)
{
    (void)data, (void)size, (void)most, (void)out;
    return glint_fail(error, GLINT_ERR_FORMAT,
                      "a JPEG, which this build of glint cannot read (libjpeg): save it as .png");
}
#endif
