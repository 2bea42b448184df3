/// The derivatives of shaders: slopes of the inputs times the gradient of the program, plus the slopes of the
/// shader's own numbers.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/render/effects/derivative/work.h"
#include "engine/render/pattern/work.h"
#include "engine/render/program/program.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BITS(first, count) (((1u << (count)) - 1) << (first))

#define VIEWS BITS(GLINT_INPUT_V_X, 3)

/// The slopes for one derivative.
typedef struct input_slopes {
    _Alignas(64) double input[GLINT_INPUT_COUNT][GLINT_PROGRAM_LANES]; ///< slopes of the shader's inputs
    uint32_t slope_inputs; ///< the inputs that have slopes, one bit each
    _Alignas(64) double sum[3][GLINT_PROGRAM_LANES]; ///< slopes of the light
} input_slopes;

/// The memory for the groups of a call.
struct glint_shader_slopes {
    _Alignas(64) double value[GLINT_SHADER_TERMS][GLINT_PROGRAM_LANES]; ///< results of the shader
    _Alignas(64) double tangent[GLINT_SHADER_TERMS][GLINT_PROGRAM_LANES]; ///< derivatives of the results by the
        ///< shader's numbers
    float share[GLINT_PROGRAM_LANES]; ///< visible share of a light that may be partly covered
    uint16_t wanted[GLINT_PROGRAM_GROUPS], odd[GLINT_PROGRAM_GROUPS];
    glint_program_sums sums[GLINT_DERIVATIVES_MAX]; ///< one for each derivative that changes something
    size_t capacity; ///< number of derivatives with memory
    input_slopes of[];
};

/// Groups that show one material, under one light.
typedef struct shading {
    glint_tile *tile;
    const glint_tile_frame *frame;
    const glint_derivative_reach *reach;
    struct glint_shader_slopes *slopes;
    const glint_pattern_lanes *entries;
    uint32_t count;
} shading;

bool glint_derive_shaders_fit(glint_derivative_work *work, const glint_plan *plan)
{
    const size_t wanted = plan->derivatives->count;
    if (!plan->derivatives->gradients || (work->shader && work->shader->capacity >= wanted))
        return true;
    free(work->shader);
    work->shader = glint_alloc(1, sizeof *work->shader + wanted * sizeof *work->shader->of);
    if (work->shader)
        work->shader->capacity = wanted;
    return work->shader;
}

void glint_shader_slopes_free(struct glint_shader_slopes *slopes) { free(slopes); }

// ---- Inputs of a shader --------------------------------------------------------------------------------------------

/// Computes the light's inputs for an entry's group, once for all derivatives, and with `sloped`
/// their slopes by derivative number `index`, next to the points' slopes.
static void find_arrival(const shading *s, size_t index, uint32_t e, const glint_derivative_points *points, bool sloped)
{
    const glint_plan_light *light = s->reach->light;
    const glint_light_sample *sample = glint_tile_light_sample_of(s->tile, light);
    const size_t at = (size_t)s->entries[e].group * GLINT_GROUP, slot = s->reach->slot;
    glint_derivative_work *work = glint_derivative_of(s->tile);
    glint_derivative_source source = *s->reach->source;
    if (sample && sample->emission == GLINT_EMIT_CONE)
        glint_derivative_take_cone(s->tile, s->frame, light, points, &source);
    for (int i = 0; i < GLINT_GROUP && light->cap && light->shadows; i++) {
        const float seen = s->tile->at.light[slot].visible[at + (size_t)i];
        const float whole = light->attenuated ? s->tile->at.light[slot].attenuation[at + (size_t)i] : 1;
        const float weight = s->reach->tinted ? seen : whole; // as in the shader itself
        s->slopes->share[e * GLINT_GROUP + (uint32_t)i] = weight > 0 ? seen / weight : seen;
        work->weight[i] = (double)weight;
        source.weight = work->weight;
    }
    if (s->reach->tinted)
        glint_derivative_take_tint(s->tile, index, s->entries[e].group, &source);
    glint_arrival_args args = { &s->frame->plan->derivatives->of[index].lights[light->source], points, &source, .value = { NULL } };
    const uint32_t read = s->frame->plan->patterns->of[s->entries->material].program[GLINT_FIELD_SHADER]->inputs;
    for (int k = 0; k < GLINT_ARRIVAL_COUNT; k++) {
        const glint_input input = (glint_input)(GLINT_INPUT_L_X + k);
        if (!(read >> input & 1))
            continue;
        if (sloped)
            args.slope[k] = s->slopes->of[index].input[input] + e * GLINT_GROUP;
        if (index == 0)
            args.value[k] = glint_pattern_row(&s->tile->pattern->inputs, input) + e * GLINT_GROUP;
    }
    s->frame->stages->arrival(&args);
}

