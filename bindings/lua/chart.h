/// The series of a chart. Private to bindings/lua.
#ifndef GLINT_L_CHART_H
#define GLINT_L_CHART_H

#include "bindings/value/glintL.h"

/// Reads a list of series into glint_overlay_desc.chart; the list keeps the chart alive. In a constructor, whose table
/// is at 1, series without x and label take the chart's x and labels.
void glintL_chart_read(lua_State *L, int index, const char *path, void *desc);
void glintL_chart_push(lua_State *L, const void *desc);
/// Reads the y of a chart with a single curve, in a constructor.
void glintL_chart_read_y(lua_State *L, int index, const char *path, void *desc);
/// Pushes the method chart:save.
int glintL_chart_push_save(lua_State *L);

#endif
