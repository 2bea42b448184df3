/// A background computed by a program, which runs for the rays of a tile or batch that hit nothing, at the point
/// where `shade` would add a plain background.
///
/// Directions are normalised in double, by the same code for every instruction set; a kernel runs the programs.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/render/effects/environment/directions.h"
#include "engine/render/effects/environment/plan.h"
#include "engine/render/pattern/inputs.h"
#include "engine/render/program/program.h"
#include "engine/render/paths/batch.h"

#include <stdlib.h>
#include <string.h>

#define TURN 0x1.921fb54442d18p+2 // 2 pi

struct glint_environment {
    glint_pattern_inputs inputs;
    _Alignas(64) double shown[3][GLINT_PROGRAM_LANES];
    double *rows; ///< scratch of the kernel
};

void *glint_environment_create(const glint_plan *plan)
{
    struct glint_environment *environment = glint_alloc(1, sizeof *environment);
    if (!environment)
        return NULL;
    environment->rows =
        glint_alloc((size_t)plan->environment->row_count * GLINT_PROGRAM_LANES, sizeof *environment->rows);
    if (environment->rows)
        return environment;
    free(environment);
    return NULL;
}

void glint_environment_destroy(void *memory)
{
    struct glint_environment *environment = memory;
    if (environment)
        free(environment->rows);
    free(environment);
}

/// Returns the lanes of a group whose rays leave the scene.
static uint16_t leaving(const glint_tile *tile, const glint_plan *plan, uint32_t g)
{
    return (uint16_t)(tile->active[g] & ~(tile->at.hits[g] | glint_tile_sees_lights(tile, plan, g)));
}

bool glint_tile_sees_environment(const glint_tile *tile)
{
    unsigned any = 0;
    for (uint32_t g = 0; g < tile->group_count && !tile->transparent; g++)
        any |= tile->active[g] & (unsigned)~tile->at.hits[g];
    return any;
}

// ---- Inputs of the programs ----

/// Loads sixteen numbers from an array of real.
static void load_group(const void *array, glint_precision precision, size_t at, double out[GLINT_GROUP])
{
    if (precision == GLINT_PRECISION_DOUBLE)
        memcpy(out, (const double *)array + at, GLINT_GROUP * sizeof *out);
    for (uint32_t i = 0; i < GLINT_GROUP && precision == GLINT_PRECISION_FLOAT; i++)
        out[i] = (double)((const float *)array)[at + i];
}

/// Loads the directions of a group's rays, not normalised: see glint_tile_direction.
static void load_directions(const glint_tile *tile, glint_precision precision, uint32_t g, double d[3][GLINT_GROUP])
{
    const size_t across = glint_tile_has_arrays(tile) ? 1 : tile->groups_across, x = g % across, y = g / across;
    for (size_t c = 0; c < 3; c++) {
        double down[GLINT_GROUP];
        if (glint_tile_has_arrays(tile)) {
            load_group(tile->rays.direction[c], precision, (size_t)g * GLINT_GROUP, d[c]);
            continue;
        }
        load_group(tile->camera.across, precision, (3 * x + c) * GLINT_GROUP, d[c]);
        load_group(tile->camera.down, precision, (3 * y + c) * GLINT_GROUP, down);
        for (uint32_t i = 0; i < GLINT_GROUP; i++)
            d[c][i] += down[i];
        for (uint32_t i = 0; i < GLINT_GROUP && precision == GLINT_PRECISION_FLOAT; i++)
            d[c][i] = (double)(float)d[c][i];
    }
}

