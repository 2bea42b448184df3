/// glint as one of the sides of the table, through its public API only.
#ifndef GLINT_BENCH_GLINT_SIDE_H
#define GLINT_BENCH_GLINT_SIDE_H

#include "engine/glint.h"
#include "tests/bench/options.h"
#include "tests/bench/scenes.h"

/// A scene as described to glint.
typedef struct side_scene {
    bench_scene plain;
    glint_scene *scene;
    glint_light *lamp;
    glint_material *materials[BENCH_MATERIALS];
    glint_shape *ball; ///< the last sphere of a small scene, owned by the scene
    const char *pattern; ///< name of the pattern, from the options
} side_scene;

/// Ends the program with the message unless the status is GLINT_OK.
void side_must(glint_status status, const glint_error *error);

side_scene side_scene_create(const bench_options *options);
void side_scene_free(side_scene *scene);
/// Sets frame `frame` of a job: moves the light, lifts the last sphere of a small scene, changes a number of the
/// pattern, or the shininess of every shiny material.
void side_scene_set_frame(side_scene *scene, const char *change, int frame);

/// Returns NULL when this machine lacks the instruction set that the options name.
glint_renderer *side_renderer_create(const bench_options *options);
/// 1920 x 1080, pixel values only, no passes.
glint_plan *side_plan_create(const side_scene *scene, const bench_options *options);
/// Like side_plan_create, but exposed over several times of frame `frame` of a job.
glint_plan *side_plan_create_exposed(side_scene *scene, const bench_options *options, int frame);

void side_run_frame(const bench_options *options);
void side_run_build(const bench_options *options);
void side_run_stages(const bench_options *options);
void side_run_reuse(const bench_options *options);
void side_run_encode(const bench_options *options);
void side_run_job(const bench_options *options);
/// Creates the program of bench_options.pattern; the caller releases it. `number`, 0 .. 1, is the darker colour of
/// the pattern. Returns NULL for "none".
glint_program *side_program_create(const char *pattern, double number);
/// Times only the kernel of programs, which no public function runs.
void side_run_program(const bench_options *options);

#endif
