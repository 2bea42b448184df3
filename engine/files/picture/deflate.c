#include "engine/files/picture/deflate.h"

#include "engine/base/status.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <zlib.h>
#ifdef GLINT_HAVE_ISAL
#include <isa-l.h>
#endif
#ifdef GLINT_HAVE_LIBDEFLATE
#include <libdeflate.h>
#endif

#define BAND_SIZE_MAX ((size_t)1 << 31)
#define SMALL_LEVEL_LIBDEFLATE 6
#define FAST_LEVEL_ZLIB 1
#define SMALL_LEVEL_ZLIB 6

/// Returns a buffer size that is enough for every encoder. It depends only on the size of the data, because some
/// encoders look at the space.
static size_t capacity_for(size_t size) { return size + size / 8 + 4096; }

// ---- zlib ---------------------------------------------------------------------------------------------------------

#if !defined GLINT_HAVE_ISAL || !defined GLINT_HAVE_LIBDEFLATE
static char zlib_name[32];

static void make_zlib_name(void) { snprintf(zlib_name, sizeof zlib_name, "zlib %s", zlibVersion()); }

static const char *name_of_zlib(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_zlib_name);
    return zlib_name;
}

static size_t band_by_zlib(int level, const uint8_t *data, size_t size, bool last, uint8_t *out, size_t capacity)
{
    z_stream stream = { 0 };
    if (deflateInit2(&stream, level, Z_DEFLATED, -15, 9, level < 4 ? Z_RLE : Z_FILTERED) != Z_OK)
        return 0;
    stream.next_in = (Bytef *)(uintptr_t)data; // not written: zlib's interface lacks the const
    stream.avail_in = (uInt)size;
    stream.next_out = out;
    stream.avail_out = (uInt)(capacity < UINT32_MAX ? capacity : UINT32_MAX);
    int result = deflate(&stream, last ? Z_FINISH : Z_FULL_FLUSH);
    bool whole = last ? result == Z_STREAM_END : result == Z_OK && stream.avail_in == 0 && stream.avail_out > 0;
    size_t written = whole ? (size_t)(stream.next_out - out) : 0;
    deflateEnd(&stream);
    return written;
}
#endif

// ---- fast ---------------------------------------------------------------------------------------------------------

#ifdef GLINT_HAVE_ISAL
#define TEXT_OF(x) #x
#define TEXT(x) TEXT_OF(x)
#define NAME_OF_FAST "isal " TEXT(ISAL_MAJOR_VERSION) "." TEXT(ISAL_MINOR_VERSION) "." TEXT(ISAL_PATCH_VERSION)

#define STREAM_BYTES sizeof(struct isal_zstream)

// ISA-L's level 1 enters the third position of its input in the wrong hash bucket: one that depends on the address of
// its stream object, not on the bytes (ISA-L 2.30 on x86, icf body without history). The output would depend on that
// address. So the stream is placed at an address that gives the right bucket. Streams stay mapped for later bands:
// mapping takes longer than deflating a band, and a picture needs few buckets, because its bands begin at its left
// edge.
#ifdef __x86_64__
#ifdef MAP_FIXED_NOREPLACE
#define MAP_THERE (MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED_NOREPLACE)
#else
#define MAP_THERE (MAP_PRIVATE | MAP_ANONYMOUS) // the address is only a hint; systems use it where nothing is mapped
#endif
#define BUCKET_BITS 13
#define ADDRESS_SHIFT 16 // The address of a place is its number shifted by this many bits
// number of the first place; programs do not use the 2^29 places from here on
#define FIRST_ADDRESS UINT32_C(0x20000000)
#define ADDRESS_BITS 29
#define ADDRESSES_TRIED 64 // each thread of each writer needs one place for each of its buckets
#define STREAMS 256 // number of streams cached for each thread

/// Returns the CRC-32C of four bytes from 0, as the crc32 instruction computes it: linear over the bits. The bucket is
/// its low bits.
static uint32_t bucket_of(uint32_t bytes)
{
    for (int i = 0; i < 32; i++)
        bytes = bytes >> 1 ^ (bytes & 1 ? 0x82f63b78 : 0);
    return bytes & ((1u << BUCKET_BITS) - 1);
}

/// Places relative to the first: for each bit of a bucket one place whose bucket has that bit as its highest, and some
/// places with bucket 0.
typedef struct basis {
    uint32_t address[BUCKET_BITS], bucket[BUCKET_BITS];
    uint32_t zero[ADDRESS_BITS];
    int zero_count;
} basis;

/// Removes from a bucket the bits that a place can provide. Returns that place; *bucket keeps the other bits.
static uint32_t address_for(const basis *p, uint32_t *bucket)
{
    uint32_t address = 0;
    for (int bit = BUCKET_BITS - 1; bit >= 0; bit--)
        if (*bucket >> bit & 1 && p->bucket[bit]) {
            *bucket ^= p->bucket[bit];
            address ^= p->address[bit];
        }
    return address;
}