/// Clears all other lanes.
static void mask_lanes(unsigned lanes, double slope[GLINT_GROUP])
{
    for (unsigned bits = 0xffff & ~lanes; bits; bits &= bits - 1)
        slope[__builtin_ctz(bits)] = 0;
}

/// Returns whether the shader reads points in the shapes' own space.
static bool reads_own_space(const shading *s)
{
    const glint_program *shader = s->frame->plan->patterns->of[s->entries->material].program[GLINT_FIELD_SHADER];
    return shader->inputs & BITS(GLINT_INPUT_P_X, 3);
}

/// Computes the slopes of points in the shapes' own space from those in world space.
static void turn_points(const shading *s, size_t index, uint32_t e)
{
    double (*input)[GLINT_PROGRAM_LANES] = s->slopes->of[index].input;
    const glint_plan *plan = s->frame->plan;
    for (unsigned bits = s->slopes->wanted[e]; bits; bits &= bits - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(bits), i = e * GLINT_GROUP + lane;
        const glint_prim *prim = &s->frame->geometry.prims[s->tile->at.prim[s->entries[e].group * GLINT_GROUP + lane]];
        const glint_pattern_space *space = &plan->patterns->spaces[plan->geometry->prim_part[prim->id]];
        const double world[3] = { input[GLINT_INPUT_WORLD_X][i], input[GLINT_INPUT_WORLD_Y][i], input[GLINT_INPUT_WORLD_Z][i] };
        for (int c = 0; c < 3; c++)
            input[GLINT_INPUT_P_X + c][i] = space->mapped ? vec_dot(space->inverse[c], world) : world[c];
    }
}

/// Computes the slopes of an entry's points and normals, and with `arrives` of the light's inputs.
static void find_entry(const shading *s, size_t index, uint32_t e, bool arrives)
{
    static const int first[3] = { GLINT_INPUT_WORLD_X, GLINT_INPUT_N_X, GLINT_INPUT_V_X };
    const uint32_t g = s->entries[e].group;
    const bool bends = s->frame->plan->derivatives->of[index].bends;
    glint_derivative_points points;
    glint_derivative_find_points(s->tile, s->frame, g, &points);
    if (bends) {
        double *row[9];
        for (int i = 0; i < 9; i++)
            points.slope[i / 3][i % 3] = row[i] = s->slopes->of[index].input[first[i / 3] + i % 3] + e * GLINT_GROUP;
        const unsigned wanted = s->slopes->wanted[e];
        const unsigned bent = wanted ? glint_bend_points(s->tile, s->frame, index, g, wanted, &points, row) : 0;
        for (int i = 0; i < 9 && wanted & ~bent; i++)
            mask_lanes(bent, row[i]);
        if (reads_own_space(s))
            turn_points(s, index, e);
    }
    if (arrives || index == 0)
        find_arrival(s, index, e, &points, arrives);
}

/// Writes the slopes of one field of the material, constant or from a program. Returns false if there are none.
static bool find_number(const shading *s, size_t index, glint_field field, int channel, double slope, double *to)
{
    const glint_plan *plan = s->frame->plan;
    const bool made = plan->patterns->of[s->entries->material].made >> field & 1;
    const double *painted = made ? glint_derivative_painted(s->tile, plan, index, field, channel) : NULL;
    if (made ? !painted : slope == 0)
        return false;
    for (uint32_t e = 0; e < s->count; e++)
        for (uint32_t i = 0; i < GLINT_GROUP; i++)
            to[e * GLINT_GROUP + i] = painted ? painted[s->entries[e].group * GLINT_GROUP + i] : slope;
    return true;
}

