// Contact sheets: chooses labels, columns and titles from the axes of the files. The engine draws the sheet.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "bindings/run/sheet.h"

#define DEFAULT_GAIN 8.0
#define ROW_MAX 6 // cells of a single axis in one row, unless columns are given
#define LABEL_SIZE 512

static bool ends_in(const char *path, const char *ending)
{
    size_t length = strlen(path), size = strlen(ending);
    return length > size && path[length - size - 1] != '/' && strcasecmp(path + length - size, ending) == 0;
}

bool glintL_sheet_check(const glintL_sheet *sheet, char message[GLINTL_MESSAGE_SIZE])
{
    if (!ends_in(sheet->path, ".png") && !glintL_name_is_vector(sheet->path) && !ends_in(sheet->path, ".html"))
        return glintL_complain(message, "a file name ending in .png, .svg, .pdf or .html expected, got '%.200s'",
                               sheet->path);
    if (sheet->count < 1 || sheet->count > GLINTL_SHEET_MAX)
        return glintL_complain(message, "pictures: 1 .. %d expected, got %zu", GLINTL_SHEET_MAX, sheet->count);
    if (!glintL_sheet_check_names(sheet, message))
        return false;
    if (sheet->difference > (int64_t)sheet->count)
        snprintf(message, GLINTL_MESSAGE_SIZE, "difference: a picture 1 .. %zu expected, got %lld", sheet->count,
                 (long long)sheet->difference);
    else if (sheet->gain > 0 && !sheet->difference)
        snprintf(message, GLINTL_MESSAGE_SIZE, "gain: expected together with difference");
    else if (sheet->columns && ends_in(sheet->path, ".html"))
        snprintf(message, GLINTL_MESSAGE_SIZE, "columns: not for pages; a page has one column for each value of its "
                                               "first axis");
    else if ((sheet->size > 0 || sheet->transparent || sheet->colorbar) && ends_in(sheet->path, ".html"))
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s: has no effect on a page",
                 sheet->colorbar ? "colorbar" : sheet->transparent ? "transparent" : "size");
    else
        return true;
    return false;
}

// ---- Labels ----

static const char *frame_of(const glintL_axes *axes, size_t cell)
{
    const char *frame = glint_picture_text(axes->pictures[cell], "glint:frame");
    return frame ? frame : "?";
}

// Returns whether the cells have different frame numbers.
static bool frames_differ(const glintL_axes *axes)
{
    for (size_t i = 1; i < axes->cell_count; i++)
        if (strcmp(frame_of(axes, i), frame_of(axes, i - 1)) == 0)
            return false;
    return axes->cell_count > 1;
}

// Writes a cell's values of the axes from `first` to before `end`, with the names or without.
static void write_values(const glintL_sheet *sheet, const glintL_axes *axes, size_t first, size_t end, size_t cell,
                         bool named, const char *separator, char out[LABEL_SIZE])
{
    char name[GLINTL_AXIS_SIZE] = "", value[GLINTL_AXIS_SIZE];
    size_t used = 0;
    out[0] = '\0';
    for (size_t a = first; a < end && used < LABEL_SIZE; a++) {
        const glintL_axis *axis = &axes->axis[a];
        if (named)
            glintL_axis_title(sheet, axis, name);
        glintL_axis_spell(sheet, axis, axis->index[cell], value);
        used += (size_t)snprintf(out + used, LABEL_SIZE - used, "%s%s%s%s", a > first ? separator : "", name,
                                 named ? " = " : "", value);
    }
}

// Writes "name = value" for every axis, as separate parts; without axes the frame number, otherwise the file name.
static void default_label(const glintL_sheet *sheet, const glintL_axes *axes, size_t cell, char out[LABEL_SIZE])
{
    write_values(sheet, axes, 0, axes->count, cell, true, "\n", out);
    if (axes->count == 0 && frames_differ(axes))
        snprintf(out, LABEL_SIZE, "frame %s", frame_of(axes, cell));
    else if (axes->count == 0)
        snprintf(out, LABEL_SIZE, "%s", glintL_base_name(sheet->files[cell]));
}

