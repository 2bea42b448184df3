#include "engine/film/image.h"

#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/film/tone.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROW(id, name, channels, look) [GLINT_PASS_##id] = { name, channels, GLINT_LOOK_##look },
static const struct {
    const char *name;
    int channels;
    glint_pass_look look;
} pass_table[GLINT_PASS_COUNT] = { GLINT_PASSES(ROW) };

static bool is_pass(glint_pass pass) { return (unsigned)pass < GLINT_PASS_COUNT; }

static bool is_plane(glint_pass pass) { return (unsigned)pass < GLINT_PLANE_COUNT; }

_Static_assert((int)GLINT_PASS_LIGHT == GLINT_PLANE_COUNT, "light passes follow the derivatives");

float *const *glint_image_planes(const glint_image *image, glint_pass pass)
{
    static float *const none[3];
    const size_t light = (size_t)pass - GLINT_PASS_LIGHT;
    if (is_plane(pass))
        return image->plane[pass];
    return pass >= GLINT_PASS_LIGHT && light < image->light_count ? image->light[light] : none;
}

const char *glint_pass_name(glint_pass pass) { return is_pass(pass) ? pass_table[pass].name : NULL; }

glint_pass_look glint_look_of(glint_pass pass)
{
    if (is_pass(pass))
        return pass_table[pass].look;
    return pass < GLINT_PASS_LIGHT ? GLINT_LOOK_DERIVATIVE : GLINT_LOOK_LIGHT;
}

glint_pass glint_pass_from_name(const char *name)
{
    int pass = 0;
    while (pass < GLINT_PASS_COUNT && !(name && strcmp(name, pass_table[pass].name) == 0))
        pass++;
    return (glint_pass)pass;
}

int glint_pass_channels(glint_pass pass)
{
    return is_pass(pass) ? pass_table[pass].channels : pass >= GLINT_PASS_DERIVATIVE ? 3 : 0;
}

const char *glint_plane_name(const glint_image *image, glint_pass pass, char buffer[GLINT_PLANE_NAME_SIZE])
{
    if (pass < GLINT_PASS_DERIVATIVE)
        return glint_pass_name(pass);
    if (is_plane(pass))
        snprintf(buffer, GLINT_PLANE_NAME_SIZE, "d:%s", image->derivative[pass - GLINT_PASS_DERIVATIVE]);
    else if (glint_image_light_pass(image, (size_t)pass - GLINT_PASS_LIGHT))
        snprintf(buffer, GLINT_PLANE_NAME_SIZE, "light:%s", image->light_name[pass - GLINT_PASS_LIGHT]);
    else
        return NULL;
    return buffer;
}

static bool allocate_plane(size_t pixels, float **plane)
{
    *plane = glint_alloc_large(pixels, sizeof(float));
    return *plane != NULL;
}

static bool allocate_all(glint_image *image, uint32_t passes, const glint_tone_desc *codes_tone)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (int pass = 0; pass < GLINT_PLANE_COUNT; pass++)
        for (int c = 0; c < glint_pass_channels((glint_pass)pass); c++)
            if (passes & 1u << pass && !allocate_plane(pixels, &image->plane[pass][c]))
                return false;
    if (!codes_tone)
        return true;
    image->code_tone = *codes_tone;
    image->codes = glint_alloc_large(pixels, glint_image_pixel_bytes(image));
    image->row_stamp = calloc(glint_image_stamps(image), sizeof *image->row_stamp);
    return image->codes && image->row_stamp;
}

static glint_status create(int width, int height, uint32_t passes, bool alpha, const glint_tone_desc *codes_tone,
                           glint_image **out, glint_error *error)
{
    glint_status status = glint_check_whole("width", width, 1, GLINT_SIDE_MAX, error);
    if (!status)
        status = glint_check_whole("height", height, 1, GLINT_SIDE_MAX, error);
    if (!status && codes_tone)
        status = glint_tone_check(codes_tone, error);
    if (status)
        return status;
    // The largest image has fewer than 2^36 bytes.
    if (sizeof(size_t) < 8 && (double)width * height * 12 > (double)SIZE_MAX)
        return glint_fail_nomem(error);
    glint_image *image = calloc(1, sizeof *image);
    if (!image)
        return glint_fail_nomem(error);
    atomic_init(&image->references, 1);
    image->width = width;
    image->height = height;
    image->alpha = alpha;
    image->channels = alpha ? 4 : 3;
    if (!allocate_all(image, passes, codes_tone)) {
        glint_image_release(image);
        return glint_fail_nomem(error);
    }
    *out = image;
    return GLINT_OK;
}

glint_status glint_image_create(int width, int height, uint32_t passes, const glint_tone_desc *codes_tone,
                                glint_image **out, glint_error *error)
{
    return create(width, height, passes, false, codes_tone, out, error);
}

