/// Triangles: rays at shared edges and corners, and triangles without area; coordinates on a ball at its poles. The
/// textbook's triangle test is Moeller-Trumbore.
#include "engine/glint_math.h"
#include "engine/glint_programs.h"
#include "tests/hard/oracle/shell.h"

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

/// G2: no ray escapes from a closed mesh. One ray in fifty is also rendered in float.
static void seams(uint64_t rays)
{
    static shell s;
    static const char *const names[] = { "box", "box, far away", "ball", "ball, far away" };
    for (int kind = 0; kind < 4; kind++) {
        uint64_t count = 0, requested = 0;
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
                glint_image *image = frame_of_ray(scene, &ray, GLINT_PRECISION_FLOAT, 1u << GLINT_PASS_OBJECT_ID);
                pixel(image, GLINT_PASS_OBJECT_ID, 0, 0, id);
                glint_image_release(image);
                shown.in_float += id[0] != 1;
                requested++;
            }
            glint_scene_release(scene);
        }
        // in float the eye's position is imprecise relative to a distant mesh, but not to a nearby mesh
        hard_check(kind % 2 || shown.in_float == 0, "%g of %llu rays get out in float", shown.in_float,
                   (unsigned long long)requested);
        snprintf(what, sizeof what, "%s: of %llu rays at seams, out (float: of %llu)", names[kind],
                 (unsigned long long)count, (unsigned long long)requested);
        hard_row("G2", what, &shown, shown.in_double == 0);
    }
}

/// G2: a face of three collinear corners is refused. In a polygon such a triangle is omitted, and the polygon has no
/// double hits or cracks.
static void no_area(int count)
{
    hard_test("G2", "triangles of no area");
    glint_error error;
    int taken = 0;
    for (int i = 0; i < count; i++) {
        double v[5][3], along[3], length = log_uniform(1e-6, 1e6);
        const uint32_t corners[5] = { 0, 1, 2, 3, 4 }, three = 3, five = 5;
        random_direction(along);
        for (int c = 0; c < 3; c++) { // the corners are multiples of one step, so they are exactly collinear
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
            continue; // the remaining triangles have no area either
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

/// Makes a triangle with integer coordinates times a size. Returns a ray in the triangle's plane that passes all
/// corners on one side.
static hard_ray aim_shared_edge(double corner[3][3])
{
    const double size = uniform(0.1, 10);
    double from[2], along[2], side[3], f[3], g[3], area;
    do {
        for (int k = 0; k < 2; k++) {
            from[k] = whole(-6, 6);
            along[k] = whole(-6, 6);
        }
        for (int j = 0; j < 3; j++) // the other corners are at 0, f and g
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

/// G1: a ray in a triangle's plane misses the triangle by at least one step.
/// Rounding tilts the ray, but by less than that.
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
        const hard_ray ray = aim_shared_edge(corner);
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
            glint_image *image = frame_of_ray(scene, &ray, GLINT_PRECISION_FLOAT, 1u << GLINT_PASS_OBJECT_ID);
            pixel(image, GLINT_PASS_OBJECT_ID, 0, 0, id);
            glint_image_release(image);
            shown.in_float += !hard_check(id[0] == 0, "float meets a triangle that the ray goes past");
        }
        glint_scene_release(scene);
    }
    hard_row("G1", "rays in a triangle's plane, beside it: hits (float: of one ray in 50)", &shown,
             shown.in_double == 0);
}

static glint_value op(glint_builder *b, glint_op which, glint_value x, glint_value y)
{
    const glint_value operands[GLINT_OPERANDS_MAX] = { x, y, y };
    glint_value out[GLINT_RESULTS_MAX];
    glint_error error;
    must(glint_builder_op(b, which, operands, out, &error), &error);
    return out[0];
}

/// Makes a pattern that is 1 where u and v are in 0 .. 1 and a checkerboard of 1e10 squares per unit is 0 or 1. For
/// NaN it is 0.
static glint_program *proper_coordinates(void)
{
    glint_builder *b;
    glint_program *program;
    glint_error error;
    glint_value zero, one, many, good;
    must(glint_builder_create(GLINT_PROGRAM_PATTERN, &b, &error), &error);
    must(glint_builder_number(b, 0, &zero, &error), &error);
    must(glint_builder_number(b, 1, &one, &error), &error);
    must(glint_builder_number(b, 1e10, &many, &error), &error);
    good = one;
    for (int k = 0; k < 2; k++) {
        glint_value x;
        must(glint_builder_input(b, (glint_input)(GLINT_INPUT_UV_U + k), &x, &error), &error);
        good = op(b, GLINT_OP_AND, good, op(b, GLINT_OP_AND, op(b, GLINT_OP_LESSEQ, zero, x), op(b, GLINT_OP_LESSEQ, x, one)));
        const glint_value odd = op(b, GLINT_OP_PARITY, op(b, GLINT_OP_MUL, x, many), zero);
        good = op(b, GLINT_OP_AND, good, op(b, GLINT_OP_OR, op(b, GLINT_OP_EQUAL, odd, zero), op(b, GLINT_OP_EQUAL, odd, one)));
    }
    must(glint_builder_finish(b, &good, 1, &program, &error), &error);
    glint_builder_destroy(b);
    return program;
}

/// G3: rays along a ball's axis, and ever closer to it.
static void poles(int steps)
{
    hard_values shown = { 0 };
    glint_material_desc desc = glint_material_desc_default();
    glint_error error;
    glint_material *material;
    hard_test("G3", "coordinates on a ball at its poles");
    desc.program.diffuse = proper_coordinates();
    must(glint_material_create(&desc, &material, &error), &error);
    glint_program_release(desc.program.diffuse);
    for (int i = 0; i < 4 * steps; i++) {
        const hard_sphere ball = { { 0.1, 0.2, 0.3 }, 1.7 };
        const double side = i % 2 ? 1 : -1, off = i < 4 ? 0 : ldexp(i % 4 < 2 ? 1 : -1, -i / 4);
        const hard_ray ray = { .o = { 0.1 + off, 0.2 + 9 * side, 0.3 - off }, .d = { 0, -side, 0 } };
        glint_scene *scene = scene_new();
        scene_sphere(scene, &ball, material);
        for (int precision = 0; precision < 2; precision++) {
            float good[3];
            glint_image *image = frame_of_ray(scene, &ray, (glint_precision)precision, 1u << GLINT_PASS_ALBEDO);
            pixel(image, GLINT_PASS_ALBEDO, 0, 0, good);
            glint_image_release(image);
            const bool wrong = !hard_check(good[0] == 1, "step %d: u or v is not within 0 .. 1", i);
            *(precision == GLINT_PRECISION_DOUBLE ? &shown.in_double : &shown.in_float) += wrong;
        }
        glint_scene_release(scene);
    }
    glint_material_release(material);
    shown.naive_double = shown.naive_float = HARD_BLANK;
    hard_row("G3", "coordinates on a ball at and by its poles: not within 0 .. 1", &shown, shown.in_double + shown.in_float == 0);
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_columns("Triangles, and coordinates on surfaces.");
    seams(hard_rays / 100);
    no_area(1000);
    in_plane(hard_rays / 50);
    poles(60);
    return hard_end();
}
