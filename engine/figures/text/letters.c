#include "engine/figures/text/letters.h"

#include "engine/base/open.h"
#include "engine/base/status.h"
#include "engine/figures/text/font.h"

#include <stdlib.h>
#include <string.h>

#define BOLD (1 / 24.0) ///< growth of the strokes of bold letters, in font sizes

double glint_letters_growth(const glint_run *run) { return run->bold ? run->em * BOLD : 0; }

#ifdef GLINT_HAVE_FREETYPE

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_MODULE_H
#include FT_OUTLINE_H
#include FT_SYSTEM_H
#include FT_TRUETYPE_TABLES_H

#include <math.h>
#include <pthread.h>
#include <stdio.h>

/// Unhinted outlines, since hinting depends on settings of the library.
#define LOAD (FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP)

struct glint_letters {
    FT_Library library;
    FT_Face face;
    char *path; ///< path of the font's file. Owned
    struct FT_MemoryRec_ memory; ///< FreeType continues after a failed allocation, so this allocator records the
        ///< failure
    bool lost;
    double em; ///< the face's current size; 0: not set
};

static void *note_lost(FT_Memory memory, void *block)
{
    glint_letters *letters = memory->user;
    letters->lost = letters->lost || !block;
    return block;
}

static void *allocate(FT_Memory memory, long size) { return note_lost(memory, malloc((size_t)size)); }

static void release(FT_Memory memory, void *block)
{
    (void)memory;
    free(block);
}

static void *resize(FT_Memory memory, long before, long size, void *block)
{
    (void)before;
    return note_lost(memory, realloc(block, (size_t)size));
}

/// The paths where common systems have the font.
static const char *const font_paths[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", // Debian
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf", // Fedora
    "/usr/share/fonts/TTF/DejaVuSans.ttf", // Arch
    "/usr/share/fonts/dejavu/DejaVuSans.ttf", // Alpine
    "/usr/local/share/fonts/dejavu/DejaVuSans.ttf", // FreeBSD
    "/Library/Fonts/DejaVuSans.ttf",
};

/// Opens the font at a path. False: there is none.
static bool open_path(glint_letters *letters, const char *path)
{
    if (glint_check_file(path, NULL) || FT_New_Face(letters->library, path, 0, &letters->face))
        return false;
    if (FT_IS_SCALABLE(letters->face)) {
        letters->path = note_lost(&letters->memory, strdup(path));
        return true;
    }
    FT_Done_Face(letters->face);
    letters->face = NULL;
    return false;
}

void glint_letters_close(glint_letters *letters)
{
    if (!letters)
        return;
    if (letters->face)
        FT_Done_Face(letters->face);
    if (letters->library)
        FT_Done_Library(letters->library);
    free(letters->path);
    free(letters);
}

bool glint_letters_lost(const glint_letters *letters) { return letters && letters->lost; }

static glint_letters *begin(void)
{
    glint_letters *letters = calloc(1, sizeof *letters);
    if (!letters)
        return NULL;
    letters->memory = (struct FT_MemoryRec_) { letters, allocate, release, resize };
    if (!FT_New_Library(&letters->memory, &letters->library)) {
        FT_Add_Default_Modules(letters->library);
        return letters;
    }
    free(letters);
    return NULL;
}

glint_status glint_letters_open(glint_letters **out, glint_error *error)
{
    const char *wanted = getenv("GLINT_FONT");
    *out = NULL;
    if (wanted && strcmp(wanted, "bitmap") == 0)
        return GLINT_OK;
    glint_letters *letters = begin();
    if (!letters)
        return glint_fail_nomem(error);
    bool found = wanted && *wanted && open_path(letters, wanted);
    for (size_t i = 0; i < sizeof font_paths / sizeof *font_paths && !found && !(wanted && *wanted); i++)
        found = open_path(letters, font_paths[i]);
    const bool lost = letters->lost;
    if (found && !lost) {
        *out = letters;
        return GLINT_OK;
    }
    glint_letters_close(letters);
    if (lost)
        return glint_fail_nomem(error);
    if (wanted && *wanted)
        return glint_fail(error, GLINT_ERR_INVALID, "GLINT_FONT: expected the file of a scalable font, or the word bitmap, got '%.300s'",
                          wanted);
    return GLINT_OK;
}

