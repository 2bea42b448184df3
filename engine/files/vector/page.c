/// The overlays of a picture as vectors, for a page that shows them over its pixels.
#include "engine/base/status.h"
#include "engine/figures/overlay/overlay.h"
#include "engine/files/vector/figure.h"
#include "engine/film/image.h"

#include <math.h>
#include <stdlib.h>

const glint_image *glint_image_without_overlays(const glint_image *image)
{
    return image && image->under ? image->under : image;
}

static glint_status check(const glint_page *page, glint_error *error)
{
    const int sides[] = { page->width, page->height };
    for (int i = 0; i < 2; i++)
        if (sides[i] < 1 || sides[i] > GLINT_SIDE_MAX)
            return glint_fail(error, GLINT_ERR_INVALID, "page.%s: expected 1 .. %d, got %d", i ? "height" : "width", GLINT_SIDE_MAX, sides[i]);
    if (!(page->scale > 0 && isfinite(page->scale)))
        return glint_fail(error, GLINT_ERR_INVALID, "page.scale: expected a finite number above 0, got %g", page->scale);
    if (!(page->least >= 0 && page->least <= 1000))
        return glint_fail(error, GLINT_ERR_INVALID, "page.least: expected 0 .. 1000, got %g", page->least);
    return GLINT_OK;
}

/// Encodes the marks as a string.
static glint_status encode(const glint_overlays *overlays, const glint_page *page, double dpi, const double box[4], char **svg,
                           glint_error *error)
{
    glint_ink ink;
    glint_bytes bytes = { 0 };
    glint_status status = glint_ink_open(overlays->width, overlays->height, &ink, error);
    if (status)
        return status;
    status = glint_overlays_draw(overlays, dpi, &ink, error);
    if (!status)
        status = glint_svg_encode_marks(&ink, box, page->transfer, &bytes, error);
    glint_ink_close(&ink);
    if (!status && !glint_bytes_append(&bytes, "", 1))
        status = glint_fail_nomem(error);
    if (status)
        free(bytes.data);
    else
        *svg = (char *)bytes.data;
    return status;
}

glint_status glint_image_overlays_svg(const glint_image *image, const glint_page *page, char **svg, glint_error *error)
{
    GLINT_REFUSE_NULL(image, error);
    GLINT_REFUSE_NULL(page, error);
    GLINT_REFUSE_NULL(svg, error);
    glint_status status = check(page, error);
    *svg = NULL;
    if (status || !image->cover)
        return status;
    const double factor[] = { (double)page->width / image->width, (double)page->height / image->height };
    const double box[] = { image->part_x * factor[0], image->part_y * factor[1], page->width, page->height };
    const double dpi = (page->dpi > 0 ? page->dpi : 72) * page->scale;
    glint_overlays *overlays = glint_overlays_resize((const glint_overlays *)image->cover, factor, page->scale, page->least, dpi);
    if (!overlays)
        return glint_fail_nomem(error);
    status = encode(overlays, page, dpi, box, svg, error);
    glint_cover_release(&overlays->base);
    return status;
}
