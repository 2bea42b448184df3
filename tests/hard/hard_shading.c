/// Test cases for reflections, sums of lights and pixel values, each also rotated and scaled; shininess from 0 to
/// 1e7; pixel values as read from a PNG file.
#include "engine/glint_files.h"
#include "engine/glint_math.h"
#include "tests/hard/oracle/point.h"

#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// ---- Reflections ----

typedef struct reflection_case {
    const char *id, *what;
    bool blinn;
    double shininess, n[3], l[3], v[3];
    double specular, diffuse; ///< the value that the list of hard cases states, to the digits given there; NAN: not
        ///< stated
} reflection_case;

#define Z \
    { \
        0, 0, 1 \
    }
#define TURNED_DOWN \
    { \
        -0.644607008, 0.74651444, -0.164918959 \
    }

static const reflection_case cases[] = {
    { "P1", "Phong", false, 10, Z, { 0.6, 0, 0.8 }, Z, 0.1073741824, 0.8 },
    { "P1", "Blinn, 4 x", true, 40, Z, { 0.6, 0, 0.8 }, Z, 0.1215766546, 0.8 },
    { "P2", "Phong", false, 50, Z, { 3, 0, 4 }, { -3, 1, 4 }, 0.3751168023, 0.8 },
    { "P2", "Blinn, 4 x", true, 200, Z, { 3, 0, 4 }, { -3, 1, 4 }, 0.2174646193, 0.8 },
    { "P3", "light below the horizon", false, 1, { 0, 1, 0 }, { 0.8, -0.6, 0 }, { -0.96, 0.28, 0 }, 0, 0 },
    { "P4", "shininess 0, r.v = 0.5", false, 0, Z, Z, { 0.8660254037844386, 0, 0.5 }, 1, 1 },
    { "P4", "shininess 0, r.v = 0", false, 0, Z, Z, { 1, 0, 0 }, 0, 1 },
    { "P5", "shininess 1e-3", false, 1e-3, Z, Z, { 0.8660254037844386, 0, 0.5 }, 0.99930709299, 1 },
    { "P6",
      "shininess 1e6, r.v = 0.999999",
      false,
      1e6,
      Z,
      Z,
      { 0.0014142132088085115, 0, 0.999999 },
      0.367879257221,
      1 },
    { "P7",
      "shininess 1e6, 1e-3 rad",
      false,
      1e6,
      Z,
      Z,
      { 0.00099999983333334168, 0, 0.99999950000004167 },
      0.606530609,
      1 },
    { "P8", "r = v, longer than 1 in float", false, 1e6, TURNED_DOWN, TURNED_DOWN, TURNED_DOWN, 1, 1 },
    { "P9", "l = -v: h is undefined", true, 10, Z, { 0.6, 0, 0.8 }, { -0.6, 0, -0.8 }, 0, 0 },
    { "P9", "l = -v, Phong", false, 10, Z, { 0.6, 0, 0.8 }, { -0.6, 0, -0.8 }, 0, 0 },
    { "P10", "n.l = 0", false, 5, Z, { 1, 0, 0 }, { 0.8660254037844386, 0, 0.5 }, 0, 0 },
    { "P10", "n.l = -1e-20", false, 5, Z, { 1, 0, -1e-20 }, { 0.8660254037844386, 0, 0.5 }, 0, 0 },
    { "P11", "shininess 310, r.v = 0.1", false, 310, Z, Z, { 0.99498743710661995, 0, 0.1 }, 0, 1 },
    { "P14",
      "Phong, v out of the plane",
      false,
      50,
      Z,
      { 1.7320508075688772, 0, 1 },
      { -1.5, 0.86602540378443865, 1 },
      NAN,
      0.5 },
    { "P14",
      "Blinn, v out of the plane",
      true,
      200,
      Z,
      { 1.7320508075688772, 0, 1 },
      { -1.5, 0.86602540378443865, 1 },
      NAN,
      0.5 },
    // grazing light from the front: the terms of the half vector l + v nearly cancel
    { "P15",
      "Blinn, h of length 2e-5",
      true,
      1e6,
      Z,
      { 1, 0, 1e-5 },
      { -1, 2e-8, 1e-5 },
      0.60653081134522,
      9.9999999995e-06 },
    { "P15",
      "Blinn, h of length 0.011",
      true,
      4577707.932090342,
      { -0x1.a414c7b8b5cb8p-1, 0x1.2128e8ff86085p-1, -0x1.6b4f8397a7f78p-4 },
      { -0x1.6e1a531c34f83p-2, -0x1.80b48c4dbf491p-2, 0x1.b5c362ec1726fp-1 },
      { 0x1.64d81a4d52babp-2, 0x1.865cbe1bf50c7p-2, -0x1.b5bfe959cb6f7p-1 },
      0.98684941986345,
      0.00532264927254788 },
    { "P15",
      "Blinn, h of length 0.0045",
      true,
      6918397.1812005276,
      { 0x1.d14aaf2408c54p-5, 0x1.5b6a8a8e45f4ep-1, 0x1.76f7928ebf813p-1 },
      { 0x1.ef146646bafbp-1, -0x1.c1049034d27dap-3, 0x1.0a8129a5a1372p-3 },
      { -0x1.ee110faf506dfp-1, 0x1.c68120adbfd6dp-3, -0x1.0341c642f5ec9p-3 },
      0.0095981263796176,
      0.001452918168518683 },
    { "P15",
      "Blinn, h of length 0.0023",
      true,
      1303785.3051670482,
      { -0x1.ce5935c6b4a9ep-1, -0x1.a1fde03918535p-6, -0x1.b71f8062379a6p-2 },
      { 0x1.3b64d9fdfe47ap-4, 0x1.f1e1f4829c56bp-1, -0x1.c2d2ca4c9b4b6p-3 },
      { -0x1.4398af3af5de8p-4, -0x1.f154c32b929efp-1, 0x1.c03bfc8507d64p-3 },
      3.767886623798e-8,
      5.594805650890779e-05 },
};

