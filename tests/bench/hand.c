/// The hand-written program: what an expert writes in an afternoon for this one job, and so a fair limit to compare
/// with. Sixteen rays per vector in AVX-512, float throughout with fused multiply-add and -ffast-math, no BVH, hard
/// shadows, a polynomial power, 8-bit sRGB without a lookup table in memory, PNG with zlib at level 1, frames of a
/// job in parallel. It takes liberties that glint does not: some hundred pixels at shadows and horizon are wrong
/// (float against a ground of radius 10000), and its files are not synced.
///
///   hand frame [scene=workshop] [threads=N] [samples=N] [shadows=0] [area=1]    ms to linear light, and to pixel
///   values
///   hand job change=light|shininess out=FOLDER [threads=N]                      seconds for 60 PNGs
///   hand encode                                                                 ms and kB of one PNG
///   hand program                                                                ns per point of Phong's shader
///   hand picture out=FILE
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/bench/hand_program.h"
#include "tests/bench/packet_light.h"
#include "tests/bench/picture.h"

enum { SPHERE_MAX = 16 };
#define FAR 1e30F
#define NEAR 1e-3F

typedef struct hand_scene {
    int count;
    float from_eye[SPHERE_MAX][3], eye_power[SPHERE_MAX]; ///< the centre minus the eye; the squared length of
        ///< that vector minus the squared radius
    float center[SPHERE_MAX][3], square_radius[SPHERE_MAX];
    vf x, y, z, inverse_radius; ///< tables with one entry per sphere
    vi material;
} hand_scene;

static inline packet_hit trace(const packet_scene *s, vec dir)
{
    const hand_scene *h = s->side;
    vf nearest = all(FAR);
    vi id = _mm512_setzero_si512();
    for (int i = 0; i < h->count; i++) {
        const float *c = h->from_eye[i];
        vf along = dir.x * all(c[0]) + dir.y * all(c[1]) + dir.z * all(c[2]);
        vf square = along * along - all(h->eye_power[i]);
        vm meets = _mm512_cmp_ps_mask(square, all(0), _CMP_GT_OQ);
        if (!meets)
            continue;
        vf t = along - _mm512_maskz_sqrt_ps(meets, square);
        vm closer = _mm512_mask_cmp_ps_mask(meets & less(all(NEAR), t), t, nearest, _CMP_LT_OQ);
        nearest = pick(closer, t, nearest);
        id = _mm512_mask_set1_epi32(id, closer, i);
    }
    packet_hit hit = { .mask = less(nearest, all(FAR)) };
    vec center = { look_up(h->x, id), look_up(h->y, id), look_up(h->z, id) };
    hit.point = add_scaled(s->eye, dir, nearest);
    hit.normal = scaled(minus(hit.point, center), look_up(h->inverse_radius, id));
    hit.material = _mm512_permutexvar_epi32(id, h->material);
    return hit;
}

/// A sphere occludes the light if the segment's line hits it between the two ends, assuming neither end is inside.
/// The point's own sphere is behind the point and fails the first test.
static inline vm hidden(const packet_scene *s, vec point, vec l, vf distance, vm mask)
{
    const hand_scene *h = s->side;
    vm dark = 0;
    for (int i = 0; i < h->count; i++) {
        const float *c = h->center[i];
        vec to = { all(c[0]) - point.x, all(c[1]) - point.y, all(c[2]) - point.z };
        vf along = dot(to, l);
        vm between = _mm512_cmp_ps_mask(along, all(NEAR), _CMP_GT_OQ);
        vf off = dot(to, to) - along * along;
        dark |= _mm512_mask_cmp_ps_mask(between & less(along, distance), off, all(h->square_radius[i]), _CMP_LT_OQ);
    }
    return dark & mask;
}

static void init(packet_scene *s, hand_scene *h, const bench_options *options)
{
    packet_scene_init(s, options);
    if (s->plain.sphere_count == 0 || s->plain.sphere_count > SPHERE_MAX)
        bench_fail(options->scene, "1 .. 16 spheres expected");
    h->count = (int)s->plain.sphere_count;
    float table[4][16] = { { 0 } };
    int32_t material[16] = { 0 };
    for (int i = 0; i < h->count; i++) {
        const float *p = s->plain.spheres + 4 * i;
        double square = 0;
        for (int c = 0; c < 3; c++) {
            table[c][i] = h->center[i][c] = p[c];
            h->from_eye[i][c] = p[c] - s->plain.eye[c];
            square += (double)h->from_eye[i][c] * (double)h->from_eye[i][c];
        }
        table[3][i] = 1 / p[3];
        h->square_radius[i] = p[3] * p[3];
        h->eye_power[i] = (float)(square - (double)p[3] * (double)p[3]);
        material[i] = (int32_t)s->plain.sphere_material[i];
    }
    h->x = _mm512_loadu_ps(table[0]);
    h->y = _mm512_loadu_ps(table[1]);
    h->z = _mm512_loadu_ps(table[2]);
    h->inverse_radius = _mm512_loadu_ps(table[3]);
    h->material = _mm512_loadu_si512(material);
    s->side = h;
}

