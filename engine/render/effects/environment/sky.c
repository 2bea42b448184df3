#include "engine/render/effects/environment/sky.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/render/effects/environment/directions.h"
#include "engine/render/effects/environment/plan.h"
#include "engine/render/program/program.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TURN 0x1.921fb54442d18p+2 // 2 pi
#define WIDTH_LEAST 1024 ///< cells of a third of a degree, so that the sun of a formula covers a corner
#define WIDTH_MOST 2048
#define WEIGHT_MOST 0x7fffffff ///< the sum over all cells stays below 2^53, exact in double
#define SPREAD (1.0 / 16) ///< a corner counts at least as this share of its brightest neighbour, so that no part of a
    ///< spot between corners is missed
#define FLOOR (1.0 / 4) ///< smallest density in a cell, as a share of its brightest corner's
/// smallest mean square of the brightness, divided by its squared mean, with which the table reduces noise
#define UNEVEN 2.0

struct glint_sky {
    glint_attached attached; ///< first: see glint_attached
    _Atomic uint32_t references;
    double pixel; ///< the angle that the background was filtered over
    bool even; ///< whether the table would not pay; it is not read then
    uint32_t width, height; ///< cells; the height is half the width
    double *level; ///< cosine of the angle to +y of the edges between rows, from 1 to -1
    double (*edge)[2]; ///< sine and cosine of the longitude of the edges between columns: from -z round over -x, +z
    float *corner; ///< brightness of the corners, edge by edge from the top, as it counts
    uint64_t *rows; ///< sum of the weights of the rows before each row, and of all
    uint64_t *cells; ///< for each row, the sum of the weights of its cells up to each cell
};

// ---- Drawing ------------------------------------------------------------------------------------------------------

