/// Test cases with one ray and one object, and variations: each case again with axes swapped and mirrored, rotated,
/// scaled, moved and with other lengths of the direction. --table prints one line per case: the truth, the engine's
/// results in double and float, and the result of the textbook's formula.
#include "tests/hard/oracle/drive.h"
#include "tests/hard/oracle/judge.h"
#include "tests/hard/oracle/naive.h"
#include "tests/hard/oracle/ray_cases.h"

#include <math.h>
#include <string.h>

// ---- The engine ----

typedef struct answer {
    bool hit;
    glint_hit at;
} answer;

static answer ask(const hard_ray *ray, const hard_sphere *sphere)
{
    answer out = { 0 };
    glint_scene *scene = scene_new();
    scene_sphere(scene, sphere, NULL);
    out.hit = cast(scene, ray, &out.at);
    glint_scene_release(scene);
    return out;
}

/// Checks that the same sphere, as the only sphere of a glint.spheres, gives the same bits.
static bool requested_as_spheres(const hard_ray *ray, const hard_sphere *sphere, const answer *one)
{
    glint_error error;
    glint_shape *shape;
    glint_hit hit;
    const double row[4] = { sphere->c[0], sphere->c[1], sphere->c[2], sphere->r };
    const glint_spheres_desc desc = { .struct_size = sizeof(glint_spheres_desc), .data = row, .count = 1, .two_sided = true };
    glint_scene *scene = scene_new();
    must(glint_spheres_create(&desc, &shape, &error), &error);
    must(glint_scene_add_shape(scene, shape, &error), &error);
    glint_shape_release(shape);
    const bool found = cast(scene, ray, &hit);
    glint_scene_release(scene);
    return found == one->hit && (!found || (hit.t == one->at.t && hit.element == 0 &&
                                            !memcmp(hit.normal, one->at.normal, sizeof hit.normal)));
}

static judgement judge_answer(const hard_ray *ray, const hard_sphere *sphere, const answer *got)
{
    const truth want = oracle_sphere(ray, sphere);
    return judge_sphere(ray, sphere, &want, got->hit, &got->at);
}

/// Renders one pixel along the ray. Returns whether it hits;
/// *t gets the distance in units of |d|, from the float32 depth pass.
static bool framed(const hard_ray *ray, const hard_sphere *sphere, glint_precision precision, double *t)
{
    float depth[3], id[3];
    glint_scene *scene = scene_new();
    scene_sphere(scene, sphere, NULL);
    glint_image *image = frame_of_ray(scene, ray, precision, 1u << GLINT_PASS_DEPTH | 1u << GLINT_PASS_OBJECT_ID);
    pixel(image, GLINT_PASS_DEPTH, 0, 0, depth);
    pixel(image, GLINT_PASS_OBJECT_ID, 0, 0, id);
    glint_image_release(image);
    glint_scene_release(scene);
    *t = (double)depth[0] / hypot(hypot(ray->d[0], ray->d[1]), ray->d[2]);
    return id[0] == 1;
}

static void print_found(bool hit, double t, const truth *want)
{
    if (hit && want->hit)
        printf(" %.0e |", fabs(t / want->t - 1));
    else
        printf(" %s |", hit == want->hit      ? "miss"
                        : want->tangency == 0 ? (hit ? "hit" : "miss")
                        : hit                 ? "**hit**"
                                              : "**miss**");
}

static void print_case(const ray_case *k, const answer *got, const truth *want, bool right)
{
    double t = 0;
    printf("| %s | %s | ", k->id, k->what);
    if (want->tangency == 0 && isnan(k->t))
        printf("tangent |");
    else
        printf(want->hit ? "%.17g |" : "miss |", want->t);
    print_found(got->hit, got->at.t, want);
    bool hit = framed(&k->ray, &k->sphere, GLINT_PRECISION_FLOAT, &t);
    print_found(hit, t, want);
    hit = naive_double(&k->ray, &k->sphere, &t);
    print_found(hit, t, want);
    hit = naive_float(&k->ray, &k->sphere, &t);
    print_found(hit, t, want);
    printf(" %s |\n", right ? "right" : "**wrong**");
}

