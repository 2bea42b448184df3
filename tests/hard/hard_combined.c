/// CSG cases in which textbook methods leave specks: cutters that end in the face they cut, halves that share a face,
/// and mesh boxes hit at edges and corners. Also defocus by a lens, against the unoccluded share of the lens.
#include "tests/hard/oracle/drive.h"

#include <string.h>

#define RAYS_MOST 4000 ///< rays per row of the table, at most; each ray is a frame

static glint_shape *made(const glint_shape_desc *d)
{
    glint_error error;
    glint_shape *shape;
    must(glint_shape_create(d, &shape, &error), &error);
    return shape;
}

static void put_in(glint_shape *whole, glint_shape *part)
{
    glint_error error;
    must(glint_group_add(whole, part, &error), &error);
    glint_shape_release(part);
}

typedef struct block {
    double low[3], high[3];
} block;

static glint_shape *solid_block(const block *b)
{
    glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_BOX);
    memcpy(d.min, b->low, sizeof d.min);
    memcpy(d.max, b->high, sizeof d.max);
    return made(&d);
}

/// Corner i of a block: bit c of i selects the upper end of axis c.
static void corner_of(const block *b, int i, double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = i >> c & 1 ? b->high[c] : b->low[c];
}

static const uint32_t TRIANGLES[12][3] = { { 0, 2, 3 }, { 0, 3, 1 }, { 4, 5, 7 }, { 4, 7, 6 }, { 0, 1, 5 }, { 0, 5, 4 },
                                           { 2, 6, 7 }, { 2, 7, 3 }, { 0, 4, 6 }, { 0, 6, 2 }, { 1, 3, 7 }, { 1, 7, 5 } };

static glint_shape *block_of_triangles(const block *b)
{
    glint_error error;
    glint_shape *shape;
    glint_mesh_desc d = glint_mesh_desc_default();
    double vertices[8][3];
    uint32_t sizes[12];
    for (int i = 0; i < 8; i++)
        corner_of(b, i, vertices[i]);
    for (int i = 0; i < 12; i++)
        sizes[i] = 3;
    d.vertices = vertices[0];
    d.vertex_count = 8;
    d.corners = TRIANGLES[0];
    d.face_sizes = sizes;
    d.face_count = 12;
    must(glint_mesh_create(&d, &shape, &error), &error);
    return shape;
}

static glint_transform random_map(void)
{
    double axis[3], by[3];
    random_direction(axis);
    for (int c = 0; c < 3; c++)
        by[c] = uniform(-3, 3);
    const glint_transform turn = glint_transform_rotate_deg(axis, uniform(0, 360)), move = glint_transform_translate(by);
    return glint_transform_product(&move, &turn);
}

static void map_vector(const glint_transform *m, const double v[3], double w, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = ((m->m[i][0] * v[0] + m->m[i][1] * v[1]) + m->m[i][2] * v[2]) + m->m[i][3] * w;
}

/// Transforms a ray from a shape's own space to the world. The ray's direction is a unit vector in the shape's space.
static hard_ray ray_in_world(const glint_transform *map, const double from[3], const double to[3])
{
    hard_ray ray;
    double d[3];
    for (int c = 0; c < 3; c++)
        d[c] = to[c] - from[c];
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int c = 0; c < 3; c++)
        d[c] /= length;
    map_vector(map, from, 1, ray.o);
    map_vector(map, d, 0, ray.d);
    return ray;
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/// Returns the distance to the ray's hit; infinity for a miss.
static double depth_of(glint_shape *whole, const hard_ray *ray, glint_precision precision)
{
    glint_error error;
    float depth[3];
    glint_scene *scene = scene_new();
    must(glint_scene_add_shape(scene, whole, &error), &error);
    glint_image *image = frame_of_ray(scene, ray, precision, 1u << GLINT_PASS_DEPTH);
    pixel(image, GLINT_PASS_DEPTH, 0, 0, depth);
    glint_image_release(image);
    glint_scene_release(scene);
    return (double)depth[0];
}

// ---- The textbook: each part is a unit cube under its own map ----

