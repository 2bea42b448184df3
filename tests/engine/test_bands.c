/// Deflate in bands of rows: whatever the cache holds from earlier pictures, the file equals a fresh encoder's.
#include "tests/engine/cases/image_case.h"
#include "tests/engine/cases/random.h"

#include "engine/files/picture/write.h"

#include <malloc.h>

enum { PICTURES = 5, STEPS = 150 };

static uint64_t next_stamp(void)
{
    static uint64_t last;
    return ++last;
}

static size_t row_bytes(const glint_image *image)
{
    return (size_t)image->width * 3 * (image->code_tone.bits == 16 ? 2 : 1);
}

/// Writes new pixel values into a row of tiles:
/// often few different ones, so that the size of deflated bands varies widely.
static void paint(glint_image *image, size_t tile_row)
{
    size_t first = tile_row * GLINT_TILE_HEIGHT, end = first + GLINT_TILE_HEIGHT;
    uint32_t colors = below(3) ? 1 + below(4) : 256, base = below(256);
    end = end < (size_t)image->height ? end : (size_t)image->height;
    uint8_t *codes = image->codes;
    for (size_t i = first * row_bytes(image); i < end * row_bytes(image); i++)
        codes[i] = (uint8_t)(base + below(colors));
    image->row_stamp[tile_row] = below(30) ? next_stamp() : 0;
}

static glint_image *new_picture(int width, int height, const glint_tone_desc *tone)
{
    glint_image *image = NULL;
    assert_int_equal(glint_image_create(width, height, 0, tone, &image, NULL), GLINT_OK);
    for (size_t i = 0; i < glint_image_stamps(image); i++)
        paint(image, i);
    return image;
}

static glint_image *random_picture(void)
{
    glint_tone_desc tone = { GLINT_TONE_CLAMP, below(2) ? GLINT_TRANSFER_SRGB : GLINT_TRANSFER_LINEAR,
                             below(2) ? GLINT_ROUNDING_NEAREST : GLINT_ROUNDING_TRUNCATE, below(3) ? 8 : 16, 0, false };
    int width = below(2) ? 1 + (int)below(100) : 1400 + (int)below(300);
    return new_picture(width, 1 + (int)below(width > 100 ? 150 : 1000), &tone);
}

/// A copy of the picture in which some rows of tiles are painted again.
static glint_image *edited(const glint_image *old)
{
    glint_image *image = NULL;
    assert_int_equal(glint_image_create(old->width, old->height, 0, &old->code_tone, &image, NULL), GLINT_OK);
    memcpy(image->codes, old->codes, (size_t)old->height * row_bytes(old));
    memcpy(image->row_stamp, old->row_stamp, glint_image_stamps(old) * sizeof *old->row_stamp);
    for (uint32_t i = below(3); i > 0; i--)
        paint(image, below((uint32_t)glint_image_stamps(image)));
    return image;
}

static glint_bytes encode_ok(const glint_image *image, glint_encode encode, glint_bands *bands, double *reused)
{
    glint_write_desc desc = describe("x.png");
    glint_bytes bytes = { 0 };
    desc.tone = image->code_tone;
    desc.encode = encode;
    glint_error error;
    if (glint_image_encode(image, &desc, bands, &bytes, reused, &error))
        fail_msg("%s", error.message);
    return bytes;
}

/// Encodes the picture with `bands` and with a fresh encoder. Returns the reused share.
static double check_same(const glint_image *image, glint_encode encode, glint_bands *bands)
{
    double reused = -1, fresh = -1;
    glint_bytes got = encode_ok(image, encode, bands, &reused), want = encode_ok(image, encode, NULL, &fresh);
    assert_int_equal(got.size, want.size);
    assert_memory_equal(got.data, want.data, got.size);
    assert_true(fresh == 0 && reused >= 0 && reused <= 1);
    free(got.data);
    free(want.data);
    return reused;
}

static void drive(glint_bands *bands, glint_encode encode)
{
    glint_image *picture[PICTURES] = { 0 };
    int partly = 0, wholly = 0;
    uint32_t last = 0;
    picture[0] = random_picture();
    for (int step = 0; step < STEPS; step += (int)case_step()) {
        uint32_t to = below(PICTURES), from = below(3) ? last : below(PICTURES); // often the picture encoded last
        glint_image *image = picture[from] && below(8) ? edited(picture[from]) : random_picture();
        glint_image_release(picture[to]);
        picture[to] = image;
        last = to;
        if (below(16) == 0)
            encode ^= 1;
        double reused = check_same(image, encode, bands);
        partly += reused > 0 && reused < 1;
        wholly += reused == 1;
        if (below(4) == 0 && picture[from])
            check_same(picture[from], encode, bands);
    }
    assert_true(wholly * (int)case_step() > STEPS / 40);
    assert_true(partly * (int)case_step() > STEPS / 40);
    for (int i = 0; i < PICTURES; i++)
        glint_image_release(picture[i]);
}

static void test_bands_repeat(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 3; threads += 2) {
        glint_bands *bands = NULL;
        random_state = (uint64_t)threads;
        assert_int_equal(glint_bands_create(threads, &bands, NULL), GLINT_OK);
        drive(bands, GLINT_ENCODE_FAST);
        glint_bands_destroy(bands);
    }
    glint_bands_destroy(NULL);
}

