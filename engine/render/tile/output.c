#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/render/pattern/pattern.h"

#include <string.h>

/// Stores a group that lies inside the image.
static void store_group(const uint32_t *from, uint32_t *to, size_t stride)
{
    memcpy(to, from, 4 * sizeof *to);
    memcpy(to + stride, from + 4, 4 * sizeof *to);
    memcpy(to + 2 * stride, from + 8, 4 * sizeof *to);
    memcpy(to + 3 * stride, from + 12, 4 * sizeof *to);
}

void glint_tile_store_plane(const glint_tile *tile, const void *groups, void *plane, int stride)
{
    _Static_assert(sizeof(float) == sizeof(uint32_t), "numbers of planes");
    uint32_t *const first = (uint32_t *)plane + (size_t)tile->y0 * (size_t)stride + tile->x0;
    if (tile->width % 4 == 0 && tile->height % 4 == 0) {
        const uint32_t *from = groups;
        for (uint32_t y = 0; y < tile->height; y += 4)
            for (uint32_t x = 0; x < tile->width; x += 4, from += GLINT_GROUP)
                store_group(from, first + (size_t)y * (size_t)stride + x, (size_t)stride);
        return;
    }
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const uint32_t x = 4 * (g % tile->groups_across), y = 4 * (g / tile->groups_across);
        const uint32_t columns = tile->width - x < 4 ? tile->width - x : 4;
        const uint32_t rows = tile->height - y < 4 ? tile->height - y : 4;
        for (uint32_t r = 0; r < rows; r++)
            memcpy(first + (size_t)(y + r) * (size_t)stride + x, (const uint32_t *)groups + g * GLINT_GROUP + 4 * r,
                   columns * sizeof *first);
    }
}

void glint_tile_store_pass(const glint_tile *tile, const glint_tile_frame *frame, glint_pass pass,
                           const float *groups)
{
    if (!(frame->plan->desc.passes >> pass & 1))
        return;
    for (int c = 0; c < glint_pass_channels(pass); c++)
        glint_tile_store_plane(tile, groups + (size_t)c * GLINT_TILE_SAMPLES, frame->image->plane[pass][c], frame->image->width);
}

double glint_tile_direction(const glint_tile *tile, glint_precision precision, int c, uint32_t i)
{
    if (glint_tile_has_arrays(tile))
        return glint_real_at(tile->rays.direction[c], precision, i);
    const uint32_t x = i / GLINT_GROUP % tile->groups_across, y = i / GLINT_GROUP / tile->groups_across;
    const uint32_t lane = i % GLINT_GROUP;
    const double d = glint_real_at(tile->camera.across, precision, (3 * x + (uint32_t)c) * GLINT_GROUP + lane) +
                     glint_real_at(tile->camera.down, precision, (3 * y + (uint32_t)c) * GLINT_GROUP + lane);
    return precision == GLINT_PRECISION_FLOAT ? (float)d : d;
}

bool glint_tile_wants_geometry(const glint_plan *plan)
{
    return plan->is_base || plan->desc.passes & GLINT_CENTRE_PASSES;
}

/// Returns the buffer for normals and object numbers before they are stored. For a base, this is the buffer that is
/// compared, with consecutive arrays; otherwise `own`.
static float *geometry_of(const glint_tile *tile, const glint_tile_frame *frame, int value, float *own)
{
    return frame->plan->is_base ? glint_differ_values(tile->differ, value) : own;
}

double glint_tile_hit_distance(const glint_tile *tile, const glint_plan *plan, uint32_t i)
{
    double d[3];
    if (!glint_has_lane(tile->at.hits, i) && !glint_tile_sees_light(tile, plan, i))
        return HUGE_VAL;
    for (int c = 0; c < 3; c++)
        d[c] = glint_tile_direction(tile, plan->desc.precision, c, i);
    return glint_real_at(tile->at.t, plan->desc.precision, i) * sqrt(vec_dot(d, d));
}

