// The rows of an object's table of fields as Lua values, for tests and for the documentation generated from them.
#include <stdint.h>

#include "bindings/value/glintL.h"

void glintL_push_default(lua_State *L, const glintL_field *field)
{
    glintL_field plain = *field;
    union {
        double numbers[3];
        int choice;
        bool flag;
        char text[GLINT_NAME_SIZE];
    } value = { .text = "" };
    for (int c = 0; c < 3; c++)
        value.numbers[c] = field->initial[c];
    if (field->type == GLINT_TYPE_CHOICE)
        value.choice = (int)field->initial[0];
    if (field->type == GLINT_TYPE_FLAG)
        value.flag = field->initial[0] != 0;
    plain.offset = plain.set_offset = 0;
    if (field->type <= GLINT_TYPE_TEXT)
        glintL_push_field(L, &plain, &value);
    else
        lua_pushnil(L);
}

static void push_rows(lua_State *L, const glintL_field *fields);

static void push_row(lua_State *L, const glintL_field *field)
{
    // The editors' type for each glint_field_type; "" for choices, whose names are listed instead.
    static const char *const types[] = { "number", "integer", "number", "boolean", "glint.vec3", "glint.vec3", "glint.color", "", "string",
                                         "", "glint.vec3[]", "number|glint.vec3", "glint.transform", "number[][]", "", "table",
                                         "any", "any" };
    static const char *const takers[] = { "glint.pattern", "glint.texture", "glint.shader" };
    luaL_Buffer type;
    luaL_buffinit(L, &type);
    luaL_addstring(&type, field->type == GLINT_TYPE_OBJECT ? field->names[0] : types[field->type]);
    for (size_t i = 0; field->type == GLINT_TYPE_CHOICE && field->names[i]; i++) {
        luaL_addstring(&type, i ? "|\"" : "\"");
        luaL_addstring(&type, field->names[i]);
        luaL_addchar(&type, '"');
    }
    for (size_t i = 0; i < sizeof takers / sizeof *takers; i++) {
        if (!(field->takes >> i & 1))
            continue;
        luaL_addstring(&type, luaL_bufflen(&type) ? "|" : "");
        luaL_addstring(&type, takers[i]);
    }
    luaL_pushresult(&type);
    lua_createtable(L, 0, 9);
    lua_insert(L, -2);
    lua_setfield(L, -2, "type");
    glintL_set_text(L, "name", field->name);
    glintL_set_text(L, "doc", field->doc);
    glintL_set_text(L, "unit", field->unit);
    glintL_set_text(L, "follows", field->follows);
    glintL_set_flag(L, "required", field->required);
    glintL_set_flag(L, "takes_variable", (field->takes & GLINT_TAKES_VARIABLE) != 0);
    glintL_push_default(L, field);
    lua_setfield(L, -2, "default");
    if (field->type == GLINT_TYPE_TABLE)
        push_rows(L, field->parts);
    else
        lua_pushnil(L);
    lua_setfield(L, -2, "parts");
}

static void push_rows(lua_State *L, const glintL_field *fields)
{
    luaL_checkstack(L, 8, "rows");
    lua_newtable(L);
    for (lua_Integer i = 0; fields && fields[i].name; i++) {
        push_row(L, &fields[i]);
        lua_rawseti(L, -2, i + 1);
    }
}

int glintL_list_rows(lua_State *L)
{
    const glintL_variant *variant = glintL_find_variant(L, luaL_checkstring(L, 1));
    push_rows(L, variant ? glintL_fields_of(variant) : NULL);
    return 1;
}
