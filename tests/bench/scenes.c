#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/bench/scenes.h"

#define PI 3.14159265358979323846

static void *need(size_t count, size_t size)
{
    void *memory = calloc(count, size);
    if (!memory) {
        fprintf(stderr, "bench: out of memory\n");
        exit(1);
    }
    return memory;
}

static void set3(float out[3], float x, float y, float z)
{
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

static void make_spheres(bench_scene *s, size_t count)
{
    s->sphere_count = count;
    s->spheres = need(count, 4 * sizeof *s->spheres);
    s->sphere_material = need(count, sizeof *s->sphere_material);
}

// ---- The workshop: scripts/workshop.lua ----

static void make_workshop(bench_scene *s, size_t count)
{
    static const float spheres[5][4] = { { 0, -10000, 0, 10000 },
                                         { -1, 4, -4.5F, 4 },
                                         { 5.8F, 3, -1, 3 },
                                         { -6.6F, 2.5F, 0.5F, 2.5F },
                                         { 0.6F, 2, 4.2F, 2 } };
    static const bench_material materials[5] = {
        { .diffuse = { 0.42F, 0.40F, 0.37F }, .specular = 0, .shininess = 128 },
        { .diffuse = { 0.70F, 0.10F, 0.08F }, .specular = 0.7F, .shininess = 128 },
        { .diffuse = { 0.85F, 0.55F, 0.10F }, .specular = 0.7F, .shininess = 128 },
        { .diffuse = { 0.10F, 0.35F, 0.62F }, .specular = 0.7F, .shininess = 128 },
        { .diffuse = { 0.16F, 0.48F, 0.20F }, .specular = 0.7F, .shininess = 128 },
    };
    make_spheres(s, count);
    memcpy(s->spheres, spheres, sizeof spheres);
    memcpy(s->materials, materials, sizeof materials);
    s->material_count = 5;
    for (uint32_t i = 0; i < 5; i++)
        s->sphere_material[i] = i;
    set3(s->eye, 0, 6.2F, 20.5F);
    set3(s->at, 0, 3.8F, 0);
    s->fov_y_degrees = 42;
    set3(s->light, 0, 20, 0);
    s->lens_radius = 0.6F;
    s->lens_focus = 17;
}

/// The workshop with a glass ball in front.
static void make_glass_ball(bench_scene *s, size_t count)
{
    make_workshop(s, count);
    s->materials[count - 1] = (bench_material) { .transmission = 0.9F };
}

/// splitmix64, as a 24-bit number in 0 .. 1.
static float random_unit(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (float)((z ^ (z >> 31)) >> 40) * 0x1p-24F;
}

// ---- Mirrors and glass ----

static void make_glass(bench_scene *s, size_t count)
{
    static const bench_material materials[4] = { { .diffuse = { 0.45F, 0.42F, 0.38F } },
                                                 { .diffuse = { 0.1F, 0.1F, 0.12F }, .mirror = 0.8F },
                                                 { .transmission = 0.9F },
                                                 { .diffuse = { 0.7F, 0.3F, 0.1F } } };
    uint64_t state = 24;
    memcpy(s->materials, materials, sizeof materials);
    s->material_count = 4;
    make_spheres(s, count + 1);
    s->spheres[1] = -10000;
    s->spheres[3] = 10000;
    for (uint32_t i = 1; i <= count; i++) {
        float *p = s->spheres + 4 * i, radius = 0.7F + 0.5F * random_unit(&state);
        set3(p, 2.6F * ((float)((i - 1) % 6) - 2.5F), radius + random_unit(&state), 2.6F * ((float)((i - 1) / 6) - 2));
        p[3] = radius;
        s->sphere_material[i] = 1 + i % 3;
    }
    set3(s->eye, 0, 6, 15);
    set3(s->at, 0, 0.8F, -1);
    s->fov_y_degrees = 42;
    set3(s->light, 6, 20, 8);
}

// ---- Many spheres, in a box of 32 x 18 x 18 seen from outside ----

static void make_palette(bench_scene *s, uint64_t *state)
{
    s->material_count = BENCH_MATERIALS;
    for (int m = 0; m < BENCH_MATERIALS; m++) {
        bench_material *p = &s->materials[m];
        for (int c = 0; c < 3; c++)
            p->diffuse[c] = 0.1F + 0.7F * random_unit(state);
        p->specular = m % 2 ? 0.5F : 0;
        p->shininess = (float)(8 << (m % 5));
    }
}

/// Adds a cloud of spheres. The radii scale with the mean spacing, so that clouds of any count cover about the same
/// share of the picture.
static void make_cloud(bench_scene *s, size_t count)
{
    static const float size[3] = { 32, 18, 18 };
    uint64_t state = count;
    make_palette(s, &state);
    make_spheres(s, count);
    float spacing = (float)cbrt((double)(size[0] * size[1] * size[2]) / (double)count);
    for (size_t i = 0; i < count; i++) {
        float *p = s->spheres + 4 * i;
        for (int c = 0; c < 3; c++)
            p[c] = (random_unit(&state) - 0.5F) * size[c];
        p[3] = spacing * (0.125F + 0.25F * random_unit(&state));
        s->sphere_material[i] = (uint32_t)i % BENCH_MATERIALS;
    }
    set3(s->eye, 0, 6, 42);
    s->fov_y_degrees = 36;
    set3(s->light, 25, 30, 30);
}

/// Makes a whole box of particles in an orthographic view, as materials scientists look at them.
static void make_box(bench_scene *s, size_t count)
{
    make_cloud(s, count);
    s->height = 18;
}

/// Makes the same box, seen and lit from inside.
static void make_inside(bench_scene *s, size_t count)
{
    make_cloud(s, count);
    set3(s->eye, 0, 0, 0);
    set3(s->at, 1, 0.1F, 0.2F);
    s->fov_y_degrees = 70;
    set3(s->light, 2, 1, 0.5F);
}

/// Makes a chain of balls connected by rods; every fourth ball has a tip.
static void make_molecule(bench_scene *s, size_t count)
{
    uint64_t state = count;
    float at[3] = { 0, 0, 0 }, next[3];
    make_palette(s, &state);
    make_spheres(s, count);
    s->solids = need(count + count / 4, sizeof *s->solids);
    for (size_t i = 0; i < count; i++) {
        float *ball = s->spheres + 4 * i, far;
        do {
            far = 0;
            for (int c = 0; c < 3; c++) {
                next[c] = at[c] + 1.6F * (random_unit(&state) - 0.5F);
                far += next[c] * next[c];
            }
        } while (!(far < 81));
        s->sphere_material[i] = (uint32_t)i % BENCH_MATERIALS;
        set3(ball, next[0], next[1], next[2]);
        ball[3] = 0.3F + 0.15F * random_unit(&state);
        bench_solid rod = { .kind = BENCH_ROD, .material = s->sphere_material[i], .size = 0.12F }, tip = { .kind = BENCH_TIP, .size = 0.3F };
        memcpy(rod.center, at, sizeof at);
        memcpy(rod.ball, next, sizeof next);
        memcpy(tip.center, next, sizeof next);
        set3(tip.ball, next[0] + random_unit(&state), next[1] + random_unit(&state), next[2]);
        s->solids[s->solid_count++] = rod;
        if (i % 4 == 3)
            s->solids[s->solid_count++] = tip;
        memcpy(at, next, sizeof at);
    }
    set3(s->eye, 0, 4, 26);
    s->fov_y_degrees = 40;
    set3(s->light, 15, 20, 20);
}

// ---- Spheres on a floor, which shadow it and each other ----

/// Puts spheres on a floor, a 40 x 40 part of the top of a large ball.
/// The radii scale with the spacing, as in a cloud.
static void make_floor(bench_scene *s, size_t count)
{
    static const float ground[4] = { 0, -1000, 0, 1000 }, side = 40;
    uint64_t state = count + 1;
    make_palette(s, &state);
    make_spheres(s, count + 1);
    memcpy(s->spheres, ground, sizeof ground);
    float spacing = side / sqrtf((float)count);
    for (size_t i = 1; i <= count; i++) {
        float *p = s->spheres + 4 * i;
        p[0] = (random_unit(&state) - 0.5F) * side;
        p[2] = (random_unit(&state) - 0.5F) * side;
        p[3] = spacing * (0.15F + 0.3F * random_unit(&state));
        p[1] = p[3] - (p[0] * p[0] + p[2] * p[2]) / 2000;
        s->sphere_material[i] = (uint32_t)i % BENCH_MATERIALS;
    }
    set3(s->eye, 0, 13, 34);
    s->fov_y_degrees = 36;
    set3(s->light, 9, 20, 6);
}

/// Turns the floor's material into a mirror. Other objects with that material become mirrors too.
static void make_mirror_floor(bench_scene *s, size_t count)
{
    make_floor(s, count);
    s->materials[0] = (bench_material) { .diffuse = { 0.1F, 0.1F, 0.12F }, .mirror = 0.8F };
}

/// Makes every second sphere glass.
static void make_glass_floor(bench_scene *s, size_t count)
{
    make_floor(s, count);
    for (int i = 1; i < BENCH_MATERIALS; i += 2)
        s->materials[i] = (bench_material) { .transmission = 0.9F };
}

/// Puts solids of one kind on the floor instead of spheres.
static void make_solids(bench_scene *s, size_t count, bench_solid_kind kind)
{
    uint64_t state = 7 * count;
    make_floor(s, count);
    s->solid_count = count;
    s->solids = need(count, sizeof *s->solids);
    for (size_t i = 0; i < count; i++) {
        const float *ball = s->spheres + 4 * (i + 1);
        bench_solid *solid = &s->solids[i];
        *solid = (bench_solid) { .kind = kind, .material = s->sphere_material[i + 1], .size = ball[3] };
        memcpy(solid->center, ball, sizeof solid->center);
        float length = 0;
        for (int c = 0; c < 3; c++) {
            solid->ball[c] = random_unit(&state) - (c == 1 ? 0 : 0.5F);
            length += solid->ball[c] * solid->ball[c];
        }
        for (int c = 0; c < 3; c++) // the cutting ball is at a corner or an edge of the box's upper side
            solid->ball[c] = kind == BENCH_TORUS ? solid->ball[c] / sqrtf(length)
                                                 : ball[c] + ball[3] * (c == 1 ? 1 : 2 * solid->ball[c]);
        solid->ball[3] = kind == BENCH_TORUS ? (0.2F + 0.3F * random_unit(&state)) * ball[3] : 0.8F * ball[3];
        solid->size = kind == BENCH_TORUS ? ball[3] - solid->ball[3] : ball[3];
    }
    s->sphere_count = 1;
}

static void make_cut(bench_scene *s, size_t count) { make_solids(s, count, BENCH_CUT); }

static void make_pieces(bench_scene *s, size_t count) { make_solids(s, count, BENCH_PIECES); }

static void make_tori(bench_scene *s, size_t count) { make_solids(s, count, BENCH_TORUS); }

static void make_cloud_over_floor(bench_scene *s, size_t count)
{
    static const float ground[4] = { 0, -1009, 0, 1000 };
    make_cloud(s, count + 1);
    memcpy(s->spheres, ground, sizeof ground);
}

// ---- A mesh: a knobbly torus of quads, equally many in both directions ----

static void make_mesh(bench_scene *s, size_t quadrangles)
{
    const uint32_t side = (uint32_t)sqrt((double)quadrangles);
    s->vertex_count = side * side;
    s->triangle_count = 2 * side * side;
    s->vertices = need(s->vertex_count, 3 * sizeof *s->vertices);
    s->triangles = need(s->triangle_count, 3 * sizeof *s->triangles);
    uint32_t *triangle = s->triangles;
    for (uint32_t i = 0; i < side; i++)
        for (uint32_t j = 0; j < side; j++) {
            double u = 2 * PI * i / side, v = 2 * PI * j / side;
            double tube = 2.5 + 0.2 * sin(24 * u) * sin(9 * v), ring = 6 + tube * cos(v);
            set3(s->vertices + 3 * (side * i + j), (float)(ring * cos(u)), (float)(tube * sin(v)),
                 (float)(ring * sin(u)));
            uint32_t a = side * i + j, b = side * i + (j + 1) % side;
            uint32_t c = side * ((i + 1) % side) + j, d = side * ((i + 1) % side) + (j + 1) % side;
            uint32_t two[6] = { a, b, c, b, d, c };
            memcpy(triangle, two, sizeof two);
            triangle += 6;
        }
    s->material_count = 1;
    s->materials[0] = (bench_material) { .diffuse = { 0.6F, 0.5F, 0.4F }, .specular = 0.5F, .shininess = 64 };
    set3(s->eye, 0, 13, 17);
    s->fov_y_degrees = 42;
    set3(s->light, 9, 14, 4);
}

static void make_level_mesh(bench_scene *s, size_t quadrangles)
{
    make_mesh(s, quadrangles);
    s->height = 16;
}

static void make_glass_mesh(bench_scene *s, size_t quadrangles)
{
    make_mesh(s, quadrangles);
    s->materials[0] = (bench_material) { .transmission = 0.9F };
}

static const struct {
    const char *name;
    void (*make)(bench_scene *s, size_t count);
    size_t count;
} scenes[] = { { "workshop", make_workshop, 5 },
               { "glassball", make_glass_ball, 5 },
               { "1k", make_cloud, 1000 },
               { "1M", make_cloud, 1000000 },
               { "over1k", make_cloud_over_floor, 1000 },
               { "over1M", make_cloud_over_floor, 1000000 },
               { "floor100", make_floor, 100 },
               { "floor1k", make_floor, 1000 },
               { "floor1M", make_floor, 1000000 },
               { "mirrorfloor", make_mirror_floor, 1000 },
               { "glassfloor", make_glass_floor, 50 },
               { "glass", make_glass, 24 },
               { "cut1k", make_cut, 1000 },
               { "pieces1k", make_pieces, 1000 },
               { "tori", make_tori, 24 },
               { "box", make_box, 100000 },
               { "inside", make_inside, 100000 },
               { "cloud17k", make_cloud, 17000 },
               { "molecule", make_molecule, 1000 },
               { "glassmesh", make_glass_mesh, 10000 },
               { "mesh", make_mesh, 250000 },
               { "mesh100k", make_mesh, 50176 },
               { "levelmesh", make_level_mesh, 50176 } };

bool bench_scene_create(const char *name, bench_scene *out)
{
    *out = (bench_scene) { .light_radius = 2 };
    set3(out->ambient, 0.16F, 0.17F, 0.20F);
    set3(out->background, 0.28F, 0.45F, 0.69F);
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        if (strcmp(name, scenes[i].name) == 0) {
            scenes[i].make(out, scenes[i].count);
            return true;
        }
    return false;
}

void bench_scene_free(bench_scene *scene)
{
    free(scene->spheres);
    free(scene->sphere_material);
    free(scene->solids);
    free(scene->vertices);
    free(scene->triangles);
}

// ---- Lamps, jobs and the camera ----

void bench_lamp(const bench_scene *scene, int i, int count, double position[3])
{
    const double angle = 2 * PI * i / count, radius = count > 1 ? 13 : 0;
    const double off[3] = { radius * cos(angle), 0, radius * sin(angle) };
    for (int c = 0; c < 3; c++)
        position[c] = (double)scene->light[c] + off[c];
}

void bench_job_light(int frame, double position[3])
{
    double angle = 2 * PI * frame / BENCH_FRAMES;
    position[0] = 13 * cos(angle);
    position[1] = 20;
    position[2] = 13 * sin(angle);
}

double bench_job_shininess(int frame) { return 8 * exp2(frame / 10.0); }

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalise(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int c = 0; c < 3; c++)
        v[c] /= length;
}

bench_camera bench_camera_of(const bench_scene *scene)
{
    bench_camera camera;
    double forward[3], right[3], up[3];
    for (int c = 0; c < 3; c++)
        forward[c] = (double)scene->at[c] - (double)scene->eye[c];
    normalise(forward);
    cross(forward, (double[3]) { 0, 1, 0 }, right);
    normalise(right);
    cross(right, forward, up);
    double pixel = scene->height > 0 ? (double)scene->height / BENCH_HEIGHT
                                     : 2 * tan((double)scene->fov_y_degrees * PI / 360) / BENCH_HEIGHT;
    for (int c = 0; c < 3; c++) {
        camera.right[c] = pixel * right[c];
        camera.down[c] = -pixel * up[c];
        camera.corner[c] = forward[c] - 0.5 * BENCH_WIDTH * camera.right[c] - 0.5 * BENCH_HEIGHT * camera.down[c];
    }
    return camera;
}
