// glint.animation: a scene and a function of time. Also the job object of animations and sweeps: its fields and run.
//
//     glint.animation { scene = s, frames = 120, fps = 24, cyclic = true, frame = function(t, n) ... end }
//
// t = (n-1)/frames when cyclic, else (n-1)/(frames-1), and 0 for a single frame. `frame` must depend only on t and n:
// it is called only for the selected frames, so a frame must not depend on an earlier one. While the camera's shutter
// is open it is called for several t around the frame's own t, which comes last.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bindings/run/carried.h"
#include "bindings/run/sheet.h"

static const glintL_field ANIMATION_FIELDS[] = {
    { .name = "scene" },  { .name = "frames" }, { .name = "fps" },
    { .name = "cyclic" }, { .name = "frame" },  { .name = NULL },
};
static const glintL_field SWEEP_FIELDS[] = {
    { .name = "scene" }, { .name = "size" }, { .name = "over" }, { .name = "sheet" }, { .name = NULL },
};

const char *glintL_job_name(glintL_job_kind kind) { return kind == GLINTL_JOB_SWEEP ? "sweep" : "animation"; }

static const glintL_field *own_fields(glintL_job_kind kind)
{
    return kind == GLINTL_JOB_SWEEP ? SWEEP_FIELDS : ANIMATION_FIELDS;
}

glintL_job *glintL_push_job(lua_State *L, glintL_job_kind kind)
{
    luaL_checkstack(L, 4, "job");
    glintL_job *job = lua_newuserdatauv(L, sizeof *job, GLINTL_JOB_NAMES);
    job->self = job;
    job->kind = kind;
    job->frames = 1;
    job->fps = 24;
    job->cyclic = false;
    job->render = glintL_render_default();
    luaL_setmetatable(L, GLINTL_ANIMATION);
    return job;
}

// ---- Fields ----

static int unknown_field(lua_State *L, const glintL_job *job, const char *name)
{
    const char *near = glintL_nearest(name, own_fields(job->kind));
    for (const glintL_field *field = glintL_render_fields; field->name; field++)
        near = glintL_nearer(name, near, field->name);
    return glintL_no_such_field(L, glintL_job_name(job->kind), name, glintL_nearer(name, near, "run"));
}

static void read_scene(lua_State *L, int index, int job_index, const char *path)
{
    if (!glintL_test_object(L, index, GLINTL_SCENE))
        glintL_refuse(L, index, path, "scene");
    lua_pushvalue(L, index);
    lua_setiuservalue(L, job_index, GLINTL_JOB_SCENE);
}

static void read_frames(lua_State *L, int index, glintL_job *job, const char *path)
{
    double frames = glintL_read_number(L, index, path);
    if (!(frames >= 1 && frames <= GLINTL_FRAMES_MAX) || frames != floor(frames))
        glintL_refuse(L, index, path, "whole number 1 .. 100000000");
    job->frames = (int64_t)frames;
}

static void read_animation_field(lua_State *L, int index, int job_index, glintL_job *job, const char *name)
{
    char path[64];
    snprintf(path, sizeof path, "animation.%s", name);
    if (strcmp(name, "scene") == 0) {
        read_scene(L, index, job_index, path);
    } else if (strcmp(name, "frames") == 0) {
        read_frames(L, index, job, path);
    } else if (strcmp(name, "fps") == 0) {
        double fps = glintL_read_number(L, index, path);
        if (!(fps > 0 && fps <= 1e6))
            glintL_refuse(L, index, path, "number > 0");
        job->fps = fps;
    } else if (strcmp(name, "cyclic") == 0) {
        if (!lua_isboolean(L, index))
            glintL_refuse(L, index, path, "boolean");
        job->cyclic = lua_toboolean(L, index);
    } else {
        if (!lua_isfunction(L, index))
            glintL_refuse(L, index, path, "function");
        lua_pushvalue(L, index);
        lua_setiuservalue(L, job_index, GLINTL_JOB_FRAME);
    }
}

