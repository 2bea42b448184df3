#include "engine/geometry.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

// ---- One primitive ----

static float float_up(double x)
{
    const float f = (float)x;
    return (double)f < x ? nextafterf(f, HUGE_VALF) : f;
}

static float float_down(double x) { return -float_up(-x); }

static void sphere_init(glint_prim *prim, const double center[3], double radius)
{
    prim->kind = GLINT_PRIM_SPHERE;
    for (int c = 0; c < 3; c++)
        prim->center[c] = center[c] + 0.0; // -0 and 0 are one place
    prim->radius = radius;
    prim->scale = power_of_two_scale(radius);
    const double r = radius * prim->scale;
    prim->r2 = r * r;
    prim->r2_low = fma(r, r, -prim->r2);
}

static void plane_init(glint_prim *prim, const double point[3], const double normal[3])
{
    prim->kind = GLINT_PRIM_PLANE;
    for (int c = 0; c < 3; c++)
        prim->center[c] = point[c] + 0.0;
    vec_normalize(prim->normal, normal);
    prim->scale = 1;
}

static bool is_bounded(const glint_prim *prim) { return prim->kind != GLINT_PRIM_PLANE; }

/// All that a primitive's place is made of.
static void prim_place(const glint_prim *prim, double out[8])
{
    out[0] = prim->kind;
    vec_copy(out + 1, prim->center);
    vec_copy(out + 4, prim->normal);
    out[7] = prim->radius;
}

// ---- From shapes to primitives ----

/// The number of the shape's material in `materials`, which grows as new ones appear.
static glint_status material_number(glint_list *materials, glint_material *material, uint32_t *out, glint_error *error)
{
    size_t index = glint_list_find(materials, material);
    glint_status status = GLINT_OK;
    if (index == materials->count)
        status = glint_list_add(materials, material, error);
    *out = (uint32_t)index;
    return status;
}

static glint_status add_shape(glint_geometry *geometry, const glint_shape *shape, uint32_t number, uint32_t *numbers,
                              glint_error *error)
{
    const glint_shape_desc *desc = &shape->desc;
    for (size_t i = 0; i < shape->material_count; i++) {
        glint_status status = material_number(&geometry->materials, shape->materials[i], &numbers[i], error);
        if (status)
            return status;
    }
    for (size_t i = 0; i < shape->count; i++) {
        const uint32_t at = geometry->table.prim_count++;
        glint_prim *prim = &geometry->prims[at];
        if (desc->kind == GLINT_SHAPE_SPHERES)
            sphere_init(prim, shape->spheres[i], shape->spheres[i][3]);
        else if (desc->kind == GLINT_SHAPE_SPHERE)
            sphere_init(prim, desc->center, desc->radius);
        else
            plane_init(prim, desc->point, desc->normal);
        prim->id = at;
        prim->two_sided = desc->two_sided;
        prim->material = numbers[shape->index ? shape->index[i] : 0];
        geometry->prim_shape[at] = number;
    }
    return GLINT_OK;
}

static glint_status add_shapes(glint_geometry *geometry, const glint_scene *scene, glint_error *error)
{
    size_t count = 0, materials = 0;
    for (size_t i = 0; i < scene->shapes.count; i++) {
        const glint_shape *shape = glint_scene_shape(scene, i);
        count += shape->count;
        materials = shape->material_count > materials ? shape->material_count : materials;
    }
    if (count >= INT32_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "scene: fewer than 2147483647 surfaces expected, got %zu", count);
    uint32_t *numbers = glint_alloc(materials, sizeof *numbers);
    geometry->prims = glint_alloc(count, sizeof *geometry->prims);
    geometry->prim_shape = glint_alloc(count, sizeof *geometry->prim_shape);
    glint_status status = GLINT_OK;
    if (!numbers || !geometry->prims || !geometry->prim_shape)
        status = glint_fail_nomem(error);
    for (size_t i = 0; i < scene->shapes.count && !status; i++)
        status = add_shape(geometry, glint_scene_shape(scene, i), (uint32_t)i, numbers, error);
    free(numbers);
    geometry->table.prims = geometry->prims;
    return status;
}