/// Computes the span of a ray inside the block. map: from the shape to the world.
#define BOOK(name, real) \
    static void name(const block *b, const glint_transform *map, const hard_ray *ray, double span[2]) \
    { \
        real low = -INFINITY, high = INFINITY; \
        for (int k = 0; k < 3; k++) { /* a row of the inverse: the map is a rotation */ \
            real o = 0, d = 0; \
            const real half = (real)((b->high[k] - b->low[k]) / 2), middle = (real)((b->high[k] + b->low[k]) / 2); \
            for (int c = 0; c < 3; c++) { \
                o += (real)map->m[c][k] / half * ((real)ray->o[c] - (real)map->m[c][3]); \
                d += (real)map->m[c][k] / half * (real)ray->d[c]; \
            } \
            o -= middle / half; \
            const real first = (-1 - o) / d, second = (1 - o) / d; \
            low = first < second ? (first > low ? first : low) : (second > low ? second : low); \
            high = first < second ? (second < high ? second : high) : (first < high ? first : high); \
        } \
        span[0] = (double)low; \
        span[1] = (double)high; \
    }
BOOK(book_double, double)
BOOK(book_float, float)

typedef void book(const block *b, const glint_transform *map, const hard_ray *ray, double span[2]);

static uint64_t rays_of_row(void)
{
    const uint64_t rays = hard_rays / 1000 < 200 ? 200 : hard_rays / 1000;
    return rays > RAYS_MOST ? RAYS_MOST : rays;
}

/// Reports a row of counts, each the number of rays that hit something that should not be there.
static void report(const char *id, const char *what, uint64_t rays, const double counts[4])
{
    char text[120];
    hard_values shown = { 0, counts[0], counts[1], counts[2], counts[3] };
    snprintf(text, sizeof text, "%s, of %llu", what, (unsigned long long)rays);
    const bool right = hard_check(counts[0] == 0 && counts[1] == 0, "%s: %g in double, %g in float", what, counts[0], counts[1]);
    hard_right(rays - 1);
    hard_row(id, text, &shown, right);
}

static void flush_cutters(void)
{
    static const block body = { { -1, -1, -1 }, { 1, 1, 1 } }, pit = { { -0.5, -0.3, -0.7 }, { 0.5, 1, 0.7 } };
    static book *const books[2] = { book_double, book_float };
    double counts[4] = { 0 };
    hard_test("K1", "flush cutters");
    for (uint64_t i = 0; i < rays_of_row(); i++) {
        glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_DIFFERENCE);
        d.transform = random_map();
        glint_shape *whole = made(&d);
        put_in(whole, solid_block(&body));
        put_in(whole, solid_block(&pit));
        const double to[3] = { uniform(-0.4, 0.4), 1, uniform(-0.6, 0.6) };
        const double from[3] = { to[0] + uniform(-1, 1), uniform(1.5, 4), to[2] + uniform(-1, 1) }, way = distance(from, to);
        const hard_ray ray = ray_in_world(&d.transform, from, to);
        for (int p = 0; p < 2; p++) {
            double outer[2], inner[2];
            counts[p] += fabs(depth_of(whole, &ray, (glint_precision)p) - way) < 1e-3;
            books[p](&body, &d.transform, &ray, outer);
            books[p](&pit, &d.transform, &ray, inner);
            counts[2 + p] += inner[0] > outer[0];
        }
        glint_shape_release(whole);
    }
    report("K1", "a skin over a hole whose cutter ends in the face", rays_of_row(), counts);
}

static void halves(void)
{
    static const block half[2] = { { { -1, -1, -1 }, { 0.3, 1, 1 } }, { { 0.3, -1, -1 }, { 1, 1, 1 } } };
    static book *const books[2] = { book_double, book_float };
    double counts[4] = { 0 };
    hard_test("K2", "halves");
    for (uint64_t i = 0; i < rays_of_row(); i++) {
        glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_UNION);
        d.transform = random_map();
        glint_shape *whole = made(&d);
        put_in(whole, solid_block(&half[0]));
        put_in(whole, solid_block(&half[1]));
        const double from[3] = { uniform(-0.9, 0.2), uniform(-0.9, 0.9), uniform(-0.9, 0.9) };
        const double to[3] = { 1, uniform(-0.9, 0.9), uniform(-0.9, 0.9) }, way = distance(from, to);
        const hard_ray ray = ray_in_world(&d.transform, from, to);
        for (int p = 0; p < 2; p++) {
            double first[2], second[2];
            counts[p] += depth_of(whole, &ray, (glint_precision)p) < way - 1e-3;
            books[p](&half[0], &d.transform, &ray, first);
            books[p](&half[1], &d.transform, &ray, second);
            counts[2 + p] += first[1] < second[0];
        }
        glint_shape_release(whole);
    }
    report("K2", "a seam between halves, from within", rays_of_row(), counts);
}