/// Computes the slopes of the shader's inputs by derivative number `index`; the first call also computes the light's
/// inputs. Returns the inputs that have slopes, one bit each.
static uint32_t find_inputs(const shading *s, size_t index)
{
    const glint_plan_derivative *d = &s->frame->plan->derivatives->of[index];
    const glint_derivative_material *m = &d->materials[s->entries->material];
    double (*input)[GLINT_PROGRAM_LANES] = s->slopes->of[index].input;
    const bool arrives = d->bends || d->lights[s->reach->light->source].varies || s->reach->tinted;
    uint32_t slope_inputs =
        (arrives ? BITS(GLINT_INPUT_L_X, GLINT_ARRIVAL_COUNT) : 0) | (d->bends ? BITS(GLINT_INPUT_P_X, 12) : 0);
    for (uint32_t e = 0; e < s->count && (slope_inputs || index == 0); e++)
        find_entry(s, index, e, arrives);
    for (int c = 0; c < 3; c++) {
        if (find_number(s, index, GLINT_FIELD_DIFFUSE, c, m->diffuse[c].slope, input[GLINT_INPUT_KD_R + c]))
            slope_inputs |= 1u << (GLINT_INPUT_KD_R + c);
        if (find_number(s, index, GLINT_FIELD_SPECULAR, c, m->specular[c].slope, input[GLINT_INPUT_KS_R + c]))
            slope_inputs |= 1u << (GLINT_INPUT_KS_R + c);
    }
    if (find_number(s, index, GLINT_FIELD_SHININESS, 0, m->shininess.slope, input[GLINT_INPUT_SHININESS]))
        slope_inputs |= 1u << GLINT_INPUT_SHININESS;
    return slope_inputs;
}

// ---- Results --------------------------------------------------------------------------------------------------

static void run(const shading *s, const glint_program *program, double (*to)[GLINT_PROGRAM_LANES])
{
    glint_program_args args = { .group_count = s->count, .wanted = s->slopes->wanted };
    for (uint32_t k = 0; k < program->code.output_count; k++)
        args.result[k] = to[k];
    glint_pattern_call(s->tile->pattern, s->frame, &program->code, 0, &args);
}

/// Adds the shader's results to the light of its samples, clamped like planes.
static void add_light(const shading *s, uint32_t terms)
{
    glint_derivative_work *work = glint_derivative_of(s->tile);
    for (uint32_t k = 0; k < terms; k++)
        for (uint32_t e = 0; e < s->count; e++)
            for (unsigned bits = s->slopes->wanted[e]; bits; bits &= bits - 1) {
                const uint32_t lane = (uint32_t)__builtin_ctz(bits), i = e * GLINT_GROUP + lane;
                const double value = s->slopes->value[k][i];
                work->light[k % 3][s->entries[e].group * GLINT_GROUP + lane] +=
                    value > 0 ? fmin(value, GLINT_REFLECTANCE_MAX) * (double)s->slopes->share[i] : 0;
            }
}

/// Lists the derivatives among first .. end - 1 that need a part of a gradient, namely its slopes from `from` on.
/// Returns their number.
static uint32_t list_sums(const shading *s, const glint_gradient *gradient, uint32_t from, size_t first, size_t end)
{
    uint32_t count = 0;
    for (size_t k = first; k < end; k++) {
        input_slopes *own = &s->slopes->of[k];
        glint_program_sums *sums = &s->slopes->sums[count];
        bool any = false;
        for (uint32_t n = from; n < gradient->count && n < from + gradient->each; n++) {
            const glint_gradient_entry at = gradient->of[n];
            const bool slope_inputs = own->slope_inputs >> at.input & 1;
            sums->by[n - from] = slope_inputs ? own->input[at.input] : NULL;
            sums->sum_of[n - from] = (uint8_t)at.channel;
            any = any || slope_inputs;
        }
        for (int c = 0; c < 3; c++)
            sums->sum[c] = own->sum[c];
        count += any;
    }
    return count;
}

/// Sums up the derivatives of a shader's light by its inputs.
static void sum_up(const shading *s, const glint_gradient *gradient, size_t first, size_t end)
{
    for (uint32_t from = 0; from < gradient->count; from += gradient->each) {
        glint_program_args args = { .group_count = s->count, .wanted = s->slopes->wanted, .sums_alone = true };
        args.sums = s->slopes->sums;
        args.sums_count = list_sums(s, gradient, from, first, end);
        if (args.sums_count)
            glint_pattern_call(s->tile->pattern, s->frame, &gradient->programs[from / gradient->each]->code, 0, &args);
    }
}

