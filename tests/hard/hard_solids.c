/// Adversarial rays at ellipsoids, boxes, disks, cylinders, cones, tori and triangles, under maps that rotate,
/// stretch, shear and mirror, against 113-bit arithmetic.
#include "tests/hard/oracle/aim_solid.h"
#include "tests/hard/oracle/solid_cases.h"

#include <string.h>

#define ROUNDING 8 ///< allowed error of the engine's arithmetic in units of 2^-53; the map's condition and the
    ///< distance multiply it

// ---- Judging ----

typedef struct tally {
    uint64_t rays, hits, close, wrong;
} tally;

static bool is_normal(const double got[3], const solid_normal *want)
{
    double off = 0;
    for (int c = 0; c < 3; c++)
        off = fmax(off, fabs(got[c] - want->n[c]));
    return off <= 1e-9 + want->turn;
}

static const char *judge(const solid_truth *want, bool hit, const glint_hit *got, tally *sum)
{
    sum->rays++;
    sum->close += want->close;
    if (want->close)
        return NULL;
    if (hit != want->hit)
        return "wrong decision";
    if (!hit)
        return NULL;
    sum->hits++;
    const double ulps = 4 * (nextafter(fabs(want->t), HUGE_VAL) - fabs(want->t));
    if (!(got->t >= want->least - ulps && got->t <= want->most + ulps))
        return "t too far off";
    for (int i = 0; i < want->normals; i++)
        if (is_normal(got->normal, &want->normal[i]))
            return NULL;
    return want->normals ? "normal too far off" : NULL;
}

/// Formats numbers as in an initializer.
static const char *list(char *out, size_t size, const double *v, int count)
{
    int at = 0;
    for (int i = 0; i < count && at < (int)size; i++)
        at += snprintf(out + at, size - (size_t)at, "%s%a", i ? ", " : "", v[i]);
    return out;
}

static void complain(const hard_solid *s, const hard_ray *ray, const solid_truth *want, bool hit, const glint_hit *got,
                     const char *what)
{
    const glint_shape_desc *d = &s->desc;
    const double *const lists[] = { ray->o, ray->d, d->center,  d->normal,         d->base,     d->top,  d->min,
                                    d->max, &d->radius, d->transform.m[0], s->corner[0], d->axis, &d->major, &d->minor };
    const char *const names[] = { "o",   "d",      "center", "normal",  "base", "top",   "min",
                                  "max", "radius", "map",    "corners", "axis", "major", "minor" };
    static const int counts[] = { 3, 3, 3, 3, 3, 3, 3, 3, 1, 12, 9, 3, 1, 1 };
    char all[2600], one[400];
    int at = 0;
    for (int i = 0; i < 14; i++)
        at += snprintf(all + at, sizeof all - (size_t)at, "\n    %s { %s }", names[i],
                       list(one, sizeof one, lists[i], counts[i]));
    hard_check(false, "%s: truth %s t %.17g (%.17g .. %.17g), engine %s t %.17g; normal %g %g %g, truth %g %g %g%s",
               what, want->hit ? "hit" : "miss", want->t, want->least, want->most, hit ? "hit" : "miss",
               hit ? got->t : 0, got->normal[0], got->normal[1], got->normal[2], want->normal[0].n[0],
               want->normal[0].n[1], want->normal[0].n[2], all);
}

static void known(const solid_case *c)
{
    tally sum = { 0 };
    glint_hit got = { 0 };
    const hard_solid s = solid_of_case(c);
    hard_test(c->id, c->what);
    glint_scene *scene = solid_alone(&s, NULL);
    const bool hit = cast(scene, &c->ray, &got);
    const solid_truth want = oracle_solid(&c->ray, &s, ROUNDING);
    hard_check(want.hit && !want.close && fabs(want.t / c->t - 1) < 0x1p-52, "the oracle: t %.17g, not %.17g", want.t,
               c->t);
    const char *wrong = judge(&want, hit, &got, &sum);
    if (wrong)
        complain(&s, &c->ray, &want, hit, &got, wrong);
    hard_right(!wrong);
    glint_scene_release(scene);
}

static void report(const char *name, const tally *sum)
{
    if (hard_table)
        printf("| %s | %llu | %llu | %llu | %llu |\n", name, (unsigned long long)sum->rays,
               (unsigned long long)sum->hits, (unsigned long long)sum->close, (unsigned long long)sum->wrong);
    hard_right(sum->rays - sum->wrong);
    hard_check(sum->hits >= sum->rays / 4, "only %llu hits of %llu rays", (unsigned long long)sum->hits,
               (unsigned long long)sum->rays);
}

static void fuzz(int kind, uint64_t count)
{
    tally sum = { 0 };
    hard_test("fuzz", solid_names[kind]);
    while (sum.rays < count) {
        double size;
        const hard_solid s = solid_random(kind, &size);
        glint_scene *scene = solid_alone(&s, NULL);
        for (int i = 0; i < 20; i++) {
            const hard_ray ray = solid_aim(&s, size);
            glint_hit got = { 0 };
            const bool hit = cast(scene, &ray, &got);
            const solid_truth want = oracle_solid(&ray, &s, ROUNDING);
            const char *wrong = judge(&want, hit, &got, &sum);
            sum.wrong += wrong != NULL;
            if (wrong)
                complain(&s, &ray, &want, hit, &got, wrong);
        }
        glint_scene_release(scene);
    }
    report(solid_names[kind], &sum);
}

// ---- Disks nearly edge-on ----