/// Allowed error. log2 of the cosine is a float with an error of at most 2.75 ulp, times a rounded exponent, rounded:
/// 3.75 ulp of y. exp2 adds 1.5 ulp, the strengths of material and light 1.5. Rounding of the vectors changes the
/// cosine, which counts s times. Blinn's h, of length `half`, also turns with l and v. In units of 2^-53 per
/// component, with l and v of length 1: l and v are off by 1 from their division, a l and w d by 1 each from the
/// product; a is off by 3, and w by half of the errors of a and l^2 plus 1.5, so the two lengths differ by 4.5; n
/// turns by 1, at most 2 / |h|. The sum is 11 / |h|, which changes (n.h)^s by s tan(n, h) times as much.
static double allowed(const reflection *want, double shininess, double half)
{
    if (want->specular == 0)
        return 0x1p-40; // a highlight below this value is 0
    const double y = fabs(want->log2_specular), ln2 = 0.6931471805599453;
    const double tangent = shininess > 0 ? sqrt(expm1(2 * ln2 * y / shininess)) : 0; // from (n.h)^s = 2^-y
    const double turn = tangent * (11 * 0x1p-53) / half;
    return want->specular * (0x1p-23 * (ln2 * 3.75 * y + 3) + shininess * (8 * 0x1p-53 + turn)) + 0x1p-40;
}

/// Returns the length of l + v for Blinn's highlight, with l and v normalised; infinity for Phong's highlight.
static double half_length(bool blinn, const double l[3], const double v[3])
{
    const double l_length = hypot(hypot(l[0], l[1]), l[2]), v_length = hypot(hypot(v[0], v[1]), v[2]);
    double half = 0;
    for (int c = 0; c < 3; c++)
        half = hypot(half, l[c] / l_length + v[c] / v_length);
    return blinn ? half : HUGE_VAL;
}

static glint_reflection evaluate(bool blinn, double shininess, const double n[3], const double l[3], const double v[3])
{
    static const double white[3] = { 1, 1, 1 };
    glint_error error;
    glint_reflection out;
    glint_material *material = material_new(blinn ? GLINT_MODEL_BLINN_PHONG : GLINT_MODEL_PHONG, white, 1, shininess);
    must(glint_material_evaluate(material, n, l, v, &out, &error), &error);
    glint_material_release(material);
    return out;
}

