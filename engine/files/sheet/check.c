/// Checks the description of a contact sheet.
#include "engine/base/status.h"
#include "engine/files/vector/figure.h"
#include "engine/files/sheet/layout.h"

#include <stdio.h>
#include <string.h>

#define AREA_MAX ((int64_t)400000000) // most pixels of a sheet: 1.2 GB while the sheet is drawn

static glint_status check_bar(const glint_overlay_desc *desc, glint_error *error)
{
    glint_overlay *bar = NULL;
    glint_error wrong;
    if (desc->kind != GLINT_OVERLAY_COLORBAR)
        return glint_fail(error, GLINT_ERR_INVALID, "colorbar: an overlay of that kind expected");
    const glint_status status = glint_overlay_create(desc, &bar, &wrong);
    glint_overlay_release(bar);
    return status ? glint_fail(error, status, "colorbar.%.400s", wrong.message) : GLINT_OK;
}

static glint_status check_axis(const char *name, const char *text, glint_error *error)
{
    if (!text || strlen(text) <= GLINT_SHEET_AXIS_BYTES)
        return text ? glint_line_check(name, text, error) : GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "%s: a name of at most %d bytes expected, got '%.40s...'", name, GLINT_SHEET_AXIS_BYTES,
                      text);
}

/// Checks the formulas of a text. NULL: no text.
static glint_status check_text(const char *kind, size_t number, const char *text, glint_error *error)
{
    char name[64];
    snprintf(name, sizeof name, "%s %zu", kind, number);
    return text ? glint_line_check(name, text, error) : GLINT_OK;
}

/// Checks the formulas of `count` heads. NULL: no heads.
static glint_status check_heads(const char *kind, const char *const *heads, size_t count, glint_error *error)
{
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < count && heads && !status; i++)
        status = check_text(kind, i + 1, heads[i], error);
    return status;
}

/// Checks the formulas of all texts of a sheet. `across` and `down` are checked already.
static glint_status check_texts(const glint_sheet_desc *desc, glint_error *error)
{
    const size_t columns = (size_t)desc->columns, rows = (desc->cell_count + columns - 1) / columns;
    const size_t block_rows = desc->block_heads ? (size_t)desc->block_rows : 1;
    glint_status status = desc->title ? glint_line_check("title", desc->title, error) : GLINT_OK;
    for (size_t i = 0; i < desc->cell_count && !status; i++)
        status = check_text("label of cell", i + 1, desc->cells[i].label, error);
    if (!status)
        status = check_heads("head of column", desc->column_heads, columns, error);
    if (!status)
        status = check_heads("head of row", desc->row_heads, rows, error);
    return status ? status : check_heads("head of block", desc->block_heads, (rows + block_rows - 1) / block_rows, error);
}

glint_status glint_sheet_check(const glint_sheet_desc *desc, const char *path, glint_error *error)
{
    glint_file_kind kind;
    glint_status status = glint_file_kind_of(path, &kind, error);
    if (!status && kind != GLINT_FILE_PNG && !glint_file_is_vector(kind))
        status = glint_fail(error, GLINT_ERR_INVALID, "path: name ending in .png, .svg or .pdf expected, got '%.400s'", path);
    if (!status)
        status = glint_check_whole("cell_count", (int64_t)desc->cell_count, 1, 1000000, error);
    if (!status)
        status = glint_check_whole("columns", desc->columns, 1, GLINT_SIDE_MAX, error);
    if (!status)
        status = glint_check_whole("difference", (int64_t)desc->difference, 0, (int64_t)desc->cell_count, error);
    if (!status && desc->difference)
        status = glint_check_range("gain", desc->gain, 1e-3, 1e6, "number 0.001 .. 1000000", error);
    if (!status)
        status = glint_check_range("dpi", desc->dpi, 0, 1e6, "number 0 .. 1000000", error);
    if (!status)
        status = glint_check_range("size", desc->size, 0, 10000, "points 0 .. 10000", error);
    if (!status)
        status = check_axis("across", desc->across, error);
    if (!status)
        status = check_axis("down", desc->down, error);
    if (!status && desc->block_heads)
        status = glint_check_whole("block_rows", desc->block_rows, 1, GLINT_SIDE_MAX, error);
    if (!status)
        status = check_texts(desc, error);
    return status || !desc->colorbar ? status : check_bar(desc->colorbar, error);
}

glint_status glint_sheet_check_sides(const glint_sheet_layout *l, glint_error *error)
{
    const long long width = l->sheet_width, height = l->sheet_height;
    if (width > GLINT_SIDE_MAX || height > GLINT_SIDE_MAX)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "sheet: sides of at most %d pixels expected, got %lldx%lld; use other columns or smaller "
                          "pictures",
                          GLINT_SIDE_MAX, width, height);
    if (width * height > AREA_MAX)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "sheet: at most %lld pixels expected, got %lldx%lld; use smaller or fewer pictures",
                          (long long)AREA_MAX, width, height);
    return GLINT_OK;
}
