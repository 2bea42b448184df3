/// Rays of a rough mirror, with roughness 1e-4 to 1 and at grazing angles, against integrals in 113 bits. The sky is
/// white on one side of a plane and black on the other, and the edge goes through the lobe.
#include "tests/engine/cases/step.h"
#include "tests/hard/oracle/drive.h"
#include "tests/hard/oracle/oracle_rough.h"

#include <math.h>
#include <string.h>

#define RAYS 16384
#define RINGS 128
#define SHARP 1e-6 ///< alpha below which the engine casts one ray

static const double black[3] = { 0 }, white[3] = { 1, 1, 1 };

static glint_material *mirror(bool beckmann, double roughness)
{
    glint_material *material;
    glint_error error;
    glint_material_desc desc = glint_material_desc_default();
    desc.distribution = beckmann ? GLINT_DISTRIBUTION_BECKMANN : GLINT_DISTRIBUTION_GGX;
    desc.has_roughness = desc.has_mirror = true;
    desc.roughness = roughness;
    memcpy(desc.mirror, white, sizeof desc.mirror);
    memcpy(desc.diffuse, black, sizeof desc.diffuse);
    must(glint_material_create(&desc, &material, &error), &error);
    return material;
}

/// Fills a random unit vector at a right angle to a unit vector.
static void random_across(const double v[3], double out[3])
{
    double dot, length;
    do {
        random_direction(out);
        dot = out[0] * v[0] + out[1] * v[1] + out[2] * v[2];
        for (int c = 0; c < 3; c++)
            out[c] -= dot * v[c];
        length = hypot(hypot(out[0], out[1]), out[2]);
    } while (length < 0.1);
    for (int c = 0; c < 3; c++)
        out[c] /= length;
}

/// Fills x along a unit vector and the rest across it.
static void lean(const double v[3], double x, double out[3])
{
    random_across(v, out);
    for (int c = 0; c < 3; c++)
        out[c] = x * v[c] + sqrt(1 - x * x) * out[c];
}

/// Renders the point. The black side of the sky is a plane, which every ray to that side hits.
static double seen(glint_material *material, const double n[3], const double v[3], const double toward[3], glint_precision precision)
{
    const hard_plane floor = { { 0 }, { n[0], n[1], n[2] } };
    const hard_plane side = { { -toward[0], -toward[1], -toward[2] }, { toward[0], toward[1], toward[2] } };
    const hard_ray ray = { { v[0] / 2, v[1] / 2, v[2] / 2 }, { -v[0], -v[1], -v[2] } };
    glint_error error;
    float out[3];
    glint_scene *scene = scene_new();
    scene_light_up(scene, 0, white);
    glint_scene_desc desc = *glint_scene_get(scene);
    desc.struct_size = sizeof desc;
    desc.reflection_samples = RAYS;
    must(glint_scene_set(scene, &desc, &error), &error);
    glint_material *dark = material_new(GLINT_MODEL_LAMBERT, black, 0, 1);
    scene_plane(scene, &floor, material);
    scene_plane(scene, &side, dark);
    glint_material_release(dark);
    glint_image *image = frame_of_ray(scene, &ray, precision, 1u << GLINT_PASS_MIRROR);
    glint_scene_release(scene);
    pixel(image, GLINT_PASS_MIRROR, 0, 0, out);
    glint_image_release(image);
    return out[1];
}

/// Compares one point. The mean of N weights of at most w has a standard error of at most sqrt((w R - R^2) / N). w is 1
/// for GGX's facets; Beckmann's are drawn from these: 4/e, times the quotient of Smith's terms, at most 3.535 / 2.
/// Returns the larger error, relative to the allowed one of four standard errors.
static double compare(bool beckmann, double roughness, double cosine)
{
    double n[3], v[3], to[3], toward[3], worst = 0;
    const double alpha = roughness * roughness, most = beckmann ? 4 / M_E * 3.535 / 2 : 1;
    random_direction(n);
    lean(n, cosine, v);
    for (int c = 0; c < 3; c++)
        to[c] = 2 * (n[0] * v[0] + n[1] * v[1] + n[2] * v[2]) * n[c] - v[c];
    lean(to, fmin(alpha, 0.4) * uniform(-2, 2), toward);
    const double want = oracle_step(beckmann, roughness, n, v, toward, RINGS);
    const double coarse = oracle_step(beckmann, roughness, n, v, toward, RINGS / 2);
    const double error = sqrt(fmax(most * want - want * want, 0) / (alpha < SHARP ? 1 : RAYS));
    glint_material *material = mirror(beckmann, roughness);
    for (int precision = GLINT_PRECISION_DOUBLE; precision <= (roughness < 0.1 ? GLINT_PRECISION_DOUBLE : GLINT_PRECISION_FLOAT); precision++) {
        const double got = seen(material, n, v, toward, (glint_precision)precision);
        const double off = fabs(got - want), limit = 4 * error + fabs(want - coarse) + 1e-6;
        worst = fmax(worst, off / limit);
        hard_check(off <= limit, "%s, roughness %g, cosine %g, %s: %.6g, truth %.6g, off by %g where %g is allowed",
                   beckmann ? "Beckmann" : "GGX", roughness, cosine, precision == GLINT_PRECISION_DOUBLE ? "double" : "float", got, want, off, limit);
    }
    glint_material_release(material);
    return worst;
}

int main(int argc, char **argv)
{
    static const double roughness[8] = { 1e-4, 9e-4, 2e-3, 0.01, 0.1, 0.3, 0.6, 1 }, cosine[4] = { 0.999, 0.6, 0.1, 0.01 };
    double worst = 0;
    hard_begin(argc, argv);
    hard_test("rough", "the rays of rough mirrors under a step");
    for (int i = 0; i < 2 * 8 * 4; i += (int)case_step())
        worst = fmax(worst, compare(i % 2, roughness[i / 2 % 8], cosine[i / 16]));
    if (hard_table)
        printf("\nRough mirrors under a step, roughness 1e-4 .. 1: worst error %.2f of the bound.\n", worst);
    return hard_end();
}
