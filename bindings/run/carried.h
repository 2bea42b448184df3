/// Reports are texts generated from data. C pushes the data as a Lua value, and a Lua module that is carried as bytes
/// (CARRIED in the Makefile) makes the text, in a separate state that scripts cannot affect. Private to bindings/.
#ifndef GLINT_L_CARRIED_H
#define GLINT_L_CARRIED_H

#include <stdio.h>

#include "bindings/run/run.h"

typedef struct glintL_carried {
    const char *name; ///< "@report.lua", for messages
    const unsigned char *text;
    size_t size;
} glintL_carried;

typedef struct glintL_made_text {
    lua_State *state; ///< owned; holds the text
    const char *text;
    size_t size;
} glintL_made_text;

/// Runs the modules in order. Each is called with the same table, which has json(value) and base64(bytes), and adds its
/// functions. Then calls the table's function `function` with the values pushed by `push` (it may raise), and stores
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
