/// A walk over a list of jobs, and one frame of it. Private to bindings/run/.
#ifndef GLINT_L_WALK_H
#define GLINT_L_WALK_H

#include "bindings/run/order.h"
#include "bindings/run/run.h"

typedef struct glintL_walk {
    lua_State *L;
    glintL_run *run;
    int list, job_index; // on the stack; the job is on top of it
    lua_Integer settled; // jobs of the list that left the scene as they leave it
    const glintL_job *job;
    glintL_render render; // with the options of the command line
    double time; // of the moment that is built
    char pattern[GLINTL_PATH_SIZE];
    glintL_naming naming;
} glintL_walk;


/// Job i of the list at `index`.
const glintL_job *glintL_walk_get_job(lua_State *L, int index, lua_Integer i);
/// Pushes job i of the list and makes it the one at hand.
void glintL_walk_begin(glintL_walk *walk, lua_Integer i);
/// Prepares the film the job's frames go into, if any. False: the run has failed.
bool glintL_walk_open_film(glintL_walk *walk);
/// Calls `function` with the job, n and the walk. False: it raised, and the run has failed.
bool glintL_walk_call(glintL_walk *walk, lua_CFunction function, int64_t n, int64_t number);
int glintL_walk_build(lua_State *L); ///< for glintL_walk_call: builds frame n at the walk's time
int glintL_walk_restore(lua_State *L); ///< for glintL_walk_call: restores the values that a sweep changed
/// Sets the scene to frame n at its own time. False: the run has failed.
bool glintL_walk_build_frame(glintL_walk *walk, int64_t n, int64_t number);
/// A job begins with the scene as the jobs before it leave it, whichever of their frames are rendered here: an animation
/// after its last frame, a sweep as it found it. So a shard's pictures equal those of the whole job. Returns false if the run has
/// failed.
bool glintL_walk_settle(glintL_walk *walk, lua_Integer i, int64_t first);
glint_scene *glintL_walk_scene(glintL_walk *walk); ///< the job's; NULL: it is closed
glint_scene *glintL_walk_open_scene(glintL_walk *walk, int64_t number); ///< NULL: it is closed, and the run has failed
/// Whether the job's scene is another at another time: an animation with a frame function.
bool glintL_walk_moves(glintL_walk *walk);
/// Sets the scene to frame n and plans it. NULL: the run has failed.
glintL_work *glintL_walk_plan(glintL_walk *walk, int64_t n, int64_t number);
/// Plans frame n and names its files. NULL: the run has failed.
glintL_work *glintL_walk_prepare(glintL_walk *walk, int64_t n, int64_t number);
/// Plans and renders frame n. False: the run has failed.
bool glintL_walk_render(glintL_walk *walk, int64_t n, int64_t number);

// ---- job_frames.c ----

/// Pushes a walk over the list at `index`: the collector's, so that it is freed whatever happens.
glintL_walk *glintL_push_walk(lua_State *L, int index, glintL_run *run);
/// Draws the sheet of a sweep whose first frame has that number, when it has one. False: the run has failed.
bool glintL_walk_make_sheet(glintL_walk *walk, int64_t first);
/// Plans frame n of the current job, at `walk`, for its keys. NULL: it cannot be planned; no message is printed.
glint_plan *glintL_walk_probe(void *walk, int64_t n);
/// Adds the axes of the job at hand: a sweep's own, of an animation its frames.
void glintL_walk_add_axes(glintL_walk *walk, glintL_order *order);

#endif
