/// Test cases for mirrors and glass: Fresnel and Snell at and around the critical angle, mirrors that face each
/// other, chains of up to a million reflections, and total reflection.
#include "tests/engine/cases/step.h"
#include "tests/hard/oracle/oracle_light.h"
#include "tests/hard/oracle/point.h"

#include <string.h>
#include <sys/resource.h>

#define LOSS 0x1p-20 ///< largest error: the light that dropped weak rays may carry

// ---- Fresnel ----

/// Returns the share of light that a glass plane of index `ior` reflects, at depth 1, in a white world. The ray along
/// d hits the plane from inside or from air.
static double reflectance(double ior, bool from_inside, const double d[3], glint_precision precision)
{
    static const double white[3] = { 1, 1, 1 };
    const hard_plane plane = { { 0 }, { 0, 1, 0 } };
    hard_ray ray = { { 0, from_inside ? -1 : 1, 0 }, { d[0], d[1] * (from_inside ? 1 : -1), d[2] } };
    glint_scene *scene = scene_new();
    glint_material *glass = point_glass(0, 1, 1, ior, true);
    scene_light_up(scene, 0, white);
    scene_plane(scene, &plane, glass);
    glint_material_release(glass);
    const double mirrored = point_seen(scene, &ray, precision, 1, GLINT_PASS_MIRROR);
    const double through = point_seen(scene, &ray, precision, 1, GLINT_PASS_TRANSMISSION);
    glint_scene_release(scene);
    const double lost = mirrored > 0 && through > 0 ? 0 : LOSS; // too weak a share is not traced
    hard_check(fabs(mirrored + through - 1) < lost + 0x1p-22, "mirrored %.9g and let through %.9g", mirrored, through);
    return mirrored;
}

/// The textbook: Snell's sine, then the two polarisations.
#define NAIVE(name, real, root) \
    static double name(double ratio, double cosine) \
    { \
        const real r = (real)ratio, c = (real)cosine, k = 1 - r * r * (1 - c * c), s = root(k); \
        const real p = (r * c - s) / (r * c + s), q = (c - r * s) / (c + r * s); \
        return (double)((p * p + q * q) / 2); \
    }
NAIVE(naive_float, float, sqrtf)
NAIVE(naive_double, double, sqrt)

/// Rounding of the ray's direction changes the cosine beyond the surface: by ratio^2 2^-52 divided by that cosine, or
/// near the critical angle by the square root of ratio^2 2^-52.
static bool check_fresnel(const char *id, const char *what, double ior, bool from_inside, double cosine, double stated)
{
    const double ratio = from_inside ? ior : 1 / ior, sine = sqrt((1 - cosine) * (1 + cosine));
    const double d[3] = { sine, cosine, 0 };
    hard_values shown = { .truth = oracle_fresnel(ratio, cosine),
                          .naive_double = naive_double(ratio, cosine),
                          .naive_float = naive_float(ratio, cosine) };
    bool right = isnan(stated) || hard_check(fabs(shown.truth - stated) <= 5e-11 * (1 + 4e3 * (stated == 1)),
                                             "oracle %.15g, stated %.12g", shown.truth, stated);
    double *const got[2] = { &shown.in_double, &shown.in_float };
    for (int p = 0; p < 2; p++) {
        const double rounding = p ? 0x1p-21 : 0x1p-50;
        // the slope of the reflectance is 4/cos at grazing angles and 4/cos' at critical angles
        const double beyond = sqrt(fabs(1 - ratio * ratio * sine * sine)), moved = rounding * ratio * ratio;
        const double off =
            0x1p-22 + 8 * (rounding / fmax(cosine, rounding) + ratio * fmin(sqrt(moved), moved / fmax(beyond, 1e-300)));
        *got[p] = reflectance(ior, from_inside, d, (glint_precision)p);
        right &= hard_check(fabs(*got[p] - shown.truth) <= off, "%s: %.12g, truth %.12g, %g allowed", what, *got[p],
                            shown.truth, off);
    }
    hard_row(id, what, &shown, right);
    return right;
}

