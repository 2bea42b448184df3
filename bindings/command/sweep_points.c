// The values of --sweep, which sweep.lua lists, and its points. The script runs once for each point, and the frames are
// numbered consecutively.
#include <stdlib.h>
#include <string.h>

#include "bindings/command/cli.h"

static const unsigned char SWEEP_LUA[] = {
#include "bindings/command/sweep.lua.h"
};

int cli_read_number(lua_State *L)
{
    const char *text = lua_tostring(L, 1);
    char *end = NULL;
    const double value = text ? strtod(text, &end) : 0;
    if (!text || end == text || *end)
        return 0;
    lua_pushnumber(L, value);
    return 1;
}

static int power(lua_State *L)
{
    lua_pushnumber(L, glint_pow(luaL_checknumber(L, 1), luaL_checknumber(L, 2)));
    return 1;
}

static void push_sweep(lua_State *L, const void *text)
{
    lua_newtable(L);
    glintL_set_text(L, "text", text);
    glintL_set_function(L, "number", cli_read_number);
    glintL_set_function(L, "power", power);
}

// Takes `size` bytes of values, each with a zero byte after it. False: out of memory.
static bool take_values(cli_sweep *sweep, const char *values, size_t size)
{
    for (size_t i = 0; i < size; i++)
        sweep->count += values[i] == '\0';
    sweep->values = malloc((size_t)sweep->count * sizeof *sweep->values);
    sweep->texts = malloc(size);
    if (!sweep->values || !sweep->texts)
        return false;
    char *at = memcpy(sweep->texts, values, size);
    for (int64_t i = 0; i < sweep->count; i++, at += strlen(at) + 1)
        sweep->values[i] = at;
    return true;
}

bool cli_read_sweep(char *text, cli_sweep *sweep, char message[GLINTL_MESSAGE_SIZE])
{
    static const glintL_carried module = { "@sweep.lua", SWEEP_LUA, sizeof SWEEP_LUA };
    glintL_made_text made;
    *sweep = (cli_sweep) { .name = text };
    bool good = glintL_make_text(&module, 1, "values", push_sweep, text, &made, message);
    if (good && !take_values(sweep, made.text, made.size))
        good = glintL_complain(message, "out of memory");
    glintL_drop_text(&made);
    if (good)
        *strchr(text, '=') = '\0'; // ends the name
    return good;
}

int64_t cli_sweep_points(const cli_options *options)
{
    int64_t points = options->sweep_count ? 1 : 0;
    for (size_t i = 0; i < options->sweep_count && points <= GLINTL_FRAMES_MAX; i++)
        points *= options->sweeps[i].count;
    return points;
}

void cli_sweep_to(cli_options *options, glintL_run *run, int64_t point)
{
    int64_t rest = point - 1;
    size_t first_set = run->request.set_count - options->sweep_count; // the sets of --sweep come last
    for (size_t i = 0; i < options->sweep_count; i++) {
        const cli_sweep *sweep = &options->sweeps[i];
        run->request.sets[first_set + i] =
            (glintL_set) { sweep->name, sweep->values[rest % sweep->count], sweep->values, sweep->count, false };
        rest /= sweep->count;
    }
}

void cli_spell_point(const cli_options *options, int64_t point, char *out, size_t size)
{
    int64_t rest = point - 1;
    size_t used = 0;
    *out = '\0';
    for (size_t i = 0; i < options->sweep_count && used < size; i++) {
        const cli_sweep *sweep = &options->sweeps[i];
        used += (size_t)snprintf(out + used, size - used, "%s%s=%s", used ? " " : "", sweep->name,
                                 sweep->values[rest % sweep->count]);
        rest /= sweep->count;
    }
}

void cli_free_sweep(cli_sweep *sweep)
{
    free(sweep->values);
    free(sweep->texts);
}
