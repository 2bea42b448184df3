/// Writes .pdf with cairo, which embeds the letters that the page uses.
#include "engine/files/vector/figure.h"

#include "engine/base/status.h"

#ifdef GLINT_HAVE_CAIRO

#include "engine/figures/ink/stamps.h"
#include "engine/figures/text/font.h"
#include "engine/figures/text/line.h"

#include <cairo-ft.h>
#include <cairo-pdf.h>

#include <errno.h>
#include <math.h>

#define SIDE_MAX 32767 ///< longest side of a cairo image, pixels

typedef struct pdf {
    cairo_t *cairo;
    const glint_figure *figure;
    cairo_surface_t *colors, *mask; ///< pixels
    cairo_surface_t *holders[2]; ///< see hold_copy
    cairo_font_face_t *face; ///< font of all texts; NULL: no text so far
    bool lost; ///< out of memory outside of cairo
} pdf;

/// Notes a failed allocation that cairo 1.16 keeps to itself: errno still tells it.
static void note_lost(pdf *p)
{
    p->lost = p->lost || errno == ENOMEM;
    errno = 0;
}

// ---- Pixels -------------------------------------------------------------------------------------------------------

/// Copies a row of codes to the 32-bit pixels of cairo, and its alpha to a row of bytes unless `alpha` is NULL.
static void copy_row(const glint_png_source *source, const uint8_t *row, uint32_t *out, uint8_t *alpha)
{
    const int channels = source->alpha ? 4 : 3;
    for (int x = 0; x < source->width; x++, row += channels) {
        out[x] = (uint32_t)row[0] << 16 | (uint32_t)row[1] << 8 | row[2];
        if (alpha)
            alpha[x] = row[3];
    }
}

static void copy_rows(pdf *p, cairo_surface_t *colors, cairo_surface_t *mask)
{
    const glint_png_source *source = p->figure->source;
    uint8_t *scratch = malloc((size_t)source->width * 4), *alpha = mask ? cairo_image_surface_get_data(mask) : NULL;
    uint8_t *out = cairo_image_surface_get_data(colors);
    p->lost = p->lost || !scratch || cairo_surface_status(colors) || (mask && cairo_surface_status(mask));
    for (int y = 0; y < source->height && scratch && out && (alpha || !mask); y++) {
        copy_row(source, source->row(source->user, y, scratch), (uint32_t *)(void *)out, alpha);
        out += cairo_image_surface_get_stride(colors);
        alpha = mask ? alpha + cairo_image_surface_get_stride(mask) : NULL;
    }
    free(scratch);
    cairo_surface_mark_dirty(colors);
    if (mask)
        cairo_surface_mark_dirty(mask);
}

/// Returns a recording that shows pixels, and therefore holds the copy that cairo makes when the pixels are destroyed.
static cairo_surface_t *hold_copy(cairo_surface_t *pixels)
{
    cairo_surface_t *holder = cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, NULL);
    cairo_t *cairo = cairo_create(holder);
    cairo_set_source_surface(cairo, pixels, 0, 0);
    cairo_paint(cairo);
    cairo_destroy(cairo);
    return holder;
}

/// Destroys pixels. cairo 1.16 crashes when it destroys a copy for which it had no memory, so such a copy is kept.
static void destroy_pixels(cairo_surface_t *pixels, cairo_surface_t *holder)
{
    errno = 0;
    cairo_surface_destroy(pixels);
    if (errno != ENOMEM)
        cairo_surface_destroy(holder);
}

/// Draws the picture. Its alpha is a mask, because cairo's pixels with alpha are products and would lose bits of the
/// colours.
static void draw_picture(pdf *p)
{
    const glint_png_source *source = p->figure->source;
    cairo_surface_t *colors = cairo_image_surface_create(CAIRO_FORMAT_RGB24, source->width, source->height);
    cairo_surface_t *mask =
        source->alpha ? cairo_image_surface_create(CAIRO_FORMAT_A8, source->width, source->height) : NULL;
    copy_rows(p, colors, mask);
    p->colors = colors;
    p->mask = mask;
    if (p->lost)
        return;
    p->holders[0] = hold_copy(colors);
    p->holders[1] = mask ? hold_copy(mask) : NULL;
    cairo_set_source_surface(p->cairo, colors, p->figure->x, p->figure->y);
    cairo_pattern_set_filter(cairo_get_source(p->cairo), CAIRO_FILTER_NEAREST); // readers show the pixel values
    if (mask)
        cairo_mask_surface(p->cairo, mask, p->figure->x, p->figure->y);
    else
        cairo_paint(p->cairo);
}

