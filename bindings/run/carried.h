/// Lua modules that the command and the module carry as bytes (modules.h in the Makefile). Private to bindings/.
///
/// The modules of bindings/run work on a script's objects, in the script's state. They see copies of Lua's functions as
/// these were when glint was opened, and no script can reach them. They call no methods of strings, which a script can
/// change, and have no line numbers: an error names the line of the script. The other modules generate texts from data,
/// each in a state of its own.
#ifndef GLINT_L_CARRIED_H
#define GLINT_L_CARRIED_H

#include <stdio.h>

#include "bindings/run/run.h"

typedef struct glintL_carried {
    const char *name; ///< for messages
    const unsigned char *text;
    size_t size;
} glintL_carried;

// ---- own.c: the modules of bindings/run ----

/// Retains Lua's functions for the modules in this state.
void glintL_open_own(lua_State *L);
/// Calls a function of a module, like lua_call: the arguments are on top of the stack. A module is loaded when it is
/// first used.
void glintL_call_own(lua_State *L, const char *module, const char *function, int arguments, int results);
/// Sets the field `function` of the table on top to a function of the module.
void glintL_set_own_function(lua_State *L, const char *module, const char *function);
/// Adds C functions for the modules.
void glintL_add_own(lua_State *L, const luaL_Reg *functions);
extern const luaL_Reg glintL_sheet_functions[], glintL_sweep_functions[];

// ---- carried.c ----

extern const luaL_Reg glintL_carried_functions[]; ///< for all modules

typedef struct glintL_made_text {
    lua_State *state; ///< owned; holds the text
    const char *text;
    size_t size;
} glintL_made_text;

/// Pushes a module's function without line numbers, so that errors and warnings name the nearest line of the script.
void glintL_load_stripped(lua_State *L, const glintL_carried *module);

/// Runs the modules in order. Each is called with the same table, which has json(value), base64(bytes) and nearer(name,
/// near, candidate), and adds its functions. Then calls the table's function `function` with the values pushed by `push` (it may raise), and stores
/// the returned string. False: `message` says why. The caller drops the text, on failure too.
bool glintL_make_text(const glintL_carried *modules, size_t count, const char *function,
                      void (*push)(lua_State *L, const void *context), const void *context, glintL_made_text *out,
                      char message[GLINTL_MESSAGE_SIZE]);
void glintL_drop_text(glintL_made_text *text);
/// Writes a file that appears whole or not at all.
glint_status glintL_write_text(const char *path, const void *text, size_t size, glint_error *error);
/// Pushes on `to` a copy of the value at `index` of `from`, including tables and their contents; other objects become
/// nil.
void glintL_copy_value(lua_State *from, int index, lua_State *to);
/// Pushes an engine object that the Lua value owns; NULL at first. `drop` frees the object of the value that is its first
/// argument.
void *glintL_push_owner(lua_State *L, size_t size, const char *type, lua_CFunction drop);
/// Writes base64 to `out`, which needs 4 bytes for every 3 of `size`, rounded up. Returns how many were written.
size_t glintL_base64(const uint8_t *from, size_t size, char *out);

/// Closes a stream that open_memstream made for `text`. Returns the text, which the caller frees, or NULL if memory was
/// short. fclose alone does not report this, and may leave no text.
char *glintL_close_text(FILE *out, char **text);

#endif
