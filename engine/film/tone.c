#include "engine/film/tone.h"
#include "engine/glint_math.h"

#include "engine/base/status.h"

#include <float.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#define GUESS_SHIFT 15 // a bucket of `guess` holds the floats that agree in their upper 17 bits

glint_tone_desc glint_tone_desc_default(void)
{
    return (glint_tone_desc) { GLINT_TONE_CLAMP, GLINT_TRANSFER_SRGB, GLINT_ROUNDING_NEAREST, 8, 0, false };
}

glint_status glint_tone_check(const glint_tone_desc *desc, glint_error *error)
{
    if (desc->curve > GLINT_TONE_FILMIC)
        return glint_fail(error, GLINT_ERR_INVALID, "tone: clamp, reinhard or filmic expected, got %d",
                          (int)desc->curve);
    if (desc->transfer > GLINT_TRANSFER_NONE)
        return glint_fail(error, GLINT_ERR_INVALID, "transfer: srgb, linear or none expected, got %d",
                          (int)desc->transfer);
    if (desc->rounding != GLINT_ROUNDING_NEAREST && desc->rounding != GLINT_ROUNDING_TRUNCATE)
        return glint_fail(error, GLINT_ERR_INVALID, "rounding: nearest or truncate expected, got %d",
                          (int)desc->rounding);
    if (desc->bits != 8 && desc->bits != 16)
        return glint_fail(error, GLINT_ERR_INVALID, "bits: 8 or 16 expected, got %d", desc->bits);
    return glint_check_range("exposure", desc->exposure, -GLINT_EXPOSURE_MAX, GLINT_EXPOSURE_MAX, "stops, -32 .. 32",
                             error);
}

bool glint_tone_same(const glint_tone_desc *a, const glint_tone_desc *b)
{
    return a->curve == b->curve && a->transfer == b->transfer && a->rounding == b->rounding && a->bits == b->bits &&
           a->exposure == b->exposure && a->dither == b->dither;
}

// ---- By definition ------------------------------------------------------------------------------------------------

static double clamp_to_unit(double x)
{
    return x > 0 ? x < 1 ? x : 1 : 0; // NaN gives 0
}

double glint_srgb_encode(double linear)
{
    double x = clamp_to_unit(linear);
    if (x <= 0.0031308)
        return 12.92 * x;
    return x < 1 ? 1.055 * glint_pow(x, 1 / 2.4) - 0.055 : 1; // 1.055 - 0.055 is not 1 in double
}

double glint_srgb_decode(double encoded)
{
    double x = clamp_to_unit(encoded);
    return x <= 0.04045 ? x / 12.92 : glint_pow((x + 0.055) / 1.055, 2.4);
}

float glint_tone_gain(const glint_tone_desc *desc) { return (float)glint_pow(2, desc->exposure); }

/// Applies the curve to light after exposure.
static double code_of(const glint_tone_desc *desc, double linear)
{
    double y = glint_tone_curve_value(desc->curve, linear);
    double x = desc->transfer == GLINT_TRANSFER_SRGB ? glint_srgb_encode(y) : clamp_to_unit(y);
    double code = x * (desc->bits == 16 ? 65535 : 255);
    return floor(desc->rounding == GLINT_ROUNDING_NEAREST ? code + 0.5 : code);
}

double glint_tone_value(const glint_tone_desc *desc, double linear)
{
    if (desc->exposure == 0)
        return code_of(desc, linear);
    const float exposed = glint_tone_gain(desc) * (float)linear;
    return code_of(desc, (double)exposed);
}

// ---- Tables -------------------------------------------------------------------------------------------------------

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static float float_of(uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/// Returns the first float whose code is at least k, by binary search over all floats.
static float first_by_search(const glint_tone_desc *desc, int k)
{
    uint32_t low = 0, high = bits_of(INFINITY); // code(low) < k <= code(high)
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        if (code_of(desc, (double)float_of(middle)) < k)
            low = middle;
        else
            high = middle;
    }
    return float_of(high);
}

