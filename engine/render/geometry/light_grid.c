/// Makes the grids of lights: the position of each small sphere in the light's view, and the cells of the view that
/// it covers.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/geometry/geometry.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SMALLEST_COUNT 64 ///< smallest number of spheres: fewer are faster to test one by one
/// Largest radius of a sphere relative to its distance; also the smallest cosine to the light's axis
#define WIDEST 0.25
#define CELLS_A_RADIUS 3.0 ///< smallest side of a cell, in mean radii of the spheres
#define COVERED_MAX 4.0 ///< largest radius of a sphere in a cell, in cell sides; larger spheres are tested one by one
#define ENTRIES_MAX 4 ///< largest mean number of entries per sphere
/// smallest limit on the mean number of entries per sphere: with a lower limit, cells are so wide that they hold too
/// many spheres
#define ENTRIES_LEAST 2
/// Bytes of an entry and a cell; there are at most as many cells as entries
#define ENTRY_BYTES (4 * sizeof(uint32_t))
#define COUNT_MAX 32767 ///< largest number of columns or rows
#define SORTED_FROM 24 ///< mean number of entries per cell from which sorting the entries by depth pays
#define SLICES 1024 ///< number of slices of depth for sorting
#define CENTER_SLACK 0x1p-21 ///< error bound of a position from float rounding, relative to 1 plus the position
/// Steps by which rounding may shift an entry's position and a point's, along both axes together
#define STEP_SLACK 1.5
#define CELL_SLACK 0x1p-21 ///< additional error bound of a position, as a fraction of the grid's width
/// Largest distance of a sphere, in the BVH's units; differences of two are then finite, too
#define FARTHEST 0x1p100
#define NEAR_MOST ((1u << (32 - GLINT_GRID_RADIUS_BITS)) - 1) ///< largest value of an entry's `near`

/// A small sphere as the light sees it.
typedef struct projected_sphere {
    float center[2], reach; ///< position of its centre, and the distance within which a segment must pass to hit the
        ///< sphere
    float radius; ///< radius of its circle in the light's view: see glint_light_grid
    float near; ///< depth w of its nearest point
    uint32_t id;
} projected_sphere;

typedef struct grid_maker {
    const glint_geometry_table *table;
    glint_light_grid *grid;
    projected_sphere *projected; ///< scratch: one for each primitive of the table
    uint32_t count; ///< number of `projected`
    float least[2], most[2]; ///< bounds of the positions that the spheres cover
    float near, far; ///< smallest and largest `near` of the spheres
    size_t max_bytes; ///< most bytes that entries and cells may take
} grid_maker;

// ---- The light's view ----

/// Computes the vector from the light to the centre of a bounding sphere in the world, and returns its length.
static double offset_to(const grid_maker *maker, const glint_prim *prim, double offset[3])
{
    vec_sub(offset, prim->center, maker->grid->origin);
    return sqrt(vec_dot(offset, offset));
}

/// Returns whether a primitive is a sphere that looks small from the light.
static bool is_small(const grid_maker *maker, const glint_prim *prim, double offset[3])
{
    if (prim->kind != GLINT_PRIM_SPHERE)
        return false;
    const double distance = offset_to(maker, prim, offset), radius = (double)prim->filter_bound / maker->table->scale;
    return maker->grid->directional || radius < WIDEST * distance;
}

