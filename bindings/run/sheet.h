/// Contact sheets of finished frames, as a picture or as a page; sheet.lua makes them. Private to bindings/.
#ifndef GLINT_L_SHEET_H
#define GLINT_L_SHEET_H

#include "bindings/run/run.h"

// ---- sheet.c ----

/// Draws the sheet that the table on top describes (see sheet.lua), and pops it. Returns the exit code. The message says
/// what is wrong; with the exit code 0 it is a warning or empty. May raise.
int glintL_sheet_make(lua_State *L, char message[GLINTL_MESSAGE_SIZE]);

// ---- sweep_sheet.c ----

void glintL_list_sheet(lua_State *L); ///< lists its fields, see glintL_list_variant
/// Draws the sheet of the sweep at `index`, if it has one. Its frames are numbered from `first`. Waits until they are
/// written. partial: some frames were not selected, and missing files only give a warning. False: the run has failed.
bool glintL_sweep_make_sheet(lua_State *L, int index, const glintL_naming *naming, int64_t first, bool partial);

#endif
