/// Constructive solid geometry (CSG): identical pictures on every instruction set, hits against point sets in 113-bit
/// arithmetic, coincident faces, and CSG shapes that equal a single solid.
#include "engine/glint.h"
#include "engine/glint_inspect.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/engine/quad.h"
#include "tests/engine/cases/closed_mesh.h"
#include "tests/engine/cases/random.h"
#include "tests/engine/cases/sets.h"

static void random_vector(double v[3], double size)
{
    for (int c = 0; c < 3; c++)
        v[c] = between(-size, size);
}

static glint_transform random_map(double move)
{
    double axis[3], by[3];
    random_vector(axis, 1);
    random_vector(by, move);
    const double scale[3] = { between(0.5, 1.6), between(0.5, 1.6), one_in(3) ? -1 : between(0.6, 1.5) };
    const glint_transform turn = glint_transform_rotate_deg(axis, between(0, 360)), large = glint_transform_scale(scale);
    const glint_transform away = glint_transform_translate(by), turned = glint_transform_product(&turn, &large);
    return glint_transform_product(&away, &turned);
}

static glint_shape *made(const glint_shape_desc *d)
{
    glint_shape *shape;
    glint_error error = { .message = "" };
    if (glint_shape_create(d, &shape, &error))
        fail_msg("%s", error.message);
    return shape;
}

static void put_in(glint_shape *whole, glint_shape *part)
{
    glint_error error = { .message = "" };
    if (glint_group_add(whole, part, &error))
        fail_msg("%s", error.message);
    glint_shape_release(part);
}

static glint_shape *new_whole(glint_shape_kind kind)
{
    const glint_shape_desc d = glint_shape_desc_default(kind);
    return made(&d);
}

// ---- Random CSG trees ----

enum { MOST_NODES = 128 };

/// A leaf solid, or a set operation on its child nodes.
typedef struct node {
    glint_shape_kind kind;
    int children[4], count;
    quad inverse[3][4]; ///< map of a leaf from world space to the unit shape
    double normal[3], point[3]; ///< normal and point of a plane, in world space
    int mesh; ///< index into meshes
} node;

static node nodes[MOST_NODES];
static int node_count, part_count;
static bool with_tori; ///< whether leaves may be tori, which the test in_part does not support
static bool with_meshes; ///< whether leaves may be meshes
static closed_mesh meshes[MOST_NODES]; ///< the meshes of all leaves, in world space
static int mesh_count;

static void invert(quad m[3][4], quad out[3][4])
{
    quad cofactor[3][3], det = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            cofactor[i][j] = m[(i + 1) % 3][(j + 1) % 3] * m[(i + 2) % 3][(j + 2) % 3] -
                             m[(i + 1) % 3][(j + 2) % 3] * m[(i + 2) % 3][(j + 1) % 3];
    for (int j = 0; j < 3; j++)
        det += m[0][j] * cofactor[0][j];
    for (int i = 0; i < 3; i++) {
        out[i][3] = 0;
        for (int j = 0; j < 3; j++) {
            out[i][j] = cofactor[j][i] / det;
            out[i][3] -= out[i][j] * m[j][3];
        }
    }
}

/// Stores the leaf's inverse map. The unit shape's z axis is the cylinder's axis from base to top, or the cone's axis
/// from apex to base. In every leaf, that axis points along y.
static void note_part(node *n, const glint_shape_desc *d, const glint_transform *around)
{
    const glint_transform map = glint_transform_product(around, &d->transform);
    quad unit[3][4] = { { 0 } }, whole[3][4];
    const bool cylinder = d->kind == GLINT_SHAPE_CYLINDER, cone = d->kind == GLINT_SHAPE_CONE;
    for (int c = 0; c < 3; c++) {
        const bool box = d->kind == GLINT_SHAPE_BOX;
        unit[c][c] = box ? ((quad)d->max[c] - d->min[c]) / 2 : (quad)d->radius;
        unit[c][3] = box ? ((quad)d->max[c] + d->min[c]) / 2 : (quad)d->center[c];
        if (cylinder || cone) {
            unit[c][0] = c == 0 ? (quad)d->radius : 0;
            unit[c][1] = c == 2 ? (quad)d->radius : 0;
            unit[c][2] = cone ? (quad)d->base[c] - d->top[c] : ((quad)d->top[c] - d->base[c]) / 2;
            unit[c][3] = cone ? (quad)d->top[c] : ((quad)d->top[c] + d->base[c]) / 2;
        }
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            whole[i][j] = j == 3 ? (quad)map.m[i][3] : 0;
            for (int k = 0; k < 3; k++)
                whole[i][j] += (quad)map.m[i][k] * unit[k][j];
        }
    invert(whole, n->inverse);
}

static void map_point(const glint_transform *map, const double p[3], double w, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = ((map->m[i][0] * p[0] + map->m[i][1] * p[1]) + map->m[i][2] * p[2]) + map->m[i][3] * w;
}