static void store_depth(const glint_tile *tile, const glint_tile_frame *frame)
{
    float depth[GLINT_TILE_SAMPLES];
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++)
        depth[i] = (float)glint_tile_hit_distance(tile, frame->plan, i);
    glint_tile_store_pass(tile, frame, GLINT_PASS_DEPTH, depth);
}

/// Clears the normals of a group's rays that hit nothing.
static void rest_normals(const glint_tile *tile, const glint_tile_frame *frame, uint32_t g, float *const normal[3])
{
    for (unsigned bits = 0xffffu & ~(unsigned)tile->at.hits[g]; bits; bits &= bits - 1) {
        const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
        double n[3] = { 0 };
        if (glint_tile_sees_light(tile, frame->plan, i))
            glint_stage_table[GLINT_STAGE_VISIBLE_LIGHT]->normal(tile, frame, i, n);
        for (int c = 0; c < 3; c++)
            normal[c][i] = (float)n[c];
    }
}

/// Rounds a component of group g to float.
static void round_normals(const void *reals, glint_precision precision, uint32_t g, float *restrict out)
{
    const double *from = (const double *)reals + (size_t)g * GLINT_GROUP;
    if (precision == GLINT_PRECISION_FLOAT) {
        memcpy(out, (const float *)reals + (size_t)g * GLINT_GROUP, GLINT_GROUP * sizeof *out);
        return;
    }
    for (size_t i = 0; i < GLINT_GROUP; i++)
        out[i] = (float)from[i];
}

static void store_normal(const glint_tile *tile, const glint_tile_frame *frame)
{
    float own[3][GLINT_TILE_SAMPLES], *normal[3];
    for (int c = 0; c < 3; c++)
        normal[c] = geometry_of(tile, frame, GLINT_DIFFER_NORMAL + c, own[c]);
    for (uint32_t g = 0; g < tile->group_count; g++) {
        if (!(tile->at.hits[g] | glint_tile_sees_lights(tile, frame->plan, g))) {
            for (int c = 0; c < 3; c++)
                memset(normal[c] + g * GLINT_GROUP, 0, GLINT_GROUP * sizeof *normal[c]);
            continue;
        }
        for (int c = 0; c < 3; c++)
            round_normals(tile->surface.normal[c], frame->plan->desc.precision, g, normal[c] + g * GLINT_GROUP);
        rest_normals(tile, frame, g, normal);
    }
    glint_tile_store_pass(tile, frame, GLINT_PASS_NORMAL, normal[0]);
}

static float object_of(const glint_tile_frame *frame, uint32_t prim)
{
    return (float)(glint_geometry_object(frame->plan->geometry, frame->geometry.prims[prim].id) + 1);
}

/// Writes the object numbers of a group that shows several primitives or the background. last: the last primitive,
/// and `object` its number.
static void part_ids(const glint_tile *tile, const glint_tile_frame *frame, uint32_t g, uint32_t *last, float *object, float *id)
{
    const uint32_t *prim = tile->at.prim + (size_t)g * GLINT_GROUP;
    for (uint32_t lane = 0; lane < GLINT_GROUP; lane++) {
        const bool hit = tile->at.hits[g] >> lane & 1;
        if (hit && prim[lane] != *last) {
            *last = prim[lane];
            *object = object_of(frame, *last);
        }
        id[lane] = hit ? *object : 0;
    }
}

static void store_object_id(const glint_tile *tile, const glint_tile_frame *frame)
{
    float own[GLINT_TILE_SAMPLES], *id = geometry_of(tile, frame, GLINT_DIFFER_ID, own), object = 0;
    uint32_t last = tile->at.only ? *tile->at.only : GLINT_MISS;
    if (tile->at.only)
        object = object_of(frame, last);
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const uint32_t *prim = tile->at.prim + (size_t)g * GLINT_GROUP;
        float *const out = id + (size_t)g * GLINT_GROUP;
        const bool same = last != GLINT_MISS && tile->at.hits[g] == 0xffff && (tile->at.only || glint_all_are(prim, last));
        const float shown = same ? object : 0;
        if (same || !tile->at.hits[g])
            for (uint32_t lane = 0; lane < GLINT_GROUP; lane++)
                out[lane] = shown;
        else
            part_ids(tile, frame, g, &last, &object, out);
    }
    glint_tile_store_pass(tile, frame, GLINT_PASS_OBJECT_ID, id);
}

