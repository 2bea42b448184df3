/// Tests the oracle, where the answer is known independently.
#include "tests/hard/oracle/aim.h"
#include "tests/hard/oracle/drive.h"
#include "tests/hard/oracle/oracle_light.h"
#include "tests/hard/oracle/ray_cases.h"

#include <math.h>
#include <string.h>

/// Cases that can be checked by hand: 3-4-5 and 1-2-2-3 triangles scaled by powers of two, with exact answers.
static void check_by_hand(void)
{
    hard_test("oracle", "triangles of whole numbers");
    for (int e = -60; e <= 60; e += 5) {
        const double s = ldexp(1, e);
        const hard_sphere ball = { { 0, 0, 0 }, 5 * s };
        const hard_ray across = { { 3 * s, 0, 10 * s }, { 0, 0, -s } },
                       back = { { 3 * s, 0, 4 * s }, { 0, 0, -2 * s } };
        const hard_ray touch = { { 5 * s, 0, 10 * s }, { 0, 0, -1 } }, leave = { { 3 * s, 0, 4 * s }, { 0, 0, 1 } };
        const hard_ray within = { { 0 }, { 2 * s, 4 * s, 4 * s } };
        truth want = oracle_sphere(&across, &ball);
        hard_check(want.hit && want.t == 6 && want.n[0] == 0.6 && want.n[1] == 0 && want.n[2] == 0.8 &&
                       want.cosine == 0.8,
                   "6 and (0.6, 0, 0.8) at scale 2^%d, got %a", e, want.t);
        want = oracle_sphere(&back, &ball); // the ray starts on the surface: the root 0 does not count
        hard_check(want.hit && want.t == 4 && want.surface == 0, "4 at scale 2^%d, got %a", e, want.t);
        want = oracle_sphere(&touch, &ball);
        hard_check(want.tangency == 0, "exact tangency, got %a", want.tangency);
        want = oracle_sphere(&leave, &ball);
        hard_check(!want.hit, "leaving is no hit, got %a", want.t);
        want = oracle_sphere(&within, &ball);
        hard_check(want.hit && want.t == 5 / 6.0 && want.n[0] == 1 / 3.0, "5/6, got %a", want.t);
        const hard_plane floor = { { s, -s, 7 * s }, { 0, 3, 0 } };
        const hard_ray fall = { { 4 * s, 2 * s, s }, { s, -6 * s, s } };
        want = oracle_plane(&fall, &floor);
        hard_check(want.hit && want.t == 0.5 && want.n[1] == 1, "1/2, got %a", want.t);
    }
}

/// Compares the oracle with answers that were computed elsewhere with 4096 bits, and 113 bits with more bits.
static void check_known(void)
{
    hard_test("oracle", "the named cases");
    for (size_t i = 0; i < ray_case_count; i++) {
        const truth want = oracle_sphere(&ray_cases[i].ray, &ray_cases[i].sphere);
        truth quick;
        if (isnan(ray_cases[i].t))
            hard_check(want.tangency == 0, "%s: tangent", ray_cases[i].id);
        else
            hard_check(want.hit == (ray_cases[i].t > 0) && (!want.hit || fabs(want.t / ray_cases[i].t - 1) < 4e-16),
                       "%s: oracle %a where %a was computed before", ray_cases[i].id, want.t, ray_cases[i].t);
        if (quick_sphere(&ray_cases[i].ray, &ray_cases[i].sphere, &quick))
            hard_check(quick.hit == want.hit && quick.t == want.t, "%s: 113 bits say %a, more say %a", ray_cases[i].id,
                       quick.t, want.t);
    }
}

/// Tests fuzz rays for which 113 bits are enough, and rays that need more.
static void check_quick(uint64_t count)
{
    hard_test("oracle", "113 bits against 400");
    uint64_t open = 0;
    for (uint64_t i = 0; i < count; i++) {
        hard_ray ray;
        hard_sphere sphere;
        hard_plane plane;
        truth quick;
        aim_at_sphere(&ray, &sphere);
        if (quick_sphere(&ray, &sphere, &quick)) {
            const truth want = oracle_sphere(&ray, &sphere);
            hard_check(quick.hit == want.hit && quick.t == want.t && !memcmp(quick.n, want.n, sizeof want.n),
                       "sphere: 113 bits say %a, 400 say %a", quick.t, want.t);
        } else {
            open++;
        }
        aim_at_plane(&ray, &plane);
        if (i % 16 == 0 && quick_plane(&ray, &plane, &quick)) {
            const truth want = oracle_plane(&ray, &plane);
            hard_check(quick.hit == want.hit && quick.t == want.t, "plane: 113 bits say %a, more say %a", quick.t,
                       want.t);
        }
    }
    hard_check(open < count / 2, "113 bits leave %llu of %llu rays open", (unsigned long long)open,
               (unsigned long long)count);
}