// ---- Marks --------------------------------------------------------------------------------------------------------

static void set_color(pdf *p, const glint_ink_mark *mark)
{
    double code[3];
    for (int c = 0; c < 3; c++)
        code[c] = glint_ink_code(mark->color[c], p->figure->source->tone.transfer, 8) / 255.0;
    cairo_set_source_rgba(p->cairo, code[0], code[1], code[2], mark->opacity);
}

static void draw_fill(pdf *p, const glint_ink_mark *mark)
{
    cairo_rectangle(p->cairo, mark->box.x, mark->box.y, mark->box.width, mark->box.height);
    cairo_fill(p->cairo);
}

static void draw_strokes(pdf *p, const glint_ink_mark *mark)
{
    const glint_strokes *strokes = &mark->strokes;
    double x = 0, y = 0;
    for (size_t i = 0; i < strokes->count; i++) {
        const double *from = strokes->of[i].from, *offset = strokes->of[i].offset;
        if (!i || fabs(from[0] - x) + fabs(from[1] - y) > 1e-6)
            cairo_move_to(p->cairo, from[0], from[1]);
        x = from[0] + offset[0];
        y = from[1] + offset[1];
        cairo_line_to(p->cairo, x, y);
    }
    cairo_set_line_width(p->cairo, 2 * strokes->half);
    cairo_stroke(p->cairo);
    for (int i = 0; i < 3 && strokes->has_head; i++)
        cairo_line_to(p->cairo, strokes->head[i][0], strokes->head[i][1]);
    cairo_fill(p->cairo);
}

/// Draws a letter of the bitmap font, which is one unit high. Called by cairo.
static cairo_status_t draw_bitmap_letter(cairo_scaled_font_t *font, unsigned long glyph, cairo_t *cairo,
                                         cairo_text_extents_t *extents)
{
    const double pixel = 1.0 / GLINT_FONT_HEIGHT;
    char utf8[5] = "";
    const char *at = utf8;
    (void)font;
    glint_font_encode((uint32_t)glyph, utf8);
    const uint8_t *rows = glint_font_next(&at);
    for (int row = 0; row < GLINT_FONT_HEIGHT; row++)
        for (int column = 0; column < GLINT_FONT_WIDTH; column++)
            if (rows[row] >> (GLINT_FONT_WIDTH - 1 - column) & 1)
                cairo_rectangle(cairo, column * pixel, (row - GLINT_FONT_ABOVE) * pixel, pixel, pixel);
    cairo_fill(cairo);
    extents->x_advance = GLINT_FONT_WIDTH * pixel;
    return CAIRO_STATUS_SUCCESS;
}

/// Opens the font for cairo: the same file, so that glyphs have the same numbers.
static cairo_font_face_t *open_face(const glint_letters *letters)
{
    if (!letters) {
        cairo_font_face_t *face = cairo_user_font_face_create();
        cairo_user_font_face_set_render_glyph_func(face, draw_bitmap_letter);
        return face;
    }
    FcPattern *pattern = FcPatternCreate();
    if (!pattern)
        return NULL;
    cairo_font_face_t *face = NULL;
    if (FcPatternAddString(pattern, FC_FILE, (const FcChar8 *)glint_letters_name(letters).path) &&
        FcPatternAddInteger(pattern, FC_INDEX, 0))
        face = cairo_ft_font_face_create_for_pattern(pattern);
    FcPatternDestroy(pattern);
    return face;
}