/// Writes the directions of sixteen rays into group `to` of the rows. pixel: the angle to filter over.
static void put_directions(struct glint_environment *environment, double pixel, const double d[3][GLINT_GROUP],
                           uint32_t to)
{
    double length[GLINT_GROUP];
    const uint32_t at = to * GLINT_GROUP;
    double(*row)[GLINT_PROGRAM_LANES] = environment->inputs.row;
    for (uint32_t i = 0; i < GLINT_GROUP; i++)
        length[i] = sqrt((d[0][i] * d[0][i] + d[1][i] * d[1][i]) + d[2][i] * d[2][i]);
    for (int c = 0; c < 3; c++) {
        double *p = row[GLINT_INPUT_P_X + c] + at, *n = row[GLINT_INPUT_N_X + c] + at;
        for (uint32_t i = 0; i < GLINT_GROUP; i++)
            p[i] = d[c][i] / length[i];
        for (uint32_t i = 0; i < GLINT_GROUP; i++)
            n[i] = -p[i];
        memcpy(row[GLINT_INPUT_WORLD_X + c] + at, p, sizeof *d);
        memcpy(row[GLINT_INPUT_V_X + c] + at, n, sizeof *d);
    }
    for (uint32_t i = 0; i < GLINT_GROUP; i++) {
        row[GLINT_INPUT_FOOTPRINT][at + i] = pixel;
        const double x = row[GLINT_INPUT_P_X][at + i], z = row[GLINT_INPUT_P_Z][at + i];
        row[GLINT_INPUT_UV_FOOTPRINT][at + i] = pixel / TURN;
        row[GLINT_INPUT_UV_FOOTPRINT_U][at + i] = pixel > 0 ? fmin(pixel / (TURN * sqrt(x * x + z * z)), 1) : 0;
        row[GLINT_INPUT_UV_FOOTPRINT_V][at + i] = pixel / (TURN / 2);
    }
}

static void run(const struct glint_environment *environment, const glint_stages *stages, const glint_program *program,
                glint_program_args *args)
{
    args->code = &program->code;
    args->rows = environment->rows;
    for (int input = 0; input < GLINT_INPUT_COUNT; input++)
        args->input[input] = environment->inputs.row[input];
    stages->program(args);
}

/// Runs the program for `count` groups of the rows.
static void run_rows(struct glint_environment *environment, const glint_plan_environment *own,
                     const glint_stages *stages, const uint16_t *lanes, uint32_t count)
{
    glint_program_args args = { .group_count = count, .wanted = lanes };
    if (own->uv) {
        args.result[0] = environment->inputs.row[GLINT_INPUT_UV_U];
        args.result[1] = environment->inputs.row[GLINT_INPUT_UV_V];
        run(environment, stages, own->uv, &args);
        args.result[1] = NULL;
    }
    for (uint32_t c = 0; c < own->program->code.output_count; c++)
        args.result[c] = environment->shown[c];
    run(environment, stages, own->program, &args);
}

void glint_environment_evaluate(struct glint_environment *environment, const glint_plan_environment *own,
                                const glint_stages *stages, double pixel, double (*d)[3][GLINT_GROUP], uint32_t groups,
                                double *brightness)
{
    uint16_t lanes[GLINT_PROGRAM_GROUPS] = { 0 };
    for (uint32_t g = 0; g < groups; g++) {
        lanes[g] = UINT16_MAX;
        put_directions(environment, pixel, (const double(*)[GLINT_GROUP])d[g], g);
    }
    run_rows(environment, own, stages, lanes, groups);
    for (uint32_t i = 0; i < groups * GLINT_GROUP; i++) {
        brightness[i] = 0;
        for (uint32_t c = 0; c < own->program->code.output_count; c++)
            brightness[i] += fmin(fmax(environment->shown[c][i], 0), GLINT_REFLECTANCE_MAX);
    }
}

// ---- Results ----

/// Records the lanes of group `from` of the rows where the program gave an invalid light.
static void note_odd(glint_tile *tile, const struct glint_environment *environment, uint32_t channels, uint32_t from,
                     unsigned lanes)
{
    for (; lanes; lanes &= lanes - 1) {
        const uint32_t at = from * GLINT_GROUP + (uint32_t)__builtin_ctz(lanes);
        glint_odd_pattern one = { .field = GLINT_FIELD_BACKGROUND };
        for (uint32_t c = 0; c < channels; c++)
            one.count |= !(environment->shown[c][at] >= 0 && environment->shown[c][at] <= GLINT_REFLECTANCE_MAX);
        for (int c = 0; c < 3; c++)
            one.point[c] = environment->inputs.row[GLINT_INPUT_P_X + c][at];
        glint_odd_patterns_note(&tile->counts.odd, &one, &environment->shown[0][at], GLINT_PROGRAM_LANES, channels);
    }
}