/// The textbook's highlight: pow(r.v, s) or pow(n.h, s).
#define NAIVE(name, real, root, power) \
    static double name(bool blinn, double shininess, const double n[3], const double l[3], const double v[3]) \
    { \
        real unit[3][3], h[3], nl = 0, rv = 0, nh = 0, hh = 0; \
        const double *const given[3] = { n, l, v }; \
        for (int k = 0; k < 3; k++) { \
            const real x = (real)given[k][0], y = (real)given[k][1], z = (real)given[k][2]; \
            const real length = root(x * x + y * y + z * z); \
            unit[k][0] = x / length; \
            unit[k][1] = y / length; \
            unit[k][2] = z / length; \
        } \
        for (int c = 0; c < 3; c++) { \
            nl += unit[0][c] * unit[1][c]; \
            h[c] = unit[1][c] + unit[2][c]; \
            hh += h[c] * h[c]; \
        } \
        for (int c = 0; c < 3; c++) { \
            rv += (2 * nl * unit[0][c] - unit[1][c]) * unit[2][c]; \
            nh += unit[0][c] * (h[c] / root(hh)); \
        } \
        return (double)power(blinn ? nh : rv, (real)shininess); \
    }
NAIVE(naive_float, float, sqrtf, powf)
NAIVE(naive_double, double, sqrt, pow)

static double compare(bool blinn, double shininess, const double n[3], const double l[3], const double v[3])
{
    const reflection want = oracle_reflection(blinn, shininess, n, l, v);
    const glint_reflection got = evaluate(blinn, shininess, n, l, v);
    const double error = fabs(got.specular[1] - want.specular),
                 limit = allowed(&want, shininess, half_length(blinn, l, v));
    hard_check(error <= limit && got.specular[1] <= 1, "specular %.10g, truth %.10g, off by %g where %g is allowed",
               got.specular[1], want.specular, error, limit);
    hard_check(fabs(got.diffuse[1] - want.diffuse) <= 0x1p-23, "diffuse %.10g, truth %.10g", got.diffuse[1],
               want.diffuse);
    return error / limit;
}

/// Prints a line of the table from one-pixel frames. In double the frame must agree with `evaluate`, except for the
/// rounding of the pixel's ray.
static void show(const reflection_case *k, const reflection *want, bool right)
{
    static const double white[3] = { 1, 1, 1 };
    glint_material *material =
        material_new(k->blinn ? GLINT_MODEL_BLINN_PHONG : GLINT_MODEL_PHONG, white, 1, k->shininess);
    const hard_values shown = { want->specular, point_reflection(material, k->n, k->l, k->v, GLINT_PRECISION_DOUBLE).specular[1],
                                point_reflection(material, k->n, k->l, k->v, GLINT_PRECISION_FLOAT).specular[1],
                                naive_double(k->blinn, k->shininess, k->n, k->l, k->v),
                                naive_float(k->blinn, k->shininess, k->n, k->l, k->v) };
    glint_material_release(material);
    const double limit = 2 * allowed(want, k->shininess, half_length(k->blinn, k->l, k->v));
    right = right & hard_check(fabs(shown.in_double - want->specular) <= limit, "a frame: specular %.10g, truth %.10g",
                               shown.in_double, want->specular);
    hard_row(k->id, k->what, &shown, right);
}

static void check_reflection(const reflection_case *k)
{
    const reflection want = oracle_reflection(k->blinn, k->shininess, k->n, k->l, k->v);
    if (!isnan(k->specular))
        hard_check(fabs(want.specular - k->specular) <= 5e-10, "oracle %.12g, stated %.12g", want.specular,
                   k->specular);
    hard_check(fabs(want.diffuse - k->diffuse) <= 1e-15, "oracle %.17g, stated %.17g", want.diffuse, k->diffuse);
    const double share = compare(k->blinn, k->shininess, k->n, k->l, k->v);
    show(k, &want, share <= 1);
    for (int turn = 0; turn < 6; turn++) // swaps the axes, and uses vectors of other lengths
        for (int e = -300; e <= 300; e += 150) {
            static const int order[6][3] = { { 0, 1, 2 }, { 0, 2, 1 }, { 1, 0, 2 },
                                             { 1, 2, 0 }, { 2, 0, 1 }, { 2, 1, 0 } };
            double n[3], l[3], v[3];
            for (int c = 0; c < 3; c++) {
                n[c] = ldexp(k->n[order[turn][c]], e);
                l[c] = k->l[order[turn][c]] * 3;
                v[c] = ldexp(k->v[order[turn][c]], -e);
            }
            compare(k->blinn, k->shininess, n, l, v);
        }
}