/// Returns a key of the font. The font's file contains a checksum of the whole font.
glint_key glint_letters_key(const glint_letters *letters)
{
    glint_key key = { 0 };
    FT_Int version[3];
    if (!letters)
        return glint_key_add_string(key, "bitmap");
    FT_Library_Version(letters->library, &version[0], &version[1], &version[2]);
    const TT_Header *head = FT_Get_Sfnt_Table(letters->face, FT_SFNT_HEAD);
    const double numbers[] = { version[0], version[1], version[2], head ? (double)head->CheckSum_Adjust : 0,
                               (double)letters->face->num_glyphs };
    key = glint_key_add(key, numbers, sizeof numbers);
    if (letters->face->family_name)
        key = glint_key_add_string(key, letters->face->family_name);
    if (letters->face->style_name)
        key = glint_key_add_string(key, letters->face->style_name);
    return key;
}

bool glint_letters_has(const glint_letters *letters, uint32_t code) { return FT_Get_Char_Index(letters->face, code) != 0; }

static void set_size(glint_letters *letters, double em)
{
    if (letters->em != em && !FT_Set_Char_Size(letters->face, 0, (FT_F26Dot6)(em * 64 + 0.5), 72, 72))
        letters->em = em;
}

void glint_letters_measure(glint_letters *letters, double em, int *above, int *below, int *line)
{
    const double unit = em / letters->face->units_per_EM;
    *above = (int)(letters->face->ascender * unit + 0.999);
    *below = (int)(-letters->face->descender * unit + 0.999);
    *line = (int)(letters->face->height * unit + 0.999);
}

/// The state of a text that is being drawn.
typedef struct pen {
    double x; ///< pixels
    FT_UInt before; ///< the previous letter, for kerning; 0: none
} pen;

/// Loads the next letter, and moves the pen to its start. False: the text is at its end.
static bool next_letter(glint_letters *letters, const char **text, pen *at)
{
    FT_Face face = letters->face;
    const FT_UInt glyph = FT_Get_Char_Index(face, glint_font_code(text));
    FT_Vector kerning;
    if (at->before && FT_HAS_KERNING(face) && !FT_Get_Kerning(face, at->before, glyph, FT_KERNING_UNFITTED, &kerning))
        at->x += (double)kerning.x / 64;
    at->before = glyph;
    return !FT_Load_Glyph(face, glyph, LOAD);
}

static double advance_of(const glint_letters *letters, const glint_run *run)
{
    return (double)letters->face->glyph->linearHoriAdvance / 65536 + glint_letters_growth(run);
}

double glint_letters_advance(glint_letters *letters, const glint_run *run)
{
    const char *text = run->text, *end = text + strnlen(text, run->size);
    pen at = { 0 };
    set_size(letters, run->em);
    while (text < end && at.x < 0x1p30)
        if (next_letter(letters, &text, &at))
            at.x += advance_of(letters, run);
    return at.x;
}

int glint_letters_width(glint_letters *letters, double em, const char *text, size_t size)
{
    return (int)(glint_letters_advance(letters, &(glint_run) { .text = text, .size = size, .em = em, .stretch = 1 }) + 0.999);
}

/// Returns the outline of the loaded letter in the shape of a run. NULL: the letter has no outline.
static FT_Outline *shape_letter(const glint_letters *letters, const glint_run *run)
{
    FT_Outline *outline = &letters->face->glyph->outline;
    const FT_Matrix matrix = { 65536, (FT_Fixed)(run->slant * 65536), 0, (FT_Fixed)(run->stretch * 65536) };
    if (letters->face->glyph->format != FT_GLYPH_FORMAT_OUTLINE || outline->n_points == 0)
        return NULL;
    if (run->bold)
        FT_Outline_Embolden(outline, (FT_Pos)(glint_letters_growth(run) * 64));
    if (run->slant != 0 || run->stretch != 1)
        FT_Outline_Transform(outline, &matrix);
    return outline;
}

glint_run_box glint_letters_box(glint_letters *letters, const glint_run *run)
{
    const char *text = run->text, *end = text + strnlen(text, run->size);
    glint_run_box ink = { 0 };
    bool has_ink = false;
    pen at = { 0 };
    set_size(letters, run->em);
    while (text < end && at.x < 0x1p30) {
        if (!next_letter(letters, &text, &at))
            continue;
        FT_Outline *outline = shape_letter(letters, run);
        FT_BBox box;
        if (outline) {
            FT_Outline_Get_CBox(outline, &box);
            const double left = at.x + (double)box.xMin / 64, right = at.x + (double)box.xMax / 64;
            const double above = (double)box.yMax / 64, below = -(double)box.yMin / 64;
            ink.left = has_ink ? fmin(ink.left, left) : left;
            ink.right = has_ink ? fmax(ink.right, right) : right;
            ink.above = has_ink ? fmax(ink.above, above) : above;
            ink.below = has_ink ? fmax(ink.below, below) : below;
            has_ink = true;
        }
        at.x += advance_of(letters, run);
    }
    return ink;
}

