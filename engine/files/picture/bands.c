#include "engine/files/picture/bands.h"

#include "engine/base/pool.h"
#include "engine/base/status.h"
#include "engine/files/picture/deflate.h"
#include "engine/film/tone.h"

#include <stdatomic.h>

// least size of a band after filtering, bytes; fixed, so that no setting changes the file
#define BAND_BYTES ((size_t)1 << 17)
#define RETAINED_WORK_BYTES ((size_t)1 << 24) // a worker with a larger buffer frees it after use
#define FILTER_SUB 1
#define VECTOR 16

typedef uint8_t vector8 __attribute__((vector_size(VECTOR)));
typedef uint16_t vector16 __attribute__((vector_size(VECTOR)));

/// The properties that must agree for stamps to be comparable, and for bands to be reusable.
typedef struct layout {
    int width, height;
    bool alpha;
    glint_tone_desc tone;
    glint_encode encode;
    size_t row_bytes; ///< bytes of a row, without the byte that names the filter
    size_t band_rows; ///< rows of every band except the last
    size_t band_count, stamp_count;
} layout;

typedef struct band {
    uint8_t *deflated; ///< owned
    size_t size;
    uint32_t adler;
} band;

/// A picture's bands. {0} has none.
typedef struct picture {
    layout layout;
    band *band;
    uint64_t *stamp; ///< for each band, the stamp of its rows of tiles; 0: the band is missing or its content unknown
    size_t *todo; ///< indices of the bands that have to be made
} picture;

/// Buffers of one thread for one band.
typedef struct worker {
    glint_bytes rows, swapped, raw, deflated; ///< reused at their capacity
    struct glint_deflate_memory *encoder; ///< owned; NULL until the first band
} worker;

struct glint_bands {
    int threads;
    glint_pool *pool; ///< NULL: only the caller's thread
    picture last;
    glint_bytes stream; ///< zlib stream of the last picture
    worker worker[];
};

// ---- Rows ---------------------------------------------------------------------------------------------------------

/// Applies the filter SUB: subtracts from each byte the one `step` bytes before it.
static void filter_sub(const uint8_t *row, size_t bytes, size_t step, uint8_t *out)
{
    *out++ = FILTER_SUB;
    memcpy(out, row, step);
    size_t i = step;
    for (; i + VECTOR <= bytes; i += VECTOR) {
        vector8 here, before;
        memcpy(&here, row + i, VECTOR);
        memcpy(&before, row + i - step, VECTOR);
        here -= before;
        memcpy(out + i, &here, VECTOR);
    }
    for (; i < bytes; i++)
        out[i] = (uint8_t)(row[i] - row[i - step]);
}

/// Converts native 16-bit pixel values to the file's byte order, high byte first.
static void swap_to_file(const uint16_t *codes, size_t count, uint8_t *out)
{
    size_t i = 0;
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    for (; i + VECTOR / 2 <= count; i += VECTOR / 2) {
        vector16 v;
        memcpy(&v, codes + i, VECTOR);
        v = v << 8 | v >> 8;
        memcpy(out + 2 * i, &v, VECTOR);
    }
#endif
    for (; i < count; i++) {
        uint16_t code = codes[i];
        out[2 * i] = (uint8_t)(code >> 8);
        out[2 * i + 1] = (uint8_t)code;
    }
}

static void filter_rows(const glint_png_source *source, size_t row_bytes, size_t first, size_t count, worker *memory)
{
    const bool wide = source->tone.bits == 16;
    uint8_t *out = memory->raw.data;
    for (size_t y = first; y < first + count; y++, out += row_bytes + 1) {
        const void *codes = source->row(source->user, (int)y, memory->rows.data);
        if (wide)
            swap_to_file(codes, row_bytes / 2, memory->swapped.data);
        filter_sub(wide ? memory->swapped.data : codes, row_bytes, glint_png_pixel_bytes(source), out);
    }
}

// ---- One band -----------------------------------------------------------------------------------------------------

typedef struct task {
    const glint_png_source *source;
    picture *picture;
    worker *worker;
    atomic_bool failed;
} task;