/// A picture that differs only in tone or encoding, with the same size and stamps, reuses nothing.
static void test_bands_tone(void **state)
{
    (void)state;
    glint_bands *bands = NULL;
    glint_tone_desc tone = glint_tone_desc_default();
    assert_int_equal(glint_bands_create(0, &bands, NULL), GLINT_ERR_INVALID);
    assert_int_equal(glint_bands_create(2, &bands, NULL), GLINT_OK);
    glint_image *image = new_picture(1920, 100, &tone);
    for (size_t i = 0; i < glint_image_stamps(image); i++)
        image->row_stamp[i] = next_stamp();
    assert_true(check_same(image, GLINT_ENCODE_FAST, bands) == 0);
    assert_true(check_same(image, GLINT_ENCODE_FAST, bands) == 1);
    assert_true(check_same(image, GLINT_ENCODE_SMALL, bands) == 0);
    assert_true(check_same(image, GLINT_ENCODE_SMALL, bands) == 1);
    image->code_tone.rounding = GLINT_ROUNDING_TRUNCATE;
    ((uint8_t *)image->codes)[0] ^= 1;
    assert_true(check_same(image, GLINT_ENCODE_SMALL, bands) == 0);
    assert_true(check_same(image, GLINT_ENCODE_FAST, bands) == 0);
    ((uint8_t *)image->codes)[image->width * 3 * 99] ^= 1; // a pixel in the last of five rows of tiles
    image->row_stamp[4] = next_stamp();
    double reused = check_same(image, GLINT_ENCODE_FAST, bands);
    assert_true(fabs(reused - 0.8) < 1e-9);
    image->row_stamp[0] = 0; // stamp 0 means that the row is unknown, so it is never reused
    reused = check_same(image, GLINT_ENCODE_FAST, bands);
    assert_true(fabs(reused - 0.8) < 1e-9);
    reused = check_same(image, GLINT_ENCODE_FAST, bands);
    assert_true(fabs(reused - 0.8) < 1e-9);
    glint_image_release(image);
    glint_bands_destroy(bands);
}

/// Pictures with and without an alpha channel never reuse each other's bands, even with equal stamps.
static void test_bands_alpha(void **state)
{
    (void)state;
    glint_bands *bands = NULL;
    glint_image *image[2];
    glint_render_desc desc = glint_render_desc_default();
    desc.width = 300;
    desc.height = 200;
    desc.codes = true;
    assert_int_equal(glint_bands_create(1, &bands, NULL), GLINT_OK);
    for (int i = 0; i < 2; i++) {
        desc.alpha = i;
        assert_int_equal(glint_image_create_for(&desc, &image[i], NULL), GLINT_OK);
        for (size_t row = 0; row < glint_image_stamps(image[i]); row++) {
            paint(image[i], row);
            image[i]->row_stamp[row] = row + 1;
        }
    }
    for (int i = 0; i < 4; i++)
        assert_true(check_same(image[i % 2], GLINT_ENCODE_FAST, bands) == 0);
    for (int i = 0; i < 2; i++)
        glint_image_release(image[i]);
    glint_bands_destroy(bands);
}

/// A pass without stamps neither uses the cache nor evicts anything from it.
static void test_bands_other_pass(void **state)
{
    (void)state;
    glint_bands *bands = NULL;
    glint_tone_desc tone = glint_tone_desc_default();
    assert_int_equal(glint_bands_create(1, &bands, NULL), GLINT_OK);
    glint_image *image = make_image(200, 300, &tone);
    for (size_t i = 0; i < glint_image_stamps(image); i++)
        image->row_stamp[i] = next_stamp();
    assert_true(check_same(image, GLINT_ENCODE_FAST, bands) == 0);
    glint_write_desc desc = describe("x.png");
    desc.pass = GLINT_PASS_NORMAL;
    for (int i = 0; i < 2; i++) {
        glint_bytes got = { 0 }, want = { 0 };
        double reused = -1;
        assert_int_equal(glint_image_encode(image, &desc, bands, &got, &reused, NULL), GLINT_OK);
        assert_int_equal(glint_image_encode(image, &desc, NULL, &want, NULL, NULL), GLINT_OK);
        assert_int_equal(got.size, want.size);
        assert_memory_equal(got.data, want.data, got.size);
        assert_true(reused == 0);
        free(got.data);
        free(want.data);
    }
    assert_true(check_same(image, GLINT_ENCODE_FAST, bands) == 1);
    glint_image_release(image);
    glint_bands_destroy(bands);
}

/// The bytes do not depend on the address of the encoder's memory, which changes because the test holds blocks.
static void test_bands_places(void **state)
{
    (void)state;
    enum { HELD = 64, TIMES = 3000 };
    void *held[HELD] = { NULL };
    glint_tone_desc tone = glint_tone_desc_default();
    random_state = 7;
    (void)mallopt(M_MMAP_THRESHOLD, 1 << 16); // puts each block in its own mapping; a sanitizer may override this
    for (int size = 8; size <= 40; size += 32) {
        glint_image *image = NULL;
        glint_bytes first = { 0 };
        assert_int_equal(glint_image_create(size, size, 0, &tone, &image, NULL), GLINT_OK); // the picture is black
        for (int i = 0; i < TIMES; i += (int)case_step()) {
            free(held[i % HELD]);
            held[i % HELD] = malloc((size_t)(1 + below(64)) << 16);
            glint_bytes bytes = encode_ok(image, GLINT_ENCODE_FAST, NULL, NULL);
            if (i == 0) {
                first = bytes;
                continue;
            }
            assert_int_equal(bytes.size, first.size);
            assert_memory_equal(bytes.data, first.data, first.size);
            free(bytes.data);
        }
        free(first.data);
        glint_image_release(image);
    }
    for (int i = 0; i < HELD; i++)
        free(held[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bands_places), // must be first, while the heap has no free blocks of that size
        cmocka_unit_test(test_bands_repeat), cmocka_unit_test(test_bands_tone),
        cmocka_unit_test(test_bands_alpha),  cmocka_unit_test(test_bands_other_pass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
