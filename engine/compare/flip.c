#include "engine/compare/flip.h"

#include "engine/base/status.h"
#include "engine/glint_math.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define COLOR_RADIUS 10 ///< pixels: ceil(3 sqrt(0.04 / (2 pi^2)) ppd), three standard deviations of the widest filter
#define FEATURE_SD (0.5 * GLINT_FLIP_W * GLINT_FLIP_PPD)
#define FEATURE_RADIUS 9 ///< ceil(3 FEATURE_SD)
#define RADIUS_MAX COLOR_RADIUS

struct glint_flip {
    int width, height;
    float *lab[3]; ///< L*, a* and b* (the last two with Hunt's adjustment) of the blurred picture
    float *edge, *point; ///< strength of edges and of points in each pixel
};

/// A filter of 2 radius + 1 taps.
typedef struct kernel {
    int radius;
    float tap[2 * RADIUS_MAX + 1];
} kernel;

// ---- Colour spaces ------------------------------------------------------------------------------------------------

/// Linear sRGB to XYZ (D65), as exact fractions from the chromaticities of the primaries; and the inverse.
static const double TO_XYZ[3][3] = {
    { 10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794 },
    { 2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897 },
    { 1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382 },
};
static const double FROM_XYZ[3][3] = {
    { 3.2410032329763587, -1.5373989694887855, -0.4986158819963629 },
    { -0.9692242522025166, 1.875929983695176, 0.041554226340084724 },
    { 0.055639419851975444, -0.20401120612390997, 1.0571489771875335 },
};

static void multiply(const double m[3][3], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (m[i][0] * v[0] + m[i][1] * v[1]) + m[i][2] * v[2];
}

/// Returns XYZ relative to white.
static void relative_xyz(const double rgb[3], double out[3])
{
    multiply(TO_XYZ, rgb, out);
    for (int i = 0; i < 3; i++)
        out[i] /= (TO_XYZ[i][0] + TO_XYZ[i][1]) + TO_XYZ[i][2];
}

static void rgb_to_ycxcz(const double rgb[3], double out[3])
{
    double w[3];
    relative_xyz(rgb, w);
    out[0] = 116 * w[1] - 16;
    out[1] = 500 * (w[0] - w[1]);
    out[2] = 200 * (w[1] - w[2]);
}

/// Converts a blurred YCxCz to linear light, clipped to the range of a screen.
static void ycxcz_to_rgb(const double ycxcz[3], double out[3])
{
    const double y = (ycxcz[0] + 16) / 116, w[3] = { y + ycxcz[1] / 500, y, y - ycxcz[2] / 200 };
    double xyz[3];
    for (int i = 0; i < 3; i++)
        xyz[i] = w[i] * ((TO_XYZ[i][0] + TO_XYZ[i][1]) + TO_XYZ[i][2]);
    multiply(FROM_XYZ, xyz, out);
    for (int i = 0; i < 3; i++)
        out[i] = out[i] > 0 ? out[i] < 1 ? out[i] : 1 : 0;
}

/// Returns the cube root of x > 0, with the same bits on every machine: a third of the exponent, then Newton's method.
static double cube_root(double x)
{
    uint64_t bits;
    double y;
    memcpy(&bits, &x, sizeof bits);
    bits = bits / 3 + 0x2a9f7893782da1ceu; // within 4 %; each step squares the error
    memcpy(&y, &bits, sizeof y);
    for (int i = 0; i < 4; i++)
        y -= (y * y * y - x) / (3 * y * y);
    return y;
}

/// Converts linear light to CIELAB, with a* and b* times 0.01 L* (Hunt: brighter light makes colours look stronger).
static void hunt_lab(const double rgb[3], double out[3])
{
    static const double knee = 6.0 / 29;
    double w[3], f[3];
    relative_xyz(rgb, w);
    for (int i = 0; i < 3; i++)
        f[i] = w[i] > knee * knee * knee ? cube_root(w[i]) : w[i] / (3 * knee * knee) + 4.0 / 29;
    out[0] = 116 * f[1] - 16;
    out[1] = 0.01 * out[0] * (500 * (f[0] - f[1]));
    out[2] = 0.01 * out[0] * (200 * (f[1] - f[2]));
}

// ---- Filters ------------------------------------------------------------------------------------------------------

/// Computes exp(-x^2 / (2 sd^2)), not normalised. Returns the sum.
static double gaussian(int radius, double sd, double out[2 * RADIUS_MAX + 1])
{
    double sum = 0;
    for (int i = -radius; i <= radius; i++)
        sum += out[i + radius] = glint_exp(-(double)i * i / (2 * sd * sd));
    return sum;
}

static kernel blur(int radius, double sd)
{
    kernel k = { .radius = radius };
    double g[2 * RADIUS_MAX + 1], sum = gaussian(radius, sd, g);
    for (int i = 0; i <= 2 * radius; i++)
        k.tap[i] = (float)(g[i] / sum);
    return k;
}

