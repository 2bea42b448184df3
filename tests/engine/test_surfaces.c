/// Meshes, solids, transforms and groups: identical pictures on every instruction set, no cracks between neighbours,
/// no light leaks at edges, no self-shadowing of flat meshes, distances and normals against 113-bit arithmetic, and
/// .obj files with their errors.
#include "engine/glint.h"
#include "engine/glint_files.h"
#include "engine/glint_inspect.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "tests/engine/quad.h"
#include "tests/engine/cases/random.h"
#include "tests/engine/cases/sets.h"

static void random_vector(double v[3], double size)
{
    for (int c = 0; c < 3; c++)
        v[c] = between(-size, size);
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void random_turn(double m[3][3])
{
    double length;
    random_vector(m[0], 1);
    random_vector(m[1], 1);
    length = sqrt(dot(m[0], m[0]));
    for (int c = 0; c < 3; c++)
        m[0][c] /= length;
    const double along = dot(m[0], m[1]);
    for (int c = 0; c < 3; c++)
        m[1][c] -= along * m[0][c];
    length = sqrt(dot(m[1], m[1]));
    for (int c = 0; c < 3; c++)
        m[1][c] /= length;
    for (int c = 0; c < 3; c++)
        m[2][c] = m[0][(c + 1) % 3] * m[1][(c + 2) % 3] - m[0][(c + 2) % 3] * m[1][(c + 1) % 3];
}

// ---- Test scenes ----

enum { MOST = 4096 };

typedef struct soup {
    double vertices[MOST][3];
    uint32_t corners[4 * MOST], sizes[MOST];
    size_t vertex_count, corner_count, face_count;
} soup;

static glint_shape *mesh_of(const soup *s, glint_shading shading, bool two_sided)
{
    glint_shape *shape = NULL;
    glint_error error = { .message = "" };
    glint_mesh_desc d = glint_mesh_desc_default();
    d.vertices = &s->vertices[0][0];
    d.vertex_count = s->vertex_count;
    d.corners = s->corners;
    d.face_sizes = s->sizes;
    d.face_count = s->face_count;
    d.has_shading = true;
    d.shading = shading;
    d.two_sided = two_sided;
    if (glint_mesh_create(&d, &shape, &error))
        fail_msg("%s", error.message);
    return shape;
}

static void add_face(soup *s, uint32_t size, const uint32_t *corners)
{
    memcpy(s->corners + s->corner_count, corners, size * sizeof *corners);
    s->corner_count += size;
    s->sizes[s->face_count++] = size;
}

/// Random triangles, some of them slivers, some sharing corners.
static void make_soup(soup *s, size_t triangles)
{
    memset(s, 0, sizeof *s);
    for (size_t i = 0; i < triangles; i++) {
        const uint32_t n = (uint32_t)s->vertex_count;
        double center[3], size = pow(10, between(-2, 0.5));
        random_vector(center, 4);
        for (int j = 0; j < 3; j++) {
            random_vector(s->vertices[n + (uint32_t)j], size);
            for (int c = 0; c < 3; c++)
                s->vertices[n + (uint32_t)j][c] += center[c];
        }
        if (i > 0 && below(3) == 0)
            memcpy(s->vertices[n], s->vertices[n - 1], sizeof s->vertices[n]);
        s->vertex_count += 3;
        add_face(s, 3, (const uint32_t[]) { n, n + 1, n + 2 });
    }
}

/// Makes a closed box of n x n quads per side. `roundness` pushes its vertices towards a sphere.
static void make_box(soup *s, uint32_t n, double half, double roundness, double m[3][3])
{
    memset(s, 0, sizeof *s);
    static uint32_t number[33][33][33];
    assert_true(n <= 32);
    for (uint32_t x = 0; x <= n; x++)
        for (uint32_t y = 0; y <= n; y++)
            for (uint32_t z = 0; z <= n; z++) {
                if (x % n && y % n && z % n)
                    continue;
                const double p[3] = { 2.0 * x / n - 1, 2.0 * y / n - 1, 2.0 * z / n - 1 };
                const double push = half * pow(sqrt(dot(p, p)), -roundness);
                number[x][y][z] = (uint32_t)s->vertex_count;
                for (int c = 0; c < 3; c++)
                    s->vertices[s->vertex_count][c] = push * ((p[0] * m[0][c] + p[1] * m[1][c]) + p[2] * m[2][c]);
                s->vertex_count++;
            }
    for (int axis = 0; axis < 3; axis++)
        for (uint32_t side = 0; side < 2; side++)
            for (uint32_t i = 0; i < n; i++)
                for (uint32_t j = 0; j < n; j++) {
                    uint32_t corner[4], at[3];
                    for (uint32_t k = 0; k < 4; k++) {
                        at[axis] = side * n;
                        at[(axis + 1) % 3] = i + (k == 1 || k == 2);
                        at[(axis + 2) % 3] = j + (k >= 2);
                        corner[side ? k : 3 - k] = number[at[0]][at[1]][at[2]];
                    }
                    add_face(s, 4, corner);
                }
}

#define PARALLEL 1234 ///< this value of at[2] selects an orthographic camera

static bool soft_light; ///< whether the next scene has a soft light

static glint_scene *new_scene(const double eye[3], const double at[3], double fov, const double light[3], bool shadows)
{
    glint_scene *scene;
    glint_camera *camera;
    glint_light *lamp;
    glint_camera_desc c = glint_camera_desc_default();
    memcpy(c.eye, eye, sizeof c.eye);
    memcpy(c.at, at, sizeof c.at);
    c.fov_y_rad = fov;
    if (at[2] == PARALLEL) { // looks along z; with 129 pixels across, every eighth ray is at an integer
        c.projection = GLINT_PROJECTION_ORTHOGRAPHIC;
        c.has_direction = true;
        c.direction[2] = -1;
        c.height = 129 / 16.0;
    }
    glint_light_desc l = glint_light_desc_default(soft_light ? GLINT_LIGHT_SPHERE : GLINT_LIGHT_POINT);
    l.radius = 0.5;
    l.samples = 5;
    memcpy(l.position, light, sizeof l.position);
    l.shadows = shadows;
    assert_int_equal(glint_scene_create(&scene, NULL), GLINT_OK);
    assert_int_equal(glint_camera_create(&c, &camera, NULL), GLINT_OK);
    assert_int_equal(glint_light_create(&l, &lamp, NULL), GLINT_OK);
    assert_int_equal(glint_scene_set(scene, &(glint_scene_desc) { .struct_size = sizeof(glint_scene_desc), .camera = camera }, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_light(scene, lamp, NULL), GLINT_OK);
    glint_camera_release(camera);
    glint_light_release(lamp);
    return scene;
}

static void add(glint_scene *scene, glint_shape *shape)
{
    assert_int_equal(glint_scene_add_shape(scene, shape, NULL), GLINT_OK);
    glint_shape_release(shape);
}

static glint_image *render(const glint_scene *scene, const char *isa, int threads, int size, glint_precision precision)
{
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
    glint_renderer_desc r = { .struct_size = sizeof(glint_renderer_desc), .threads = threads, .isa = isa };
    glint_render_desc d = glint_render_desc_default();
    glint_error error;
    d.width = d.height = size;
    d.precision = precision;
    d.passes = 1u << GLINT_PASS_BEAUTY | 1u << GLINT_PASS_DEPTH | 1u << GLINT_PASS_NORMAL | 1u << GLINT_PASS_OBJECT_ID;
    glint_status status = glint_renderer_create(&r, &renderer, &error);
    if (status == GLINT_ERR_UNSUPPORTED)
        return NULL;
    assert_int_equal(status, GLINT_OK);
    assert_int_equal(glint_plan_create(scene, &d, &plan, &error), GLINT_OK);
    assert_int_equal(glint_render(renderer, plan, &image, NULL, &error), GLINT_OK);
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    return image;
}

static int differing(const glint_image *a, const glint_image *b)
{
    static const glint_pass passes[] = { GLINT_PASS_BEAUTY, GLINT_PASS_DEPTH, GLINT_PASS_NORMAL, GLINT_PASS_OBJECT_ID };
    int count = 0;
    for (int pass = 0; pass < 4; pass++)
        for (int y = 0; y < glint_image_height(a); y++)
            for (int x = 0; x < glint_image_width(a); x++) {
                float p[3], q[3];
                glint_image_pixel(a, passes[pass], x, y, p, NULL);
                glint_image_pixel(b, passes[pass], x, y, q, NULL);
                count += memcmp(p, q, sizeof p) != 0;
            }
    return count;
}

// ---- Identical on every instruction set ----

/// Makes a random invertible map: rotation, stretch, reflection and translation.
static glint_transform random_map(double move)
{
    double a[3][3], b[3][3];
    glint_transform out = { { { 0 } } };
    random_turn(a);
    random_turn(b);
    const bool even = below(3) == 0;
    const double s[3] = { between(0.3, 2), even ? 0 : between(0.2, 3), even ? 0 : -between(0.5, 2) };
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                out.m[i][j] += a[i][k] * (even ? s[0] : s[k]) * b[k][j];
        out.m[i][3] = between(-move, move);
    }
    return out;
}

/// Makes a random solid. A `capped` solid is certainly closed.
static glint_shape *random_solid(int kind, bool capped)
{
    glint_shape *shape;
    glint_shape_desc d = glint_shape_desc_default((glint_shape_kind)kind);
    random_vector(d.center, 2);
    random_vector(d.normal, 1);
    random_vector(d.base, 2);
    random_vector(d.top, 2);
    for (int c = 0; c < 3; c++) {
        d.min[c] = between(-1.5, 0);
        d.max[c] = between(0.2, 1.5);
    }
    random_vector(d.axis, 1);
    d.radius = between(0.2, 1.5);
    d.major = between(0.4, 1.5);
    d.minor = between(0.1, 0.9) * d.major;
    d.two_sided = below(2);
    d.capped = capped || below(2);
    if (below(4))
        d.transform = random_map(2);
    assert_int_equal(glint_shape_create(&d, &shape, NULL), GLINT_OK);
    return shape;
}

/// Makes a group of solids and spheres under random maps; some occur twice.
static glint_shape *random_group(uint32_t count)
{
    static const int kinds[] = { GLINT_SHAPE_SPHERE, GLINT_SHAPE_BOX, GLINT_SHAPE_DISK, GLINT_SHAPE_CYLINDER,
                                 GLINT_SHAPE_CONE, GLINT_SHAPE_TORUS };
    glint_shape *outer, *inner;
    glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_GROUP);
    assert_int_equal(glint_shape_create(&d, &outer, NULL), GLINT_OK);
    d.transform = random_map(3);
    assert_int_equal(glint_shape_create(&d, &inner, NULL), GLINT_OK);
    for (uint32_t i = 0; i < count; i++) {
        glint_shape *shape = random_solid(kinds[below(6)], false);
        assert_int_equal(glint_group_add(outer, shape, NULL), GLINT_OK);
        if (below(2))
            assert_int_equal(glint_group_add(inner, shape, NULL), GLINT_OK);
        glint_shape_release(shape);
    }
    assert_int_equal(glint_group_add(outer, inner, NULL), GLINT_OK);
    glint_shape_release(inner);
    return outer;
}

