/// Rays that leave a triangle close to an edge or corner: a reflected ray does not hit the adjacent face from inside;
/// in glass, no ray slips past that face.
#include "tests/hard/oracle/point.h"
#include "tests/hard/oracle/shell.h"

// ---- Two faces ----

/// Two triangles of a convex mesh, and a grazing ray that hits the first one close to the second. Rounding moves the
/// hit point away from the plane of the first or of a third triangle. It moves further than the continued ray rises
/// before it reaches the second triangle.
typedef struct grazing_case {
    const char *what;
    bool mirrors;
    double corner[6][3];
    hard_ray ray;
} grazing_case;

static const grazing_case cases[] = {
    { "a mirror met itself at cos 3e-5",
      true,
      { { -0x1.456f054466618p-8, -0x1.456f054466618p-8, -0x1.529ba158f0364p-9 },
        { -0x1.44ca1cdd9bf86p-8, -0x1.5151d08b5b642p-9, -0x1.44ca1cdd9bf86p-8 },
        { -0x1.401e22bbb836fp-8, -0x1.401e22bbb836fp-8, -0x1.401e22bbb836fp-8 },
        { -0x1.44ca1cdd9bf86p-8, -0x1.5151d08b5b642p-9, -0x1.44ca1cdd9bf86p-8 },
        { -0x1.2c246966945f2p-9, -0x1.3233694b3875fp-8, -0x1.3233694b3875fp-8 },
        { -0x1.401e22bbb836fp-8, -0x1.401e22bbb836fp-8, -0x1.401e22bbb836fp-8 } },
      { { -0x1.7f68bf76a895ep-8, 0x1.2383d26465cb3p-7, 0x1.388036b0422ep-7 },
        { 0x1.f36be1492a21p-11, -0x1.b59273189f5c2p-7, -0x1.d8fdd85703d6ep-7 } } },
    { "glass let one out at cos 2e-6",
      false,
      { { 0x1.bb139e6eeefdfp-6, -0x1.20c7faaa302c6p-5, 0x1.20236f2545981p-4 },
        { 0x1.ba546ba931704p-6, -0x1.1a1400ab31250p-5, 0x1.1ff3a273d634ap-4 },
        { 0x1.b976f917380c8p-6, -0x1.1a82b9f42dd6ep-5, 0x1.23460f8046c2cp-4 },
        { 0x1.ac258ac592477p-6, -0x1.1a17ddbb22eb4p-5, 0x1.237b7d9ccc38ap-4 },
        { 0x1.b976f917380c8p-6, -0x1.1a82b9f42dd6ep-5, 0x1.23460f8046c2cp-4 },
        { 0x1.b8b7c6517a7edp-6, -0x1.13cebff52ecf8p-5, 0x1.231642ced75f6p-4 } },
      { { 0x1.c120a38d6e4b6p-6, -0x1.328ff91cb085fp-5, 0x1.11e256a9c226ep-4 },
        { -0x1.ea6a9d8cc19e6p-12, 0x1.80d3f28789377p-9, 0x1.163b8d67d4cfap-8 } } },
    { "glass let one out along a third face's plane",
      false,
      { { -0x1.705597046c13cp+8, -0x1.badb881926d5ep+8, 0x1.dbce85655fc42p+5 },
        { -0x1.7043272bbd3fcp+8, -0x1.bad972a879296p+8, 0x1.dc62042ad663fp+5 },
        { -0x1.704421d4bd81bp+8, -0x1.bada6d51796b5p+8, 0x1.dbd75ba2cb18cp+5 },
        { -0x1.705597046c13cp+8, -0x1.badb881926d5ep+8, 0x1.dbce85655fc42p+5 },
        { -0x1.704421d4bd81bp+8, -0x1.bada6d51796b5p+8, 0x1.dbd75ba2cb18cp+5 },
        { -0x1.70436da69638cp+8, -0x1.baea138b5349ep+8, 0x1.dbdcfd1405602p+5 } },
      { { -0x1.7042fa07858eep+8, -0x1.ba95221c33ae7p+8, 0x1.de02d285ef51ap+5 },
        { -0x1.2781502687c06p-8, -0x1.154733fb64eecp-2, -0x1.15ba41f2eb3a4p-2 } } },
};

/// In a white world the mirror shows all light. The glass does not refract, and the depth allows one surface, so the
/// glass shows no light: the second face ends the chain.
static void check_case(const grazing_case *k)
{
    static const uint32_t corners[6] = { 0, 1, 2, 3, 4, 5 }, sizes[2] = { 3, 3 };
    static const double white[3] = { 1, 1, 1 };
    glint_material *material = point_glass(0, k->mirrors, !k->mirrors, 1, false);
    glint_mesh_desc desc = glint_mesh_desc_default();
    glint_shape *shape;
    glint_error error;
    desc.vertices = k->corner[0];
    desc.vertex_count = 6;
    desc.corners = corners;
    desc.face_sizes = sizes;
    desc.face_count = 2;
    desc.material = material;
    must(glint_mesh_create(&desc, &shape, &error), &error);
    glint_scene *scene = scene_new();
    must(glint_scene_add_shape(scene, shape, &error), &error);
    scene_light_up(scene, 0, white);
    const double shown =
        point_seen(scene, &k->ray, GLINT_PRECISION_DOUBLE, 1, k->mirrors ? GLINT_PASS_MIRROR : GLINT_PASS_TRANSMISSION);
    const bool right = hard_check(shown == k->mirrors, "%s: %g", k->what, shown);
    hard_row("G2", k->what, &(hard_values) { k->mirrors, shown, HARD_BLANK, HARD_BLANK, HARD_BLANK }, right);
    glint_scene_release(scene);
    glint_shape_release(shape);
    glint_material_release(material);
}