/// Returns the first or second derivative of the feature detectors' Gaussian: positive taps sum to 1, negative to -1.
static kernel derivative(int order)
{
    kernel k = { .radius = FEATURE_RADIUS };
    double g[2 * RADIUS_MAX + 1], positive = 0, negative = 0;
    gaussian(FEATURE_RADIUS, FEATURE_SD, g);
    for (int i = -FEATURE_RADIUS; i <= FEATURE_RADIUS; i++) {
        double *tap = &g[i + FEATURE_RADIUS];
        *tap *= order == 1 ? -i : (double)i * i / (FEATURE_SD * FEATURE_SD) - 1;
        *(*tap > 0 ? &positive : &negative) += *tap;
    }
    for (int i = 0; i <= 2 * FEATURE_RADIUS; i++)
        k.tap[i] = (float)(g[i] > 0 ? g[i] / positive : -g[i] / negative);
    return k;
}

static void add_scaled(float *restrict out, const float *restrict in, float scale, int count)
{
    for (int i = 0; i < count; i++)
        out[i] += scale * in[i];
}

static int clamp(int i, int end) { return i < 0 ? 0 : i < end ? i : end - 1; }

/// Filters the rows of a plane; the border pixels are repeated outside.
static void filter_rows(const glint_flip *size, const float *in, const kernel *k, float *padded, float *out)
{
    const int width = size->width, r = k->radius;
    memset(out, 0, (size_t)width * (size_t)size->height * sizeof *out);
    for (int y = 0; y < size->height; y++) {
        const float *row = in + (size_t)y * (size_t)width;
        for (int x = -r; x < width + r; x++)
            padded[x + r] = row[clamp(x, width)];
        for (int i = 0; i <= 2 * r; i++)
            add_scaled(out + (size_t)y * (size_t)width, padded + i, k->tap[i], width);
    }
}

/// Filters the columns and adds `scale` times the result to `out`.
static void filter_columns(const glint_flip *size, const float *in, const kernel *k, float scale, float *out)
{
    const size_t width = (size_t)size->width;
    for (int y = 0; y < size->height; y++)
        for (int i = -k->radius; i <= k->radius; i++)
            add_scaled(out + (size_t)y * width, in + (size_t)clamp(y + i, size->height) * width,
                       scale * k->tap[i + k->radius], size->width);
}

// ---- A picture ----------------------------------------------------------------------------------------------------

/// Temporary planes for preparing a picture.
typedef struct workshop {
    float *opponent[3]; ///< YCxCz
    float *blurred[3];
    float *rows[3]; ///< filtered along rows only
    float *padded;
    float *memory;
} workshop;

static bool open_workshop(workshop *w, const glint_flip *size)
{
    const size_t pixels = (size_t)size->width * (size_t)size->height;
    w->memory = calloc(9 * pixels + (size_t)size->width + 2 * RADIUS_MAX, sizeof *w->memory);
    if (!w->memory)
        return false;
    for (size_t c = 0; c < 3; c++) {
        w->opponent[c] = w->memory + c * pixels;
        w->blurred[c] = w->memory + (3 + c) * pixels;
        w->rows[c] = w->memory + (6 + c) * pixels;
    }
    w->padded = w->memory + 9 * pixels;
    return true;
}

static void blur_channel(const glint_flip *size, workshop *w, int channel, double b, double weight)
{
    const kernel k = blur(COLOR_RADIUS, sqrt(b / (2 * PI * PI)) * GLINT_FLIP_PPD);
    filter_rows(size, w->opponent[channel], &k, w->padded, w->rows[0]);
    filter_columns(size, w->rows[0], &k, (float)weight, w->blurred[channel]);
}

/// Blurs by contrast sensitivity: each channel's filter is a sum of terms a sqrt(pi / b) exp(-pi^2 x^2 / b), x in
/// degrees, normalised to 1.
static void blur_colors(const glint_flip *size, workshop *w)
{
    static const double blue_yellow[2][2] = { { 34.1, 0.04 }, { 13.5, 0.025 } }; // a, b
    double weight[2], g[2 * RADIUS_MAX + 1], sum = 0;
    blur_channel(size, w, 0, 0.0047, 1);
    blur_channel(size, w, 1, 0.0053, 1);
    for (int i = 0; i < 2; i++) { // two Gaussians, each separable, weighted by their sums over the plane
        const double *ab = blue_yellow[i];
        const double mass = gaussian(COLOR_RADIUS, sqrt(ab[1] / (2 * PI * PI)) * GLINT_FLIP_PPD, g);
        sum += weight[i] = ab[0] * sqrt(PI / ab[1]) * mass * mass;
    }
    for (int i = 0; i < 2; i++)
        blur_channel(size, w, 2, blue_yellow[i][1], weight[i] / sum);
}

static void make_lab(glint_flip *flip, workshop *w, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        double ycxcz[3] = { w->blurred[0][i], w->blurred[1][i], w->blurred[2][i] }, rgb[3], lab[3];
        ycxcz_to_rgb(ycxcz, rgb);
        hunt_lab(rgb, lab);
        for (int c = 0; c < 3; c++)
            flip->lab[c][i] = (float)lab[c];
    }
}