double glint_letters_place(glint_letters *letters, const glint_run *run, glint_letter *out)
{
    const char *text = run->text, *end = text + strnlen(text, run->size);
    pen at = { 0 };
    set_size(letters, run->em);
    for (; text < end; out++) {
        const char *code = text;
        const bool loaded = next_letter(letters, &text, &at);
        *out = (glint_letter) { at.before, glint_font_code(&code), at.x };
        at.x += loaded ? advance_of(letters, run) : 0;
    }
    return at.x;
}

glint_font_name glint_letters_name(const glint_letters *letters)
{
    const FT_Face face = letters->face;
    return (glint_font_name) { letters->path, face->family_name ? face->family_name : "", (face->style_flags & FT_STYLE_FLAG_BOLD) != 0,
                               (face->style_flags & FT_STYLE_FLAG_ITALIC) != 0 };
}

/// Adds a rectangle of coverage. The coverages of two letters in a pixel are treated as independent.
static void add_coverage(const FT_Bitmap *from, int x, int y, glint_mask *mask)
{
    for (unsigned row = 0; row < from->rows; row++)
        for (unsigned column = 0; column < from->width; column++) {
            uint8_t *to = mask->coverage + (size_t)(y + (int)row) * (size_t)mask->width + (size_t)(x + (int)column);
            const unsigned both = from->buffer[(size_t)row * from->width + column];
            *to = (uint8_t)(both + *to - (both * *to + 127) / 255);
        }
}

static FT_Pos to_64ths(double pixels) { return (FT_Pos)(pixels * 64 + (pixels < 0 ? -0.5 : 0.5)); }

/// Draws the loaded letter at x on the baseline of a run, clipped to the mask.
static void draw_letter(glint_letters *letters, const glint_run *run, double x, glint_mask *mask)
{
    FT_Outline *outline = shape_letter(letters, run);
    FT_BBox box;
    if (!outline)
        return;
    FT_Outline_Translate(outline, to_64ths(x), -to_64ths(run->y)); // mask corner at 0, 0
    FT_Outline_Get_CBox(outline, &box);
    const FT_Pos left = box.xMin >> 6 > 0 ? box.xMin >> 6 : 0;
    const FT_Pos right = (box.xMax + 63) >> 6 < mask->width ? (box.xMax + 63) >> 6 : mask->width;
    const FT_Pos top = -((box.yMax + 63) >> 6) > 0 ? -((box.yMax + 63) >> 6) : 0;
    const FT_Pos bottom = -(box.yMin >> 6) < mask->height ? -(box.yMin >> 6) : mask->height;
    if (left >= right || top >= bottom)
        return;
    FT_Bitmap part = { .rows = (unsigned)(bottom - top), .width = (unsigned)(right - left), .pixel_mode = FT_PIXEL_MODE_GRAY };
    part.num_grays = 256;
    part.pitch = (int)part.width;
    part.buffer = calloc(part.rows, part.width);
    letters->lost = letters->lost || !part.buffer;
    FT_Outline_Translate(outline, -left * 64, bottom * 64);
    if (part.buffer && !FT_Outline_Get_Bitmap(letters->library, outline, &part))
        add_coverage(&part, (int)left, (int)top, mask);
    free(part.buffer);
}

void glint_letters_draw(glint_letters *letters, const glint_run *run, glint_mask *mask)
{
    const char *text = run->text, *end = text + strnlen(text, run->size);
    pen at = { .x = run->x };
    set_size(letters, run->em);
    while (text < end && at.x < mask->width)
        if (next_letter(letters, &text, &at)) {
            const double advance = advance_of(letters, run);
            draw_letter(letters, run, at.x, mask);
            at.x += advance;
        }
}

// ---- Outlines ----

typedef struct outline {
    glint_outline_part *put;
    void *context;
    double x, y; ///< where the letter begins, pixels
} outline;

