/// The signs and the commands of formulas. Internal.
#ifndef GLINT_TEXT_SYMBOLS_H
#define GLINT_TEXT_SYMBOLS_H

#include <stdbool.h>
#include <stddef.h>

/// The classes of TeX's atoms, which determine the space between two of them.
typedef enum glint_atom {
    GLINT_ATOM_ORDINARY,
    GLINT_ATOM_OPERATOR, ///< a function or a large operator: cos, sum
    GLINT_ATOM_BINARY, ///< +
    GLINT_ATOM_RELATION, ///< =
    GLINT_ATOM_OPENING,
    GLINT_ATOM_CLOSING,
    GLINT_ATOM_PUNCTUATION,
    GLINT_ATOM_INNER, ///< a fraction, or a part between \left and \right
    GLINT_ATOM_SPACE, ///< a space command; the classes on both sides of it are neighbours
} glint_atom;

typedef struct glint_symbol {
    const char *name; ///< the command without its backslash, or the sign itself
    const char *text; ///< what is drawn, UTF-8
    const char *plain; ///< drawn instead by a font that lacks it; NULL: `text`
    glint_atom atom;
    bool is_variable; ///< drawn slanted, as a letter
    bool is_large; ///< a large operator
} glint_symbol;

/// Returns whether the first `size` bytes of `name` are a known name.
bool glint_symbol_is(const char *known, const char *name, size_t size);
/// Returns the symbol of a command, or of a sign that is no letter or digit; NULL: none.
/// name  the first `size` bytes are the command without its backslash, or the sign.
const glint_symbol *glint_symbol_find(bool is_command, const char *name, size_t size);

#endif
