/// The stage derivative: how fast the light of each sample changes with parameters, with hits and shadows held
/// constant.
#include "engine/render/effects/derivative/work.h"

#include "engine/base/alloc.h"
#include "engine/render/stages/light/cone_sample.h"

#include <stdlib.h>
#include <string.h>

#define NO_SHADOWS 0x811c9dc5u ///< no light is hidden from the sample

// ---- Points ---------------------------------------------------------------------------------------------------------

/// Loads the directions of the group's rays.
static void gather_directions(const glint_tile *tile, glint_precision precision, uint32_t g, double (*out)[GLINT_GROUP])
{
    for (uint32_t c = 0; c < 3; c++) {
        double down[GLINT_GROUP];
        if (glint_tile_has_arrays(tile)) {
            glint_reals_of(tile->rays.direction[c], precision, g, out[c]);
            continue;
        }
        glint_reals_of(tile->camera.across, precision, 3 * (g % tile->groups_across) + c, out[c]);
        glint_reals_of(tile->camera.down, precision, 3 * (g / tile->groups_across) + c, down);
        for (int i = 0; i < GLINT_GROUP; i++)
            out[c][i] = (double)(float)(out[c][i] + down[i]);
    }
}

/// Computes the directions from the group's points to the viewer.
static void find_eyes(const glint_tile *tile, const glint_tile_frame *frame, uint32_t g)
{
    double (*eye)[GLINT_TILE_SAMPLES] = glint_derivative_of(tile)->eye;
    const size_t at = (size_t)g * GLINT_GROUP;
    _Alignas(64) double buffer[3][GLINT_GROUP];
    glint_eyes_args args = { .direction = buffer[0], .eye = { eye[0] + at, eye[1] + at, eye[2] + at } };
    if (glint_tile_has_arrays(tile) || frame->plan->desc.precision == GLINT_PRECISION_FLOAT) {
        gather_directions(tile, frame->plan->desc.precision, g, buffer);
    } else {
        args.direction = (const double *)tile->camera.across + (size_t)3 * GLINT_GROUP * (g % tile->groups_across);
        args.more = (const double *)tile->camera.down + (size_t)3 * GLINT_GROUP * (g / tile->groups_across);
    }
    frame->stages->eyes(&args);
}

/// Returns the lanes of `rest` in group g with the same material as the first of these lanes.
static unsigned lanes_of_material(const glint_tile *tile, uint32_t g, unsigned rest, uint32_t *material)
{
    const uint32_t *of = tile->surface.material + (size_t)g * GLINT_GROUP;
    *material = of[__builtin_ctz(rest)];
    return glint_lanes_equal(of, rest);
}

/// Returns whether the derivatives of a group read the viewer's direction: for highlights, moving views and secondary
/// rays.
static bool reads_eyes(const glint_tile *tile, const glint_plan *plan, uint32_t g)
{
    const glint_plan_derivatives *all = plan->derivatives;
    bool reads = all->bends || plan->runs[GLINT_STAGE_BOUNCE];
    for (unsigned rest = tile->at.hits[g], lanes; rest && !reads; rest &= ~lanes) {
        uint32_t material;
        lanes = lanes_of_material(tile, g, rest, &material);
        for (size_t k = 0; k < all->count; k++)
            reads = reads || all->of[k].materials[material].highlight != GLINT_HIGHLIGHT_NONE;
        reads = reads || plan->materials[material].planes & GLINT_PLANE_SHADED;
    }
    return reads;
}

static void gather_points(glint_tile *tile, const glint_tile_frame *frame, uint32_t g)
{
    glint_derivative_work *work = glint_derivative_of(tile);
    const glint_precision precision = frame->plan->desc.precision;
    const size_t at = (size_t)g * GLINT_GROUP;
    if (reads_eyes(tile, frame->plan, g))
        find_eyes(tile, frame, g);
    for (int c = 0; c < 3 && precision == GLINT_PRECISION_FLOAT; c++) {
        glint_reals_of(tile->surface.point[c], precision, g, work->point[c] + at);
        glint_reals_of(tile->surface.normal[c], precision, g, work->normal[c] + at);
    }
}