static bool ensure_capacity(worker *memory, const layout *l, size_t rows)
{
    return glint_bytes_reserve(&memory->rows, l->row_bytes) &&
           (l->tone.bits == 8 || glint_bytes_reserve(&memory->swapped, l->row_bytes)) &&
           glint_bytes_reserve(&memory->raw, (l->row_bytes + 1) * rows) &&
           (memory->encoder || (memory->encoder = glint_deflate_memory_create()));
}

/// Stores a copy of the bytes in the band, in a block of exactly their size.
static bool keep(band *b, const glint_bytes *deflated)
{
    if (b->size != deflated->size) {
        free(b->deflated);
        b->size = 0;
        b->deflated = malloc(deflated->size);
        if (!b->deflated)
            return false;
    }
    b->size = deflated->size;
    memcpy(b->deflated, deflated->data, deflated->size);
    return true;
}

static bool make_band(task *t, size_t index, worker *memory)
{
    const layout *l = &t->picture->layout;
    band *b = &t->picture->band[index];
    const size_t first = index * l->band_rows, remaining = (size_t)l->height - first;
    const size_t rows = remaining < l->band_rows ? remaining : l->band_rows;
    if (!ensure_capacity(memory, l, rows))
        return false;
    filter_rows(t->source, l->row_bytes, first, rows, memory);
    memory->deflated.size = 0;
    return glint_deflate_band(memory->encoder, l->encode, memory->raw.data, (l->row_bytes + 1) * rows,
                              index + 1 == l->band_count, &memory->deflated, &b->adler, NULL) == GLINT_OK &&
           keep(b, &memory->deflated);
}

static void make_item(void *context, size_t index, int number)
{
    task *t = context;
    if (!atomic_load(&t->failed) && !make_band(t, t->picture->todo[index], &t->worker[number]))
        atomic_store(&t->failed, true);
}

static void free_bytes(glint_bytes *bytes)
{
    free(bytes->data);
    *bytes = (glint_bytes) { 0 };
}

static void free_worker(worker *memory)
{
    free_bytes(&memory->rows);
    free_bytes(&memory->swapped);
    free_bytes(&memory->raw);
    free_bytes(&memory->deflated);
    glint_deflate_memory_destroy(memory->encoder);
    memory->encoder = NULL;
}

// ---- A picture ----------------------------------------------------------------------------------------------------

static layout layout_of(const glint_png_source *source, glint_encode encode)
{
    layout l = { .width = source->width, .height = source->height, .tone = source->tone, .encode = encode };
    const size_t height = (size_t)l.height;
    l.alpha = source->alpha;
    l.row_bytes = (size_t)l.width * glint_png_pixel_bytes(source);
    const size_t tile_row = (l.row_bytes + 1) * GLINT_TILE_HEIGHT; // at most 2^24
    l.band_rows = (BAND_BYTES + tile_row - 1) / tile_row * GLINT_TILE_HEIGHT;
    if (l.band_rows > height || !glint_deflate_has_bands(encode))
        l.band_rows = height;
    l.band_count = (height + l.band_rows - 1) / l.band_rows;
    l.stamp_count = (height + GLINT_TILE_HEIGHT - 1) / GLINT_TILE_HEIGHT;
    return l;
}

static bool same_layout(const layout *a, const layout *b)
{
    return a->width == b->width && a->height == b->height && a->alpha == b->alpha &&
           glint_tone_same(&a->tone, &b->tone) && a->encode == b->encode;
}

static void free_picture(picture *p)
{
    for (size_t i = 0; p->band && i < p->layout.band_count; i++)
        free(p->band[i].deflated);
    free(p->band);
    free(p->stamp);
    free(p->todo);
    *p = (picture) { 0 };
}

/// Sets the layout of `p`. Keeps the bands if the layout is unchanged.
static bool lay_out(picture *p, const layout *l)
{
    if (p->band && same_layout(&p->layout, l))
        return true;
    free_picture(p);
    p->layout = *l;
    p->band = calloc(l->band_count, sizeof *p->band);
    p->stamp = calloc(l->stamp_count, sizeof *p->stamp);
    p->todo = calloc(l->band_count, sizeof *p->todo);
    if (p->band && p->stamp && p->todo)
        return true;
    free_picture(p);
    return false;
}

