#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "tests/bench/packet.h"

static vec wide_vector(const double v[3]) { return (vec) { all((float)v[0]), all((float)v[1]), all((float)v[2]) }; }

/// Lane k of a block is the pixel (k % 4, k / 4). The lanes of `corner` include the offset of that pixel.
static void set_camera(packet_scene *s)
{
    bench_camera camera = bench_camera_of(&s->plain);
    const vf across = _mm512_setr_ps(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3);
    const vf along = _mm512_setr_ps(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
    s->eye = all3(s->plain.eye);
    s->right = wide_vector(camera.right);
    s->down = wide_vector(camera.down);
    s->corner = add_scaled(add_scaled(wide_vector(camera.corner), s->right, across), s->down, along);
}

/// Places the samples as a Hammersley set: sample k has the coordinates (k + 1/2) / count and the reversed bits of k.
/// A single sample is at the pixel's centre.
static void set_samples(packet_scene *s)
{
    int count = s->options.samples;
    s->sample_weight = 1.0F / (float)count;
    for (int k = 0; k < count; k++) {
        float radical = 0.5F / (float)count;
        for (int bit = 0; bit < 6; bit++)
            radical += (float)(k >> bit & 1) / (float)(2 << bit);
        s->sample[k][0] = ((float)k + 0.5F) / (float)count;
        s->sample[k][1] = radical;
    }
}

/// Places the light's samples on a spiral that covers the sphere evenly, and chooses a rotation of the spiral for
/// each pixel of a block.
static void set_light(packet_scene *s)
{
    const double turn = 2.39996322972865332; // the golden angle
    memcpy(s->light, s->plain.light, sizeof s->light);
    for (int k = 0; k < LIGHT_SAMPLES; k++) {
        double y = 1 - (2 * k + 1.0) / LIGHT_SAMPLES, ring = sqrt(1 - y * y), radius = (double)s->plain.light_radius;
        s->light_offset[k][0] = (float)(radius * ring * cos(turn * k));
        s->light_offset[k][1] = (float)(radius * y);
        s->light_offset[k][2] = (float)(radius * ring * sin(turn * k));
    }
    float cosine[16], sine[16];
    for (int k = 0; k < 16; k++) {
        double angle = turn / 16 * ((7 * k) % 16);
        cosine[k] = (float)cos(angle);
        sine[k] = (float)sin(angle);
    }
    s->turn_cos = _mm512_loadu_ps(cosine);
    s->turn_sin = _mm512_loadu_ps(sine);
}

void packet_scene_set_materials(packet_scene *s, float shininess)
{
    float diffuse[3][16] = { { 0 } }, ambient[3][16] = { { 0 } }, specular[16] = { 0 }, exponent[16] = { 0 };
    for (int m = 0; m < s->plain.material_count; m++) {
        const bench_material *p = &s->plain.materials[m];
        for (int c = 0; c < 3; c++) {
            diffuse[c][m] = p->diffuse[c];
            ambient[c][m] = p->diffuse[c] * s->plain.ambient[c];
        }
        specular[m] = p->specular;
        exponent[m] = shininess > 0 ? shininess : p->shininess;
    }
    for (int c = 0; c < 3; c++) {
        s->diffuse[c] = _mm512_loadu_ps(diffuse[c]);
        s->ambient[c] = _mm512_loadu_ps(ambient[c]);
    }
    s->specular = _mm512_loadu_ps(specular);
    s->shininess = _mm512_loadu_ps(exponent);
}

void packet_scene_init(packet_scene *s, const bench_options *options)
{
    s->options = *options;
    if (!bench_scene_create(options->scene, &s->plain))
        bench_fail(options->scene, "no such scene");
    set_camera(s);
    set_samples(s);
    set_light(s);
    packet_scene_set_materials(s, 0);
}

void packet_scene_free(packet_scene *s) { bench_scene_free(&s->plain); }

// ---- A frame ----

typedef struct frame_job {
    const packet_scene *scene;
    packet_render *render;
    packet_use *use;
    void *user;
    atomic_int next;
} frame_job;

static void *work(void *argument)
{
    frame_job *job = argument;
    packet_band band;
    for (int y; (y = BAND * atomic_fetch_add(&job->next, 1)) < BENCH_HEIGHT;) {
        job->render(job->scene, y, &band);
        if (job->use)
            job->use(job->user, y, &band);
    }
    return NULL;
}

void packet_frame(const packet_scene *scene, packet_render *render, packet_use *use, void *user)
{
    frame_job job = { .scene = scene, .render = render, .use = use, .user = user };
    pthread_t threads[64];
    int others = scene->options.threads - 1;
    for (int i = 0; i < others; i++)
        if (pthread_create(&threads[i], NULL, work, &job))
            bench_fail("threads", "cannot be started");
    work(&job);
    for (int i = 0; i < others; i++)
        pthread_join(threads[i], NULL);
}
