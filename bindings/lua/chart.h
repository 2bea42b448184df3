/// The series of a chart. Private to bindings/lua.
#ifndef GLINT_L_CHART_H
#define GLINT_L_CHART_H

#include "bindings/value/glintL.h"

/// Reads a list of series into glint_overlay_desc.chart; the list keeps the chart alive. In a constructor, whose table
/// is at 1, series without x take the chart's.
void glintL_chart_read(lua_State *L, int index, const char *path, void *desc);
void glintL_chart_push(lua_State *L, const void *desc);

#endif
