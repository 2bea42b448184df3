/// shade and resolve on every instruction set against the scalar reference, and the accuracy of exp2.
#include "tests/engine/cases/stage_case.h"

#define ALIGNED _Alignas(64)

enum { CASES = 300 };

// ---- shade and resolve -------------------------------------------------------------------------------------------

static void random_color(double color[3])
{
    const double grey = one_in(3) ? 1 : one_in(3) ? between(0, 2) : -1;
    for (int c = 0; c < 3; c++)
        color[c] = grey >= 0 ? grey : one_in(6) ? 0 : one_in(10) ? power_of_ten(-40, 40) : between(0, 2);
}

/// Makes the results of light and occlude: values only in groups that the light reached, before shadows.
static void make_shade_light(glint_shade_light *light, const uint16_t *hits, uint32_t groups)
{
    uint32_t n = groups * GLINT_GROUP;
    uint16_t *lit = input(KIND_U16, groups);
    float *sine2 = input(KIND_FLOAT, n), *schlick = input(KIND_FLOAT, n);
    float *cosine = input(KIND_FLOAT, n), *attenuation = input(KIND_FLOAT, n), *log2_specular = input(KIND_FLOAT, n);
    random_color(light->diffuse);
    random_color(light->specular);
    for (uint32_t g = 0; g < groups; g++) {
        uint16_t facing = hits[g] & random_mask();
        lit[g] = one_in(2) ? facing : facing & random_mask();
        for (uint32_t i = g * GLINT_GROUP; facing && i < (g + 1) * GLINT_GROUP; i++) {
            bool bright = facing >> i % GLINT_GROUP & 1;
            cosine[i] = (float)(!bright ? 0 : one_in(8) ? 1 : between(0, 1));
            attenuation[i] = bright ? one_in(20) ? FLT_MAX : (float)power_of_ten(-6, 1) : 0;
            sine2[i] = !bright || one_in(9) ? GLINT_NO_SPECULAR : one_in(9) ? below(2) : (float)power_of_ten(-40, 0);
            schlick[i] = bright ? (float)power_of_ten(-12, 0) : 0;
            log2_specular[i] = !bright || one_in(5) ? GLINT_NO_SPECULAR : one_in(9) ? 0 : (float)-power_of_ten(-9, 2);
        }
    }
    light->lit = lit;
    light->cosine = cosine;
    light->attenuation = one_in(2) ? attenuation : NULL;
    light->log2_specular = log2_specular;
    light->sine2 = sine2;
    light->schlick = schlick;
    light->summed = false;
    light->highlight = attenuation; // any values will do
}

static void make_materials(glint_shade_material *material, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        random_color(material[i].diffuse);
        random_color(material[i].specular);
        random_color(material[i].ambient);
        material[i].shininess = (float)(one_in(8) ? 0 : power_of_ten(-2, 4));
        random_color(material[i].grazing);
        material[i].planes = 0;
        material[i].highlight = below(4);
        material[i].alpha = (float)(one_in(6) ? 1 : one_in(6) ? 1e-18 : power_of_ten(-6, 0));
        material[i].lobe = material[i].highlight == GLINT_HIGHLIGHT_FACETS ? GLINT_LOBE_GGX + below(2) : below(2);
    }
}

