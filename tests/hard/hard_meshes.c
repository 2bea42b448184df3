/// Triangles: rays at the edges and corners that two or more share, triangles of no area, and texture coordinates, of which
/// there are none. The textbook's triangle is Moller and Trumbore's.
#include "tests/hard/point.h"

#include <string.h>

// ---- The textbook ----

#define NAIVE(name, real) \
    static bool name(const double corner[3][3], const hard_ray *ray) \
    { \
        real e[2][3], p[3], q[3], s[3], det = 0, u = 0, v = 0, t = 0; \
        for (int c = 0; c < 3; c++) { \
            e[0][c] = (real)corner[1][c] - (real)corner[0][c]; \
            e[1][c] = (real)corner[2][c] - (real)corner[0][c]; \
            s[c] = (real)ray->o[c] - (real)corner[0][c]; \
        } \
        for (int c = 0; c < 3; c++) { \
            const int i = (c + 1) % 3, k = (c + 2) % 3; \
            p[c] = (real)ray->d[i] * e[1][k] - (real)ray->d[k] * e[1][i]; \
            q[c] = s[i] * e[0][k] - s[k] * e[0][i]; \
        } \
        for (int c = 0; c < 3; c++) { \
            det += e[0][c] * p[c]; \
            u += s[c] * p[c]; \
            v += (real)ray->d[c] * q[c]; \
            t += e[1][c] * q[c]; \
        } \
        if (det == 0) \
            return false; \
        return u / det >= 0 && v / det >= 0 && u / det + v / det <= 1 && t / det > 0; \
    }
NAIVE(naive_float, float)
NAIVE(naive_double, double)

// ---- A closed mesh ----

#define SIDE 4 ///< quadrangles along an edge of the box
#define VERTICES (6 * (SIDE + 1) * (SIDE + 1))
#define QUADS (6 * SIDE * SIDE)

typedef struct shell {
    double vertex[VERTICES][3];
    uint32_t corner[QUADS][4], size[QUADS];
    double middle[3];
} shell;

/// A box, or a ball, made of quadrangles that need not be flat, somewhere; its seams have the same numbers on both sides.
static void make_shell(shell *s, bool ball, double size, double away)
{
    uint32_t n = 0, q = 0;
    double shear[3];
    random_direction(shear);
    for (int c = 0; c < 3; c++)
        s->middle[c] = uniform(-1, 1) * away;
    for (int face = 0; face < 6; face++) {
        const uint32_t first = n;
        for (int i = 0; i <= SIDE; i++)
            for (int j = 0; j <= SIDE; j++) {
                double p[3];
                p[face % 3] = face < 3 ? 1 : -1;
                p[(face + 1) % 3] = 2.0 * i / SIDE - 1;
                p[(face + 2) % 3] = 2.0 * j / SIDE - 1;
                // an order of its own, so that seams round alike
                const double length = ball ? sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) : 1;
                const double lean = 0.1 * (p[0] * shear[0] + p[1] * shear[1] + p[2] * shear[2]);
                for (int c = 0; c < 3; c++)
                    s->vertex[n][c] = s->middle[c] + size * (p[c] / length + lean);
                n++;
            }
        for (uint32_t i = 0; i < SIDE; i++)
            for (uint32_t j = 0; j < SIDE; j++) {
                const uint32_t at = first + i * (SIDE + 1) + j;
                const uint32_t round[4] = { at, at + SIDE + 1, at + SIDE + 2, at + 1 };
                for (int k = 0; k < 4; k++) // the outside is in front
                    s->corner[q][k] = round[face < 3 ? k : 3 - k];
                s->size[q++] = 4;
            }
    }
}

static glint_shape *shell_shape(const shell *s, glint_material *material)
{
    glint_mesh_desc desc = glint_mesh_desc_default();
    glint_shape *shape;
    glint_error error;
    desc.vertices = s->vertex[0];
    desc.vertex_count = VERTICES;
    desc.corners = s->corner[0];
    desc.face_sizes = s->size;
    desc.face_count = QUADS;
    desc.material = material;
    must(glint_mesh_create(&desc, &shape, &error), &error);
    return shape;
}

static void add_shell(glint_scene *scene, const shell *s, glint_material *material)
{
    glint_error error;
    glint_shape *shape = shell_shape(s, material);
    must(glint_scene_add_shape(scene, shape, &error), &error);
    glint_shape_release(shape);
}