static int random_mesh(glint_shape *whole, const glint_transform *around)
{
    closed_mesh *mesh = &meshes[mesh_count];
    const bool mapped = one_in(2);
    const glint_transform none = glint_transform_identity(), own = mapped ? random_map(0.5) : none;
    const glint_transform map = glint_transform_product(around, &own);
    random_closed_mesh(mesh);
    put_in(whole, closed_mesh_shape(mesh, one_in(3), one_in(2) ? GLINT_SHADING_PHONG : GLINT_SHADING_FACETED, &own));
    for (int i = 0; i < 9 * mesh->count; i += 3) {
        double moved[3];
        map_point(&map, &mesh->corner[0][0][0] + i, 1, moved);
        memcpy(&mesh->corner[0][0][0] + i, moved, sizeof moved);
    }
    nodes[node_count] = (node) { .kind = GLINT_SHAPE_MESH, .mesh = mesh_count++ };
    part_count += 4;
    return node_count++;
}

/// Adds a random leaf; a plane only if `plane`, because planes occur only under the identity map.
static int random_part(glint_shape *whole, const glint_transform *around, bool plane)
{
    static const glint_shape_kind kinds[] = { GLINT_SHAPE_SPHERE, GLINT_SHAPE_BOX, GLINT_SHAPE_CYLINDER,
                                              GLINT_SHAPE_CONE };
    if (with_meshes && !plane && one_in(2))
        return random_mesh(whole, around);
    node *n = &nodes[node_count];
    glint_shape_desc d = glint_shape_desc_default(plane ? GLINT_SHAPE_PLANE : kinds[below(4)]);
    if (with_tori && !plane && one_in(4)) {
        d = glint_shape_desc_default(GLINT_SHAPE_TORUS);
        random_vector(d.axis, 1);
        d.major = between(0.5, 1.4);
        d.minor = d.major * between(0.1, 0.9);
        part_count++;
    }
    random_vector(d.center, 1);
    random_vector(d.base, 1);
    random_vector(d.point, 0.7);
    random_vector(d.normal, 1);
    memcpy(d.top, d.base, sizeof d.top);
    d.top[1] += between(0.5, 2);
    for (int c = 0; c < 3; c++) {
        d.min[c] = between(-1.5, 0);
        d.max[c] = between(0.2, 1.5);
    }
    d.radius = between(0.4, 1.4);
    if (!plane && one_in(2))
        d.transform = random_map(0.5);
    *n = (node) { .kind = d.kind };
    memcpy(n->normal, d.normal, sizeof n->normal);
    memcpy(n->point, d.point, sizeof n->point);
    note_part(n, &d, around);
    part_count++;
    put_in(whole, made(&d));
    return node_count++;
}

/// Makes a set operation of kind `kind` on random parts.
static int random_set(glint_shape **out, const glint_transform *around, glint_shape_kind kind, int depth)
{
    const int at = node_count++;
    glint_shape_desc d = glint_shape_desc_default(kind);
    if (one_in(2))
        d.transform = random_map(0.5);
    const glint_transform map = glint_transform_product(around, &d.transform), none = glint_transform_identity();
    const bool plain = memcmp(&map, &none, sizeof map) == 0;
    glint_shape *whole = *out = made(&d);
    nodes[at] = (node) { .kind = kind };
    const int count = 1 + (int)below(3);
    for (int i = 0; i < count; i++) {
        int child;
        if (depth > 0 && one_in(3) && node_count < MOST_NODES - 8) {
            glint_shape *inner;
            child = random_set(&inner, &map, (glint_shape_kind)(GLINT_SHAPE_GROUP + below(4)), depth - 1);
            put_in(whole, inner);
        } else {
            child = random_part(whole, &map, plain && one_in(8));
        }
        nodes[at].children[nodes[at].count++] = child;
    }
    return at;
}

static glint_shape *random_whole(int depth)
{
    const glint_transform none = glint_transform_identity();
    glint_shape *whole;
    do {
        node_count = part_count = mesh_count = 0;
        random_set(&whole, &none, (glint_shape_kind)(GLINT_SHAPE_UNION + below(3)), depth);
        if (part_count > 60)
            glint_shape_release(whole);
    } while (part_count > 60);
    return whole;
}

static bool in_part(const node *n, const quad p[3])
{
    if (n->kind == GLINT_SHAPE_MESH) {
        const int times = times_inside(&meshes[n->mesh], p); // the count is negative under a mirroring map
        return times != 0;
    }
    quad k[3], height = 0;
    for (int i = 0; i < 3; i++) {
        height += (quad)n->normal[i] * (p[i] - n->point[i]);
        k[i] = n->inverse[i][3];
        for (int j = 0; j < 3; j++)
            k[i] += n->inverse[i][j] * p[j];
    }
    const quad round = k[0] * k[0] + k[1] * k[1], z = k[2];
    switch (n->kind) {
    case GLINT_SHAPE_PLANE:
        return height < 0;
    case GLINT_SHAPE_SPHERE:
        return round + z * z < 1;
    case GLINT_SHAPE_BOX:
        return k[0] * k[0] < 1 && k[1] * k[1] < 1 && z * z < 1;
    case GLINT_SHAPE_CYLINDER:
        return round < 1 && z * z < 1;
    default:
        return round < z * z && z > 0 && z < 1;
    }
}

