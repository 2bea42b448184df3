// glint.scene
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bindings/lua/lua.h"
#include "engine/glint_figures.h"

typedef glint_scene_desc desc_type;
_Static_assert(sizeof(desc_type) <= GLINTL_DESC_SIZE, "GLINTL_DESC_SIZE");

static const glintL_variant SCENE = { .name = "scene", .kind = GLINT_OBJECT_SCENE };

static const glintL_variant *variant(const void *object)
{
    (void)object;
    return &SCENE;
}

static void get(const void *object, void *desc)
{
    desc_type *const copy = desc;
    *copy = *glint_scene_get(object);
    copy->struct_size = sizeof *copy;
}

static glint_status set(void *object, const void *desc, glint_error *error) { return glint_scene_set(object, desc, error); }

static void *retain(void *object) { return glint_scene_retain(object); }

static void release(void *object) { glint_scene_release(object); }

// ---- Objects in and out ----

// Keeps the userdata at `value` alive as long as the scene at `index`, stored under the address of its object; nil
// releases it. Returns whether a userdata was stored under this address before.
static bool keep_object(lua_State *L, int index, const void *object, int value)
{
    lua_getiuservalue(L, index, 1);
    if (!lua_istable(L, -1)) {
        lua_pop(L, 1);
        lua_newtable(L);
        lua_pushvalue(L, -1);
        lua_setiuservalue(L, index, 1);
    }
    bool was_retained = lua_rawgetp(L, -1, object) != LUA_TNIL;
    lua_pop(L, 1);
    lua_pushvalue(L, value);
    lua_rawsetp(L, -2, object);
    lua_pop(L, 1);
    return was_retained;
}

static void drop_object(lua_State *L, int index, const void *object)
{
    if (lua_getiuservalue(L, index, 1) == LUA_TTABLE) {
        lua_pushnil(L);
        lua_rawsetp(L, -2, object);
    }
    lua_pop(L, 1);
}

// An element of a scene; only one of the pointers is set.
typedef struct member {
    glint_shape *shape;
    glint_light *light;
    glint_overlay *overlay;
} member;

// Returns whether the value is an object of a scene, or a list that begins with one.
static bool has_object(lua_State *L, int value)
{
    value = lua_absindex(L, value);
    luaL_checkstack(L, 2, "scene");
    if (lua_istable(L, value))
        lua_rawgeti(L, value, 1);
    else
        lua_pushvalue(L, value);
    const bool has = glintL_test_object(L, -1, GLINTL_SHAPE) || glintL_test_object(L, -1, GLINTL_LIGHT) ||
                     glintL_test_object(L, -1, GLINTL_OVERLAY);
    lua_pop(L, 1);
    return has;
}

static void refuse_member(lua_State *L, int value, const char *path)
{
    const char *expected = "shape, light or overlay";
    if (lua_istable(L, value) && has_object(L, value))
        glintL_error(L, "%s: %s expected, got a list; put its objects into the scene directly, or into a glint.group", path, expected);
    if (lua_istable(L, value) && !glintL_is_module(L, value))
        glintL_error(L, "%s: %s expected, got table; write glint.sphere { ... }, glint.point_light { ... } or another", path,
                     expected);
    glintL_refuse(L, value, path, expected);
}

static member check_member(lua_State *L, int value, const char *path)
{
    member m = { .shape = glintL_test_object(L, value, GLINTL_SHAPE), .light = glintL_test_object(L, value, GLINTL_LIGHT),
                 .overlay = glintL_test_object(L, value, GLINTL_OVERLAY) };
    if (!m.shape && !m.light && !m.overlay)
        refuse_member(L, value, path);
    return m;
}

static const void *object_of(const member *m)
{
    return m->shape ? (const void *)m->shape : m->light ? (const void *)m->light : m->overlay;
}

// Returns whether glint.ambient_occlusion made the value.
static bool is_ambient_occlusion(lua_State *L, int value)
{
    luaL_checkstack(L, 2, "scene");
    if (!lua_istable(L, value) || luaL_getmetafield(L, value, "glint.ambient_occlusion") == LUA_TNIL)
        return false;
    lua_pop(L, 1);
    return true;
}

// Sets the field of the scene at `index` to the value, or to nil.
static void set_ambient_occlusion(lua_State *L, int index, int value)
{
    index = lua_absindex(L, index);
    if (value)
        lua_pushvalue(L, value);
    else
        lua_pushnil(L);
    lua_setfield(L, index, "ambient_occlusion");
}

