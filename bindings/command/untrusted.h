/// --untrusted: a script that is not trusted. Private to bindings/.
#ifndef GLINT_UNTRUSTED_H
#define GLINT_UNTRUSTED_H

#include "bindings/command/cli.h"

// ---- untrusted.c ----

/// Goes on in a child process behind walls: it has no files but the script and a folder for its pictures, no network, no
/// other processes, and limits of memory and time. True: this is the child. False: the child has ended (or could not
/// begin, which is reported), *code is the exit code and *signal_number the signal that ended it, or 0.
/// To be called before there are threads. options->request.folder is the folder, owned by it; NULL: none.
bool cli_untrusted_begin(cli_options *options, cli_output *output, int *code, int *signal_number);

// ---- walls.c ----

#define CLI_UNTRUSTED_FILE ((uint64_t)1 << 30) ///< bytes of one file

/// Takes from this process what an untrusted script has no need of: descriptors but 0 (which reads nothing), 1, 2 and `data`,
/// files but the script and options->request.folder, calls, memory. False: the message says why.
bool cli_untrusted_walls(const cli_options *options, int data, char *message);

// ---- untrusted_lua.c ----

/// A state that fails for want of memory beyond memory->most, which outlives it. NULL: out of memory.
lua_State *cli_untrusted_state(cli_lua_memory *memory);
/// Gives the state the small Lua of such scripts: no files, no modules but glint, no bytecode, no finalizers. May raise.
void cli_open_untrusted(lua_State *L, glintL_run *run);

#endif