static bool in_set(int at, const quad p[3])
{
    const node *n = &nodes[at];
    if (n->kind < GLINT_SHAPE_GROUP)
        return in_part(n, p);
    bool in = in_set(n->children[0], p);
    for (int i = 1; i < n->count; i++) {
        const bool other = in_set(n->children[i], p);
        in = n->kind == GLINT_SHAPE_INTERSECTION ? in && other
             : n->kind == GLINT_SHAPE_DIFFERENCE ? in && !other
                                                 : in || other;
    }
    return in;
}

// ---- All points where a ray can enter or leave ----

static quad roots[(12 + CLOSED_TRIANGLES) * MOST_NODES];
static bool near_edge; ///< whether the current ray passes close to an edge
static int root_count;

static void add_root(quad t)
{
    if (t > 0)
        roots[root_count++] = t;
}

static quad square_root(quad x)
{
    quad s = (quad)sqrt((double)x);
    for (int i = 0; i < 3 && s > 0; i++)
        s = (s + x / s) / 2;
    return s;
}

/// Adds the roots of a t^2 + 2 b t + c = 0.
static void add_roots(quad a, quad b, quad c)
{
    const quad disc = b * b - a * c;
    if (disc < 0 || a == 0)
        return;
    add_root((-b - square_root(disc)) / a);
    add_root((-b + square_root(disc)) / a);
}

static void mesh_roots(closed_mesh *mesh, const double o[3], const double d[3])
{
    const quad from[3] = { o[0], o[1], o[2] };
    bool sure = true;
    for (int i = 0; i < mesh->count; i++) {
        quad t;
        if (quad_crossing(mesh->corner[i], from, d, &t, &sure))
            add_root(t);
    }
    near_edge = near_edge || !sure;
}

static void roots_of(const node *n, const double o[3], const double d[3])
{
    if (n->kind == GLINT_SHAPE_MESH) {
        mesh_roots(&meshes[n->mesh], o, d);
        return;
    }
    quad f[3], e[3], height = 0, rise = 0;
    for (int i = 0; i < 3; i++) {
        height += (quad)n->normal[i] * ((quad)o[i] - n->point[i]);
        rise += (quad)n->normal[i] * d[i];
        f[i] = n->inverse[i][3];
        e[i] = 0;
        for (int j = 0; j < 3; j++) {
            f[i] += n->inverse[i][j] * o[j];
            e[i] += n->inverse[i][j] * d[j];
        }
    }
    if (n->kind == GLINT_SHAPE_PLANE) {
        add_root(-height / rise);
        return;
    }
    const quad z = n->kind == GLINT_SHAPE_SPHERE ? 1 : n->kind == GLINT_SHAPE_CONE ? -1 : 0;
    const quad one = n->kind == GLINT_SHAPE_CONE ? 0 : 1;
    if (n->kind != GLINT_SHAPE_BOX)
        add_roots(e[0] * e[0] + e[1] * e[1] + z * e[2] * e[2], f[0] * e[0] + f[1] * e[1] + z * f[2] * e[2],
                  f[0] * f[0] + f[1] * f[1] + z * f[2] * f[2] - one);
    for (int c = n->kind == GLINT_SHAPE_BOX ? 0 : 2; c < 3 && n->kind != GLINT_SHAPE_SPHERE; c++) {
        add_root((1 - f[c]) / e[c]);
        add_root((-1 - f[c]) / e[c]);
    }
}

static int by_value(const void *a, const void *b)
{
    const quad x = *(const quad *)a, y = *(const quad *)b;
    return (x > y) - (x < y);
}

static void at_way(const double o[3], const double d[3], quad t, quad p[3])
{
    for (int c = 0; c < 3; c++)
        p[c] = o[c] + t * d[c];
}

/// Returns the distance at which the ray first enters or leaves the shape; 0 if it never does. *sure becomes false if
/// another root is so close that rounding could swap the two.
static quad first_change(const double o[3], const double d[3], bool *sure)
{
    quad p[3], close = 1;
    root_count = 0;
    near_edge = false;
    for (int i = 0; i < node_count; i++)
        if (nodes[i].kind < GLINT_SHAPE_GROUP)
            roots_of(&nodes[i], o, d);
    qsort(roots, (size_t)root_count, sizeof *roots, by_value);
    for (int i = 0; i + 1 < root_count; i++)
        close = roots[i + 1] - roots[i] < close ? roots[i + 1] - roots[i] : close;
    *sure = close > 1e-7 && (root_count == 0 || roots[0] > 1e-7) && !near_edge;
    at_way(o, d, root_count ? roots[0] / 2 : 1, p);
    const bool within = in_set(0, p);
    for (int i = 0; i < root_count; i++) {
        at_way(o, d, i + 1 < root_count ? (roots[i] + roots[i + 1]) / 2 : roots[i] + 1, p);
        if (in_set(0, p) != within)
            return roots[i];
    }
    return 0;
}