static int put_part(const outline *o, char command, int count, const FT_Vector *const at[3])
{
    double points[3][2] = { { 0 } };
    for (int i = 0; i < count; i++) {
        points[i][0] = o->x + (double)at[i]->x / 64;
        points[i][1] = o->y - (double)at[i]->y / 64;
    }
    o->put(o->context, command, count, (const double(*)[2])points);
    return 0;
}

static int put_move(const FT_Vector *to, void *o) { return put_part(o, 'M', 1, (const FT_Vector *[3]) { to }); }

static int put_line(const FT_Vector *to, void *o) { return put_part(o, 'L', 1, (const FT_Vector *[3]) { to }); }

static int put_conic(const FT_Vector *by, const FT_Vector *to, void *o)
{
    return put_part(o, 'Q', 2, (const FT_Vector *[3]) { by, to });
}

static int put_cubic(const FT_Vector *first, const FT_Vector *second, const FT_Vector *to, void *o)
{
    return put_part(o, 'C', 3, (const FT_Vector *[3]) { first, second, to });
}

void glint_letters_outline(glint_letters *letters, const glint_run *run, glint_outline_part *put, void *context)
{
    static const FT_Outline_Funcs parts = { put_move, put_line, put_conic, put_cubic, 0, 0 };
    const char *text = run->text, *end = text + strnlen(text, run->size);
    pen at = { .x = run->x };
    set_size(letters, run->em);
    while (text < end)
        if (next_letter(letters, &text, &at)) {
            const double advance = advance_of(letters, run);
            FT_Outline *shape = shape_letter(letters, run);
            outline o = { put, context, at.x, run->y };
            if (shape && FT_Outline_Decompose(shape, &parts, &o))
                letters->lost = true;
            at.x += advance;
        }
}

static char library_name[48];

// Stores the version of the library in use or, without memory to start it, the version compiled against.
static void name_library(void)
{
    FT_Library library;
    FT_Int version[3] = { FREETYPE_MAJOR, FREETYPE_MINOR, FREETYPE_PATCH };
    if (FT_Init_FreeType(&library) == 0) {
        FT_Library_Version(library, &version[0], &version[1], &version[2]);
        FT_Done_FreeType(library);
    }
    snprintf(library_name, sizeof library_name, "FreeType %d.%d.%d", version[0], version[1], version[2]);
}

const char *glint_letters_library(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, name_library);
    return library_name;
}

#else

glint_status glint_letters_open(glint_letters **out, glint_error *error)
{
    const char *wanted = getenv("GLINT_FONT");
    *out = NULL;
    if (!wanted || !*wanted || strcmp(wanted, "bitmap") == 0)
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_UNSUPPORTED, "GLINT_FONT: bitmap expected, because this build has no "
                                                    "FreeType, got '%.300s'", wanted);
}

void glint_letters_close(glint_letters *letters) { (void)letters; }

bool glint_letters_lost(const glint_letters *letters)
{
    (void)letters;
    return false;
}

glint_key glint_letters_key(const glint_letters *letters)
{
    (void)letters;
    return glint_key_add_string((glint_key) { 0 }, "bitmap");
}

void glint_letters_measure(glint_letters *letters, double em, int *above, int *below, int *line)
{
    (void)letters, (void)em;
    *above = *below = *line = 0;
}

bool glint_letters_has(const glint_letters *letters, uint32_t code)
{
    (void)letters, (void)code;
    return false;
}

int glint_letters_width(glint_letters *letters, double em, const char *text, size_t size)
{
    (void)letters, (void)em, (void)text, (void)size;
    return 0;
}

double glint_letters_place(glint_letters *letters, const glint_run *run, glint_letter *out)
{
    (void)letters, (void)run, (void)out;
    return 0;
}

glint_font_name glint_letters_name(const glint_letters *letters)
{
    (void)letters;
    return (glint_font_name) { .path = "" };
}

double glint_letters_advance(glint_letters *letters, const glint_run *run)
{
    (void)letters, (void)run;
    return 0;
}

glint_run_box glint_letters_box(glint_letters *letters, const glint_run *run)
{
    (void)letters, (void)run;
    return (glint_run_box) { 0 };
}

void glint_letters_outline(glint_letters *letters, const glint_run *run, glint_outline_part *put, void *context)
{
    (void)letters, (void)run, (void)put, (void)context;
}

void glint_letters_draw(glint_letters *letters, const glint_run *run, glint_mask *mask)
{
    (void)letters, (void)run, (void)mask;
}

const char *glint_letters_library(void) { return NULL; }

#endif
