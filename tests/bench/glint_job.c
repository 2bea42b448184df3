#include <stdio.h>
#include <sys/stat.h>

#include "engine/glint_files.h"
#include "tests/bench/glint_side.h"

static glint_write_desc write_desc(const char *path, glint_encode encode)
{
    return (glint_write_desc) { .struct_size = sizeof(glint_write_desc),
        .path = path, .pass = GLINT_PASS_BEAUTY, .tone = glint_tone_desc_default(), .encode = encode
    };
}

typedef struct encode_state {
    glint_image *image;
    glint_writer *writer;
    glint_write_desc desc;
} encode_state;

static double time_encode(void *state)
{
    encode_state *e = state;
    glint_error error;
    glint_write_result result;
    side_must(glint_writer_submit(e->writer, e->image, &e->desc, NULL, &error), &error);
    if (!glint_writer_collect(e->writer, true, &result) || result.status != GLINT_OK)
        bench_fail("glint", result.message);
    return result.encode_ms;
}

static void say_encode(encode_state *e, const char *path, glint_encode encode, const char *name, const char *size_name)
{
    struct stat status;
    e->desc = write_desc(path, encode);
    bench_say(name, "ms", bench_median(time_encode, e));
    if (stat(path, &status))
        bench_fail(path, "not written");
    bench_say(size_name, "kB", (double)status.st_size / 1000);
    remove(path);
}

void side_run_encode(const bench_options *options)
{
    glint_error error;
    side_scene scene = side_scene_create(options);
    bench_options fresh = *options; // without reuse a picture has no stamps, and the writer deflates every band again
    fresh.no_reuse = true;
    glint_renderer *renderer = side_renderer_create(&fresh);
    glint_plan *plan = side_plan_create(&scene, options);
    encode_state e;
    side_must(glint_render(renderer, plan, &e.image, NULL, &error), &error);
    side_must(glint_writer_create(1, 1, &e.writer, &error), &error);
    char path[512];
    snprintf(path, sizeof path, "%s/frame.png", options->out);
    say_encode(&e, path, GLINT_ENCODE_FAST, "fast", "fast_size");
    say_encode(&e, path, GLINT_ENCODE_SMALL, "small", "small_size");
    glint_writer_destroy(e.writer);
    glint_image_release(e.image);
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    side_scene_free(&scene);
}

/// Times the whole job, from the described scene until the last file is synced to disk.
void side_run_job(const bench_options *options)
{
    glint_error error;
    side_scene scene = side_scene_create(options);
    glint_writer *writer;
    double start = bench_now_ms();
    glint_renderer *renderer = side_renderer_create(options);
    side_must(glint_writer_create(2, options->threads, &writer, &error), &error);
    for (int frame = 0; frame < BENCH_FRAMES; frame++) {
        side_scene_set_frame(&scene, options->change, frame);
        glint_plan *plan = side_plan_create(&scene, options);
        glint_image *image;
        side_must(glint_render(renderer, plan, &image, NULL, &error), &error);
        char path[512];
        snprintf(path, sizeof path, "%s/%04d.png", options->out, frame + 1);
        glint_write_desc d = write_desc(path, GLINT_ENCODE_FAST);
        side_must(glint_writer_submit(writer, image, &d, NULL, &error), &error);
        glint_image_release(image);
        glint_plan_destroy(plan);
    }
    for (glint_write_result result; glint_writer_collect(writer, true, &result);)
        if (result.status != GLINT_OK)
            bench_fail("glint", result.message);
    bench_say("job", "s", (bench_now_ms() - start) / 1e3);
    bench_say("cpu", "s", bench_processor_ms() / 1e3);
    glint_writer_destroy(writer);
    glint_renderer_destroy(renderer);
    side_scene_free(&scene);
}