static void check_hit(uint64_t seed, const double o[3], const double d[3], const glint_hit *got, quad want)
{
    quad p[3], out[3], in[3];
    if (fabs((double)(got->t / want - 1)) > 1e-11)
        fail_msg("seed %d: t %.17g, wanted %.17g", (int)seed, got->t, (double)want);
    at_way(o, d, want, p);
    for (int c = 0; c < 3; c++) {
        out[c] = p[c] + 1e-8 * got->normal[c];
        in[c] = p[c] - 1e-8 * got->normal[c];
        if (fabs((double)(p[c] - got->point[c])) > 1e-11)
            fail_msg("seed %d: %g off the surface", (int)seed, (double)(p[c] - got->point[c]));
    }
    if (in_set(0, out) || !in_set(0, in))
        fail_msg("seed %d: the normal does not point outwards", (int)seed);
}

/// Random CSG trees against point sets: the first change of inside to outside or back is the hit,
/// and its normal points outwards.
static void against_sets(uint64_t seeds)
{
    int hits = 0, sure_rays = 0, rays = 0;
    with_tori = false;
    for (uint64_t seed = 1; seed <= seeds; seed += case_step()) {
        glint_scene *scene;
        random_state = seed;
        glint_shape *whole = random_whole(3);
        assert_int_equal(glint_scene_create(&scene, NULL), GLINT_OK);
        assert_int_equal(glint_scene_add_shape(scene, whole, NULL), GLINT_OK);
        for (int i = 0; i < 8; i++, rays++) {
            double o[3], d[3];
            glint_hit got;
            bool hit = false, sure;
            random_vector(o, one_in(3) ? 1 : 4);
            random_vector(d, 1);
            for (int c = 0; c < 3; c++)
                d[c] -= o[c];
            const quad want = first_change(o, d, &sure);
            assert_int_equal(glint_scene_cast(scene, o, d, &hit, &got, NULL), GLINT_OK);
            if (!sure)
                continue;
            sure_rays++;
            hits += hit;
            if (hit != (want > 0))
                fail_msg("seed %d: %s, %g", (int)seed, hit ? "hit" : "missed", (double)want);
            if (hit)
                check_hit(seed, o, d, &got, want);
            assert_true(!hit || (got.shape == whole && got.element < (size_t)part_count));
        }
        glint_shape_release(whole);
        glint_scene_release(scene);
    }
    assert_true(sure_rays > rays * 9 / 10 && hits > rays / 4);
}

static void wholes_against_sets(void **unused)
{
    (void)unused;
    with_meshes = false;
    against_sets(3000);
}

/// Leaves may be meshes. Counting crossings in 113-bit arithmetic decides whether a point is inside a mesh.
static void meshes_against_sets(void **unused)
{
    (void)unused;
    with_meshes = true;
    against_sets(2000);
}

// ---- Pictures ----

static glint_material *random_material(void)
{
    glint_material *material;
    glint_material_desc d = glint_material_desc_default();
    for (int c = 0; c < 3; c++) {
        d.diffuse[c] = between(0, 1);
        d.absorption[c] = between(0, 0.3);
    }
    const uint32_t sort = below(4);
    for (int c = 0; c < 3; c++) {
        d.mirror[c] = sort == 1 ? 0.5 : 0;
        d.transmission[c] = sort == 2 ? 0.8 : 0;
    }
    assert_int_equal(glint_material_create(&d, &material, NULL), GLINT_OK);
    return material;
}

static void dress(glint_shape *shape)
{
    glint_shape_desc d = *glint_shape_get(shape);
    d.struct_size = sizeof d;
    if (one_in(2) && d.kind != GLINT_SHAPE_GROUP) {
        d.material = random_material();
        d.two_sided = !one_in(4);
        assert_int_equal(glint_shape_set(shape, &d, NULL), GLINT_OK);
        glint_material_release(d.material);
    }
    for (size_t i = 0; i < glint_group_count(shape); i++)
        dress(glint_group_child(shape, i));
}

static void add(glint_scene *scene, glint_shape *shape)
{
    assert_int_equal(glint_scene_add_shape(scene, shape, NULL), GLINT_OK);
    glint_shape_release(shape);
}

