// glint.animation: a scene and a function of time. Also the job object of animations and sweeps: its fields and run.
//
//     glint.animation { scene = s, frames = 120, fps = 24, cyclic = true, frame = function(t, n) ... end }
//
// t = (n-1)/frames when cyclic, else (n-1)/(frames-1), and 0 for a single frame. `frame` must depend only on t and n:
// it is called only for the selected frames, so a frame must not depend on an earlier one. While the camera's shutter
// is open it is called for several t around the frame's own t, which comes last.
#include <string.h>

#include "bindings/lua/lua.h"
#include "bindings/run/carried.h"
#include "bindings/run/sheet.h"

static int new_animation(lua_State *L)
{
    lua_settop(L, 1);
    glintL_push_job(L, GLINTL_JOB_ANIMATION);
    glintL_job_read_table(L, 1, 2);
    return 1;
}

static int new_sweep(lua_State *L)
{
    lua_settop(L, 1);
    glintL_push_job(L, GLINTL_JOB_SWEEP);
    glintL_job_read_table(L, 1, 2);
    if (lua_getiuservalue(L, 2, GLINTL_JOB_FRAME) == LUA_TNIL)
        glintL_refuse(L, -1, "sweep.over", "list of axes");
    lua_settop(L, 2);
    return 1;
}

static int write_field(lua_State *L)
{
    luaL_checkudata(L, 1, GLINTL_ANIMATION);
    const glintL_job *job = lua_touserdata(L, 1);
    if (lua_type(L, 2) != LUA_TSTRING)
        glintL_bad_key(L, glintL_job_name(job->kind), 2);
    glintL_job_read_field(L, 3, 1, lua_tostring(L, 2));
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
    else if (strcmp(name, "frames") == 0 || glintL_find_field(glintL_job_fields(job->kind), name))
        push_own_field(L, job, name);
    else
        glintL_job_unknown_field(L, job, name);
    return 1;
}

static int to_string(lua_State *L)
{
    const glintL_job *job = luaL_checkudata(L, 1, GLINTL_ANIMATION);
    lua_pushfstring(L, "%s of %I frame%s", glintL_job_name(job->kind), (LUAI_UACINT)job->frames,
                    job->frames == 1 ? "" : "s");
    return 1;
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
    list_fields(L, "animation", glintL_job_fields(GLINTL_JOB_ANIMATION));
    list_fields(L, "sweep", glintL_job_fields(GLINTL_JOB_SWEEP));
    glintL_list_sheet(L);
    glintL_set_function(L, "animation", new_animation);
    glintL_set_function(L, "sweep", new_sweep);
}