static glint_scene *random_scene(uint64_t seed)
{
    static soup s;
    double eye[3], light[3], m[3][3];
    random_state = seed;
    random_vector(eye, 9);
    random_vector(light, 9);
    soft_light = below(3) == 0;
    const double at[3] = { 0, 0, below(4) ? 0 : PARALLEL };
    glint_scene *scene = new_scene(eye, at, between(0.3, 1.5), light, true);
    make_soup(&s, 1 + below(60));
    add(scene, mesh_of(&s, (glint_shading)below(4), below(2)));
    random_turn(m);
    make_box(&s, 1 + below(6), between(0.5, 3), below(2), m);
    add(scene, mesh_of(&s, (glint_shading)below(4), below(2)));
    add(scene, random_group(below(8)));
    soft_light = false;
    return scene;
}

static void same_on_every_instruction_set(void **unused)
{
    (void)unused;
    for (uint64_t seed = 1; seed <= 40; seed += case_step())
        for (int precision = 0; precision < 2; precision++) {
            glint_scene *scene = random_scene(seed);
            glint_image *want = render(scene, "ref", 1, 50, (glint_precision)precision);
            for (size_t i = FIRST_KERNELS; i < INSTRUCTION_SETS; i++) {
                glint_image *got = render(scene, instruction_sets[i], (int)i, 50, (glint_precision)precision);
                if (got && differing(want, got))
                    fail_msg("seed %d, %s, precision %d: %d pixels", (int)seed, instruction_sets[i], precision,
                             differing(want, got));
                glint_image_release(got);
            }
            glint_image_release(want);
            glint_scene_release(scene);
        }
}

