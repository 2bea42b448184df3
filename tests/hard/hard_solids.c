/// Adversarial rays at ellipsoids, boxes, disks, cylinders, cones and triangles, under maps that turn, stretch, shear and
/// mirror, against 113 bits.
#include "tests/hard/oracle/aim_solid.h"
#include "tests/hard/oracle/solid_cases.h"

#define ROUNDING 8 ///< of 2^-53: what the engine's arithmetic may be off by, times the map's condition and the distance

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

/// Numbers as they stand in an initializer.
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
    const double *const lists[] = { ray->o, ray->d, d->center,  d->normal,         d->base,     d->top,
                                    d->min, d->max, &d->radius, d->transform.m[0], s->corner[0] };
    const char *const names[] = {
        "o", "d", "center", "normal", "base", "top", "min", "max", "radius", "map", "corners"
    };
    static const int counts[] = { 3, 3, 3, 3, 3, 3, 3, 3, 1, 12, 9 };
    char all[2000], one[400];
    int at = 0;
    for (int i = 0; i < 11; i++)
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
    if (hard_table)
        printf("| %s | %llu | %llu | %llu | %llu |\n", solid_names[kind], (unsigned long long)sum.rays,
               (unsigned long long)sum.hits, (unsigned long long)sum.close, (unsigned long long)sum.wrong);
    hard_right(sum.rays - sum.wrong);
    hard_check(sum.hits >= sum.rays / 4, "only %llu hits of %llu rays", (unsigned long long)sum.hits,
               (unsigned long long)sum.rays);
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    if (hard_table)
        printf("Solids and triangles, under maps that turn, stretch, shear and mirror, against 113 bits.\n\n"
               "| aimed at | rays | hits | too close to tell | wrong |\n| --- | --- | --- | --- | --- |\n");
    for (int kind = 0; kind < SOLID_KINDS; kind++)
        fuzz(kind, hard_rays / 40);
    for (int i = 0; i < solid_case_count; i++)
        known(&solid_cases[i]);
    return hard_end();
}
