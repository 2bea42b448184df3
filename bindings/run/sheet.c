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
    if (!ends_in(sheet->path, ".png") && !ends_in(sheet->path, ".html")) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "a file name ending in .png or .html expected, got '%.200s'",
                 sheet->path);
        return false;
    }
    if (sheet->count < 1 || sheet->count > GLINTL_SHEET_MAX) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "pictures: 1 .. %d expected, got %zu", GLINTL_SHEET_MAX, sheet->count);
        return false;
    }
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

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

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

// Writes "name value" for every axis, as separate parts; without axes the frame number, otherwise the file name.
static void default_label(const glintL_sheet *sheet, const glintL_axes *axes, size_t cell, char out[LABEL_SIZE])
{
    char value[64];
    size_t used = 0;
    for (size_t a = 0; a < axes->count && used < LABEL_SIZE; a++) {
        const glintL_axis *axis = &axes->axis[a];
        glintL_axis_spell(axis->values[axis->index[cell]], value);
        used += (size_t)snprintf(out + used, LABEL_SIZE - used, "%s%s = %s", a ? "\n" : "", axis->name, value);
    }
    if (axes->count == 0 && frames_differ(axes))
        snprintf(out, LABEL_SIZE, "frame %s", frame_of(axes, cell));
    else if (axes->count == 0)
        snprintf(out, LABEL_SIZE, "%s", base_name(sheet->files[cell]));
}

// Returns the value for {name}; NULL: unknown name.
static const char *find_value(const glintL_sheet *sheet, const glintL_axes *axes, size_t cell, const char *name,
                              size_t length, char value[64])
{
    for (size_t a = 0; a < axes->count; a++) {
        const glintL_axis *axis = &axes->axis[a];
        if (strlen(axis->name) != length || memcmp(axis->name, name, length) != 0)
            continue;
        glintL_axis_spell(axis->values[axis->index[cell]], value);
        return value;
    }
    if (length == 4 && memcmp(name, "file", 4) == 0)
        return base_name(sheet->files[cell]);
    return length == 5 && memcmp(name, "frame", 5) == 0 ? frame_of(axes, cell) : NULL;
}

// Fills in the template. False: the message names the unknown name.
static bool fill_label(const glintL_sheet *sheet, const glintL_axes *axes, size_t cell, char out[LABEL_SIZE],
                       char *message)
{
    char value[64];
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

// Returns the number of columns: the number of values of a grid's first axis; otherwise the sheet is about square.
static int columns_of(const glintL_sheet *sheet, const glintL_axes *axes)
{
    if (sheet->columns)
        return (int)(sheet->columns < (int64_t)sheet->count ? sheet->columns : (int64_t)sheet->count);
    if (axes->is_grid && (axes->count > 1 || sheet->count <= ROW_MAX))
        return (int)axes->axis[0].count;
    return (int)ceil(sqrt((double)sheet->count));
}

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
    snprintf(message, GLINTL_MESSAGE_SIZE,
             "columns: %zu or %zu expected, so that each column of the %s pictures has one value of %s, got %lld",
             axes->axis[0].count, product, counts, axes->axis[0].name, (long long)sheet->columns);
    return false;
}

static void list_names(const glintL_axes *axes, size_t from, size_t to, char out[256])
{
    size_t used = 0;
    out[0] = '\0';
    for (size_t a = from; a < to && used < 256; a++)
        used += (size_t)snprintf(out + used, 256 - used, "%s%s", a > from ? ", " : "", axes->axis[a].name);
}

// Names the columns and rows of a grid.
static void set_titles(const glintL_axes *axes, glint_sheet_desc *desc, char across[256], char down[256])
{
    const size_t count = axes->is_grid ? count_across(axes, (size_t)desc->columns) : 0;
    if (!count)
        return;
    list_names(axes, 0, count, across);
    list_names(axes, count, axes->count, down);
    desc->across = across;
    desc->down = *down ? down : NULL;
}

static int draw_picture(const glintL_sheet *sheet, const glintL_axes *axes, char *const *labels, char *message)
{
    char across[256], down[256];
    glint_error error;
    glint_sheet_cell *cells = calloc(sheet->count, sizeof *cells);
    if (!cells) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "out of memory");
        return GLINTL_EXIT_FAILED;
    }
    for (size_t i = 0; i < sheet->count; i++)
        cells[i] = (glint_sheet_cell) { sheet->files[i], labels[i] };
    glint_sheet_desc desc = { .cells = cells, .cell_count = sheet->count, .title = sheet->title };
    desc.columns = columns_of(sheet, axes);
    desc.difference = (size_t)sheet->difference;
    desc.gain = sheet->gain > 0 ? sheet->gain : DEFAULT_GAIN;
    desc.size = sheet->size;
    desc.dpi = sheet->dpi;
    desc.transparent = sheet->transparent;
    desc.colorbar = sheet->colorbar;
    set_titles(axes, &desc, across, down);
    glint_status status = glint_sheet_write(&desc, sheet->path, &error);
    free(cells);
    if (status)
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
    return glintL_run_exit_code(status);
}

int glintL_sheet_make(const glintL_sheet *sheet, char message[GLINTL_MESSAGE_SIZE])
{
    glintL_axes axes;
    int code = GLINTL_EXIT_USAGE;
    if (!glintL_sheet_check(sheet, message))
        return code;
    if (glintL_axes_find(sheet, &axes, &code, message)) {
        char **labels = check_columns(sheet, &axes, message) ? make_labels(sheet, &axes, message) : NULL;
        code = GLINTL_EXIT_USAGE;
        if (labels)
            code = ends_in(sheet->path, ".html") ? glintL_sheet_page(sheet, &axes, labels, message)
                                                 : draw_picture(sheet, &axes, labels, message);
        free_list(labels, sheet->count);
    }
    glintL_axes_drop(&axes);
    return code;
}
