/// Adversarial rays: the engine's answers against the oracle's. Casts 1e6 rays when run as a test, and --rays in the
/// soak. Covers single spheres and planes, many spheres in one place, pictures of tangent spheres through the frame's
/// own kernels, and rays that leave surfaces towards a light.
#include "tests/hard/oracle/aim.h"
#include "tests/hard/oracle/drive.h"
#include "tests/hard/oracle/judge.h"
#include "tests/hard/oracle/still.h"

#include <math.h>
#include <string.h>

typedef struct tally {
    uint64_t rays, hits, close, wrong;
    double worst_ulp, worst_t, worst_normal; ///< largest errors; worst_t and worst_normal are relative to the allowed
        ///< error
} tally;

static void report(const char *name, const tally *sum)
{
    if (hard_table)
        printf("| %s | %llu | %llu | %llu | %llu | %.2f | %.2f |\n", name, (unsigned long long)sum->rays,
               (unsigned long long)sum->hits, (unsigned long long)sum->close, (unsigned long long)sum->wrong,
               sum->worst_t, sum->worst_normal);
    hard_right(sum->rays - sum->wrong);
    // at least a third of the rays must hit
    hard_check(sum->hits >= sum->rays / 3, "%s: only %llu hits of %llu rays", name, (unsigned long long)sum->hits,
               (unsigned long long)sum->rays);
}

static void note(tally *sum, const judgement *j, bool hit)
{
    sum->rays++;
    sum->hits += hit && j->verdict != TOO_CLOSE;
    sum->close += j->verdict == TOO_CLOSE;
    sum->wrong += j->verdict > TOO_CLOSE;
    sum->worst_t = fmax(sum->worst_t, j->t_share);
    sum->worst_normal = fmax(sum->worst_normal, j->normal_share);
}

/// Reports a wrong answer, with the input to reproduce it.
static void complain(const char *about, const hard_ray *ray, const judgement *j, const truth *want, bool hit,
                     const glint_hit *got)
{
    hard_check(false,
               "%s: %s, %g of what is allowed; truth %s t %a, engine %s t %a; tangency %g, surface %g\n"
               "    ray { { %a, %a, %a }, { %a, %a, %a } }",
               about, verdict_name[j->verdict], fmax(j->t_share, j->normal_share), want->hit ? "hit" : "miss", want->t,
               hit ? "hit" : "miss", hit ? got->t : 0, want->tangency, want->surface, ray->o[0], ray->o[1], ray->o[2],
               ray->d[0], ray->d[1], ray->d[2]);
}

static const char *describe_sphere(const hard_sphere *sphere)
{
    static char text[200];
    snprintf(text, sizeof text, "sphere { { %a, %a, %a }, %a }", sphere->c[0], sphere->c[1], sphere->c[2], sphere->r);
    return text;
}

static const char *describe_plane(const hard_plane *plane)
{
    static char text[200];
    snprintf(text, sizeof text, "plane { { %a, %a, %a }, { %a, %a, %a } }", plane->p[0], plane->p[1], plane->p[2],
             plane->n[0], plane->n[1], plane->n[2]);
    return text;
}

static void fuzz_spheres(uint64_t count)
{
    hard_test("fuzz", "one sphere");
    tally sum = { 0 };
    for (uint64_t i = 0; i < count; i++) {
        hard_ray ray;
        hard_sphere sphere;
        glint_hit got;
        aim_at_sphere(&ray, &sphere);
        glint_scene *scene = scene_new();
        scene_sphere(scene, &sphere, NULL);
        const bool hit = cast(scene, &ray, &got);
        glint_scene_release(scene);
        const truth want = true_sphere(&ray, &sphere);
        const judgement j = judge_sphere(&ray, &sphere, &want, hit, &got);
        note(&sum, &j, hit);
        if (j.verdict > TOO_CLOSE)
            complain(describe_sphere(&sphere), &ray, &j, &want, hit, &got);
    }
    report("one sphere", &sum);
}

static void fuzz_planes(uint64_t count)
{
    hard_test("fuzz", "one plane");
    tally sum = { 0 };
    for (uint64_t i = 0; i < count; i++) {
        hard_ray ray;
        hard_plane plane;
        glint_hit got;
        aim_at_plane(&ray, &plane);
        glint_scene *scene = scene_new();
        scene_plane(scene, &plane, NULL);
        const bool hit = cast(scene, &ray, &got);
        glint_scene_release(scene);
        const truth want = true_plane(&ray, &plane);
        const judgement j = judge_plane(&ray, &plane, &want, hit, &got);
        note(&sum, &j, hit);
        if (j.verdict > TOO_CLOSE)
            complain(describe_plane(&plane), &ray, &j, &want, hit, &got);
    }
    report("one plane", &sum);
}

#define MANY 6

static bool same_sphere(const hard_sphere *a, const hard_sphere *b)
{
    return a->r == b->r && a->c[0] == b->c[0] && a->c[1] == b->c[1] && a->c[2] == b->c[2];
}