void glint_derivative_find_points(const glint_tile *tile, const glint_tile_frame *frame, uint32_t g, glint_derivative_points *out)
{
    const glint_derivative_work *work = glint_derivative_of(tile);
    const bool is_float = frame->plan->desc.precision == GLINT_PRECISION_FLOAT;
    const size_t at = (size_t)g * GLINT_GROUP;
    for (int c = 0; c < 3; c++) {
        out->point[c] = (is_float ? work->point[c] : tile->surface.point[c]) + at;
        out->normal[c] = (is_float ? work->normal[c] : tile->surface.normal[c]) + at;
        out->eye[c] = work->eye[c] + at;
        for (int quantity = 0; quantity < 3; quantity++)
            out->slope[quantity][c] = NULL;
    }
}

// ---- Lights -------------------------------------------------------------------------------------------------------

/// Returns a light in the form that kernels read, the same for all groups. The position of a plain light is copied to
/// every lane. For GLINT_EMIT_CONE, glint_derivative_take_cone fills in each group.
static glint_derivative_source source_of(glint_tile *tile, const glint_plan_light *light)
{
    glint_derivative_work *work = glint_derivative_of(tile);
    const glint_light_sample *sample = glint_tile_light_sample_of(tile, light);
    glint_derivative_source out = { .weight = NULL };
    for (int c = 0; c < 3; c++) {
        out.position[c] = sample ? sample->position[c] : work->position[c];
        out.normal[c] = sample ? sample->normal[c] : work->position[c]; // not read for a plain light
        for (int i = 0; i < GLINT_GROUP && !sample; i++)
            work->position[c][i] = light->position[c];
    }
    out.both = sample && sample->emission == GLINT_EMIT_RADIANT_BOTH;
    out.radiant = out.both || (sample && sample->emission == GLINT_EMIT_RADIANT_FRONT);
    return out;
}

void glint_derivative_take_cone(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light,
                                const glint_derivative_points *points, glint_derivative_source *out)
{
    glint_derivative_work *work = glint_derivative_of(tile);
    const glint_light_sample *sample = glint_tile_light_sample_of(tile, light);
    const bool is_float = frame->plan->desc.precision == GLINT_PRECISION_FLOAT;
    for (uint32_t i = 0; i < GLINT_GROUP; i++) {
        const double at[3] = { points->point[0][i], points->point[1][i], points->point[2][i] };
        const double normal[3] = { points->normal[0][i], points->normal[1][i], points->normal[2][i] };
        const glint_cone_sample own = glint_cone_at(
            sample, light->scale, is_float ? GLINT_CONE_SLACK_FLOAT : GLINT_CONE_SLACK_DOUBLE, at, normal, i);
        for (int c = 0; c < 3; c++)
            work->position[c][i] = at[c] + own.direction[c] * own.far;
        work->weight[i] = own.weight;
    }
    for (int c = 0; c < 3; c++)
        out->position[c] = work->position[c];
    out->weight = work->weight;
}

void glint_derivative_take_tint(const glint_tile *tile, size_t index, uint32_t g, glint_derivative_source *out)
{
    const glint_derivative_work *work = glint_derivative_of(tile);
    for (int c = 0; c < 3; c++) {
        out->tint[c] = work->tint[c] + (size_t)g * GLINT_GROUP;
        out->tint_slope[c] = work->tint_slope[index][c] + (size_t)g * GLINT_GROUP;
    }
}

// ---- Results of programs -------------------------------------------------------------------------------------------

static void take_field(const glint_tile *tile, const glint_plan *plan, size_t index, int field, int which, uint32_t g,
                       glint_derivative_planes *out)
{
    glint_derivative_work *work = glint_derivative_of(tile);
    for (int c = 0; c < glint_field_channels(field); c++) {
        glint_reals_of(glint_plane_of(tile->at.planes, plan, field, c), GLINT_PRECISION_FLOAT, g, work->planes[which + c]);
        const double *slope = glint_derivative_painted(tile, plan, index, field, c);
        out->value[which + c] = work->planes[which + c];
        out->slope[which + c] = slope ? slope + (size_t)g * GLINT_GROUP : NULL;
    }
}

