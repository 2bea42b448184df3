/// --untrusted: a script that is not trusted. Private to bindings/.
#ifndef GLINT_UNTRUSTED_H
#define GLINT_UNTRUSTED_H

#include "bindings/command/cli.h"

// ---- untrusted.c ----

/// Continues in a sandboxed child process. It has no files except the script and a folder for its pictures, no network,
/// no other processes, and limits of memory and time. True: this is the child. False: the child has ended (or could not
/// start, which was reported); *code is the exit code and *signal_number the signal that ended it, or 0. Call it before
/// there are threads. options owns options->request.folder, the folder; NULL: none.
bool cli_untrusted_begin(cli_options *options, cli_output *output, int *code, int *signal_number);

// ---- walls.c ----

#define CLI_UNTRUSTED_FILE ((uint64_t)1 << 30) ///< bytes of one file

/// Sandboxes this process: closes descriptors except 0 (empty), 1, 2 and `data`; blocks files except the script and
/// options->request.folder; limits system calls and memory. False: the message says why.
bool cli_untrusted_walls(const cli_options *options, int data, char *message);

// ---- untrusted_lua.c ----

/// Returns a Lua state whose allocations fail beyond memory->most. `memory` must outlive the state. NULL: out of
/// memory.
lua_State *cli_untrusted_state(cli_lua_memory *memory);
/// Gives the state a reduced Lua: no files, no modules except glint, no bytecode, no finalizers. May raise.
void cli_open_untrusted(lua_State *L, glintL_run *run);

#endif
