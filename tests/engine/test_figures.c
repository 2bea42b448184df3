/// Figures made from finished files: drafts, reading files back, the font, contact sheets, animated PNG.
#include "tests/engine/cases/image_case.h"

#include <png.h>

#include "engine/figures/ink/stamps.h"
#include "engine/figures/text/font.h"
#include "engine/files/picture/pfm.h"

// ---- Drafts -------------------------------------------------------------------------------------------------------

static void test_draft(void **state)
{
    (void)state;
    const char *path = in_folder("deep/er/film.mp4");
    glint_draft *draft = NULL;
    glint_error error = { 0 };
    assert_int_equal(glint_draft_create(path, &draft, &error), GLINT_OK);
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(access(glint_draft_name(draft), F_OK), 0);
    assert_int_equal(glint_draft_append(draft, "abc", 3, &error), GLINT_OK);
    FILE *other = fopen(glint_draft_name(draft), "ab"); // stands for another process
    assert_non_null(other);
    fputs("def", other);
    fclose(other);
    assert_int_equal(glint_draft_finish(draft, &error), GLINT_OK);
    glint_draft_destroy(draft);
    glint_bytes bytes = read_ok(path);
    assert_int_equal(bytes.size, 6);
    assert_memory_equal(bytes.data, "abcdef", 6);
    free(bytes.data);
    assert_int_equal(files_in(in_folder("deep/er")), 1);
    // Dropping a draft leaves the existing file as it was.
    assert_int_equal(glint_draft_create(path, &draft, &error), GLINT_OK);
    assert_int_equal(glint_draft_append(draft, "xyz", 3, &error), GLINT_OK);
    glint_draft_destroy(draft);
    glint_draft_destroy(NULL);
    bytes = read_ok(path);
    assert_memory_equal(bytes.data, "abcdef", 6);
    free(bytes.data);
    assert_int_equal(files_in(in_folder("deep/er")), 1);
    assert_int_equal(glint_draft_create(in_folder("deep"), &draft, &error), GLINT_ERR_IO);
    assert_non_null(strstr(error.message, "deep: "));
}

// ---- Pictures -----------------------------------------------------------------------------------------------------

/// Writes a PNG with libpng.
static void write_by_libpng(const char *path, int width, int height, int bits, int type, bool linear, uint8_t **rows)
{
    FILE *file = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_text text = { .compression = PNG_TEXT_COMPRESSION_NONE,
                      .key = (char[]) { "Title" },
                      .text = (char[]) { "\xe4 b" } };
    assert_non_null(file);
    png_init_io(png, file);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, bits, type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (linear)
        png_set_gAMA_fixed(png, info, 100000);
    png_set_text(png, info, &text, 1);
    png_write_info(png, info);
    png_write_image(png, rows);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    fclose(file);
}

static glint_picture *read_picture(const char *path, bool pixels)
{
    glint_picture *picture = NULL;
    glint_error error = { 0 };
    if (glint_picture_read(path, pixels, &picture, &error))
        fail_msg("%s", error.message);
    return picture;
}

static void test_picture_alpha(void **state)
{
    (void)state;
    uint8_t row[] = { 200, 255, 200, 0, 100, 51 }, *rows[] = { row }, rgb[9];
    write_by_libpng(in_folder("a.png"), 3, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, false, rows);
    glint_picture *picture = read_picture(in_folder("a.png"), true);
    assert_int_equal(glint_picture_width(picture), 3);
    assert_int_equal(glint_picture_height(picture), 1);
    assert_int_equal(glint_picture_channels(picture), 2);
    assert_int_equal(glint_picture_bits(picture), 8);
    assert_string_equal(glint_picture_text(picture, "Title"), "\xc3\xa4 b");
    assert_null(glint_picture_text(picture, "title"));
    glint_picture_row(picture, 0, 255, rgb);
    const uint8_t want[] = { 200, 200, 200, 255, 255, 255, 224, 224, 224 }; // 100 with alpha 1/5 over 255
    assert_memory_equal(rgb, want, sizeof want);
    glint_picture_destroy(picture);
    glint_picture_destroy(NULL);
}

