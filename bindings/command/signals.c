// SIGINT, SIGTERM and SIGHUP. The first signal stops the render within a tile and the script at its next instruction,
// so that no file is left half written. The second ends the process at once.
#include <signal.h>
#include <string.h>
#include <unistd.h>

#include "bindings/command/cli.h"

static glintL_run *volatile caught_run;
static lua_State *volatile caught_state;

static void raise_interrupted(lua_State *L, lua_Debug *where)
{
    (void)where; // the hook stays, so a script that catches the error gets it again
    luaL_error(L, "interrupted");
}

// Ends the process by the signal, when the handler returns.
static void leave(int number)
{
    glint_drafts_abandon();
    signal(number, SIG_DFL);
    raise(number);
}

static void handle(int number, void (*handler)(int), int flags)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = handler;
    action.sa_flags = flags;
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, NULL);
}

// Interrupts a system call that began after the signal, once a second.
static void nudge(int number)
{
    (void)number;
    alarm(1);
}

static void stop(int number)
{
    glintL_run *run = caught_run;
    lua_State *L = caught_state;
    if (!run || run->interrupted) {
        leave(number);
        return;
    }
    run->interrupted = number;
    handle(SIGALRM, nudge, 0);
    alarm(1);
    if (run->renderer)
        glint_renderer_cancel(run->renderer);
    if (L) // lua_sethook may be called in a signal handler
        lua_sethook(L, raise_interrupted, LUA_MASKCALL | LUA_MASKRET | LUA_MASKLINE | LUA_MASKCOUNT, 1);
}

static void ignore(int number) { (void)number; }

// Installs the handler. SIGHUP stays ignored if it was ignored before, as under nohup. The signals interrupt system calls:
// the script may wait for a pipe that nobody opens.
static void handle_all(void (*handler)(int))
{
    handle(SIGINT, handler, 0);
    handle(SIGTERM, handler, 0);
    if (signal(SIGHUP, SIG_DFL) == SIG_IGN)
        signal(SIGHUP, SIG_IGN);
    else
        handle(SIGHUP, handler, 0);
    // A failing write reports its error. The signals get handlers, because programs that the script starts would
    // inherit SIG_IGN.
    handle(SIGPIPE, ignore, SA_RESTART);
    handle(SIGXFSZ, ignore, SA_RESTART);
}

void cli_restart_calls(bool restarts)
{
    static const int numbers[] = { SIGINT, SIGTERM, SIGHUP, SIGALRM };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        struct sigaction action;
        sigaction(numbers[i], NULL, &action);
        action.sa_flags = restarts ? action.sa_flags | SA_RESTART : action.sa_flags & ~SA_RESTART;
        sigaction(numbers[i], &action, NULL);
    }
}

void cli_catch_signals(glintL_run *run)
{
    caught_run = run;
    handle_all(stop);
}

void cli_leave_by_signals(void) { handle_all(leave); }

void cli_release_signals(void)
{
    caught_run = NULL;
    caught_state = NULL;
}

void cli_set_state(lua_State *L)
{
    caught_state = L;
    if (L && caught_run && caught_run->interrupted)
        lua_sethook(L, raise_interrupted, LUA_MASKCOUNT, 1);
}