/// Shininess 0 and 1e-3 .. 1e7, with v at a distance from the mirror direction that gives highlights from 1 to 2^-45.
/// Some cases have grazing light.
static void sweep_shininess(uint64_t count)
{
    hard_test("P", "shininess 0 .. 1e7");
    double worst = 0;
    for (uint64_t i = 0; i < count; i++) {
        const double shininess = chance(0.02) ? 0 : log_uniform(1e-3, 1e7);
        const bool blinn = chance(0.5);
        double n[3], l[3], v[3], off[3], nl = 0;
        random_direction(n);
        random_direction(l);
        random_direction(off);
        for (int c = 0; c < 3; c++)
            nl += n[c] * l[c];
        const double rise = chance(0.2) ? log_uniform(1e-7, 1) : 1;
        const double angle = fmin(1, sqrt(uniform(0, 90) / (shininess + 1e-9))) * (blinn ? 2 * rise : 1);
        for (int c = 0; c < 3; c++) {
            l[c] = (nl < 0 ? -1 : 1) * (l[c] - (1 - rise) * nl * n[c]);
            v[c] = 2 * rise * fabs(nl) * n[c] - l[c] + angle * off[c];
        }
        worst = fmax(worst, compare(blinn, shininess, n, l, v));
    }
    if (hard_table)
        printf("\n%llu highlights of shininess 0 .. 1e7: worst error %.2f of the bound.\n", (unsigned long long)count,
               worst);
}

// ---- Pixel values ----

/// Renders a row of pixels with these linear values:
/// an orthographic camera sees one sphere per pixel, lit only by ambient light.
static glint_image *row_of(const double *values, int count)
{
    static const double one[3] = { 1, 1, 1 }, none[3] = { 0 };
    glint_scene *scene = scene_new();
    scene_light_up(scene, 1, none);
    glint_camera_desc camera = glint_camera_desc_default();
    camera.projection = GLINT_PROJECTION_ORTHOGRAPHIC;
    camera.height = 1;
    scene_camera(scene, &camera);
    for (int i = 0; i < count; i++) {
        const hard_sphere ball = { { i + 0.5 - 0.5 * count, 0, 0 }, 0.4 };
        glint_material *material = material_new(GLINT_MODEL_LAMBERT, one, 0, 1);
        glint_material_desc desc = *glint_material_get(material);
        desc.struct_size = sizeof desc;
        glint_error error;
        for (int c = 0; c < 3; c++)
            desc.diffuse[c] = values[i];
        must(glint_material_set(material, &desc, &error), &error);
        scene_sphere(scene, &ball, material);
        glint_material_release(material);
    }
    const frame_desc desc = { count, 1, GLINT_PRECISION_DOUBLE, 1u << GLINT_PASS_BEAUTY, 1, NULL };
    glint_image *image = frame(scene, &desc, NULL);
    glint_scene_release(scene);
    return image;
}