/// Adds the light that a surface reflects and transmits at normal incidence to its diffuse reflectance, up to 1.
/// Denoisers expect this for metal and glass (Open Image Denoise 2, "Albedo").
static void add_bounces(const glint_bounce_material *m, double color[3])
{
    const double r = (m->ior - 1) / (m->ior + 1), reflected = m->fresnel ? r * r : 1;
    const double transmitted = m->fresnel ? 1 - reflected : 1;
    for (int c = 0; c < 3; c++) {
        const double mirror = reflected * m->mirror[c] * m->specular[c] * (m->schlick ? m->f0[c] : 1);
        color[c] = fmax(color[c], fmin(color[c] + mirror + transmitted * m->transmission[c], 1));
    }
}

double glint_tile_albedo(const glint_tile *tile, const glint_plan *plan, uint32_t i, bool followed, double color[3])
{
    glint_bounce_material buffer;
    double own[3];
    vec_copy(color, glint_tile_diffuse(tile, plan, i, own));
    if (!plan->bouncing)
        return 1;
    const glint_bounce_material *m = glint_tile_bouncing(tile, plan, i, &buffer);
    const double opacity = plan->clears ? 1 - m->clear : 1;
    if (!followed)
        add_bounces(m, color);
    for (int c = 0; c < 3; c++)
        color[c] = opacity > 0 ? color[c] / opacity : 0;
    return opacity;
}

/// Stores the albedo of the first surfaces that are neither smooth mirrors nor smooth glass, and 1 where such surfaces
/// show the surroundings.
static void store_albedo(glint_tile *tile, const glint_tile_frame *frame)
{
    double light[3][GLINT_TILE_SAMPLES], color[3] = { 0 };
    float albedo[3][GLINT_TILE_SAMPLES];
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        const bool hit = glint_has_lane(tile->at.hits, i);
        if (hit)
            glint_tile_albedo(tile, frame->plan, i, false, color);
        for (int c = 0; c < 3; c++)
            light[c][i] = hit ? color[c] : 0;
    }
    glint_tile_step(tile, frame, GLINT_AT_ALBEDO, &(glint_sample_walk) { .albedo = light });
    for (int c = 0; c < 3; c++)
        for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++)
            albedo[c][i] = (float)light[c][i];
    glint_tile_store_pass(tile, frame, GLINT_PASS_ALBEDO, albedo[0]);
}

void glint_tile_store_geometry(glint_tile *tile, const glint_tile_frame *frame)
{
    const uint32_t passes = frame->plan->desc.passes;
    if (passes >> GLINT_PASS_DEPTH & 1)
        store_depth(tile, frame);
    if (passes >> GLINT_PASS_NORMAL & 1 || frame->plan->is_base)
        store_normal(tile, frame);
    if (passes >> GLINT_PASS_OBJECT_ID & 1 || frame->plan->is_base)
        store_object_id(tile, frame);
    if (passes >> GLINT_PASS_ALBEDO & 1)
        store_albedo(tile, frame);
}

// ---- Coverage -----------------------------------------------------------------------------------------------------

bool glint_tile_wants_coverage(const glint_plan *plan)
{
    return plan->desc.alpha || plan->desc.passes >> GLINT_PASS_ALPHA & 1;
}

void glint_tile_count_hits(glint_tile *tile, const glint_plan *plan, uint32_t k)
{
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        const bool light = glint_tile_sees_light(tile, plan, i);
        tile->film.covered[i] =
            (k ? tile->film.covered[i] : 0) + (light || tile->at.hits[i / GLINT_GROUP] >> i % GLINT_GROUP & 1u);
    }
}

static float coverage_at(const glint_tile *tile, const glint_plan *plan, uint32_t i)
{
    return (float)(fmax(tile->film.covered[i], 0) / plan->desc.samples);
}