/// Sets the axes along the mean direction to small primitives. Returns false if there are too few of them, or if they
/// surround the light.
static bool aim(grid_maker *maker)
{
    glint_light_grid *grid = maker->grid;
    const double scale = maker->table->scale;
    double away[3] = { 0, 0, 0 }, offset[3];
    uint32_t small = 0;
    for (uint32_t i = 0; i < maker->table->prim_count; i++) {
        if (!is_small(maker, &maker->table->prims[i], offset))
            continue;
        const double length = sqrt(vec_dot(offset, offset));
        small++;
        for (int c = 0; c < 3; c++)
            away[c] += offset[c] / length;
    }
    for (int c = 0; grid->directional && c < 3; c++)
        away[c] = -grid->position[c];
    const double length = sqrt(vec_dot(away, away));
    if (small < SMALLEST_COUNT || !(length > (grid->directional ? 0.5 : 0.5 * small)))
        return false;
    const int least = fabs(away[0]) < fabs(away[1]) ? (fabs(away[0]) < fabs(away[2]) ? 0 : 2)
                                                    : (fabs(away[1]) < fabs(away[2]) ? 1 : 2);
    double axis[3][3] = { { 0 } }, side[3] = { 0, 0, 0 };
    side[least] = 1;
    for (int c = 0; c < 3; c++)
        axis[2][c] = away[c] / length;
    vec_cross(axis[0], side, axis[2]);
    vec_normalize(axis[0], axis[0]);
    vec_cross(axis[1], axis[2], axis[0]);
    for (int j = 0; j < 3; j++)
        for (int c = 0; c < 3; c++)
            grid->axis[j][c] = axis[j][c] * scale; // a power of two
    return true;
}

/// Computes the position of a sphere in the light's view. False: the sphere is too far to the side.
///
/// The squared distance of a segment at (u, v) from the centre is at least w0^2 (du^2 + dv^2) / (1 + u^2 + v^2). A
/// segment that hits the sphere therefore has du^2 + dv^2 <= (r / w0)^2 (1 + u^2 + v^2). The root of the right side
/// is at most the root at the centre plus the distance from there, which bounds that distance.
static bool project_sphere(const grid_maker *maker, const glint_prim *prim, uint32_t id, const double offset[3],
                           projected_sphere *out)
{
    const glint_light_grid *grid = maker->grid;
    const double radius = (double)prim->filter_bound, w = vec_dot(grid->axis[2], offset);
    const double per_w = grid->directional ? 1 : 1 / w;
    const double distance = sqrt(vec_dot(offset, offset)) * maker->table->scale;
    if (!grid->directional && !(w > WIDEST * distance && w > 2 * radius))
        return false;
    const double u = vec_dot(grid->axis[0], offset) * per_w, v = vec_dot(grid->axis[1], offset) * per_w;
    const double wide = sqrt(u * u + v * v), size = grid->directional ? distance : wide;
    const double r = radius * per_w * (1 + 1e-6) + CENTER_SLACK * (1 + size);
    const double reach = grid->directional ? r : r * sqrt(1 + wide * wide) / (1 - r);
    out->center[0] = (float)u;
    out->center[1] = (float)v;
    out->reach = (float)((reach + CENTER_SLACK * (1 + size)) * (1 + 1e-6));
    out->radius = (float)(r * (1 + 1e-6));
    out->near = (float)((w - radius) - 1e-6 * (distance + radius));
    out->id = id;
    return r < 0.5 && distance < FARTHEST && isfinite(out->reach);
}

/// Adds a primitive that is tested for every point instead of being in cells. Returns false if there are too many.
static bool add_other(glint_light_grid *grid, uint32_t id)
{
    if (grid->other_count == GLINT_GRID_OTHERS)
        return false;
    grid->others[grid->other_count++] = id;
    return true;
}

/// Computes the positions of all bounded primitives.
static bool see_all(grid_maker *maker)
{
    const glint_geometry_table *table = maker->table;
    double offset[3];
    for (uint32_t i = 0; i < table->prim_count; i++) {
        const glint_prim *prim = &table->prims[i];
        if (!glint_prim_bounded(prim))
            continue;
        if (is_small(maker, prim, offset) && project_sphere(maker, prim, i, offset, &maker->projected[maker->count]))
            maker->count++;
        else if (!add_other(maker->grid, i))
            return false;
    }
    return maker->count >= SMALLEST_COUNT;
}

// ---- The cells ----

static float mean_reach(const grid_maker *maker)
{
    double sum = 0;
    for (uint32_t i = 0; i < maker->count; i++)
        sum += (double)maker->projected[i].reach;
    return (float)(sum / maker->count);
}

