#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "engine/glint_inspect.h"
#include "tests/bench/glint_side.h"

enum { ROUNDS = 15, LIMIT_S = 20, LAST = 15 };

typedef struct frame_state {
    glint_renderer *renderer;
    glint_plan *plan;
    glint_frame_stats stats; ///< the statistics of the last frame
    double processor_ms[LAST]; ///< the processor times of the last frames
    int frames;
} frame_state;

/// Renders a frame and returns its milliseconds. If processor_ms is not NULL, *processor_ms gets the processor time
/// of rendering only, without building the BVH and converting light to pixel values.
static double render(glint_renderer *renderer, const glint_plan *plan, glint_frame_stats *stats, double *processor_ms)
{
    glint_error error;
    glint_image *image;
    const double start = bench_processor_ms();
    side_must(glint_render(renderer, plan, &image, stats, &error), &error);
    const double whole = stats->build_ms + stats->render_ms + stats->tone_ms;
    if (processor_ms)
        *processor_ms = (bench_processor_ms() - start) * stats->render_ms / whole;
    glint_image_release(image);
    return stats->render_ms;
}

static double time_render(void *state)
{
    frame_state *f = state;
    const double ms = render(f->renderer, f->plan, &f->stats, &f->processor_ms[f->frames % LAST]);
    f->frames++;
    return ms;
}

static double time_codes(void *state)
{
    frame_state *f = state;
    return render(f->renderer, f->plan, &f->stats, NULL) + f->stats.tone_ms;
}

static glint_renderer *renderer_or_exit(const bench_options *options)
{
    glint_renderer *renderer = side_renderer_create(options);
    if (!renderer) {
        bench_say("lacks_isa", "-", 0);
        exit(0);
    }
    return renderer;
}

/// Ends the program when a frame takes too long. The driver reads the message and continues.
static void give_up(int signal)
{
    (void)signal;
    static const char late[] = "late s 20\n";
    ssize_t written = write(1, late, sizeof late - 1);
    _exit(written > 0 ? 0 : 1);
}

/// Prints the peak memory of the process with the film, but without this program's own copy of the scene; and the
/// size of the spheres, each stored as doubles with a material.
static void say_memory(const bench_scene *scene)
{
    struct rusage usage;
    const size_t own = 4 * sizeof *scene->spheres + sizeof *scene->sphere_material, data = 4 * sizeof(double) + sizeof(uint32_t);
    if (getrusage(RUSAGE_SELF, &usage) == 0)
        bench_say("peak", "MB", ((double)usage.ru_maxrss * 1024 - (double)(scene->sphere_count * own)) / 1e6);
    bench_say("data", "MB", (double)(scene->sphere_count * data) / 1e6);
}

void side_run_frame(const bench_options *options)
{
    bench_options fresh = *options;
    fresh.no_reuse = true;
    side_scene scene = side_scene_create(options);
    frame_state f = { .renderer = renderer_or_exit(&fresh) };
    signal(SIGALRM, give_up);
    alarm(LIMIT_S);
    f.plan = side_plan_create(&scene, options);
    time_render(&f);
    alarm(0);
    double ms = bench_median(time_render, &f);
    double rays = (double)(f.stats.rays.primary + f.stats.rays.shadow);
    bench_say("render", "ms", ms);
    bench_say("cpu", "ms", bench_median_of(f.processor_ms, f.frames < LAST ? f.frames : LAST));
    bench_say("codes", "ms", bench_median(time_codes, &f));
    bench_say("rays", "M/s", rays / ms / 1e3);
    bench_say("shadow_rays", "rays", (double)f.stats.rays.shadow);
    say_memory(&scene.plain);
    glint_plan_destroy(f.plan);
    glint_renderer_destroy(f.renderer);
    side_scene_free(&scene);
}

/// Renders a small frame of a new scene. Returns the time to build its BVH. *ready_ms gets the whole time from the
/// described scene to the film, including plan and snapshot.
static double build_once(const bench_options *options, double *ready_ms)
{
    glint_error error;
    side_scene scene = side_scene_create(options);
    glint_renderer *renderer = renderer_or_exit(options);
    glint_render_desc d = glint_render_desc_default();
    d.width = d.height = 16;
    glint_plan *plan;
    glint_frame_stats stats;
    double start = bench_now_ms();
    side_must(glint_plan_create(scene.scene, &d, &plan, &error), &error);
    render(renderer, plan, &stats, NULL);
    *ready_ms = bench_now_ms() - start;
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    side_scene_free(&scene);
    return stats.build_ms;
}