/// Returns the planes of a material in group g for derivative number `index`. NULL: all fields of the material are
/// constants.
static const glint_derivative_planes *planes_of(const glint_tile *tile, const glint_plan *plan, size_t index,
                                                uint32_t material, uint32_t g, glint_derivative_planes *buffer)
{
    const uint32_t planes = plan->materials[material].planes;
    if (!planes)
        return NULL;
    *buffer = (glint_derivative_planes) { .value = { NULL }, .slope = { NULL } };
    if (planes & GLINT_PLANE_DIFFUSE)
        take_field(tile, plan, index, GLINT_FIELD_DIFFUSE, GLINT_DERIVED_DIFFUSE, g, buffer);
    if (planes & GLINT_PLANE_SPECULAR)
        take_field(tile, plan, index, GLINT_FIELD_SPECULAR, GLINT_DERIVED_SPECULAR, g, buffer);
    if (planes & GLINT_PLANE_SHININESS)
        take_field(tile, plan, index, GLINT_FIELD_SHININESS, GLINT_DERIVED_SHININESS, g, buffer);
    if (planes & GLINT_PLANE_ALPHA)
        take_field(tile, plan, index, GLINT_FIELD_ROUGHNESS, GLINT_DERIVED_ALPHA, g, buffer);
    return buffer;
}

/// Returns a program's result for the ambient reflectance of sample i in channel c; 1 if the material's ambient
/// reflectance is a constant.
static double ambient_plane(const glint_tile *tile, const glint_plan *plan, uint32_t i, int c)
{
    const uint32_t planes = plan->materials[tile->surface.material[i]].planes;
    if (planes & GLINT_PLANE_AMBIENT_IS_DIFFUSE)
        return (double)glint_plane_of(tile->at.planes, plan, GLINT_FIELD_DIFFUSE, c)[i];
    return planes & GLINT_PLANE_AMBIENT ? (double)glint_plane_of(tile->at.planes, plan, GLINT_FIELD_AMBIENT, c)[i] : 1;
}

/// Adds the slope of the ambient light in channel c for the lanes `hits` of group g and derivative number `index`.
static void add_ambient(const glint_tile *tile, const glint_plan *plan, size_t index, uint32_t g, unsigned hits, int c)
{
    const glint_plan_derivative *d = &plan->derivatives->of[index];
    const double *diffuse = d->repaints ? glint_derivative_painted(tile, plan, index, GLINT_FIELD_DIFFUSE, c) : NULL;
    const double *ambient = d->repaints ? glint_derivative_painted(tile, plan, index, GLINT_FIELD_AMBIENT, c) : NULL;
    for (unsigned bits = hits; bits; bits &= bits - 1) {
        const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits), material = tile->surface.material[i];
        const uint32_t planes = plan->materials[material].planes;
        const glint_dual own = d->materials[material].ambient[c];
        const double *painted = planes & GLINT_PLANE_AMBIENT_IS_DIFFUSE ? diffuse : planes & GLINT_PLANE_AMBIENT ? ambient : NULL;
        if (own.slope != 0)
            glint_derivative_of(tile)->sum[index][c][i] += own.slope * ambient_plane(tile, plan, i, c);
        if (painted)
            glint_derivative_of(tile)->sum[index][c][i] += own.value * painted[i];
    }
}

// ---- One light ----------------------------------------------------------------------------------------------------

/// Adds the derivatives of one light in a group. `reached`: lanes that the light reaches; `tinted`: through
/// transparent surfaces.
static void derive_group(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light, uint32_t slot,
                         glint_derivative_source source, uint32_t g, unsigned reached,
                         bool tinted)
{
    glint_derivative_work *work = glint_derivative_of(tile);
    const glint_plan_derivatives *all = frame->plan->derivatives;
    const glint_light_sample *sample = glint_tile_light_sample_of(tile, light);
    const size_t at = (size_t)g * GLINT_GROUP;
    const bool weighs = glint_derivatives_read_light(tile, frame->plan);
    glint_derivative_points points, bent_points;
    double *bent[9];
    glint_derivative_find_points(tile, frame, g, &points);
    glint_derivative_find_points(tile, frame, g, &bent_points);
    for (int i = 0; i < 9 && all->bends; i++)
        bent_points.slope[i / 3][i % 3] = bent[i] = work->bend[i / 3][i % 3];
    if (sample && sample->emission == GLINT_EMIT_CONE)
        glint_derivative_take_cone(tile, frame, light, &points, &source);
    for (int i = 0; i < GLINT_GROUP && light->cap && light->shadows; i++) {
        work->weight[i] = (double)tile->at.light[slot].visible[at + (size_t)i];
        source.weight = work->weight;
    }
    for (unsigned pending = reached, lanes; pending; pending &= ~lanes) {
        uint32_t material;
        lanes = lanes_of_material(tile, g, pending, &material);
        for (size_t k = 0; k < all->count && !(frame->plan->materials[material].planes & GLINT_PLANE_SHADED); k++) {
            glint_slope_args args = { .light = &all->of[k].lights[light->source],
                                      .material = &all->of[k].materials[material],
                                      .source = &source };
            glint_derivative_planes buffer;
            args.planes = planes_of(tile, frame->plan, k, material, g, &buffer);
            if (tinted)
                glint_derivative_take_tint(tile, k, g, &source);
            for (int c = 0; c < 3; c++) {
                args.sum[c] = work->sum[k][c] + at;
                args.whole[c] = weighs && k == 0 ? work->light[c] + at : NULL;
            }
            args.lanes = all->of[k].bends ? glint_bend_points(tile, frame, k, g, lanes, &points, bent) : 0;
            args.points = &bent_points;
            const unsigned rest = lanes & ~args.lanes;
            if (args.lanes)
                frame->stages->slope(&args);
            args.lanes = rest;
            args.points = &points;
            if (rest && (tinted || args.whole[0] || args.light->varies || args.material->varies))
                frame->stages->slope(&args);
        }
    }
}