/// Makes planes in half of the cases: materials take some parameters from planes,
/// or all light from a shader's planes.
static const glint_shade_planes *make_planes(glint_shade_material *material, uint32_t count, uint32_t n,
                                             glint_shade_planes *planes)
{
    if (one_in(2))
        return NULL;
    const bool shaded = one_in(2), grey = one_in(2), level = one_in(2);
    for (uint32_t i = 0; i < count; i++) {
        material[i].planes = one_in(3) ? 0 : below(128);
        if (!grey || one_in(2))
            continue;
        material[i].planes = GLINT_PLANE_DIFFUSE | GLINT_PLANE_AMBIENT_IS_DIFFUSE; // the common case
        material[i].diffuse[1] = material[i].diffuse[2] = material[i].diffuse[0] = 1;
    }
    float *shininess = input(KIND_FLOAT, n), *alpha = input(KIND_FLOAT, n);
    for (int c = 0; c < 3; c++) {
        float *diffuse = input(KIND_FLOAT, n), *ambient = input(KIND_FLOAT, n), *specular = input(KIND_FLOAT, n);
        for (uint32_t i = 0; i < n; i++) {
            diffuse[i] = (float)(one_in(6) ? 0 : one_in(9) ? 0x1p100 : between(0, 2));
            ambient[i] = (float)between(0, 2);
            specular[i] = (float)(one_in(6) ? 0 : power_of_ten(-4, 1));
        }
        planes->diffuse[c] = grey && c > 0 ? planes->diffuse[0] : diffuse;
        planes->ambient[c] = ambient;
        planes->specular[c] = specular;
        planes->ambient_light[c] = level && c > 0 ? planes->ambient_light[0] : between(0, 2);
        planes->shaded[0][c] = shaded ? specular : NULL; // any values will do
        planes->shaded[1][c] = shaded ? ambient : NULL;
    }
    for (uint32_t i = 0; i < n; i++) {
        shininess[i] = (float)(one_in(8) ? 0 : power_of_ten(-2, 4));
        alpha[i] = (float)(one_in(6) ? 1 : power_of_ten(-6, 0));
    }
    planes->shininess = shininess;
    planes->alpha = alpha;
    return planes;
}

/// Makes the shade outputs of the running instruction set: sums that start at `before`, or the film and the beauty.
static void make_shade_outputs(glint_shade_args *args, const double *before, uint32_t passes)
{
    uint32_t n = args->group_count * GLINT_GROUP;
    for (int term = 0; term < GLINT_TERM_COUNT; term++) {
        for (int c = 0; c < 3; c++) {
            bool computed = term != GLINT_TERM_SPECULAR || args->highlights;
            args->sum[term][c] = before && computed ? output("sum", KIND_DOUBLE, n) : NULL;
            for (uint32_t i = 0; i < n && args->sum[term][c]; i++)
                args->sum[term][c][i] = before[i];
            args->film[term][c] = !before && passes >> term & 1 ? output("film", KIND_FLOAT, n) : NULL;
        }
    }
    for (int c = 0; c < 3; c++)
        args->beauty[c] = before ? NULL : output("beauty", KIND_FLOAT, n);
}

/// Makes the lights of a sample. If `sums`, some of the lights arrive already summed.
static void make_shade_lights(glint_shade_args *args, glint_shade_light *lights, uint32_t count, bool sums)
{
    args->lights = lights;
    args->light_count = count;
    for (uint32_t k = 0; k < count; k++) {
        make_shade_light(&lights[k], args->hits, args->group_count);
        lights[k].summed = sums && one_in(2);
    }
    for (uint32_t k = 0; k < count; k++) { // all samples of one light have the same colours
        lights[k].joined = k > 0 && !lights[k - 1].summed && !lights[k].summed && one_in(2);
        if (!lights[k].joined)
            continue;
        memcpy(lights[k].diffuse, lights[k - 1].diffuse, sizeof lights[k].diffuse);
        memcpy(lights[k].specular, lights[k - 1].specular, sizeof lights[k].specular);
    }
}

/// Makes the materials of a sample: several materials, or one material in most groups, which may be known in advance.
static void make_shade_hits(glint_shade_args *args, uint32_t material_count)
{
    static const uint32_t only = 0;
    const uint32_t n = args->group_count * GLINT_GROUP;
    const bool alike = one_in(2), known = alike && one_in(2);
    uint16_t *hits = masks(args->group_count);
    uint32_t *material = input(KIND_U32, n);
    float *facing = input(KIND_FLOAT, n);
    for (uint32_t g = 0; g < args->group_count; g++)
        hits[g] = (alike && !one_in(5) ? 0xffff : hits[g]) & args->active[g];
    for (uint32_t i = 0; i < n; i++) {
        const bool other = !known && (!alike || one_in(50));
        if (hits[i / GLINT_GROUP])
            material[i] = lane_of(hits, i) && other ? below(material_count) : 0;
        facing[i] = (float)(one_in(9) ? below(2) : between(0, 1));
    }
    args->hits = hits;
    args->material = material;
    args->only = known ? &only : NULL;
    args->facing = facing;
}