/// Moves primitives larger than `limit` out of the cells, to the primitives that are tested one by one. If there are
/// too many, changes nothing and returns false.
static bool take_large(grid_maker *maker, float limit)
{
    uint32_t large = 0, kept = 0;
    for (uint32_t i = 0; i < maker->count; i++)
        large += maker->projected[i].reach > limit;
    if (large + maker->grid->other_count > GLINT_GRID_OTHERS)
        return false;
    for (uint32_t i = 0; i < maker->count; i++)
        if (!(maker->projected[i].reach > limit && add_other(maker->grid, maker->projected[i].id)))
            maker->projected[kept++] = maker->projected[i];
    maker->count = kept;
    return true;
}

static void bound_centers(grid_maker *maker)
{
    for (int j = 0; j < 2; j++) {
        maker->least[j] = HUGE_VALF;
        maker->most[j] = -HUGE_VALF;
    }
    maker->near = HUGE_VALF;
    maker->far = -HUGE_VALF;
    for (uint32_t i = 0; i < maker->count; i++) {
        const projected_sphere *s = &maker->projected[i];
        for (int j = 0; j < 2; j++) {
            maker->least[j] = fminf(maker->least[j], s->center[j] - s->reach);
            maker->most[j] = fmaxf(maker->most[j], s->center[j] + s->reach);
        }
        maker->near = fminf(maker->near, s->near);
        maker->far = fmaxf(maker->far, s->near);
    }
}

/// Clamps a finite x. fminf and fmaxf would be function calls.
static inline uint32_t clamp(float x, float most) { return (uint32_t)(int32_t)(x < 0 ? 0 : x < most ? x : most); }

/// Computes the first and last cell of a sphere along both axes, with the same float arithmetic as the stage. This
/// arithmetic is monotonic.
static inline void cells_of(const glint_light_grid *grid, const projected_sphere *s, uint32_t first[2],
                            uint32_t last[2])
{
    for (int j = 0; j < 2; j++) {
        const float most = (float)(grid->count[j] - 1);
        first[j] = clamp(((s->center[j] - s->reach) - grid->first[j]) * grid->cells, most);
        last[j] = clamp(((s->center[j] + s->reach) - grid->first[j]) * grid->cells, most);
    }
}

/// Returns the number of entries for cells with this side. Above `limit`, it may be any number above `limit`.
static uint64_t count_entries(grid_maker *maker, float side, uint64_t limit)
{
    glint_light_grid *grid = maker->grid;
    uint64_t entries = 0;
    grid->cells = 1 / side;
    for (int j = 0; j < 2; j++) {
        const double cells = ((double)maker->most[j] - (double)maker->least[j]) / (double)side + 1;
        grid->first[j] = maker->least[j];
        if (!(cells < COUNT_MAX))
            return limit + 1;
        grid->count[j] = (uint32_t)cells + 1;
    }
    if ((uint64_t)grid->count[0] * grid->count[1] > limit)
        return limit + 1;
    for (uint32_t i = 0; i < maker->count && entries <= limit; i++) {
        uint32_t first[2], last[2];
        cells_of(grid, &maker->projected[i], first, last);
        entries += (uint64_t)(last[0] - first[0] + 1) * (last[1] - first[1] + 1);
    }
    return entries;
}

/// Chooses the smallest cells whose entries fit into the limit, and returns the number of entries; 0: no cells do.
static uint64_t choose_cells(grid_maker *maker)
{
    const uint64_t most = (uint64_t)ENTRIES_MAX * maker->count + 1024, fit = maker->max_bytes / ENTRY_BYTES;
    const uint64_t limit = fit < most ? fit : most;
    float side = (float)CELLS_A_RADIUS * mean_reach(maker);
    int tries = 0;
    while (!take_large(maker, (float)COVERED_MAX * side) && tries++ < 32)
        side *= 2;
    if (tries > 32 || maker->count < SMALLEST_COUNT || limit < (uint64_t)ENTRIES_LEAST * maker->count)
        return 0;
    bound_centers(maker);
    for (; tries++ < 64; side *= 1.5F) {
        const uint64_t entries = count_entries(maker, side, limit);
        if (entries <= limit)
            return entries;
    }
    return 0;
}