/// Finds, for each primitive, the first one with bit-equal geometry.
static glint_status find_coincident(glint_geometry *geometry, glint_error *error)
{
    const uint32_t count = geometry->table.prim_count;
    size_t size = 16;
    while (size < 2 * (size_t)count)
        size *= 2;
    uint32_t *slots = calloc(size, sizeof *slots); // index + 1
    if (!slots)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < count; i++) {
        double place[8], other[8];
        prim_place(&geometry->prims[i], place);
        size_t at = glint_key_add((glint_key) { 0 }, place, sizeof place).low & (size - 1);
        for (; slots[at]; at = (at + 1) & (size - 1)) {
            prim_place(&geometry->prims[slots[at] - 1], other);
            if (memcmp(place, other, sizeof place) == 0)
                break;
        }
        if (!slots[at])
            slots[at] = i + 1;
        geometry->prims[i].coincident = slots[at] - 1;
        geometry->table.duplicates = geometry->table.duplicates || slots[at] != i + 1;
    }
    free(slots);
    return GLINT_OK;
}

/// Keys of where the primitives are, and of what they look like.
static void make_keys(glint_geometry *geometry)
{
    enum { CHUNK = 32 };
    for (uint32_t i = 0; i < geometry->table.prim_count; i += CHUNK) {
        double place[CHUNK][8];
        uint32_t look[CHUNK][2], n = 0;
        for (; n < CHUNK && i + n < geometry->table.prim_count; n++) {
            const glint_prim *prim = &geometry->prims[i + n];
            prim_place(prim, place[n]);
            look[n][0] = prim->two_sided;
            look[n][1] = prim->material;
        }
        geometry->where = glint_key_add(geometry->where, place, n * sizeof place[0]);
        geometry->look = glint_key_add(geometry->look, look, n * sizeof look[0]);
    }
}

// ---- The index's frame ----

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Around the middle of what there is (the median, so that one giant does not draw it away), in units of the largest
/// length: floats lose least there.
static void choose_frame(glint_geometry *geometry)
{
    enum { SAMPLES = 255 };
    glint_geometry_table *table = &geometry->table;
    const uint32_t count = table->prim_count, step = count / SAMPLES + 1;
    for (int c = 0; c < 3; c++) {
        double sample[SAMPLES + 1] = { 0 };
        size_t n = 0;
        for (uint32_t i = 0; i < count; i += step)
            sample[n++] = geometry->prims[i].center[c];
        qsort(sample, n, sizeof *sample, by_value);
        table->reference[c] = n ? sample[n / 2] : 0;
    }
    double largest = 0;
    for (uint32_t i = 0; i < count; i++) {
        const glint_prim *prim = &geometry->prims[i];
        double offset[3];
        vec_sub(offset, prim->center, table->reference);
        if (is_bounded(prim))
            largest = fmax(largest, vec_max_abs(offset) + prim->radius);
        table->extent = fmax(table->extent, vec_max_abs(prim->center) + prim->radius);
    }
    table->scale = largest > 0 && isfinite(largest) ? power_of_two_scale(largest) : 1;
}

/// Numbers beyond this are as good as infinite, and differences of such floats are still finite.
#define BOX_MAX 0x1p120

static void place_in_frame(const glint_geometry_table *table, glint_prim *prim, glint_box *box)
{
    double center[3];
    vec_sub(center, prim->center, table->reference);
    vec_scale(center, center, table->scale);
    const double radius = prim->radius * table->scale, distance = sqrt(vec_dot(center, center));
    for (int c = 0; c < 3; c++) {
        const double slack = 0x1p-50 * (fabs(center[c]) + radius);
        prim->filter_center[c] = (float)center[c];
        box->lower[c] = float_down(fmax(center[c] - radius - slack, -BOX_MAX));
        box->upper[c] = float_up(fmin(center[c] + radius + slack, BOX_MAX));
    }
    prim->filter_bound = float_up(radius * (1 + 2e-6) + GLINT_FILTER_SLACK * distance + FLT_MIN);
}