/// Returns the first float whose code is at least k, 1 <= k <= M: the float above the inverse if the inverse is far
/// enough from any float to be certain, otherwise found by single steps. The inverse and the definition agree to
/// 2^-48, but with a tone curve only to 2^-34, since 1 - y of the last codes has 16 bits less.
static float first_of_code(const glint_tone_desc *desc, int k)
{
    double code = desc->rounding == GLINT_ROUNDING_NEAREST ? k - 0.5 : k;
    double encoded = code / (desc->bits == 16 ? 65535 : 255);
    double y = desc->transfer == GLINT_TRANSFER_SRGB ? glint_srgb_decode(encoded) : encoded;
    double linear = glint_tone_curve_inverse(desc->curve, y);
    if (!(linear < FLT_MAX))
        return first_by_search(desc, k);
    uint32_t bits = bits_of((float)linear);
    if (float_of(bits) < linear)
        bits++;
    double doubt = (desc->curve == GLINT_TONE_CLAMP ? 0x1p-40 : 0x1p-30) * linear;
    if (linear < glint_tone_curve_white(desc->curve) && float_of(bits) - linear > doubt &&
        linear - float_of(bits - 1) > doubt)
        return float_of(bits);
    while (code_of(desc, (double)float_of(bits)) < k)
        bits++;
    while (code_of(desc, (double)float_of(bits - 1)) >= k)
        bits--;
    return float_of(bits);
}

void glint_tone_steps(const glint_tone_desc *tone, float least[255])
{
    if (!tone || !least)
        return;
    glint_tone_desc desc = *tone;
    desc.bits = 8;
    for (int k = 1; k <= 255; k++)
        least[k - 1] = first_of_code(&desc, k);
}

static bool fill_lut(glint_tone_table *table)
{
    const uint32_t entries = (bits_of(table->top) >> 16) - GLINT_TONE_FIRST + 1;
    table->lut = malloc(entries * sizeof *table->lut);
    if (!table->lut)
        return false;
    uint32_t first = GLINT_TONE_FIRST << 16, code = 0, next = bits_of(first_of_code(&table->desc, 1));
    for (uint32_t i = 0; i < entries; i++, first += 0x10000) {
        while (code < 255 && next <= first) {
            code++;
            next = code < 255 ? bits_of(first_of_code(&table->desc, (int)code + 1)) : UINT32_MAX;
        }
        uint32_t offset = next - first;
        table->lut[i] = code | (offset < 0x10000 ? offset : 0x10000) << 8;
    }
    return true;
}

/// Makes the tone stage's estimate of the transfer function: m^(1 / 2.4) by Remez's exchange, relative error 1.2e-6,
/// which is 3.2e-4 codes at 1. Float rounding, at most 2^-24 of 512 at the end and of the terms before, adds less than
/// 0.7e-4. So 16 / 2^15 codes (4.9e-4) on either side of a step are enough.
static void make_fit(glint_tone_table *table)
{
    static const float power[6] = { 0x1.815cbcp-2f, 0x1.e7d75cp-1f,  -0x1.f7881ep-2f,
                                    0x1.ab2598p-3f, -0x1.a5354ep-5f, 0x1.643670p-8f };
    const bool srgb = table->desc.transfer == GLINT_TRANSFER_SRGB;
    glint_tone_fit *fit = &table->fit;
    memcpy(fit->power, power, sizeof power);
    for (int i = 0; i < 16; i++)
        fit->scale[i] = srgb ? (float)(255 * 1.055 * glint_pow(2, (i - 15) / 2.4)) : 0;
    fit->doubt = 32;
    fit->knee = srgb ? 0.0031308f : INFINITY;
    fit->slope = (float)(srgb ? 255 * 12.92 : 255);
    fit->base = 256 + (float)fit->doubt * 0x1p-16f + (table->desc.rounding == GLINT_ROUNDING_NEAREST ? 0.5f : 0);
    fit->offset = fit->base - (float)(255 * 0.055);
}

