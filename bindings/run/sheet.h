/// Contact sheets of finished frames, as a picture or as a page. Private to bindings/.
#ifndef GLINT_L_SHEET_H
#define GLINT_L_SHEET_H

#include "bindings/run/run.h"

#define GLINTL_AXES_MAX 16
#define GLINTL_SHEET_MAX 100000 ///< cells
#define GLINTL_AXIS_NAME_MAX 100 ///< bytes of a name that a sheet gives an axis
#define GLINTL_FORMAT_MAX 80 ///< bytes of a format
#define GLINTL_AXIS_SIZE 512 ///< for the text of one value or name, with its end; holds any number in any format

// ---- sheet.c ----

typedef struct glintL_sheet {
    const char *path; ///< .png or .html
    char *const *files; ///< the cells, row by row
    size_t count;
    char *const *positions; ///< "name=value" lines of each cell, its place on the axes; NULL: read from the file
    char *const *labels; ///< NULL: made from `label`
    const char *names; ///< "axis=text" lines: names of axes on the sheet; NULL: the axes' own
    const char *formats; ///< "axis=format" lines, for printf; an empty axis stands for all others; NULL: up to 4 digits
    const char *label; ///< with {name} for a value; "none"; NULL: heads on a grid, otherwise every axis and its value
    const char *title; ///< NULL: none
    int64_t columns; ///< 0: from the axes
    int64_t difference; ///< the cell, from 1, that the others are compared with; 0: none
    double gain; ///< 0: the default
    double size, dpi; ///< size of the text, points; pixels per inch: 0: not given
    bool transparent; ///< no background
    const glint_overlay_desc *colorbar; ///< for all pictures; NULL: none
    bool mixes; ///< files may come from different scripts or settings
    const char *live; ///< HTML of a live figure for the page; NULL: none
} glintL_sheet;

/// Checks everything that does not depend on the files. False: the message says what is wrong.
bool glintL_sheet_check(const glintL_sheet *sheet, char message[GLINTL_MESSAGE_SIZE]);
/// Draws the sheet. Returns the exit code; the message says what is wrong.
int glintL_sheet_make(const glintL_sheet *sheet, char message[GLINTL_MESSAGE_SIZE]);

// ---- sheet_axes.c: what distinguishes the cells ----

typedef struct glintL_axis {
    char *name; ///< owned
    char **values; ///< owned, in the order of the cells
    size_t count;
    size_t *index; ///< owned: index of each cell's value
} glintL_axis;

typedef struct glintL_axes {
    glintL_axis axis[GLINTL_AXES_MAX]; ///< the first axis changes fastest
    size_t count;
    bool is_grid; ///< the cells are all combinations, in order
    glint_picture **pictures; ///< owned; the files' pictures, for their sizes and texts
    size_t cell_count;
} glintL_axes;

/// Reads the files of a sheet and finds its axes: first the axes of sweeps, then the parameters, options and passes
/// that differ. False: a file is missing, or differs in size or origin; *code is the exit code. The caller drops `out`
/// in any case.
bool glintL_axes_find(const glintL_sheet *sheet, glintL_axes *out, int *code, char message[GLINTL_MESSAGE_SIZE]);
void glintL_axes_drop(glintL_axes *axes);

// ---- sheet_names.c: names and values as the sheet shows them ----

/// Checks the form of `names` and `formats`. False: the message says what is wrong.
bool glintL_sheet_check_names(const glintL_sheet *sheet, char message[GLINTL_MESSAGE_SIZE]);
/// Checks that `names` and `formats` are of axes in `axes`, which has "axis=..." lines. False: the message names the
/// nearest axis.
bool glintL_sheet_check_axes(const glintL_sheet *sheet, const char *axes, char message[GLINTL_MESSAGE_SIZE]);
/// Writes the name of an axis for the sheet.
void glintL_axis_title(const glintL_sheet *sheet, const glintL_axis *axis, char out[GLINTL_AXIS_SIZE]);
/// Writes value `i` of an axis for the sheet.
void glintL_axis_spell(const glintL_sheet *sheet, const glintL_axis *axis, size_t i, char out[GLINTL_AXIS_SIZE]);

// ---- sheet_page.c ----

/// Writes the page with a slider for each axis, and the labels of the sheet. Returns the exit code.
int glintL_sheet_page(const glintL_sheet *sheet, const glintL_axes *axes, char *const *labels,
                      char message[GLINTL_MESSAGE_SIZE]);

// ---- sweep_sheet.c ----

void glintL_list_sheet(lua_State *L); ///< lists its fields, see glintL_list_variant
/// Checks sweep.sheet at `index`; raises if it is wrong.
void glintL_sweep_check_sheet(lua_State *L, int index);
/// Checks the sheet of the sweep at `index` against its axes, when both are set; raises if they do not match.
void glintL_sweep_check_together(lua_State *L, int index);
/// Draws the sheet of the sweep at `index`, if it has one. Its frames are numbered from `first`. Waits until they are
/// written. partial: some frames were not selected, and missing files only give a warning. False: the run has failed.
bool glintL_sweep_make_sheet(lua_State *L, int index, const glintL_naming *naming, int64_t first, bool partial);

#endif
