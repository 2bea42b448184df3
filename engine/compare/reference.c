/// Differences from a reference: statistics of linear light and of pixel values, and FLIP.
#include "engine/base/status.h"
#include "engine/compare/flip.h"
#include "engine/film/image.h"
#include "engine/film/tone.h"
#include "engine/glint_compare.h"

#include <math.h>
#include <stdlib.h>

struct glint_reference {
    glint_image *image; ///< the mean
    glint_tone_desc tone;
    glint_flip *flip;
};

/// Pixel values of a picture, of 8 or 16 bits.
typedef struct codes {
    int bits;
    void *rgb; ///< owned
} codes;

static size_t pixel_count(const glint_image *image) { return (size_t)image->width * (size_t)image->height; }

/// Converts an image to pixel values. Uses the tone tables of an open reference.
static glint_status fill_codes(const glint_image *image, glint_tone_desc tone, int bits, codes *out, glint_error *error)
{
    const glint_tone_table *table = NULL;
    float *const *p = image->plane[GLINT_PASS_BEAUTY];
    const size_t pixels = pixel_count(image);
    tone.bits = bits;
    tone.dither = false;
    glint_status status = glint_tone_table_shared(&tone, &table, error);
    if (status)
        return status;
    *out = (codes) { bits, malloc(pixels * 3 * (bits == 16 ? sizeof(uint16_t) : 1)) };
    if (!out->rgb)
        return glint_fail_nomem(error);
    glint_tone_row(table, glint_tone_gain(&tone), (const float *const[3]) { p[0], p[1], p[2] }, NULL, (const int[2]) { 0, 0 },
                   pixels, out->rgb, NULL);
    return GLINT_OK;
}

static glint_status make_codes(const glint_image *image, glint_tone_desc tone, int bits, codes *out, glint_error *error)
{
    glint_tone_store_open();
    glint_status status = fill_codes(image, tone, bits, out, error);
    glint_tone_store_close();
    return status;
}

/// Returns pixel value number i, converted to 8-bit steps.
static double code_at(const codes *c, size_t i)
{
    return c->bits == 16 ? ((const uint16_t *)c->rgb)[i] / 257.0 : ((const uint8_t *)c->rgb)[i];
}

/// Returns the linear light for each pixel value, sRGB or linear. NULL: out of memory.
static float *decoding(bool srgb, int bits)
{
    const int last = bits == 16 ? 65535 : 255;
    float *table = malloc(((size_t)last + 1) * sizeof *table);
    for (int k = 0; table && k <= last; k++)
        table[k] = (float)(srgb ? glint_srgb_decode((double)k / last) : (double)k / last);
    return table;
}

/// Returns the scene's light for each pixel value: also undoes tone curve and exposure; +inf if no light gives the
/// value. NULL: out of memory.
static float *scene_light(const glint_tone_desc *tone, int bits)
{
    const int last = bits == 16 ? 65535 : 255;
    float *table = decoding(tone->transfer == GLINT_TRANSFER_SRGB, bits);
    for (int k = 0; table && k <= last; k++)
        table[k] = (float)glint_tone_curve_inverse(tone->curve, (double)table[k]) / glint_tone_gain(tone);
    return table;
}

// ---- Pictures for the eye -----------------------------------------------------------------------------------------

/// Converts the pixel values of a picture to linear light. The caller frees planes[0]; NULL: out of memory.
static void decode(const codes *c, const float *table, size_t pixels, float *planes[3])
{
    planes[0] = malloc(3 * pixels * sizeof *planes[0]);
    if (!planes[0])
        return;
    for (size_t k = 0; k < 3; k++) {
        planes[k] = planes[0] + k * pixels;
        for (size_t i = 0; i < pixels; i++)
            planes[k][i] =
                table[c->bits == 16 ? ((const uint16_t *)c->rgb)[3 * i + k] : ((uint8_t *)c->rgb)[3 * i + k]];
    }
}