// ---- The entries ----

static size_t seen_bytes(const grid_maker *maker) { return maker->table->prim_count * sizeof *maker->projected; }

/// Sorts the spheres by slices of depth; the `near` of each sphere becomes the front of its slice.
static bool sort_by_depth(grid_maker *maker)
{
    projected_sphere *sorted = glint_scratch_resize(NULL, 0, seen_bytes(maker));
    uint32_t next[SLICES + 1] = { 0 };
    const float depth = maker->far - maker->near, slices = depth > 0 ? (SLICES - 1) / depth : 0;
    if (!sorted)
        return false;
    for (uint32_t i = 0; i < maker->count; i++)
        next[(uint32_t)((maker->projected[i].near - maker->near) * slices) + 1]++;
    float front[SLICES];
    for (uint32_t k = 0; k < SLICES; k++) {
        next[k + 1] += next[k];
        front[k] = HUGE_VALF;
    }
    for (uint32_t i = 0; i < maker->count; i++) {
        const uint32_t slice = (uint32_t)((maker->projected[i].near - maker->near) * slices);
        front[slice] = fminf(front[slice], maker->projected[i].near);
    }
    for (uint32_t i = 0; i < maker->count; i++) {
        const uint32_t slice = (uint32_t)((maker->projected[i].near - maker->near) * slices);
        projected_sphere *to = &sorted[next[slice]++];
        *to = maker->projected[i];
        to->near = front[slice];
    }
    glint_scratch_free(maker->projected, seen_bytes(maker));
    maker->projected = sorted;
    return true;
}

/// The state of writing a grid's entries.
typedef struct grid_entries {
    uint32_t *center, *size, *id;
} grid_entries;

/// Returns the bits of a sphere's entries that are the same in all cells.
static uint32_t size_of(const glint_light_grid *grid, const projected_sphere *s)
{
    const double steps = GLINT_GRID_STEPS * (double)grid->cells;
    const double most = grid->count[0] > grid->count[1] ? grid->count[0] : grid->count[1];
    const double radius = (double)s->radius * steps + STEP_SLACK + CELL_SLACK * GLINT_GRID_STEPS * most;
    // the stage computes the depth of a point in the same way
    const uint32_t near = clamp((s->near - grid->nearest) * grid->slices, NEAR_MOST);
    return near << GLINT_GRID_RADIUS_BITS | (uint32_t)(int32_t)(radius / GLINT_GRID_RADIUS + 1);
}

/// Returns a sphere's position along an axis, relative to a cell.
static uint32_t step_of(const glint_light_grid *grid, const projected_sphere *s, int axis, uint32_t cell)
{
    const double step = ((double)s->center[axis] - (double)grid->first[axis]) * (double)grid->cells - cell;
    return (uint32_t)(int32_t)((step + GLINT_GRID_ASIDE) * GLINT_GRID_STEPS + 0.5);
}

/// Writes a sphere to each of its cells, at the cell's position `next`.
static void enter(const glint_light_grid *grid, const projected_sphere *s, const uint32_t first[2],
                  const uint32_t last[2], uint32_t *next, const grid_entries *entries)
{
    const uint32_t size = size_of(grid, s), across = step_of(grid, s, 0, first[0]);
    uint32_t down = step_of(grid, s, 1, first[1]);
    for (uint32_t row = first[1]; row <= last[1]; row++, down -= GLINT_GRID_STEPS)
        for (uint32_t column = first[0]; column <= last[0]; column++) {
            const uint32_t at = next[(size_t)row * grid->count[0] + column]++;
            entries->center[at] = down << 16 | (across - (column - first[0]) * GLINT_GRID_STEPS);
            entries->size[at] = size;
            entries->id[at] = s->id;
        }
}