static void add_light(glint_scene *scene)
{
    static const glint_light_kind kinds[] = { GLINT_LIGHT_POINT, GLINT_LIGHT_POINT, GLINT_LIGHT_DIRECTIONAL,
                                              GLINT_LIGHT_SPHERE, GLINT_LIGHT_DISK };
    glint_light *lamp;
    glint_light_desc l = glint_light_desc_default(kinds[below(5)]);
    random_vector(l.position, 6);
    random_vector(l.direction, 1);
    l.radius = 0.5;
    l.samples = 5;
    assert_int_equal(glint_light_create(&l, &lamp, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_light(scene, lamp, NULL), GLINT_OK);
    glint_light_release(lamp);
}

/// Makes a lit scene, with a floor if `floor`, and if `many` with so many objects that tiles traverse the BVH.
static glint_scene *lit_scene(bool floor, bool many)
{
    glint_scene *scene;
    glint_camera *camera;
    glint_camera_desc c = glint_camera_desc_default();
    random_vector(c.eye, one_in(4) ? 1 : 7);
    c.fov_y_rad = between(0.4, 1.2);
    if (one_in(4)) {
        c.projection = GLINT_PROJECTION_ORTHOGRAPHIC;
        c.height = 6;
    }
    assert_int_equal(glint_scene_create(&scene, NULL), GLINT_OK);
    assert_int_equal(glint_camera_create(&c, &camera, NULL), GLINT_OK);
    glint_scene_desc desc = { .struct_size = sizeof(glint_scene_desc), .camera = camera, .ambient = { 0.1, 0.1, 0.1 }, .background = { 0.2, 0.3, 0.4 } };
    desc.has_indirect = one_in(6);
    desc.indirect_samples = 2;
    desc.indirect_bounces = 1;
    assert_int_equal(glint_scene_set(scene, &desc, NULL), GLINT_OK);
    glint_camera_release(camera);
    for (uint32_t i = 1 + below(2); i > 0; i--)
        add_light(scene);
    glint_shape_desc plane = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    plane.point[1] = -1.5;
    if (floor)
        add(scene, made(&plane));
    for (int i = 0; many && i < 40; i++) {
        glint_shape_desc ball = glint_shape_desc_default(one_in(2) ? GLINT_SHAPE_SPHERE : GLINT_SHAPE_BOX);
        random_vector(ball.center, 4);
        ball.radius = between(0.05, 0.3);
        for (int k = 0; k < 3; k++) {
            ball.min[k] = ball.center[k] - ball.radius;
            ball.max[k] = ball.center[k] + ball.radius;
        }
        add(scene, made(&ball));
    }
    return scene;
}

static glint_image *render(const glint_scene *scene, const char *isa, int threads, glint_precision precision)
{
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
    glint_renderer_desc r = { .struct_size = sizeof(glint_renderer_desc), .threads = threads, .isa = isa };
    glint_render_desc d = glint_render_desc_default();
    glint_error error;
    d.width = d.height = 48;
    d.precision = precision;
    d.passes = 1u << GLINT_PASS_BEAUTY | 1u << GLINT_PASS_DEPTH | 1u << GLINT_PASS_NORMAL | 1u << GLINT_PASS_OBJECT_ID;
    const glint_status status = glint_renderer_create(&r, &renderer, &error);
    if (status == GLINT_ERR_UNSUPPORTED)
        return NULL;
    assert_int_equal(status, GLINT_OK);
    if (glint_plan_create(scene, &d, &plan, &error))
        fail_msg("%s", error.message);
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

static void same_on_every_set(uint64_t seeds)
{
    with_tori = true;
    for (uint64_t seed = 1; seed <= seeds; seed += case_step())
        for (int precision = 0; precision < 2; precision++) {
            random_state = seed;
            glint_scene *scene = lit_scene(one_in(2), one_in(3));
            for (uint32_t i = 1 + below(3); i > 0; i--) {
                glint_shape *whole = random_whole(2);
                dress(whole);
                add(scene, whole);
            }
            glint_image *want = render(scene, "ref", 1, (glint_precision)precision);
            for (size_t i = FIRST_KERNELS; i < INSTRUCTION_SETS; i++) {
                glint_image *got = render(scene, instruction_sets[i], (int)i, (glint_precision)precision);
                if (got && differing(want, got))
                    fail_msg("seed %d, %s, precision %d: %d pixels", (int)seed, instruction_sets[i], precision,
                             differing(want, got));
                glint_image_release(got);
            }
            glint_image_release(want);
            glint_scene_release(scene);
        }
}

static void same_on_every_instruction_set(void **unused)
{
    (void)unused;
    with_meshes = false;
    same_on_every_set(60);
}

static void meshes_on_every_instruction_set(void **unused)
{
    (void)unused;
    with_meshes = true;
    same_on_every_set(60);
}

/// A box, ball or cylinder around a grid point. On the grid, faces coincide. Eyes are between the grid points.
static glint_shape *grid_part(const double place[3], glint_shape_kind kind)
{
    glint_shape_desc d = glint_shape_desc_default(kind);
    for (int c = 0; c < 3; c++) {
        d.center[c] = d.base[c] = d.top[c] = place[c] + 0.125 * (below(5) - 2.0);
        d.min[c] = d.center[c] - 0.125 * (1 + below(3));
        d.max[c] = d.center[c] + 0.125 * (1 + below(3));
    }
    d.top[below(3)] += 0.125 * (1 + below(4));
    d.radius = 0.125 * (1 + below(4));
    if (one_in(6))
        d.transform = random_map(0.1);
    return made(&d);
}

/// Many small CSG shapes among boxes, so that tiles find them through the BVH. Data computed once for the eye must be
/// right for all rays.
static void many_small_wholes(void **unused)
{
    static const glint_shape_kind kinds[] = { GLINT_SHAPE_BOX, GLINT_SHAPE_BOX, GLINT_SHAPE_SPHERE,
                                              GLINT_SHAPE_CYLINDER };
    (void)unused;
    for (uint64_t seed = 1; seed <= 60; seed += case_step()) {
        random_state = seed;
        glint_scene *scene = lit_scene(one_in(2), false);
        for (int i = 0; i < 60; i++) {
            double place[3];
            for (int c = 0; c < 3; c++)
                place[c] = 0.5 * (below(9) - 4.0);
            glint_shape *whole = one_in(3) ? grid_part(place, GLINT_SHAPE_BOX)
                                           : new_whole((glint_shape_kind)(GLINT_SHAPE_UNION + below(3)));
            for (uint32_t k = glint_shape_get(whole)->kind == GLINT_SHAPE_BOX ? 0 : 2 + below(2); k > 0; k--)
                put_in(whole, grid_part(place, kinds[below(4)]));
            dress(whole);
            add(scene, whole);
        }
        glint_image *want = render(scene, "ref", 1, GLINT_PRECISION_DOUBLE);
        for (size_t i = FIRST_KERNELS; i < INSTRUCTION_SETS; i++) {
            glint_image *got = render(scene, instruction_sets[i], 1, GLINT_PRECISION_DOUBLE);
            if (got && differing(want, got))
                fail_msg("seed %d, %s: %d pixels", (int)seed, instruction_sets[i], differing(want, got));
            glint_image_release(got);
        }
        glint_image_release(want);
        glint_scene_release(scene);
    }
}

// ---- CSG shapes that equal one solid ----

static const glint_shape_kind solids[] = { GLINT_SHAPE_SPHERE, GLINT_SHAPE_BOX, GLINT_SHAPE_CYLINDER, GLINT_SHAPE_CONE,
                                           GLINT_SHAPE_TORUS };

static glint_shape *random_solid(glint_shape_kind kind)
{
    glint_shape_desc d = glint_shape_desc_default(kind);
    random_vector(d.base, 0.5);
    memcpy(d.top, d.base, sizeof d.top);
    d.top[1] += between(0.8, 1.5);
    d.radius = between(0.5, 1.2);
    d.major = between(0.5, 1);
    d.minor = d.major * between(0.1, 0.9);
    d.transform = random_map(0.3); // turns a ball into an ellipsoid
    d.material = random_material();
    glint_shape *shape = made(&d);
    glint_material_release(d.material);
    return shape;
}

/// A cube from -size to size on every axis, moved along x.
static glint_shape *cube(double size, double x)
{
    glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_BOX);
    for (int c = 0; c < 3; c++) {
        d.min[c] = -size + (c == 0 ? x : 0);
        d.max[c] = size + (c == 0 ? x : 0);
    }
    return made(&d);
}

/// Returns a set operation that leaves the solid unchanged: union with itself, intersection with a larger box,
/// difference with a distant box, or difference with a shell around it.
static glint_shape *same_solid(glint_shape *solid, uint32_t way)
{
    static const glint_shape_kind kinds[] = { GLINT_SHAPE_UNION, GLINT_SHAPE_INTERSECTION, GLINT_SHAPE_DIFFERENCE,
                                              GLINT_SHAPE_DIFFERENCE };
    glint_shape *whole = new_whole(kinds[way]), *hollow = NULL;
    put_in(whole, glint_shape_retain(solid));
    if (way == 1)
        put_in(whole, cube(50, 0));
    if (way == 2)
        put_in(whole, cube(1, 60));
    if (way == 3) { // a hollow box around the solid
        hollow = new_whole(GLINT_SHAPE_DIFFERENCE);
        put_in(hollow, cube(60, 0));
        put_in(hollow, cube(55, 0));
        put_in(whole, hollow);
    }
    return whole;
}

/// In glass, mirrors, shadows and indirect light, the picture is identical to the last bit.
static void wholes_of_one_solid(void **unused)
{
    (void)unused;
    for (uint64_t seed = 1; seed <= 200; seed += case_step()) {
        glint_image *image[2];
        for (int i = 0; i < 2; i++) {
            random_state = seed;
            glint_scene *scene = lit_scene(seed % 2, seed % 3 == 0);
            glint_shape *solid = random_solid(solids[seed % 5]);
            add(scene, i == 0 ? glint_shape_retain(solid) : same_solid(solid, (uint32_t)(seed / 5 % 4)));
            image[i] = render(scene, NULL, 2, GLINT_PRECISION_DOUBLE);
            glint_shape_release(solid);
            glint_scene_release(scene);
        }
        if (differing(image[0], image[1]))
            fail_msg("seed %d: %d pixels", (int)seed, differing(image[0], image[1]));
        glint_image_release(image[0]);
        glint_image_release(image[1]);
    }
}

/// Counts the pixels that differ by more than 2^-18 of their values, which rounding of positions and light can
/// explain. *hits gets the number of hits in `a`.
static int unlike(const glint_image *a, const glint_image *b, int *hits)
{
    static const glint_pass passes[] = { GLINT_PASS_BEAUTY, GLINT_PASS_DEPTH, GLINT_PASS_NORMAL };
    int count = 0;
    for (int y = 0; y < glint_image_height(a); y++)
        for (int x = 0; x < glint_image_width(a); x++) {
            bool same = true;
            for (int pass = 0; pass < 3; pass++) {
                float p[3] = { 0 }, q[3] = { 0 };
                glint_image_pixel(a, passes[pass], x, y, p, NULL);
                glint_image_pixel(b, passes[pass], x, y, q, NULL);
                for (int c = 0; c < 3; c++)
                    same = same && (p[c] == q[c] || fabsf(p[c] - q[c]) <= 0x1p-18f * (1 + fabsf(p[c])));
                *hits += pass == 1 && isfinite(p[0]);
            }
            count += !same;
        }
    return count;
}

/// A mesh box minus a ball, cut by a block that ends in one of its faces, against the same shape with a plain box, in
/// glass, mirrors and shadows.
static void boxes_of_triangles(void **unused)
{
    int hits = 0, off = 0;
    (void)unused;
    for (uint64_t seed = 1; seed <= 200; seed += case_step()) {
        glint_image *image[2];
        for (int i = 0; i < 2; i++) {
            random_state = seed;
            glint_scene *scene = lit_scene(seed % 2, seed % 3 == 0);
            glint_shape_desc d = glint_shape_desc_default((glint_shape_kind)(GLINT_SHAPE_UNION + below(3)));
            glint_shape_desc box = glint_shape_desc_default(GLINT_SHAPE_BOX),
                             ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
            d.transform = random_map(0.5);
            d.material = random_material();
            random_vector(box.max, 0.5);
            for (int c = 0; c < 3; c++)
                box.max[c] += 1;
            random_vector(ball.center, 1);
            glint_shape_desc cut = box;
            cut.min[0] = cut.min[1] = -0.3;
            closed_mesh mesh = { 0 };
            make_box(&mesh, box.min, box.max);
            glint_shape *whole = made(&d);
            put_in(whole, i ? closed_mesh_shape(&mesh, one_in(2), GLINT_SHADING_FACETED, &box.transform) : made(&box));
            if (!i)
                (void)one_in(2);
            put_in(whole, made(&ball));
            put_in(whole, made(&cut));
            add(scene, whole);
            image[i] = render(scene, NULL, 2, GLINT_PRECISION_DOUBLE);
            glint_material_release(d.material);
            glint_scene_release(scene);
        }
        off += unlike(image[0], image[1], &hits);
        glint_image_release(image[0]);
        glint_image_release(image[1]);
    }
    assert_int_equal(off, 0);
    assert_true(hits * (int)case_step() > 50000);
}

// ---- Coincident faces ----

static glint_shape *block(double x0, double x1, double y0, double y1, double z0, double z1)
{
    glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_BOX);
    const double low[3] = { x0, y0, z0 }, high[3] = { x1, y1, z1 };
    memcpy(d.min, low, sizeof low);
    memcpy(d.max, high, sizeof high);
    return made(&d);
}