// ---- Mesh boxes ----

/// Moeller-Trumbore, edges included: counts the triangles that a ray hits.
#define COUNT(name, real) \
    static int name(const block *b, const double from[3], const double way[3]) \
    { \
        int count = 0; \
        for (int i = 0; i < 12; i++) { \
            double corner[3][3]; \
            real f[3], g[3], q[3], s[3], r[3], a = 0, u = 0, v = 0, t = 0; \
            for (int j = 0; j < 3; j++) \
                corner_of(b, (int)TRIANGLES[i][j], corner[j]); \
            for (int c = 0; c < 3; c++) { \
                f[c] = (real)corner[1][c] - (real)corner[0][c]; \
                g[c] = (real)corner[2][c] - (real)corner[0][c]; \
                s[c] = (real)from[c] - (real)corner[0][c]; \
            } \
            for (int c = 0; c < 3; c++) { \
                const int x = (c + 1) % 3, y = (c + 2) % 3; \
                q[c] = (real)way[x] * g[y] - (real)way[y] * g[x]; \
                r[c] = s[x] * f[y] - s[y] * f[x]; \
            } \
            for (int c = 0; c < 3; c++) { \
                a += f[c] * q[c]; \
                u += s[c] * q[c]; \
                v += (real)way[c] * r[c]; \
                t += g[c] * r[c]; \
            } \
            count += a != 0 && u / a >= 0 && v / a >= 0 && (u + v) / a <= 1 && t / a > 0; \
        } \
        return count; \
    }
COUNT(count_double, double)
COUNT(count_float, float)

/// Casts rays from outside towards the centre, through an edge, a corner or the diagonal of a face.
static void edges_and_corners(void)
{
    static const block body = { { -1, -1, -1 }, { 1, 1, 1 } };
    double counts[4] = { 0 };
    hard_test("K3", "edges and corners");
    glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_UNION);
    glint_shape *whole = made(&d);
    put_in(whole, block_of_triangles(&body));
    for (uint64_t i = 0; i < rays_of_row(); i++) {
        double at[3] = { 1, 1, chance(0.3) ? 1 : uniform(-1, 1) }, from[3], way[3];
        if (chance(0.3))
            at[1] = at[2]; // a point on the diagonal
        const double far = uniform(1.5, 6);
        for (int c = 0; c < 3; c++) {
            const int k = (int)((uint64_t)c + i) % 3;
            from[k] = (i >> (3 + c) & 1 ? -1 : 1) * at[c] * far;
            way[k] = -from[k];
        }
        const glint_transform none = glint_transform_identity();
        const double middle[3] = { 0, 0, 0 };
        const hard_ray ray = ray_in_world(&none, from, middle);
        for (int p = 0; p < 2; p++)
            counts[p] += !(depth_of(whole, &ray, (glint_precision)p) < distance(from, middle));
        counts[2] += count_double(&body, from, way) % 2;
        counts[3] += count_float(&body, from, way) % 2;
    }
    glint_shape_release(whole);
    report("K3", "through edges and corners of a box of triangles: missed; books: went in and not out", rays_of_row(), counts);
}

/// Compares mesh boxes minus a ball and a flush block with solid boxes minus the same shapes.
static void boxes_of_triangles(void)
{
    static const block body = { { -1, -1, -1 }, { 1, 1, 1 } }, pit = { { -0.5, -0.3, -0.7 }, { 0.5, 1, 0.7 } };
    double counts[4] = { 0, 0, HARD_BLANK, HARD_BLANK };
    hard_test("K4", "boxes of triangles");
    for (uint64_t i = 0; i < rays_of_row(); i++) {
        glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_DIFFERENCE), ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
        d.transform = random_map();
        ball.radius = 0.7;
        for (int c = 0; c < 3; c++)
            ball.center[c] = uniform(-1, 1);
        glint_shape *whole[2] = { made(&d), made(&d) };
        double from[3], to[3];
        for (int k = 0; k < 2; k++) {
            put_in(whole[k], k ? block_of_triangles(&body) : solid_block(&body));
            put_in(whole[k], made(&ball));
            put_in(whole[k], k ? block_of_triangles(&pit) : solid_block(&pit));
        }
        for (int c = 0; c < 3; c++) {
            from[c] = uniform(-3, 3);
            to[c] = uniform(-1, 1);
        }
        const hard_ray ray = ray_in_world(&d.transform, from, to);
        for (int p = 0; p < 2; p++) {
            const double a = depth_of(whole[0], &ray, (glint_precision)p), b = depth_of(whole[1], &ray, (glint_precision)p);
            counts[p] += !(a == b || fabs(a - b) <= (p ? 1e-4 : 1e-6) * a);
        }
        glint_shape_release(whole[0]);
        glint_shape_release(whole[1]);
    }
    report("K4", "boxes of triangles that are not the boxes", rays_of_row(), counts);
}