/// Adds all spheres as one shape, whose element indices equal the spheres' indices,
/// or each sphere as a separate shape.
static void add_many(glint_scene *scene, const hard_sphere *spheres, int count, glint_shape *shapes[MANY], bool as_one)
{
    for (int i = 0; i < count && !as_one; i++)
        shapes[i] = scene_sphere(scene, &spheres[i], NULL);
    if (!as_one)
        return;
    double rows[4 * MANY];
    for (int i = 0; i < count; i++) {
        memcpy(rows + 4 * i, spheres[i].c, sizeof spheres[i].c);
        rows[4 * i + 3] = spheres[i].r;
    }
    glint_error error;
    const glint_spheres_desc desc = { .struct_size = sizeof(glint_spheres_desc), .data = rows, .count = (size_t)count, .two_sided = true };
    must(glint_spheres_create(&desc, &shapes[0], &error), &error);
    must(glint_scene_add_shape(scene, shapes[0], &error), &error);
    glint_shape_release(shapes[0]);
}

/// Returns the index of the sphere that was hit; -1: none.
static int which(const glint_hit *got, glint_shape *const shapes[MANY], int count, bool as_one)
{
    if (as_one)
        return got->shape == shapes[0] ? (int)got->element : -1;
    for (int i = 0; i < count; i++)
        if (shapes[i] == got->shape)
            return i;
    return -1;
}

/// The ray must hit the engine's sphere, no other sphere may be clearly nearer,
/// and no earlier sphere may be identical.
static judgement judge_many(const hard_ray *ray, const hard_sphere *spheres, int count, bool hit, int index,
                            const glint_hit *got)
{
    truth want[MANY];
    bool close = false, any = false;
    for (int i = 0; i < count; i++) {
        want[i] = true_sphere(ray, &spheres[i]);
        close = close || want[i].tangency < TANGENCY ||
                (want[i].surface < SURFACE && !exact_difference(ray->o, spheres[i].c));
        any = any || want[i].hit;
    }
    if (close)
        return (judgement) { .verdict = TOO_CLOSE };
    if (hit != any || (hit && (index < 0 || index >= count)))
        return (judgement) { .verdict = WRONG_DECISION };
    if (!hit)
        return (judgement) { .verdict = RIGHT };
    judgement j = judge_sphere(ray, &spheres[index], &want[index], hit, got);
    for (int i = 0; i < count && j.verdict == RIGHT; i++) {
        if (i < index && same_sphere(&spheres[i], &spheres[index]))
            j.verdict = WRONG_DECISION;
        if (i == index || !want[i].hit || want[i].t >= got->t)
            continue;
        glint_hit other = *got; // tests whether another sphere is nearer, allowing for the error of t
        memcpy(other.normal, want[i].n, sizeof other.normal);
        const judgement nearer = judge_sphere(ray, &spheres[i], &want[i], true, &other);
        if (nearer.verdict != RIGHT)
            j.verdict = WRONG_DECISION;
    }
    return j;
}

static void fuzz_many(uint64_t count)
{
    hard_test("fuzz", "concentric and coincident spheres");
    tally sum = { 0 };
    for (uint64_t i = 0; i < count; i++) {
        hard_ray ray;
        hard_sphere spheres[MANY];
        glint_shape *shapes[MANY];
        glint_hit got = { 0 };
        const int n = 2 + (int)(random_bits() % (MANY - 1));
        const bool as_one = chance(0.5);
        aim_at_many(&ray, spheres, n);
        glint_scene *scene = scene_new();
        add_many(scene, spheres, n, shapes, as_one);
        const bool hit = cast(scene, &ray, &got);
        const int index = hit ? which(&got, shapes, n, as_one) : -1;
        glint_scene_release(scene);
        const judgement j = judge_many(&ray, spheres, n, hit, index, &got);
        note(&sum, &j, hit);
        if (j.verdict > TOO_CLOSE) {
            const truth want = true_sphere(&ray, &spheres[index < 0 ? 0 : index]);
            char about[300];
            snprintf(about, sizeof about, "%d spheres, the first %s, number %d", n, describe_sphere(&spheres[0]),
                     index);
            complain(about, &ray, &j, &want, hit, &got);
        }
    }
    report("concentric and coincident spheres", &sum);
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    if (hard_table)
        printf(
            "Rays aimed to hurt, against the oracle. Errors as shares of what is allowed: 4 ulp of t, times what the "
            "rounding of the\ninputs is magnified by.\n\n"
            "| aimed at | rays | hits | too close to tell | wrong | worst t | worst normal |\n"
            "| --- | --- | --- | --- | --- | --- | --- |\n");
    fuzz_spheres(hard_rays * 6 / 10);
    fuzz_planes(hard_rays * 2 / 10);
    fuzz_many(hard_rays * 2 / 10);
    return hard_end();
}
