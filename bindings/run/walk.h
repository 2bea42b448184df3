/// A loop over a list of jobs, and one frame of it. Private to bindings/run/.
#ifndef GLINT_L_WALK_H
#define GLINT_L_WALK_H

#include "bindings/run/order.h"
#include "bindings/run/run.h"

typedef struct glintL_walk {
    lua_State *L;
    glintL_run *run;
    int list, job_index; // stack indices; the job is at job_index
    lua_Integer settled; // number of jobs in the list whose scene is in its final state
    const glintL_job *job;
    glintL_render render; // render options, including the options of the command line
    double time; // time of the moment that is built
    char pattern[GLINTL_PATH_SIZE];
    glintL_naming naming;
} glintL_walk;


/// Returns job i of the list at `index`.
const glintL_job *glintL_walk_get_job(lua_State *L, int index, lua_Integer i);
/// Pushes job i of the list and makes it the current one.
void glintL_walk_begin(glintL_walk *walk, lua_Integer i);
/// Opens the film for the job's frames, if there is one. False: the run has failed.
bool glintL_walk_open_film(glintL_walk *walk);
/// Calls `function` with the job, n and the walk. False: it raised, and the run has failed.
bool glintL_walk_call(glintL_walk *walk, lua_CFunction function, int64_t n, int64_t number);
int glintL_walk_build(lua_State *L); ///< for glintL_walk_call: builds frame n at the walk's time
int glintL_walk_restore(lua_State *L); ///< for glintL_walk_call: restores the values that a sweep changed
/// Sets the scene to frame n at its own time. False: the run has failed.
bool glintL_walk_build_frame(glintL_walk *walk, int64_t n, int64_t number);
/// Brings the scene to the state in which job i starts: previous animations are at their last frame, and previous
/// sweeps have changed nothing. The state does not depend on the frames that this run renders, so a shard renders the
/// same pictures as the whole job. False: the run has failed.
bool glintL_walk_settle(glintL_walk *walk, lua_Integer i, int64_t first);
glint_scene *glintL_walk_scene(glintL_walk *walk); ///< the job's scene; NULL: it is closed
glint_scene *glintL_walk_open_scene(glintL_walk *walk, int64_t number); ///< NULL: it is closed, and the run has failed
/// Returns whether the job's scene changes with time: an animation with a frame function.
bool glintL_walk_moves(glintL_walk *walk);
/// Sets the scene to frame n and plans it. NULL: the run has failed.
glintL_work *glintL_walk_plan(glintL_walk *walk, int64_t n, int64_t number);
/// Plans frame n and names its files. NULL: the run has failed.
glintL_work *glintL_walk_prepare(glintL_walk *walk, int64_t n, int64_t number);
/// Plans and renders frame n. False: the run has failed.
bool glintL_walk_render(glintL_walk *walk, int64_t n, int64_t number);

// ---- job_frames.c ----

/// Pushes a walk over the list at `index`. Lua's collector frees it in any case.
glintL_walk *glintL_push_walk(lua_State *L, int index, glintL_run *run);
/// Draws the sheet of a sweep, if it has one; the sweep's first frame has that number. False: the run has failed.
bool glintL_walk_make_sheet(glintL_walk *walk, int64_t first);
/// Plans frame n of the current job, at `walk`, for its keys. NULL: it cannot be planned; no message is printed.
glint_plan *glintL_walk_probe(void *walk, int64_t n);
/// Adds the axes of the current job: a sweep's own; for an animation its frames.
void glintL_walk_add_axes(glintL_walk *walk, glintL_order *order);

#endif