/// Loads the light of group `from` of the rows, 0 in other lanes. channels: the number of channels that the program
/// computes; a single channel is used for all three.
static void light_of(glint_tile *tile, const struct glint_environment *environment, uint32_t channels, uint32_t from,
                     unsigned lanes, double light[3][GLINT_GROUP])
{
    double wanted[GLINT_GROUP], odd[GLINT_GROUP] = { 0 };
    bool any = false;
    for (uint32_t i = 0; i < GLINT_GROUP; i++)
        wanted[i] = lanes >> i & 1 ? GLINT_REFLECTANCE_MAX : 0;
    for (uint32_t c = 0; c < 3; c++) {
        const double *shown = environment->shown[c < channels ? c : 0] + from * GLINT_GROUP;
        for (uint32_t i = 0; i < GLINT_GROUP; i++)
            light[c][i] = shown[i] > 0 ? shown[i] : 0;
        for (uint32_t i = 0; i < GLINT_GROUP; i++)
            light[c][i] = light[c][i] < GLINT_REFLECTANCE_MAX ? light[c][i] : GLINT_REFLECTANCE_MAX;
        for (uint32_t i = 0; i < GLINT_GROUP; i++)
            odd[i] += light[c][i] == shown[i] ? 0 : 1;
        for (uint32_t i = 0; i < GLINT_GROUP; i++)
            light[c][i] = light[c][i] < wanted[i] ? light[c][i] : wanted[i];
    }
    for (uint32_t i = 0; i < GLINT_GROUP; i++)
        any = any || odd[i] > 0;
    if (any)
        note_odd(tile, environment, channels, from, lanes);
}

/// Adds group `from` of the rows to group g of the tile.
static void add_group(glint_tile *tile, const struct glint_environment *environment, uint32_t channels, uint32_t g,
                      uint32_t from, unsigned lanes)
{
    double light[3][GLINT_GROUP];
    light_of(tile, environment, channels, from, lanes, light);
    for (uint32_t c = 0; c < 3; c++) {
        double *sum = tile->film.sum[GLINT_TERM_BACKGROUND][c] + g * GLINT_GROUP;
        for (uint32_t i = 0; i < GLINT_GROUP; i++)
            sum[i] += light[c][i];
    }
}

/// Runs the program for groups of a tile and their lanes.
static void run_groups(glint_tile *tile, const glint_tile_frame *frame, const uint32_t *groups, const uint16_t *lanes,
                       uint32_t count)
{
    struct glint_environment *environment = tile->own[GLINT_STAGE_ENVIRONMENT];
    const uint32_t channels = frame->plan->environment->program->code.output_count;
    for (uint32_t k = 0; k < count; k++) {
        double d[3][GLINT_GROUP];
        load_directions(tile, frame->plan->desc.precision, groups[k], d);
        put_directions(environment, frame->plan->environment->pixel, (const double(*)[GLINT_GROUP])d, k);
    }
    run_rows(environment, frame->plan->environment, frame->stages, lanes, count);
    for (uint32_t k = 0; k < count; k++)
        add_group(tile, environment, channels, groups[k], k, lanes[k]);
}

/// Adds the background of the rays that leave the scene to the sums.
static void add_background(glint_tile *tile, const glint_tile_frame *frame, const glint_shade_args *args, uint32_t from,
                           uint32_t count_of_lights)
{
    uint32_t groups[GLINT_PROGRAM_GROUPS], count = 0;
    uint16_t lanes[GLINT_PROGRAM_GROUPS];
    (void)from, (void)count_of_lights;
    if (tile->transparent || !args->first)
        return;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        lanes[count] = leaving(tile, frame->plan, g);
        tile->counts.work.environment += (uint64_t)__builtin_popcount(lanes[count]);
        groups[count] = g;
        count += lanes[count] != 0;
        if (count == GLINT_PROGRAM_GROUPS || (count > 0 && g + 1 == tile->group_count)) {
            run_groups(tile, frame, groups, lanes, count);
            count = 0;
        }
    }
    glint_tile_count_stage(tile, frame, GLINT_STAGE_ENVIRONMENT, false);
}

