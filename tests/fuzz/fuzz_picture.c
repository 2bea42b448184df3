/// Bytes that start like a PNG go to the PNG decoder and the PNG scanner, those that start like a Radiance picture to
/// its decoder, other bytes to the PFM reader. If both PNG readers accept the data, they report the same size, and all
/// decoded pixel values are present. No value of a Radiance picture is negative or NaN. A PFM is unchanged after
/// writing and reading it again.
#include "engine/files/picture/hdr.h"
#include "engine/files/picture/pfm.h"
#include "engine/files/picture/png.h"
#include "tests/fuzz/fuzz.h"

#include <math.h>
#include <string.h>
#include <zlib.h>

static const uint8_t signature[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };

static uint32_t big_endian(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static bool is_png(const uint8_t *data, size_t size) { return size >= 8 && memcmp(data, signature, 8) == 0; }

static unsigned sum_of(const void *values, size_t bytes)
{
    unsigned sum = 0;
    for (size_t i = 0; i < bytes; i++)
        sum += ((const uint8_t *)values)[i];
    return sum;
}

static bool take_text(void *user, const uint8_t *bytes, size_t size)
{
    *(unsigned *)user += sum_of(bytes, size);
    return true;
}

static void try_png(const uint8_t *data, size_t size)
{
    glint_png png;
    glint_png_head head;
    glint_error error;
    unsigned sum = 0;
    const bool scanned = glint_png_scan(data, size, &head, take_text, &sum, &error) == GLINT_OK;
    glint_png_has_text(data, size, "glint:key", "value");
    if (glint_png_decode(data, size, &png, &error))
        return;
    sum += sum_of(png.codes, (size_t)png.width * (size_t)png.height * (size_t)(png.channels * png.bits / 8));
    FUZZ_CHECK(!scanned || (head.width == png.width && head.height == png.height && head.bits == png.bits &&
                            head.channels == png.channels),
               "%d x %d and %d x %d, sum %u", head.width, head.height, png.width, png.height, sum);
    free(png.codes);
}

static void try_pfm(const uint8_t *data, size_t size)
{
    glint_pfm first, again;
    glint_error error;
    glint_bytes bytes = { 0 };
    if (glint_pfm_decode(data, size, &first, &error))
        return;
    const size_t pixels = (size_t)first.width * (size_t)first.height, channels = (size_t)first.channels;
    float *values = malloc((pixels * channels + 1) * sizeof *values), *plane[3];
    FUZZ_CHECK(values, "out of memory");
    for (size_t i = 0; i < pixels * channels; i++) // values that a file cannot store change when they are written
        values[i % channels * pixels + i / channels] = first.values[i] = isfinite(first.values[i]) ? first.values[i] : 0;
    for (size_t c = 0; c < channels; c++)
        plane[c] = values + c * pixels;
    FUZZ_CHECK(glint_pfm_encode(first.width, first.height, first.channels, plane, &bytes), "out of memory");
    FUZZ_CHECK(!glint_pfm_decode(bytes.data, bytes.size, &again, &error), "%s", error.message);
    FUZZ_CHECK(memcmp(first.values, again.values, pixels * channels * sizeof *values) == 0, "%d x %d", first.width,
               first.height);
    free(values);
    free(first.values);
    free(again.values);
    free(bytes.data);
}

static void try_hdr(const uint8_t *data, size_t size)
{
    glint_pfm picture;
    glint_error error;
    const size_t most = 1 << 16;
    if (glint_hdr_decode(data, size, most, &picture, &error))
        return;
    const size_t pixels = (size_t)picture.width * (size_t)picture.height;
    FUZZ_CHECK(picture.channels == 3 && pixels > 0 && pixels <= most, "%d x %d", picture.width, picture.height);
    for (size_t i = 0; i < 3 * pixels; i++)
        FUZZ_CHECK(picture.values[i] >= 0, "value %zu: %g", i, (double)picture.values[i]);
    free(picture.values);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (is_png(data, size))
        try_png(data, size);
    else if (glint_is_hdr(data, size))
        try_hdr(data, size);
    else
        try_pfm(data, size);
    return 0;
}

/// Corrects the checksums of a PNG's chunks; otherwise few mutations would pass the checks.
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t room, unsigned seed)
{
    size = LLVMFuzzerMutate(data, size, room);
    if (!is_png(data, size) || seed % 16 == 0)
        return size;
    for (size_t at = 8; at + 12 <= size;) {
        const size_t length = big_endian(data + at);
        if (length > size - at - 12)
            break;
        const uint32_t crc = (uint32_t)crc32(0, data + at + 4, (uInt)length + 4);
        for (int i = 0; i < 4; i++)
            data[at + 8 + length + (size_t)i] = (uint8_t)(crc >> (24 - 8 * i));
        at += 12 + length;
    }
    return size;
}