static glint_status index_create(glint_geometry *geometry, glint_error *error)
{
    const uint32_t count = geometry->table.prim_count;
    glint_index *index = geometry->index = calloc(1, sizeof *index);
    geometry->unbounded = glint_alloc(count, sizeof *geometry->unbounded);
    if (!index || !geometry->unbounded)
        return glint_fail_nomem(error);
    atomic_init(&index->references, 1);
    pthread_mutex_init(&index->lock, NULL);
    index->boxes = malloc((count + 1) * sizeof *index->boxes);
    index->bounded = malloc((count + 1) * sizeof *index->bounded);
    if (!index->boxes || !index->bounded)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < count; i++) {
        glint_prim *prim = &geometry->prims[i];
        prim->filter_bound = HUGE_VALF;
        if (is_bounded(prim)) {
            place_in_frame(&geometry->table, prim, &index->boxes[index->box_count]);
            index->bounded[index->box_count++] = i;
        } else {
            geometry->unbounded[geometry->table.unbounded_count++] = i;
        }
    }
    geometry->table.unbounded = geometry->unbounded;
    return GLINT_OK;
}

static void index_release(glint_index *index)
{
    if (!index || atomic_fetch_sub(&index->references, 1) > 1)
        return;
    glint_bvh_free(&index->bvh);
    free(index->boxes);
    free(index->bounded);
    free(index->order);
    pthread_mutex_destroy(&index->lock);
    free(index);
}

/// Numbers the primitives in the order in which the tree's nodes name them, and has the nodes say so.
static void order_by_tree(glint_index *index)
{
    uint32_t next = 0;
    for (uint32_t n = 0; n < index->bvh.node_count; n++) {
        glint_node *node = &index->bvh.nodes[n];
        for (int i = 0; i < GLINT_NODE_WIDTH; i++) {
            if (!(node->lower[0][i] <= node->upper[0][i]) || !(node->child[i] & GLINT_NODE_PRIM))
                continue;
            index->order[next] = index->bounded[node->child[i] & ~GLINT_NODE_PRIM];
            node->child[i] = GLINT_NODE_PRIM | next++;
        }
    }
}

static glint_status index_build(glint_index *index, glint_pool *pool, glint_error *error)
{
    index->order = malloc((index->box_count + 1) * sizeof *index->order);
    if (!index->order)
        return glint_fail_nomem(error);
    glint_status status = glint_bvh_build(index->boxes, index->box_count, pool, &index->bvh, error);
    if (status) {
        free(index->order);
        index->order = NULL;
        return status;
    }
    order_by_tree(index);
    free(index->boxes);
    free(index->bounded);
    index->boxes = NULL;
    index->bounded = NULL;
    index->built = true;
    return GLINT_OK;
}

typedef struct arranging {
    const glint_index *index;
    const glint_prim *from;
    glint_prim *to;
} arranging;

#define ARRANGE_CHUNK 16384u

static void arrange_chunk(void *context, size_t chunk, int worker)
{
    const arranging *a = context;
    const uint32_t from = (uint32_t)chunk * ARRANGE_CHUNK, rest = a->index->box_count - from;
    (void)worker;
    for (uint32_t i = from; i < from + (rest < ARRANGE_CHUNK ? rest : ARRANGE_CHUNK); i++)
        a->to[i] = a->from[a->index->order[i]];
}