glint_status glint_image_add_lights(glint_image *image, size_t count, const char (*names)[GLINT_NAME_SIZE], glint_error *error)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    if (!(image->light = calloc(count, sizeof *image->light)) || !(image->light_name = calloc(count, sizeof *image->light_name)))
        return glint_fail_nomem(error);
    for (; image->light_count < count; image->light_count++) {
        memcpy(image->light_name[image->light_count], names[image->light_count], GLINT_NAME_SIZE);
        for (int c = 0; c < 3; c++)
            if (!allocate_plane(pixels, &image->light[image->light_count][c])) {
                image->light_count++; // counts the planes to free on failure
                return glint_fail_nomem(error);
            }
    }
    return GLINT_OK;
}

/// Adds the light passes of a plan's description: names separated by commas.
static glint_status add_lights_of(glint_image *image, const char *list, glint_error *error)
{
    size_t count = 1, i = 0;
    for (const char *at = list; *at; at++)
        count += *at == ',';
    char(*names)[GLINT_NAME_SIZE] = calloc(count, sizeof *names);
    for (const char *at = list; names && i < count; at += strcspn(at, ",") + 1)
        snprintf(names[i++], GLINT_NAME_SIZE, "%.*s", (int)strcspn(at, ","), at);
    glint_status status = names ? glint_image_add_lights(image, count, (const char(*)[GLINT_NAME_SIZE])names, error) : glint_fail_nomem(error);
    free(names);
    return status;
}

glint_status glint_image_create_for(const glint_render_desc *desc, glint_image **out, glint_error *error)
{
    glint_status status = create((int)desc->width, (int)desc->height, desc->passes, desc->alpha,
                                 desc->codes ? &desc->tone : NULL, out, error);
    if (status)
        return status;
    (*out)->outline = desc->outline;
    (*out)->exposure = desc->tone.exposure;
    if (desc->derivative_count)
        (*out)->shadows = glint_alloc_large((size_t)desc->width * (size_t)desc->height, sizeof *(*out)->shadows);
    if (desc->derivative_count && !(*out)->shadows)
        status = glint_fail_nomem(error);
    if (!status && desc->light_passes)
        status = add_lights_of(*out, desc->light_passes, error);
    if (status)
        glint_image_release(*out);
    return status;
}

static void copy_rows(const void *from, size_t stride, void *to, size_t row, size_t count)
{
    for (size_t y = 0; from && y < count; y++)
        memcpy((uint8_t *)to + y * row, (const uint8_t *)from + y * stride, row);
}

glint_status glint_image_crop(const glint_image *image, int x, int y, int width, int height, glint_image **out,
                              glint_error *error)
{
    uint32_t passes = 0;
    for (int pass = 0; pass < GLINT_PLANE_COUNT; pass++)
        passes |= (uint32_t)glint_image_has_pass(image, (glint_pass)pass) << pass;
    glint_status status =
        create(width, height, passes, image->alpha, image->codes ? &image->code_tone : NULL, out, error);
    if (status)
        return status;
    const size_t first = (size_t)y * (size_t)image->width + (size_t)x, bytes = glint_image_pixel_bytes(image);
    const size_t stride = (size_t)image->width, row = (size_t)width, rows = (size_t)height;
    (*out)->outline = image->outline;
    (*out)->exposure = image->exposure;
    (*out)->part_x = x;
    (*out)->part_y = y;
    memcpy((*out)->derivative, image->derivative, sizeof image->derivative);
    for (int pass = 0; pass < GLINT_PLANE_COUNT; pass++)
        for (int c = 0; c < 3; c++)
            if (image->plane[pass][c])
                copy_rows(image->plane[pass][c] + first, stride * sizeof(float), (*out)->plane[pass][c],
                          row * sizeof(float), rows);
    if (image->light_count)
        status = glint_image_add_lights(*out, image->light_count, (const char(*)[GLINT_NAME_SIZE])image->light_name, error);
    for (size_t i = 0; i < image->light_count && !status; i++)
        for (int c = 0; c < 3; c++)
            copy_rows(image->light[i][c] + first, stride * sizeof(float), (*out)->light[i][c], row * sizeof(float), rows);
    if (status) {
        glint_image_release(*out);
        return status;
    }
    if (image->codes)
        copy_rows((const uint8_t *)image->codes + first * bytes, stride * bytes, (*out)->codes, row * bytes, rows);
    return GLINT_OK;
}

glint_status glint_image_cover(glint_image *under, glint_cover *cover, int x, int y, glint_image **out,
                               glint_error *error)
{
    glint_image *image = calloc(1, sizeof *image);
    if (!image) {
        glint_image_release(under);
        return glint_fail_nomem(error);
    }
    atomic_init(&image->references, 1);
    image->width = under->width;
    image->height = under->height;
    memcpy(image->plane, under->plane, sizeof image->plane);
    image->light = under->light;
    image->light_name = under->light_name;
    image->light_count = under->light_count;
    image->codes = under->codes;
    image->alpha = under->alpha;
    image->outline = under->outline;
    image->channels = under->channels;
    image->code_tone = under->code_tone;
    image->exposure = under->exposure;
    image->row_stamp = under->row_stamp;
    image->under = under;
    image->cover = glint_cover_retain(cover);
    image->part_x = x;
    image->part_y = y;
    *out = image;
    return GLINT_OK;
}