// Returns the value for {name}; NULL: unknown name.
static const char *find_value(const glintL_sheet *sheet, const glintL_axes *axes, size_t cell, const char *name,
                              size_t length, char value[GLINTL_AXIS_SIZE])
{
    for (size_t a = 0; a < axes->count; a++) {
        const glintL_axis *axis = &axes->axis[a];
        if (strlen(axis->name) != length || memcmp(axis->name, name, length) != 0)
            continue;
        glintL_axis_spell(sheet, axis, axis->index[cell], value);
        return value;
    }
    if (length == 4 && memcmp(name, "file", 4) == 0)
        return glintL_base_name(sheet->files[cell]);
    return length == 5 && memcmp(name, "frame", 5) == 0 ? frame_of(axes, cell) : NULL;
}

// Fills in the template. False: the message names the unknown name.
static bool fill_label(const glintL_sheet *sheet, const glintL_axes *axes, size_t cell, char out[LABEL_SIZE],
                       char *message)
{
    char value[GLINTL_AXIS_SIZE];
    size_t used = 0;
    for (const char *at = sheet->label; *at && used < LABEL_SIZE - 1;) {
        const char *end = *at == '{' ? strchr(at, '}') : NULL;
        if (!end) {
            out[used++] = *at++;
            continue;
        }
        size_t length = (size_t)(end - at) - 1;
        const char *text = find_value(sheet, axes, cell, at + 1, length, value);
        if (!text) {
            snprintf(message, GLINTL_MESSAGE_SIZE,
                     "label: {%.*s}: an axis of the sheet, {file} or {frame} expected; the axes are%s", (int)length,
                     at + 1, axes->count ? ":" : " none");
            for (size_t a = 0; a < axes->count; a++) {
                size_t size = strlen(message);
                snprintf(message + size, GLINTL_MESSAGE_SIZE - size, " {%s}", axes->axis[a].name);
            }
            return false;
        }
        used += (size_t)snprintf(out + used, LABEL_SIZE - used, "%s", text);
        at = end + 1;
    }
    out[used < LABEL_SIZE ? used : LABEL_SIZE - 1] = '\0';
    return true;
}

static void free_list(char **list, size_t count)
{
    for (size_t i = 0; i < count && list; i++)
        free(list[i]);
    free(list);
}

// Returns the number of columns: the number of values of a grid's first axis; otherwise the sheet is about square.
static int columns_of(const glintL_sheet *sheet, const glintL_axes *axes)
{
    if (sheet->columns)
        return (int)(sheet->columns < (int64_t)sheet->count ? sheet->columns : (int64_t)sheet->count);
    if (axes->is_grid && (axes->count > 1 || sheet->count <= ROW_MAX))
        return (int)axes->axis[0].count;
    return (int)ceil(sqrt((double)sheet->count));
}

// Returns whether heads name the values of the axes.
static bool has_heads(const glintL_sheet *sheet, const glintL_axes *axes)
{
    return axes->is_grid && !sheet->labels && !sheet->label;
}

// Returns whether a single axis takes several rows: then each picture has its value below it.
static bool is_wrapped(const glintL_sheet *sheet, const glintL_axes *axes)
{
    return axes->count == 1 && !ends_in(sheet->path, ".html") && (size_t)columns_of(sheet, axes) < axes->axis[0].count;
}

// Returns the labels of all cells, owned by the caller. NULL: the message says why.
static char **make_labels(const glintL_sheet *sheet, const glintL_axes *axes, char *message)
{
    char label[LABEL_SIZE];
    char **labels = calloc(sheet->count, sizeof *labels);
    bool good = labels != NULL;
    snprintf(message, GLINTL_MESSAGE_SIZE, "out of memory");
    for (size_t i = 0; i < sheet->count && good; i++) {
        label[0] = '\0';
        if (sheet->labels)
            snprintf(label, sizeof label, "%s", sheet->labels[i]);
        else if (has_heads(sheet, axes))
            write_values(sheet, axes, 0, is_wrapped(sheet, axes), i, false, "", label);
        else if (!sheet->label)
            default_label(sheet, axes, i, label);
        else if (strcmp(sheet->label, "none") != 0)
            good = fill_label(sheet, axes, i, label, message);
        labels[i] = good ? strdup(label) : NULL;
        good = labels[i] != NULL;
    }
    if (good)
        return labels;
    free_list(labels, sheet->count);
    return NULL;
}