static void check_case(const ray_case *k)
{
    const answer got = ask(&k->ray, &k->sphere);
    const truth want = oracle_sphere(&k->ray, &k->sphere);
    const double reach =
        hypot(hypot(k->ray.o[0] - k->sphere.c[0], k->ray.o[1] - k->sphere.c[1]), k->ray.o[2] - k->sphere.c[2]) +
        k->sphere.r;
    const double normal_allowed = fmax(1e-9, 8 * 0x1p-53 * reach / k->sphere.r);
    bool right = isnan(k->t) || got.hit == want.hit;
    if (got.hit && want.hit && !isnan(k->t)) {
        right = fabs(got.at.t - want.t) <= 1e-13 * want.t;
        for (int c = 0; c < 3; c++)
            right = right && fabs(got.at.normal[c] - want.n[c]) <= normal_allowed;
    } else if (got.hit) { // a tangent ray: the hit must be at the point of contact
        right = right && fabs(got.at.t / want.t - 1) < 1e-7;
    }
    hard_check(right, "truth %s t %.17g, engine %s t %.17g", want.hit ? "hit" : "miss", want.t,
               got.hit ? "hit" : "miss", got.hit ? got.at.t : 0);
    hard_check(requested_as_spheres(&k->ray, &k->sphere, &got), "another answer from a shape of many spheres");
    if (hard_table)
        print_case(k, &got, &want, right);
    // A frame's ray is rounded once more. Its depth is float32, and infinite beyond the range.
    double t;
    const bool hit = framed(&k->ray, &k->sphere, GLINT_PRECISION_DOUBLE, &t);
    if (want.tangency > 64 * 0x1p-53 && want.surface > 0)
        hard_check(hit == want.hit && (!hit || fabs(t / want.t - 1) < 1e-6 || t > 1e38), "a frame finds %g, truth %g",
                   hit ? t : 0, want.t);
}

// ---- Variations ----

/// Permutes and mirrors the axes in one of 48 ways, 0 .. 47.
static void turn_axes(double v[3], int way)
{
    static const int order[6][3] = { { 0, 1, 2 }, { 0, 2, 1 }, { 1, 0, 2 }, { 1, 2, 0 }, { 2, 0, 1 }, { 2, 1, 0 } };
    const double w[3] = { v[0], v[1], v[2] };
    for (int c = 0; c < 3; c++)
        v[c] = w[order[way % 6][c]] * (way / 6 >> c & 1 ? -1 : 1);
}

/// Rotates about a random axis (Rodrigues).
static void rotate(double v[3], const double axis[3], double angle)
{
    const double w[3] = { v[0], v[1], v[2] }, dot = axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
    for (int c = 0; c < 3; c++) {
        const int i = (c + 1) % 3, k = (c + 2) % 3;
        v[c] = w[c] * cos(angle) + (axis[i] * w[k] - axis[k] * w[i]) * sin(angle) + axis[c] * dot * (1 - cos(angle));
    }
}

static void check_variant(const hard_ray *ray, const hard_sphere *sphere, const char *how)
{
    const answer got = ask(ray, sphere);
    const judgement j = judge_answer(ray, sphere, &got);
    hard_check(j.verdict <= TOO_CLOSE, "%s: %s, %g and %g of what is allowed", how, verdict_name[j.verdict], j.t_share,
               j.normal_share);
}