// ---- Rays that left surfaces ----

/// Loads the directions of `count` rays, at most a group.
static void load_rays(const glint_rays *rays, glint_precision precision, const uint16_t *ray, uint32_t count,
                      double d[3][GLINT_GROUP])
{
    for (uint32_t i = 0; i < GLINT_GROUP; i++)
        for (int c = 0; c < 3; c++)
            d[c][i] = glint_real_at(rays->direction[c], precision, ray[i < count ? i : 0]);
}

/// Runs the program for `count` rays, at most as many as fit into one call.
static void run_rays(glint_tile *tile, const glint_tile_frame *frame, const glint_rays *rays, const uint16_t *ray,
                     uint32_t count, double (*light)[GLINT_TILE_SAMPLES])
{
    struct glint_environment *environment = tile->own[GLINT_STAGE_ENVIRONMENT];
    const uint32_t groups = (count + GLINT_GROUP - 1) / GLINT_GROUP;
    uint16_t lanes[GLINT_PROGRAM_GROUPS] = { 0 };
    for (uint32_t g = 0; g < groups; g++) {
        const uint32_t first = g * GLINT_GROUP, here = count - first < GLINT_GROUP ? count - first : GLINT_GROUP;
        double d[3][GLINT_GROUP];
        lanes[g] = (uint16_t)((1u << here) - 1);
        load_rays(rays, frame->plan->desc.precision, ray + first, here, d);
        put_directions(environment, frame->plan->environment->pixel, (const double(*)[GLINT_GROUP])d, g);
    }
    run_rows(environment, frame->plan->environment, frame->stages, lanes, groups);
    for (uint32_t g = 0; g < groups; g++) {
        double of[3][GLINT_GROUP];
        light_of(tile, environment, frame->plan->environment->program->code.output_count, g, lanes[g], of);
        for (uint32_t i = g * GLINT_GROUP; i < count && i < (g + 1) * GLINT_GROUP; i++)
            for (int c = 0; c < 3; c++)
                light[c][ray[i]] = of[c][i % GLINT_GROUP];
    }
}

/// Computes the background for rays of a batch that leave the scene.
static void show_missed(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    const glint_rays *rays = walk->batch->rays;
    uint16_t missed[GLINT_TILE_GROUPS], ray[GLINT_PROGRAM_LANES];
    uint32_t count = 0;
    glint_batch_find_missed(walk->batch, missed);
    for (uint32_t g = 0; g < rays->group_count; g++) {
        tile->counts.work.environment += (uint64_t)__builtin_popcount(missed[g]);
        for (unsigned bits = missed[g]; bits; bits &= bits - 1) {
            ray[count++] = (uint16_t)(g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits));
            if (count < GLINT_PROGRAM_LANES)
                continue;
            run_rays(tile, frame, rays, ray, count, walk->batch->shown);
            count = 0;
        }
    }
    if (count)
        run_rays(tile, frame, rays, ray, count, walk->batch->shown);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_ENVIRONMENT, false);
}

static bool called(const glint_plan *plan) { return plan->environment; }

/// Requests the directions of rays that leave the scene.
static void need_directions(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (glint_tile_sees_environment(tile))
        glint_tile_need_rays(tile, frame, walk);
}

/// Replaces the plain background that `shade` reads.
const glint_stage glint_stage_environment = {
    .name = "environment",
    .doc = "the background pattern for rays that leave the scene",
    .prepare = glint_environment_prepare,
    .release = glint_environment_release,
    .called = called,
    .sums = true,
    .remote = true,
    .step = { [GLINT_AFTER_PRIMARY] = need_directions, [GLINT_AT_MISSED] = show_missed },
    .after_shade = add_background,
    .adds = glint_tile_adds_anywhere,
    .create = glint_environment_create,
    .destroy = glint_environment_destroy,
    .sized = true,
    .shared = true,
};