/// A ray from within at a corner, at a place on an edge or diagonal, or next to one.
static hard_ray aim_at_seam(const shell *s, double size)
{
    const uint32_t *quad = s->corner[random_bits() % QUADS];
    const double *a = s->vertex[quad[random_bits() % 4]], *b = s->vertex[quad[random_bits() % 4]];
    const double w = chance(0.2) ? 0 : chance(0.3) ? 0.5 : uniform(0, 1);
    hard_ray ray;
    for (int c = 0; c < 3; c++) {
        ray.o[c] = s->middle[c] + size * uniform(-0.3, 0.3);
        ray.d[c] = (a[c] + w * (b[c] - a[c])) - ray.o[c];
    }
    if (chance(0.3))
        ray.d[random_bits() % 3] *= 1 + log_uniform(1e-16, 1e-12);
    return ray;
}

static bool naive_hit(const shell *s, const hard_ray *ray, bool (*meets)(const double corner[3][3], const hard_ray *))
{
    for (int q = 0; q < QUADS; q++)
        for (int half = 0; half < 2; half++) {
            double corner[3][3];
            for (int j = 0; j < 3; j++)
                memcpy(corner[j], s->vertex[s->corner[q][j == 0 ? 0 : j + half]], sizeof corner[j]);
            if (meets((const double(*)[3])corner, ray))
                return true;
        }
    return false;
}

/// G2: nothing gets out of a closed mesh. Frames in float are asked one ray in fifty.
static void seams(uint64_t rays)
{
    static shell s;
    static const char *const names[] = { "box", "box, far away", "ball", "ball, far away" };
    for (int kind = 0; kind < 4; kind++) {
        uint64_t count = 0, asked = 0;
        hard_values shown = { 0 };
        char what[96];
        hard_test("G2", names[kind]);
        while (count < rays) {
            const double size = log_uniform(1e-6, 1e6);
            make_shell(&s, kind / 2, size, kind % 2 ? size * log_uniform(1, 1e6) : 0);
            glint_scene *scene = scene_new();
            add_shell(scene, &s, NULL);
            for (int i = 0; i < 500; i++, count++) {
                const hard_ray ray = aim_at_seam(&s, size);
                glint_hit hit;
                shown.in_double += !hard_check(cast(scene, &ray, &hit), "a ray gets out");
                shown.naive_double += !naive_hit(&s, &ray, naive_double);
                shown.naive_float += !naive_hit(&s, &ray, naive_float);
                if (i % 50)
                    continue;
                float id[3];
                glint_image *image = frame_of_ray(scene, &ray, GLINT_FLOAT, 1u << GLINT_PASS_OBJECT_ID);
                pixel(image, GLINT_PASS_OBJECT_ID, 0, 0, id);
                glint_image_release(image);
                shown.in_float += id[0] != 1;
                asked++;
            }
            glint_scene_release(scene);
        }
        // float loses the eye's place in a mesh far away; near by it keeps it
        hard_check(kind % 2 || shown.in_float == 0, "%g of %llu rays get out in float", shown.in_float,
                   (unsigned long long)asked);
        snprintf(what, sizeof what, "%s: of %llu rays at seams, out (float: of %llu)", names[kind],
                 (unsigned long long)count, (unsigned long long)asked);
        hard_row("G2", what, &shown, shown.in_double == 0);
    }
}

/// A ray from outside, at a seam.
static hard_ray aim_from_outside(const shell *s, double size)
{
    hard_ray ray = aim_at_seam(s, size);
    double place[3], side[3];
    random_direction(side);
    for (int c = 0; c < 3; c++) {
        place[c] = ray.o[c] + ray.d[c];
        ray.o[c] = s->middle[c] + side[c] * size * 3;
        ray.d[c] = place[c] - ray.o[c];
    }
    return ray;
}

/// The way of a ray through the shell, by casting it from both ends; 0: it misses.
static double way_through(const glint_scene *scene, const hard_ray *ray)
{
    glint_hit in, out;
    hard_ray back = *ray;
    double length = 0, way = 0;
    if (!cast(scene, ray, &in))
        return 0;
    for (int c = 0; c < 3; c++) {
        length = hypot(length, ray->d[c]);
        back.o[c] = in.point[c] + 3 * (ray->d[c]);
        back.d[c] = -ray->d[c];
    }
    if (!cast(scene, &back, &out))
        return 0;
    for (int c = 0; c < 3; c++)
        way = hypot(way, out.point[c] - in.point[c]);
    return way;
}