/// Swapped axes and powers of two must not change any bit.
static void exact_variants(const ray_case *k)
{
    const answer plain = ask(&k->ray, &k->sphere);
    for (int way = 0; way < 48; way++) {
        hard_ray ray = k->ray;
        hard_sphere sphere = k->sphere;
        turn_axes(ray.o, way);
        turn_axes(ray.d, way);
        turn_axes(sphere.c, way);
        check_variant(&ray, &sphere, "with axes swapped");
    }
    for (int e = -40; e <= 40; e += 5)
        for (int stretch = -100; stretch <= 100; stretch += 50) {
            hard_ray ray = k->ray;
            hard_sphere sphere = k->sphere;
            for (int c = 0; c < 3; c++) {
                ray.o[c] = ldexp(ray.o[c], e);
                ray.d[c] = ldexp(ray.d[c], stretch);
                sphere.c[c] = ldexp(sphere.c[c], e);
            }
            sphere.r = ldexp(sphere.r, e);
            const answer got = ask(&ray, &sphere);
            hard_check(got.hit == plain.hit &&
                           (!got.hit || (got.at.t == ldexp(plain.at.t, e - stretch) &&
                                         !memcmp(got.at.normal, plain.at.normal, sizeof got.at.normal))),
                       "scale 2^%d, direction times 2^%d: other bits", e, stretch);
        }
}

/// Other variations round the inputs; the oracle evaluates the rounded inputs.
static void rounded_variants(const ray_case *k)
{
    static const double scales[] = { 1, 1e-6, 1e6, 3, 1 / 3.0 }, offsets[] = { 0, 1, 1e3, 1e7 };
    for (size_t s = 0; s < sizeof scales / sizeof *scales; s++)
        for (size_t m = 0; m < sizeof offsets / sizeof *offsets; m++)
            for (int turn = 0; turn < 8; turn++) {
                hard_ray ray = k->ray;
                hard_sphere sphere = k->sphere;
                double axis[3], by[3], length = log_uniform(1e-3, 1e3);
                random_direction(axis);
                random_direction(by);
                const double angle = turn ? uniform(0, 6.3) : 0;
                rotate(ray.o, axis, angle);
                rotate(ray.d, axis, angle);
                rotate(sphere.c, axis, angle);
                for (int c = 0; c < 3; c++) {
                    ray.o[c] = ray.o[c] * scales[s] + by[c] * offsets[m];
                    sphere.c[c] = sphere.c[c] * scales[s] + by[c] * offsets[m];
                    ray.d[c] *= length;
                }
                sphere.r *= scales[s];
                check_variant(&ray, &sphere, "turned, scaled and moved");
            }
}

// ---- Several objects ----

/// S28, S38: a ray hits the outer of two concentric spheres, in any order of definition,
/// and the first of two equal spheres.
static void check_pairs(void)
{
    hard_test("S28, S38", "concentric and equal spheres");
    for (int e = -40; e <= 40; e += 10)
        for (int ulps = 0; ulps <= 3; ulps++)
            for (int swapped = 0; swapped < 2; swapped++) {
                const double gap = ulps == 0 ? 0 : ldexp(1, ulps == 1 ? -23 : ulps == 2 ? -40 : -51);
                const hard_ray ray = { { ldexp(0.25, e), ldexp(0.125, e), ldexp(5, e) }, { 0, 0, -1 } };
                const hard_sphere small = { { 0 }, ldexp(1, e) }, large = { { 0 }, ldexp(1 + gap, e) };
                glint_scene *scene = scene_new();
                glint_hit hit;
                glint_shape *a = scene_sphere(scene, swapped ? &large : &small, NULL);
                glint_shape *b = scene_sphere(scene, swapped ? &small : &large, NULL);
                const bool found = cast(scene, &ray, &hit);
                const truth outer = oracle_sphere(&ray, &large);
                glint_shape *want = gap == 0 || swapped ? a : b;
                hard_check(found && hit.shape == want && fabs(hit.t / outer.t - 1) < 1e-15,
                           "gap %g, scale 2^%d, order %d", gap, e, swapped);
                glint_scene_release(scene);
            }
}

