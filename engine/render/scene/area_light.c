#include "engine/render/scene/area_light.h"
#include "engine/base/sequence.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"

#include <float.h>
#include <stdio.h>

#define PI 0x1.921fb54442d18p+1
#define GOLDEN 0x1.3c6ef372fe95p-1 // (sqrt(5) - 1) / 2
#define PLANAR 1e-6 // tolerance for corners outside the plane or inside an edge, as a fraction of the polygon's size
// most light samples over all sets; if a light needs more, the samples of a pixel share sets
#define SET_SAMPLES_MAX 4096

typedef const double (*corners)[3];

// ---- Polygons ----

/// Computes the polygon's normal, whose length is twice the polygon's area: the sum of the cross products of its
/// triangle fan.
static void area_vector(const glint_light_desc *desc, double out[3])
{
    out[0] = out[1] = out[2] = 0;
    for (size_t i = 1; i + 1 < desc->vertex_count; i++) {
        double a[3], b[3], c[3];
        vec_sub(a, desc->vertices[i], desc->vertices[0]);
        vec_sub(b, desc->vertices[i + 1], desc->vertices[0]);
        vec_cross(c, a, b);
        for (int k = 0; k < 3; k++)
            out[k] += c[k];
    }
}

void glint_light_sample_polygon_normal(const glint_light_desc *desc, double normal[3])
{
    area_vector(desc, normal);
    vec_normalize(normal, normal);
}

/// Returns the largest distance of a corner from the first corner along any axis.
static double polygon_size(const glint_light_desc *desc)
{
    double size = 0;
    for (size_t i = 1; i < desc->vertex_count; i++) {
        double a[3];
        vec_sub(a, desc->vertices[i], desc->vertices[0]);
        size = fmax(size, vec_max_abs(a));
    }
    return size;
}

/// Checks that every corner lies in the plane and on the inner side of the edge from corner i.
static glint_status check_edge(const glint_light_desc *desc, size_t i, const double normal[3], double size,
                               glint_error *error)
{
    const double *from = desc->vertices[i], *to = desc->vertices[(i + 1) % desc->vertex_count];
    double edge[3], inwards[3];
    vec_sub(edge, to, from);
    if (edge[0] == 0 && edge[1] == 0 && edge[2] == 0)
        return glint_fail(error, GLINT_ERR_INVALID, "vertices: corners that differ expected, got corner %zu twice",
                          i + 1);
    vec_cross(inwards, normal, edge);
    vec_normalize(inwards, inwards);
    for (size_t k = 0; k < desc->vertex_count; k++) {
        double away[3];
        vec_sub(away, desc->vertices[k], from);
        if (fabs(vec_dot(away, normal)) > PLANAR * size)
            return glint_fail(error, GLINT_ERR_INVALID,
                              "vertices: corners in one plane expected, got corner %zu %.3g out of it", k + 1,
                              vec_dot(away, normal));
        if (vec_dot(away, inwards) < -PLANAR * size)
            return glint_fail(error, GLINT_ERR_INVALID,
                              "vertices: convex polygon expected, got corner %zu outside of the edge from corner %zu",
                              k + 1, i + 1);
        if (k != i && vec_max_abs(away) == 0)
            return glint_fail(error, GLINT_ERR_INVALID,
                              "vertices: corners that differ expected, got corner %zu again as corner %zu", i + 1,
                              k + 1);
    }
    return GLINT_OK;
}

glint_status glint_light_sample_check_polygon(const glint_light_desc *desc, glint_error *error)
{
    if (desc->vertex_count < 3 || desc->vertex_count > GLINT_CORNERS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "vertices: 3 to %d corners expected, got %zu", GLINT_CORNERS_MAX,
                          desc->vertex_count);
    for (size_t i = 0; i < desc->vertex_count; i++) {
        char name[48];
        snprintf(name, sizeof name, "vertices: corner %zu", i + 1);
        glint_status status = glint_check_vector(name, desc->vertices[i], error);
        if (status)
            return status;
    }
    double normal[3];
    const double size = polygon_size(desc);
    area_vector(desc, normal);
    const double area = sqrt(vec_dot(normal, normal)) / 2;
    if (!(area > 1e-12 * size * size))
        return glint_fail(error, GLINT_ERR_INVALID, "vertices: polygon with an area expected, got area %.3g", area);
    if (!isfinite(area))
        return glint_fail(error, GLINT_ERR_INVALID, "vertices: polygon with a finite area expected");
    vec_normalize(normal, normal);
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < desc->vertex_count && !status; i++)
        status = check_edge(desc, i, normal, size, error);
    return status;
}

// ---- Areas ----

double glint_light_sample_area(const glint_light_desc *desc)
{
    double normal[3];
    switch (desc->kind) {
    case GLINT_LIGHT_DISK:
        return PI * (desc->radius * desc->radius);
    case GLINT_LIGHT_SPHERE:
        return 4 * PI * (desc->radius * desc->radius);
    case GLINT_LIGHT_POLYGON:
        area_vector(desc, normal);
        return sqrt(vec_dot(normal, normal)) / 2;
    default:
        return 0;
    }
}

