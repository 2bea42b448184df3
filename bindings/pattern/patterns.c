// Opens the module's functions for patterns, and registers them with the other values.
#include "bindings/pattern/pattern.h"

static const luaL_Reg METHODS[] = {
    { "unpack", glintL_unpack },
    { "dot", glintL_dot },
    { "cross", glintL_cross },
    { "length", glintL_length },
    { "unit", glintL_unit },
    { "reflect", glintL_reflect },
    { NULL, NULL },
};

const glintL_tracing glintL_patterns = {
    .place = glintL_traced_position,
    .is_source = glintL_is_source,
    .refuse = glintL_refuse_within_trace,
    .keep = glintL_keep_source,
    .keep_closed = glintL_keep_closed,
    .methods = METHODS,
    .map_array = glintL_map_array,
};

void glintL_open_patterns(lua_State *L)
{
    glintL_open_symbol(L);
    glintL_open_triple(L);
    glintL_open_operation(L);
    glintL_open_tiling(L);
    glintL_open_input(L);
    glintL_open_trace(L);
    glintL_open_texture(L);
    glintL_open_colormap(L);
    glintL_open_functions(L);
}