static void shade_case(int precision, bool odd)
{
    (void)precision, (void)odd;
    uint32_t groups = 1 + below(GLINT_TILE_GROUPS), n = groups * GLINT_GROUP;
    glint_shade_material material_table[6];
    glint_shade_light lights[GLINT_LIGHT_CHUNK];
    double *before = one_in(2) ? input(KIND_DOUBLE, n) : NULL;
    uint32_t passes = one_in(3) ? 0 : below(16);
    for (uint32_t i = 0; i < n && before; i++)
        before[i] = one_in(3) ? 0 : power_of_ten(-5, 3);
    make_materials(material_table, COUNT_OF(material_table));
    const bool sums = one_in(3);
    for (size_t i = 0; sums && i < COUNT_OF(material_table); i++)
        material_table[i].highlight %= GLINT_HIGHLIGHT_FACETS;
    glint_shade_args args = { .group_count = groups,
                              .active = masks(groups),
                              .materials = material_table,
                              .highlights = one_in(2),
                              .first = !before || one_in(2) };
    random_color(args.background);
    make_shade_hits(&args, COUNT_OF(material_table));
    glint_shade_planes planes;
    args.planes = make_planes(material_table, COUNT_OF(material_table), n, &planes);
    make_shade_lights(&args, lights, one_in(3) ? 1 : below(GLINT_LIGHT_CHUNK + 1), sums);
    FOR_EACH_TESTED
    {
        make_shade_outputs(&args, before, args.highlights ? passes : passes & 7);
        running->shade(&args);
        compare_outputs(before ? "shade, sums" : "shade");
    }
}

static void resolve_samples_case(int precision, bool odd)
{
    (void)precision, (void)odd;
    const uint32_t groups = 1 + below(GLINT_TILE_GROUPS), count = 1 + below(GLINT_LIGHT_CHUNK);
    glint_shade_material material_table[6];
    glint_shade_light lights[GLINT_LIGHT_CHUNK][GLINT_LIGHT_CHUNK];
    glint_shade_args samples[GLINT_LIGHT_CHUNK] = {
        { .group_count = groups, .materials = material_table, .highlights = one_in(2), .first = true }
    };
    uint16_t *active = masks(groups);
    const bool everywhere = one_in(2);
    for (uint32_t g = 0; everywhere && g < groups; g++)
        active[g] = 0xffff;
    samples[0].active = active;
    make_materials(material_table, COUNT_OF(material_table));
    random_color(samples[0].background);
    glint_shade_planes planes;
    samples[0].planes = make_planes(material_table, COUNT_OF(material_table), groups * GLINT_GROUP, &planes);
    for (size_t i = 0; i < COUNT_OF(material_table); i++)
        material_table[i].planes &= ~(uint32_t)GLINT_PLANE_SHADED;
    for (uint32_t k = 0; k < count; k++) {
        samples[k] = samples[0];
        make_shade_hits(&samples[k], COUNT_OF(material_table));
        make_shade_lights(&samples[k], lights[k], below(GLINT_LIGHT_CHUNK / count + 1), false);
    }
    const uint32_t passes = one_in(2) ? 0 : below(16);
    FOR_EACH_TESTED
    {
        make_shade_outputs(&samples[0], NULL, passes);
        running->resolve_samples(samples, count);
        compare_outputs("resolve_samples");
    }
}

static void test_shade(void **state)
{
    (void)state;
    run_cases(8 * CASES, 10000, shade_case);
}

static void test_resolve_samples(void **state)
{
    (void)state;
    run_cases(CASES, 12000, resolve_samples_case);
}