double glint_light_sample_size(const glint_light_desc *desc)
{
    return desc->kind == GLINT_LIGHT_POLYGON ? polygon_size(desc) : desc->radius;
}

// ---- From the unit square to the surface ----

/// Constants of a light for the mappings, besides its description.
typedef struct surface {
    const glint_light_desc *desc;
    double normal[3], right[3], up[3]; ///< disk, polygon: unit
    double area2; ///< polygon: twice its area
    bool parallelogram;
} surface;

/// Computes two unit vectors perpendicular to the normal and to each other. If the normal is an axis, some of their
/// components are exactly 0.
static void find_frame(surface *s)
{
    double axis[3] = { 0, 0, 0 };
    int least = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(s->normal[k]) < fabs(s->normal[least]))
            least = k;
    axis[least] = 1;
    vec_cross(s->right, axis, s->normal);
    vec_normalize(s->right, s->right);
    vec_cross(s->up, s->normal, s->right);
}

static void surface_init(surface *s, const glint_light_desc *desc)
{
    *s = (surface) { .desc = desc };
    if (desc->kind == GLINT_LIGHT_DISK) {
        vec_normalize(s->normal, desc->normal);
        find_frame(s);
    } else if (desc->kind == GLINT_LIGHT_POLYGON) {
        corners v = desc->vertices;
        area_vector(desc, s->normal);
        s->area2 = sqrt(vec_dot(s->normal, s->normal));
        vec_normalize(s->normal, s->normal);
        s->parallelogram = desc->vertex_count == 4;
        for (int k = 0; k < 3 && s->parallelogram; k++)
            s->parallelogram = v[1][k] - v[0][k] == v[2][k] - v[3][k];
    }
}

/// Maps the square to a sphere with equal areas, by Archimedes' theorem.
static void sphere_point(const surface *s, double u, double v, double position[3], double normal[3])
{
    const double ring = 2 * sqrt(u * (1 - u)), angle = 2 * PI * v;
    normal[0] = ring * glint_cos(angle);
    normal[1] = 1 - 2 * u;
    normal[2] = ring * glint_sin(angle);
    for (int k = 0; k < 3; k++)
        position[k] = s->desc->position[k] + s->desc->radius * normal[k];
}

static void disk_point(const surface *s, double u, double v, double position[3])
{
    const double r = s->desc->radius * sqrt(u), angle = 2 * PI * v;
    const double x = r * glint_cos(angle), y = r * glint_sin(angle);
    for (int k = 0; k < 3; k++)
        position[k] = s->desc->position[k] + (x * s->right[k] + y * s->up[k]);
}

static void on_triangle(const double a[3], const double b[3], const double c[3], double x, double y, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[k] + (x * (b[k] - a[k]) + y * (c[k] - a[k]));
}

/// Maps the square to the triangles of the polygon's fan; each triangle gets a part of u in proportion to its area.
static void polygon_point(const surface *s, double u, double v, double position[3])
{
    corners corner = s->desc->vertices;
    if (s->parallelogram) {
        on_triangle(corner[0], corner[1], corner[3], u, v, position);
        return;
    }
    double rest = u * s->area2;
    for (size_t i = 1;; i++) {
        double a[3], b[3], c[3];
        vec_sub(a, corner[i], corner[0]);
        vec_sub(b, corner[i + 1], corner[0]);
        vec_cross(c, a, b);
        const double area2 = fmax(vec_dot(c, s->normal), 0);
        if (rest < area2 || i + 2 == s->desc->vertex_count) {
            const double r = sqrt(area2 > 0 ? fmin(rest / area2, 1) : 0);
            on_triangle(corner[0], corner[i], corner[i + 1], r * (1 - v), r * v, position);
            return;
        }
        rest -= area2;
    }
}

static void surface_point(const surface *s, const double square[2], double position[3], double normal[3])
{
    if (s->desc->kind == GLINT_LIGHT_SPHERE) {
        sphere_point(s, square[0], square[1], position, normal);
        return;
    }
    vec_copy(normal, s->normal);
    if (s->desc->kind == GLINT_LIGHT_DISK)
        disk_point(s, square[0], square[1], position);
    else
        polygon_point(s, square[0], square[1], position);
}

// ---- The samples ----

uint32_t glint_light_sample_sets(const glint_light_desc *desc, double pixel_samples)
{
    uint32_t sets = 1;
    while (sets < pixel_samples && 2 * sets * desc->samples <= SET_SAMPLES_MAX)
        sets *= 2;
    return sets;
}

/// Returns a pixel's position in the sequence: the pixels of each 2 x 2 block are consecutive, so that they have an
/// even set of points, too.
static uint32_t lane_order(uint32_t lane)
{
    const uint32_t x = lane & 3, y = lane >> 2;
    return (x & 1) | (y & 1) << 1 | (x >> 1) << 2 | (y >> 1) << 3;
}