/// S39: invalid spheres and rays are refused.
static void check_refused(void)
{
    hard_test("S39", "refused by name");
    const double bad[] = { 0, -1, NAN, HUGE_VAL, -HUGE_VAL };
    glint_error error;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        glint_shape_desc desc = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
        glint_shape *shape;
        desc.radius = bad[i];
        hard_check(glint_shape_create(&desc, &shape, &error) == GLINT_ERR_INVALID &&
                       !strncmp(error.message, "radius", 6),
                   "radius %g is refused by name: %s", bad[i], error.message);
        glint_scene *scene = scene_new();
        const hard_sphere ball = { { 0 }, 1 };
        scene_sphere(scene, &ball, NULL);
        for (int c = 0; c < 3; c++) {
            bool hit;
            glint_hit got;
            double o[3] = { 0, 0, 5 }, d[3] = { 0, 0, 0 };
            o[c] = bad[i];
            d[c] = i == 1 ? 0 : bad[i]; // a direction with a component -1 is valid
            if (i >= 2)
                hard_check(glint_scene_cast(scene, o, (double[3]) { 0, 0, -1 }, &hit, &got, &error) ==
                                   GLINT_ERR_INVALID &&
                               !strncmp(error.message, "origin", 6),
                           "an origin with %g is refused by name", bad[i]);
            hard_check(glint_scene_cast(scene, (double[3]) { 0, 0, 5 }, d, &hit, &got, &error) == GLINT_ERR_INVALID &&
                           !strncmp(error.message, "direction", 9),
                       "a direction with %g is refused by name", d[c]);
            desc = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
            desc.radius = 1;
            desc.center[c] = bad[i];
            if (i >= 2)
                hard_check(glint_shape_create(&desc, &shape, &error) == GLINT_ERR_INVALID &&
                               !strncmp(error.message, "center", 6),
                           "a centre with %g is refused by name", bad[i]);
        }
        glint_scene_release(scene);
    }
}

/// G1: rays in a plane, rays parallel to the plane, and rays so nearly parallel that the quotient has no meaning.
static void check_planes(void)
{
    hard_test("G1", "rays in and along planes");
    for (int way = 0; way < 48; way++)
        for (int e = -200; e <= 200; e += 100) {
            const double s = ldexp(1, e / 5);
            const struct {
                hard_ray ray;
                double t;
            } rays[] = { { { { 0, 0, 0 }, { 1, 0, 0 } }, 0 },
                         { { { 0, s, 0 }, { 1, 0, 3 } }, 0 },
                         { { { 0, s, 0 }, { 1, -1e-31, 0 } }, 0 },
                         { { { 0, s, 0 }, { 1, 1e-20, 0 } }, 0 },
                         { { { s, s, 0 }, { 1, -0x1p-40, 0 } }, 0x1p40 * s },
                         { { { 3 * s, s, 4 * s }, { 1, -0.5, 0 } }, 2 * s },
                         { { { 0, -s, 0 }, { 1, 0.25, 2 } }, 4 * s } };
            for (size_t i = 0; i < sizeof rays / sizeof *rays; i++) {
                hard_ray ray = rays[i].ray;
                hard_plane plane = { { 0 }, { 0, ldexp(1, e), 0 } };
                glint_hit hit;
                turn_axes(ray.o, way);
                turn_axes(ray.d, way);
                turn_axes(plane.n, way);
                glint_scene *scene = scene_new();
                scene_plane(scene, &plane, NULL);
                const bool found = cast(scene, &ray, &hit);
                hard_check(found == (rays[i].t > 0) && (!found || hit.t == rays[i].t), "ray %zu, axes %d: t %g, not %g",
                           i, way, found ? hit.t : 0, rays[i].t);
                glint_scene_release(scene);
            }
        }
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    if (hard_table)
        printf("One ray and one sphere: relative error of t.\n\n"
               "| case | what | truth | double | float | textbook double | textbook float | verdict |\n"
               "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (size_t i = 0; i < ray_case_count; i++) {
        hard_test(ray_cases[i].id, ray_cases[i].what);
        check_case(&ray_cases[i]);
        exact_variants(&ray_cases[i]);
        rounded_variants(&ray_cases[i]);
    }
    check_pairs();
    check_refused();
    check_planes();
    return hard_end();
}