/// Compares pixel values after the tone on an sRGB screen, so that the tone curve counts, too. With 16 bits, compares
/// the film itself.
static glint_status prepare_flip(const glint_image *image, const glint_tone_desc *tone, int bits, glint_flip **out,
                                 glint_error *error)
{
    codes c = { 0 };
    float *planes[3] = { NULL };
    glint_status status = make_codes(image, *tone, bits, &c, error);
    float *table = status ? NULL : decoding(tone->transfer != GLINT_TRANSFER_LINEAR, bits);
    if (table)
        decode(&c, table, pixel_count(image), planes);
    if (!status)
        status = planes[0] ? glint_flip_create(image->width, image->height, (const float *const *)planes, out, error)
                           : glint_fail_nomem(error);
    free(planes[0]);
    free(table);
    free(c.rgb);
    return status;
}

// ---- The reference ------------------------------------------------------------------------------------------------

static glint_status check_image(const glint_image *image, int width, int height, glint_error *error)
{
    if (!glint_image_has_pass(image, GLINT_PASS_BEAUTY))
        return glint_fail(error, GLINT_ERR_INVALID, "image: expected a picture with its beauty pass");
    if (image->width != width || image->height != height)
        return glint_fail(error, GLINT_ERR_INVALID, "image: %d x %d pixels expected, got %d x %d", width, height,
                          image->width, image->height);
    return GLINT_OK;
}

static void average(const glint_image *const *images, size_t count, glint_image *out)
{
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < pixel_count(out); i++) {
            double sum = 0;
            for (size_t k = 0; k < count; k++)
                sum += images[k]->plane[GLINT_PASS_BEAUTY][c][i];
            out->plane[GLINT_PASS_BEAUTY][c][i] = (float)(sum / (double)count);
        }
}

glint_status glint_reference_create(const glint_image *const *images, size_t count, const glint_tone_desc *tone,
                                    glint_reference **out, glint_error *error)
{
    GLINT_REFUSE_NULL(images, error);
    GLINT_REFUSE_NULL(tone, error);
    GLINT_REFUSE_NULL(out, error);
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < count && !status; i++)
        status = check_image(images[i], images[0]->width, images[0]->height, error);
    if (status)
        return status;
    if (count == 0)
        return glint_fail(error, GLINT_ERR_INVALID, "images: at least one expected, got 0");
    glint_reference *reference = calloc(1, sizeof *reference);
    if (!reference)
        return glint_fail_nomem(error);
    reference->tone = *tone;
    status = glint_image_create(images[0]->width, images[0]->height, 1u << GLINT_PASS_BEAUTY, NULL, &reference->image,
                                error);
    if (!status) {
        average(images, count, reference->image);
        status = prepare_flip(reference->image, tone, 16, &reference->flip, error);
    }
    if (status) {
        glint_reference_destroy(reference);
        return status;
    }
    *out = reference;
    return GLINT_OK;
}

void glint_reference_destroy(glint_reference *reference)
{
    if (!reference)
        return;
    glint_image_release(reference->image);
    glint_flip_destroy(reference->flip);
    free(reference);
}

const glint_image *glint_reference_image(const glint_reference *reference)
{
    return reference ? reference->image : NULL;
}

// ---- Measuring ----------------------------------------------------------------------------------------------------

/// Measures errors in linear light. light_of_code: the light for each pixel value, to compare the light stored in a
/// file; NULL: compares the image's light.
static void compare_light(const glint_reference *reference, const glint_image *image, const codes *c,
                          const float *light_of_code, glint_picture_error *out)
{
    const size_t pixels = pixel_count(image);
    const double white = glint_tone_curve_white(reference->tone.curve) / (double)glint_tone_gain(&reference->tone);
    double squares = 0, relative = 0;
    for (size_t i = 0; i < pixels; i++)
        for (size_t k = 0; k < 3; k++) {
            const double r = reference->image->plane[GLINT_PASS_BEAUTY][k][i];
            double x = image->plane[GLINT_PASS_BEAUTY][k][i];
            if (light_of_code && x <= white) {
                const double light = light_of_code[c->bits == 16 ? ((const uint16_t *)c->rgb)[3 * i + k]
                                                                 : ((const uint8_t *)c->rgb)[3 * i + k]];
                x = isfinite(light) ? light : x;
            }
            squares += (x - r) * (x - r);
            relative += (x - r) * (x - r) / (r * r + 0.01);
        }
    out->rmse = sqrt(squares / (3 * (double)pixels));
    out->relmse = relative / (3 * (double)pixels);
}

