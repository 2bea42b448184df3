/// Bonds: finds pairs of close atoms, and makes cylinders of them.
///
/// The atoms are sorted into cells as wide as the longest bond, so each is compared only with the atoms of 27 cells. In a
/// periodic box, images of the atoms near its faces are added to the list.
#include "engine/base/status.h"
#include "engine/glint.h"
#include "engine/glint_data.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define ATOMS_MAX ((size_t)1 << 30)
#define CYLINDER ((size_t)7) // numbers of a cylinder: base, top, radius
#define BONDS_MAX ((size_t)1 << 28)
#define IMAGES 8 ///< limit of the longest bond, in sides of the periodic box
#define STEPS_MAX 64 ///< limit of images along one side, for very tilted boxes
#define CELLS_MAX 0x1p50 ///< limit of cells along one axis
#define NONE UINT32_MAX

/// Called for a bond of atoms a and b, with the vector from b to a, or from b to the nearest image of a.
typedef void bond_found(void *context, size_t a, size_t b, const double step[3]);

/// An atom, or a periodic image of one.
typedef struct site {
    double at[3]; ///< in a periodic box: inside it, or near it for an image
    double cell[3]; ///< whole numbers
    uint32_t atom, next; ///< `next`: the site added before it in the same row of the hash table, or NONE
} site;

typedef struct search {
    const glint_bonds_desc *desc;
    double low[3], width; ///< corner of cell 0; side of a cell, the longest bond
    site *sites;
    size_t count, space;
    uint32_t *rows; ///< the last site of each row of the hash table
    size_t mask;
    glint_error *error;
} search;

static size_t row_of(const search *s, const double cell[3])
{
    uint64_t hash = 0;
    for (int c = 0; c < 3; c++) // |cell[c]| < CELLS_MAX + 2
        hash = (hash ^ (uint64_t)(int64_t)cell[c]) * 0x9e3779b97f4a7c15u;
    return (size_t)(hash >> 32) & s->mask;
}

/// Compares site i with all earlier sites of a cell. Returns the number of bonds.
static size_t compare(const search *s, uint32_t i, const double cell[3], bond_found *found, void *context)
{
    const glint_bonds_desc *desc = s->desc;
    const site *a = &s->sites[i];
    const double reach = desc->reach[a->atom], closest2 = desc->closest * desc->closest;
    size_t count = 0;
    for (uint32_t j = s->rows[row_of(s, cell)]; j != NONE; j = s->sites[j].next) {
        const site *b = &s->sites[j];
        const double d[3] = { b->at[0] - a->at[0], b->at[1] - a->at[1], b->at[2] - a->at[2] };
        const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], most = reach + desc->reach[b->atom];
        if (!(square <= most * most && square > closest2) || j >= desc->count || b->cell[0] != cell[0] ||
            b->cell[1] != cell[1] || b->cell[2] != cell[2])
            continue;
        count++;
        if (found) {
            const double step[3] = { a->at[0] - b->at[0], a->at[1] - b->at[1], a->at[2] - b->at[2] };
            found(context, a->atom, b->atom, step);
        }
    }
    return count;
}

static size_t compare_all(search *s, bond_found *found, void *context)
{
    size_t count = 0;
    memset(s->rows, 0xff, (s->mask + 1) * sizeof *s->rows);
    for (size_t i = 0; i < s->count && count <= BONDS_MAX; i++) {
        site *own = &s->sites[i];
        double cell[3];
        for (int c = 0; c < 3; c++)
            own->cell[c] = floor((own->at[c] - s->low[c]) / s->width);
        for (int k = 0; k < 27; k++) {
            cell[0] = own->cell[0] + k / 9 - 1;
            cell[1] = own->cell[1] + k / 3 % 3 - 1;
            cell[2] = own->cell[2] + k % 3 - 1;
            count += compare(s, (uint32_t)i, cell, found, context);
        }
        uint32_t *row = &s->rows[row_of(s, own->cell)];
        own->next = *row;
        *row = (uint32_t)i;
    }
    return count;
}

// ---- The periodic box ----

/// A flat side has the length 1 for fractional coordinates, which are then lengths.
static double side_of(const glint_bonds_desc *b, int c) { return b->size[c] == 0 ? 1 : b->size[c]; }

static void scale(const glint_bonds_desc *b, const double p[3], double u[3])
{
    u[2] = (p[2] - b->low[2]) / side_of(b, 2);
    u[1] = (p[1] - b->low[1] - u[2] * b->yz) / side_of(b, 1);
    u[0] = (p[0] - b->low[0] - u[1] * b->xy - u[2] * b->xz) / side_of(b, 0);
}

static void wrap(const glint_bonds_desc *b, double p[3])
{
    double u[3];
    scale(b, p, u);
    for (int c = 0; c < 3; c++)
        u[c] -= b->periodic[c] ? floor(u[c]) : 0;
    p[0] = b->low[0] + u[0] * side_of(b, 0) + u[1] * b->xy + u[2] * b->xz;
    p[1] = b->low[1] + u[1] * side_of(b, 1) + u[2] * b->yz;
    p[2] = b->low[2] + u[2] * side_of(b, 2);
}