/// The relative error of the engine's t is at most GRAZING 2^-53 (1 + R / L) / c, where the ray hits the plane at a
/// cosine c, L after its start, and R is the size of the operands: the lengths of o, p, o - p and the radius. The
/// normal, n.(o - p) and n.d each have at most three roundings relative to their terms; R counts its terms twice, and
/// the last two errors are divided by c.
#define GRAZING 2

typedef struct grazed {
    hard_ray ray;
    hard_plane plane;
    double radius;
} grazed;

/// Makes a disk, and a ray that hits the disk's plane at a cosine of 1e-16 .. 1e-2,
/// inside the disk, at its rim or outside.
static grazed graze(void)
{
    grazed g;
    double across[3], toward[3], length = 0;
    const double cosine = log_uniform(1e-16, 1e-2), turn = uniform(0, 6.3), at = chance(0.5) ? 0 : log_uniform(1, 1e5),
                 rim = chance(0.3) ? 1 + (chance(0.5) ? -1 : 1) * log_uniform(1e-16, 1e-1) : uniform(0, 1.3);
    g.radius = log_uniform(1e-3, 1e3);
    random_direction(g.plane.n);
    random_direction(toward);
    for (int c = 0; c < 3; c++)
        across[c] = g.plane.n[(c + 1) % 3] * toward[(c + 2) % 3] - g.plane.n[(c + 2) % 3] * toward[(c + 1) % 3];
    for (int c = 0; c < 3; c++)
        length = hypot(length, across[c]);
    const double reach = g.radius * log_uniform(1e-2, 1e4), scale = chance(0.2) ? log_uniform(1e-30, 1e30) : 1;
    for (int c = 0; c < 3; c++) {
        const double x = across[c] / length,
                     y = (g.plane.n[(c + 1) % 3] * across[(c + 2) % 3] - g.plane.n[(c + 2) % 3] * across[(c + 1) % 3]) /
                         length;
        g.plane.p[c] = g.radius * at * uniform(-1, 1);
        const double p = g.plane.p[c] + g.radius * rim * (cos(turn) * x + sin(turn) * y);
        const double way = x + g.plane.n[c] * cosine;
        g.ray.o[c] = p - reach * way;
        g.ray.d[c] = (p - g.ray.o[c]) * scale;
    }
    return g;
}

static double length_of(const double v[3]) { return hypot(hypot(v[0], v[1]), v[2]); }

/// Compares the engine with the bound. *share gets the error of t relative to the error bound.
static const char *judge_grazed(const grazed *g, bool hit, const glint_hit *got, tally *sum, double *share)
{
    const truth want = true_plane(&g->ray, &g->plane);
    const double way = want.t * length_of(g->ray.d), off[3] = { g->ray.o[0] - g->plane.p[0], g->ray.o[1] - g->plane.p[1],
                                                                g->ray.o[2] - g->plane.p[2] };
    const double numbers = length_of(off) + length_of(g->ray.o) + length_of(g->plane.p) + g->radius;
    const double bound = GRAZING * 0x1p-53 * (1 + numbers / way) / want.cosine;
    double from_center = 0, places = 0;
    for (int c = 0; c < 3; c++) {
        from_center = hypot(from_center, off[c] + want.t * g->ray.d[c]);
        places += fabs(g->plane.n[c]) * (2 * fabs(g->plane.p[c]) + g->radius);
    }
    *share = 0;
    sum->rays++;
    // Points so close to the plane, or so close to the rim, may count for either side.
    if (!want.hit || !(bound < 0.25) || way * want.cosine < 1.01 * 0x1p-50 * places ||
        fabs(from_center - g->radius) < bound * way + 8 * 0x1p-53 * numbers) {
        sum->close++;
        return NULL;
    }
    sum->hits += hit;
    if (hit != (from_center < g->radius))
        return "wrong decision";
    *share = hit ? fabs(got->t / want.t - 1) / bound : 0;
    return *share <= 1 ? NULL : "t too far off";
}

static void fuzz_grazing(uint64_t count)
{
    tally sum = { 0 };
    double worst = 0, share;
    hard_test("fuzz", "disks at grazing rays");
    for (uint64_t i = 0; i < count; i++) {
        const grazed g = graze();
        hard_solid s = { .desc = glint_shape_desc_default(GLINT_SHAPE_DISK) };
        glint_hit got = { 0 };
        s.desc.radius = g.radius;
        memcpy(s.desc.center, g.plane.p, sizeof s.desc.center);
        memcpy(s.desc.normal, g.plane.n, sizeof s.desc.normal);
        glint_scene *scene = solid_alone(&s, NULL);
        const bool hit = cast(scene, &g.ray, &got);
        const char *wrong = judge_grazed(&g, hit, &got, &sum, &share);
        glint_scene_release(scene);
        worst = fmax(worst, share);
        sum.wrong += wrong != NULL;
        if (wrong) {
            const solid_truth want = oracle_solid(&g.ray, &s, ROUNDING);
            complain(&s, &g.ray, &want, hit, &got, wrong);
        }
    }
    report("disk, grazing", &sum);
    if (hard_table)
        printf("\nOf disks at grazing rays the worst t is %.2f of the bound, %d 2^-53 (1 + R / L) / cosine.\n", worst,
               GRAZING);
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    if (hard_table)
        printf("Solids and triangles, under maps that turn, stretch, shear and mirror, against 113 bits.\n\n"
               "| aimed at | rays | hits | too close to tell | wrong |\n| --- | --- | --- | --- | --- |\n");
    for (int kind = 0; kind < SOLID_KINDS; kind++)
        fuzz(kind, hard_rays / 40);
    fuzz_grazing(hard_rays / 10);
    for (int i = 0; i < solid_case_count; i++)
        known(&solid_cases[i]);
    return hard_end();
}