static void test_picture_linear(void **state)
{
    (void)state;
    static const unsigned codes[] = { 0, 1, 300, 11796, 32768, 65535 };
    uint8_t row[36], *rows[] = { row }, rgb[18];
    for (int i = 0; i < 18; i++) {
        row[2 * i] = (uint8_t)(codes[i / 3] >> 8);
        row[2 * i + 1] = (uint8_t)codes[i / 3];
    }
    write_by_libpng(in_folder("l.png"), 6, 1, 16, PNG_COLOR_TYPE_RGB, true, rows);
    glint_picture *picture = read_picture(in_folder("l.png"), true);
    assert_int_equal(glint_picture_bits(picture), 16);
    assert_int_equal(glint_picture_transfer(picture), GLINT_TRANSFER_LINEAR);
    glint_picture_row(picture, 0, 0, rgb);
    for (int i = 0; i < 18; i++) // IEC 61966-2-1, using the C library
    {
        double x = codes[i / 3] / 65535.0, y = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
        assert_int_equal(rgb[i], (int)(y * 255 + 0.5));
    }
    glint_picture_destroy(picture);
}

static void test_picture_broken(void **state)
{
    (void)state;
    glint_picture *picture = NULL;
    glint_error error = { 0 };
    glint_image *image = make_image(20, 10, NULL);
    glint_write_desc desc = describe(in_folder("whole.png"));
    write_ok(image, &desc);
    glint_image_release(image);
    glint_bytes bytes = read_ok(desc.path);
    for (size_t size = 0; size < bytes.size; size += 7) {
        assert_int_equal(glint_file_write(in_folder("cut.png"), bytes.data, size, NULL), GLINT_OK);
        for (int pixels = 0; pixels < 2; pixels++)
            assert_int_equal(glint_picture_read(in_folder("cut.png"), pixels, &picture, &error), GLINT_ERR_FORMAT);
        assert_non_null(strstr(error.message, "cut.png: not a whole PNG"));
    }
    for (size_t at = 0; at < bytes.size; at += 5) {
        bytes.data[at] ^= 4;
        assert_int_equal(glint_file_write(in_folder("bad.png"), bytes.data, bytes.size, NULL), GLINT_OK);
        assert_int_equal(glint_picture_read(in_folder("bad.png"), false, &picture, &error), GLINT_ERR_FORMAT);
        bytes.data[at] ^= 4;
    }
    free(bytes.data);
    assert_int_equal(glint_picture_read(in_folder("none.png"), true, &picture, &error), GLINT_ERR_IO);
    assert_int_equal(glint_picture_read(in_folder("none.txt"), true, &picture, &error), GLINT_ERR_INVALID);
}

// ---- The font -----------------------------------------------------------------------------------------------------

static void test_font(void **state)
{
    (void)state;
    const char *unknown = "\xef\xbf\xbd";
    const uint8_t *box = glint_font_next(&unknown);
    assert_int_equal(*unknown, '\0');
    for (char c = '!'; c <= '~'; c++) { // each glyph is drawn and differs from the previous one
        char text[] = { c, (char)(c + 1), '\0' };
        const char *at = text;
        const uint8_t *one = glint_font_next(&at), *next = glint_font_next(&at);
        assert_int_not_equal(memcmp(one, next, GLINT_FONT_HEIGHT), 0);
        assert_ptr_not_equal(one, box);
    }
    static const struct {
        const char *text;
        size_t count;
    } texts[] = { { "", 0 },     { "abc", 3 },  { "\xce\xb1=1", 3 }, { "\xe2\x86\x92", 1 }, { "\xf0\x9f\x98\x80", 1 },
                  { "\x80", 1 }, { "\xc3", 1 }, { "\xe2\x86", 2 },   { "\xff\xfe", 2 },     { "a\xf0\x9f", 3 } };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        assert_int_equal(glint_font_count(texts[i].text, SIZE_MAX), texts[i].count);
    assert_int_equal(glint_font_count("abcdef", 4), 4);
    const char *arrow = "\xe2\x86\x92", *smile = "\xf0\x9f\x98\x80";
    assert_ptr_not_equal(glint_font_next(&arrow), box);
    assert_ptr_equal(glint_font_next(&smile), box);
}

/// Draws a page on rows of black or transparent pixels. The caller frees the pixels.
static uint8_t *draw_page(const glint_ink *ink, int channels)
{
    glint_stamps stamps;
    const size_t row = (size_t)ink->width * (size_t)channels;
    uint8_t *pixels = calloc((size_t)ink->height, row);
    assert_non_null(pixels);
    assert_int_equal(glint_stamps_make(ink, GLINT_TRANSFER_LINEAR, 8, &stamps, NULL), GLINT_OK);
    for (int y = 0; y < ink->height; y++)
        glint_stamps_row(&stamps, 0, y, ink->width, channels, pixels + (size_t)y * row);
    glint_stamps_free(&stamps);
    return pixels;
}

