/// Indirect light one ray at a time, in plain C, as written in an hour: an eye ray, a shadow ray, and from the hit
/// some cosine-weighted paths over the hemisphere. The including program defines `nearest`.
#ifndef GLINT_BENCH_PLAIN_PATH_H
#define GLINT_BENCH_PLAIN_PATH_H

#include <math.h>
#include <stdlib.h>

#include "tests/bench/options.h"
#include "tests/bench/scenes.h"

#define NO_SPHERE SIZE_MAX

typedef struct plain_scene {
    bench_scene plain;
    bench_options options;
    void *side; ///< data private to the including program
    float *film; ///< red, green, blue of each pixel
} plain_scene;

/// Returns the nearest sphere that a ray hits before t = *far, except the sphere that the ray leaves, and sets *far
/// to the t of that hit. Returns NO_SPHERE when there is none.
static size_t nearest(const plain_scene *s, const double origin[3], const double dir[3], size_t leaving, double *far);

static double plain_dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void plain_unit(double v[3])
{
    double length = sqrt(plain_dot(v, v));
    for (int c = 0; c < 3; c++)
        v[c] /= length;
}

/// Returns a random number in 0 .. 1, by xorshift.
static double plain_random(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) * 0x1p-53;
}

static void plain_scatter(const double n[3], uint64_t *state, double out[3])
{
    double u = plain_random(state), turn = 6.283185307179586 * plain_random(state);
    double x = sqrt(u) * cos(turn), y = sqrt(u) * sin(turn), h = sqrt(1 - u), g = n[2] < 0 ? -1 : 1;
    double p = -1 / (g + n[2]), q = n[0] * n[1] * p;
    const double a[3] = { 1 + g * n[0] * n[0] * p, g * q, -g * n[0] }, b[3] = { q, g + n[1] * n[1] * p, -n[1] };
    for (int c = 0; c < 3; c++)
        out[c] = x * a[c] + y * b[c] + h * n[c];
}

/// A point on a sphere, and the light that it receives from the lamp.
typedef struct plain_point {
    double at[3], normal[3], lit;
    size_t sphere;
} plain_point;

static plain_point plain_meet(const plain_scene *s, const double origin[3], const double dir[3], double t, size_t sphere)
{
    plain_point p = { .sphere = sphere };
    const float *ball = s->plain.spheres + 4 * sphere;
    double to_light[3];
    for (int c = 0; c < 3; c++) {
        p.at[c] = origin[c] + t * dir[c];
        p.normal[c] = (p.at[c] - (double)ball[c]) / (double)ball[3];
        to_light[c] = (double)s->plain.light[c] - p.at[c];
    }
    double distance = sqrt(plain_dot(to_light, to_light)), far = 1, cosine = plain_dot(p.normal, to_light) / distance;
    if (cosine > 0 && nearest(s, p.at, to_light, sphere, &far) == NO_SPHERE)
        p.lit = cosine;
    return p;
}

static double plain_surface(const plain_scene *s, const plain_point *p, int c, double ambient)
{
    const bench_material *m = &s->plain.materials[s->plain.sphere_material[p->sphere]];
    return (double)m->diffuse[c] * (p->lit + ambient * (double)s->plain.ambient[c]);
}

static void plain_pixel(const plain_scene *s, const double eye[3], const double dir[3], uint64_t *state, float out[3])
{
    double t = HUGE_VAL, sum[3] = { 0 };
    size_t sphere = nearest(s, eye, dir, NO_SPHERE, &t);
    for (int c = 0; c < 3; c++)
        out[c] = s->plain.background[c];
    if (sphere == NO_SPHERE)
        return;
    plain_point p = plain_meet(s, eye, dir, t, sphere);
    for (int k = 0; k < s->options.indirect; k++) {
        double way[3], far = HUGE_VAL;
        plain_scatter(p.normal, state, way);
        size_t other = nearest(s, p.at, way, sphere, &far);
        plain_point q = { 0 };
        if (other != NO_SPHERE)
            q = plain_meet(s, p.at, way, far, other);
        for (int c = 0; c < 3; c++)
            sum[c] += other == NO_SPHERE ? (double)s->plain.background[c] : plain_surface(s, &q, c, 1);
    }
    const bench_material *m = &s->plain.materials[s->plain.sphere_material[sphere]];
    for (int c = 0; c < 3; c++)
        out[c] = (float)(plain_surface(s, &p, c, 0) + (double)m->diffuse[c] * sum[c] / s->options.indirect);
}

static double plain_frame(void *scene)
{
    const plain_scene *s = scene;
    bench_camera camera = bench_camera_of(&s->plain);
    uint64_t state = 88172645463325252u;
    const double eye[3] = { (double)s->plain.eye[0], (double)s->plain.eye[1], (double)s->plain.eye[2] };
    double start = bench_now_ms();
    for (int y = 0; y < BENCH_HEIGHT; y++)
        for (int x = 0; x < BENCH_WIDTH; x++) {
            double dir[3];
            for (int c = 0; c < 3; c++)
                dir[c] = camera.corner[c] + (x + 0.5) * camera.right[c] + (y + 0.5) * camera.down[c];
            plain_unit(dir);
            plain_pixel(s, eye, dir, &state, s->film + 3 * ((size_t)y * BENCH_WIDTH + (size_t)x));
        }
    return bench_now_ms() - start;
}

/// Prints the frame's time, and the mean light of its pixels, which equals glint's within the noise.
static void plain_measure(plain_scene *s)
{
    double sum = 0;
    size_t count = (size_t)3 * BENCH_WIDTH * BENCH_HEIGHT;
    s->film = malloc(count * sizeof *s->film);
    if (!s->film)
        bench_fail("plain", "out of memory");
    bench_say("render", "ms", plain_frame(s)); // takes seconds: one run is enough
    for (size_t i = 0; i < count; i++)
        sum += (double)s->film[i];
    bench_say("light", "-", sum / (double)count);
    free(s->film);
}

static plain_scene plain_scene_create(int argc, char **argv)
{
    plain_scene s = { .options = bench_options_read(argc, argv) };
    if (s.options.indirect == 0)
        bench_fail("indirect", "1 or more expected");
    if (!bench_scene_create(s.options.scene, &s.plain) || s.plain.sphere_count == 0)
        bench_fail(s.options.scene, "no scene of spheres");
    return s;
}

#endif