static uint32_t code_by_search(const float *threshold, float x)
{
    uint32_t low = 0, high = 65536; // threshold[low] <= x < threshold[high]
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        if (threshold[middle] <= x)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/// Returns the fractional code at x, between the two codes around it. A line through two such points is a good guess
/// in between.
static float fractional_code(const float *threshold, float x)
{
    uint32_t code = code_by_search(threshold, x);
    if (code == 65535)
        return 65535;
    return (float)code + (x - threshold[code]) / (threshold[code + 1] - threshold[code]);
}

static bool fill_thresholds(glint_tone_table *table)
{
    const uint32_t entries = (bits_of(table->top) >> GUESS_SHIFT) - (GLINT_TONE16_FIRST << (16 - GUESS_SHIFT)) + 1;
    table->threshold = malloc(65537 * sizeof *table->threshold);
    table->guess = malloc(entries * sizeof *table->guess);
    if (!table->threshold || !table->guess)
        return false;
    table->threshold[0] = 0;
    for (int k = 1; k <= 65535; k++)
        table->threshold[k] = first_of_code(&table->desc, k);
    table->threshold[65536] = INFINITY;
    uint32_t bits = GLINT_TONE16_FIRST << 16;
    float value = fractional_code(table->threshold, float_of(bits));
    for (uint32_t i = 0; i < entries; i++) {
        bits += 1u << GUESS_SHIFT;
        float next = fractional_code(table->threshold, float_of(bits));
        table->guess[i][0] = value;
        table->guess[i][1] = (next - value) / (1 << GUESS_SHIFT);
        value = next;
    }
    return true;
}

glint_status glint_tone_table_create(const glint_tone_desc *desc, glint_tone_table **out, glint_error *error)
{
    glint_status status = glint_tone_check(desc, error);
    if (status)
        return status;
    glint_tone_table *table = calloc(1, sizeof *table);
    if (!table)
        return glint_fail_nomem(error);
    table->desc = *desc;
    table->desc.exposure = 0;
    table->desc.dither = desc->dither && desc->bits == 8;
    if (table->desc.dither) { // 257 steps for each 8-bit value, to which whole thresholds are added
        table->desc.bits = 16;
        table->desc.rounding = GLINT_ROUNDING_TRUNCATE;
    }
    const bool wide = table->desc.bits == 16;
    table->white = (float)glint_tone_curve_white(desc->curve);
    table->top = desc->curve == GLINT_TONE_CLAMP ? 1 : first_of_code(&table->desc, wide ? 65535 : 255);
    table->has_fit = !wide && desc->curve == GLINT_TONE_CLAMP;
    if (table->has_fit)
        make_fit(table);
    if (!(wide ? fill_thresholds(table) : fill_lut(table))) {
        glint_tone_table_destroy(table);
        return glint_fail_nomem(error);
    }
    *out = table;
    return GLINT_OK;
}

void glint_tone_table_destroy(glint_tone_table *table)
{
    if (!table)
        return;
    free(table->lut);
    free(table->threshold);
    free(table->guess);
    free(table);
}

static pthread_mutex_t store_lock = PTHREAD_MUTEX_INITIALIZER;
static glint_tone_table *store[GLINT_TONE_FILMIC + 1][2][2][3];
static size_t store_users;

void glint_tone_store_open(void)
{
    pthread_mutex_lock(&store_lock);
    store_users++;
    pthread_mutex_unlock(&store_lock);
}

void glint_tone_store_close(void)
{
    glint_tone_table **slot = &store[0][0][0][0];
    pthread_mutex_lock(&store_lock);
    store_users--;
    for (size_t i = 0; store_users == 0 && i < sizeof store / sizeof *slot; i++) {
        glint_tone_table_destroy(slot[i]);
        slot[i] = NULL;
    }
    pthread_mutex_unlock(&store_lock);
}

glint_status glint_tone_table_shared(const glint_tone_desc *desc, const glint_tone_table **out, glint_error *error)
{
    glint_status status = glint_tone_check(desc, error);
    if (status)
        return status;
    glint_tone_table **slot = &store[desc->curve][desc->transfer == GLINT_TRANSFER_SRGB]
                                    [desc->rounding == GLINT_ROUNDING_NEAREST][desc->bits == 16 ? 1 : desc->dither ? 2 : 0];
    pthread_mutex_lock(&store_lock);
    if (!*slot)
        status = glint_tone_table_create(desc, slot, error);
    if (!status)
        *out = *slot;
    pthread_mutex_unlock(&store_lock);
    return status;
}

// ---- Rows ---------------------------------------------------------------------------------------------------------

static inline float clamp_float(float x, float top)
{
    x = x > 0 ? x : 0;
    return x < top ? x : top;
}

static inline uint8_t code8(const glint_tone_table *table, float exposed)
{
    uint32_t bits = bits_of(clamp_float(exposed, table->top));
    if (bits < GLINT_TONE_FIRST << 16)
        return 0;
    uint32_t entry = table->lut[(bits >> 16) - GLINT_TONE_FIRST];
    return (uint8_t)((entry & 255) + ((bits & 0xffff) >= entry >> 8));
}

static inline uint16_t code16(const glint_tone_table *table, float exposed)
{
    float x = clamp_float(exposed, table->top);
    uint32_t bits = bits_of(x);
    if (bits < GLINT_TONE16_FIRST << 16)
        return 0;
    const float *line = table->guess[(bits >> GUESS_SHIFT) - (GLINT_TONE16_FIRST << (16 - GUESS_SHIFT))];
    uint32_t code = (uint32_t)(line[0] + (float)(bits & ((1u << GUESS_SHIFT) - 1)) * line[1]);
    while (x < table->threshold[code]) // the guess is within one: threshold[0] = 0, threshold[65536] = inf
        code--;
    while (x >= table->threshold[code + 1])
        code++;
    return (uint16_t)code;
}

/// Returns the threshold of a pixel, 2 .. 254, in steps of a 257th of an 8-bit value: its place in Bayer's matrix of 8 x
/// 8, whose bits are those of x ^ y and y, interleaved and reversed.
static unsigned threshold_at(unsigned x, unsigned y)
{
    unsigned place = 0;
    for (unsigned bit = 0; bit < 3; bit++)
        place = place << 2 | ((x ^ y) >> bit & 1) << 1 | (y >> bit & 1);
    return 4 * place + 2;
}

void glint_tone_row(const glint_tone_table *table, float gain, const float *const light[3], const float *alpha,
                    const int at[2], size_t count, void *codes, uint64_t counts[2])
{
    const bool dither = table->desc.dither, wide = table->desc.bits == 16 && !dither;
    const double most = wide ? 65535 : 255;
    const size_t channels = alpha ? 4 : 3;
    for (size_t i = 0; i < count; i++) {
        const unsigned threshold = dither ? threshold_at((unsigned)at[0] + (unsigned)i, (unsigned)at[1]) : 0;
        bool clipped = false, odd = false;
        for (size_t c = 0; c < channels; c++) {
            const float x = c == 3 ? alpha[i] : !alpha ? light[c][i] : alpha[i] > 0 ? light[c][i] / alpha[i] : 0;
            const unsigned code = c == 3   ? (unsigned)((double)x * most + 0.5)
                                  : dither ? (code16(table, gain * x) + threshold) / 257
                                  : wide   ? code16(table, gain * x)
                                           : code8(table, gain * x);
            if (wide)
                ((uint16_t *)codes)[channels * i + c] = (uint16_t)code;
            else
                ((uint8_t *)codes)[channels * i + c] = (uint8_t)code;
            clipped = clipped || (c < 3 && gain * x > table->white);
            odd = odd || (c < 3 && !isfinite(x));
        }
        if (counts) {
            counts[0] += clipped;
            counts[1] += odd;
        }
    }
}