// ---- The picture ----

// Returns how many axes of a grid go across: those whose combined values make the columns. A single axis may take
// several rows. 0: no number of axes fits the columns.
static size_t count_across(const glintL_axes *axes, size_t columns)
{
    size_t product = 1;
    if (axes->count == 1)
        return 1;
    for (size_t a = 0; a < axes->count; a++) {
        product *= axes->axis[a].count;
        if (product == columns)
            return a + 1;
    }
    return 0;
}

static bool check_columns(const glintL_sheet *sheet, const glintL_axes *axes, char *message)
{
    size_t used = 0, product = 1;
    char counts[200] = "";
    if (!axes->is_grid || count_across(axes, (size_t)columns_of(sheet, axes)))
        return true;
    for (size_t a = 0; a < axes->count && used < sizeof counts; a++) {
        product *= axes->axis[a].count;
        used += (size_t)snprintf(counts + used, sizeof counts - used, "%s%zu (%s)", a ? " x " : "", axes->axis[a].count,
                                 axes->axis[a].name);
    }
    return glintL_complain(
        message, "columns: %zu or %zu expected, so that each column of the %s pictures has one value of %s, got %lld",
        axes->axis[0].count, product, counts, axes->axis[0].name, (long long)sheet->columns);
}

// Lists the names of the axes from `first` to before `end`, owned by the caller. NULL: out of memory.
static char *list_names(const glintL_sheet *sheet, const glintL_axes *axes, size_t first, size_t end)
{
    char *out = calloc(GLINTL_AXES_MAX, GLINTL_AXIS_SIZE + 2);
    size_t used = 0;
    for (size_t a = first; a < end && out; a++) {
        if (a > first)
            used += (size_t)snprintf(out + used, 3, ", ");
        glintL_axis_title(sheet, &axes->axis[a], out + used);
        used += strlen(out + used);
    }
    return out;
}

// Returns the heads of `count` columns, rows or blocks, owned by the caller: the values of the axes from `first` to
// before `end` in every `step`-th cell. NULL: out of memory.
static char **make_heads(const glintL_sheet *sheet, const glintL_axes *axes, size_t first, size_t end, size_t count,
                         size_t step, bool named)
{
    char text[LABEL_SIZE];
    char **heads = calloc(count, sizeof *heads);
    bool good = heads != NULL;
    for (size_t i = 0; i < count && good; i++) {
        write_values(sheet, axes, first, end, i * step, named, ", ", text);
        good = (heads[i] = strdup(text)) != NULL;
    }
    if (!good) {
        free_list(heads, count);
        heads = NULL;
    }
    return heads;
}

// The texts around a grid, owned.
typedef struct surround {
    char *across, *down; // NULL: none
    char **columns, **rows, **blocks; // NULL: none
    size_t column_count, row_count, block_count;
} surround;

static void drop_surround(surround *s)
{
    free_list(s->columns, s->column_count);
    free_list(s->rows, s->row_count);
    free_list(s->blocks, s->block_count);
    free(s->across);
    free(s->down);
}

// Makes the heads of columns, rows and blocks: `across` axes go across, the next one down, and all others make blocks.
static bool add_heads(const glintL_sheet *sheet, const glintL_axes *axes, size_t across, surround *out)
{
    const size_t down = across < axes->count ? across + 1 : across, cells = axes->cell_count;
    out->row_count = cells / out->column_count;
    out->block_count = down > across ? out->row_count / axes->axis[across].count : 0;
    out->columns = make_heads(sheet, axes, 0, across, out->column_count, 1, false);
    bool good = out->columns;
    if (down > across)
        good = (out->rows = make_heads(sheet, axes, across, down, out->row_count, out->column_count, false)) && good;
    if (axes->count > down)
        good = (out->blocks = make_heads(sheet, axes, down, axes->count, out->block_count, cells / out->block_count, true)) && good;
    return good;
}