static void turn(glint_shape *shape, bool turned)
{
    glint_shape_desc d = *glint_shape_get(shape);
    d.struct_size = sizeof d;
    if (turned)
        d.transform = random_map(3);
    assert_int_equal(glint_shape_set(shape, &d, NULL), GLINT_OK);
}

/// Casts a ray from above, in the shape's own space, at a point with y = 1 and x and z within -1 .. 1.
static bool look_down(const glint_scene *scene, const glint_shape *shape, double at[3], glint_hit *hit)
{
    double o[3], d[3], own[3], to[3];
    bool any;
    const glint_transform *map = &glint_shape_get(shape)->transform;
    at[0] = one_in(4) ? 0.25 * (below(9) - 4.0) : between(-1, 1);
    at[2] = one_in(4) ? 0.25 * (below(9) - 4.0) : between(-1, 1);
    at[1] = 1;
    for (int c = 0; c < 3; c++)
        own[c] = at[c] + (c == 1 ? between(0.5, 4) : one_in(3) ? 0 : between(-2, 2));
    for (int c = 0; c < 3; c++)
        to[c] = at[c] - own[c];
    map_point(map, own, 1, o);
    map_point(map, to, 0, d);
    assert_int_equal(glint_scene_cast(scene, o, d, &any, hit, NULL), GLINT_OK);
    return any;
}