static void fresnel(void)
{
    const double critical = sqrt(5) / 3; // the cosine where the sine is 2/3
    char what[80];
    hard_test("M1", "critical angle");
    check_fresnel("M1", "1.5 -> 1, sin = 2/3: R", 1.5, true, critical, NAN);
    for (double near = 1e-2; near > 1e-17; near *= 1e-3)
        for (int side = -1; side <= 1; side += 2) {
            snprintf(what, sizeof what, "cosine %s by %.0e", side < 0 ? "less" : "more", near);
            check_fresnel("M1", what, 1.5, true, critical * (1 + side * near), side < 0 && near > 1e-15 ? 1 : NAN);
        }
    hard_test("M3", "Fresnel");
    check_fresnel("M3", "1 -> 1.5 at cos 1", 1.5, false, 1, 0.04);
    check_fresnel("M3", "1 -> 1.5 at cos 0.5", 1.5, false, 0.5, 0.0891867128);
    check_fresnel("M3", "1 -> 1.5 at cos 0.1", 1.5, false, 0.1, 0.5715925203);
    check_fresnel("M3", "1 -> 1.5 at cos 1e-9", 1.5, false, 1e-9, 1);
    hard_test("M4", "Fresnel from inside");
    check_fresnel("M4", "1.5 -> 1 at cos 0.75", 1.5, true, 0.75, 0.5);
    const bool table = hard_table;
    hard_table = false; // too many rows for the table
    for (int i = 0; i < 300; i += (int)case_step()) {
        const double ior = chance(0.3) ? 1 + log_uniform(1e-6, 1) : log_uniform(0.1, 10);
        check_fresnel("M3", "random", ior, chance(0.5), chance(0.3) ? log_uniform(1e-6, 1) : uniform(0, 1), NAN);
    }
    hard_table = table;
}

// ---- Snell ----

/// Returns whether a ray refracted at the origin hits a sheet that lies `below` the surface and starts at x.
static bool lands_beyond(double ior, const double d[3], double below, double x, glint_precision precision)
{
    const hard_plane plane = { { 0 }, { 0, 1, 0 } };
    const double far = 1e3 * below, vertices[4][3] = {
        { x, -below, -far }, { x + 4 * far, -below, -far }, { x + 4 * far, -below, far }, { x, -below, far }
    };
    const uint32_t corners[4] = { 0, 1, 2, 3 }, size = 4;
    const hard_ray ray = { { -d[0], -d[1], -d[2] }, { d[0], d[1], d[2] } };
    glint_mesh_desc mesh = glint_mesh_desc_default();
    glint_scene *scene = scene_new();
    glint_material *glass = point_glass(0, 0, 1, ior, false), *visible_light = point_glass(1, 0, 0, 1, false);
    glint_shape *sheet;
    glint_error error;
    mesh.vertices = vertices[0];
    mesh.vertex_count = 4;
    mesh.corners = corners;
    mesh.face_sizes = &size;
    mesh.face_count = 1;
    mesh.material = visible_light;
    must(glint_mesh_create(&mesh, &sheet, &error), &error);
    must(glint_scene_add_shape(scene, sheet, &error), &error);
    glint_shape_release(sheet);
    scene_plane(scene, &plane, glass);
    scene_light_up(scene, 1, (double[3]) { 0 });
    glint_material_release(glass);
    glint_material_release(visible_light);
    const double seen = point_seen(scene, &ray, precision, 2, GLINT_PASS_TRANSMISSION);
    glint_scene_release(scene);
    return seen > 0;
}

/// Returns the refracted ray's tangent, by bisection over the edge of a sheet.
static double tangent(double ior, const double d[3], glint_precision precision)
{
    double low = 0, high = 1e3;
    for (int i = 0; i < 64; i++) {
        const double x = 0.5 * (low + high);
        *(lands_beyond(ior, d, 1, x, precision) ? &low : &high) = x;
    }
    return low;
}

