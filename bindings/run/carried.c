// Runs the Lua modules that the command and the module carry as bytes.
#include <lualib.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/carried.h"

// ---- Functions for the modules ----

size_t glintL_base64(const uint8_t *from, size_t size, char *out)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t used = 0;
    for (size_t i = 0; i < size; i += 3) {
        size_t rest = size - i;
        unsigned bits =
            (unsigned)from[i] << 16 | (rest > 1 ? (unsigned)from[i + 1] << 8 : 0) | (rest > 2 ? from[i + 2] : 0);
        for (size_t k = 0; k < 4; k++)
            out[used++] = (char)(k <= rest ? digits[bits >> (18 - 6 * k) & 63] : '=');
    }
    return used;
}

static int base64(lua_State *L)
{
    size_t size;
    luaL_Buffer buffer;
    const char *bytes = luaL_checklstring(L, 1, &size);
    char *out = luaL_buffinitsize(L, &buffer, size / 3 * 4 + 4);
    luaL_pushresultsize(&buffer, glintL_base64((const uint8_t *)bytes, size, out));
    return 1;
}

char *glintL_close_text(FILE *out, char **text)
{
    const bool is_written = fflush(out) == 0 && !ferror(out);
    if (fclose(out) == 0 && is_written && *text)
        return *text;
    free(*text);
    return NULL;
}

// json(value): returns a number, boolean, nil or string as JSON.
static int json(lua_State *L)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (out && lua_isinteger(L, 1))
        fprintf(out, LUA_INTEGER_FMT, lua_tointeger(L, 1));
    else if (out && lua_type(L, 1) == LUA_TNUMBER)
        glintL_json_number(out, lua_tonumber(L, 1));
    else if (out && lua_type(L, 1) == LUA_TSTRING)
        glintL_json_string(out, lua_tostring(L, 1));
    else if (out)
        fputs(lua_isnil(L, 1) ? "null" : lua_toboolean(L, 1) ? "true" : "false", out);
    if (!out || !glintL_close_text(out, &text))
        return luaL_error(L, "out of memory");
    char *spelling = lua_newuserdatauv(L, size + 1, 0); // allocated by Lua, so that an error frees it
    memcpy(spelling, text, size + 1);
    free(text);
    lua_pushlstring(L, spelling, size);
    return 1;
}

// nearer(name, near, candidate): returns the one closer to the misspelt name; nil if neither is close.
static int nearer(lua_State *L)
{
    lua_pushstring(L, glintL_nearer(luaL_checkstring(L, 1), lua_tostring(L, 2), luaL_checkstring(L, 3)));
    return 1;
}

const luaL_Reg glintL_carried_functions[] = {
    { "base64", base64 }, { "json", json }, { "nearer", nearer }, { NULL, NULL },
};

// ---- Loading ----

typedef struct code_buffer {
    luaL_Buffer buffer;
    bool begun; // luaL_buffinit was called: at the first write, as lua_dump needs the function on top until then
} code_buffer;

static int add_code(lua_State *L, const void *bytes, size_t size, void *context)
{
    code_buffer *code = context;
    if (!code->begun)
        luaL_buffinit(L, &code->buffer);
    code->begun = true;
    luaL_addlstring(&code->buffer, bytes, size);
    return 0;
}

void glintL_load_stripped(lua_State *L, const glintL_carried *module)
{
    code_buffer code = { .begun = false };
    size_t size;
    if (luaL_loadbufferx(L, (const char *)module->text, module->size, module->name, "t") != LUA_OK)
        lua_error(L);
    if (lua_dump(L, add_code, &code, true))
        luaL_error(L, "out of memory");
    luaL_pushresult(&code.buffer);
    const char *bytes = lua_tolstring(L, -1, &size);
    if (luaL_loadbufferx(L, bytes, size, "=glint", "b") != LUA_OK)
        lua_error(L);
    lua_replace(L, -3);
    lua_pop(L, 1);
}

// ---- Modules in a state of their own ----

typedef struct task {
    const glintL_carried *modules;
    size_t count;
    const char *function;
    void (*push)(lua_State *L, const void *context);
    const void *context;
} task;

static int run_modules(lua_State *L)
{
    const task *what = lua_touserdata(L, 1);
    luaL_openlibs(L);
    lua_newtable(L);
    luaL_setfuncs(L, glintL_carried_functions, 0);
    for (size_t i = 0; i < what->count; i++) {
        const glintL_carried *module = &what->modules[i];
        if (luaL_loadbufferx(L, (const char *)module->text, module->size, module->name, "t") != LUA_OK)
            return lua_error(L);
        lua_pushvalue(L, -2);
        lua_call(L, 1, 0);
    }
    lua_getfield(L, -1, what->function);
    what->push(L, what->context);
    lua_call(L, 1, 1);
    return 1;
}

bool glintL_make_text(const glintL_carried *modules, size_t count, const char *function,
                      void (*push)(lua_State *L, const void *context), const void *context, glintL_made_text *out,
                      char message[GLINTL_MESSAGE_SIZE])
{
    task what = { modules, count, function, push, context };
    *out = (glintL_made_text) { .state = luaL_newstate() };
    snprintf(message, GLINTL_MESSAGE_SIZE, "out of memory");
    if (!out->state)
        return false;
    lua_pushcfunction(out->state, run_modules);
    lua_pushlightuserdata(out->state, &what);
    const int status = lua_pcall(out->state, 1, 1, 0);
    out->text = lua_tolstring(out->state, -1, &out->size);
    if (status != LUA_OK && status != LUA_ERRMEM)
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s", out->text ? out->text : function);
    return status == LUA_OK;
}

void glintL_drop_text(glintL_made_text *text)
{
    if (text->state)
        lua_close(text->state);
    *text = (glintL_made_text) { .state = NULL };
}

glint_status glintL_write_text(const char *path, const void *text, size_t size, glint_error *error)
{
    glint_draft *draft = NULL;
    glint_status status = glint_draft_create(path, &draft, error);
    if (!status)
        status = glint_draft_append(draft, text, size, error);
    if (!status)
        status = glint_draft_finish(draft, error);
    glint_draft_destroy(draft);
    return status;
}

void *glintL_push_owner(lua_State *L, size_t size, const char *type, lua_CFunction drop)
{
    void *owner = lua_newuserdatauv(L, size, 0);
    memset(owner, 0, size);
    if (luaL_newmetatable(L, type)) {
        glintL_set_function(L, "__gc", drop);
        glintL_set_function(L, "__close", drop);
    }
    lua_setmetatable(L, -2);
    return owner;
}

void glintL_copy_value(lua_State *from, int index, lua_State *to)
{
    size_t size = 0;
    const char *text;
    index = lua_absindex(from, index);
    luaL_checkstack(from, 4, "copy");
    luaL_checkstack(to, 4, "copy");
    switch (lua_type(from, index)) {
    case LUA_TBOOLEAN:
        lua_pushboolean(to, lua_toboolean(from, index));
        break;
    case LUA_TNUMBER:
        if (lua_isinteger(from, index))
            lua_pushinteger(to, lua_tointeger(from, index));
        else
            lua_pushnumber(to, lua_tonumber(from, index));
        break;
    case LUA_TSTRING:
        text = lua_tolstring(from, index, &size);
        lua_pushlstring(to, text, size);
        break;
    case LUA_TTABLE:
        lua_newtable(to);
        for (lua_pushnil(from); lua_next(from, index); lua_pop(from, 1)) {
            glintL_copy_value(from, -2, to);
            glintL_copy_value(from, -1, to);
            lua_rawset(to, -3);
        }
        break;
    default:
        lua_pushnil(to);
    }
}
