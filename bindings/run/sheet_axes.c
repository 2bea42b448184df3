// The axes of a sheet: the values that distinguish its cells.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/sheet.h"

static bool no_memory(char *message) { return glintL_complain(message, "out of memory"); }

// ---- The files ----

static bool check_size(const glintL_sheet *sheet, const glintL_axes *axes, size_t i, char *message)
{
    int width = glint_picture_width(axes->pictures[0]), height = glint_picture_height(axes->pictures[0]);
    int other_width = glint_picture_width(axes->pictures[i]), other_height = glint_picture_height(axes->pictures[i]);
    if (width == other_width && height == other_height)
        return true;
    return glintL_complain(message, "%.200s: %dx%d pixels expected, as in %.200s, got %dx%d", sheet->files[i], width,
                           height, sheet->files[0], other_width, other_height);
}

static bool read_files(const glintL_sheet *sheet, glintL_axes *out, int *code, char *message)
{
    glint_error error;
    out->pictures = calloc(sheet->count, sizeof *out->pictures);
    out->cell_count = sheet->count;
    *code = GLINTL_EXIT_FAILED;
    if (!out->pictures)
        return no_memory(message);
    for (size_t i = 0; i < sheet->count; i++) {
        glint_status status = glint_picture_read(sheet->files[i], false, &out->pictures[i], &error);
        if (status) {
            snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
            *code = glintL_run_exit_code(status);
            return false;
        }
        *code = GLINTL_EXIT_USAGE;
        if (!check_size(sheet, out, i, message))
            return false;
        if (!sheet->mixes && !glintL_provenance_match(out->pictures[0], sheet->files[0], out->pictures[i],
                                                      sheet->files[i], false, message))
            return false;
    }
    return true;
}

// ---- The axes ----

// Returns the value of a name in "name=value" lines, owned by the caller; "-" if there is none. NULL: out of memory.
static char *copy_value(const char *lines, const char *name, size_t name_length)
{
    size_t length = 0;
    const char *line = glintL_find_line(lines, name, name_length, &length);
    return line ? strndup(line + name_length + 1, length - name_length - 1) : strdup("-");
}

static const char *lines_of(const glintL_sheet *sheet, const glintL_axes *axes, size_t cell, const char *keyword)
{
    if (sheet->positions && strcmp(keyword, "glint:sweep") == 0)
        return sheet->positions[cell];
    return glint_picture_text(axes->pictures[cell], keyword);
}

static void drop_axis(glintL_axis *axis)
{
    for (size_t i = 0; i < axis->count; i++)
        free(axis->values[i]);
    free(axis->values);
    free(axis->index);
    free(axis->name);
    *axis = (glintL_axis) { 0 };
}

// Adds the value of one cell. The axis takes it over.
static bool add_value(glintL_axis *axis, size_t cell, char *value)
{
    size_t at = 0;
    while (at < axis->count && strcmp(axis->values[at], value) != 0)
        at++;
    axis->index[cell] = at;
    if (at < axis->count) {
        free(value);
        return true;
    }
    char **grown = realloc(axis->values, (axis->count + 1) * sizeof *grown);
    if (!grown) {
        free(value);
        return false;
    }
    axis->values = grown;
    grown[axis->count++] = value;
    return true;
}

// Fills an axis with the cells' values of `name`. Returns false when out of memory.
static bool fill_axis(const glintL_sheet *sheet, const glintL_axes *axes, const char *keyword, const char *name,
                      size_t name_length, glintL_axis *out)
{
    *out = (glintL_axis) { .name = strndup(name, name_length), .index = calloc(sheet->count, sizeof *out->index) };
    bool good = out->name && out->index;
    for (size_t cell = 0; cell < sheet->count && good; cell++) {
        char *value = copy_value(lines_of(sheet, axes, cell, keyword), name, name_length);
        good = value && add_value(out, cell, value);
    }
    if (!good)
        drop_axis(out);
    return good;
}