static void add_member(lua_State *L, int index, int value, const char *path)
{
    glint_status status;
    glint_error error;
    if (is_ambient_occlusion(L, value)) {
        set_ambient_occlusion(L, index, value);
        return;
    }
    member m = check_member(L, value, path);
    const void *object = object_of(&m);
    bool was_retained = keep_object(L, index, object, value);
    m = check_member(L, value, path); // again: storing allocates, and may run finalizers
    glint_scene *scene = glintL_check_object(L, index, GLINTL_SCENE);
    if (m.shape)
        status = glint_scene_add_shape(scene, m.shape, &error);
    else if (m.light)
        status = glint_scene_add_light(scene, m.light, &error);
    else
        status = glint_scene_add_overlay(scene, m.overlay, &error);
    if (status && !was_retained)
        drop_object(L, index, object);
    glintL_check_status(L, "scene", &error, status);
}

static int add(lua_State *L)
{
    glintL_check_object(L, 1, GLINTL_SCENE);
    glintL_refuse_within_trace(L, "scene.add");
    if (lua_gettop(L) > 2) // an ignored object would be missing from the picture
        return glintL_error(L, "scene.add: one object expected, got %d", lua_gettop(L) - 1);
    lua_settop(L, 2);
    add_member(L, 1, 2, "scene.add");
    return 1; // the object, for `local ball = scene:add(glint.sphere{...})`
}

static int drop(lua_State *L)
{
    glint_status status;
    glint_error error;
    glint_scene *scene = glintL_check_object(L, 1, GLINTL_SCENE);
    glintL_refuse_within_trace(L, "scene.remove");
    if (is_ambient_occlusion(L, 2)) {
        set_ambient_occlusion(L, 1, 0);
        return 0;
    }
    const member m = check_member(L, 2, "scene.remove");
    if (m.shape)
        status = glint_scene_remove_shape(scene, m.shape, &error);
    else if (m.light)
        status = glint_scene_remove_light(scene, m.light, &error);
    else
        status = glint_scene_remove_overlay(scene, m.overlay, &error);
    glintL_check_status(L, "scene", &error, status);
    drop_object(L, 1, object_of(&m));
    return 0;
}

// The objects of a scene, in their order of definition: shapes, lights, then labels and other overlays.
static lua_Integer count(const void *scene)
{
    return (lua_Integer)(glint_scene_shape_count(scene) + glint_scene_light_count(scene) + glint_scene_overlay_count(scene));
}

static void push_at(lua_State *L, const void *scene, size_t index)
{
    const size_t shapes = glint_scene_shape_count(scene), lights = glint_scene_light_count(scene);
    if (index < shapes)
        glintL_push_object(L, GLINTL_SHAPE, glint_scene_shape_at(scene, index));
    else if (index - shapes < lights)
        glintL_push_object(L, GLINTL_LIGHT, glint_scene_light_at(scene, index - shapes));
    else
        glintL_push_object(L, GLINTL_OVERLAY, glint_scene_overlay_at(scene, index - shapes - lights));
}

// ---- Rays ----

typedef struct ray {
    double origin[3], direction[3];
} ray;

// Casts the ray and pushes the shape that it hits, or nil. If the shape has no userdata any more, makes one and casts
// the ray again, because a finalizer may have changed the scene.
static bool cast_ray(lua_State *L, const ray *r, glint_hit *out)
{
    glintL_box *box = NULL;
    for (;;) {
        glint_error error;
        bool hit = false;
        const glint_scene *scene = glintL_check_object(L, 1, GLINTL_SCENE);
        glintL_check_status(L, "cast", &error, glint_scene_cast(scene, r->origin, r->direction, &hit, out, &error));
        glintL_push_remembered(L, hit ? out->shape : NULL);
        if (!hit || !lua_isnil(L, -1))
            return hit;
        lua_pop(L, 1);
        if (box) {
            box->object = glint_shape_retain(out->shape);
            glintL_remember(L, out->shape);
            return true;
        }
        box = glintL_new_box(L, GLINTL_SHAPE);
    }
}

static int cast(lua_State *L)
{
    ray r;
    glint_hit hit;
    glintL_check_object(L, 1, GLINTL_SCENE);
    glintL_read_vector(L, 2, "cast.origin", r.origin);
    glintL_read_vector(L, 3, "cast.direction", r.direction);
    lua_settop(L, 1);
    if (!cast_ray(L, &r, &hit))
        return 1; // nil
    const glint_shape *shape = glintL_test_object(L, -1, GLINTL_SHAPE);
    const glint_shape_kind kind = shape ? glint_shape_get(shape)->kind : GLINT_SHAPE_SPHERE;
    bool numbered = kind == GLINT_SHAPE_SPHERES || kind == GLINT_SHAPE_CYLINDERS || kind == GLINT_SHAPE_MESH || kind >= GLINT_SHAPE_UNION;
    lua_createtable(L, 0, 5);
    lua_insert(L, -2);
    lua_setfield(L, -2, "object");
    glintL_set_number(L, "t", hit.t);
    glintL_push_vector(L, hit.point);
    lua_setfield(L, -2, "point");
    glintL_push_vector(L, hit.normal);
    lua_setfield(L, -2, "normal");
    if (numbered) {
        glintL_set_whole(L, "element", (lua_Integer)hit.element + 1);
    }
    return 1;
}