/// Rays that start on seams, in a white world: a mirror's go away; in glass none gets out without meeting the inside; and
/// through glass that does not bend but dims they lose what the way takes.
static void leaving_seams(uint64_t rays)
{
    static shell s;
    const double white[3] = { 1, 1, 1 };
    double wrong[3] = { 0 };
    uint64_t count = 0;
    hard_test("G2", "rays that leave by seams");
    while (count < rays) {
        const double size = log_uniform(1e-3, 1e3);
        glint_error error;
        glint_material *mirror = point_glass(0, 1, 0, 1.5, false), *glass = point_glass(0, 0, 1, 1.5, false),
                       *dim = point_glass(0, 0, 1, 1, false);
        glint_material_desc desc = *glint_material_get(dim);
        for (int c = 0; c < 3; c++)
            desc.absorption[c] = 1 / size;
        must(glint_material_set(dim, &desc, &error), &error);
        make_shell(&s, false, size, chance(0.5) ? 0 : size * log_uniform(1, 1e4));
        glint_scene *scenes[3] = { scene_new(), scene_new(), scene_new() };
        add_shell(scenes[0], &s, mirror);
        add_shell(scenes[1], &s, glass);
        add_shell(scenes[2], &s, dim);
        for (int i = 0; i < 3; i++)
            scene_light_up(scenes[i], 0, white);
        for (int i = 0; i < 100; i++, count++) {
            const hard_ray ray = aim_from_outside(&s, size);
            const double way = way_through(scenes[0], &ray);
            if (way < 1e-13 * (size + fabs(s.middle[0]) + fabs(s.middle[1]) + fabs(s.middle[2])))
                continue; // by the silhouette: a hit or a miss, of the front or of the back
            const double shown = point_seen(scenes[0], &ray, GLINT_DOUBLE, 1, GLINT_PASS_MIRROR);
            const double leaked = point_seen(scenes[1], &ray, GLINT_DOUBLE, 1, GLINT_PASS_TRANSMISSION);
            const double left = point_seen(scenes[2], &ray, GLINT_DOUBLE, 64, GLINT_PASS_TRANSMISSION);
            wrong[0] += !hard_check(shown == 1, "a mirror shows %g of a white world", shown);
            wrong[1] += !hard_check(leaked == 0, "%g got in and out at one place", leaked);
            wrong[2] +=
                !hard_check(fabs(left - exp(-way / size)) < 1e-6, "%.9g is left, truth %.9g", left, exp(-way / size));
        }
        for (int i = 0; i < 3; i++)
            glint_scene_release(scenes[i]);
        glint_material_release(mirror);
        glint_material_release(glass);
        glint_material_release(dim);
    }
    static const char *const names[] = { "mirror: hits itself", "glass: out at once", "dim glass: other light" };
    for (int i = 0; i < 3; i++)
        hard_row("G2", names[i], &(hard_values) { 0, wrong[i], HARD_BLANK, HARD_BLANK, HARD_BLANK }, wrong[i] == 0);
}

/// G2: three corners on one line are no face; where a polygon has such a triangle it is left out, and nothing is hit twice
/// or by a hair of it.
static void no_area(int count)
{
    hard_test("G2", "triangles of no area");
    glint_error error;
    int taken = 0;
    for (int i = 0; i < count; i++) {
        double v[5][3], along[3], length = log_uniform(1e-6, 1e6);
        const uint32_t corners[5] = { 0, 1, 2, 3, 4 }, three = 3, five = 5;
        random_direction(along);
        for (int c = 0; c < 3; c++) { // whole steps: exactly on one line
            along[c] = rint(along[c] * 1024) / 1024 * exp2(rint(log2(length)));
            v[0][c] = 0;
            v[1][c] = along[c];
            v[2][c] = 2 * along[c];
            v[3][c] = 2 * along[c] + (c == i % 3 ? -along[(c + 1) % 3] : c == (i + 1) % 3 ? along[i % 3] : 0);
            v[4][c] = v[3][c] - 2 * along[c];
        }
        glint_mesh_desc desc = glint_mesh_desc_default();
        glint_shape *shape = NULL;
        desc.vertices = v[0];
        desc.vertex_count = 5;
        desc.corners = corners;
        desc.face_sizes = &three;
        desc.face_count = 1;
        const glint_status status = glint_mesh_create(&desc, &shape, &error);
        hard_check(status == GLINT_ERR_INVALID && !strncmp(error.message, "faces[1]", 8), "refused by name: %s",
                   status ? error.message : "it is taken");
        if (!status) {
            glint_shape_release(shape);
            taken++;
            continue;
        }
        if (along[i % 3] == 0 && along[(i + 1) % 3] == 0)
            continue; // the rest has no area either
        desc.face_sizes = &five;
        must(glint_mesh_create(&desc, &shape, &error), &error);
        hard_check(glint_spheres_count(shape) == 2, "a quadrangle with a corner more is %zu triangles",
                   glint_spheres_count(shape));
        glint_shape_release(shape);
    }
    hard_row("G2", "three corners on one line: faces taken",
             &(hard_values) { 0, taken, HARD_BLANK, HARD_BLANK, HARD_BLANK }, taken == 0);
}