static void test_ink(void **state)
{
    (void)state;
    static const double white[3] = { 1, 1, 1 };
    glint_ink ink;
    assert_int_equal(glint_ink_open(30, 20, &ink, NULL), GLINT_OK);
    glint_ink_fill(&ink, -5, -5, 6, 6, white, 1); // clipped at the edges
    glint_ink_fill(&ink, 29, 19, 50, 50, white, 0.2);
    glint_ink_fill(&ink, 40, 0, 5, 5, white, 1);
    assert_int_equal(ink.count, 2);
    glint_ink_clip(&ink, &(glint_rect) { 10, 10, 3, 3 });
    glint_ink_fill(&ink, 0, 12, 30, 8, white, 1);
    const glint_stroke across = { { 0, 10.5 }, { 30, 0 } };
    glint_ink_strokes(&ink, &(glint_strokes) { .of = (glint_stroke *)&across, .count = 1, .half = 0.5 }, white);
    uint8_t *pixels = draw_page(&ink, 3);
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 30; x++) {
            const bool inside = x >= 10 && x < 13 && (y == 10 || y == 12);
            const int expected = (x == 0 && y == 0) || inside ? 255 : x == 29 && y == 19 ? 51 : 0;
            assert_int_equal(pixels[3 * (y * 30 + x)], expected);
        }
    free(pixels);
    glint_ink_close(&ink);
}

/// Draws a text of the bitmap font on a transparent page of its size.
static uint8_t *draw_turned(int width, int height, glint_turn turn)
{
    static const double black[3] = { 0, 0, 0 };
    const glint_typeface typeface = glint_typeface_open(NULL, 13);
    glint_ink ink;
    assert_int_equal(glint_ink_open(width, height, &ink, NULL), GLINT_OK);
    glint_ink_text(&ink, &typeface, "Rg", SIZE_MAX, 0, 0, turn, black);
    uint8_t *pixels = draw_page(&ink, 4);
    glint_ink_close(&ink);
    return pixels;
}

/// Text rotated by a quarter turn has the same pixels as horizontal text.
static void test_turned(void **state)
{
    (void)state;
    uint8_t *level = draw_turned(16, 13, GLINT_LEVEL), *down = draw_turned(13, 16, GLINT_DOWN), *up = draw_turned(13, 16, GLINT_UP);
    int count = 0;
    for (int y = 0; y < 13; y++)
        for (int x = 0; x < 16; x++) {
            const int covered = level[4 * (y * 16 + x) + 3];
            assert_int_equal(down[4 * (x * 13 + 12 - y) + 3], covered);
            assert_int_equal(up[4 * ((15 - x) * 13 + y) + 3], covered);
            count += covered == 255;
        }
    assert_in_range(count, 20, 80);
    free(level);
    free(down);
    free(up);
}

// ---- Sheets -------------------------------------------------------------------------------------------------------

/// Writes a linear picture of one colour. Returns its name.
static const char *write_plain(const char *name, int width, int height, float value)
{
    const char *path = in_folder(name);
    glint_image *image = make_image(width, height, NULL);
    for (int i = 0; i < width * height; i++)
        for (int c = 0; c < 3; c++)
            image->plane[GLINT_PASS_BEAUTY][c][i] = value;
    glint_write_desc desc = describe(path);
    write_ok(image, &desc);
    glint_image_release(image);
    return path;
}

static glint_png decode_ok(const char *path)
{
    glint_png png = { 0 };
    glint_bytes bytes = read_ok(path);
    assert_int_equal(glint_png_decode(bytes.data, bytes.size, &png, NULL), GLINT_OK);
    free(bytes.data);
    return png;
}

static int code_at(const glint_png *png, int x, int y) { return ((uint8_t *)png->codes)[3 * (y * png->width + x)]; }

/// Counts the pixels of a rectangle that are darker than the paper.
static int ink_in(const glint_png *png, int x, int y, int width, int height)
{
    int ink = 0;
    for (int row = y; row < y + height; row++)
        for (int column = x; column < x + width; column++)
            ink += code_at(png, column, row) < 128;
    return ink;
}