/// A cutter that ends exactly in the face leaves the same hole as a longer one: no ray hits a skin over the hole.
static void flush_cutters(void **unused)
{
    int through = 0;
    (void)unused;
    for (uint64_t seed = 1; seed <= 400; seed += case_step()) {
        glint_scene *scenes[2];
        glint_shape *whole[2];
        for (int i = 0; i < 2; i++) {
            random_state = seed;
            whole[i] = new_whole(GLINT_SHAPE_DIFFERENCE);
            put_in(whole[i], block(-1, 1, -1, 1, -1, 1));
            put_in(whole[i], block(-0.5, 0.5, -0.25, i ? 2 : 1, -0.5, 0.5));
            turn(whole[i], seed % 4 != 0);
            assert_int_equal(glint_scene_create(&scenes[i], NULL), GLINT_OK);
            assert_int_equal(glint_scene_add_shape(scenes[i], whole[i], NULL), GLINT_OK);
        }
        for (int n = 0; n < 40; n++) {
            glint_hit got[2];
            bool hit[2];
            double at[3];
            const uint64_t state = random_state;
            for (int i = 0; i < 2; i++) {
                random_state = state;
                hit[i] = look_down(scenes[i], whole[i], at, &got[i]);
            }
            const bool open = fabs(at[0]) < 0.499 && fabs(at[2]) < 0.499;
            through += open;
            if (hit[0] != hit[1] || (hit[0] && open && memcmp(&got[0].t, &got[1].t, sizeof got[0].t)))
                fail_msg("seed %d: t %.17g, with the longer cutter %.17g", (int)seed, got[0].t, got[1].t);
        }
        for (int i = 0; i < 2; i++) {
            glint_scene_release(scenes[i]);
            glint_shape_release(whole[i]);
        }
    }
    assert_true(through * (int)case_step() > 1000);
}