/// Writes the image and reads its pixel values back with libpng.
static void written_codes(const glint_image *image, glint_transfer transfer, int bits, int *codes)
{
    char path[64];
    const int width = glint_image_width(image);
    glint_error error;
    glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .path = path, .pass = GLINT_PASS_BEAUTY, .tone = glint_tone_desc_default() };
    desc.tone.transfer = transfer;
    desc.tone.bits = bits;
    temporary_file(path, ".png");
    must(glint_image_write(image, &desc, &error), &error);
    FILE *in = fopen(path, "rb");
    unlink(path);
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_byte *row = malloc((size_t)width * 6);
    if (!in || !row || setjmp(png_jmpbuf(png)))
        exit(1);
    png_init_io(png, in);
    png_read_info(png, info);
    const int wide = png_get_bit_depth(png, info) == 16;
    hard_check(png_get_bit_depth(png, info) == bits, "a PNG of %d bits", bits);
    png_read_row(png, row, NULL);
    for (int x = 0; x < width; x++)
        codes[x] = wide ? row[6 * x] << 8 | row[6 * x + 1] : row[3 * x];
    png_destroy_read_struct(&png, &info, NULL);
    fclose(in);
    free(row);
}

static void check_row(const char *id, const double *values, int count, glint_transfer transfer, int bits,
                      const int *stated)
{
    hard_test(id, bits == 8 ? "codes of 8 bits" : "codes of 16 bits");
    int *codes = calloc((size_t)count, sizeof *codes), wrong = 0;
    glint_image *image = row_of(values, count);
    written_codes(image, transfer, bits, codes);
    for (int i = 0; i < count; i++) {
        float linear[3];
        pixel(image, GLINT_PASS_BEAUTY, i, 0, linear);
        const int want = oracle_code(linear[1], transfer == GLINT_TRANSFER_SRGB, bits == 8 ? 255 : 65535);
        wrong += !hard_check(codes[i] == want && (!stated || codes[i] == stated[i]), "%.9g is %d, truth %d", linear[1],
                             codes[i], want);
    }
    if (hard_table)
        printf("| %s | %d values | %d bit, %s | %d | %s |\n", id, count, bits,
               transfer == GLINT_TRANSFER_SRGB ? "sRGB" : "linear", wrong, wrong ? "**wrong**" : "right");
    glint_image_release(image);
    free(codes);
}

static void check_codes(void)
{
    // I1; a pixel is a float, so a value slightly below a half stays there
    const double steps[] = { 0.49999 / 255, 0.5 / 255, 1.5 / 255, 127.5 / 255, 0.999, 1.0001, 1e30, 0 };
    const int step_codes[] = { 0, 1, 2, 128, 255, 255, 255, 0 };
    check_row("I1", steps, 8, GLINT_TRANSFER_LINEAR, 8, step_codes);
    // I2 without 0.2140411, whose float is on the other side of the step
    const double known[] = { 0.0031308, 0.18, 0.5, 0.75, 1 };
    const int known_8[] = { 10, 118, 188, 225, 255 }, known_16[] = { 2651, 30235, 48192, 57725, 65535 };
    check_row("I2", known, 5, GLINT_TRANSFER_SRGB, 8, known_8);
    check_row("I2", known, 5, GLINT_TRANSFER_SRGB, 16, known_16);
    double values[1024];
    int same[1024];
    for (int bits = 8; bits <= 16; bits += 8) {
        const int range = bits == 8 ? 255 : 65535, count = bits == 8 ? 256 : 1024;
        for (int i = 0; i < count; i++) {
            same[i] = bits == 8 ? i : (int)(random_bits() % 65536);
            values[i] = glint_srgb_decode((double)same[i] / range);
        }
        check_row("I3", values, count, GLINT_TRANSFER_SRGB, bits, same); // I3: pixel value -> linear -> pixel value
        for (int i = 0; i < 1024; i++) { // the values of the steps themselves, and a few floats on each side
            const double step = glint_srgb_decode(((double)(random_bits() % (unsigned)range) + 0.5) / range);
            values[i] = (double)((float)step * (1 + (float)(int)(random_bits() % 7 - 3) * 0x1p-23f));
        }
        check_row("steps", values, 1024, GLINT_TRANSFER_SRGB, bits, NULL);
    }
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_columns("Reflections: the highlight of one light.");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        hard_test(cases[i].id, cases[i].what);
        check_reflection(&cases[i]);
    }
    sweep_shininess(hard_rays / 20);
    if (hard_table)
        printf("\nCodes, read back from PNG files.\n\n| case | of | as | wrong | verdict |\n| --- | --- | --- | --- | "
               "--- |\n");
    check_codes();
    return hard_end();
}
