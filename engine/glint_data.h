/// Data of other programs: rows of numbers in text, and bonds between atoms.
#ifndef GLINT_DATA_H
#define GLINT_DATA_H

#include "glint_types.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

// ---- Rows of numbers in text ---------------------------------------------------------------------------------------

/// A table from words to numbers, for columns of words.
typedef struct glint_words glint_words;

/// Makes an empty table; the caller destroys it.
glint_status glint_words_create(glint_words **out, glint_error *error);
/// Adds a word, or changes the number of a word. GLINT_ERR_INVALID: the table already has 65536 words.
glint_status glint_words_add(glint_words *words, const char *word, size_t length, uint32_t number, glint_error *error);
/// Frees the table. NULL: nothing.
void glint_words_destroy(glint_words *words);

/// What a field must be.
typedef enum glint_column_kind {
    GLINT_COLUMN_NUMBER, ///< a finite decimal number such as -1.5, 3e-7 or Fortran's 1.5D+03
    GLINT_COLUMN_SIZE, ///< a number > 0
    GLINT_COLUMN_VALUE, ///< a finite number, in Fortran's form only with a point; or a missing value, NaN: nan, NA, n/a,
        ///< null, or an empty field
    GLINT_COLUMN_WORD ///< a word of `words`
} glint_column_kind;

/// A field that is read from each row.
typedef struct glint_column {
    size_t field; ///< position of the field in its row, from 0; with `is_fixed`: of its first byte in the line
    size_t width; ///< with `is_fixed`: bytes of the field; spaces around a number are skipped
    glint_column_kind kind; ///< what the field must be
    double *numbers; ///< memory for the values; a missing value is NaN. NULL: the field is only checked
    const glint_words *words; ///< GLINT_COLUMN_WORD: the table of its words
    int64_t *indices; ///< GLINT_COLUMN_WORD: memory for the words' numbers. NULL: the field is only checked
} glint_column;

/// How the rows of a text are read.
typedef struct glint_rows_desc {
    char separator; ///< 0: fields are separated by spaces and tabs; otherwise by this character, and may be "quoted"
    size_t field_count; ///< number of fields in each row; 0: any number
    bool skips; ///< lines that are empty or begin with # are not rows
    bool is_fixed; ///< fields have fixed positions in lines without tabs; separator and field_count are not used
    const glint_column *columns; ///< in the order of their fields
    size_t column_count; ///< number of columns
    int threads; ///< 1 .. 1024 threads that read parts of a long text; 0: one per processor
} glint_rows_desc;

/// Reads up to `most` rows of a text, one per line. It stops at the first line that does not have the expected fields,
/// at a line without a newline at its end, and after `most` rows. Numbers are the doubles nearest to their decimal
/// form, whatever the locale.
///
/// used   written: the bytes of the lines read; the next line begins there.
/// lines  written: the number of lines read, including skipped ones.
///
/// Returns the number of rows.
size_t glint_rows_read(const glint_rows_desc *desc, const char *text, size_t length, size_t most, size_t *used,
                       size_t *lines);

// ---- Bonds ---------------------------------------------------------------------------------------------------------

/// The atoms among which glint_bonds_create looks for bonds. All arrays are borrowed for the call.
typedef struct glint_bonds_desc {
    const double *points; ///< `stride` numbers for each atom; the first three are its position
    size_t stride, count; ///< stride >= 3; number of atoms, up to 2^30
    /// Two atoms are joined if their distance is above `closest` and not above the sum of their reaches, >= 0. NaN: the
    /// atom has no bonds
    const double *reach;
    double closest;
    double low[3], size[3]; ///< a box with periodic sides: its corner and the diagonal of its matrix; size >= 0, and
        ///< > 0 for periodic sides
    double xy, xz, yz; ///< tilt: x of the second side, x and y of the third
    bool periodic[3]; ///< sides across which bonds continue; none: the box is not used
    double radius; ///< of the cylinders; > 0
    glint_material *const *materials; ///< as for spheres
    size_t material_count;
    const uint32_t *material_index; ///< material of each atom; NULL: all are 0
} glint_bonds_desc;

/// Finds pairs of atoms by their distance and makes open cylinders of them: two for each bond, from each atom to the
/// middle, with the material of the atom. The middle is that of the nearest images. *out: NULL if there are no bonds.
/// GLINT_ERR_INVALID names a wrong number, or a periodic side shorter than 1/8 of the longest bond.
glint_status glint_bonds_create(const glint_bonds_desc *desc, glint_shape **out, glint_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
