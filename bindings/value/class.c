// Classes: reading and writing the fields of boxes, and their metatables.
#include <stdint.h>
#include <string.h>

#include "bindings/value/glintL.h"

typedef union description { // description of any object
    max_align_t align;
    char bytes[GLINTL_DESC_SIZE];
} description;

// ---- Fields ----

// Returns the class, the first upvalue of each metamethod. 1: the object.
static const glintL_class *this_class(lua_State *L) { return lua_touserdata(L, lua_upvalueindex(1)); }

static const luaL_Reg *find_function(const luaL_Reg *functions, const char *name)
{
    for (; functions && functions->name; functions++)
        if (strcmp(functions->name, name) == 0)
            return functions;
    return NULL;
}

// Returns which component of the variant's place "x", "y" or "z" is, or -1.
static int component(const glintL_variant *variant, const char *name)
{
    return variant->place && name[0] >= 'x' && name[0] <= 'z' && !name[1] ? name[0] - 'x' : -1;
}

static const char *field_name(lua_State *L, const glintL_variant *variant)
{
    if (lua_type(L, 2) != LUA_TSTRING)
        glintL_bad_key(L, variant->name, 2);
    return lua_tostring(L, 2);
}

static int unknown_field(lua_State *L, const glintL_class *class, const glintL_variant *variant, const char *name)
{
    const char *near = glintL_nearest(name, glintL_fields_of(variant));
    for (const luaL_Reg *f = variant->getters; f && f->name; f++)
        near = glintL_nearer(name, near, f->name);
    for (const luaL_Reg *f = variant->methods; f && f->name; f++)
        near = glintL_nearer(name, near, f->name);
    for (const luaL_Reg *f = class->methods; f && f->name; f++)
        near = glintL_nearer(name, near, f->name);
    return glintL_no_such_field(L, variant->name, name, glintL_nearer(name, glintL_nearer(name, near, "kind"), "close"));
}

// Makes a new userdata if the object has none any more, before reading the object's pointer again: making it may run a
// finalizer of the script, which may close the owner.
static void push_object_field(lua_State *L, const glintL_class *class, const glintL_field *field, description *desc)
{
    void *object;
    lua_pop(L, 1);
    glintL_box *box = glintL_new_box(L, field->names[0]);
    class->get(glintL_check_object(L, 1, class->type), desc);
    memcpy(&object, desc->bytes + field->offset, sizeof object);
    if (object) {
        box->object = glintL_class_of(L, field->names[0])->retain(object);
        glintL_remember(L, object);
    } else {
        lua_pop(L, 1);
        lua_pushnil(L);
    }
}

static void push_value(lua_State *L, const glintL_class *class, const glintL_field *field, const void *object)
{
    description desc;
    class->get(object, &desc);
    if (class->follow)
        class->follow(&desc);
    glintL_push_field(L, field, &desc);
    if (field->type == GLINT_TYPE_OBJECT && lua_isnil(L, -1))
        push_object_field(L, class, field, &desc);
}

// Pushes the pattern that replaces a field's value.
static bool push_source(lua_State *L, const glintL_class *class, const glintL_field *field, const void *object)
{
    description desc;
    if (field->program_offset && glintL_push_kept(L, 1, field->name))
        return true;
    if (!field->follows)
        return false;
    class->get(object, &desc);
    return !desc.bytes[field->set_offset] && glintL_push_kept(L, 1, field->follows);
}

static int close_object(lua_State *L);

static int read_member(lua_State *L)
{
    const glintL_class *class = this_class(L);
    const luaL_Reg *function;
    if (lua_type(L, 2) == LUA_TSTRING) { // methods first, so that a closed object can be closed again
        const char *name = lua_tostring(L, 2);
        if (strcmp(name, "close") == 0) {
            lua_pushvalue(L, lua_upvalueindex(2));
            return 1;
        }
        function = find_function(class->methods, name);
        if (function) {
            lua_pushcfunction(L, function->func);
            return 1;
        }
    }
    const void *object = glintL_check_object(L, 1, class->type);
    if (lua_isinteger(L, 2) && class->count && class->count(object) >= 0)
        return glintL_push_numbered(L, class, object, lua_tointeger(L, 2));
    const glintL_variant *variant = class->variant(object);
    const char *name = field_name(L, variant);
    const glintL_field *field = glintL_find_field(glintL_fields_of(variant), name);
    function = find_function(variant->methods, name);
    if (function) {
        lua_pushcfunction(L, function->func);
        return 1;
    }
    int part = component(variant, name);
    if (field && (push_source(L, class, field, object) || glintL_push_sloped(L, 1, field))) {
        return 1;
    } else if (field) {
        push_value(L, class, field, object);
    } else if (part >= 0 && glintL_push_sloped(L, 1, glintL_find_field(glintL_fields_of(variant), variant->place))) {
        lua_rawgeti(L, -1, part + 1);
    } else if (part >= 0) {
        push_value(L, class, glintL_find_field(glintL_fields_of(variant), variant->place), object);
        lua_pushnumber(L, glintL_to_vector(L, -1)[part]);
    } else if (strcmp(name, "kind") == 0) {
        lua_pushstring(L, variant->name);
    } else if ((function = find_function(variant->getters, name)) != NULL) {
        lua_settop(L, 1);
        return function->func(L);
    } else {
        return unknown_field(L, class, variant, name);
    }
    return 1;
}