// ---- One frame ----

static picture shown;

static double time_render(void *scene)
{
    double start = bench_now_ms();
    packet_frame(scene, render_band, NULL, NULL);
    return bench_now_ms() - start;
}

static double time_codes(void *scene)
{
    double start = bench_now_ms();
    packet_frame(scene, render_band, picture_tone, &shown);
    return bench_now_ms() - start;
}

static picture_writer *writer;

static double time_encode(void *bytes)
{
    double start = bench_now_ms();
    picture_encode(writer, &shown, bytes);
    return bench_now_ms() - start;
}

static double time_libpng(void *bytes)
{
    double start = bench_now_ms();
    picture_encode_libpng(writer, &shown, bytes);
    return bench_now_ms() - start;
}

static void run_encode(const packet_scene *s)
{
    size_t size;
    packet_frame(s, render_band, picture_tone, &shown);
    bench_say("zlib", "ms", bench_median(time_encode, &size));
    bench_say("zlib_size", "kB", (double)size / 1000);
    bench_say("libpng", "ms", bench_median(time_libpng, &size));
    bench_say("libpng_size", "kB", (double)size / 1000);
}

static void write_shown(const char *path)
{
    size_t size;
    const uint8_t *bytes = picture_encode(writer, &shown, &size);
    picture_write(bytes, size, path);
}

// ---- A job: frames in parallel, each thread with its own state ----

typedef struct job {
    const packet_scene *scene;
    atomic_int next;
} job;

static void set_frame(packet_scene *s, int frame)
{
    if (strcmp(s->options.change, "shininess") == 0) {
        packet_scene_set_materials(s, (float)bench_job_shininess(frame));
        return;
    }
    double position[3];
    bench_job_light(frame, position);
    for (int c = 0; c < 3; c++)
        s->light[c] = (float)position[c];
}

static void *work(void *argument)
{
    job *j = argument;
    packet_scene scene = *j->scene;
    scene.options.threads = 1;
    picture *codes = malloc(sizeof *codes);
    picture_writer *own = picture_writer_create();
    if (!codes)
        bench_fail("job", "out of memory");
    for (int frame; (frame = atomic_fetch_add(&j->next, 1)) < BENCH_FRAMES;) {
        set_frame(&scene, frame);
        packet_frame(&scene, render_band, picture_tone, codes);
        char path[512];
        snprintf(path, sizeof path, "%s/%04d.png", scene.options.out, frame + 1);
        size_t size;
        const uint8_t *bytes = picture_encode(own, codes, &size);
        picture_write(bytes, size, path);
    }
    picture_writer_destroy(own);
    free(codes);
    return NULL;
}

static void run_job(const packet_scene *s)
{
    job j = { .scene = s };
    pthread_t threads[64];
    double start = bench_now_ms();
    for (int i = 1; i < s->options.threads; i++)
        if (pthread_create(&threads[i], NULL, work, &j))
            bench_fail("threads", "cannot be started");
    work(&j);
    for (int i = 1; i < s->options.threads; i++)
        pthread_join(threads[i], NULL);
    bench_say("job", "s", (bench_now_ms() - start) / 1e3);
    bench_say("cpu", "s", bench_processor_ms() / 1e3);
}

int main(int argc, char **argv)
{
    bench_options options = bench_options_read(argc, argv);
    static packet_scene scene;
    static hand_scene spheres;
    init(&scene, &spheres, &options);
    writer = picture_writer_create();
    if (strcmp(options.mode, "frame") == 0) {
        bench_say_render(time_render, &scene);
        bench_say("codes", "ms", bench_median(time_codes, &scene));
    } else if (strcmp(options.mode, "encode") == 0) {
        run_encode(&scene);
    } else if (strcmp(options.mode, "job") == 0 && options.out) {
        run_job(&scene);
    } else if (strcmp(options.mode, "program") == 0) {
        hand_run_program();
    } else if (strcmp(options.mode, "picture") == 0 && options.out) {
        time_codes(&scene);
        write_shown(options.out);
    } else {
        bench_fail(options.mode, "frame, encode, program, job out=FOLDER or picture out=FILE expected");
    }
    picture_writer_destroy(writer);
    packet_scene_free(&scene);
    return 0;
}