// ---- A lens ----

/// Renders a pixel that looks past the edge of a black wall halfway to the focus, with 4,096 samples. At the wall,
/// the edge is at a share `edge` of the lens's cross-section; the rest of the lens sees a white world.
static double seen_past(double edge, glint_precision precision)
{
    static const double white[3] = { 1, 1, 1 };
    const double radius = 0.25, focus = 8;
    glint_error error;
    float seen[3];
    glint_scene *scene = scene_new();
    glint_camera_desc c = glint_camera_desc_default();
    const double eye[3] = { 0, 0, focus }, at[3] = { 0, 0, 0 };
    memcpy(c.eye, eye, sizeof c.eye);
    memcpy(c.at, at, sizeof c.at);
    c.fov_y_rad = 1e-6;
    c.aperture = radius;
    c.focus = focus;
    scene_light_up(scene, 0, white);
    scene_camera(scene, &c);
    glint_shape_desc wall = glint_shape_desc_default(GLINT_SHAPE_BOX);
    const double low[3] = { -50, -50, focus / 2 - 1e-6 }, high[3] = { edge * radius / 2, 50, focus / 2 };
    memcpy(wall.min, low, sizeof low);
    memcpy(wall.max, high, sizeof high);
    glint_shape *shape = made(&wall);
    must(glint_scene_add_shape(scene, shape, &error), &error);
    glint_shape_release(shape);
    glint_render_desc d = glint_render_desc_default();
    glint_renderer_desc r = glint_renderer_desc_default();
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
    d.width = d.height = 1;
    d.samples = 4096;
    d.precision = precision;
    must(glint_renderer_create(&r, &renderer, &error), &error);
    must(glint_plan_create(scene, &d, &plan, &error), &error);
    must(glint_render(renderer, plan, &image, NULL, &error), &error);
    pixel(image, GLINT_PASS_BEAUTY, 0, 0, seen);
    glint_image_release(image);
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    glint_scene_release(scene);
    return (double)seen[0];
}

static void lens(void)
{
    static const double edges[] = { -1.01, -0.9, -0.5, 0, 0.25, 0.75, 0.99, 1.01 };
    hard_test("K5", "a lens");
    for (size_t i = 0; i < sizeof edges / sizeof *edges; i++) {
        const double s = fmin(fmax(edges[i], -1), 1);
        // an error of 4096^-3/4, as for an edge across a square
        const double want = (acos(s) - s * sqrt(1 - s * s)) / acos(-1), off = 0x1p-9;
        char what[80];
        uint64_t open = 0, all = 0;
        for (; all < 4096;) {
            const double x = uniform(-1, 1), y = uniform(-1, 1);
            if (x * x + y * y > 1)
                continue;
            open += x > edges[i];
            all++;
        }
        hard_values shown = { want, seen_past(edges[i], GLINT_PRECISION_DOUBLE), seen_past(edges[i], GLINT_PRECISION_FLOAT), (double)open / 4096, HARD_BLANK };
        const bool right = hard_check(fabs(shown.in_double - want) <= off && fabs(shown.in_float - want) <= off,
                                      "a lens open to %g: %.9g, truth %.9g", edges[i], shown.in_double, want);
        snprintf(what, sizeof what, "a lens past an edge at %g of it, 4,096 samples; books: random ones", edges[i]);
        hard_row("K5", what, &shown, right);
    }
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_columns("Combined solids: how many rays see what is not there; and a lens");
    flush_cutters();
    halves();
    edges_and_corners();
    boxes_of_triangles();
    lens();
    return hard_end();
}
