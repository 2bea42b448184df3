/// Shared by array.c and array_math.c. Internal.
#ifndef GLINT_L_ARRAY_H
#define GLINT_L_ARRAY_H

#include "bindings/value/glintL.h"

#define WIDTH_MAX 64 ///< numbers of a row

/// Returns the array at 1; raises if it is none.
glintL_array *glintL_check_array(lua_State *L);
/// Pushes number i of all numbers.
void glintL_push_element(lua_State *L, const glintL_array *a, size_t i);

static inline double number_at(const glintL_array *a, size_t i)
{
    return a->is_whole ? (double)a->wholes[i] : a->numbers[i];
}

// ---- array_math.c: metamethods and methods ----

int glintL_array_add(lua_State *L);
int glintL_array_subtract(lua_State *L);
int glintL_array_multiply(lua_State *L);
int glintL_array_divide(lua_State *L);
int glintL_array_negate(lua_State *L);
int glintL_array_floor(lua_State *L);
int glintL_array_bins(lua_State *L);
int glintL_array_counts(lua_State *L);
int glintL_array_min(lua_State *L);
int glintL_array_max(lua_State *L);
int glintL_array_sum(lua_State *L);
int glintL_array_mean(lua_State *L);

#endif