// Reads argument 3 into one component of the place.
static void read_component(lua_State *L, const glintL_variant *variant, int part, description *desc)
{
    static const char *const names[] = { "x", "y", "z" };
    const glintL_field *place = glintL_find_field(glintL_fields_of(variant), variant->place);
    const glintL_field field = { .name = names[part], .type = GLINT_TYPE_NUMBER, .takes = place->takes };
    double value;
    glintL_read_field(L, 3, variant->name, &field, &value);
    memcpy(desc->bytes + place->offset + (size_t)part * sizeof value, &value, sizeof value);
}

static const glintL_field *writable_field(lua_State *L, const glintL_class *class, const glintL_variant *variant,
                                          const char *name)
{
    const glintL_field *field = glintL_find_field(glintL_fields_of(variant), name);
    if (field)
        return field;
    if (find_function(variant->getters, name) || strcmp(name, "kind") == 0)
        glintL_error(L, "%s.%s: this field is read-only", variant->name, name);
    if (strcmp(name, "close") == 0 || find_function(class->methods, name) || find_function(variant->methods, name))
        glintL_error(L, "%s.%s: a method cannot be assigned", variant->name, name);
    unknown_field(L, class, variant, name);
    return NULL;
}

// Reads a table into a copy of the description. Reading allocates, which may run a finalizer of the script that changes
// or closes the object, so the description is fetched again before the value is stored.
static void *read_nested(lua_State *L, const glintL_class *class, const glintL_field *field, description *desc)
{
    description fields = *desc;
    glintL_read_field(L, 3, class->variant(glintL_check_object(L, 1, class->type))->name, field, &fields);
    void *object = glintL_check_object(L, 1, class->type);
    class->get(object, desc);
    for (const glintL_field *f = field->parts; f->name; f++) {
        memcpy(desc->bytes + f->offset, fields.bytes + f->offset, (f->type == GLINT_TYPE_COLOR ? 3 : 1) * sizeof(double));
        if (f->set_offset)
            desc->bytes[f->set_offset] = fields.bytes[f->set_offset];
    }
    desc->bytes[field->set_offset] = fields.bytes[field->set_offset];
    return object;
}

static int write_member(lua_State *L)
{
    const glintL_class *class = this_class(L);
    void *object = glintL_check_object(L, 1, class->type);
    const glintL_variant *variant = class->variant(object);
    const char *name = field_name(L, variant);
    int part = component(variant, name);
    const glintL_field *field = NULL;
    description desc;
    glint_error error;
    glintL_get_tracing(L)->refuse(L, variant->name);
    if (part < 0)
        field = writable_field(L, class, variant, name);
    class->get(object, &desc);
    if (field && field->type == GLINT_TYPE_TABLE)
        object = read_nested(L, class, field, &desc);
    else if (field)
        glintL_read_field(L, 3, variant->name, field, &desc);
    else
        read_component(L, variant, part, &desc);
    if (field && class->assigned)
        class->assigned(L, field, &desc);
    glintL_check_status(L, variant->name, &error, class->set(object, &desc, &error));
    if (field && field->type == GLINT_TYPE_OBJECT)
        glintL_keep(L, 1, field->name, 3);
    if (field)
        glintL_keep_slopes(L, 1, field, 3);
    else
        glintL_keep_part_slopes(L, 1, glintL_find_field(glintL_fields_of(variant), variant->place), part, 3);
    if (field && field->program_offset)
        glintL_get_tracing(L)->keep(L, 1, field, 3);
    if (field && class->accepted)
        class->accepted(L, field, &desc);
    return 0;
}

// ---- The rest of a metatable ----

static int close_object(lua_State *L)
{
    const glintL_class *class = this_class(L);
    glintL_box *box = luaL_testudata(L, 1, class->type);
    if (!box)
        return glintL_refuse(L, 1, "", class->type + sizeof "glint." - 1);
    if (!lua_toboolean(L, lua_upvalueindex(2))) // not when called by the collector
        glintL_get_tracing(L)->keep_closed(L, 1);
    void *object = box->object;
    box->object = NULL; // first, so that the object is released only once
    if (object)
        class->release(object);
    return 0;
}

