#include "engine/files/vector/figure.h"

#include "engine/base/status.h"
#include "engine/figures/ink/stamps.h"
#include "engine/files/picture/file.h"

/// A source of rows whose marks are drawn on the pixel values.
typedef struct inked {
    const glint_figure *figure;
    glint_stamps stamps;
} inked;

static const void *row_of_ink(const void *user, int y, void *scratch)
{
    const inked *from = user;
    const glint_png_source *source = from->figure->source;
    const void *row = source->row(source->user, y, scratch);
    if (row != scratch)
        memcpy(scratch, row, (size_t)source->width * glint_png_pixel_bytes(source));
    glint_stamps_row(&from->stamps, from->figure->x, from->figure->y + y, source->width, source->alpha ? 4 : 3,
                     scratch);
    return scratch;
}

static glint_status encode_png(const glint_figure *figure, const glint_png_desc *desc, glint_bytes *out,
                               glint_error *error)
{
    glint_png_source source = *figure->source;
    inked from = { .figure = figure };
    if (!figure->ink)
        return glint_png_encode(NULL, &source, desc, out, NULL, error);
    glint_status status = glint_stamps_make(figure->ink, source.tone.transfer, source.tone.bits, &from.stamps, error);
    if (status)
        return status;
    source.row = row_of_ink;
    source.user = &from;
    source.stamp = NULL;
    status = glint_png_encode(NULL, &source, desc, out, NULL, error);
    glint_stamps_free(&from.stamps);
    return status;
}

glint_status glint_figure_encode(const glint_figure *figure, glint_file_kind kind, const glint_png_desc *desc,
                                 glint_bytes *out, glint_error *error)
{
    if (kind == GLINT_FILE_SVG)
        return glint_svg_encode(figure, desc, out, error);
    if (kind == GLINT_FILE_PDF)
        return glint_pdf_encode(figure, desc, out, error);
    return encode_png(figure, desc, out, error);
}

glint_status glint_figure_write(const glint_figure *figure, const char *path, const glint_png_desc *desc,
                                glint_error *error)
{
    glint_file_kind kind;
    glint_bytes bytes = { 0 };
    glint_status status = glint_file_kind_of(path, &kind, error);
    if (!status)
        status = glint_figure_encode(figure, kind, desc, &bytes, error);
    if (!status)
        status = glint_file_write(path, bytes.data, bytes.size, error);
    free(bytes.data);
    return status;
}
