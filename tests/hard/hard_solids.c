/// Adversarial rays at ellipsoids, boxes, disks, cylinders, cones and triangles, under maps that turn, stretch, shear and
/// mirror, against 113 bits.
#include "tests/hard/aim_solid.h"

#define ROUNDING 8 ///< of 2^-53: what the engine's arithmetic may be off by, times the map's condition and the distance

// ---- Judging ----

typedef struct tally {
    uint64_t rays, hits, close, wrong;
    double worst_normal;
} tally;

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
    double off = 0;
    for (int c = 0; c < 3; c++)
        off = fmax(off, fabs(got->normal[c] - want->n[c]));
    if (want->edge)
        return NULL;
    const double turn = want->turn;
    sum->worst_normal = fmax(sum->worst_normal, off / (1e-9 + turn));
    return off <= 1e-9 + turn ? NULL : "normal too far off";
}

static void complain(const hard_solid *s, const hard_ray *ray, const solid_truth *want, bool hit, const glint_hit *got,
                     const char *what)
{
    const double *m = s->desc.transform.m[0];
    hard_check(false,
               "%s: truth %s t %.17g (%.17g .. %.17g), engine %s t %.17g; normal %g %g %g, truth %g %g %g\n"
               "    ray { { %a, %a, %a }, { %a, %a, %a } } base %a %a %a top %a %a %a radius %a map %a %a %a %a ...",
               what, want->hit ? "hit" : "miss", want->t, want->least, want->most, hit ? "hit" : "miss",
               hit ? got->t : 0, got->normal[0], got->normal[1], got->normal[2], want->n[0], want->n[1], want->n[2],
               ray->o[0], ray->o[1], ray->o[2], ray->d[0], ray->d[1], ray->d[2], s->desc.base[0], s->desc.base[1],
               s->desc.base[2], s->desc.top[0], s->desc.top[1], s->desc.top[2], s->desc.radius, m[0], m[1], m[2], m[3]);
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
    return hard_end();
}