static bool add_image(search *s, uint32_t atom, const int step[3])
{
    const glint_bonds_desc *b = s->desc;
    if (s->count == s->space) {
        const size_t space = 2 * s->space;
        site *sites = space < NONE ? realloc(s->sites, space * sizeof *sites) : NULL;
        if (!sites)
            return false;
        s->sites = sites;
        s->space = space;
    }
    const double *at = s->sites[atom].at;
    s->sites[s->count++] = (site) { .at = { at[0] + step[0] * b->size[0] + step[1] * b->xy + step[2] * b->xz,
                                            at[1] + step[1] * b->size[1] + step[2] * b->yz,
                                            at[2] + step[2] * b->size[2] },
                                    .atom = atom };
    return true;
}

/// Adds the images that lie within a bond's length of the box. Uses only one of two opposite steps.
static glint_status add_images(search *s)
{
    const glint_bonds_desc *b = s->desc;
    const double x = side_of(b, 0), y = side_of(b, 1), z = side_of(b, 2);
    const double a = b->yz / z, c = (b->xy * b->yz / y - b->xz) / z; // the planes' normals: (1, -xy/y, c), (0, 1, -a)
    double margin[3] = { s->width / x * sqrt(1 + (b->xy / y) * (b->xy / y) + c * c), s->width / y * sqrt(1 + a * a),
                         s->width / z };
    int most[3], step[3];
    for (int i = 0; i < 3; i++) {
        if (b->periodic[i] && !(margin[i] <= STEPS_MAX))
            return glint_fail(s->error, GLINT_ERR_INVALID, "a periodic box with less tilt expected");
        most[i] = b->periodic[i] ? (int)ceil(margin[i]) : 0;
        margin[i] = b->periodic[i] ? margin[i] : HUGE_VAL; // atoms may be outside
    }
    for (uint32_t i = 0; i < b->count; i++) {
        double u[3];
        scale(b, s->sites[i].at, u);
        for (step[0] = 0; step[0] <= most[0]; step[0]++) {
            if (u[0] + step[0] > 1 + margin[0])
                break;
            for (step[1] = step[0] == 0 ? 0 : -most[1]; step[1] <= most[1]; step[1]++) {
                const double v = u[1] + step[1];
                if (v < -margin[1] || v > 1 + margin[1])
                    continue;
                for (step[2] = step[0] == 0 && step[1] == 0 ? 1 : -most[2]; step[2] <= most[2]; step[2]++) {
                    const double w = u[2] + step[2];
                    if (w >= -margin[2] && w <= 1 + margin[2] && !add_image(s, i, step))
                        return glint_fail_nomem(s->error);
                }
            }
        }
    }
    return GLINT_OK;
}

static bool is_periodic(const glint_bonds_desc *desc)
{
    return desc->periodic[0] || desc->periodic[1] || desc->periodic[2];
}

/// Lists the sites and computes the first cell.
static glint_status prepare(search *s)
{
    const glint_bonds_desc *desc = s->desc;
    glint_status status = GLINT_OK;
    double high[3] = { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };
    s->space = desc->count + 1;
    s->sites = malloc(s->space * sizeof *s->sites);
    if (!s->sites)
        return glint_fail_nomem(s->error);
    for (size_t i = 0; i < desc->count; i++) {
        site *own = &s->sites[s->count++];
        own->atom = (uint32_t)i;
        memcpy(own->at, desc->points + desc->stride * i, sizeof own->at);
        if (is_periodic(desc))
            wrap(desc, own->at);
    }
    if (is_periodic(desc))
        status = add_images(s);
    for (int c = 0; c < 3; c++) {
        s->low[c] = HUGE_VAL;
        for (size_t i = 0; i < s->count; i++) {
            s->low[c] = fmin(s->low[c], s->sites[i].at[c]);
            high[c] = fmax(high[c], s->sites[i].at[c]);
        }
        if (!status && !((high[c] - s->low[c]) / s->width < CELLS_MAX))
            status = glint_fail(s->error, GLINT_ERR_INVALID, "atoms less than 2^50 bond lengths apart expected");
    }
    for (s->mask = 15; s->mask < s->count; s->mask = 2 * s->mask + 1) {
    }
    s->rows = malloc((s->mask + 1) * sizeof *s->rows);
    return status ? status : s->rows ? GLINT_OK : glint_fail_nomem(s->error);
}

