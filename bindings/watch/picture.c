// Pictures of glint watch: as PNG bytes, and made small for a terminal.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bindings/watch/watch.h"

// ---- PNG in memory: the engine writes into a pipe, read here ----

typedef struct encoding {
    const glint_image *image;
    glint_write_desc desc;
    int end; // of the pipe, for writing
    glint_status status;
    glint_error error;
} encoding;

static void *encode(void *argument)
{
    encoding *e = argument;
    e->status = glint_image_write(e->image, &e->desc, &e->error);
    close(e->end);
    return NULL;
}

// Reads to the end. False: out of memory; the rest is read all the same, so that the writer can end.
static bool read_all(int from, watch_picture *picture)
{
    size_t room = 0;
    bool good = true;
    char spilled[4096];
    for (;;) {
        if (good && picture->size == room) {
            size_t more = room ? 2 * room : 1 << 18;
            unsigned char *grown = realloc(picture->bytes, more);
            good = grown != NULL;
            picture->bytes = grown ? grown : picture->bytes;
            room = grown ? more : room;
        }
        ssize_t got = good ? read(from, picture->bytes + picture->size, room - picture->size)
                           : read(from, spilled, sizeof spilled);
        if (got == 0)
            return good;
        if (got > 0 && good)
            picture->size += (size_t)got;
        if (got < 0 && errno != EINTR)
            return false;
    }
}

watch_picture *watch_picture_create(const glint_image *image, const glintL_render *render, glint_error *error)
{
    char path[32];
    int ends[2] = { -1, -1 };
    pthread_t thread;
    watch_picture *picture = calloc(1, sizeof *picture);
    if (!picture || !glintL_pipe(ends))
        goto fail;
    atomic_init(&picture->references, 1);
    glintL_end_path(ends[1], path);
    encoding e = { .image = image, .end = ends[1] };
    e.desc = (glint_write_desc) { .path = path, .pass = GLINT_PASS_BEAUTY, .tone = render->desc.tone };
    e.desc.tone.bits = 8; // a screen shows no more
    if (pthread_create(&thread, NULL, encode, &e) != 0)
        goto fail;
    bool good = read_all(ends[0], picture);
    close(ends[0]);
    pthread_join(thread, NULL);
    if (good && e.status == GLINT_OK)
        return picture;
    *error = e.error;
    if (e.status == GLINT_OK)
        snprintf(error->message, sizeof error->message, "out of memory");
    watch_picture_release(picture);
    return NULL;
fail:
    snprintf(error->message, sizeof error->message, "picture: %s", strerror(errno));
    error->status = GLINT_ERR_IO;
    for (int i = 0; i < 2; i++)
        if (ends[i] >= 0)
            close(ends[i]);
    free(picture);
    return NULL;
}

watch_picture *watch_picture_retain(watch_picture *picture)
{
    atomic_fetch_add(&picture->references, 1);
    return picture;
}

void watch_picture_release(watch_picture *picture)
{
    if (!picture || atomic_fetch_sub(&picture->references, 1) > 1)
        return;
    free(picture->bytes);
    free(picture);
}

// ---- Small pictures ----

// sRGB transfer function, IEC 61966-2-1:1999. For a terminal only: files have the engine's, the same on every machine.
static unsigned char code_of(double linear)
{
    double x = linear > 0 ? fmin(linear, 1) : 0; // NaN becomes 0
    double v = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
    return (unsigned char)(v * 255 + 0.5);
}

static void average(const glint_image *image, int x0, int x1, int y0, int y1, unsigned char out[3])
{
    glint_error error;
    double sum[3] = { 0 };
    float pixel[3];
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            if (glint_image_pixel(image, GLINT_PASS_BEAUTY, x, y, pixel, &error) == GLINT_OK)
                for (int c = 0; c < 3; c++)
                    sum[c] += fmin(pixel[c], 1);
    for (int c = 0; c < 3; c++)
        out[c] = code_of(sum[c] / ((double)(x1 - x0) * (y1 - y0)));
}

// The pixels from *from up to *to belong to place `i` of `places`; at least one.
static void span(int i, int places, int pixels, int *from, int *to)
{
    *from = (int)((int64_t)i * pixels / places);
    *to = (int)((int64_t)(i + 1) * pixels / places);
    if (*to <= *from)
        *to = *from + 1;
}

bool watch_small_create(const glint_image *image, int width, int height, watch_small *out)
{
    *out = (watch_small) { width, height, malloc((size_t)width * (size_t)height * 3) };
    for (int y = 0; y < height && out->rgb; y++)
        for (int x = 0; x < width; x++) {
            int x0, x1, y0, y1;
            span(x, width, glint_image_width(image), &x0, &x1);
            span(y, height, glint_image_height(image), &y0, &y1);
            average(image, x0, x1, y0, y1, out->rgb + ((size_t)y * (size_t)width + (size_t)x) * 3);
        }
    return out->rgb != NULL;
}