// Makes the texts around a grid. False: out of memory.
static bool make_surround(const glintL_sheet *sheet, const glintL_axes *axes, surround *out)
{
    const size_t columns = (size_t)columns_of(sheet, axes);
    const size_t across = axes->is_grid ? count_across(axes, columns) : 0;
    const size_t down = across < axes->count && has_heads(sheet, axes) ? across + 1 : axes->count;
    *out = (surround) { .column_count = columns };
    if (!across)
        return true;
    bool good = (out->across = list_names(sheet, axes, 0, across)) != NULL;
    if (across < axes->count)
        good = (out->down = list_names(sheet, axes, across, down)) && good;
    if (has_heads(sheet, axes) && !is_wrapped(sheet, axes))
        good = add_heads(sheet, axes, across, out) && good;
    return good;
}

static int draw_picture(const glintL_sheet *sheet, const glintL_axes *axes, char *const *labels, char *message)
{
    surround around;
    glint_error error;
    glint_status status = GLINT_ERR_NOMEM;
    glint_sheet_cell *cells = calloc(sheet->count, sizeof *cells);
    for (size_t i = 0; i < sheet->count && cells; i++)
        cells[i] = (glint_sheet_cell) { sheet->files[i], labels[i] };
    snprintf(error.message, sizeof error.message, "out of memory");
    if (make_surround(sheet, axes, &around) && cells) {
        const glint_sheet_desc desc = {
            .cells = cells, .cell_count = sheet->count, .columns = columns_of(sheet, axes), .title = sheet->title,
            .across = around.across, .down = around.down, .column_heads = (const char *const *)around.columns,
            .row_heads = (const char *const *)around.rows, .block_heads = (const char *const *)around.blocks,
            .block_rows = around.blocks ? (int)(around.row_count / around.block_count) : 0,
            .difference = (size_t)sheet->difference, .gain = sheet->gain > 0 ? sheet->gain : DEFAULT_GAIN, .size = sheet->size,
            .dpi = sheet->dpi, .transparent = sheet->transparent, .colorbar = sheet->colorbar,
        };
        status = glint_sheet_write(&desc, sheet->path, &error);
    }
    drop_surround(&around);
    free(cells);
    if (status)
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
    return glintL_run_exit_code(status);
}

// Returns the names of all axes as "name=" lines, owned by the caller. NULL: out of memory.
static char *axis_lines(const glintL_axes *axes)
{
    size_t size = 1, used = 0;
    for (size_t a = 0; a < axes->count; a++)
        size += strlen(axes->axis[a].name) + 2;
    char *lines = calloc(size, 1);
    for (size_t a = 0; a < axes->count && lines; a++)
        used += (size_t)snprintf(lines + used, size - used, "%s=\n", axes->axis[a].name);
    return lines;
}

static bool check_known(const glintL_sheet *sheet, const glintL_axes *axes, char *message)
{
    char *lines = axis_lines(axes);
    const bool good = lines && glintL_sheet_check_axes(sheet, lines, message);
    if (!lines)
        snprintf(message, GLINTL_MESSAGE_SIZE, "out of memory");
    free(lines);
    return good;
}

int glintL_sheet_make(const glintL_sheet *sheet, char message[GLINTL_MESSAGE_SIZE])
{
    glintL_axes axes;
    int code = GLINTL_EXIT_USAGE;
    if (!glintL_sheet_check(sheet, message))
        return code;
    if (glintL_axes_find(sheet, &axes, &code, message)) {
        const bool good = check_known(sheet, &axes, message) && check_columns(sheet, &axes, message);
        char **labels = good ? make_labels(sheet, &axes, message) : NULL;
        code = GLINTL_EXIT_USAGE;
        if (labels)
            code = ends_in(sheet->path, ".html") ? glintL_sheet_page(sheet, &axes, labels, message)
                                                 : draw_picture(sheet, &axes, labels, message);
        free_list(labels, sheet->count);
    }
    glintL_axes_drop(&axes);
    return code;
}