/// Lists the bands that the picture lacks, and marks them as missing until they are made.
static size_t list_missing(picture *p, const uint64_t *stamp)
{
    size_t count = 0;
    const size_t step = (p->layout.band_rows + GLINT_TILE_HEIGHT - 1) / GLINT_TILE_HEIGHT;
    for (size_t i = 0; i < p->layout.band_count; i++) {
        const size_t first = i * step, end = first + step;
        bool missing = !stamp;
        for (size_t s = first; s < end && s < p->layout.stamp_count && !missing; s++)
            missing = stamp[s] == 0 || stamp[s] != p->stamp[s];
        if (!missing)
            continue;
        p->todo[count++] = i;
        for (size_t s = first; s < end && s < p->layout.stamp_count; s++)
            p->stamp[s] = 0;
    }
    return count;
}

static bool make_stream(const picture *p, glint_bytes *stream)
{
    const layout *l = &p->layout;
    uint32_t sum = 1;
    stream->size = 0;
    bool done = glint_deflate_begin(stream);
    for (size_t i = 0; i < l->band_count && done; i++) {
        const size_t remaining = (size_t)l->height - i * l->band_rows;
        const size_t rows = remaining < l->band_rows ? remaining : l->band_rows;
        sum = glint_deflate_join(sum, p->band[i].adler, (l->row_bytes + 1) * rows);
        done = glint_bytes_append(stream, p->band[i].deflated, p->band[i].size);
    }
    return done && glint_deflate_end(stream, sum);
}

static bool deflate_picture(glint_bands *bands, picture *p, const glint_png_source *source, double *reused)
{
    const size_t count = list_missing(p, source->stamp);
    task t = { .source = source, .picture = p, .worker = bands->worker };
    if (bands->pool && count > 1)
        glint_pool_run(bands->pool, count, make_item, &t);
    else
        for (size_t i = 0; i < count; i++)
            make_item(&t, i, 0);
    for (int i = 0; i < bands->threads; i++)
        if (bands->worker[i].raw.capacity > RETAINED_WORK_BYTES)
            free_worker(&bands->worker[i]);
    if (bands->stream.capacity > RETAINED_WORK_BYTES)
        free_bytes(&bands->stream);
    if (atomic_load(&t.failed))
        return false;
    if (source->stamp)
        memcpy(p->stamp, source->stamp, p->layout.stamp_count * sizeof *p->stamp);
    if (reused)
        *reused = 1 - (double)count / (double)p->layout.band_count;
    return make_stream(p, &bands->stream);
}

// ---- The interface ------------------------------------------------------------------------------------------------

glint_status glint_bands_create(int threads, glint_bands **out, glint_error *error)
{
    glint_status status = glint_check_whole("threads", threads, 1, 1024, error);
    if (status)
        return status;
    glint_bands *bands = calloc(1, sizeof *bands + (size_t)threads * sizeof *bands->worker);
    if (!bands)
        return glint_fail_nomem(error);
    bands->threads = threads;
    if (threads > 1)
        status = glint_pool_create(threads, &bands->pool, error);
    if (status) {
        free(bands);
        return status;
    }
    *out = bands;
    return GLINT_OK;
}

void glint_bands_destroy(glint_bands *bands)
{
    if (!bands)
        return;
    glint_pool_destroy(bands->pool);
    for (int i = 0; i < bands->threads; i++)
        free_worker(&bands->worker[i]);
    free_picture(&bands->last);
    free_bytes(&bands->stream);
    free(bands);
}

glint_status glint_bands_deflate(glint_bands *bands, const glint_png_source *source, glint_encode encode,
                                 const glint_bytes **stream, double *reused, glint_error *error)
{
    // a picture without stamps is stored here; it is not cached and does not replace the cached picture
    picture passing = { 0 };
    picture *p = source->stamp ? &bands->last : &passing;
    const layout l = layout_of(source, encode);
    const bool done = lay_out(p, &l) && deflate_picture(bands, p, source, reused);
    free_picture(&passing);
    *stream = &bands->stream;
    return done ? GLINT_OK : glint_fail_nomem(error);
}