/// Calls `found` (NULL: nothing) for each bond and writes their number. The order depends only on the positions. The
/// arrays of `desc` have been checked. GLINT_ERR_INVALID: a periodic side is too short, or there are too many bonds.
static glint_status find_bonds(const glint_bonds_desc *desc, size_t *count, bond_found *found, void *context, glint_error *error)
{
    search s = { .desc = desc, .error = error };
    *count = 0;
    for (size_t i = 0; i < desc->count; i++)
        s.width = fmax(s.width, 2 * desc->reach[i]); // fmax ignores NaN
    if (!(s.width > 0))
        return GLINT_OK;
    for (int c = 0; c < 3; c++)
        if (desc->periodic[c] && s.width > IMAGES * desc->size[c])
            return glint_fail(error, GLINT_ERR_INVALID,
                              "a periodic box of at least 1/%d of the longest bond expected, got %.6g for a bond of %.6g",
                              IMAGES, desc->size[c], s.width);
    glint_status status = prepare(&s);
    if (!status)
        *count = compare_all(&s, found, context);
    if (*count > BONDS_MAX)
        status = glint_fail(error, GLINT_ERR_INVALID, "at most %zu bonds expected; set a shorter distance", BONDS_MAX);
    free(s.sites);
    free(s.rows);
    return status;
}

// ---- Cylinders ----

typedef struct joining {
    const glint_bonds_desc *desc;
    double *items; ///< the cylinders
    uint32_t *index; ///< the material of each; NULL: all have the first
    size_t count; ///< cylinders so far
} joining;

/// Adds the half of a bond at atom i, which ends at the atom's position plus `sign` times half of `step`.
static void add_half(joining *j, size_t i, const double step[3], double sign)
{
    const double *at = j->desc->points + j->desc->stride * i;
    double *item = j->items + CYLINDER * j->count;
    for (int c = 0; c < 3; c++) {
        item[c] = at[c];
        item[3 + c] = at[c] + sign * (step[c] / 2);
    }
    item[6] = j->desc->radius;
    if (j->index)
        j->index[j->count] = j->desc->material_index[i];
    j->count++;
}

static void join(void *context, size_t a, size_t b, const double step[3])
{
    joining *j = context;
    add_half(j, a, step, -1);
    add_half(j, b, step, 1);
}

static glint_status check_bonds(const glint_bonds_desc *desc, glint_error *error)
{
    if (desc->stride < 3 || desc->count > ATOMS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "points: at most %zu atoms of 3 numbers or more expected", ATOMS_MAX);
    if (desc->count > 0 && (!desc->points || !desc->reach))
        return glint_fail(error, GLINT_ERR_INVALID, "points, reach: pointers expected, got NULL");
    if (!(desc->radius > 0 && isfinite(desc->radius)))
        return glint_fail(error, GLINT_ERR_INVALID, "radius: number > 0 expected, got %.15g", desc->radius);
    for (size_t i = 0; i < desc->count; i++) {
        const double *at = desc->points + desc->stride * i;
        if (!(isfinite(at[0]) && isfinite(at[1]) && isfinite(at[2])))
            return glint_fail(error, GLINT_ERR_INVALID, "points: atom %zu: finite position expected", i + 1);
        if (desc->reach[i] < 0 || isinf(desc->reach[i]))
            return glint_fail(error, GLINT_ERR_INVALID, "reach: atom %zu: finite number >= 0 expected, got %.15g", i + 1,
                              desc->reach[i]);
        if (desc->material_index && desc->material_index[i] >= (desc->material_count ? desc->material_count : 1))
            return glint_fail(error, GLINT_ERR_INVALID, "index: atom %zu: material 1 .. %zu expected, got %llu", i + 1,
                              desc->material_count, (unsigned long long)desc->material_index[i] + 1);
    }
    return GLINT_OK;
}

static glint_status make_cylinders(const joining *j, glint_shape **out, glint_error *error)
{
    const glint_bonds_desc *desc = j->desc;
    const glint_spheres_desc cylinders = { .struct_size = sizeof(glint_spheres_desc), .data = j->items, .count = j->count, .materials = desc->materials,
                                           .material_count = desc->material_count, .material_index = j->index, .two_sided = true };
    glint_shape *shape = NULL;
    glint_status status = glint_cylinders_create(&cylinders, &shape, error);
    if (status)
        return status;
    glint_shape_desc open = *glint_shape_get(shape);
    open.struct_size = sizeof open;
    open.capped = false;
    status = glint_shape_set(shape, &open, error);
    if (status)
        glint_shape_release(shape);
    else
        *out = shape;
    return status;
}

glint_status glint_bonds_create(const glint_bonds_desc *desc, glint_shape **out, glint_error *error)
{
    GLINT_REFUSE_NULL(desc, error);
    GLINT_REFUSE_NULL(out, error);
    joining j = { .desc = desc };
    size_t count = 0;
    *out = NULL;
    glint_status status = check_bonds(desc, error);
    if (!status)
        status = find_bonds(desc, &count, NULL, NULL, error);
    if (status || count == 0)
        return status;
    j.items = malloc(2 * count * CYLINDER * sizeof *j.items);
    j.index = desc->material_index ? malloc(2 * count * sizeof *j.index) : NULL;
    status = j.items && (j.index || !desc->material_index) ? find_bonds(desc, &count, join, &j, error) : glint_fail_nomem(error);
    if (!status)
        status = make_cylinders(&j, out, error);
    free(j.items);
    free(j.index);
    return status;
}