static void resolve_case(int precision, bool odd)
{
    (void)precision;
    uint32_t groups = 1 + below(GLINT_TILE_GROUPS), n = groups * GLINT_GROUP;
    const uint32_t passes = below(1u << GLINT_TERM_COUNT), missing = below(1u << GLINT_TERM_COUNT) >> GLINT_TERM_LOCAL;
    glint_resolve_args args = { .group_count = groups, .samples = 1 + below(1000) };
    for (int term = 0; term < GLINT_TERM_COUNT; term++) {
        if (missing << GLINT_TERM_LOCAL >> term & 1) // a frame may lack terms that shade does not compute
            continue;
        for (int c = 0; c < 3; c++) {
            args.sum[term][c] = input(KIND_DOUBLE, n);
            for (uint32_t i = 0; i < n; i++)
                args.sum[term][c][i] = maybe_odd(odd, one_in(3) ? 0 : power_of_ten(-5, 3));
        }
    }
    FOR_EACH_TESTED
    {
        for (int term = 0; term < GLINT_TERM_COUNT; term++)
            for (int c = 0; c < 3; c++)
                args.film[term][c] = args.sum[term][c] && passes >> term & 1 ? output("film", KIND_FLOAT, n) : NULL;
        for (int c = 0; c < 3; c++)
            args.beauty[c] = output("beauty", KIND_FLOAT, n);
        running->resolve(&args);
        compare_outputs("resolve");
    }
}

static void test_resolve(void **state)
{
    (void)state;
    run_cases(CASES / 2, 11000, resolve_case);
}

// ---- elementary functions ----------------------------------------------------------------------------------------

/// The error of `got` in ulps of `want` as a float.
static double ulps(float got, long double want)
{
    if (want == 0)
        return got == 0 ? 0 : HUGE_VAL;
    return fabs((double)(((long double)got - want) / ldexpl(1, ilogbl(want) - 23)));
}

/// Largest possible error in float ulps, a sum of these errors: 0.5 from the last sum, 0.25 from the product before
/// that sum, 0.25 from a factor of the product, 0.1 from the earlier terms, and at most 0.34 from the polynomial's
/// own error of 2e-8.
#define MAX_ULP_EXP2 1.5

/// Computes exp2 through shade: white light on a white material of shininess 1, with log2_specular = y.
static double exp2_error(const float y[GLINT_TILE_SAMPLES])
{
    static ALIGNED uint16_t all[GLINT_TILE_GROUPS];
    static ALIGNED uint32_t material[GLINT_TILE_SAMPLES];
    static ALIGNED float cosine[GLINT_TILE_SAMPLES], film[GLINT_TILE_SAMPLES], beauty[3][GLINT_TILE_SAMPLES];
    memset(all, 0xff, sizeof all);
    glint_shade_material white = { .specular = { 1, 1, 1 }, .shininess = 1, .highlight = GLINT_HIGHLIGHT_PHONG };
    glint_shade_light light = { .lit = all, .cosine = cosine, .log2_specular = y, .specular = { 1, 1, 1 } };
    glint_shade_args args = { .group_count = GLINT_TILE_GROUPS,
                              .active = all,
                              .hits = all,
                              .material = material,
                              .materials = &white,
                              .highlights = true,
                              .first = true,
                              .lights = &light,
                              .light_count = 1,
                              .beauty = { beauty[0], beauty[1], beauty[2] } };
    args.film[GLINT_TERM_SPECULAR][0] = film;
    running->shade(&args);
    double worst = 0;
    for (uint32_t i = 0; i < GLINT_TILE_SAMPLES; i++)
        worst = fmax(worst, ulps(film[i], exp2l(y[i])));
    return worst;
}

static void test_exp2_accuracy(void **state)
{
    (void)state;
    static ALIGNED float y[GLINT_TILE_SAMPLES];
    random_state = 13000;
    for (uint32_t k = 0; k < 200; k++) {
        for (uint32_t i = 0; i < GLINT_TILE_SAMPLES; i++)
            y[i] = (float)(k % 4 == 0 ? between(-1, 0) : k % 4 == 1 ? -power_of_ten(-10, 1.6) : between(-40, 0));
        y[0] = -40;
        y[1] = 0;
        y[2] = -0.5f;
        FOR_EACH_TESTED
        {
            double worst = exp2_error(y);
            if (!(worst <= MAX_ULP_EXP2))
                print_message("%s: exp2 is %.3f ulp off\n", running->name, worst);
            assert_true(worst <= MAX_ULP_EXP2);
        }
    }
}

int main(void)
{
    find_tested();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shade),
        cmocka_unit_test(test_resolve),
        cmocka_unit_test(test_resolve_samples),
        cmocka_unit_test(test_exp2_accuracy),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    print_skipped();
    return failed;
}