/// Returns whether all of `lanes` have shaders.
static bool are_shaded(const glint_tile *tile, const glint_plan *plan, uint32_t g, unsigned lanes)
{
    bool all = plan->patterns && plan->patterns->shaders;
    for (unsigned rest = lanes, same; rest && all; rest &= ~same) {
        uint32_t material;
        same = lanes_of_material(tile, g, rest, &material);
        all = plan->materials[material].planes & GLINT_PLANE_SHADED;
    }
    return all;
}

/// Returns whether a derivative moves the shadows of a light.
static bool moves(const glint_plan_derivatives *all, uint32_t source)
{
    bool any = false;
    for (size_t k = 0; all->moves && k < all->count; k++)
        any = any || all->of[k].lights[source].moves || all->of[k].bends;
    return any;
}

/// Records the shadowed lanes of a light: above the horizon, but not reached by the light.
static void note_shadows(glint_tile *tile, const glint_plan_light *light, uint32_t g, unsigned lit, unsigned unoccluded)
{
    glint_derivative_work *work = glint_derivative_of(tile);
    uint32_t *shadows = work->shadows + (size_t)g * GLINT_GROUP;
    const unsigned occluded = lit & ~unoccluded, fresh = occluded & ~(light->joined ? work->occluded[g] : 0u);
    if (!light->joined)
        work->occluded[g] = work->unoccluded[g] = 0;
    work->occluded[g] |= (uint16_t)occluded;
    work->unoccluded[g] |= (uint16_t)unoccluded;
    work->mixed[g] |= work->occluded[g] & work->unoccluded[g];
    for (unsigned rest = fresh; rest; rest &= rest - 1) {
        uint32_t *hash = &shadows[__builtin_ctz(rest)];
        *hash = (*hash ^ (light->source + 1)) * GLINT_SHADOW_MIXER;
    }
}

static void derive_light(glint_tile *tile, const glint_tile_frame *frame, uint32_t row, uint32_t slot)
{
    const glint_plan_light *light = &frame->plan->lights[row];
    const uint16_t *sampled = frame->plan->runs[GLINT_STAGE_VERTEX_SHADING] ? tile->at.sampled : tile->at.hits;
    const uint16_t *lit = tile->at.light[slot].lit;
    const uint16_t *open = light->shadows ? tile->at.light[slot].unoccluded : lit;
    const bool shift = light->shadows && moves(frame->plan->derivatives, light->source);
    const glint_derivative_source source = source_of(tile, light);
    uint16_t lanes[GLINT_TILE_GROUPS];
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const unsigned hits = sampled[g] & tile->active[g], above = hits ? lit[g] & hits : 0;
        const unsigned reached = above ? open[g] & above : 0;
        const unsigned dimmed = reached && light->shadows && frame->plan->absorbs_transmitted ? glint_tile_dim_lanes(tile, g) : 0;
        if (shift)
            note_shadows(tile, light, g, above, reached);
        lanes[g] = (uint16_t)(reached & ~dimmed);
        if (lanes[g] && !are_shaded(tile, frame->plan, g, lanes[g]))
            derive_group(tile, frame, light, slot, source, g, lanes[g], false);
    }
    const glint_derivative_reach reach = { light, slot, &source, lanes, false };
    if (glint_tile_shows_shader(tile, frame->plan))
        glint_derive_shaders(tile, frame, &reach);
}