/// Without `entries`, counts each cell's spheres in `next`. With `entries`, writes each sphere to each of its cells,
/// at the cell's position `next`.
static void spread(const grid_maker *maker, uint32_t *next, const grid_entries *entries)
{
    const glint_light_grid *grid = maker->grid;
    for (uint32_t i = 0; i < maker->count; i++) {
        const projected_sphere *s = &maker->projected[i];
        uint32_t first[2], last[2];
        cells_of(grid, s, first, last);
        if (entries)
            enter(grid, s, first, last, next, entries);
        for (uint32_t row = first[1]; !entries && row <= last[1]; row++)
            for (uint32_t column = first[0]; column <= last[0]; column++)
                next[(size_t)row * grid->count[0] + column]++;
    }
}

/// Allocates the entries in one block that begins at `center`, with padding after the last entry, because the stage
/// also loads what follows it.
static bool make_entries(glint_light_grid *grid, uint64_t count, grid_entries *out)
{
    const size_t length = (size_t)count + GLINT_GROUP;
    uint32_t *memory = glint_alloc_large(length, 3 * sizeof *memory);
    if (!memory)
        return false;
    *out = (grid_entries) { memory, memory + length, memory + 2 * length };
    for (size_t k = 1; k <= 3; k++)
        memset(memory + k * length - GLINT_GROUP, 0, GLINT_GROUP * sizeof *memory);
    grid->center = out->center;
    grid->size = out->size;
    grid->id = out->id;
    return true;
}

/// Fills the cells. Returns false when out of memory.
static bool fill(grid_maker *maker, uint64_t count)
{
    glint_light_grid *grid = maker->grid;
    const size_t cells = (size_t)grid->count[0] * grid->count[1];
    uint32_t *begin = glint_alloc(cells + 2, sizeof *begin);
    grid_entries entries;
    grid->sorted = count / cells >= SORTED_FROM;
    grid->begin = begin;
    if (!begin || !make_entries(grid, count, &entries) || (grid->sorted && !sort_by_depth(maker)))
        return false;
    const float depth = maker->far - maker->near;
    grid->nearest = maker->near;
    grid->slices = depth > 0 && isfinite(NEAR_MOST / depth) ? NEAR_MOST / depth : 0;
    uint32_t *next = begin + 1; // begin[cell + 1] moves from the cell's first entry to its end
    spread(maker, next + 1, NULL);
    for (size_t cell = 0; cell < cells; cell++)
        next[cell + 1] += next[cell];
    spread(maker, next, &entries);
    return true;
}

glint_status glint_light_grid_create(const glint_geometry_table *table, bool directional, const double position[3],
                                     size_t max_bytes, glint_light_grid **out, glint_error *error)
{
    grid_maker maker = { .table = table, .max_bytes = max_bytes };
    bool enough = true;
    *out = NULL;
    if (!table->nodes || table->prim_count < SMALLEST_COUNT)
        return GLINT_OK;
    maker.grid = glint_alloc(1, sizeof *maker.grid);
    maker.projected = glint_scratch_resize(NULL, 0, seen_bytes(&maker));
    if (maker.grid && maker.projected) {
        *maker.grid = (glint_light_grid) { .directional = directional };
        vec_copy(maker.grid->position, position);
        vec_copy(maker.grid->origin, directional ? table->reference : position);
        const uint64_t entries = aim(&maker) && see_all(&maker) ? choose_cells(&maker) : 0;
        enough = entries == 0 || (entries < UINT32_MAX && fill(&maker, entries));
        if (entries && enough)
            *out = maker.grid;
    } else {
        enough = false;
    }
    glint_scratch_free(maker.projected, seen_bytes(&maker));
    if (!*out)
        glint_light_grid_destroy(maker.grid);
    return enough ? GLINT_OK : glint_fail_nomem(error);
}

void glint_light_grid_destroy(glint_light_grid *grid)
{
    if (!grid)
        return;
    free((void *)(uintptr_t)grid->begin);
    free((void *)(uintptr_t)grid->center); // the other arrays of entries are in the same block
    free(grid);
}