static void check_snell(const char *id, const char *what, double ior, double degrees, double stated)
{
    const double angle = degrees * M_PI / 180, d[3] = { sin(angle), -cos(angle), 0 };
    const double sine = oracle_snell(1 / ior, sin(angle));
    hard_values shown = { .truth = asin(sine) * 180 / M_PI,
                          .naive_double = asin(sin(angle) / ior) * 180 / M_PI,
                          .naive_float = (double)(asinf(sinf((float)angle) / (float)ior) * (180 / (float)M_PI)) };
    double *const got[2] = { &shown.in_double, &shown.in_float };
    bool right = true;
    if (stated > 0)
        hard_check(fabs(shown.truth - stated) < 5e-10, "oracle %.12g degrees, stated %.12g", shown.truth, stated);
    for (int p = 0; p < 2; p++) {
        *got[p] = atan(tangent(ior, d, (glint_precision)p)) * 180 / M_PI;
        right &= hard_check(fabs(*got[p] - shown.truth) <= (p ? 2e-4 : 1e-12), "%s: %.14g degrees, truth %.14g", what,
                            *got[p], shown.truth);
    }
    hard_row(id, what, &shown, right);
}

static void snell(void)
{
    hard_test("M5", "Snell");
    check_snell("M5", "45 degrees, 1 -> 1.5", 1.5, 45, 28.125505702);
    check_snell("M5", "5 degrees, 1 -> 2.4", 2.4, 5, 0);
    check_snell("M5", "85 degrees, 1 -> 1.33", 1.33, 85, 0);
    check_snell("M5", "30 degrees, 1 -> 1.0000001", 1.0000001, 30, 0);
    hard_test("M2", "ior 1: direction unchanged");
    for (int i = 1; i < 8; i++) {
        char what[64];
        snprintf(what, sizeof what, "%d degrees, 1 -> 1", 10 * i);
        check_snell("M2", what, 1, 10 * i, 10 * i);
    }
    for (int i = 0; i < 2; i++)
        check_fresnel("M2", i ? "1 -> 1: R, from inside" : "1 -> 1: R", 1, i, 0.7, 0);
}

// ---- Depth ----