static int same_object(lua_State *L)
{
    const glintL_class *class = this_class(L);
    const void *a = glintL_test_object(L, 1, class->type), *b = glintL_test_object(L, 2, class->type);
    lua_pushboolean(L, a && a == b);
    return 1;
}

static int to_string(lua_State *L)
{
    const glintL_class *class = this_class(L);
    const void *object = glintL_test_object(L, 1, class->type);
    if (object) {
        const glintL_variant *variant = class->variant(object);
        const glintL_field *field = glintL_find_field(glintL_fields_of(variant), "name");
        if (field)
            push_value(L, class, field, object);
        if (field && *lua_tostring(L, -1))
            lua_pushfstring(L, "%s '%s'", variant->name, lua_tostring(L, -1));
        else
            lua_pushfstring(L, "%s: %p", variant->name, object);
    } else if (!lua_isuserdata(L, 1) || !glintL_push_object_name(L, 1)) {
        glintL_refuse(L, 1, "", class->type + sizeof "glint." - 1);
    }
    return 1;
}

void glintL_open_class(lua_State *L, const glintL_class *class)
{
    static const luaL_Reg meta[] = {
        { "__index", read_member },
        { "__newindex", write_member },
        { "__eq", same_object },
        { "__tostring", to_string },
        { "__pairs", glintL_pairs },
        { NULL, NULL },
    };
    luaL_newmetatable(L, class->type);
    if (class->count)
        glintL_set_function(L, "__len", glintL_count_objects);
    lua_pushlightuserdata(L, (void *)(uintptr_t) class);
    lua_setfield(L, -2, "class");
    glintL_set_flag(L, "__metatable", false);
    lua_pushlightuserdata(L, (void *)(uintptr_t) class);
    lua_pushboolean(L, true);
    lua_pushcclosure(L, close_object, 2);
    lua_setfield(L, -2, "__gc");
    lua_pushlightuserdata(L, (void *)(uintptr_t) class);
    lua_pushcclosure(L, close_object, 1);
    lua_pushvalue(L, -1);
    lua_setfield(L, -3, "__close");
    lua_pushlightuserdata(L, (void *)(uintptr_t) class);
    lua_insert(L, -2);
    luaL_setfuncs(L, meta, 2); // upvalues: class, close
    lua_pop(L, 1);
}

void glintL_list_object(lua_State *L, const glintL_variant *variant, const glintL_class *class)
{
    static const luaL_Reg parts[] = { { "x", NULL }, { "y", NULL }, { "z", NULL }, { NULL, NULL } };
    static const luaL_Reg kind[] = { { "kind", NULL }, { NULL, NULL } };
    static const luaL_Reg close[] = { { "close", close_object }, { NULL, NULL } };
    glintL_list_variant(L, variant, class->methods);
    glintL_push_listed(L);
    lua_getfield(L, -1, variant->name);
    glintL_list_functions(L, variant->place ? parts : NULL, "field");
    glintL_list_functions(L, kind, "field");
    glintL_list_functions(L, variant->methods, "method");
    glintL_list_functions(L, close, "method");
    lua_pop(L, 2);
}

bool glintL_is_given(lua_State *L, const char *name)
{
    lua_pushstring(L, name);
    bool given = lua_rawget(L, 1) != LUA_TNIL;
    lua_pop(L, 1);
    return given;
}

// Makes an object. Upvalues: the class, the variant, its number.
static int new_object(lua_State *L)
{
    const glintL_class *class = this_class(L);
    const glintL_variant *variant = lua_touserdata(L, lua_upvalueindex(2));
    const glintL_field *fields = glintL_fields_of(variant);
    description desc;
    void *object;
    glint_error error;
    lua_settop(L, 1);
    glintL_box *box = glintL_new_box(L, class->type);
    class->begin((int)lua_tointeger(L, lua_upvalueindex(3)), &desc);
    glintL_read_table(L, 1, variant->name, fields, &desc, variant->is_list);
    if (class->given)
        class->given(L, variant, &desc);
    glintL_check_status(L, variant->name, &error, class->create(&desc, &object, &error));
    box->object = object;
    glintL_remember(L, object);
    glintL_get_tracing(L)->keep_all(L, 2, 1, fields);
    glintL_keep_table_slopes(L, 2, 1, fields);
    if (class->made)
        class->made(L, &desc);
    lua_settop(L, 2);
    return 1;
}

void glintL_open_objects(lua_State *L, const glintL_class *class, const glintL_variant *variants, int count)
{
    glintL_open_class(L, class);
    for (int i = 0; i < count; i++) {
        glintL_list_object(L, &variants[i], class);
        lua_pushlightuserdata(L, (void *)(uintptr_t) class);
        lua_pushlightuserdata(L, (void *)(uintptr_t)&variants[i]);
        lua_pushinteger(L, i);
        lua_pushcclosure(L, new_object, 3);
        lua_setfield(L, -2, variants[i].name);
    }
}