/// Two halves of a block equal the whole block: no ray sees a gap or a face between them.
static void halves_are_whole(void **unused)
{
    (void)unused;
    for (uint64_t seed = 1; seed <= 400; seed += case_step()) {
        glint_scene *scenes[2];
        glint_shape *whole[2];
        for (int i = 0; i < 2; i++) {
            random_state = seed;
            whole[i] = new_whole(GLINT_SHAPE_UNION);
            put_in(whole[i], i ? block(-1, 1, -1, 1, -1, 1) : block(-1, 0, -1, 1, -1, 1));
            if (i == 0)
                put_in(whole[i], block(0, 1, -1, 1, -1, 1));
            turn(whole[i], seed % 4 != 0);
            assert_int_equal(glint_scene_create(&scenes[i], NULL), GLINT_OK);
            assert_int_equal(glint_scene_add_shape(scenes[i], whole[i], NULL), GLINT_OK);
        }
        for (int n = 0; n < 40; n++) {
            double o[3], d[3], at[3];
            glint_hit got[2];
            bool hit[2];
            random_vector(at, n % 2 ? 1 : 5); // the ray may also start inside
            for (int c = 0; c < 3; c++)
                at[c] = one_in(4) ? (double)(int)at[c] : at[c];
            map_point(&glint_shape_get(whole[0])->transform, at, 1, o);
            random_vector(at, 1);
            at[0] = one_in(3) ? 0 : at[0]; // a point in the plane between the halves
            map_point(&glint_shape_get(whole[0])->transform, at, 1, d);
            for (int c = 0; c < 3; c++)
                d[c] -= o[c];
            for (int i = 0; i < 2; i++)
                assert_int_equal(glint_scene_cast(scenes[i], o, d, &hit[i], &got[i], NULL), GLINT_OK);
            if (hit[0] != hit[1] || (hit[0] && memcmp(&got[0].t, &got[1].t, sizeof got[0].t)))
                fail_msg("seed %d, ray %d: t %.17g of halves, %.17g of the whole", (int)seed, n, hit[0] ? got[0].t : 0,
                         hit[1] ? got[1].t : 0);
        }
        for (int i = 0; i < 2; i++) {
            glint_scene_release(scenes[i]);
            glint_shape_release(whole[i]);
        }
    }
}

/// A solid minus itself is empty, for every kind of solid and from every direction.
static void nothing_is_left(void **unused)
{
    (void)unused;
    for (uint64_t seed = 1; seed <= 400; seed += case_step()) {
        glint_scene *scene;
        random_state = seed;
        glint_shape *solid = random_solid(solids[seed % 5]), *whole = new_whole(GLINT_SHAPE_DIFFERENCE);
        const glint_shape_desc d = *glint_shape_get(solid);
        put_in(whole, solid);
        put_in(whole, made(&d));
        assert_int_equal(glint_scene_create(&scene, NULL), GLINT_OK);
        add(scene, whole);
        for (int n = 0; n < 40; n++) {
            double o[3], to[3];
            glint_hit got;
            bool hit;
            random_vector(o, 4);
            random_vector(to, 1);
            for (int c = 0; c < 3; c++)
                to[c] -= o[c];
            assert_int_equal(glint_scene_cast(scene, o, to, &hit, &got, NULL), GLINT_OK);
            if (hit)
                fail_msg("seed %d: something at %.17g", (int)seed, got.t);
        }
        glint_scene_release(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wholes_against_sets), cmocka_unit_test(same_on_every_instruction_set),
        cmocka_unit_test(meshes_against_sets), cmocka_unit_test(meshes_on_every_instruction_set),
        cmocka_unit_test(wholes_of_one_solid), cmocka_unit_test(boxes_of_triangles),
        cmocka_unit_test(flush_cutters),       cmocka_unit_test(many_small_wholes),
        cmocka_unit_test(halves_are_whole),    cmocka_unit_test(nothing_is_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