static double whole(double low, double high) { return rint(uniform(low, high)); }

/// A triangle of whole numbers, of some size, and a ray that runs in its plane and passes its corners on one side.
static hard_ray aim_beside(double corner[3][3])
{
    const double size = uniform(0.1, 10);
    double from[2], along[2], side[3], f[3], g[3], area;
    do {
        for (int k = 0; k < 2; k++) {
            from[k] = whole(-6, 6);
            along[k] = whole(-6, 6);
        }
        for (int j = 0; j < 3; j++) // the corners are at 0, f and g
            side[j] = ((j == 1) - from[0]) * along[1] - ((j == 2) - from[1]) * along[0];
    } while (!((side[0] > 0 && side[1] > 0 && side[2] > 0) || (side[0] < 0 && side[1] < 0 && side[2] < 0)));
    do {
        area = 0;
        for (int c = 0; c < 3; c++) {
            f[c] = whole(-3, 3);
            g[c] = whole(-3, 3);
        }
        for (int c = 0; c < 3; c++)
            area += fabs(f[c] * g[(c + 1) % 3] - f[(c + 1) % 3] * g[c]);
    } while (area == 0);
    hard_ray ray;
    for (int c = 0; c < 3; c++) {
        const double first = whole(-8, 8);
        corner[0][c] = size * first;
        corner[1][c] = size * (first + f[c]);
        corner[2][c] = size * (first + g[c]);
        ray.o[c] = size * (first + from[0] * f[c] + from[1] * g[c]);
        ray.d[c] = size * (along[0] * f[c] + along[1] * g[c]);
    }
    return ray;
}

/// G1: a ray in a triangle's own plane that goes past it, by a whole step at least: rounding tilts it a little, but not so far.
static void in_plane(uint64_t rays)
{
    const uint32_t corners[3] = { 0, 1, 2 }, three = 3;
    hard_values shown = { 0 };
    hard_test("G1", "rays in a triangle's plane, beside it");
    for (uint64_t i = 0; i < rays; i++) {
        double corner[3][3];
        glint_mesh_desc desc = glint_mesh_desc_default();
        glint_shape *shape;
        glint_error error;
        glint_hit hit;
        const hard_ray ray = aim_beside(corner);
        desc.vertices = corner[0];
        desc.vertex_count = 3;
        desc.corners = corners;
        desc.face_sizes = &three;
        desc.face_count = 1;
        must(glint_mesh_create(&desc, &shape, &error), &error);
        glint_scene *scene = scene_new();
        must(glint_scene_add_shape(scene, shape, &error), &error);
        glint_shape_release(shape);
        shown.in_double += !hard_check(!cast(scene, &ray, &hit), "a triangle is met that the ray goes past");
        shown.naive_double += naive_double((const double(*)[3])corner, &ray);
        shown.naive_float += naive_float((const double(*)[3])corner, &ray);
        if (i % 50 == 0) {
            float id[3];
            glint_image *image = frame_of_ray(scene, &ray, GLINT_FLOAT, 1u << GLINT_PASS_OBJECT_ID);
            pixel(image, GLINT_PASS_OBJECT_ID, 0, 0, id);
            glint_image_release(image);
            shown.in_float += !hard_check(id[0] == 0, "float meets a triangle that the ray goes past");
        }
        glint_scene_release(scene);
    }
    hard_row("G1", "rays in a triangle's plane, beside it: hits (float: of one ray in 50)", &shown,
             shown.in_double == 0);
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_columns("Triangles.");
    seams(hard_rays / 100);
    leaving_seams(hard_rays / 200);
    no_area(1000);
    in_plane(hard_rays / 50);
    hard_absent("G3", "there are no textures, and so no texture coordinates");
    return hard_end();
}
