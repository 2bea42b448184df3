// glint.read_image: a finished picture or a photo, as linear light.
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/lua/lua.h"

#define PICTURE "glint.picture"

typedef struct picture {
    int width, height;
    float *values; // three per pixel, top row first; a block owned by Lua: user value 1
} picture;

static const glintL_field FIELDS[] = { { .name = "width" }, { .name = "height" }, { .name = NULL } };

char *glintL_put_float(char *to, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++)
        *to++ = (char)(bits >> 8 * i & 0xff);
    return to;
}

static picture *check_self(lua_State *L)
{
    picture *self = luaL_testudata(L, 1, PICTURE);
    if (!self) {
        const char *got = glintL_push_spelling(L, 1);
        glintL_error(L, "picture expected, got %s%s", got, glintL_push_colon_cure(L, 1));
    }
    return self;
}

static int check_coordinate(lua_State *L, int index, const char *path, int count)
{
    const double x = glintL_read_number(L, index, path);
    if (!(x >= 0 && x < count && x == (int)x)) {
        const char *got = glintL_push_spelling(L, index);
        glintL_error(L, "%s: whole number 0 .. %d expected, got %s", path, count - 1, got);
    }
    return (int)x;
}

static int pixel(lua_State *L)
{
    const picture *self = check_self(L);
    const int x = check_coordinate(L, 2, "pixel.x", self->width), y = check_coordinate(L, 3, "pixel.y", self->height);
    const float *at = self->values + 3 * ((size_t)y * (size_t)self->width + (size_t)x);
    for (int c = 0; c < 3; c++)
        lua_pushnumber(L, (lua_Number)at[c]);
    return 3;
}

static int bytes(lua_State *L)
{
    luaL_Buffer out;
    const picture *self = check_self(L);
    const size_t count = 3 * (size_t)self->width * (size_t)self->height;
    lua_settop(L, 1);
    char *to = luaL_buffinitsize(L, &out, 4 * count);
    for (size_t i = 0; i < count; i++)
        to = glintL_put_float(to, self->values[i]);
    luaL_pushresultsize(&out, 4 * count);
    return 1;
}

// Returns all pixels as an array with a row for each, from the top left.
static int to_array(lua_State *L)
{
    const picture *self = check_self(L);
    glintL_array *out = glintL_push_array(L, (size_t)self->width * (size_t)self->height, 3, false);
    for (size_t i = 0; i < 3 * out->count; i++)
        out->numbers[i] = self->values[i];
    return 1;
}

static const luaL_Reg METHODS[] = { { "array", to_array }, { "bytes", bytes }, { "pixel", pixel }, { NULL, NULL } };

static int read_member(lua_State *L)
{
    const picture *self = check_self(L);
    if (lua_type(L, 2) != LUA_TSTRING)
        return glintL_bad_key(L, "picture", 2);
    const char *name = lua_tostring(L, 2), *near = glintL_nearest(name, FIELDS);
    for (const luaL_Reg *method = METHODS; method->name; method++) {
        near = glintL_nearer(name, near, method->name);
        if (strcmp(name, method->name) == 0) {
            lua_pushcfunction(L, method->func);
            return 1;
        }
    }
    if (!glintL_find_field(FIELDS, name))
        return glintL_no_such_field(L, "picture", name, near);
    lua_pushinteger(L, strcmp(name, "width") == 0 ? self->width : self->height);
    return 1;
}

static int write_member(lua_State *L)
{
    return glintL_error(L, "picture.%s: a picture is read-only", luaL_tolstring(L, 2, NULL));
}

typedef struct held { // owned by Lua, so that an error frees it
    glint_picture *file;
} held;

static int close_held(lua_State *L)
{
    held *h = lua_touserdata(L, 1);
    glint_picture_destroy(h->file);
    h->file = NULL;
    return 0;
}

static const char *check_path(lua_State *L)
{
    const glintL_run *run = glintL_get_run(L);
    size_t length;
    if (lua_type(L, 1) != LUA_TSTRING || lua_rawlen(L, 1) == 0)
        glintL_refuse(L, 1, "read_image", "name of a .png or .pfm");
    const char *path = lua_tolstring(L, 1, &length);
    if (strlen(path) != length)
        glintL_error(L, "read_image: file name without zero bytes expected");
    if (run->request.is_untrusted)
        glintL_error(L, "read_image: an untrusted script reads no files");
    if (run->reporter.reads)
        run->reporter.reads(run->reporter.context, path);
    return path;
}

static int read_image(lua_State *L)
{
    glint_error error;
    const char *path = check_path(L);
    held *h = lua_newuserdatauv(L, sizeof *h, 0);
    h->file = NULL;
    luaL_setmetatable(L, PICTURE ".held");
    glintL_check_status(L, "read_image", &error, glint_picture_read(path, true, &h->file, &error));
    picture *self = lua_newuserdatauv(L, sizeof *self, 1);
    *self = (picture) { glint_picture_width(h->file), glint_picture_height(h->file), NULL };
    const size_t row = 3 * (size_t)self->width;
    self->values = lua_newuserdatauv(L, row * (size_t)self->height * sizeof *self->values, 0);
    lua_setiuservalue(L, -2, 1);
    for (int y = 0; y < self->height; y++)
        glint_picture_light(h->file, y, self->values + (size_t)y * row);
    luaL_setmetatable(L, PICTURE);
    glint_picture_destroy(h->file);
    h->file = NULL;
    return 1;
}

void glintL_open_picture(lua_State *L)
{
    static const luaL_Reg meta[] = { { "__index", read_member }, { "__newindex", write_member }, { NULL, NULL } };
    static const glintL_variant variant = { .name = "picture", .fields = FIELDS };
    luaL_newmetatable(L, PICTURE ".held");
    glintL_set_function(L, "__gc", close_held);
    luaL_newmetatable(L, PICTURE);
    luaL_setfuncs(L, meta, 0);
    glintL_set_flag(L, "__metatable", false);
    lua_pop(L, 2);
    glintL_list_variant(L, &variant, METHODS);
    glintL_set_function(L, "read_image", read_image);
}