// Reads the value at `index` into a field of the job at `job_index`. Both are absolute.
static void read_field(lua_State *L, int index, int job_index, const char *name)
{
    glintL_job *job = lua_touserdata(L, job_index);
    char path[32];
    int field = glintL_render_find(name);
    if (field >= 0) {
        snprintf(path, sizeof path, "%s.", glintL_job_name(job->kind));
        glintL_render_read(L, index, path, field, &job->render);
    } else if (!glintL_find_field(own_fields(job->kind), name)) {
        unknown_field(L, job, name);
    } else if (job->kind == GLINTL_JOB_ANIMATION) {
        read_animation_field(L, index, job_index, job, name);
    } else if (strcmp(name, "scene") == 0) {
        read_scene(L, index, job_index, "sweep.scene");
    } else {
        glintL_sweep_read(L, index, job_index, name);
    }
}

void glintL_job_read_table(lua_State *L, int index, int job_index)
{
    const glintL_job *job = lua_touserdata(L, job_index);
    const char *name = glintL_job_name(job->kind);
    if (!lua_istable(L, index))
        glintL_refuse(L, index, name, "table");
    bool has_size = lua_getfield(L, index, "size") != LUA_TNIL;
    bool has_side = lua_getfield(L, index, "width") != LUA_TNIL || lua_getfield(L, index, "height") != LUA_TNIL;
    if (job->kind == GLINTL_JOB_SWEEP && has_size && has_side)
        glintL_error(L, "sweep.size: either size or width and height expected, got both");
    lua_settop(L, job_index);
    lua_pushnil(L);
    while (lua_next(L, index)) {
        if (lua_type(L, -2) != LUA_TSTRING)
            glintL_bad_key(L, name, -2);
        read_field(L, lua_gettop(L), job_index, lua_tostring(L, -2));
        lua_pop(L, 1);
    }
    if (lua_getiuservalue(L, job_index, GLINTL_JOB_SCENE) == LUA_TNIL)
        glintL_refuse(L, -1, job->kind == GLINTL_JOB_SWEEP ? "sweep.scene" : "animation.scene", "scene");
    lua_pop(L, 1);
}

static int new_animation(lua_State *L)
{
    lua_settop(L, 1);
    glintL_push_job(L, GLINTL_JOB_ANIMATION);
    glintL_job_read_table(L, 1, 2);
    return 1;
}

static int write_field(lua_State *L)
{
    luaL_checkudata(L, 1, GLINTL_ANIMATION);
    const glintL_job *job = lua_touserdata(L, 1);
    if (lua_type(L, 2) != LUA_TSTRING)
        glintL_bad_key(L, glintL_job_name(job->kind), 2);
    read_field(L, 3, 1, lua_tostring(L, 2));
    return 0;
}

static int push_own_field(lua_State *L, const glintL_job *job, const char *name)
{
    if (strcmp(name, "frames") == 0)
        lua_pushinteger(L, job->frames);
    else if (strcmp(name, "fps") == 0)
        lua_pushnumber(L, job->fps);
    else if (strcmp(name, "cyclic") == 0)
        lua_pushboolean(L, job->cyclic);
    else if (strcmp(name, "scene") == 0)
        lua_getiuservalue(L, 1, GLINTL_JOB_SCENE);
    else if (strcmp(name, "frame") == 0)
        lua_getiuservalue(L, 1, GLINTL_JOB_FRAME);
    else if (strcmp(name, "over") == 0) {
        lua_getiuservalue(L, 1, GLINTL_JOB_FRAME);
        glintL_call_own(L, "sweep", "copy_axes", 1, 1);
    } else if (strcmp(name, "sheet") == 0)
        lua_getiuservalue(L, 1, GLINTL_JOB_SHEET);
    else { // size
        lua_createtable(L, 2, 0);
        lua_pushinteger(L, (lua_Integer)job->render.desc.width);
        lua_rawseti(L, -2, 1);
        lua_pushinteger(L, (lua_Integer)job->render.desc.height);
        lua_rawseti(L, -2, 2);
    }
    return 1;
}