static void store_coverage(const glint_tile *tile, const glint_tile_frame *frame)
{
    float alpha[GLINT_TILE_SAMPLES];
    if (!(frame->plan->desc.passes >> GLINT_PASS_ALPHA & 1))
        return;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++)
        alpha[i] = coverage_at(tile, frame->plan, i);
    glint_tile_store_pass(tile, frame, GLINT_PASS_ALPHA, alpha);
}

// ---- Light --------------------------------------------------------------------------------------------------------

/// Stores the pass `refined` without adaptive sampling: every pixel has all samples.
static void store_refined(const glint_tile *tile, const glint_tile_frame *frame)
{
    float all[GLINT_TILE_SAMPLES];
    if (frame->base || !(frame->plan->desc.passes >> GLINT_PASS_REFINED & 1))
        return;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++)
        all[i] = 1;
    glint_tile_store_pass(tile, frame, GLINT_PASS_REFINED, all);
}

void glint_tile_store_light(glint_tile *tile, const glint_tile_frame *frame)
{
    store_coverage(tile, frame);
    store_refined(tile, frame);
    for (int k = GLINT_TERM_LOCAL; k < GLINT_TERM_COUNT; k++)
        if ((tile->direct || !glint_plan_has_term(frame->plan, (glint_term)k)) &&
            frame->plan->desc.passes >> (GLINT_PASS_BACKGROUND + k) & 1)
            memset(tile->film.terms[k], 0, sizeof tile->film.terms[k]);
    glint_tile_store_pass(tile, frame, GLINT_PASS_BEAUTY, tile->film.beauty[0]);
    for (int k = 0; k < GLINT_TERM_COUNT; k++)
        glint_tile_store_pass(tile, frame, (glint_pass)(GLINT_PASS_BACKGROUND + k), tile->film.terms[k][0]);
    glint_tile_step(tile, frame, GLINT_AT_STORE_LIGHT, NULL);
}

/// Converts the tile's pixels row by row, if the stage tone does not support the format.
static void tone_rows(glint_tile *tile, const glint_tile_frame *frame)
{
    float row[3][GLINT_TILE_WIDTH], alpha[GLINT_TILE_WIDTH];
    const glint_image *image = frame->image;
    uint64_t counts[2] = { 0 };
    for (uint32_t y = 0; y < tile->height; y++) {
        for (uint32_t x = 0; x < tile->width; x++) {
            const uint32_t i = glint_tile_slot(tile, x, y);
            alpha[x] = frame->plan->desc.alpha ? coverage_at(tile, frame->plan, i) : 1;
            for (int c = 0; c < 3; c++)
                row[c][x] = tile->film.beauty[c][i];
        }
        const int first[2] = { (int)tile->x0, (int)(tile->y0 + y) };
        const size_t at = (size_t)first[1] * (size_t)image->width + (size_t)first[0];
        glint_tone_row(frame->tone_table, frame->gain, (const float *const[3]) { row[0], row[1], row[2] },
                       frame->plan->desc.alpha ? alpha : NULL, first, tile->width,
                       (char *)image->codes + at * glint_image_pixel_bytes(image), counts);
    }
    tile->counts.clipped += counts[0];
    tile->counts.nonfinite += counts[1];
}

/// Prefetches the tile's rows of a picture; memory may be NULL.
static void prefetch_rows(const glint_tile *tile, const void *memory, int width, size_t pixel)
{
    const size_t stride = (size_t)width * pixel;
    for (size_t y = 0; memory && y < tile->height; y++)
        glint_prefetch((const char *)memory + (tile->y0 + y) * stride + tile->x0 * pixel, tile->width * pixel);
}

void glint_tile_prefetch_output(const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_image *image = frame->image;
    prefetch_rows(tile, image->codes, image->width, glint_image_pixel_bytes(image));
    for (uint32_t bits = frame->plan->desc.passes & ((1u << GLINT_PASS_COUNT) - 1); bits; bits &= bits - 1)
        for (int c = 0; c < 3; c++)
            prefetch_rows(tile, image->plane[__builtin_ctz(bits)][c], image->width, sizeof(float));
}