// Adds the axis "pass" if the files show several passes.
static bool add_passes(glintL_axes *axes)
{
    glintL_axis *axis = &axes->axis[axes->count];
    if (axes->count == GLINTL_AXES_MAX)
        return true;
    *axis = (glintL_axis) { .name = strdup("pass"), .index = calloc(axes->cell_count, sizeof *axis->index) };
    bool good = axis->name && axis->index;
    for (size_t cell = 0; cell < axes->cell_count && good; cell++) {
        const char *pass = glint_picture_text(axes->pictures[cell], "glint:pass");
        char *value = strdup(pass ? pass : "beauty");
        good = value && add_value(axis, cell, value);
    }
    if (good && axis->count > 1)
        axes->count++;
    else
        drop_axis(axis);
    return good;
}

static bool has_axis(const glintL_axes *axes, const char *name, size_t name_length)
{
    for (size_t i = 0; i < axes->count; i++)
        if (strlen(axes->axis[i].name) == name_length && memcmp(axes->axis[i].name, name, name_length) == 0)
            return true;
    return false;
}

// Adds an axis for every name in the first cell's lines; without `all`, only for names whose values differ.
static bool add_axes(const glintL_sheet *sheet, glintL_axes *axes, const char *keyword, bool all)
{
    const char *lines = lines_of(sheet, axes, 0, keyword);
    while (lines && *lines && axes->count < GLINTL_AXES_MAX) {
        size_t size = strcspn(lines, "\n"), name = strcspn(lines, "=");
        if (name < size && !has_axis(axes, lines, name)) {
            glintL_axis *axis = &axes->axis[axes->count];
            if (!fill_axis(sheet, axes, keyword, lines, name, axis))
                return false;
            if (all || axis->count > 1)
                axes->count++;
            else
                drop_axis(axis);
        }
        lines += size + (lines[size] == '\n');
    }
    return true;
}

// Returns whether cell i has value i / stride % count on each axis.
static bool is_grid(const glintL_axes *axes)
{
    size_t stride = 1;
    for (size_t a = 0; a < axes->count; a++) {
        for (size_t cell = 0; cell < axes->cell_count; cell++)
            if (axes->axis[a].index[cell] != cell / stride % axes->axis[a].count)
                return false;
        stride *= axes->axis[a].count;
    }
    return axes->count > 0 && stride == axes->cell_count;
}

// Returns the first cell whose value differs from the first cell's.
static size_t first_change(const glintL_axes *axes, size_t axis)
{
    size_t cell = 0;
    while (cell < axes->cell_count && axes->axis[axis].index[cell] == 0)
        cell++;
    return cell;
}

// Sorts the axes so that the one that changes fastest comes first.
static void sort(glintL_axes *axes)
{
    for (size_t i = 1; i < axes->count; i++)
        for (size_t k = i; k > 0 && first_change(axes, k) < first_change(axes, k - 1); k--) {
            const glintL_axis axis = axes->axis[k];
            axes->axis[k] = axes->axis[k - 1];
            axes->axis[k - 1] = axis;
        }
}

bool glintL_axes_find(const glintL_sheet *sheet, glintL_axes *out, int *code, char message[GLINTL_MESSAGE_SIZE])
{
    memset(out, 0, sizeof *out);
    if (!read_files(sheet, out, code, message))
        return false;
    if (!add_axes(sheet, out, "glint:sweep", true) || !add_axes(sheet, out, "glint:params", false) ||
        !add_axes(sheet, out, "glint:options", false) || !add_passes(out)) {
        *code = GLINTL_EXIT_FAILED;
        return no_memory(message);
    }
    out->is_grid = is_grid(out);
    if (!out->is_grid) { // passes change fastest; so does the last name in files made by nested shell loops
        glintL_axis before[GLINTL_AXES_MAX];
        memcpy(before, out->axis, sizeof before);
        sort(out);
        out->is_grid = is_grid(out);
        if (!out->is_grid)
            memcpy(out->axis, before, sizeof before);
    }
    return true;
}

void glintL_axes_drop(glintL_axes *axes)
{
    for (size_t i = 0; i < axes->count; i++)
        drop_axis(&axes->axis[i]);
    for (size_t i = 0; i < axes->cell_count && axes->pictures; i++)
        glint_picture_destroy(axes->pictures[i]);
    free(axes->pictures);
    memset(axes, 0, sizeof *axes);
}