// ---- Light through transparent objects ----------------------------------------------------------------------------

void glint_tile_begin_tints(const glint_tile *tile, const glint_plan *plan)
{
    memset(glint_derivative_of(tile)->ray_tint, 0, plan->derivatives->count * sizeof *glint_derivative_of(tile)->ray_tint);
}

void glint_tile_derive_tint(const glint_tile *tile, const glint_plan *plan, uint32_t material, uint32_t ray, int c,
                            double color, double share, double transmitted)
{
    for (size_t k = 0; k < plan->derivatives->count; k++) {
        double *slope = &glint_derivative_of(tile)->ray_tint[k][c][ray];
        const glint_derivative_bounce *bounce = &plan->derivatives->of[k].bounces[material];
        *slope = (*slope * share + color * (bounce->transmission[c] + bounce->clear)) * transmitted;
    }
}

void glint_tile_put_tint(const glint_tile *tile, const glint_plan *plan, uint32_t i, uint32_t ray,
                         const double (*color)[GLINT_TILE_SAMPLES])
{
    glint_derivative_work *work = glint_derivative_of(tile);
    for (int c = 0; c < 3; c++) {
        work->tint[c][i] = color[c][ray];
        for (size_t k = 0; k < plan->derivatives->count; k++)
            work->tint_slope[k][c][i] = work->ray_tint[k][c][ray];
    }
}

void glint_tile_derive_tinted(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light, uint32_t slot,
                              const uint16_t *reached)
{
    const glint_derivative_source source = source_of(tile, light);
    uint16_t lanes[GLINT_TILE_GROUPS];
    for (uint32_t g = 0; g < tile->group_count; g++) {
        lanes[g] = reached[g] & tile->active[g];
        if (lanes[g] && !are_shaded(tile, frame->plan, g, lanes[g]))
            derive_group(tile, frame, light, slot, source, g, lanes[g], true);
    }
    const glint_derivative_reach reach = { light, slot, &source, lanes, true };
    if (glint_tile_shows_shader(tile, frame->plan))
        glint_derive_shaders(tile, frame, &reach);
}

// ---- A sample -----------------------------------------------------------------------------------------------------

/// Starts the derivatives of a group with the part that does not depend on lights.
static void begin_group(glint_tile *tile, const glint_tile_frame *frame, uint32_t g)
{
    glint_derivative_work *work = glint_derivative_of(tile);
    const glint_plan_derivatives *all = frame->plan->derivatives;
    const unsigned covered = tile->at.hits[g] | glint_tile_sees_lights(tile, frame->plan, g);
    const unsigned sky = tile->transparent ? 0 : tile->active[g] & ~covered;
    for (size_t k = 0; k < all->count; k++)
        for (int c = 0; c < 3; c++) {
            add_ambient(tile, frame->plan, k, g, tile->at.hits[g], c);
            for (unsigned bits = all->of[k].background[c] != 0 ? sky : 0; bits; bits &= bits - 1)
                work->sum[k][c][g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits)] += all->of[k].background[c];
        }
}

/// Starts the light of hits with the part that does not depend on lights, if it is read.
static void begin_light(glint_tile *tile, const glint_tile_frame *frame, uint32_t g)
{
    for (uint32_t i = g * GLINT_GROUP; i < (g + 1) * GLINT_GROUP; i++)
        for (int c = 0; c < 3; c++)
            glint_derivative_of(tile)->light[c][i] =
                glint_has_lane(tile->at.hits, i) && !glint_derives_shading_points(tile)
                    ? frame->plan->derivatives->of[0].materials[tile->surface.material[i]].ambient[c].value *
                          ambient_plane(tile, frame->plan, i, c)
                    : 0;
}