/// Prefetches the cache line of number `at` in a plane.
static void prefetch_number(const void *plane, size_t at)
{
    if (plane)
        glint_prefetch((const uint32_t *)plane + at, sizeof(uint32_t));
}

/// Prefetches one cache line of sixteen pixels per plane: four adjacent groups share four such lines, one row each.
void glint_tile_prefetch_derivatives(const glint_tile *tile, const glint_tile_frame *frame, uint32_t g)
{
    const glint_image *image = frame->image;
    const uint32_t x = g % tile->groups_across / 4 * 16, y = g / tile->groups_across * 4 + g % 4;
    const size_t at = (tile->y0 + y) * (size_t)image->width + tile->x0 + x;
    if (y >= tile->height)
        return;
    for (size_t k = 0; k < frame->plan->derivatives->count; k++)
        for (int c = 0; c < 3; c++)
            prefetch_number(image->plane[GLINT_PASS_DERIVATIVE + k][c], at);
    if (frame->plan->derivatives->moves)
        prefetch_number(image->shadows, at);
}

void glint_tile_tone(glint_tile *tile, const glint_tile_frame *frame)
{
    if (frame->plan->desc.alpha || frame->plan->desc.tone.bits == 16 || frame->plan->desc.tone.dither) {
        tone_rows(tile, frame);
        return;
    }
    const size_t stride = 3 * (size_t)frame->image->width;
    glint_tone_args args = { .group_count = tile->group_count,
                             .groups_across = tile->groups_across,
                             .active = tile->active,
                             .gain = frame->gain,
                             .white = frame->tone_table->white,
                             .top = frame->tone_table->top,
                             .table = frame->tone_table->lut,
                             .fit = frame->tone_table->has_fit ? &frame->tone_table->fit : NULL,
                             .codes = (uint8_t *)frame->image->codes + tile->y0 * stride + 3 * (size_t)tile->x0,
                             .stride = stride,
                             .clipped = &tile->counts.clipped,
                             .nonfinite = &tile->counts.nonfinite };
    for (int c = 0; c < 3; c++)
        args.beauty[c] = tile->film.beauty[c];
    frame->stages->tone(&args);
}

bool glint_tile_has_codes_of(const glint_tile *tile, const glint_image *a, const glint_image *b)
{
    const size_t pixel = glint_image_pixel_bytes(a), stride = (size_t)a->width * pixel;
    const size_t at = tile->y0 * stride + tile->x0 * pixel;
    for (size_t y = 0; a->codes && y < tile->height; y++)
        if (memcmp((const char *)a->codes + at + y * stride, (const char *)b->codes + at + y * stride,
                   tile->width * pixel) != 0)
            return false;
    return true;
}

void glint_tile_copy(const glint_tile *tile, const glint_tile_frame *frame, const glint_image *from)
{
    const size_t stride = (size_t)from->width, at = (size_t)tile->y0 * stride + tile->x0;
    const size_t pixel = from->codes && frame->image->codes ? glint_image_pixel_bytes(from) : 0;
    for (size_t y = 0; y < tile->height; y++) {
        const size_t row = at + y * stride;
        if (pixel)
            memcpy((char *)frame->image->codes + row * pixel, (const char *)from->codes + row * pixel,
                   tile->width * pixel);
        if (from->shadows && frame->image->shadows)
            memcpy(frame->image->shadows + row, from->shadows + row, tile->width * sizeof *from->shadows);
        for (int pass = 0; pass < GLINT_PLANE_COUNT; pass++)
            for (int c = 0; c < 3; c++)
                if (from->plane[pass][c] && frame->image->plane[pass][c])
                    memcpy(frame->image->plane[pass][c] + row, from->plane[pass][c] + row, tile->width * sizeof(float));
        for (size_t i = 0; i < frame->image->light_count; i++)
            for (int c = 0; c < 3; c++)
                memcpy(frame->image->light[i][c] + row, from->light[i][c] + row, tile->width * sizeof(float));
    }
}
