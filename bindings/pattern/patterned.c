// Materials and scenes whose fields hold patterns. The userdata of such an object stores the patterns. The object gets
// their programs each time that a frame is planned.
#include "bindings/pattern/pattern.h"
#include "engine/glint.h"

#include <stdlib.h>
#include <string.h>

static const char PATTERNED; // address used as the registry key for materials with patterns, as weak keys
static const char CLOSED; // registry key for closed userdata whose materials may still be in a scene

void glintL_refuse_within_trace(lua_State *L, const char *what)
{
    if (glintL_current_trace(L))
        glintL_error(L, "%s: the function of a pattern must not change objects, because it may be called any number "
                        "of times", what);
}

// ---- Storing ----

static void note_patterned(lua_State *L, int index)
{
    if (!luaL_testudata(L, index, GLINTL_MATERIAL))
        return; // scenes are found without a list
    glintL_push_weak_table(L, &PATTERNED, "k");
    lua_pushvalue(L, index);
    lua_pushboolean(L, true);
    lua_rawset(L, -3);
    lua_pop(L, 1);
}

void glintL_keep_source(lua_State *L, int index, const glintL_field *field, int value)
{
    const bool is_source = glintL_is_source(L, value, field->type == GLINT_TYPE_CHOICE);
    luaL_checkstack(L, 8, "pattern");
    index = lua_absindex(L, index);
    if (!is_source && !glintL_push_kept(L, index, field->name))
        return; // the common case: no pattern before and after
    if (!is_source) {
        lua_pushnil(L);
        glintL_keep(L, index, field->name, -1);
        lua_pop(L, 2);
        return;
    }
    glintL_keep(L, index, field->name, value);
    note_patterned(L, index);
}

void glintL_keep_sources(lua_State *L, int index, int table, const glintL_field *fields)
{
    for (const glintL_field *field = fields; field->name; field++) {
        if (!field->program_offset)
            continue;
        lua_pushstring(L, field->name);
        lua_rawget(L, table);
        glintL_keep_source(L, index, field, -1);
        lua_pop(L, 1);
    }
}

void glintL_keep_closed(lua_State *L, int index)
{
    const glintL_box *box = lua_touserdata(L, index);
    luaL_checkstack(L, 8, "pattern");
    index = lua_absindex(L, index);
    glintL_push_table(L, &PATTERNED);
    lua_pushvalue(L, index);
    const bool is_patterned = lua_rawget(L, -2) != LUA_TNIL;
    lua_pop(L, 2);
    if (!is_patterned || !box->object)
        return;
    glintL_push_table(L, &CLOSED);
    glintL_box *twin = glintL_new_box(L, GLINTL_MATERIAL);
    lua_getiuservalue(L, index, 1);
    lua_setiuservalue(L, -2, 1);
    note_patterned(L, lua_gettop(L));
    if (box->object)
        twin->object = glint_material_retain(box->object);
    lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
    lua_pop(L, 1);
}

// ---- Tracing ----

// Pushes the result of the pattern on top for this frame. A pattern used in several fields runs once. `frame` is the
// index of the table of results. A background texture has a separate program, because no other field uses a texture in
// that way.
static void push_traced(lua_State *L, int frame, bool is_background)
{
    lua_pushvalue(L, -1);
    if (lua_rawget(L, frame) != LUA_TNIL)
        return;
    lua_pop(L, 1);
    glintL_make_program(L, lua_gettop(L), is_background);
    lua_pushvalue(L, -2);
    lua_pushvalue(L, -2);
    lua_rawset(L, frame);
}

// Returns whether a number of the program depends on a variable.
static bool changes(const glint_program *program)
{
    bool any = false;
    for (size_t k = 0; k < GLINTL_VARIABLES_MAX; k++)
        any = any || glint_program_tangent(program, k);
    return any;
}

// Pushes the position of the function of the field's pattern.
static const char *push_position(lua_State *L, int index, const glintL_field *field)
{
    luaL_checkstack(L, 4, "message");
    return glintL_push_kept(L, index, field->name) ? glintL_push_pattern_position(L, -1) : lua_pushliteral(L, "");
}

// Raises the engine's error, with the position of the function of the field that the message names first.
static void refuse_field(lua_State *L, int index, const char *name, const glintL_field *fields, glint_status status,
                         const glint_error *error)
{
    const size_t length = strcspn(error->message, ":");
    for (const glintL_field *field = fields; field->name && status == GLINT_ERR_INVALID; field++) {
        if (!field->program_offset || strncmp(field->name, error->message, length) != 0 || field->name[length])
            continue;
        const char *position = push_position(L, index, field);
        if (!*position)
            break;
        lua_pushfstring(L, "%s%s.%s", position, name, error->message);
        lua_error(L);
    }
    glintL_check_status(L, name, error, status);
}