/// Moves the origin to the upper left corner of a text, and turns the page so that the text runs to the right.
static void move_to_text(pdf *p, const glint_ink_mark *mark)
{
    const glint_rect *box = &mark->box;
    if (mark->turn == GLINT_LEVEL)
        cairo_translate(p->cairo, box->x, box->y);
    else if (mark->turn == GLINT_DOWN)
        cairo_translate(p->cairo, box->x + box->width, box->y);
    else
        cairo_translate(p->cairo, box->x, box->y + box->height);
    if (mark->turn)
        cairo_rotate(p->cairo, mark->turn == GLINT_DOWN ? M_PI / 2 : -M_PI / 2);
}

/// The letters of a run, as cairo takes them.
typedef struct letters {
    glint_letter *placed;
    cairo_glyph_t *glyphs;
    cairo_text_cluster_t *clusters;
    char *utf8;
} letters;

/// Draws a run whose line begins at x, y. Bold letters have a line around them, and grow to the right and upwards.
static void show_run(pdf *p, const glint_typeface *typeface, const glint_run *run, double x, double y, const letters *l)
{
    const int count = (int)glint_font_count(run->text, run->size);
    const double growth = glint_letters_growth(run), slant = typeface->letters ? run->slant : 0;
    const double em = typeface->letters ? run->em : GLINT_FONT_HEIGHT * glint_typeface_scale(run->em);
    const cairo_matrix_t shape = { em, 0, -slant * em, run->stretch * em, 0, 0 };
    size_t size = 0;
    glint_typeface_place(typeface, run, l->placed);
    for (int i = 0; i < count; i++) {
        const size_t bytes = glint_font_encode(l->placed[i].code, l->utf8 + size);
        l->glyphs[i] =
            (cairo_glyph_t) { l->placed[i].glyph, x + run->x + l->placed[i].x + growth / 2, y + run->y - growth / 2 };
        l->clusters[i] = (cairo_text_cluster_t) { (int)bytes, 1 };
        size += bytes;
    }
    cairo_set_font_matrix(p->cairo, &shape);
    cairo_show_text_glyphs(p->cairo, l->utf8, (int)size, l->glyphs, count, l->clusters, count, 0);
    if (!run->bold)
        return;
    cairo_glyph_path(p->cairo, l->glyphs, count);
    cairo_set_line_width(p->cairo, growth);
    cairo_stroke(p->cairo);
}

static void draw_run(pdf *p, const glint_typeface *typeface, const glint_run *run, double x, double y)
{
    const size_t count = glint_font_count(run->text, run->size);
    letters l = { .placed = calloc(count + 1, sizeof *l.placed), .glyphs = calloc(count + 1, sizeof *l.glyphs) };
    l.clusters = calloc(count + 1, sizeof *l.clusters);
    l.utf8 = calloc(count + 1, 4);
    if (l.placed && l.glyphs && l.clusters && l.utf8)
        show_run(p, typeface, run, x, y, &l);
    else
        p->lost = true;
    free(l.placed);
    free(l.glyphs);
    free(l.clusters);
    free(l.utf8);
}

static void draw_text(pdf *p, const glint_ink_mark *mark)
{
    glint_line line;
    if (!p->face)
        p->face = open_face(mark->typeface.letters);
    if (!p->face) {
        p->lost = true;
        return;
    }
    glint_line_set(&mark->typeface, mark->text, SIZE_MAX, &line);
    move_to_text(p, mark);
    cairo_set_font_face(p->cairo, p->face);
    for (int i = 0; i < line.run_count; i++)
        draw_run(p, &mark->typeface, &line.runs[i], line.pad, line.above);
    for (int i = 0; i < line.rule_count; i++) {
        const glint_rule *rule = &line.rules[i];
        cairo_rectangle(p->cairo, line.pad + rule->x, line.above + rule->y, rule->width, rule->height);
    }
    cairo_fill(p->cairo);
}

