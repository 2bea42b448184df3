/// glint through its public API, as a linked program uses it, in its default double precision.
///
///   glint_side frame scene=NAME [lamps=N] [threads=N] [samples=N] [shadows=0] [indirect=N] [isa=NAME] [float=1]
///       [pattern=NAME]
///   glint_side build scene=1M [threads=N]                ms to build the BVH, and for a scene's first (small) frame
///   glint_side stages [isa=NAME]                         ns per pixel
///   glint_side reuse change=light|sphere|shininess|number [pattern=NAME]  ms of a frame without and with reuse
///   glint_side job change=light|sphere|shininess out=FOLDER [threads=N] [reuse=0] [float=1]
///   glint_side encode out=FOLDER
///   glint_side program                                   ns per point of patterns and a shader, in the kernel only
///   glint_side picture out=FILE [scene=...]
///   glint_side isa                                       the best instruction set of this machine
///   glint_side compare out=A with=B                      number of pixels that differ by more than two 8-bit steps
#include <stdio.h>
#include <string.h>

#include "engine/glint_compare.h"
#include "engine/glint_files.h"
#include "tests/bench/glint_side.h"

static void run_picture(const bench_options *options)
{
    glint_error error;
    side_scene scene = side_scene_create(options);
    glint_renderer *renderer = side_renderer_create(options);
    glint_plan *plan = side_plan_create(&scene, options);
    glint_image *image;
    side_must(glint_render(renderer, plan, &image, NULL, &error), &error);
    glint_write_desc d = { .struct_size = sizeof(glint_write_desc), .path = options->out, .pass = GLINT_PASS_BEAUTY, .tone = glint_tone_desc_default() };
    side_must(glint_image_write(image, &d, &error), &error);
    glint_image_release(image);
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    side_scene_free(&scene);
}

static void run_compare(const bench_options *options)
{
    glint_error error;
    glint_compare_desc d = { .fail = 2.5 / 255, .warn = 2.5 / 255 };
    glint_compare_result result;
    side_must(glint_compare_files(options->out, options->with, &d, &result, &error), &error);
    bench_say("differ", "pixels", (double)result.failed);
}

static void run_isa(const bench_options *options)
{
    glint_renderer *renderer = side_renderer_create(options);
    puts(glint_renderer_isa(renderer));
    glint_renderer_destroy(renderer);
}

typedef struct mode {
    const char *name;
    void (*run)(const bench_options *options);
    bool writes;
} mode;

static const mode modes[] = {
    { "frame", side_run_frame, false },     { "build", side_run_build, false },
    { "stages", side_run_stages, false },   { "reuse", side_run_reuse, false },
    { "job", side_run_job, true },          { "encode", side_run_encode, true },
    { "program", side_run_program, false }, { "compare", run_compare, true },
    { "picture", run_picture, true },       { "isa", run_isa, false },
};

int main(int argc, char **argv)
{
    bench_options options = bench_options_read(argc, argv);
    for (size_t i = 0; i < sizeof modes / sizeof *modes; i++)
        if (strcmp(modes[i].name, options.mode) == 0) {
            if (modes[i].writes && !options.out)
                bench_fail(options.mode, "out=... expected");
            modes[i].run(&options);
            return 0;
        }
    bench_fail(options.mode, "no such mode");
}
