/// Pairs of atoms by their distance. Internal.
#ifndef GLINT_DATA_BONDS_H
#define GLINT_DATA_BONDS_H

#include "engine/glint.h"
#include "engine/glint_data.h"

/// Called for a bond of atoms a and b, with the vector from b to a, or from b to the nearest image of a.
typedef void glint_bond_found(void *context, size_t a, size_t b, const double step[3]);

/// Calls `found` (NULL: nothing) for each bond and writes their number. The order depends only on the positions. The
/// arrays of `desc` have been checked. GLINT_ERR_INVALID: a periodic side is too short, or there are too many bonds.
glint_status glint_find_bonds(const glint_bonds_desc *desc, size_t *count, glint_bond_found *found, void *context,
                              glint_error *error);

#endif
