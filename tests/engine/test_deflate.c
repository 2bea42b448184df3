/// The encoder's bytes depend only on the picture, not on where its memory is. A bucket of ISA-L's hash table depends
/// on the stream's address, and deflate.c chooses addresses that all give the right bucket.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "engine/files/picture/deflate.c" // included as source, because the tests call its static functions

#ifdef BUCKET_BITS // deflate.c defines it where the address matters and can be chosen
#define OTHER_PLACES 32768 // enough addresses to use each bucket about four times
#define BAND_BYTES ((size_t)30000)

static void put(uint8_t *at, const char *bytes) { memcpy(at, bytes, strlen(bytes)); }

/// Zeros and a repeated byte sequence: with a wrong bucket for the second position,
/// the encoder does not find the repetition.
static uint8_t *make_band(void)
{
    uint8_t *data = calloc(1, BAND_BYTES);
    put(data, "abcdefgh");
    put(data + 20000, "Xbcdefghi");
    return data;
}

/// Maps a stream at one of many scattered addresses. The caller frees it with munmap. Returns NULL when the address
/// is in use.
static void *stream_at(uint64_t number)
{
    void *want = (void *)(uintptr_t)(UINT64_C(0x100000000000) + ((number * 0x9e3779b1 & 0x1fffffff) << 16));
    void *got = mmap(want, STREAM_BYTES, PROT_READ | PROT_WRITE, MAP_THERE, -1, 0);
    if (got == want)
        return got;
    if (got != MAP_FAILED)
        munmap(got, STREAM_BYTES);
    return NULL;
}

/// Encodes a band with this stream. Returns the bytes.
static glint_bytes band_at(const uint8_t *data, void *stream)
{
    static uint8_t level[ISAL_DEF_LVL1_DEFAULT];
    glint_bytes out = { 0 };
    assert_true(glint_bytes_reserve(&out, capacity_for(BAND_BYTES)));
    out.size = fast_band_at(stream, level, data, BAND_BYTES, false, out.data, capacity_for(BAND_BYTES));
    assert_true(out.size > 0);
    return out;
}

static bool same_at(const uint8_t *data, void *stream, const glint_bytes *want)
{
    glint_bytes got = band_at(data, stream);
    const bool same = got.size == want->size && memcmp(got.data, want->data, got.size) == 0;
    free(got.data);
    return same;
}

static void test_fast_places(void **state)
{
    (void)state;
    uint8_t *data = make_band();
    void *stream[ADDRESSES_TRIED];
    uint32_t third;
    memcpy(&third, data + 2, sizeof third);
    for (int i = 0; i < ADDRESSES_TRIED; i++) { // places each stream at its own address
        stream[i] = map_stream(bucket_of(third));
        assert_non_null(stream[i]);
    }
    glint_bytes want = band_at(data, stream[0]);
    for (int i = 1; i < ADDRESSES_TRIED; i++)
        assert_true(same_at(data, stream[i], &want));
    for (int i = 0; i < ADDRESSES_TRIED; i++)
        munmap(stream[i], STREAM_BYTES);
    size_t different = 0; // otherwise the test would prove nothing
    for (uint64_t number = 0; number < OTHER_PLACES; number++) {
        void *other = stream_at(number);
        if (!other)
            continue;
        different += !same_at(data, other, &want);
        munmap(other, STREAM_BYTES);
    }
    print_message("%zu of %d places elsewhere give other bytes\n", different, OTHER_PLACES);
    assert_true(different > 0);
    free(want.data);
    free(data);
}

/// For any bytes, the stream is mapped at an address whose bucket is the bucket of the bytes.
static void test_buckets(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 1000; i++) {
        const uint32_t bytes = i * 0x9e3779b1;
        void *stream = map_stream(bucket_of(bytes));
        assert_non_null(stream);
        assert_int_equal(bucket_of((uint32_t)((uintptr_t)stream >> ADDRESS_SHIFT)), bucket_of(bytes));
        munmap(stream, STREAM_BYTES);
    }
}

/// The state retained between bands does not affect the output, even when there are more buckets than streams.
static void test_memory(void **state)
{
    (void)state;
    struct glint_deflate_memory *kept = glint_deflate_memory_create();
    uint8_t *data = make_band();
    assert_non_null(kept);
    for (uint32_t i = 0; i < 3 * STREAMS; i++) {
        const uint32_t bytes = i % (STREAMS + STREAMS / 2) * 0x9e3779b1;
        struct glint_deflate_memory *fresh = glint_deflate_memory_create();
        glint_bytes want = { 0 }, got = { 0 };
        uint32_t sum[2];
        assert_non_null(fresh);
        memcpy(data + 2, &bytes, sizeof bytes);
        memcpy(data + 20002, &bytes, sizeof bytes);
        assert_int_equal(glint_deflate_band(kept, GLINT_ENCODE_FAST, data, BAND_BYTES, false, &got, &sum[0], NULL), GLINT_OK);
        assert_int_equal(glint_deflate_band(fresh, GLINT_ENCODE_FAST, data, BAND_BYTES, false, &want, &sum[1], NULL), GLINT_OK);
        assert_int_equal(got.size, want.size);
        assert_memory_equal(got.data, want.data, want.size);
        assert_int_equal(sum[0], sum[1]);
        glint_deflate_memory_destroy(fresh);
        free(got.data);
        free(want.data);
    }
    assert_int_equal(kept->placed.count, STREAMS);
    assert_null(kept->anywhere); // checks that no stream needed an arbitrary address
    glint_deflate_memory_destroy(kept);
    free(data);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_fast_places), cmocka_unit_test(test_buckets),
                                        cmocka_unit_test(test_memory) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
#else
int main(void)
{
    print_message("no place matters to the encoder here\n");
    return 77;
}
#endif