/// Adds the derivative by the shader's own numbers.
static void add_tangent(const shading *s, size_t index, const glint_program *tangent)
{
    struct glint_shader_slopes *slopes = s->slopes;
    run(s, tangent, slopes->tangent);
    for (uint32_t k = 0; k < tangent->code.output_count; k++)
        for (uint32_t i = 0; i < s->count * GLINT_GROUP; i++)
            if (slopes->value[k][i] > 0 && slopes->value[k][i] <= GLINT_REFLECTANCE_MAX)
                slopes->of[index].sum[k % 3][i] += slopes->tangent[k][i];
}

/// Adds the sums to the samples' sums. Values without a slope, such as the root of a constant 0, add nothing.
static void add_sums(const shading *s, size_t index)
{
    double (*to)[GLINT_TILE_SAMPLES] = glint_derivative_of(s->tile)->sum[index];
    for (uint32_t e = 0; e < s->count; e++)
        for (int c = 0; c < 3; c++) {
            const float *share = s->slopes->share + e * GLINT_GROUP;
            const double *from = s->slopes->of[index].sum[c] + e * GLINT_GROUP;
            double *sum = to[c] + s->entries[e].group * GLINT_GROUP, slope[GLINT_GROUP];
            for (int i = 0; i < GLINT_GROUP; i++)
                slope[i] = fabs(from[i] * (double)share[i]) < HUGE_VAL ? from[i] * (double)share[i] : 0;
            if (s->slopes->wanted[e] != 0xffff)
                mask_lanes(s->slopes->wanted[e], slope);
            for (int i = 0; i < GLINT_GROUP; i++)
                sum[i] += slope[i];
        }
}

/// Sets the shader's inputs for the directions to the eye to those already computed.
static void find_views(const shading *s)
{
    glint_pattern_inputs *inputs = &s->tile->pattern->inputs;
    bool in_order = true;
    for (uint32_t e = 1; e < s->count; e++)
        in_order = in_order && s->entries[e].group == s->entries[0].group + e;
    for (int c = 0; c < 3; c++) {
        const double *eye = glint_derivative_of(s->tile)->eye[c];
        double *row = glint_pattern_row(inputs, (glint_input)(GLINT_INPUT_V_X + c));
        if (in_order)
            inputs->from[GLINT_INPUT_V_X + c] = eye + (size_t)s->entries[0].group * GLINT_GROUP;
        for (uint32_t e = 0; e < s->count && !in_order; e++)
            memcpy(row + e * GLINT_GROUP, eye + (size_t)s->entries[e].group * GLINT_GROUP, GLINT_GROUP * sizeof *row);
    }
}

/// Gathers the inputs of points and material. Returns false if the light reaches no group.
static bool begin(const shading *s, const glint_pattern_points *points)
{
    unsigned any = 0;
    for (uint32_t e = 0; e < s->count; e++)
        any |= s->slopes->wanted[e] = s->entries[e].lanes & s->reach->lanes[s->entries[e].group];
    if (!any)
        return false;
    for (uint32_t i = 0; i < s->count * GLINT_GROUP; i++)
        s->slopes->share[i] = 1;
    const bool seen =
        !s->tile->batch && !glint_derives_shading_points(s->tile) && s->frame->plan->desc.precision == GLINT_PRECISION_DOUBLE;
    glint_shader_gather(s->tile, s->frame, points, seen ? VIEWS : 0, s->entries, s->count);
    if (seen)
        find_views(s);
    return true;
}