/// Returns the first index i of 0 .. count - 1 with at < sums[i]; the last index if there is none.
static uint32_t find_sum(const uint64_t *sums, uint32_t count, double at)
{
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (at < (double)sums[middle])
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/// Chooses an interval of running sums, and stretches the rest of u, 0 .. 1, over the interval. from: the sum before
/// the first one.
static uint32_t choose(const uint64_t *sums, uint32_t count, double u, double *rest)
{
    const double at = u * (double)sums[count - 1];
    const uint32_t i = find_sum(sums, count, at);
    const double from = i ? (double)sums[i - 1] : 0;
    *rest = fmin(fmax((at - from) / ((double)sums[i] - from), 0), 1);
    return i;
}

/// Loads the densities, up to a factor, at the corners of a cell: upper left, upper right, lower left, lower right.
/// Returns their mean.
static double load_corners(const glint_sky *sky, uint32_t j, uint32_t i, double corner[4])
{
    const float *upper = sky->corner + (size_t)j * sky->width, *lower = upper + sky->width;
    const uint32_t right = i + 1 < sky->width ? i + 1 : 0;
    corner[0] = (double)upper[i];
    corner[1] = (double)upper[right];
    corner[2] = (double)lower[i];
    corner[3] = (double)lower[right];
    const double least = FLOOR * fmax(fmax(corner[0], corner[1]), fmax(corner[2], corner[3]));
    for (int k = 0; k < 4; k++)
        corner[k] = fmax(corner[k], least);
    return ((corner[0] + corner[1]) + (corner[2] + corner[3])) / 4;
}

/// Maps u, 0 .. 1, so that its density goes from `from` to `to` in a line; both are > 0.
static double bend(double u, double from, double to)
{
    return fmin(u * (from + to) / (from + sqrt(from * from + u * (to * to - from * from))), 1);
}

static double mixed(double t, double a, double b) { return a + t * (b - a); }

void glint_sky_draw(const glint_sky *sky, const double u[2], double direction[3])
{
    double down, along, corner[4];
    const uint32_t j = choose(sky->rows + 1, sky->height, u[1], &down);
    const uint32_t i = choose(sky->cells + (size_t)j * sky->width, sky->width, u[0], &along);
    load_corners(sky, j, i, corner);
    down = bend(down, corner[0] + corner[1], corner[2] + corner[3]);
    along = bend(along, mixed(down, corner[0], corner[2]), mixed(down, corner[1], corner[3]));
    const double y = sky->level[j] + down * (sky->level[j + 1] - sky->level[j]);
    const double radius = sqrt(fmax(1 - y * y, 0)), longitude = ((i + along) / sky->width - 0.5) * TURN;
    direction[0] = radius * glint_sin(longitude);
    direction[1] = y;
    direction[2] = 0 - radius * glint_cos(longitude);
}

// ---- Density ------------------------------------------------------------------------------------------------------

static uint32_t find_row(const glint_sky *sky, double y)
{
    uint32_t low = 0, high = sky->height - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (y > sky->level[middle + 1])
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/// Returns the column of a direction, by the sides of edges on which it lies, within its half of the sphere.
static uint32_t find_column(const glint_sky *sky, double x, double z)
{
    const uint32_t half = sky->width / 2;
    uint32_t low = x < 0 ? 0 : half, high = low + half - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        const double *edge = sky->edge[middle + 1];
        if (x * edge[1] + z * edge[0] < 0)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

double glint_sky_density(const glint_sky *sky, const double direction[3])
{
    const uint32_t j = find_row(sky, direction[1]), i = find_column(sky, direction[0], direction[2]);
    const uint64_t *cells = sky->cells + (size_t)j * sky->width;
    const double x = direction[0], z = direction[2], radius = sqrt(x * x + z * z);
    const double sine = radius > 0 ? (x * sky->edge[i][1] + z * sky->edge[i][0]) / radius : 0; // of a small angle
    const double along = fmin(fmax((sine + sine * sine * sine / 6) * (sky->width / TURN), 0), 1);
    const double down = fmin(fmax((sky->level[j] - direction[1]) / (sky->level[j] - sky->level[j + 1]), 0), 1);
    double corner[4];
    const double mean = load_corners(sky, j, i, corner);
    const double here = mixed(down, mixed(along, corner[0], corner[1]), mixed(along, corner[2], corner[3]));
    const double weight = (double)(cells[i] - (i ? cells[i - 1] : 0));
    const double angle = (sky->level[j] - sky->level[j + 1]) * (TURN / sky->width);
    return mean > 0 ? weight / (double)sky->rows[sky->height] / angle * (here / mean) : 0;
}

// ---- Making -------------------------------------------------------------------------------------------------------

static void destroy(glint_sky *sky)
{
    free(sky->level);
    free(sky->edge);
    free(sky->corner);
    free(sky->rows);
    free(sky->cells);
    free(sky);
}

static void release_attached(glint_attached *attached) { glint_sky_release((const glint_sky *)attached); }

void glint_sky_release(const glint_sky *sky)
{
    glint_sky *own = (glint_sky *)(uintptr_t)sky;
    if (own && atomic_fetch_sub(&own->references, 1) == 1)
        destroy(own);
}

/// Returns the number of columns: two for each texel of the program's largest texture, within limits.
static uint32_t width_of(const glint_program *program)
{
    uint32_t width = WIDTH_LEAST;
    for (uint32_t i = 0; i < program->texture_count; i++) {
        const uint32_t twice = 2 * (uint32_t)glint_texture_width(program->textures[i]);
        width = twice > width ? twice : width;
    }
    return width < WIDTH_MOST ? width : WIDTH_MOST;
}

/// Allocates a sky, with the edges of its cells. NULL: out of memory.
static glint_sky *new_sky(uint32_t width)
{
    glint_sky *sky = calloc(1, sizeof *sky);
    if (!sky)
        return NULL;
    const uint32_t height = width / 2;
    sky->attached.release = release_attached;
    sky->references = 1;
    sky->width = width;
    sky->height = height;
    sky->level = glint_alloc(height + 1, sizeof *sky->level);
    sky->edge = glint_alloc(width + 1, sizeof *sky->edge);
    sky->corner = glint_alloc_large((size_t)width * (height + 1), sizeof *sky->corner);
    sky->rows = glint_alloc(height + 1, sizeof *sky->rows);
    sky->cells = glint_alloc_large((size_t)width * height, sizeof *sky->cells);
    if (!sky->level || !sky->edge || !sky->corner || !sky->rows || !sky->cells) {
        destroy(sky);
        return NULL;
    }
    for (uint32_t j = 0; j <= height; j++)
        sky->level[j] = j == 0 ? 1 : j == height ? -1 : glint_cos(j * (TURN / 2) / height);
    for (uint32_t i = 0; i <= width; i++) {
        sky->edge[i][0] = glint_sin(((double)i / width - 0.5) * TURN);
        sky->edge[i][1] = glint_cos(((double)i / width - 0.5) * TURN);
    }
    return sky;
}

/// Writes the directions of the corners from column `first` of edge j, in groups.
static void corners(const glint_sky *sky, uint32_t j, uint32_t first, uint32_t groups, double (*d)[3][GLINT_GROUP])
{
    const double y = sky->level[j], radius = sqrt(1 - y * y);
    for (uint32_t k = 0; k < groups * GLINT_GROUP; k++) {
        const double *edge = sky->edge[(first + k) % sky->width];
        double(*to)[GLINT_GROUP] = d[k / GLINT_GROUP];
        to[0][k % GLINT_GROUP] = radius * edge[0];
        to[1][k % GLINT_GROUP] = y;
        to[2][k % GLINT_GROUP] = 0 - radius * edge[1];
    }
}

/// Computes the brightness of all corners, edge by edge from the top: the width times (the height + 1). Returns false
/// when out of memory.
static bool find_brightness(const glint_sky *sky, const glint_plan *plan, const glint_stages *stages, double *brightness)
{
    struct glint_environment *environment = glint_environment_create(plan);
    const double pixel = fmax(sky->pixel, width_of(plan->environment->program) == WIDTH_MOST ? TURN / WIDTH_MOST : 0);
    for (uint32_t j = 0; environment && j <= sky->height; j++)
        for (uint32_t i = 0; i < sky->width; i += GLINT_PROGRAM_LANES) {
            double d[GLINT_PROGRAM_GROUPS][3][GLINT_GROUP], found[GLINT_PROGRAM_LANES];
            const uint32_t count = sky->width - i < GLINT_PROGRAM_LANES ? sky->width - i : GLINT_PROGRAM_LANES;
            const uint32_t groups = (count + GLINT_GROUP - 1) / GLINT_GROUP;
            corners(sky, j, i, groups, d);
            glint_environment_evaluate(environment, plan->environment, stages, pixel, d, groups, found);
            memcpy(brightness + (size_t)j * sky->width + i, found, count * sizeof *found);
        }
    glint_environment_destroy(environment);
    return environment;
}

/// Fills the brightness of the corners as it counts.
static void fill_corners(glint_sky *sky, const double *brightness)
{
    for (uint32_t j = 0; j <= sky->height; j++)
        for (uint32_t i = 0; i < sky->width; i++) {
            double most = 0;
            for (uint32_t y = j ? j - 1 : 0; y <= j + 1 && y <= sky->height; y++)
                for (uint32_t x = 0; x < 3; x++)
                    most = fmax(most, brightness[(size_t)y * sky->width + (i + sky->width - 1 + x) % sky->width]);
            sky->corner[(size_t)j * sky->width + i] = (float)fmax(brightness[(size_t)j * sky->width + i], most * SPREAD);
        }
}

/// Returns the weight of a cell: its mean density times its solid angle in units of a column's.
static double weight_of(const glint_sky *sky, uint32_t j, uint32_t i)
{
    double corner[4];
    return load_corners(sky, j, i, corner) * (sky->level[j] - sky->level[j + 1]);
}

/// Returns the largest weight, and whether the weights are so even that drawing by them would not reduce noise.
static double survey(const glint_sky *sky, bool *even)
{
    double most = 0, sum = 0, square = 0;
    for (uint32_t j = 0; j < sky->height; j++)
        for (uint32_t i = 0; i < sky->width; i++) {
            const double weight = weight_of(sky, j, i), angle = sky->level[j] - sky->level[j + 1];
            most = fmax(most, weight);
            sum += weight;
            square += weight * (weight / angle);
        }
    *even = !(square * 2 * sky->width > UNEVEN * (sum * sum));
    return most;
}

/// Fills the sums.
static void fill(glint_sky *sky, const double *brightness)
{
    fill_corners(sky, brightness);
    const double most = survey(sky, &sky->even);
    for (uint32_t j = 0; j < sky->height && !sky->even; j++) {
        uint64_t sum = 0;
        for (uint32_t i = 0; i < sky->width; i++) {
            const double weight = weight_of(sky, j, i) / most;
            sum += weight > 0 ? 1 + (uint64_t)(weight * (WEIGHT_MOST - 1)) : 0;
            sky->cells[(size_t)j * sky->width + i] = sum;
        }
        sky->rows[j + 1] = sky->rows[j] + sum;
    }
}

static glint_status make(const glint_plan *plan, glint_sky **out, glint_error *error)
{
    const glint_stages *stages;
    const glint_status status = glint_choose_isa(NULL, &stages, error);
    if (status)
        return status;
    glint_sky *sky = new_sky(width_of(plan->environment->program));
    double *brightness = sky ? glint_alloc_large((size_t)sky->width * (sky->height + 1), sizeof *brightness) : NULL;
    if (sky)
        sky->pixel = plan->environment->pixel;
    const bool done = brightness && find_brightness(sky, plan, stages, brightness);
    if (done)
        fill(sky, brightness);
    free(brightness);
    if (!done && sky)
        destroy(sky);
    *out = done ? sky : NULL;
    return done ? GLINT_OK : glint_fail_nomem(error);
}

/// Finds the program's sky for an angle of pixels, or makes it and attaches it. The caller owns a reference.
static glint_status sky_of(const glint_plan *plan, glint_sky **out, glint_error *error)
{
    glint_program *program = plan->environment->program;
    for (uint32_t i = 0; i < GLINT_ATTACHED_MAX; i++) {
        *out = (glint_sky *)atomic_load(&program->attached[i]);
        if (!*out)
            break;
        if ((*out)->pixel != plan->environment->pixel)
            continue;
        atomic_fetch_add(&(*out)->references, 1);
        return GLINT_OK;
    }
    const glint_status status = make(plan, out, error);
    for (uint32_t i = 0; i < GLINT_ATTACHED_MAX && !status; i++) {
        glint_attached *none = NULL;
        atomic_fetch_add(&(*out)->references, 1);
        if (atomic_compare_exchange_strong(&program->attached[i], &none, &(*out)->attached))
            break;
        atomic_fetch_sub(&(*out)->references, 1);
    }
    return status;
}

glint_status glint_sky_find(glint_plan *plan, glint_error *error)
{
    glint_sky *sky;
    if (plan->sky || !plan->environment)
        return GLINT_OK;
    const glint_status status = sky_of(plan, &sky, error);
    if (!status && !sky->even)
        plan->sky = sky;
    else if (!status)
        glint_sky_release(sky);
    return status;
}