/// Cosines of the 3-4-5 triangle with known powers; pixel values at both ends and in the middle.
static void check_shading(void)
{
    hard_test("oracle", "reflections and codes");
    const double n[3] = { 0, 0, 2 }, l[3] = { 3, 0, 4 }, v[3] = { 0, 0, 1 }, mirrored[3] = { -6, 0, 8 };
    hard_check(oracle_reflection(false, 2, n, l, v).specular == 0.64, "0.8^2 of Phong");
    hard_check(oracle_reflection(true, 7, n, l, mirrored).specular == 1, "1^7 of Blinn");
    hard_check(oracle_reflection(false, 0, n, l, v).diffuse == 0.8, "n.l of 0.8");
    hard_check(oracle_code(0, true, 255) == 0 && oracle_code(1, true, 65535) == 65535 &&
                   oracle_code(0.5, false, 255) == 128 && oracle_code(0.2140411, true, 65535) == 32767,
               "codes of 0, 1, 1/2 and 0.2140411");
}

/// Cases whose answer is an integer or a fraction.
static void check_light(void)
{
    const double n[3] = { 0, 0, 2 }, l[3] = { 3, 0, 4 }, v[3] = { -3, 0, 4 }, up[3] = { 0, 0, 1 };
    hard_test("oracle", "microfacets, lights, glass");
    hard_check(oracle_ggx(0.5, 0) == 4 / M_PI, "GGX at n = h is 1 / (pi alpha^2)");
    // h = n: pi D = 16, Lambda = (sqrt(1 + (0.25 0.75)^2) - 1) / 2, F = 1
    hard_check(fabs(oracle_facets(false, 0.5, 1, n, l, v) * sqrt(1 + 0.1875 * 0.1875) - 5) < 1e-15, "GGX, 3-4-5");
    hard_check(oracle_facets(false, 1, 1, n, up, up) == 0.25 && oracle_facets(true, 1, 1, n, up, up) == 0.25,
               "roughness 1, straight down");
    hard_check(fabs(oracle_facets(true, 0.5, 0.25, n, l, v) / (16 / 3.2 * (0.25 + 0.75 * pow(0.2, 5))) - 1) < 1e-15,
               "Beckmann, 3-4-5: its facets hide nothing, F = f0 + (1 - f0) 0.2^5");
    hard_check(oracle_facets(false, 0.5, 1, n, (double[3]) { 3, 0, -4 }, v) == 0, "below the horizon");
    const double a60 = acos(0.5), a90 = acos(0); // halfway between the cosines 0.5 and 0
    hard_check(fabs(oracle_spot(a60, a90, 0, up, (double[3]) { sqrt(15), 0, 1 }) - 0.5) < 1e-15, "spot, half way");
    hard_check(oracle_spot(1, 1.5, 2, up, l) == 0.64 && oracle_spot(0.1, 0.2, 0, up, l) == 0, "spot, 0.8^2");
    hard_check(fabs(oracle_cap(0.6) - 0.2) < 1e-16 && oracle_cap(1) == 1, "caps");
    hard_check(oracle_disk(1, 2) == M_PI / 5 && oracle_ball(1, 2) == M_PI / 4, "disk and ball");
    hard_check(oracle_shadow(true, 0.5, 4, 0.5, 2) == 0.5 &&
                   fabs(oracle_shadow(false, 0.5, 4, 0.5, 2) - sqrt(3)) < 1e-15,
               "umbra and penumbra");
    hard_check(oracle_fresnel(1.5, 1) == 0.04 && oracle_fresnel(2, 0.6) == 1 && oracle_fresnel(1, 0.3) == 0, "Fresnel");
    // sin 0.8 -> 0.6, cos 0.6 -> 0.8: (0.75 0.6 - 0.8) / (0.75 0.6 + 0.8) = -7/25, (0.6 - 0.6) / 1.2 = 0
    hard_check(fabs(oracle_fresnel(0.75, 0.6) - 0.0392) < 1e-16, "Fresnel at Brewster's angle");
    hard_check(fabs(oracle_snell(0.75, 0.8) - 0.6) < 1e-15, "Snell, 3-4-5");
    hard_check(oracle_facing_mirrors(1, 0.5, 3) == 1.875 && oracle_facing_mirrors(2, 1, 9) == 20, "facing mirrors");
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    check_by_hand();
    check_known();
    check_quick(hard_rays / 20);
    check_shading();
    check_light();
    return hard_end();
}