static bool is_black_code(const glint_image *image, size_t i)
{
    const size_t at = i * (size_t)image->channels;
    if (image->code_tone.bits == 16) {
        const uint16_t *code = (const uint16_t *)image->codes + at;
        return !(code[0] | code[1] | code[2]);
    }
    const uint8_t *code = (const uint8_t *)image->codes + at;
    return !(code[0] | code[1] | code[2]);
}

bool glint_image_is_black(const glint_image *image)
{
    if (!image)
        return false;
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    float *const *light = image->plane[GLINT_PASS_BEAUTY];
    bool black = image->codes || light[0];
    for (size_t i = 0; i < pixels && black; i++)
        black = image->codes ? is_black_code(image, i) : !(light[0][i] > 0 || light[1][i] > 0 || light[2][i] > 0);
    return black;
}

size_t glint_image_bytes(const glint_image *image)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    size_t bytes = image->codes ? pixels * glint_image_pixel_bytes(image) : 0;
    for (int pass = 0; pass < GLINT_PLANE_COUNT; pass++)
        for (int c = 0; c < 3; c++)
            bytes += image->plane[pass][c] ? pixels * sizeof(float) : 0;
    bytes += 3 * image->light_count * pixels * sizeof(float);
    return bytes + (image->shadows ? pixels * sizeof *image->shadows : 0);
}

glint_image *glint_image_retain(glint_image *image)
{
    if (image)
        atomic_fetch_add_explicit(&image->references, 1, memory_order_relaxed);
    return image;
}

void glint_image_release(glint_image *image)
{
    if (!image || atomic_fetch_sub_explicit(&image->references, 1, memory_order_acq_rel) != 1)
        return;
    glint_cover_release(image->cover);
    if (image->under) {
        glint_image_release(image->under);
        free(image);
        return;
    }
    for (int pass = 0; pass < GLINT_PLANE_COUNT; pass++)
        for (int c = 0; c < 3; c++)
            free(image->plane[pass][c]);
    for (size_t i = 0; i < image->light_count; i++)
        for (int c = 0; c < 3; c++)
            free(image->light[i][c]);
    free(image->light);
    free(image->light_name);
    free(image->codes);
    free(image->row_stamp);
    free(image->shadows);
    free(image->film);
    free(image);
}

const char *glint_image_derivative(const glint_image *image, size_t index)
{
    if (!image)
        return NULL;
    return index < GLINT_DERIVATIVES_MAX && *image->derivative[index] ? image->derivative[index] : NULL;
}

const char *glint_image_light_pass(const glint_image *image, size_t index)
{
    if (!image)
        return NULL;
    return index < image->light_count ? image->light_name[index] : NULL;
}

int glint_image_width(const glint_image *image) { return image ? image->width : 0; }

int glint_image_height(const glint_image *image) { return image ? image->height : 0; }

bool glint_image_has_pass(const glint_image *image, glint_pass pass)
{
    if (!image)
        return false;
    return glint_image_planes(image, pass)[0] != NULL;
}

/// Refuses a pass that the image does not store.
static glint_status check_pass(const glint_image *image, glint_pass pass, glint_error *error)
{
    if ((int)pass < 0)
        return glint_fail(error, GLINT_ERR_INVALID, "pass: one of the %d passes expected, got %d", GLINT_PASS_COUNT,
                          (int)pass);
    if (glint_image_planes(image, pass)[0])
        return GLINT_OK;
    if (!is_pass(pass))
        return glint_fail(error, GLINT_ERR_INVALID, "pass: this image has no %s number %d", is_plane(pass) ? "derivative" : "light pass",
                          (int)pass - (int)(is_plane(pass) ? GLINT_PASS_DERIVATIVE : GLINT_PASS_LIGHT));
    return glint_fail(error, GLINT_ERR_INVALID, "pass: '%s' is not stored in this image", pass_table[pass].name);
}

glint_status glint_image_pixel(const glint_image *image, glint_pass pass, int x, int y, float out[3],
                               glint_error *error)
{
    GLINT_REFUSE_NULL(image, error);
    GLINT_REFUSE_NULL(out, error);
    glint_status status = check_pass(image, pass, error);
    if (!status)
        status = glint_check_whole("x", x, 0, image->width - 1, error);
    if (!status)
        status = glint_check_whole("y", y, 0, image->height - 1, error);
    if (status)
        return status;
    float *const *plane = glint_image_planes(image, pass);
    size_t at = (size_t)y * (size_t)image->width + (size_t)x;
    for (int c = 0; c < 3; c++)
        out[c] = plane[glint_pass_channels(pass) == 1 ? 0 : c][at];
    return GLINT_OK;
}

glint_status glint_image_floats(const glint_image *image, glint_pass pass, float *out, glint_error *error)
{
    GLINT_REFUSE_NULL(image, error);
    GLINT_REFUSE_NULL(out, error);
    const glint_status status = check_pass(image, pass, error);
    if (status)
        return status;
    float *const *plane = glint_image_planes(image, pass);
    const size_t count = (size_t)image->width * (size_t)image->height, channels = (size_t)glint_pass_channels(pass);
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < channels; c++)
            out[i * channels + c] = plane[c][i];
    return GLINT_OK;
}