// Renders the scene. A separate box retains the engine's scene during the call, whatever finalizers do.
static int render(lua_State *L)
{
    glintL_check_object(L, 1, GLINTL_SCENE);
    glintL_refuse_within_trace(L, "scene.render");
    lua_settop(L, 2);
    glintL_give_camera(L, glintL_get_run(L), 1);
    glintL_box *box = glintL_new_box(L, GLINTL_SCENE);
    box->object = glint_scene_retain(glintL_check_object(L, 1, GLINTL_SCENE));
    return glintL_render_call(L, box->object, 2);
}

static const luaL_Reg METHODS[] = {
    { "add", add }, { "remove", drop }, { "cast", cast }, { "objects", glintL_list_objects }, { "render", render }, { NULL, NULL } };

static const glintL_class CLASS = {
    .type = GLINTL_SCENE,
    .variant = variant,
    .get = get,
    .set = set,
    .retain = retain,
    .release = release,
    .methods = METHODS,
    .count = count,
    .push_at = push_at };

static void add_list(lua_State *L)
{
    size_t count = glintL_check_list(L, 1, "scene", true);
    for (size_t i = 1; i <= count; i++) {
        char path[32];
        lua_rawgeti(L, 1, (lua_Integer)i);
        snprintf(path, sizeof path, "scene[%zu]", i);
        add_member(L, 2, 3, path);
        lua_pop(L, 1);
    }
}

// Refuses named objects: lights = { lamp }, ball = glint.sphere { ... }.
static void refuse_named(lua_State *L)
{
    if (!lua_istable(L, 1))
        return;
    for (lua_pushnil(L); lua_next(L, 1); lua_pop(L, 1))
        if (lua_type(L, -2) == LUA_TSTRING && !glintL_find_field(glintL_fields_of(&SCENE), lua_tostring(L, -2)) &&
            (has_object(L, -1) || strcmp(lua_tostring(L, -2), "lights") == 0))
            glintL_error(L, "scene.%s: shapes and lights are listed in a scene without a name: glint.scene { camera "
                            "= ..., lamp, ball }",
                         lua_tostring(L, -2));
}

static int new_scene(lua_State *L)
{
    desc_type desc = { .camera = NULL };
    glint_scene *scene = NULL;
    glint_error error;
    lua_settop(L, 1);
    glintL_box *box = glintL_new_box(L, GLINTL_SCENE);
    glintL_check_status(L, "scene", &error, glint_scene_create(&scene, &error));
    get(scene, &desc);
    box->object = scene;
    refuse_named(L);
    glintL_read_table(L, 1, "scene", glintL_fields_of(&SCENE), &desc, true);
    glintL_check_status(L, "scene", &error, glint_scene_set(scene, &desc, &error));
    if (desc.camera) {
        lua_pushliteral(L, "camera");
        lua_rawget(L, 1);
        glintL_keep(L, 2, "camera", 3);
        lua_settop(L, 2);
    }
    glintL_keep_sources(L, 2, 1, glintL_fields_of(&SCENE));
    glintL_keep_table_slopes(L, 2, 1, glintL_fields_of(&SCENE));
    add_list(L);
    glintL_remember(L, scene);
    return 1;
}

// glint.ambient_occlusion: checks the fields of a scene's ambient_occlusion, and returns them as a read-only table. A
// scene also accepts this table among its objects.
static int new_ambient_occlusion(lua_State *L)
{
    desc_type desc = { .struct_size = sizeof desc, .has_ambient_occlusion = true };
    glint_scene *scene = NULL;
    glint_error error;
    lua_settop(L, 1);
    const glintL_field *field = glintL_find_field(glintL_fields_of(&SCENE), "ambient_occlusion");
    glintL_begin_table(field->parts, &desc);
    glintL_read_table(L, 1, field->name, field->parts, &desc, false);
    glintL_box *box = glintL_new_box(L, GLINTL_SCENE); // a scene that checks the value
    glintL_check_status(L, "", &error, glint_scene_create(&scene, &error));
    box->object = scene;
    glintL_check_status(L, "", &error, glint_scene_set(scene, &desc, &error));
    glintL_push_field(L, field, &desc);
    lua_getmetatable(L, -1);
    glintL_set_flag(L, "glint.ambient_occlusion", true);
    lua_pop(L, 1);
    return 1;
}

void glintL_open_scene(lua_State *L)
{
    glintL_open_class(L, &CLASS);
    glintL_list_object(L, &SCENE, &CLASS);
    glintL_set_function(L, "scene", new_scene);
    glintL_set_function(L, "ambient_occlusion", new_ambient_occlusion);
}