static uint32_t emission_of(const glint_light_desc *desc)
{
    const bool flat = desc->kind != GLINT_LIGHT_SPHERE, one_sided = flat && !desc->two_sided;
    if (!desc->has_radiance)
        return one_sided ? GLINT_EMIT_FRONT : GLINT_EMIT_ALL;
    if (one_sided)
        return GLINT_EMIT_RADIANT_FRONT;
    return flat ? GLINT_EMIT_RADIANT_BOTH : GLINT_EMIT_CONE;
}

/// Computes the box and ball around all samples. Samples in a cone depend on the shaded point; box and ball then
/// enclose the light.
static void enclose(const glint_light_desc *desc, glint_light_sample *light_samples, size_t count)
{
    double lower[3] = { DBL_MAX, DBL_MAX, DBL_MAX }, upper[3] = { -DBL_MAX, -DBL_MAX, -DBL_MAX };
    double center[3], radius = 0;
    const bool cone = emission_of(desc) == GLINT_EMIT_CONE;
    for (int k = 0; k < 3 && cone; k++) {
        lower[k] = desc->position[k] - desc->radius;
        upper[k] = desc->position[k] + desc->radius;
    }
    for (size_t i = 0; i < count && !cone; i++)
        for (int k = 0; k < 3; k++)
            for (int lane = 0; lane < GLINT_GROUP; lane++) {
                lower[k] = fmin(lower[k], light_samples[i].position[k][lane]);
                upper[k] = fmax(upper[k], light_samples[i].position[k][lane]);
            }
    for (int k = 0; k < 3; k++)
        center[k] = desc->kind == GLINT_LIGHT_POLYGON ? 0.5 * lower[k] + 0.5 * upper[k] : desc->position[k];
    radius = desc->radius;
    if (desc->kind == GLINT_LIGHT_POLYGON)
        radius =
            0.5 * sqrt((upper[0] - lower[0]) * (upper[0] - lower[0]) + (upper[1] - lower[1]) * (upper[1] - lower[1]) +
                       (upper[2] - lower[2]) * (upper[2] - lower[2]));
    for (size_t i = 0; i < count; i++) {
        vec_copy(light_samples[i].lower, lower);
        vec_copy(light_samples[i].upper, upper);
        vec_copy(light_samples[i].center, center);
        light_samples[i].radius = radius;
        light_samples[i].emission = emission_of(desc);
    }
}

void glint_light_sample_whole(const glint_light_desc *desc, glint_light_sample *out)
{
    *out = (glint_light_sample) { .radius = desc->radius };
    vec_copy(out->center, desc->position);
    for (int k = 0; k < 3; k++) {
        out->lower[k] = desc->position[k] - desc->radius;
        out->upper[k] = desc->position[k] + desc->radius;
    }
}

/// Computes sample i of N in the unit square. In a cone, samples form pairs on opposite sides of the axis, mirrored
/// within their stratum. Quantities that vary linearly across the cone, as cosines do, are then summed without error.
static void square_point(uint32_t i, uint32_t samples, bool cone, const double shift[2], double square[2])
{
    const bool paired = cone && samples % 2 == 0;
    const uint32_t k = paired ? i / 2 : i, strata = paired ? samples / 2 : samples;
    const bool other = paired && i % 2;
    square[0] = (k + (other ? 1 - shift[0] : shift[0])) / strata;
    square[1] = k * GOLDEN + shift[1] + (other ? 0.5 : 0);
    square[1] -= floor(square[1]);
}

/// Computes the part of a sample in a cone that does not depend on the shaded point.
static void cone_point(const double square[2], double position[3])
{
    position[0] = square[0];
    position[1] = glint_cos(2 * PI * square[1]);
    position[2] = glint_sin(2 * PI * square[1]);
}

void glint_light_sample_fill(const glint_light_desc *desc, uint32_t sets, double seed, glint_light_sample *out)
{
    const uint32_t samples = (uint32_t)desc->samples;
    const int bits = glint_sequence_bits(GLINT_GROUP * sets);
    const bool cone = emission_of(desc) == GLINT_EMIT_CONE;
    surface s;
    surface_init(&s, desc);
    for (uint32_t lane = 0; lane < GLINT_GROUP; lane++)
        for (uint32_t set = 0; set < sets; set++) {
            double shift[2];
            glint_sequence_point(lane_order(lane) * sets + set, bits, seed, shift);
            for (uint32_t i = 0; i < samples; i++) {
                double position[3], normal[3] = { 0 }, square[2];
                square_point(i, samples, cone, shift, square);
                if (cone)
                    cone_point(square, position);
                else
                    surface_point(&s, square, position, normal);
                glint_light_sample *light_sample = &out[(size_t)i * sets + set];
                for (int k = 0; k < 3; k++) {
                    light_sample->position[k][lane] = position[k];
                    light_sample->normal[k][lane] = normal[k];
                }
            }
        }
    enclose(desc, out, (size_t)samples * sets);
}