// ---- No cracks between neighbours ----

/// From inside a closed mesh every ray hits: towards its corners, its edges, points next to them, and anywhere else.
static void no_cracks(void **unused)
{
    static soup s;
    (void)unused;
    for (uint64_t seed = 1; seed <= 60; seed++) {
        random_state = seed;
        double m[3][3], eye[3], offset = below(2) ? 0 : pow(10, between(0, 6));
        random_turn(m);
        make_box(&s, 1 + below(8), 1, below(2), m);
        for (size_t i = 0; i < s.vertex_count; i++)
            for (int c = 0; c < 3; c++)
                s.vertices[i][c] += offset;
        random_vector(eye, 0.4);
        for (int c = 0; c < 3; c++)
            eye[c] += offset;
        glint_scene *scene = new_scene(eye, (double[3]) { 9, 9, 9 }, 1, eye, true);
        add(scene, mesh_of(&s, GLINT_SHADING_FACETED, true));
        for (int k = 0; k < 3000; k += (int)case_step()) {
            const size_t face = below((uint32_t)s.face_count);
            const double *a = s.vertices[s.corners[4 * face + below(4)]];
            const uint32_t turn = below(4);
            const double *b = s.vertices[s.corners[4 * face + turn]],
                         *c = s.vertices[s.corners[4 * face + (turn + 1) % 4]];
            double d[3], w = between(0, 1);
            for (int i = 0; i < 3; i++)
                d[i] = k % 3 == 0 ? a[i] - eye[i] : (b[i] + w * (c[i] - b[i])) - eye[i];
            if (k % 2)
                d[below(3)] *= 1 + between(-4, 4) * DBL_EPSILON;
            bool hit = false;
            glint_hit where;
            assert_int_equal(glint_scene_cast(scene, eye, d, &hit, &where, NULL), GLINT_OK);
            if (!hit)
                fail_msg("seed %d: a ray got through", (int)seed);
        }
        glint_scene_release(scene);
    }
}