/// Finds the places by Gaussian elimination over the bits of a place.
static basis find_basis(void)
{
    basis p = { .zero_count = 0 };
    for (int i = 0; i < ADDRESS_BITS; i++) {
        uint32_t bucket = bucket_of(UINT32_C(1) << i);
        const uint32_t address = UINT32_C(1) << i ^ address_for(&p, &bucket);
        if (bucket) {
            const int highest = 31 - __builtin_clz(bucket);
            p.bucket[highest] = bucket;
            p.address[highest] = address;
        } else {
            p.zero[p.zero_count++] = address;
        }
    }
    return p;
}

/// Maps memory for a stream at an address with this bucket. NULL: the system has no such address free.
static void *map_stream(uint32_t bucket)
{
    const basis p = find_basis();
    bucket ^= bucket_of(FIRST_ADDRESS);
    uint32_t address = FIRST_ADDRESS ^ address_for(&p, &bucket);
    for (int i = 1; bucket == 0 && i <= ADDRESSES_TRIED; i++) {
        void *want = (void *)((uintptr_t)address << ADDRESS_SHIFT);
        void *got = mmap(want, STREAM_BYTES, PROT_READ | PROT_WRITE, MAP_THERE, -1, 0);
        if (got == want)
            return got;
        if (got != MAP_FAILED)
            munmap(got, STREAM_BYTES);
        address ^= p.zero[__builtin_ctz((unsigned)i)]; // Gray code: every combination once
    }
    return NULL;
}

/// Cached streams, each at an address that gives its bucket.
typedef struct streams {
    void *stream[STREAMS];
    uint16_t bucket[STREAMS];
    uint32_t count, oldest;
} streams;

static void free_streams(streams *cache)
{
    for (uint32_t i = 0; i < cache->count; i++)
        munmap(cache->stream[i], STREAM_BYTES);
}

/// Caches a stream. If the cache is full, it replaces the oldest one.
static void cache_stream(streams *cache, void *stream, uint32_t bucket)
{
    uint32_t at = cache->count;
    if (at < STREAMS) {
        cache->count++;
    } else {
        at = cache->oldest;
        munmap(cache->stream[at], STREAM_BYTES);
        cache->oldest = (at + 1) % STREAMS;
    }
    cache->stream[at] = stream;
    cache->bucket[at] = (uint16_t)bucket;
}

/// Returns the stream for a band that begins with these bytes. NULL: no address gives their bucket.
static void *find_stream(streams *cache, const uint8_t *data, size_t size)
{
    uint32_t third = 0;
    if (size >= 2 + sizeof third)
        memcpy(&third, data + 2, sizeof third);
    const uint32_t bucket = bucket_of(third);
    for (uint32_t i = 0; i < cache->count; i++)
        if (cache->bucket[i] == bucket)
            return cache->stream[i];
    void *stream = map_stream(bucket);
    if (stream)
        cache_stream(cache, stream, bucket);
    return stream;
}
#else
typedef struct streams {
    char none; ///< the address of the stream does not matter
} streams;

static void free_streams(streams *cache) { (void)cache; }

static void *find_stream(streams *cache, const uint8_t *data, size_t size)
{
    (void)cache, (void)data, (void)size;
    return NULL;
}
#endif

struct glint_deflate_memory {
    uint8_t *level; ///< ISA-L's buffer for the level; owned
    void *anywhere; ///< a stream from malloc, for bands without a placed stream; owned
    streams placed;
};

static void free_memory(struct glint_deflate_memory *memory)
{
    free_streams(&memory->placed);
    free(memory->anywhere);
    free(memory->level);
}

/// Returns the stream for a band. NULL: out of memory.
static void *stream_for(struct glint_deflate_memory *memory, const uint8_t *data, size_t size)
{
    void *stream = find_stream(&memory->placed, data, size);
    if (!stream && !memory->anywhere)
        memory->anywhere = malloc(STREAM_BYTES);
    return stream ? stream : memory->anywhere;
}

static size_t fast_band_at(struct isal_zstream *stream, uint8_t *level, const uint8_t *data, size_t size, bool last,
                           uint8_t *out, size_t capacity)
{
    isal_deflate_stateless_init(stream);
    stream->hist_bits = 0; // the whole window; init leaves the field uninitialised
    stream->level = 1;
    stream->level_buf = level;
    stream->level_buf_size = ISAL_DEF_LVL1_DEFAULT;
    stream->gzip_flag = IGZIP_DEFLATE;
    stream->flush = last ? NO_FLUSH : FULL_FLUSH;
    stream->end_of_stream = last;
    stream->next_in = (uint8_t *)(uintptr_t)data; // not written: the interface lacks the const
    stream->avail_in = (uint32_t)size;
    stream->next_out = out;
    stream->avail_out = (uint32_t)(capacity < UINT32_MAX ? capacity : UINT32_MAX);
    return isal_deflate_stateless(stream) == COMP_OK ? stream->total_out : 0;
}