static int read_member(lua_State *L)
{
    const glintL_job *job = luaL_checkudata(L, 1, GLINTL_ANIMATION);
    if (lua_type(L, 2) != LUA_TSTRING)
        glintL_bad_key(L, glintL_job_name(job->kind), 2);
    const char *name = lua_tostring(L, 2);
    int field = glintL_render_find(name);
    if (field >= 0)
        glintL_render_push(L, field, &job->render);
    else if (strcmp(name, "run") == 0)
        lua_pushcfunction(L, glintL_job_run);
    else if (strcmp(name, "frames") == 0 || glintL_find_field(own_fields(job->kind), name))
        push_own_field(L, job, name);
    else
        unknown_field(L, job, name);
    return 1;
}

static int to_string(lua_State *L)
{
    const glintL_job *job = luaL_checkudata(L, 1, GLINTL_ANIMATION);
    lua_pushfstring(L, "%s of %I frame%s", glintL_job_name(job->kind), (LUAI_UACINT)job->frames,
                    job->frames == 1 ? "" : "s");
    return 1;
}

// ---- One frame ----

static double steps_of(const glintL_job *job) { return (double)(job->cyclic ? job->frames : job->frames - 1); }

double glintL_job_time(const glintL_job *job, int64_t n)
{
    double steps = steps_of(job);
    return steps > 0 ? (double)(n - 1) / steps : 0;
}

double glintL_job_shutter_time(const glintL_job *job, int64_t n, double share, int k, int times)
{
    double steps = steps_of(job), within = (k + 0.5) / times;
    if (steps < 1)
        return share * within;
    double t = ((double)(n - 1) + share * (within - 0.5)) / steps;
    if (job->cyclic)
        return t - floor(t);
    return fmin(fmax(t, 0), 1);
}

void glintL_job_build(lua_State *L, int index, int64_t n, double t)
{
    const glintL_job *job = lua_touserdata(L, index);
    luaL_checkstack(L, 4, "frame");
    if (job->kind == GLINTL_JOB_SWEEP) {
        glintL_sweep_build(L, index, n);
    } else if (lua_getiuservalue(L, index, GLINTL_JOB_FRAME) == LUA_TFUNCTION) { // a still has no frame function
        lua_pushnumber(L, t);
        lua_pushinteger(L, n);
        lua_call(L, 2, 0);
    } else {
        lua_pop(L, 1);
    }
    lua_getiuservalue(L, index, GLINTL_JOB_SCENE);
    const glint_scene *scene = glintL_test_object(L, -1, GLINTL_SCENE);
    if (scene) {
        glintL_trace_scene(L, scene);
        glintL_update_curves(L, scene);
    }
    lua_pop(L, 1);
}

static void list_fields(lua_State *L, const char *name, const glintL_field *own)
{
    static const luaL_Reg methods[] = { { "run", glintL_job_run }, { NULL, NULL } };
    glintL_field fields[GLINTL_RENDER_FIELDS + 8];
    size_t count = 0;
    for (; own->name; own++)
        fields[count++] = *own;
    memcpy(fields + count, glintL_render_fields, sizeof glintL_render_fields); // including the terminator
    glintL_variant variant = { .name = name, .fields = fields };
    glintL_list_variant(L, &variant, methods);
}

void glintL_open_animation(lua_State *L)
{
    static const luaL_Reg meta[] = {
        { "__index", read_member },
        { "__newindex", write_field },
        { "__tostring", to_string },
        { NULL, NULL },
    };
    glintL_new_type(L, GLINTL_ANIMATION, meta);
    glintL_open_kept_image(L);
    list_fields(L, "animation", ANIMATION_FIELDS);
    list_fields(L, "sweep", SWEEP_FIELDS);
    glintL_list_sheet(L);
    glintL_set_function(L, "animation", new_animation);
    glintL_set_function(L, "sweep", glintL_new_sweep);
}