// Sets the programs of the patterns in the object whose userdata is at `index`.
static void trace_object(lua_State *L, int index, const char *type, int frame)
{
    const int top = lua_gettop(L);
    const glintL_class *class = glintL_class_of(L, type);
    const glintL_field *fields = glintL_fields_of(class->variant(NULL));
    union {
        max_align_t align;
        char bytes[GLINTL_DESC_SIZE];
    } desc;
    glint_error error;
    bool sloped = false;
    double outputs[GLINT_PROGRAM_OUTPUTS_MAX];
    for (const glintL_field *field = fields; field->name; field++)
        if (field->program_offset && glintL_push_kept(L, index, field->name))
            push_traced(L, frame, strcmp(type, GLINTL_SCENE) == 0);
    lua_settop(L, top);
    void *object = glintL_test_object(L, index, type);
    if (!object) // a pattern's function has closed it
        return;
    class->get(object, &desc);
    for (const glintL_field *field = fields; field->name; field++) {
        glint_program *program = NULL;
        if (!field->program_offset || !glintL_push_kept(L, index, field->name))
            continue;
        lua_rawget(L, frame); // a pattern assigned in the meantime has no result
        const glintL_traced *traced = lua_touserdata(L, -1);
        if (traced)
            program = traced->program;
        sloped = sloped || (program && changes(program));
        if (program && changes(program) && glint_program_constant(program, outputs)) {
            lua_pushfstring(L, "%s%s.%s: a pattern with the same number everywhere has no derivative; assign the number itself",
                            push_position(L, index, field), type + sizeof "glint." - 1, field->name);
            lua_error(L);
        }
        memcpy(desc.bytes + field->program_offset, &program, sizeof program);
    }
    const glint_status status = class->set(object, &desc, &error);
    if (status)
        refuse_field(L, index, type + sizeof "glint." - 1, fields, status, &error);
    lua_settop(L, top);
    if (sloped)
        glintL_note_sloped(L, index);
}

void glintL_trace_material(lua_State *L, int index)
{
    index = lua_absindex(L, index);
    luaL_checkstack(L, 16, "pattern");
    lua_newtable(L);
    trace_object(L, index, GLINTL_MATERIAL, lua_gettop(L));
    lua_pop(L, 1);
}

// ---- The materials of a scene ----

typedef struct entry {
    const glint_material *material;
    lua_Integer position; // position of the object's userdata in a list
    size_t order; // number of the scene's background, from 1; 0: another scene's
} entry;

typedef struct entries {
    size_t count, order;
    entry items[];
} entries;

static int by_address(const void *a, const void *b)
{
    const uintptr_t left = (uintptr_t)((const entry *)a)->material, right = (uintptr_t)((const entry *)b)->material;
    return (left > right) - (left < right);
}

static int by_turn(const void *a, const void *b)
{
    const size_t left = ((const entry *)a)->order, right = ((const entry *)b)->order;
    return (left > right) - (left < right);
}

static void visit_backgrounds(entries *all, const glint_shape *shape)
{
    glint_material *const *list;
    const size_t count = glint_shape_materials(shape, &list);
    for (size_t i = 0; i < count; i++) {
        const entry key = { .material = list[i] };
        entry *found = bsearch(&key, all->items, all->count, sizeof key, by_address);
        if (found && found->order == 0)
            found->order = ++all->order;
    }
    for (size_t i = 0; i < glint_group_count(shape); i++)
        visit_backgrounds(all, glint_group_child(shape, i));
}

// Pushes a list of the userdata that store patterns, and the entries of their materials.
static entries *push_entries(lua_State *L)
{
    size_t count = 0;
    lua_newtable(L);
    const int list = lua_gettop(L);
    glintL_push_table(L, &PATTERNED);
    for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1)) {
        lua_pushvalue(L, -2);
        lua_rawseti(L, list, (lua_Integer)++count);
    }
    lua_pop(L, 1);
    entries *all = lua_newuserdatauv(L, sizeof *all + count * sizeof *all->items, 0);
    *all = (entries) { 0, 0 };
    for (size_t i = 1; i <= count; i++) {
        lua_rawgeti(L, list, (lua_Integer)i);
        const glint_material *material = glintL_test_object(L, -1, GLINTL_MATERIAL);
        if (material)
            all->items[all->count++] = (entry) { material, (lua_Integer)i, 0 };
        lua_pop(L, 1);
    }
    return all;
}

// Traces the scene's own patterns, with a table of their programs.
static void trace_background(lua_State *L, const glint_scene *scene)
{
    const int top = lua_gettop(L);
    glintL_push_remembered(L, scene);
    if (lua_isnil(L, -1) || !glintL_push_kept(L, top + 1, "background"))
        return;
    lua_newtable(L);
    trace_object(L, top + 1, GLINTL_SCENE, top + 3);
}

void glintL_trace_scene(lua_State *L, const glint_scene *scene)
{
    const int top = lua_gettop(L);
    luaL_checkstack(L, 24, "pattern");
    entries *all = push_entries(L);
    if (all->count > 0) {
        qsort(all->items, all->count, sizeof *all->items, by_address);
        for (size_t i = 0; i < glint_scene_shape_count(scene); i++)
            visit_backgrounds(all, glint_scene_shape_at(scene, i));
        qsort(all->items, all->count, sizeof *all->items, by_turn);
    }
    lua_newtable(L); // the results of patterns
    for (size_t i = 0; i < all->count; i++) {
        if (all->items[i].order == 0)
            continue;
        lua_rawgeti(L, top + 1, all->items[i].position);
        trace_object(L, top + 4, GLINTL_MATERIAL, top + 3);
        lua_settop(L, top + 3);
    }
    trace_background(L, scene);
    lua_settop(L, top);
}