/// Renders from inside a closed box, with corners and edges on the pixels' rays: no light leaks in.
static void no_light_by_an_edge(void **unused)
{
    static soup s;
    (void)unused;
    for (uint64_t seed = 1; seed <= 40; seed += case_step()) {
        random_state = seed;
        double m[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, light[3];
        const double eye[3] = { 0, 0, 0 }, at[3] = { 0, 0, -1 };
        if (seed % 2)
            random_turn(m);
        make_box(&s, 1 + below(5), 1, seed % 3 ? 0 : 1, m);
        random_vector(light, 6);
        light[below(3)] = 3;
        glint_scene *scene = new_scene(eye, at, 2 * atan(1 + below(2)), light, true);
        add(scene, mesh_of(&s, GLINT_SHADING_FACETED, true));
        for (int precision = 0; precision < 2; precision++) {
            glint_image *image = render(scene, NULL, 1, 129, (glint_precision)precision);
            glint_image *same = render(scene, seed % 8 ? "generic" : "ref", 1, 129, (glint_precision)precision);
            assert_int_equal(differing(image, same), 0);
            glint_image_release(same);
            for (int y = 0; y < 129; y++)
                for (int x = 0; x < 129; x++) {
                    float p[3], id[3];
                    glint_image_pixel(image, GLINT_PASS_BEAUTY, x, y, p, NULL);
                    glint_image_pixel(image, GLINT_PASS_OBJECT_ID, x, y, id, NULL);
                    if (p[0] != 0 || id[0] != 1)
                        fail_msg("seed %d precision %d: light at %d, %d", (int)seed, precision, x, y);
                }
            glint_image_release(image);
        }
        glint_scene_release(scene);
    }
}

/// Renders a tessellated floor at any orientation, under a light at any height:
/// the picture is identical with and without shadows.
static void no_acne(void **unused)
{
    static soup s;
    (void)unused;
    for (uint64_t seed = 1; seed <= 40; seed += case_step()) {
        enum { SIDE = 24 };
        random_state = seed;
        double m[3][3], eye[3], at[3], light[3], low = pow(10, between(-5, 0.5)), offset = below(2) ? 0 : 1e5;
        memset(&s, 0, sizeof s);
        random_turn(m);
        const bool aligned = seed % 2;
        if (aligned) { // puts edges on the pixels' rays, and uses a slope that is rounded at every vertex
            offset = 0;
            memcpy(m, (const double[3][3]) { { 1, 0, between(-1, 1) }, { 0, 1, between(-1, 1) }, { 0, 0, 1 } },
                   sizeof m);
        }
        for (uint32_t i = 0; i <= SIDE; i++)
            for (uint32_t j = 0; j <= SIDE; j++) {
                for (int c = 0; c < 3; c++)
                    s.vertices[s.vertex_count][c] = offset + (i - 12.0) * m[0][c] + (j - 12.0) * m[1][c];
                s.vertex_count++;
                const uint32_t n = i * (SIDE + 1) + j;
                if (i < SIDE && j < SIDE)
                    add_face(&s, 4, (const uint32_t[]) { n, n + 1, n + SIDE + 2, n + SIDE + 1 });
            }
        for (int c = 0; c < 3; c++) {
            eye[c] = offset + 14 * m[2][c] + 3 * m[0][c];
            at[c] = offset;
            light[c] = offset + low * m[2][c] + 9 * m[0][c] - 5 * m[1][c];
        }
        at[2] = aligned ? PARALLEL : at[2];
        glint_image *image[2];
        for (int shadows = 0; shadows < 2; shadows++) {
            glint_scene *scene = new_scene(eye, at, 1, light, shadows);
            add(scene, mesh_of(&s, GLINT_SHADING_FACETED, true));
            image[shadows] = render(scene, NULL, 1, 129, GLINT_PRECISION_DOUBLE);
            glint_scene_release(scene);
        }
        if (differing(image[0], image[1]))
            fail_msg("seed %d: %d pixels", (int)seed, differing(image[0], image[1]));
        glint_image_release(image[0]);
        glint_image_release(image[1]);
    }
}

// ---- Against 113-bit arithmetic ----

static quad quad_dot(const quad a[3], const quad b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void quad_cross(const quad a[3], const quad b[3], quad out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

/// Computes t, the weights of corners 1 and 2, and the normal, which is not a unit vector.
static void triangle_truth(const soup *s, const double o[3], const double d[3], quad *t, quad w[2], quad n[3])
{
    quad e[3], f[3], g[3], q[3], p[3];
    for (int c = 0; c < 3; c++) {
        f[c] = (quad)s->vertices[1][c] - s->vertices[0][c];
        g[c] = (quad)s->vertices[2][c] - s->vertices[0][c];
        e[c] = (quad)o[c] - s->vertices[0][c];
        p[c] = d[c];
    }
    quad_cross(f, g, n);
    const quad down = quad_dot(n, p);
    *t = -quad_dot(n, e) / down;
    for (int c = 0; c < 3; c++)
        e[c] += *t * p[c]; // the hit point, relative to corner 0
    quad_cross(e, g, q);
    w[0] = quad_dot(q, n) / quad_dot(n, n);
    quad_cross(f, e, q);
    w[1] = quad_dot(q, n) / quad_dot(n, n);
}

static void triangles_against_oracle(void **unused)
{
    static soup s;
    int hits = 0;
    (void)unused;
    random_state = 7;
    for (int k = 0; k < 20000; k += (int)case_step()) {
        double o[3], d[3], scale = pow(10, between(-6, 6));
        make_soup(&s, 1);
        for (int i = 0; i < 9; i++)
            s.vertices[i / 3][i % 3] *= scale;
        random_vector(o, 10 * scale);
        const double u = between(0, 1.1), v = between(0, 1.1 - u);
        for (int c = 0; c < 3; c++)
            d[c] = s.vertices[0][c] + u * (s.vertices[1][c] - s.vertices[0][c]) +
                   v * (s.vertices[2][c] - s.vertices[0][c]) - o[c];
        quad t, w[2], n[3];
        triangle_truth(&s, o, d, &t, w, n);
        bool hit = false;
        glint_hit got;
        glint_scene *scene = new_scene((double[3]) { 0, 0, 9 }, (double[3]) { 0 }, 1, o, true);
        add(scene, mesh_of(&s, GLINT_SHADING_FACETED, true));
        assert_int_equal(glint_scene_cast(scene, o, d, &hit, &got, NULL), GLINT_OK);
        glint_scene_release(scene);
        const double least = fmin(fmin((double)w[0], (double)w[1]), (double)(1 - w[0] - w[1]));
        double length = sqrt((double)quad_dot(n, n)), along = 0;
        for (int c = 0; c < 3; c++)
            along += (double)n[c] * d[c];
        const double sine = fabs(along) / (length * sqrt(dot(d, d)));
        // The error from rounding the corners, as seen from the origin, to 53 bits,
        // divided by the sine of the incidence angle.
        double size = 0, far = 0;
        for (int i = 0; i < 9; i++) {
            size = fmax(size, fabs(s.vertices[i / 3][i % 3] - s.vertices[0][i % 3]));
            far = fmax(far, fabs(s.vertices[i / 3][i % 3] - o[i % 3]));
        }
        const double thin = length / (size * size), tolerance = 64 * DBL_EPSILON * (far / size) / (sine * thin);
        if (tolerance > 1e-6)
            continue;
        if (least > tolerance && !hit)
            fail_msg("case %d: a hit is missed by %g", k, least);
        if (least < -tolerance && hit)
            fail_msg("case %d: hit at %g outside", k, least);
        if (!hit || least < -tolerance)
            continue;
        hits++;
        // t belongs to a point of the triangle, within the error of the point's weights
        assert_true(fabs(got.t - (double)t) <= (8 * DBL_EPSILON + tolerance * size / far) * (double)t);
        for (int c = 0; c < 3; c++)
            assert_true(fabs(got.normal[c] - (double)(n[c] / length)) <= 16 * DBL_EPSILON / thin);
    }
    assert_true(hits * (int)case_step() > 5000);
}

/// Returns how far a point is outside its shape, in units of the unit shape. *bound gets the bound that is exceeded.
/// m is the unit shape's map.
static double outside(const glint_shape_desc *d, quad m[3][4], const quad p[3], int *bound)
{
    const glint_shape_kind kind = d->kind;
    quad q[3], k[3], cofactor[3][3], det;
    for (int i = 0; i < 3; i++) {
        q[i] = p[i] - m[i][3];
        for (int j = 0; j < 3; j++)
            cofactor[i][j] = m[(i + 1) % 3][(j + 1) % 3] * m[(i + 2) % 3][(j + 2) % 3] -
                             m[(i + 1) % 3][(j + 2) % 3] * m[(i + 2) % 3][(j + 1) % 3];
    }
    det = m[0][0] * cofactor[0][0] + m[0][1] * cofactor[0][1] + m[0][2] * cofactor[0][2];
    for (int j = 0; j < 3; j++)
        k[j] = (cofactor[0][j] * q[0] + cofactor[1][j] * q[1] + cofactor[2][j] * q[2]) / det;
    const double x = (double)k[0], y = (double)k[1], z = (double)k[2], round = sqrt(x * x + y * y);
    double by[3] = { round - 1, z - 1, -1 - z };
    if (kind == GLINT_SHAPE_SPHERE)
        by[0] = by[1] = by[2] = sqrt(x * x + y * y + z * z) - 1;
    if (kind == GLINT_SHAPE_CONE)
        by[0] = round - z, by[2] = -z;
    if (kind == GLINT_SHAPE_TORUS)
        by[0] = by[1] = by[2] = hypot(round - 1, z) - d->minor / d->major;
    if (kind == GLINT_SHAPE_BOX)
        by[0] = fabs(x) - 1, by[1] = fabs(y) - 1, by[2] = fabs(z) - 1;
    *bound = by[0] >= by[1] && by[0] >= by[2] ? 0 : by[1] >= by[2] ? 1 : 2;
    return by[*bound];
}

/// Computes the map from the unit shape, as the description defines it.
static void unit_map(const glint_shape_desc *d, quad m[3][4])
{
    quad unit[3][4] = { { 0 } };
    const bool torus = d->kind == GLINT_SHAPE_TORUS;
    const double radius = torus ? d->major : d->radius;
    double z[3], x[3], y[3], length;
    for (int c = 0; c < 3; c++) {
        z[c] = d->kind == GLINT_SHAPE_CONE ? d->base[c] - d->top[c]
               : torus                     ? d->axis[c] / sqrt(dot(d->axis, d->axis)) * d->major
                                           : 0.5 * (d->top[c] - d->base[c]);
        unit[c][3] = d->kind == GLINT_SHAPE_CONE       ? (quad)d->top[c]
                     : d->kind == GLINT_SHAPE_CYLINDER ? ((quad)d->top[c] + d->base[c]) / 2
                     : d->kind == GLINT_SHAPE_BOX      ? ((quad)d->max[c] + d->min[c]) / 2
                                                       : (quad)d->center[c];
        unit[c][c] = d->kind == GLINT_SHAPE_BOX ? ((quad)d->max[c] - d->min[c]) / 2 : (quad)d->radius;
    }
    if (d->kind == GLINT_SHAPE_CONE || d->kind == GLINT_SHAPE_CYLINDER || torus) {
        const double other[3] = { fabs(z[0]) < fabs(z[1]), fabs(z[0]) >= fabs(z[1]), 0 };
        for (int c = 0; c < 3; c++)
            x[c] = z[(c + 1) % 3] * other[(c + 2) % 3] - z[(c + 2) % 3] * other[(c + 1) % 3];
        length = sqrt(dot(x, x));
        for (int c = 0; c < 3; c++)
            x[c] /= length;
        for (int c = 0; c < 3; c++)
            y[c] = (z[(c + 1) % 3] * x[(c + 2) % 3] - z[(c + 2) % 3] * x[(c + 1) % 3]) / sqrt(dot(z, z));
        for (int c = 0; c < 3; c++) {
            unit[c][0] = radius * x[c];
            unit[c][1] = radius * y[c];
            unit[c][2] = z[c];
        }
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            m[i][j] = j == 3 ? (quad)d->transform.m[i][3] : 0;
            for (int k = 0; k < 3; k++)
                m[i][j] += (quad)d->transform.m[i][k] * unit[k][j];
        }
}

/// Solids under random maps: the hit is on the surface, nothing is in front of it,
/// and the normal is perpendicular to the surface.
static void solids_against_oracle(void **unused)
{
    static const glint_shape_kind kinds[] = { GLINT_SHAPE_SPHERE, GLINT_SHAPE_BOX, GLINT_SHAPE_CYLINDER,
                                              GLINT_SHAPE_CONE, GLINT_SHAPE_TORUS };
    int hits = 0;
    (void)unused;
    for (int n = 0; n < 4000; n += (int)case_step()) {
        random_state = (uint64_t)n;
        glint_shape *shape = random_solid(kinds[n % 5], true);
        const glint_shape_desc d = *glint_shape_get(shape);
        double o[3], dir[3], aim[3];
        quad m[3][4], p[3];
        glint_hit got;
        bool hit = false;
        int bound, other;
        unit_map(&d, m);
        random_vector(o, 6);
        random_vector(aim, 1);
        for (int c = 0; c < 3; c++)
            dir[c] = (double)m[c][3] + aim[c] - o[c];
        glint_scene *scene = new_scene((double[3]) { 0, 0, 9 }, (double[3]) { 0 }, 1, o, true);
        add(scene, shape);
        assert_int_equal(glint_scene_cast(scene, o, dir, &hit, &got, NULL), GLINT_OK);
        const double end = hit ? got.t : 3;
        for (int c = 0; c < 3; c++)
            p[c] = o[c];
        const bool inside = outside(&d, m, p, &bound) < 0;
        for (int i = 1; i < 100; i++) {
            for (int c = 0; c < 3; c++)
                p[c] = o[c] + (quad)end * i / 100 * dir[c];
            const double far = outside(&d, m, p, &other);
            if (fabs(far) > 1e-9 && (far < 0) != inside)
                fail_msg("case %d: something at %d %% of the way to the hit", n, i);
        }
        if (hit) {
            hits++;
            for (int c = 0; c < 3; c++)
                p[c] = o[c] + (quad)got.t * dir[c];
            if (fabs(outside(&d, m, p, &bound)) > 1e-12)
                fail_msg("case %d: %g off the surface", n, outside(&d, m, p, &bound));
            // A step along the normal leads outside.
            // Steps perpendicular to the normal stay on the surface to first order.
            for (int axis = 0; axis < 3; axis++) {
                double slope[3];
                for (int c = 0; c < 3; c++) {
                    quad there[3] = { p[0], p[1], p[2] };
                    there[c] += 1e-6;
                    slope[c] = outside(&d, m, there, &other);
                    bound = other == bound ? bound : -1;
                }
                const double length = sqrt(dot(slope, slope));
                for (int c = 0; c < 3 && bound >= 0; c++)
                    if (fabs(slope[c] / length - got.normal[c]) > 1e-4)
                        fail_msg("case %d: normal %g, wanted %g", n, got.normal[c], slope[c] / length);
            }
        }
        glint_scene_release(scene);
    }
    assert_true(hits * (int)case_step() > 1000);
}

// ---- Groups ----

static void groups_hold_together(void **unused)
{
    glint_shape *a, *b, *chain = NULL, *ball, *flat;
    glint_error error;
    glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_GROUP);
    (void)unused;
    assert_int_equal(glint_shape_create(&d, &a, NULL), GLINT_OK);
    assert_int_equal(glint_shape_create(&d, &b, NULL), GLINT_OK);
    assert_int_equal(glint_group_add(a, b, &error), GLINT_OK);
    assert_int_equal(glint_group_add(b, a, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "group: a group cannot contain itself");
    assert_int_equal(glint_group_add(a, a, &error), GLINT_ERR_INVALID);
    assert_int_equal(glint_group_add(a, b, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "group: already in the group");
    // Two paths lead up at every level, so the number of paths is exponential, and the answer is still immediate.
    assert_int_equal(glint_shape_create(&d, &chain, NULL), GLINT_OK);
    for (int i = 0; i < 70; i++) {
        glint_shape *outer, *left, *right;
        assert_int_equal(glint_shape_create(&d, &outer, NULL), GLINT_OK);
        assert_int_equal(glint_shape_create(&d, &left, NULL), GLINT_OK);
        assert_int_equal(glint_shape_create(&d, &right, NULL), GLINT_OK);
        const bool fits =
            glint_group_add(left, chain, NULL) == GLINT_OK && glint_group_add(right, chain, NULL) == GLINT_OK &&
            glint_group_add(outer, left, NULL) == GLINT_OK && glint_group_add(outer, right, NULL) == GLINT_OK;
        assert_int_equal(fits, 2 * i + 2 <= GLINT_GROUP_DEPTH); // only chains within the depth limit are accepted
        glint_shape_release(left);
        glint_shape_release(right);
        glint_shape_release(chain);
        chain = outer;
        if (!fits)
            break;
    }
    glint_shape_release(chain);
    // A later edit of a child appears under both of its parents.
    d.kind = GLINT_SHAPE_SPHERE;
    assert_int_equal(glint_shape_create(&d, &ball, NULL), GLINT_OK);
    assert_int_equal(glint_group_add(b, ball, NULL), GLINT_OK);
    glint_scene *scene = new_scene((double[3]) { 0, 0, 9 }, (double[3]) { 0 }, 1, (double[3]) { 0, 9, 9 }, true);
    add(scene, a);
    assert_int_equal(glint_scene_add_shape(scene, b, NULL), GLINT_OK);
    d = *glint_shape_get(b);
    d.struct_size = sizeof d;
    d.transform = glint_transform_translate((double[3]) { 5, 0, 0 });
    assert_int_equal(glint_shape_set(b, &d, NULL), GLINT_OK);
    for (int step = 0; step < 2; step++) {
        glint_hit hit;
        bool any;
        assert_int_equal(glint_scene_cast(scene, (double[3]) { 5, 0, 9 }, (double[3]) { 0, 0, -1 }, &any, &hit, NULL),
                         GLINT_OK);
        assert_true(any && hit.shape == ball && hit.t == (step ? 7 : 8));
        d = *glint_shape_get(ball);
        d.struct_size = sizeof d;
        d.radius = 2;
        assert_int_equal(glint_shape_set(ball, &d, NULL), GLINT_OK);
    }
    // No flattening transform is accepted.
    d.transform = glint_transform_scale((double[3]) { 1, 0, 1 });
    assert_int_equal(glint_shape_set(ball, &d, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "transform: an invertible transform expected, got one that flattens space");
    assert_int_equal(glint_shape_create(&d, &flat, NULL), GLINT_ERR_INVALID);
    glint_shape_release(ball);
    glint_shape_release(b);
    glint_scene_release(scene);
}

// ---- Files ----

static glint_status load_text(const char *text, glint_shape **out, glint_error *error)
{
    char path[] = "/tmp/glint_obj_XXXXXX";
    const int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, text, strlen(text)), strlen(text));
    close(fd);
    glint_mesh_desc d = glint_mesh_desc_default();
    const glint_status status = glint_mesh_load(path, &d, out, error);
    unlink(path);
    return status;
}

#define CORNERS "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void good_files(void **unused)
{
    static const struct {
        const char *text;
        size_t triangles;
        glint_shading shading;
    } files[] = {
        { CORNERS "f 1 2 3 4", 2, GLINT_SHADING_FACETED },
        { "# c\nmtllib a.mtl\no x\n" CORNERS "vt 0 0\nvn 0 0 1\ng a b\ns off\nusemtl m\nf 1/1/1 2/1/1 3/1/1\n\n", 1,
          GLINT_SHADING_PHONG },
        { CORNERS "vn 0 0 2\nf -4//-1 -3//-1 -2//1 -1//1\r\n", 2, GLINT_SHADING_PHONG },
        { CORNERS "f 1/ 2 3", 1, GLINT_SHADING_FACETED },
        { CORNERS "vt 1 1\nf 1/1 2/1 \\\n 3/1\nv 2 2 2 0.5 1 1\n", 1, GLINT_SHADING_FACETED },
        { "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 5 1 2 3 4 # concave", 3, GLINT_SHADING_FACETED },
        { "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3 4", 1, GLINT_SHADING_FACETED },
    };
    (void)unused;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        glint_shape *shape = NULL;
        glint_error error = { .message = "" };
        const glint_status status = load_text(files[i].text, &shape, &error);
        if (status)
            fail_msg("file %zu: %s", i, error.message);
        assert_int_equal(glint_spheres_count(shape), files[i].triangles);
        assert_int_equal(glint_shape_get(shape)->shading, files[i].shading);
        glint_shape_release(shape);
    }
}

static void bad_files(void **unused)
{
    static const char *const files[][2] = {
        { CORNERS "f 1 2 5", ":5: a vertex number 1 .. 4 expected, got '5'" },
        { CORNERS "f 1 2 -5", ":5: a vertex number 1 .. 4 expected, got '-5'" },
        { CORNERS "f 1 2 0", ":5: a vertex number 1 .. 4 expected, got '0'" },
        { CORNERS "f 1/x 2 3", ":5: v, v/vt, v//vn or v/vt/vn expected, got '1/x 2 3'" },
        { CORNERS "f 1 2", "faces expected, got 4 vertices and none" },
        { CORNERS "f 1 2 3x", ":5: v, v/vt, v//vn or v/vt/vn expected, got '3x'" },
        { "v 0 0 zero", ":1: a number expected, got 'zero'" },
        { "v 0 0\nv 1 1 1", ":1: a number expected, got the end of the line" },
        { "v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3", "faces expected, got only faces with a vertex that is not finite" },
        { "vertex 0 0 0", "faces expected, got 0 vertices and none: is it a Wavefront .obj?" },
        { CORNERS, "faces expected, got 4 vertices and none" },
        { "", "faces expected, got 0 vertices and none" },
        { CORNERS "f 1 1 2", "faces: one with an area expected, got 1 without" },
    };
    (void)unused;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        glint_shape *shape = NULL;
        glint_error error = { .message = "" };
        assert_int_not_equal(load_text(files[i][0], &shape, &error), GLINT_OK);
        assert_null(shape);
        if (!strstr(error.message, files[i][1]))
            fail_msg("got: %s", error.message);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_on_every_instruction_set),
        cmocka_unit_test(no_cracks),
        cmocka_unit_test(no_light_by_an_edge),
        cmocka_unit_test(no_acne),
        cmocka_unit_test(triangles_against_oracle),
        cmocka_unit_test(good_files),
        cmocka_unit_test(bad_files),
        cmocka_unit_test(solids_against_oracle),
        cmocka_unit_test(groups_hold_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