static size_t fast_band(struct glint_deflate_memory *memory, const uint8_t *data, size_t size, bool last, uint8_t *out,
                        size_t capacity)
{
    if (!memory->level)
        memory->level = malloc(ISAL_DEF_LVL1_DEFAULT);
    void *stream = memory->level ? stream_for(memory, data, size) : NULL;
    return stream ? fast_band_at(stream, memory->level, data, size, last, out, capacity) : 0;
}
#else
#define NAME_OF_FAST name_of_zlib()

struct glint_deflate_memory {
    char none; ///< zlib's memory does not outlive a band
};

static void free_memory(struct glint_deflate_memory *memory) { (void)memory; }

static size_t fast_band(struct glint_deflate_memory *memory, const uint8_t *data, size_t size, bool last, uint8_t *out,
                        size_t capacity)
{
    (void)memory;
    return band_by_zlib(FAST_LEVEL_ZLIB, data, size, last, out, capacity);
}
#endif

// ---- small --------------------------------------------------------------------------------------------------------

#ifdef GLINT_HAVE_LIBDEFLATE
#define NAME_OF_SMALL "libdeflate " LIBDEFLATE_VERSION_STRING
#define SMALL_HAS_BANDS false

static size_t small_band(const uint8_t *data, size_t size, bool last, uint8_t *out, size_t capacity)
{
    struct libdeflate_compressor *compressor = last ? libdeflate_alloc_compressor(SMALL_LEVEL_LIBDEFLATE) : NULL;
    if (!compressor)
        return 0;
    size_t written = libdeflate_deflate_compress(compressor, data, size, out, capacity);
    libdeflate_free_compressor(compressor);
    return written;
}
#else
#define NAME_OF_SMALL name_of_zlib()
#define SMALL_HAS_BANDS true

static size_t small_band(const uint8_t *data, size_t size, bool last, uint8_t *out, size_t capacity)
{
    return band_by_zlib(SMALL_LEVEL_ZLIB, data, size, last, out, capacity);
}
#endif

// ---- The interface ------------------------------------------------------------------------------------------------

const char *glint_encoder_name(glint_encode encode)
{
    return encode == GLINT_ENCODE_SMALL ? NAME_OF_SMALL : NAME_OF_FAST;
}

bool glint_deflate_has_bands(glint_encode encode) { return encode == GLINT_ENCODE_SMALL ? SMALL_HAS_BANDS : true; }

static uint32_t checksum(const uint8_t *data, size_t size)
{
#if defined GLINT_HAVE_LIBDEFLATE
    return libdeflate_adler32(1, data, size);
#elif defined GLINT_HAVE_ISAL
    return isal_adler32(1, data, size);
#else
    return (uint32_t)adler32_z(1, data, size);
#endif
}

struct glint_deflate_memory *glint_deflate_memory_create(void) { return calloc(1, sizeof(struct glint_deflate_memory)); }

void glint_deflate_memory_destroy(struct glint_deflate_memory *memory)
{
    if (memory)
        free_memory(memory);
    free(memory);
}

glint_status glint_deflate_band(struct glint_deflate_memory *memory, glint_encode encode, const uint8_t *data, size_t size,
                                bool last, glint_bytes *out, uint32_t *adler, glint_error *error)
{
    bool bands = glint_deflate_has_bands(encode);
    if (bands ? size > BAND_SIZE_MAX : !last)
        return glint_fail(error, GLINT_ERR_INVALID, "size: the encoder takes 2^31 bytes, or the whole, at a time");
    size_t capacity = capacity_for(size);
    if (!glint_bytes_reserve(out, capacity))
        return glint_fail_nomem(error);
    uint8_t *end = out->data + out->size;
    size_t written = encode == GLINT_ENCODE_SMALL ? small_band(data, size, last, end, capacity)
                                                  : fast_band(memory, data, size, last, end, capacity);
    if (!written) // the buffer is large enough, so only memory can be short
        return glint_fail_nomem(error);
    out->size += written;
    *adler = checksum(data, size);
    return GLINT_OK;
}

uint32_t glint_deflate_join(uint32_t first, uint32_t second, size_t second_size)
{
    return (uint32_t)adler32_combine(first, second, (z_off_t)second_size);
}

bool glint_deflate_begin(glint_bytes *out) { return glint_bytes_append(out, "\x78\x01", 2); }

bool glint_deflate_end(glint_bytes *out, uint32_t adler)
{
    uint8_t tail[4] = { (uint8_t)(adler >> 24), (uint8_t)(adler >> 16), (uint8_t)(adler >> 8), (uint8_t)adler };
    return glint_bytes_append(out, tail, sizeof tail);
}