static void draw_marks(pdf *p)
{
    static void (*const draws[])(pdf *, const glint_ink_mark *) = { draw_fill, draw_text, draw_strokes };
    const glint_ink *ink = p->figure->ink;
    for (size_t i = 0; i < ink->count; i++) {
        const glint_ink_mark *mark = &ink->of[i];
        cairo_save(p->cairo);
        if (mark->clip.width < ink->width || mark->clip.height < ink->height) {
            cairo_rectangle(p->cairo, mark->clip.x, mark->clip.y, mark->clip.width, mark->clip.height);
            cairo_clip(p->cairo);
        }
        set_color(p, mark);
        draws[mark->kind](p, mark);
        cairo_restore(p->cairo);
        note_lost(p);
    }
}

// ---- The file -----------------------------------------------------------------------------------------------------

static cairo_status_t append(void *out, const unsigned char *bytes, unsigned size)
{
    return glint_bytes_append(out, bytes, size) ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_NO_MEMORY;
}

/// Turns hinting off, so that letters have the same positions as in a .png, and makes strokes round.
static void set_options(cairo_t *cairo)
{
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cairo, options);
    cairo_font_options_destroy(options);
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
}

static glint_status check(const glint_png_source *source, glint_error *error)
{
    if (source->tone.bits != 8)
        return glint_fail(error, GLINT_ERR_INVALID, "bits: 8 expected for a .pdf, got %d; a .svg or .png can have 16",
                          source->tone.bits);
    if (source->tone.transfer != GLINT_TRANSFER_SRGB)
        return glint_fail(
            error, GLINT_ERR_INVALID,
            "transfer: srgb expected for a .pdf, and these pixel values are linear; a .svg or .png can have them");
    if (source->width > SIDE_MAX || source->height > SIDE_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "path: sides of at most %d pixels expected for a .pdf, got %dx%d",
                          SIDE_MAX, source->width, source->height);
    return GLINT_OK;
}

/// Returns the first failure of cairo, or GLINT_OK.
static glint_status status_of(const pdf *p, cairo_surface_t *surface, glint_error *error)
{
    cairo_status_t status = cairo_status(p->cairo);
    if (!status)
        status = cairo_surface_status(surface);
    if (p->lost || status == CAIRO_STATUS_NO_MEMORY)
        return glint_fail_nomem(error);
    return status ? glint_fail(error, GLINT_ERR_INVALID, "cairo: %s", cairo_status_to_string(status)) : GLINT_OK;
}

glint_status glint_pdf_encode(const glint_figure *figure, const glint_png_desc *desc, glint_bytes *out,
                              glint_error *error)
{
    const glint_png_source *source = figure->source;
    const double unit = glint_figure_unit(desc);
    glint_status status = check(source, error);
    if (status)
        return status;
    cairo_surface_t *surface =
        cairo_pdf_surface_create_for_stream(append, out, source->width * unit, source->height * unit);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, "glint " GLINT_VERSION);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE,
                                   ""); // no date, so that equal figures have equal bytes
    pdf p = { .cairo = cairo_create(surface), .figure = figure };
    errno = 0;
    set_options(p.cairo);
    cairo_scale(p.cairo, unit, unit);
    cairo_translate(p.cairo, -figure->x, -figure->y);
    draw_picture(&p);
    note_lost(&p);
    if (figure->ink)
        draw_marks(&p);
    cairo_show_page(p.cairo);
    cairo_surface_finish(surface);
    note_lost(&p);
    status = status_of(&p, surface, error);
    cairo_font_face_destroy(p.face);
    cairo_destroy(p.cairo);
    cairo_surface_destroy(surface);
    destroy_pixels(p.colors, p.holders[0]);
    destroy_pixels(p.mask, p.holders[1]);
    return status;
}

const char *glint_cairo_version(void) { return cairo_version_string(); }

#else

glint_status glint_pdf_encode(const glint_figure *figure, const glint_png_desc *desc, glint_bytes *out,
                              glint_error *error)
{
    (void)figure, (void)desc, (void)out;
    return glint_fail(error, GLINT_ERR_UNSUPPORTED,
                      "path: .svg or .png expected, as this build has no cairo for .pdf (libcairo2-dev)");
}

const char *glint_cairo_version(void) { return NULL; }

#endif