// ---- A box ----

/// Aims a ray from outside at a seam.
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

/// Aims a ray from outside, nearly parallel to a face, that hits the face close to a seam, before or beyond the seam.
static hard_ray aim_along_face(const shell *s, double size)
{
    const uint32_t *quad = s->corner[random_bits() % QUADS];
    const double *a = s->vertex[quad[0]], *b = s->vertex[quad[1]], *c = s->vertex[quad[2]];
    const double share = uniform(0, 1), rise = log_uniform(1e-11, 1), before = size * log_uniform(1e-17, 1e-3);
    double along[3], normal[3], length = 0, area = 0;
    hard_ray ray;
    for (int k = 0; k < 3; k++) {
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        along[k] = (c[k] - b[k]) + share * (b[k] - a[k]);
        normal[k] = (b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]);
        length = hypot(length, along[k]);
        area = hypot(area, normal[k]);
    }
    const double turn = chance(0.5) ? 1 : -1;
    for (int k = 0; k < 3; k++) {
        const double place = turn > 0 ? c[k] : a[k] + share * (b[k] - a[k]);
        ray.d[k] = 3 * size * (turn * along[k] / length - rise * normal[k] / area);
        ray.o[k] = (place - before * turn * along[k] / length) - ray.d[k];
    }
    return ray;
}

/// Returns the ray as a camera along it would generate it, so that casting it gives the same decision as the frame.
static hard_ray as_camera(const hard_ray *ray)
{
    hard_ray out = *ray;
    const double length = sqrt((ray->d[0] * ray->d[0] + ray->d[1] * ray->d[1]) + ray->d[2] * ray->d[2]);
    for (int c = 0; c < 3; c++)
        out.d[c] /= length;
    return out;
}

static double cosine_at(const hard_ray *ray, const glint_hit *hit)
{
    return (hit->normal[0] * ray->d[0] + hit->normal[1] * ray->d[1]) + hit->normal[2] * ray->d[2];
}

/// Computes the length of a unit-direction ray inside the shell, by casting it from both ends. *slack gets the error
/// bound of that length: 16 roundings of the coordinates at each end, divided by the cosine there. Returns false when
/// the error is too large, or when the ray does not enter through a front face and leave through a back face, as
/// close to a silhouette.
static bool way_through(const glint_scene *scene, const shell *s, double size, const hard_ray *ray, double *way,
                        double *slack)
{
    glint_hit in, out;
    hard_ray back = *ray;
    if (!cast(scene, ray, &in) || cosine_at(ray, &in) >= 0)
        return false;
    for (int c = 0; c < 3; c++) {
        back.o[c] = in.point[c] + 8 * size * ray->d[c];
        back.d[c] = -ray->d[c];
    }
    if (!cast(scene, &back, &out) || cosine_at(ray, &out) <= 0)
        return false;
    *way = 0;
    for (int c = 0; c < 3; c++)
        *way = hypot(*way, out.point[c] - in.point[c]);
    const double place = 16 * size + fabs(s->middle[0]) + fabs(s->middle[1]) + fabs(s->middle[2]);
    *slack = 16 * 0x1p-53 * place * (1 / -cosine_at(ray, &in) + 1 / cosine_at(ray, &out));
    // Corners are off by 4 roundings, and the plane of a face is below the neighbour's corner by up to five times as
    // much. So a ray that rises by less than 40 roundings over half the size may really hit the neighbour. That is a
    // slack of 0.4 sizes.
    return *slack < 0.25 * size;
}

/// Rays that start close to seams, in a white world. Reflected rays leave, refracted rays do not get out without
/// hitting the inside, and non-refracting absorbing glass dims by the length of the path.
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
        desc.struct_size = sizeof desc;
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
            const hard_ray aimed = chance(0.5) ? aim_from_outside(&s, size) : aim_along_face(&s, size);
            const hard_ray ray = as_camera(&aimed);
            double way, slack;
            if (!way_through(scenes[0], &s, size, &ray, &way, &slack))
                continue;
            const double shown = point_seen(scenes[0], &aimed, GLINT_PRECISION_DOUBLE, 1, GLINT_PASS_MIRROR);
            const double leaked = point_seen(scenes[1], &aimed, GLINT_PRECISION_DOUBLE, 1, GLINT_PASS_TRANSMISSION);
            const double left = point_seen(scenes[2], &aimed, GLINT_PRECISION_DOUBLE, 64, GLINT_PASS_TRANSMISSION);
            wrong[0] += !hard_check(shown == 1, "a mirror shows %g of a white world", shown);
            wrong[1] += !hard_check(leaked == 0, "%g got in and out at one place", leaked);
            wrong[2] += !hard_check(fabs(left - exp(-way / size)) < 1e-6 + slack / size,
                                    "%.9g is left, truth %.9g give or take %g", left, exp(-way / size), slack / size);
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

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_columns("Rays that leave triangles by their seams.");
    hard_test("G2", "two faces, by grazing light");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check_case(&cases[i]);
    leaving_seams(hard_rays / 200);
    return hard_end();
}
