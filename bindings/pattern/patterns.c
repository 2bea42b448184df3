// Opens the module's functions for patterns.
#include "bindings/pattern/pattern.h"

void glintL_open_patterns(lua_State *L)
{
    glintL_open_symbol(L);
    glintL_open_triple(L);
    glintL_open_operation(L);
    glintL_open_tiling(L);
    glintL_open_input(L);
    glintL_open_trace(L);
    glintL_open_colormap(L);
    glintL_open_functions(L);
}