/// Puts the primitives into the order of the index, those without an end last.
static glint_status arrange(glint_geometry *geometry, glint_pool *pool, glint_error *error)
{
    const uint32_t count = geometry->table.prim_count, bounded = geometry->index->box_count;
    arranging a = { geometry->index, geometry->prims, glint_alloc_large(count, sizeof *geometry->prims) };
    if (!a.to)
        return glint_fail_nomem(error);
    const size_t chunks = (bounded + ARRANGE_CHUNK - 1) / ARRANGE_CHUNK;
    if (pool && chunks > 1)
        glint_pool_run(pool, chunks, arrange_chunk, &a);
    else
        for (size_t i = 0; i < chunks; i++)
            arrange_chunk(&a, i, 0);
    for (uint32_t i = 0; i < geometry->table.unbounded_count; i++) {
        a.to[bounded + i] = geometry->prims[geometry->unbounded[i]];
        geometry->unbounded[i] = bounded + i;
    }
    free(geometry->prims);
    geometry->table.prims = geometry->prims = a.to;
    geometry->table.nodes = geometry->index->bvh.nodes;
    geometry->arranged = true;
    return GLINT_OK;
}

glint_status glint_geometry_index(glint_geometry *geometry, glint_pool *pool, glint_geometry_table *table,
                                  glint_error *error)
{
    glint_index *index = geometry->index;
    pthread_mutex_lock(&index->lock);
    glint_status status = index->built ? GLINT_OK : index_build(index, pool, error);
    if (!status && !geometry->arranged)
        status = arrange(geometry, pool, error);
    pthread_mutex_unlock(&index->lock);
    *table = geometry->table;
    return status;
}

// ---- The scene's ----

glint_geometry *glint_geometry_retain(glint_geometry *geometry)
{
    atomic_fetch_add(&geometry->references, 1);
    return geometry;
}

void glint_geometry_release(glint_geometry *geometry)
{
    if (!geometry || atomic_fetch_sub(&geometry->references, 1) > 1)
        return;
    index_release(geometry->index);
    glint_list_free(&geometry->materials);
    free(geometry->prims);
    free(geometry->prim_shape);
    free(geometry->unbounded);
    free(geometry);
}

static glint_status fill(glint_geometry *geometry, const glint_scene *scene, glint_error *error)
{
    const glint_geometry *last = scene->geometry;
    glint_status status = add_shapes(geometry, scene, error);
    if (!status)
        status = find_coincident(geometry, error);
    if (status)
        return status;
    make_keys(geometry);
    choose_frame(geometry);
    status = index_create(geometry, error);
    if (!status && last && glint_key_equal(last->where, geometry->where)) {
        index_release(geometry->index);
        geometry->index = last->index;
        atomic_fetch_add(&geometry->index->references, 1);
    }
    return status;
}

/// Every change of a shape gives it a number that no other state of any shape has.
static glint_key revision_of(const glint_scene *scene)
{
    enum { CHUNK = 64 };
    glint_key key = { 0 };
    for (size_t i = 0; i < scene->shapes.count; i += CHUNK) {
        uint64_t revision[CHUNK];
        size_t n = 0;
        for (; n < CHUNK && i + n < scene->shapes.count; n++)
            revision[n] = glint_scene_shape(scene, i + n)->revision;
        key = glint_key_add(key, revision, n * sizeof *revision);
    }
    return key;
}

glint_status glint_geometry_of(const glint_scene *scene, glint_geometry **out, glint_error *error)
{
    const glint_key revision = revision_of(scene);
    if (!scene->geometry || !glint_key_equal(scene->geometry->revision, revision)) {
        glint_geometry *geometry = calloc(1, sizeof *geometry);
        if (!geometry)
            return glint_fail_nomem(error);
        atomic_init(&geometry->references, 1);
        geometry->revision = revision;
        glint_status status = fill(geometry, scene, error);
        if (status) {
            glint_geometry_release(geometry);
            return status;
        }
        glint_geometry_release(scene->geometry);
        ((glint_scene *)scene)->geometry = geometry; // a cache: nobody sees it
    }
    *out = glint_geometry_retain(scene->geometry);
    return GLINT_OK;
}