static void test_sheet(void **state)
{
    (void)state;
    glint_error error = { 0 };
    const glint_sheet_cell cells[] = { { write_plain("a.png", 50, 30, 1), "a = 1" },
                                       { write_plain("b.png", 50, 30, 0.5f), "a = 2\nlong = 1234567890" },
                                       { write_plain("c.png", 50, 30, 0), NULL } };
    glint_sheet_desc desc = { .struct_size = sizeof(glint_sheet_desc), .cells = cells, .cell_count = 3, .columns = 2, .difference = 1, .gain = 0.5 };
    if (glint_sheet_write(&desc, in_folder("sheet.png"), &error))
        fail_msg("%s", error.message);
    glint_png png = decode_ok(in_folder("sheet.png"));
    // The columns are as wide as the longest part of a label, "long = 1234567890", 17 characters.
    // Labels have two lines.
    int column = 17 * 8, band = 30 + 2 * 15 + 4 + 12, x = 12 + (column - 50) / 2, y = 12;
    assert_int_equal(code_at(&png, x + 25, y + 15), 255);
    assert_int_equal(code_at(&png, x + column + 12, y), 188);
    assert_int_equal(code_at(&png, x + column + 12 + 49, y + 29), 188);
    assert_int_equal(code_at(&png, x + column + 12 - 1, y), 255);
    assert_int_equal(code_at(&png, x, y + 2 * band), 0);
    // The error is half of |188 - 255| and of |0 - 255|. It is 0 below the reference cell itself.
    assert_int_equal(code_at(&png, x + 25, y + band + 15), 0);
    assert_int_equal(code_at(&png, x + column + 12 + 25, y + band + 15), 34);
    assert_int_equal(code_at(&png, x + 25, y + 3 * band + 15), 128);
    assert_in_range(ink_in(&png, 12, y + 30, column, 15 + 4), 20, 200); // "a = 1", on one line
    assert_int_equal(ink_in(&png, 12, y + 30 + 19, column, 15), 0);
    assert_in_range(ink_in(&png, 24 + column, y + 30 + 19, column, 15), 80, 500);
    free(png.codes);
}

