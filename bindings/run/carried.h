/// Reports are texts made of data: C pushes the data as a Lua value, a Lua module that is carried as bytes (the Makefile's
/// CARRIED) makes the text of it, in a state of its own, where scripts have nothing to say. Private to bindings/.
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

/// Runs the modules in order, each called with one table that has json(value) and base64(bytes) and takes their functions;
/// then calls function `function` of that table with the values pushed by `push` (it may raise), and stores the string it
/// returns. False: `message` says why. To be dropped also on failure.
bool glintL_make_text(const glintL_carried *modules, size_t count, const char *function,
                      void (*push)(lua_State *L, const void *context), const void *context, glintL_made_text *out,
                      char message[GLINTL_MESSAGE_SIZE]);
void glintL_drop_text(glintL_made_text *text);
/// Writes a file that appears whole or not at all.
glint_status glintL_write_text(const char *path, const void *text, size_t size, glint_error *error);
/// Pushes on `to` a copy of the value at `index` of `from`, including tables and their contents; other objects become nil.
void glintL_copy_value(lua_State *from, int index, lua_State *to);
/// `out` has room for 4 bytes for each 3 of `size`, rounded up. Returns how many were written.
size_t glintL_base64(const uint8_t *from, size_t size, char *out);

/// Closes a stream that open_memstream made for `text`: the text, for the caller to free, or NULL without memory for all of
/// it. fclose alone says nothing then, and may leave no text.
char *glintL_close_text(FILE *out, char **text);

#endif