void side_run_build(const bench_options *options)
{
    enum { TIMES = 3 };
    double build_ms[TIMES], ready_ms[TIMES];
    signal(SIGALRM, give_up);
    alarm(LIMIT_S);
    for (int i = -1; i < TIMES; i++)
        build_ms[i < 0 ? 0 : i] = build_once(options, &ready_ms[i < 0 ? 0 : i]);
    alarm(0);
    bench_say("build", "ms", bench_median_of(build_ms, TIMES));
    bench_say("ready", "ms", bench_median_of(ready_ms, TIMES));
}

/// Prints the nanoseconds per pixel of each stage, on one thread.
void side_run_stages(const bench_options *options)
{
    bench_options fresh = *options;
    fresh.no_reuse = true;
    side_scene scene = side_scene_create(options);
    frame_state f = { .renderer = renderer_or_exit(&fresh) };
    f.plan = side_plan_create(&scene, options);
    static double ms[GLINT_STAGE_MAX][ROUNDS];
    static double tone[ROUNDS];
    for (int round = -1; round < ROUNDS; round++) {
        render(f.renderer, f.plan, &f.stats, NULL);
        for (int k = 0; k < f.stats.stage_count && round >= 0; k++)
            ms[k][round] = f.stats.stage_ms[k];
        if (round >= 0)
            tone[round] = f.stats.tone_ms;
    }
    const double ns_a_pixel = 1e6 / (BENCH_WIDTH * BENCH_HEIGHT);
    for (int k = 0; k < f.stats.stage_count; k++)
        if (strcmp(f.stats.stage_name[k], "tone") != 0)
            bench_say(f.stats.stage_name[k], "ns/px", bench_median_of(ms[k], ROUNDS) * ns_a_pixel);
    bench_say("tone", "ns/px", bench_median_of(tone, ROUNDS) * ns_a_pixel);
    glint_plan_destroy(f.plan);
    glint_renderer_destroy(f.renderer);
    side_scene_free(&scene);
}

/// Renders successive frames of a job, without reuse in one renderer and with reuse in another. With the option
/// `times`, the second renderer computes several shutter times of each frame.
void side_run_reuse(const bench_options *options)
{
    bench_options fresh_options = *options;
    fresh_options.no_reuse = true;
    side_scene scene = side_scene_create(options);
    glint_renderer *fresh = renderer_or_exit(&fresh_options), *keeping = renderer_or_exit(options);
    double fresh_ms[ROUNDS], kept_ms[ROUNDS], fresh_cpu[ROUNDS], kept_cpu[ROUNDS];
    for (int round = -2; round < ROUNDS; round++) {
        glint_frame_stats stats;
        side_scene_set_frame(&scene, options->change, round + 2);
        glint_plan *plan = side_plan_create(&scene, options);
        double processor[2], f = render(fresh, plan, &stats, &processor[0]);
        if (options->times) {
            glint_plan_destroy(plan);
            plan = side_plan_create_exposed(&scene, options, round + 2);
        }
        double k = render(keeping, plan, &stats, &processor[1]);
        if (round >= 0) {
            fresh_ms[round] = f;
            kept_ms[round] = k;
            fresh_cpu[round] = processor[0];
            kept_cpu[round] = processor[1];
        }
        glint_plan_destroy(plan);
    }
    bench_say("fresh", "ms", bench_median_of(fresh_ms, ROUNDS));
    bench_say("kept", "ms", bench_median_of(kept_ms, ROUNDS));
    bench_say("fresh_cpu", "ms", bench_median_of(fresh_cpu, ROUNDS));
    bench_say("kept_cpu", "ms", bench_median_of(kept_cpu, ROUNDS));
    glint_renderer_destroy(fresh);
    glint_renderer_destroy(keeping);
    side_scene_free(&scene);
}