/// The heads of columns, rows and blocks shift the pictures by the size of the heads,
/// and are drawn next to the pictures.
static void test_sheet_heads(void **state)
{
    (void)state;
    static const char *const columns[] = { "1", "22" }, *const rows[] = { "10", "2", "10", "2" }, *const blocks[] = { "b = 3", "b = 4" };
    const char *path = write_plain("a.png", 50, 30, 0);
    glint_sheet_cell cells[8];
    glint_error error;
    for (int i = 0; i < 8; i++)
        cells[i] = (glint_sheet_cell) { path, NULL };
    glint_sheet_desc desc = { .struct_size = sizeof(glint_sheet_desc), .cells = cells, .cell_count = 8, .columns = 2, .column_heads = columns, .row_heads = rows,
                              .block_heads = blocks, .block_rows = 2 };
    assert_int_equal(glint_sheet_write(&desc, in_folder("sheet.png"), &error), GLINT_OK);
    glint_png png = decode_ok(in_folder("sheet.png"));
    const int left = 12 + 2 * 8 + 6, top = 12 + 15 + 4, block = 15 + 4, band = 30 + 12;
    assert_int_equal(png.width, left + 2 * (50 + 12));
    assert_int_equal(png.height, top + 2 * block + 4 * band);
    for (int row = 0; row < 4; row++) {
        const int y = top + (row / 2 + 1) * block + row * band;
        assert_int_equal(code_at(&png, left, y - 1), 255);
        assert_int_equal(code_at(&png, left, y), 0);
        assert_int_equal(code_at(&png, left + 62 + 49, y + 29), 0);
        assert_in_range(ink_in(&png, 12, y, 8, 30), row % 2 ? 0 : 8, row % 2 ? 0 : 40); // "10" is two digits, "2" is at the right
        assert_in_range(ink_in(&png, 20, y, 8, 30), 8, 40);
        assert_in_range(ink_in(&png, left, y - block, 5 * 8, 15), row % 2 ? 0 : 20, row % 2 ? 2000 : 120);
    }
    assert_in_range(ink_in(&png, left + 21, 12, 8, 15), 5, 40);
    assert_in_range(ink_in(&png, left + 62 + 17, 12, 16, 15), 10, 80);
    free(png.codes);
    desc.block_rows = 0;
    assert_int_equal(glint_sheet_write(&desc, in_folder("none.png"), &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "block_rows: whole number 1 .. 65535 expected, got 0");
    char name[1002] = "";
    memset(name, 'n', 1001);
    desc = (glint_sheet_desc) { .struct_size = sizeof(glint_sheet_desc), .cells = cells, .cell_count = 1, .columns = 1, .down = name };
    assert_int_equal(glint_sheet_write(&desc, in_folder("none.png"), &error), GLINT_ERR_INVALID);
    assert_non_null(strstr(error.message, "down: a name of at most 1000 bytes expected"));
}

/// A colour bar of 256 pixels shows the table's colours one by one: from bottom to top at the right of the pictures,
/// or from left to right below them. The pictures stay at the same position as without the bar.
static void test_sheet_bar(void **state)
{
    (void)state;
    const glint_sheet_cell cells[] = { { write_plain("a.png", 20, 300, 1), NULL }, { write_plain("b.png", 20, 300, 0), NULL } };
    glint_overlay_desc bar = glint_overlay_desc_default(GLINT_OVERLAY_COLORBAR);
    const glint_sheet_desc desc = { .struct_size = sizeof(glint_sheet_desc), .cells = cells, .cell_count = 2, .columns = 2, .gain = 1, .colorbar = &bar };
    const uint32_t *table = glint_colormap_table(GLINT_COLORMAP_TURBO);
    bar.map = GLINT_COLORMAP_TURBO;
    bar.has_length = true;
    bar.length = 256;
    for (int across = 0; across < 2; across++) {
        bar.orientation = across ? GLINT_ORIENTATION_HORIZONTAL : GLINT_ORIENTATION_VERTICAL;
        assert_int_equal(glint_sheet_write(&desc, in_folder("sheet.png"), NULL), GLINT_OK);
        const glint_png png = decode_ok(in_folder("sheet.png"));
        const uint8_t *codes = png.codes;
        int found = 0;
        assert_int_equal(code_at(&png, 12, 12), 255);
        assert_int_equal(code_at(&png, 12 + 32, 12), 0);
        for (int y = 0; y < png.height; y++)
            for (int x = 0; x < png.width; x++) {
                int i = 0;
                while (i < 256 && (across ? x + i < png.width : y + i < png.height)) {
                    const uint8_t *c = codes + 3 * ((size_t)(across ? y : y + i) * (size_t)png.width + (size_t)(across ? x + i : x));
                    if (((uint32_t)c[0] << 16 | (uint32_t)c[1] << 8 | c[2]) != table[across ? i : 255 - i])
                        break;
                    i++;
                }
                found += i == 256;
                assert_true(i < 256 || (across ? y > 12 + 300 : x > 12 + 52));
            }
        assert_int_equal(found, 12); // 0.9 of 13 pixels, rounded up
        free(png.codes);
    }
    glint_error error = { 0 };
    bar.high = bar.low;
    assert_int_equal(glint_sheet_write(&desc, in_folder("none.png"), &error), GLINT_ERR_INVALID);
    assert_non_null(strstr(error.message, "colorbar.high: another number than low"));
    bar = glint_overlay_desc_default(GLINT_OVERLAY_LABEL);
    assert_int_equal(glint_sheet_write(&desc, in_folder("none.png"), &error), GLINT_ERR_INVALID);
}

static void test_sheet_refuses(void **state)
{
    (void)state;
    glint_error error = { 0 };
    glint_sheet_cell cells[] = { { write_plain("a.png", 20, 10, 1), NULL }, { write_plain("b.png", 20, 11, 1), NULL } };
    glint_sheet_desc desc = { .struct_size = sizeof(glint_sheet_desc), .cells = cells, .cell_count = 2, .columns = 2, .gain = 1 };
    const char *path = in_folder("sheet.png");
    assert_int_equal(glint_sheet_write(&desc, path, &error), GLINT_ERR_INVALID);
    assert_non_null(strstr(error.message, "b.png: 20x10 pixels"));
    cells[1].path = in_folder("none.png");
    assert_int_equal(glint_sheet_write(&desc, path, &error), GLINT_ERR_IO);
    cells[1].path = cells[0].path;
    desc.columns = GLINT_SIDE_MAX;
    assert_int_equal(glint_sheet_write(&desc, path, &error), GLINT_ERR_INVALID);
    assert_non_null(strstr(error.message, "sides of at most 65535 pixels"));
    desc.columns = 0;
    assert_int_equal(glint_sheet_write(&desc, path, &error), GLINT_ERR_INVALID);
    desc.columns = 1;
    desc.difference = 3;
    assert_int_equal(glint_sheet_write(&desc, path, &error), GLINT_ERR_INVALID);
    desc.difference = 0;
    assert_int_equal(glint_sheet_write(&desc, in_folder("sheet.pfm"), &error), GLINT_ERR_INVALID);
    assert_int_equal(files_in(folder), 2);
    assert_int_equal(glint_sheet_write(&desc, path, &error), GLINT_OK);
}

// ---- Animated PNG -------------------------------------------------------------------------------------------------

static uint32_t big_endian(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/// A player: composes the frames of an RGB APNG, decoding each as a separate PNG.
typedef struct player {
    uint8_t header[25], *canvas; ///< IHDR with its length and CRC; the displayed pixel values
    size_t pixel_bytes;
    uint32_t width, sequence, frames;
    uint8_t control[26]; ///< fcTL chunk of the frame being read
    glint_bytes data; ///< zlib stream of that frame
} player;

static void put_chunk(glint_bytes *out, const char *type, const uint8_t *body, size_t size)
{
    uint8_t length[4] = { (uint8_t)(size >> 24), (uint8_t)(size >> 16), (uint8_t)(size >> 8), (uint8_t)size }, sum[4];
    assert_true(glint_bytes_append(out, length, 4) && glint_bytes_append(out, type, 4));
    assert_true(glint_bytes_append(out, body, size));
    uint32_t crc = 0xffffffff; // PNG, annex D
    for (const uint8_t *at = out->data + out->size - size - 4; at < out->data + out->size; at++) {
        crc ^= *at;
        for (int i = 0; i < 8; i++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    crc = ~crc;
    for (int i = 0; i < 4; i++)
        sum[i] = (uint8_t)(crc >> (24 - 8 * i));
    assert_true(glint_bytes_append(out, sum, 4));
}

/// A 16-bit RGBA PNG that claims this size, with `size` bytes of zeros as pixel data. `frames` 0 makes no animation.
static glint_bytes claim(uint32_t width, uint32_t height, uint32_t frames, size_t size)
{
    glint_bytes file = { 0 };
    uint8_t header[13] = { [8] = 16, 6, 0, 0, 1 }, animation[8] = { 0 }, *zeros = calloc(1, size);
    for (int i = 0; i < 4; i++) {
        header[i] = (uint8_t)(width >> (24 - 8 * i));
        header[4 + i] = (uint8_t)(height >> (24 - 8 * i));
        animation[i] = (uint8_t)(frames >> (24 - 8 * i));
    }
    assert_non_null(zeros);
    assert_true(glint_bytes_append(&file, "\x89PNG\r\n\x1a\n", 8));
    put_chunk(&file, "IHDR", header, 13);
    if (frames)
        put_chunk(&file, "acTL", animation, 8);
    put_chunk(&file, "IDAT", zeros, size);
    put_chunk(&file, "IEND", zeros, 0);
    free(zeros);
    return file;
}

/// The decoder checks a file's claimed size against the file's length before it allocates memory.
static void test_claims(void **state)
{
    (void)state;
    glint_png png;
    glint_error error;
    glint_bytes file = claim(GLINT_SIDE_MAX, GLINT_SIDE_MAX, 0, 1000);
    const uint64_t side = GLINT_SIDE_MAX, raw = (8 * side + 1) * side;
    assert_int_equal(glint_png_decode(file.data, file.size, &png, &error), GLINT_ERR_FORMAT);
    assert_non_null(strstr(error.message, "too little data for its size"));
    assert_int_equal(glint_png_raw_bytes(file.data, file.size), raw);
    assert_int_equal(glint_png_raw_bytes(file.data, 33), raw); // these 33 bytes are enough to read IHDR
    assert_int_equal(glint_png_raw_bytes(file.data, 32), 0);
    file.data[18] ^= 1; // makes its CRC wrong
    assert_int_equal(glint_png_raw_bytes(file.data, file.size), 0);
    free(file.data);
    file = claim(2, 3, 5, 10);
    // five frames and a separate default image
    assert_int_equal(glint_png_raw_bytes(file.data, file.size), 6 * (2 * 8 + 1) * 3);
    free(file.data);
    const uint8_t pfm[] = "PF\n65535 2\n-1\n";
    assert_int_equal(glint_pfm_bytes(pfm, sizeof pfm - 1), sizeof pfm - 1 + 65535 * 2 * 3 * 4);
    assert_int_equal(glint_pfm_bytes(pfm, 5), 0);
}

static void show_frame(player *p)
{
    glint_bytes file = { 0 };
    glint_png png;
    uint8_t header[13];
    memcpy(header, p->header + 8, 13);
    memcpy(header, p->control + 4, 8);
    assert_true(glint_bytes_append(&file, "\x89PNG\r\n\x1a\n", 8));
    put_chunk(&file, "IHDR", header, 13);
    put_chunk(&file, "IDAT", p->data.data, p->data.size);
    put_chunk(&file, "IEND", header, 0);
    assert_int_equal(glint_png_decode(file.data, file.size, &png, NULL), GLINT_OK);
    size_t x = big_endian(p->control + 12), y = big_endian(p->control + 16), row = (size_t)png.width * p->pixel_bytes;
    for (size_t i = 0; i < (size_t)png.height; i++)
        memcpy(p->canvas + ((y + i) * p->width + x) * p->pixel_bytes, (uint8_t *)png.codes + i * row, row);
    free(png.codes);
    free(file.data);
    p->data.size = 0;
    p->frames++;
}

/// Plays a file and compares frame i with picture i.
static void check_played(const char *path, const char *const *pictures, uint32_t count, unsigned above, unsigned below)
{
    glint_bytes bytes = read_ok(path);
    player p = { .width = big_endian(bytes.data + 16) };
    memcpy(p.header, bytes.data + 8, 25);
    p.pixel_bytes = (bytes.data[24] == 16 ? 2 : 1) * (bytes.data[25] == 6 ? 4 : 3);
    size_t size = (size_t)p.width * big_endian(bytes.data + 20) * p.pixel_bytes;
    p.canvas = calloc(1, size);
    for (size_t at = 8; at < bytes.size;) {
        const uint8_t *body = bytes.data + at + 8, *type = bytes.data + at + 4;
        uint32_t length = big_endian(bytes.data + at);
        bool ends = memcmp(type, "fcTL", 4) == 0 || memcmp(type, "IEND", 4) == 0;
        if (memcmp(type, "acTL", 4) == 0)
            assert_int_equal(big_endian(body), count);
        if (ends && p.data.size > 0) {
            show_frame(&p);
            glint_png want = decode_ok(pictures[p.frames - 1]);
            assert_memory_equal(p.canvas, want.codes, size);
            free(want.codes);
        }
        if (memcmp(type, "fcTL", 4) == 0) {
            memcpy(p.control, body, 26);
            assert_int_equal(big_endian(body), p.sequence++);
            assert_int_equal(body[20] << 8 | body[21], above);
            assert_int_equal(body[22] << 8 | body[23], below);
        } else if (memcmp(type, "IDAT", 4) == 0) {
            assert_true(glint_bytes_append(&p.data, body, length));
        } else if (memcmp(type, "fdAT", 4) == 0) {
            assert_int_equal(big_endian(body), p.sequence++);
            assert_true(glint_bytes_append(&p.data, body + 4, length - 4));
        }
        at += 12 + length;
    }
    assert_int_equal(p.frames, count);
    free(p.canvas);
    free(p.data.data);
    free(bytes.data);
}

/// Writes a frame with a bright square at a position; -1: no square.
static const char *write_frame(const char *name, int bits, bool alpha, int square)
{
    const char *path = in_folder(name);
    glint_image *image = make_image(40, 30, NULL);
    image->alpha = alpha;
    for (int i = 0; square >= 0 && i < 9; i++)
        image->plane[GLINT_PASS_BEAUTY][1][(5 + i / 3) * 40 + square + i % 3] = 0.9f;
    glint_write_desc desc = describe(path);
    desc.tone.bits = bits;
    write_ok(image, &desc);
    glint_image_release(image);
    return path;
}

static void make_apng(const char *path, const glint_apng_desc *desc, const char *const *pictures)
{
    glint_apng *apng = NULL;
    glint_error error = { 0 };
    assert_int_equal(glint_apng_create(path, desc, &apng, &error), GLINT_OK);
    for (uint32_t i = 0; i < desc->frame_count; i++) {
        assert_int_equal(glint_apng_finish(apng, &error), GLINT_ERR_INVALID);
        glint_picture *picture = read_picture(pictures[i], true);
        assert_int_equal(glint_apng_add(apng, picture, &error), GLINT_OK);
        glint_picture_destroy(picture);
    }
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(glint_apng_finish(apng, &error), GLINT_OK);
    glint_apng_destroy(apng);
}

static void test_apng(void **state)
{
    (void)state;
    static const struct {
        int bits;
        bool alpha;
        double fps;
        unsigned above, below;
    } cases[] = { { 8, false, 24, 1, 24 },  { 16, false, 30000.0 / 1001, 1001, 30000 },
                  { 8, false, 0.1, 10, 1 }, { 8, true, 12.5, 2, 25 },
                  { 16, true, 24, 1, 24 } };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char name[16];
        snprintf(name, sizeof name, "film%zu.png", i);
        char *film = strdup(in_folder(name));
        const int bits = cases[i].bits;
        const bool alpha = cases[i].alpha;
        const char *pictures[] = { write_frame("0.png", bits, alpha, -1), write_frame("1.png", bits, alpha, 0),
                                   write_frame("2.png", bits, alpha, 37), write_frame("3.png", bits, alpha, 37),
                                   write_frame("4.png", bits, alpha, -1) };
        glint_apng_desc desc = { 40, 30, bits, alpha, GLINT_TRANSFER_SRGB, 5, cases[i].fps, 0, GLINT_ENCODE_FAST };
        make_apng(film, &desc, pictures);
        check_played(film, pictures, 5, cases[i].above, cases[i].below);
        free(film);
    }
}

static void test_apng_refuses(void **state)
{
    (void)state;
    glint_error error = { 0 };
    glint_apng *apng = NULL;
    glint_apng_desc desc = { 40, 30, 8, false, GLINT_TRANSFER_SRGB, 1, 24, 0, GLINT_ENCODE_FAST };
    const char *path = in_folder("film.png");
    glint_apng_desc wrong[] = { desc, desc, desc, desc, desc };
    wrong[0].width = 0;
    wrong[1].bits = 12;
    wrong[2].frame_count = 0;
    wrong[3].fps = 0;
    wrong[4].fps = NAN;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(glint_apng_create(path, &wrong[i], &apng, &error), GLINT_ERR_INVALID);
    glint_picture *covered = read_picture(write_frame("covered.png", 8, true, 1), true);
    glint_picture *deep = read_picture(write_frame("deep.png", 16, false, 1), true);
    glint_picture *small = read_picture(write_plain("small.png", 20, 10, 1), true);
    glint_picture *unread = read_picture(write_frame("right.png", 8, false, 1), false);
    glint_picture *right = read_picture(in_folder("right.png"), true);
    assert_int_equal(glint_apng_create(path, &desc, &apng, &error), GLINT_OK);
    assert_int_equal(glint_apng_add(apng, deep, &error), GLINT_ERR_INVALID);
    assert_int_equal(glint_apng_add(apng, covered, &error), GLINT_ERR_INVALID);
    glint_picture_destroy(covered);
    assert_int_equal(glint_apng_add(apng, small, &error), GLINT_ERR_INVALID);
    assert_int_equal(glint_apng_add(apng, unread, &error), GLINT_ERR_INVALID);
    assert_int_equal(glint_apng_add(apng, right, &error), GLINT_OK);
    assert_int_equal(glint_apng_add(apng, right, &error), GLINT_ERR_INVALID); // one frame more than declared
    glint_apng_destroy(apng); // the file is unfinished
    glint_apng_destroy(NULL);
    assert_int_equal(files_in(folder), 4);
    glint_picture_destroy(deep);
    glint_picture_destroy(small);
    glint_picture_destroy(unread);
    glint_picture_destroy(right);
}

int main(void)
{
    setenv("GLINT_FONT", "bitmap", 1); // the same pixels on every machine
    const struct CMUnitTest tests[] = {
        WITH_FOLDER(test_draft),          WITH_FOLDER(test_picture_alpha), WITH_FOLDER(test_picture_linear),
        WITH_FOLDER(test_picture_broken), cmocka_unit_test(test_claims),
        cmocka_unit_test(test_font),      cmocka_unit_test(test_ink),
        cmocka_unit_test(test_turned),
        WITH_FOLDER(test_sheet),          WITH_FOLDER(test_sheet_heads),  WITH_FOLDER(test_sheet_bar),     WITH_FOLDER(test_sheet_refuses),
        WITH_FOLDER(test_apng),
        WITH_FOLDER(test_apng_refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