static void store_length(const float *x, const float *y, size_t pixels, float *out)
{
    for (size_t i = 0; i < pixels; i++)
        out[i] = sqrtf(x[i] * x[i] + y[i] * y[i]);
}

/// Computes the derivatives of the lightness along both axes: the first finds edges, the second points.
static void find_features(glint_flip *flip, workshop *w, size_t pixels)
{
    const kernel smooth = blur(FEATURE_RADIUS, FEATURE_SD);
    for (size_t i = 0; i < pixels; i++)
        w->opponent[0][i] = (w->opponent[0][i] + 16) / 116;
    filter_rows(flip, w->opponent[0], &smooth, w->padded, w->rows[0]);
    for (int order = 1; order <= 2; order++) {
        const kernel k = derivative(order);
        memset(w->blurred[0], 0, 2 * pixels * sizeof *w->blurred[0]); // planes 0 and 1
        filter_rows(flip, w->opponent[0], &k, w->padded, w->rows[1]);
        filter_columns(flip, w->rows[1], &smooth, 1, w->blurred[0]);
        filter_columns(flip, w->rows[0], &k, 1, w->blurred[1]);
        store_length(w->blurred[0], w->blurred[1], pixels, order == 1 ? flip->edge : flip->point);
    }
}

glint_status glint_flip_create(int width, int height, const float *const rgb[3], glint_flip **out, glint_error *error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    workshop w = { .memory = NULL };
    glint_flip *flip = calloc(1, sizeof *flip);
    float *planes = flip ? malloc(5 * pixels * sizeof *planes) : NULL;
    if (!planes) {
        free(flip);
        return glint_fail_nomem(error);
    }
    flip->width = width;
    flip->height = height;
    for (size_t c = 0; c < 3; c++)
        flip->lab[c] = planes + c * pixels;
    flip->edge = planes + 3 * pixels;
    flip->point = planes + 4 * pixels;
    if (!open_workshop(&w, flip)) {
        glint_flip_destroy(flip);
        return glint_fail_nomem(error);
    }
    for (size_t i = 0; i < pixels; i++) {
        double color[3] = { rgb[0][i], rgb[1][i], rgb[2][i] }, ycxcz[3];
        rgb_to_ycxcz(color, ycxcz);
        for (int c = 0; c < 3; c++)
            w.opponent[c][i] = (float)ycxcz[c];
    }
    blur_colors(flip, &w);
    make_lab(flip, &w, pixels);
    find_features(flip, &w, pixels);
    free(w.memory);
    *out = flip;
    return GLINT_OK;
}

void glint_flip_destroy(glint_flip *flip)
{
    if (!flip)
        return;
    free(flip->lab[0]);
    free(flip);
}

// ---- Two pictures -------------------------------------------------------------------------------------------------

static double color_distance(const double a[3], const double b[3])
{
    const double da = a[1] - b[1], db = a[2] - b[2], hyab = fabs(a[0] - b[0]) + sqrt(da * da + db * db);
    return hyab > 0 ? glint_pow(hyab, GLINT_FLIP_QC) : 0;
}

/// Returns the largest distance between two displayable colours.
static double largest_distance(void)
{
    static const double green[3] = { 0, 1, 0 }, blue[3] = { 0, 0, 1 };
    double a[3], b[3];
    hunt_lab(green, a);
    hunt_lab(blue, b);
    return color_distance(a, b);
}

/// Maps a distance to 0 .. 1; small differences take most of this range.
static double spread(double distance, double largest)
{
    const double knee = GLINT_FLIP_PC * largest;
    if (distance < knee)
        return GLINT_FLIP_PT / knee * distance;
    const double rest = (distance - knee) / (largest - knee);
    return GLINT_FLIP_PT + (rest < 1 ? rest : 1) * (1 - GLINT_FLIP_PT);
}

static double feature_difference(const glint_flip *a, const glint_flip *b, size_t i)
{
    const double edge = fabs((double)a->edge[i] - b->edge[i]), point = fabs((double)a->point[i] - b->point[i]);
    const double f = (edge > point ? edge : point) / sqrt(2.0);
    return f > 0 ? glint_pow(f < 1 ? f : 1, GLINT_FLIP_QF) : 0;
}

double glint_flip_mean(const glint_flip *a, const glint_flip *b)
{
    const size_t pixels = (size_t)a->width * (size_t)a->height;
    const double largest = largest_distance();
    double sum = 0;
    for (size_t i = 0; i < pixels; i++) {
        const double pa[3] = { a->lab[0][i], a->lab[1][i], a->lab[2][i] };
        const double pb[3] = { b->lab[0][i], b->lab[1][i], b->lab[2][i] };
        const double color = spread(color_distance(pa, pb), largest);
        if (color > 0)
            sum += glint_pow(color, 1 - feature_difference(a, b, i));
    }
    return sum / (double)pixels;
}
