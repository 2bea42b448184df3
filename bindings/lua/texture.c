// glint.texture: a picture, called with u and v inside a pattern, or assigned directly to a field.
#include "bindings/lua/lua.h"

#include <string.h>

typedef struct arguments {
    char file[4096];
    glint_texture_desc desc;
    unsigned transfer;
} arguments;

#define AT(member) offsetof(arguments, member)

static const char *const WRAPS[] = { "repeat", "clamp", "around", NULL };
static const char *const FILTERS[] = { "bilinear", "nearest", NULL };
static const char *const TRANSFERS[] = { "srgb", "linear", NULL };

static const glintL_field FIELDS[] = {
    { .name = "file", .type = GLINT_TYPE_OTHER },
    { .name = "wrap", .type = GLINT_TYPE_CHOICE, .offset = AT(desc.wrap), .names = WRAPS },
    { .name = "filter", .type = GLINT_TYPE_CHOICE, .offset = AT(desc.filter), .names = FILTERS },
    { .name = "transfer", .type = GLINT_TYPE_CHOICE, .offset = AT(transfer), .names = TRANSFERS },
    { .name = NULL },
};

static const glintL_field SIZES[] = { { .name = "width" }, { .name = "height" }, { .name = NULL } };

static void read_file(lua_State *L, char out[4096])
{
    size_t length;
    lua_pushliteral(L, "file");
    if (lua_rawget(L, 1) != LUA_TSTRING || lua_rawlen(L, -1) == 0)
        glintL_refuse(L, -1, "texture.file", "name of a PNG file");
    const char *file = lua_tolstring(L, -1, &length);
    if (length >= 4096 || memchr(file, '\0', length))
        glintL_error(L, "texture.file: a shorter file name without zero bytes expected");
    memcpy(out, file, length + 1);
    lua_pop(L, 1);
    const glintL_run *run = glintL_get_run(L);
    if (run->request.is_untrusted) // the answers would tell an untrusted script which files exist
        glintL_error(L, "texture.file: an untrusted script reads no files");
    file = glintL_push_file(L, out);
    snprintf(out, 4096, "%s", file);
    lua_pop(L, 1);
    if (run->reporter.reads)
        run->reporter.reads(run->reporter.context, out);
}

// Stores the texture's fields for reading in a table, its user value 1.
static void keep_fields(lua_State *L, const arguments *a, const glint_texture *texture)
{
    lua_createtable(L, 0, 6);
    glintL_set_text(L, "file", a->file);
    for (const glintL_field *f = FIELDS + 1; f->name; f++) {
        glintL_push_field(L, f, a);
        lua_setfield(L, -2, f->name);
    }
    glintL_set_whole(L, "width", glint_texture_width(texture));
    glintL_set_whole(L, "height", glint_texture_height(texture));
    lua_setiuservalue(L, -2, 1);
}

static int new_texture(lua_State *L)
{
    arguments a = { .desc = glint_texture_desc_default() };
    glint_error error;
    lua_settop(L, 1);
    glintL_read_table(L, 1, "texture", FIELDS, &a, false);
    read_file(L, a.file);
    a.desc.linear = a.transfer == 1;
    glintL_pattern *pattern = glintL_push_pattern(L, GLINT_PROGRAM_PATTERN, GLINTL_TEXTURE);
    glintL_check_status(L, "", &error, glint_texture_read(a.file, &a.desc, &pattern->texture, &error));
    keep_fields(L, &a, pattern->texture);
    glintL_charge(L,
                  (size_t)glint_texture_width(pattern->texture) * (size_t)glint_texture_height(pattern->texture) * 8);
    return 1;
}

static int close_texture(lua_State *L)
{
    glintL_pattern *pattern = lua_touserdata(L, 1);
    glint_texture_release(pattern->texture);
    pattern->texture = NULL;
    return 0;
}

// ---- photo(u, v, footprint) ----

static int look_up(lua_State *L)
{
    const glintL_pattern *pattern = lua_touserdata(L, 1);
    glintL_operand uv;
    glintL_term in[4] = { [2] = glintL_number_term(0) }, out[4];
    glintL_read_operand(L, 2, "texture: u", &uv);
    int next = 3;
    in[0] = uv.at[0];
    in[1] = uv.at[1];
    if (!uv.is_vector)
        in[1] = glintL_read_term(L, next++, "texture: v");
    if (!lua_isnoneornil(L, next))
        in[2] = glintL_read_term(L, next, "texture: footprint");
    in[3] = lua_isnoneornil(L, next + 1) ? in[2] : glintL_read_term(L, next + 1, "texture: footprint along v");
    if (lua_gettop(L) > next + 1)
        return glintL_error(L, "texture: expected u, v and one or two footprints, or s.uv and footprints, got more");
    glintL_apply_texture(L, pattern->texture, in, out);
    glintL_push_color(L, out);
    return 1;
}

static int read_member(lua_State *L)
{
    const char *near = NULL;
    if (lua_type(L, 2) != LUA_TSTRING)
        return glintL_bad_key(L, "texture", 2);
    const char *name = lua_tostring(L, 2);
    if (strcmp(name, "evaluate") == 0) {
        lua_pushcfunction(L, glintL_pattern_evaluate);
        return 1;
    }
    lua_getiuservalue(L, 1, 1);
    lua_pushvalue(L, 2);
    if (lua_rawget(L, -2) != LUA_TNIL)
        return 1;
    near = glintL_nearer(name, glintL_nearest(name, FIELDS), "width");
    return glintL_no_such_field(L, "texture", name, glintL_nearer(name, near, "height"));
}

static int write_member(lua_State *L)
{
    return glintL_error(L, "texture.%s: a texture cannot be changed; make another one", luaL_tolstring(L, 2, NULL));
}

static int to_string(lua_State *L)
{
    const glintL_pattern *pattern = lua_touserdata(L, 1);
    lua_getiuservalue(L, 1, 1);
    lua_getfield(L, -1, "file");
    lua_pushfstring(L, "texture '%s', %d x %d", lua_tostring(L, -1), glint_texture_width(pattern->texture),
                    glint_texture_height(pattern->texture));
    return 1;
}

void glintL_open_texture(lua_State *L)
{
    static const luaL_Reg meta[] = {
        { "__index", read_member },  { "__newindex", write_member }, { "__call", look_up },
        { "__tostring", to_string }, { "__gc", close_texture },      { NULL, NULL },
    };
    static const luaL_Reg methods[] = { { "evaluate", glintL_pattern_evaluate }, { NULL, NULL } };
    glintL_field fields[sizeof FIELDS / sizeof *FIELDS + 2];
    const glintL_variant variant = { .name = "texture", .fields = fields };
    const size_t own = sizeof FIELDS / sizeof *FIELDS - 1;
    memcpy(fields, FIELDS, own * sizeof *fields);
    memcpy(fields + own, SIZES, sizeof SIZES);
    glintL_new_type(L, GLINTL_TEXTURE, meta);
    glintL_list_variant(L, &variant, methods);
    glintL_set_function(L, "texture", new_texture);
}