static void compare_codes(const codes *a, const codes *b, size_t pixels, glint_picture_error *out)
{
    size_t over1 = 0, over8 = 0;
    out->max_code = 0;
    for (size_t i = 0; i < pixels; i++) {
        double worst = 0;
        for (size_t k = 0; k < 3; k++) {
            const double d = fabs(code_at(a, 3 * i + k) - code_at(b, 3 * i + k));
            worst = d > worst ? d : worst;
        }
        over1 += worst > 1;
        over8 += worst > 8;
        out->max_code = worst > out->max_code ? worst : out->max_code;
    }
    out->over1 = (double)over1 / (double)pixels;
    out->over8 = (double)over8 / (double)pixels;
}

static glint_status measure(const glint_reference *reference, const glint_image *image, int file_bits,
                            glint_picture_error *out, glint_error *error)
{
    const int bits = file_bits ? file_bits : 8;
    codes mine = { 0 }, theirs = { 0 };
    glint_flip *flip = NULL;
    glint_status status = make_codes(image, reference->tone, bits, &mine, error);
    if (!status)
        status = make_codes(reference->image, reference->tone, bits, &theirs, error);
    if (!status)
        status = prepare_flip(image, &reference->tone, file_bits ? file_bits : 16, &flip, error);
    float *light_of_code = !status && file_bits ? scene_light(&reference->tone, bits) : NULL;
    if (!status && file_bits && !light_of_code)
        status = glint_fail_nomem(error);
    if (!status) {
        compare_light(reference, image, &mine, light_of_code, out);
        compare_codes(&mine, &theirs, pixel_count(image), out);
        out->flip = glint_flip_mean(reference->flip, flip);
    }
    free(light_of_code);
    glint_flip_destroy(flip);
    free(mine.rgb);
    free(theirs.rgb);
    return status;
}

glint_status glint_reference_measure(const glint_reference *reference, const glint_image *image, int file_bits,
                                     glint_picture_error *out, glint_error *error)
{
    GLINT_REFUSE_NULL(reference, error);
    GLINT_REFUSE_NULL(image, error);
    GLINT_REFUSE_NULL(out, error);
    if (file_bits != 0 && file_bits != 8 && file_bits != 16)
        return glint_fail(error, GLINT_ERR_INVALID, "file_bits: 0, 8 or 16 expected, got %d", file_bits);
    glint_status status = check_image(image, reference->image->width, reference->image->height, error);
    return status ? status : measure(reference, image, file_bits, out, error);
}

// ---- For the eye --------------------------------------------------------------------------------------------------

glint_status glint_reference_difference(const glint_reference *reference, const glint_image *image, double scale,
                                        glint_image **out, glint_error *error)
{
    GLINT_REFUSE_NULL(reference, error);
    GLINT_REFUSE_NULL(image, error);
    GLINT_REFUSE_NULL(out, error);
    codes mine = { 0 }, theirs = { 0 };
    glint_image *made = NULL;
    glint_tone_desc tone = reference->tone;
    tone.bits = 8;
    glint_status status = check_image(image, reference->image->width, reference->image->height, error);
    if (!status)
        status = make_codes(image, tone, 8, &mine, error);
    if (!status)
        status = make_codes(reference->image, tone, 8, &theirs, error);
    if (!status)
        status = glint_image_create(image->width, image->height, 0, &tone, &made, error);
    for (size_t i = 0; !status && i < 3 * pixel_count(image); i++) {
        const double d = scale * fabs(code_at(&mine, i) - code_at(&theirs, i));
        ((uint8_t *)made->codes)[i] = (uint8_t)(d < 255 ? d + 0.5 : 255);
    }
    free(mine.rgb);
    free(theirs.rgb);
    if (!status)
        *out = made;
    return status;
}