/// After a sample: finds the pixels whose hidden lights differ from the first sample's.
static void end_shadows(glint_tile *tile, bool is_first)
{
    glint_derivative_work *work = glint_derivative_of(tile);
    const uint32_t count = tile->group_count * GLINT_GROUP;
    if (is_first) {
        memcpy(work->first, work->shadows, count * sizeof *work->first);
        return;
    }
    for (uint32_t i = 0; i < count; i++)
        if (work->shadows[i] != work->first[i])
            work->mixed[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
}

static void fill_group(uint32_t out[GLINT_GROUP], uint32_t number)
{
    for (int i = 0; i < GLINT_GROUP; i++)
        out[i] = number;
}

/// Starts the hashes of group g with its surfaces, if these move.
static void begin_shadows(const glint_tile *tile, const glint_tile_frame *frame, uint32_t g)
{
    uint32_t *shadows = glint_derivative_of(tile)->shadows + (size_t)g * GLINT_GROUP;
    const uint32_t *prims = tile->at.prim + (size_t)g * GLINT_GROUP;
    fill_group(shadows, NO_SHADOWS);
    for (unsigned pending = frame->plan->derivatives->bends ? tile->at.hits[g] : 0, same; pending; pending &= ~same) {
        const uint32_t prim = prims[__builtin_ctz(pending)];
        const uint32_t hash = (NO_SHADOWS ^ (frame->geometry.prims[prim].id + 1)) * GLINT_SHADOW_MIXER;
        same = glint_lanes_equal(prims, pending);
        if (same == 0xffff) // the common case
            fill_group(shadows, hash);
        for (unsigned rest = same == 0xffff ? 0 : same; rest; rest &= rest - 1)
            shadows[__builtin_ctz(rest)] = hash;
    }
}

static void begin_sample(glint_tile *tile, const glint_tile_frame *frame)
{
    glint_derivative_work *work = glint_derivative_of(tile);
    const glint_plan_derivatives *all = frame->plan->derivatives;
    const size_t count = tile->group_count * (size_t)GLINT_GROUP;
    if (tile->sample == 0 || tile->batch) {
        memset(work->mixed, 0, tile->group_count * sizeof *work->mixed);
        for (size_t k = 0; k < all->count; k++)
            for (int c = 0; c < 3; c++)
                memset(work->sum[k][c], 0, count * sizeof **work->sum[k]);
    } else if (all->moves) {
        end_shadows(tile, tile->sample == 1);
    }
    if (all->repaints)
        glint_derivative_repaint(tile, frame);
    if (all->bends)
        glint_bend_aim(tile, frame->plan);
    for (uint32_t g = 0; g < tile->group_count; g++) {
        if (tile->sample == 0 && !tile->batch && !glint_derives_shading_points(tile))
            glint_tile_prefetch_derivatives(tile, frame, g);
        if (all->everywhere && !glint_derives_shading_points(tile))
            begin_group(tile, frame, g);
        if (tile->at.hits[g])
            gather_points(tile, frame, g);
        if (glint_derivatives_read_light(tile, frame->plan))
            begin_light(tile, frame, g);
        if (all->moves)
            begin_shadows(tile, frame, g);
    }
}

void glint_tile_derive(glint_tile *tile, const glint_tile_frame *frame, uint32_t from, uint32_t count)
{
    if (from == 0)
        begin_sample(tile, frame);
    for (uint32_t i = 0; i < count; i++)
        derive_light(tile, frame, from + i, i);
}

// ---- Into the image -----------------------------------------------------------------------------------------------

static void store_shadows(glint_tile *tile, const glint_tile_frame *frame)
{
    glint_derivative_work *work = glint_derivative_of(tile);
    end_shadows(tile, frame->plan->desc.samples == 1);
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned rest = work->mixed[g]; rest; rest &= rest - 1)
            work->first[g * GLINT_GROUP + (unsigned)__builtin_ctz(rest)] = 0;
    if (frame->base)
        glint_tile_take_plane(tile, frame, frame->base->shadows, work->first);
    glint_tile_store_plane(tile, work->first, frame->image->shadows, frame->image->width);
}

void glint_tile_store_derivatives(glint_tile *tile, const glint_tile_frame *frame)
{
    glint_derivative_work *work = glint_derivative_of(tile);
    const glint_plan *plan = frame->plan;
    const double share = 1.0 / plan->desc.samples;
    double (*sum)[3][GLINT_TILE_SAMPLES] = plan->runs[GLINT_STAGE_DEPTH_CUE] ? work->faded : work->sum;
    for (size_t k = 0; k < plan->derivatives->count; k++)
        for (int c = 0; c < 3; c++) {
            float *plane = frame->image->plane[GLINT_PASS_DERIVATIVE + k][c];
            for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++)
                work->plane[i] = (float)(sum[k][c][i] * share);
            if (frame->base)
                glint_tile_take_plane(tile, frame, frame->base->plane[GLINT_PASS_DERIVATIVE + k][c], work->plane);
            if (plane)
                glint_tile_store_plane(tile, work->plane, plane, frame->image->width);
        }
    if (plan->derivatives->moves)
        store_shadows(tile, frame);
}
