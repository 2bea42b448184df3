// Warnings and notes of a run. Each warning is given once. --warnings=error ends the run with exit code 2 at the first
// warning.
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/run.h"

#define SAID_MAX 100 // warnings of one run

// Returns the part of a message that identifies it, without the frame at its beginning.
static const char *gist_of(const char *message)
{
    const size_t digits = strncmp(message, "frame ", 6) == 0 ? strspn(message + 6, "0123456789") : 0;
    return digits && message[6 + digits] == ':' ? message + 6 + digits : message;
}

// Returns whether a warning is new and among the first SAID_MAX. When memory is short it may be repeated.
static bool is_new(glintL_run *run, const char *message)
{
    message = gist_of(message);
    for (size_t i = 0; i < run->said_count; i++)
        if (strcmp(run->said[i], message) == 0)
            return false;
    if (run->said_count == SAID_MAX)
        return false;
    char *copy = strdup(message), **grown = realloc(run->said, (run->said_count + 1) * sizeof *grown);
    run->said = grown ? grown : run->said;
    if (copy && grown)
        grown[run->said_count++] = copy;
    else
        free(copy);
    return true;
}

void glintL_forget_warnings(glintL_run *run)
{
    for (size_t i = 0; i < run->said_count; i++)
        free(run->said[i]);
    free(run->said);
    run->said = NULL;
    run->said_count = 0;
}

static void say(const glintL_run *run, const char *message)
{
    if (run->reporter.warn) {
        run->reporter.warn(run->reporter.context, message);
    } else {
        fputs("glint: warning: ", stderr);
        glintL_put_text(stderr, message, strlen(message));
        fputc('\n', stderr);
    }
}

void glintL_run_warn(glintL_run *run, const char *format, ...)
{
    char message[GLINTL_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    if (run->request.warnings == GLINTL_WARNINGS_NONE || !is_new(run, message))
        return;
    if (run->request.warnings == GLINTL_WARNINGS_ERROR)
        glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "%.1000s (--warnings=error)", message);
    else
        say(run, message);
    if (run->said_count == SAID_MAX)
        say(run, "too many warnings; no more are shown");
}

void glintL_warn(lua_State *L, const char *message)
{
    glintL_push_position(L);
    glintL_run_warn(glintL_get_run(L), "%s%s", lua_tostring(L, -1), message);
    lua_pop(L, 1);
}

void glintL_warn_of_shutter(glintL_run *run)
{
    glintL_run_warn(
        run, "camera.shutter: nothing moves while it is open; move objects in the frame function of a glint.animation");
}

void glintL_run_note(const glintL_run *run, const char *format, ...)
{
    char message[GLINTL_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    if (run->request.warnings != GLINTL_WARNINGS_NONE)
        say(run, message);
}
