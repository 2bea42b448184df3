// Pictures of glint watch: as PNG bytes, and reduced for a terminal.
#include <stdlib.h>
#include <string.h>

#include "bindings/watch/watch.h"

// ---- PNG in memory ----

watch_picture *watch_picture_create(const glint_image *image, const glintL_render *render, glint_error *error)
{
    watch_picture *picture = calloc(1, sizeof *picture);
    glint_write_desc desc = { .struct_size = sizeof(glint_write_desc),
        .path = "watch.png", .pass = GLINT_PASS_BEAUTY, .tone = render->desc.tone, .dpi = render->dpi
    };
    desc.tone.bits = 8; // a screen shows no more
    if (!picture) {
        *error = (glint_error) { GLINT_ERR_NOMEM, "out of memory" };
        return NULL;
    }
    atomic_init(&picture->references, 1);
    picture->width = glint_image_width(image);
    picture->height = glint_image_height(image);
    if (glint_image_to_bytes(image, &desc, &picture->bytes, &picture->size, error) == GLINT_OK)
        return picture;
    watch_picture_release(picture);
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

// Returns the pixels, from *from up to *to, that element `i` of `places` covers; at least one.
static void span(int i, int places, int pixels, int *from, int *to)
{
    *from = (int)((int64_t)i * pixels / places);
    *to = (int)((int64_t)(i + 1) * pixels / places);
    if (*to <= *from)
        *to = *from + 1;
}

typedef struct shrinking {
    const glint_picture *from;
    watch_small *to;
    double light[256], *sums; // light: linear light of each pixel value; sums: sums of a row
    unsigned char *row; // row of the full picture
} shrinking;

// Computes row y of the reduced picture by averaging.
static void shrink_row(shrinking *s, int y)
{
    const int width = s->to->width;
    int x0, x1, y0, y1;
    span(y, s->to->height, glint_picture_height(s->from), &y0, &y1);
    memset(s->sums, 0, (size_t)width * 3 * sizeof *s->sums);
    for (int from = y0; from < y1; from++) {
        glint_picture_row(s->from, from, 0, s->row);
        for (int x = 0; x < width; x++) {
            span(x, width, glint_picture_width(s->from), &x0, &x1);
            for (int i = 3 * x0; i < 3 * x1; i++)
                s->sums[3 * x + i % 3] += s->light[s->row[i]] / (x1 - x0);
        }
    }
    for (int i = 0; i < 3 * width; i++)
        s->to->rgb[(size_t)y * (size_t)width * 3 + (size_t)i] =
            (unsigned char)(glint_srgb_encode(s->sums[i] / (y1 - y0)) * 255 + 0.5);
}

bool watch_small_create(const watch_picture *from, int width, int height, watch_small *out)
{
    glint_picture *picture = NULL;
    glint_error error;
    *out = (watch_small) { width, height, malloc((size_t)width * (size_t)height * 3) };
    shrinking s = { .to = out,
                    .sums = malloc((size_t)width * 3 * sizeof(double)),
                    .row = malloc((size_t)from->width * 3) };
    const bool good =
        out->rgb && s.sums && s.row && glint_picture_from_bytes(from->bytes, from->size, &picture, &error) == GLINT_OK;
    s.from = picture;
    for (int code = 0; code < 256; code++)
        s.light[code] = glint_srgb_decode(code / 255.0);
    for (int y = 0; y < height && good; y++)
        shrink_row(&s, y);
    glint_picture_destroy(picture);
    free(s.row);
    free(s.sums);
    if (!good)
        free(out->rgb);
    return good;
}
