#include "tests/hard/oracle/shell.h"

void make_shell(shell *s, bool ball, double size, double away)
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
                // the same order of operations for both sides of a seam, so that the seam rounds identically
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
                for (int k = 0; k < 4; k++) // turns the front outwards
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

void add_shell(glint_scene *scene, const shell *s, glint_material *material)
{
    glint_error error;
    glint_shape *shape = shell_shape(s, material);
    must(glint_scene_add_shape(scene, shape, &error), &error);
    glint_shape_release(shape);
}

hard_ray aim_at_seam(const shell *s, double size)
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
