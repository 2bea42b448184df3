// The job of an animation or a sweep: its fields, the time of each frame, and the call that builds one.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bindings/run/carried.h"

static const glintL_field ANIMATION_FIELDS[] = {
    { .name = "scene" },  { .name = "frames" }, { .name = "fps" },
    { .name = "cyclic" }, { .name = "frame" },  { .name = NULL },
};
static const glintL_field SWEEP_FIELDS[] = {
    { .name = "scene" }, { .name = "size" }, { .name = "over" }, { .name = "sheet" }, { .name = NULL },
};

const char *glintL_job_name(glintL_job_kind kind) { return kind == GLINTL_JOB_SWEEP ? "sweep" : "animation"; }

const glintL_field *glintL_job_fields(glintL_job_kind kind)
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

int glintL_job_unknown_field(lua_State *L, const glintL_job *job, const char *name)
{
    const char *near = glintL_nearest(name, glintL_job_fields(job->kind));
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

void glintL_job_read_field(lua_State *L, int index, int job_index, const char *name)
{
    glintL_job *job = lua_touserdata(L, job_index);
    char path[32];
    int field = glintL_render_find(name);
    if (field >= 0) {
        snprintf(path, sizeof path, "%s.", glintL_job_name(job->kind));
        glintL_render_read(L, index, path, field, &job->render);
    } else if (!glintL_find_field(glintL_job_fields(job->kind), name)) {
        glintL_job_unknown_field(L, job, name);
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
        glintL_job_read_field(L, lua_gettop(L), job_index, lua_tostring(L, -2));
        lua_pop(L, 1);
    }
    if (lua_getiuservalue(L, job_index, GLINTL_JOB_SCENE) == LUA_TNIL)
        glintL_refuse(L, -1, job->kind == GLINTL_JOB_SWEEP ? "sweep.scene" : "animation.scene", "scene");
    lua_pop(L, 1);
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