/// Adds the derivative of the light by the shader's inputs, in one forward sweep for derivative number `index`.
/// Returns whether that was all: for the lanes that remain wanted, nothing was added.
static bool sweep(const shading *s, size_t index, const glint_program *forward)
{
    input_slopes *own = &s->slopes->of[index];
    uint32_t groups[GLINT_PROGRAM_GROUPS];
    unsigned odd = 0;
    glint_program_args args = { .group_count = s->count, .wanted = s->slopes->wanted, .groups = groups, .sums_alone = true };
    for (uint32_t e = 0; e < s->count; e++)
        groups[e] = s->entries[e].group;
    for (uint32_t bits = forward->slopes; bits; bits &= bits - 1) {
        const int input = __builtin_ctz(bits);
        if (!(own->slope_inputs >> input & 1))
            memset(own->input[input], 0, s->count * GLINT_GROUP * sizeof(double));
        args.input[GLINT_INPUT_COUNT + input] = own->input[input];
    }
    for (int c = 0; c < 3; c++)
        args.added[c] = glint_derivative_of(s->tile)->sum[index][c];
    args.share = s->slopes->share;
    args.odd = s->slopes->odd;
    glint_pattern_call(s->tile->pattern, s->frame, &forward->code, 0, &args);
    for (uint32_t e = 0; e < s->count; e++)
        odd |= args.odd[e];
    return !odd;
}

/// Adds one or all derivatives of the light, by the gradient and by the shader's own numbers.
static void derive_exactly(const shading *s, size_t from, size_t to)
{
    const glint_plan_derivatives *all = s->frame->plan->derivatives;
    const uint32_t material = s->entries->material;
    for (size_t k = from; k < to; k++)
        for (int c = 0; c < 3; c++)
            memset(s->slopes->of[k].sum[c], 0, s->count * GLINT_GROUP * sizeof(double));
    sum_up(s, &all->gradients[material], from, to);
    for (size_t k = from; k < to; k++) {
        const glint_program *tangent = all->of[k].programs[material].of[GLINT_FIELD_SHADER];
        if (tangent)
            add_tangent(s, k, tangent);
        add_sums(s, k);
    }
}

/// Computes derivative number `index`, by a forward sweep if possible.
static void derive_one(const shading *s, size_t index)
{
    const glint_plan_derivatives *all = s->frame->plan->derivatives;
    const uint32_t material = s->entries->material;
    const glint_gradient *gradient = &all->gradients[material];
    const bool tangent = all->of[index].programs[material].of[GLINT_FIELD_SHADER];
    const glint_program *forward = index < GLINT_FORWARD_MAX && !tangent ? gradient->forward[index] : NULL;
    uint16_t wanted[GLINT_PROGRAM_GROUPS];
    if (forward && !(forward->slopes & s->slopes->of[index].slope_inputs))
        return;
    if (forward && sweep(s, index, forward))
        return;
    memcpy(wanted, s->slopes->wanted, sizeof wanted);
    if (forward)
        memcpy(s->slopes->wanted, s->slopes->odd, sizeof wanted);
    derive_exactly(s, index, index + 1);
    memcpy(s->slopes->wanted, wanted, sizeof wanted);
}

static void derive(const shading *s, const glint_pattern_points *points)
{
    const glint_plan *plan = s->frame->plan;
    const glint_plan_derivatives *all = plan->derivatives;
    const uint32_t material = s->entries->material, source = s->reach->light->source;
    const bool weighs = glint_derivatives_read_light(s->tile, plan);
    bool tangents = false, varies = weighs || s->reach->tinted;
    for (size_t k = 0; k < all->count; k++) {
        tangents = tangents || all->of[k].programs[material].of[GLINT_FIELD_SHADER];
        varies = varies || all->of[k].bends || all->of[k].lights[source].varies || all->of[k].materials[material].varies;
    }
    if (!varies || !begin(s, points))
        return;
    for (size_t k = 0; k < all->count; k++)
        s->slopes->of[k].slope_inputs = find_inputs(s, k);
    if (weighs || tangents)
        run(s, plan->patterns->of[material].program[GLINT_FIELD_SHADER], s->slopes->value);
    if (weighs)
        add_light(s, plan->patterns->of[material].program[GLINT_FIELD_SHADER]->code.output_count);
    if (all->count > GLINT_FORWARD_MAX)
        derive_exactly(s, 0, all->count);
    for (size_t k = 0; k < all->count && all->count <= GLINT_FORWARD_MAX; k++)
        derive_one(s, k);
}

void glint_derive_shaders(glint_tile *tile, const glint_tile_frame *frame, const glint_derivative_reach *reach)
{
    const glint_pattern_points points = glint_shader_find_lanes(tile, frame->plan, tile->at.hits);
    shading s = { tile, frame, reach, glint_derivative_of(tile)->shader, NULL, 0 };
    while ((s.count = glint_pattern_take(tile->pattern, &s.entries)))
        derive(&s, &points);
}