static long resident_kb(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

/// Returns the light between two glowing mirrors that face each other.
static double facing(double mirror, double depth, double visible_light, glint_precision precision)
{
    const hard_plane low = { { 0 }, { 0, 1, 0 } }, high = { { 0, 1, 0 }, { 0, -1, 0 } };
    const hard_ray ray = { { 0, 0.5, 0 }, { 0.3, -1, 0 } };
    glint_scene *scene = scene_new();
    glint_material *wall = point_glass(visible_light, mirror, 0, 1.5, false);
    scene_plane(scene, &low, wall);
    scene_plane(scene, &high, wall);
    glint_material_release(wall);
    scene_light_up(scene, 1, (double[3]) { 0 });
    const double seen = point_seen(scene, &ray, precision, depth, GLINT_PASS_BEAUTY);
    glint_scene_release(scene);
    return seen;
}

static void mirrors(void)
{
    static const double depths[] = { 0, 1, 2, 10, 60, 1000, 1e6 };
    hard_test("M6", "facing mirrors");
    for (size_t i = 0; i < sizeof depths / sizeof *depths; i++) {
        char what[64];
        const double depth = depths[i];
        hard_values shown = { oracle_facing_mirrors(0.05, 0.9, depth), facing(0.9, depth, 0.05, GLINT_PRECISION_DOUBLE),
                              facing(0.9, depth, 0.05, GLINT_PRECISION_FLOAT), HARD_BLANK, HARD_BLANK };
        const bool right = hard_check(fabs(shown.in_double - shown.truth) <= LOSS + 0x1p-23, "depth %g: %.9g, not %.9g",
                                      depth, shown.in_double, shown.truth) &
                           hard_check(fabs(shown.in_float - shown.truth) <= LOSS + 0x1p-21, "depth %g: %.9g, not %.9g",
                                      depth, shown.in_float, shown.truth);
        snprintf(what, sizeof what, "mirrors of 0.9 that glow 0.05, depth %g", depth);
        hard_row("M6", what, &shown, right);
    }
    for (double mirror = 0.5; mirror < 1; mirror += 0.07)
        hard_check(fabs(facing(mirror, 1e6, 0.01, GLINT_PRECISION_DOUBLE) - oracle_facing_mirrors(0.01, mirror, 1e6)) <=
                       LOSS + 0x1p-22,
                   "mirrors of %g", mirror);
}

static void depth(void)
{
    hard_test("depth 1e6", "mirrors of 1: a million reflections");
    hard_values shown = { .naive_double = HARD_BLANK, .naive_float = HARD_BLANK };
    const long before = resident_kb();
    shown.truth = oracle_facing_mirrors(1e-6, 1, 1e6);
    shown.in_double = facing(1, 1e6, 1e-6, GLINT_PRECISION_DOUBLE);
    const long memory = resident_kb() - before;
    const bool right =
        hard_check(fabs(shown.in_double - shown.truth) < 1e-6, "%.9g, not %.9g", shown.in_double, shown.truth) &
        hard_check(memory < 64 << 10, "%ld KB more", memory);
    shown.in_float = facing(1, 1e6, 1e-6, GLINT_PRECISION_FLOAT);
    hard_row("depth 1e6", "mirrors of 1 that glow 1e-6", &shown, right);
}

// ---- Total reflection ----

/// Returns the light through a glass rod along x, one unit thick. A ray enters at 45 degrees through one end, and
/// leaves through the other end after `reflections` total reflections.
static double through_rod(int reflections, double transmission, double mirror, glint_precision precision)
{
    static const double white[3] = { 1, 1, 1 };
    const double rise = 1 / sqrt(2 * 1.5 * 1.5 - 1); // the tangent inside the glass, for a sine of sqrt(1/2) / 1.5
    const hard_ray ray = { { -0.5, 0, 0 }, { 1, 1, 0 } }; // the ray enters halfway up
    glint_shape_desc rod = glint_shape_desc_default(GLINT_SHAPE_BOX);
    glint_scene *scene = scene_new();
    glint_shape *shape;
    glint_error error;
    rod.min[0] = rod.min[1] = 0;
    rod.max[0] = reflections / rise;
    rod.material = point_glass(0, mirror, transmission, 1.5, false);
    must(glint_shape_create(&rod, &shape, &error), &error);
    must(glint_scene_add_shape(scene, shape, &error), &error);
    glint_material_release(rod.material);
    glint_shape_release(shape);
    scene_light_up(scene, 0, white);
    const double seen = point_seen(scene, &ray, precision, reflections + 2, GLINT_PASS_TRANSMISSION);
    glint_scene_release(scene);
    return seen;
}

/// Totally reflected light does not cross the surface, so transmission does not dim it. The textbook's columns dim it
/// at each reflection.
static void total(void)
{
    static const struct {
        int reflections;
        double transmission;
    } rods[] = { { 1, 0.5 }, { 5, 0.9 }, { 5, 0.5 }, { 12, 0.8 }, { 100, 0.99 } };
    hard_test("total", "total reflection keeps all of the light");
    for (size_t i = 0; i < sizeof rods / sizeof *rods; i++) {
        char what[80];
        const double t = rods[i].transmission, dimmed = t * t * pow(t, rods[i].reflections);
        hard_values shown = { .truth = t * t, .naive_double = dimmed, .naive_float = dimmed };
        double *const got[2] = { &shown.in_double, &shown.in_float };
        bool right = true;
        for (int p = 0; p < 2; p++) {
            *got[p] = through_rod(rods[i].reflections, t, 0, (glint_precision)p);
            right &= hard_check(fabs(*got[p] - t * t) <= 0x1p-23, "%.9g, truth %.9g", *got[p], t * t);
        }
        snprintf(what, sizeof what, "%d total reflections in glass of transmission %g", rods[i].reflections, t);
        hard_row("total", what, &shown, right);
    }
}

/// A random prism with total reflections as above, of any length, size, index, angle, position and orientation. *out
/// gets the transmitted light, *through the true value, transmission^2.
/// Returns false for prisms close to the critical angle.
static bool random_prism(double *out, double *through)
{
    static const double white[3] = { 1, 1, 1 };
    const double ior = uniform(1.2, 2.5), sine = uniform(0.05, 0.95), inside = sine / ior,
                 rise = inside / sqrt(1 - inside * inside), size = log_uniform(1e-6, 1e6);
    const int reflections = 1 + (int)(random_bits() % 40);
    double axis[3], by[3];
    if (ior * ior * (1 - inside * inside) < 1.001 || rise * reflections < 1e-2)
        return false; // the prism is close to the critical angle
    *through = uniform(0.1, 1);
    random_direction(axis);
    for (int c = 0; c < 3; c++)
        by[c] = chance(0.5) ? 0 : size * uniform(-100, 100);
    const glint_transform turn = glint_transform_rotate_deg(axis, uniform(0, 360)), move = glint_transform_translate(by),
                          map = glint_transform_product(&move, &turn);
    glint_shape_desc rod = glint_shape_desc_default(GLINT_SHAPE_BOX);
    glint_scene *scene = scene_new();
    glint_shape *shape;
    glint_error error;
    rod.min[0] = rod.min[1] = 0;
    rod.min[2] = -size;
    rod.max[0] = size * reflections / rise;
    rod.max[1] = rod.max[2] = size;
    rod.transform = map;
    rod.material = point_glass(0, 0, *through, ior, false);
    must(glint_shape_create(&rod, &shape, &error), &error);
    must(glint_scene_add_shape(scene, shape, &error), &error);
    glint_material_release(rod.material);
    glint_shape_release(shape);
    scene_light_up(scene, 0, white);
    // The ray enters halfway up.
    const double from[3] = { -size * sqrt(1 - sine * sine), size * (0.5 - sine), 0 },
                 d[3] = { sqrt(1 - sine * sine), sine, 0 };
    hard_ray ray;
    for (int i = 0; i < 3; i++) {
        ray.o[i] = map.m[i][0] * from[0] + map.m[i][1] * from[1] + map.m[i][2] * from[2] + map.m[i][3];
        ray.d[i] = map.m[i][0] * d[0] + map.m[i][1] * d[1] + map.m[i][2] * d[2];
    }
    *out = point_seen(scene, &ray, GLINT_PRECISION_DOUBLE, reflections + 2, GLINT_PASS_TRANSMISSION);
    *through *= *through;
    glint_scene_release(scene);
    return true;
}

static void prisms(uint64_t count)
{
    hard_test("fuzz", "prisms of total reflection");
    hard_values shown = { 0, 0, 0, HARD_BLANK, HARD_BLANK };
    char what[80];
    for (uint64_t i = 0; i < count;) {
        double got, through;
        if (!random_prism(&got, &through))
            continue;
        i++;
        shown.in_double += !hard_check(fabs(got - through) <= 0x1p-22, "%.9g, truth %.9g", got, through);
    }
    shown.in_float = HARD_BLANK;
    snprintf(what, sizeof what, "of %llu prisms, dimmed by their total reflections", (unsigned long long)count);
    hard_row("total", what, &shown, shown.in_double == 0);
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_columns("Mirrors and glass: shares of light, degrees.");
    fresnel();
    snell();
    mirrors();
    depth();
    total();
    prisms(hard_rays / 5000);
    return hard_end();
}
