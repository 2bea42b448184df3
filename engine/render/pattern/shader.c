/// The stage shader: programs that compute the light reflected by a material, instead of the built-in models.
///
/// The groups that show a material are taken sixteen at a time. The inputs of the surface are gathered once, then
/// those of each light, and the program's results are added up in double before the next sixteen come.
#include "engine/render/light_groups/light_groups.h"
#include "engine/render/pattern/work.h"
#include "engine/render/program/program.h"

#include <math.h>
#include <string.h>

/// Inputs that are constant for a material and a light, unless programs compute them.
#define NUMBERS (7u << GLINT_INPUT_KD_R | 7u << GLINT_INPUT_KS_R | 1u << GLINT_INPUT_SHININESS | 7u << GLINT_INPUT_LIGHT_R)

/// Groups that show one material.
typedef struct batch {
    const glint_program *program;
    const glint_pattern_lanes *entries;
    uint32_t groups[GLINT_PROGRAM_GROUPS]; ///< indices of the groups
    uint32_t count;
} batch;

/// The destination of a light's contribution.
typedef enum result { TO_SUMS, TO_TOTALS, TO_PLANES } result;

/// The part of a batch that a light reaches: `count` entries from `first` on, including unlit ones between.
typedef struct reached {
    uint32_t first, count;
    uint16_t lanes[GLINT_PROGRAM_GROUPS]; ///< for each entry of the batch, the lanes that the light reaches
} reached;

static void find_reached(const batch *b, const uint16_t *lit, reached *out)
{
    uint32_t first = 0, end = b->count;
    for (uint32_t k = 0; k < b->count; k++)
        out->lanes[k] = b->entries[k].lanes & lit[b->groups[k]];
    while (end > 0 && !out->lanes[end - 1])
        end--;
    while (first < end && !out->lanes[first])
        first++;
    out->first = first;
    out->count = end - first;
}

// ---- What a program reads ----

/// The arguments for gathering a material's fields.
typedef struct reading {
    const glint_plan_pattern *own;
    uint32_t inputs;
    const glint_pattern_lanes *entries;
    uint32_t count;
} reading;

/// Gathers a field of a material if the program reads it: the constant, or the result of the field's own program.
static void gather_field(glint_tile *tile, const glint_plan *plan, const reading *r, glint_field field, int channel,
                         double number, int input)
{
    glint_pattern_inputs *inputs = &tile->pattern->inputs;
    if (!(r->inputs >> input & 1))
        return;
    if (!(r->own->made >> field & 1)) {
        glint_pattern_put_number(inputs, (glint_input)input, number);
        return;
    }
    const float *plane = glint_plane_of(tile->at.planes, plan, field, channel);
    double *to = glint_pattern_row(inputs, (glint_input)input);
    for (uint32_t k = 0; k < r->count; k++)
        for (uint32_t i = 0; i < GLINT_GROUP; i++)
            to[k * GLINT_GROUP + i] = (double)plane[r->entries[k].group * GLINT_GROUP + i];
}

static void gather_material(glint_tile *tile, const glint_plan *plan, const reading *r)
{
    const double *diffuse = glint_plan_diffuse(plan, r->entries[0].material);
    for (int c = 0; c < 3; c++) {
        gather_field(tile, plan, r, GLINT_FIELD_DIFFUSE, c, diffuse[c], GLINT_INPUT_KD_R + c);
        gather_field(tile, plan, r, GLINT_FIELD_SPECULAR, c, r->own->desc.specular[c], GLINT_INPUT_KS_R + c);
    }
    gather_field(tile, plan, r, GLINT_FIELD_SHININESS, 0, r->own->desc.shininess, GLINT_INPUT_SHININESS);
}

void glint_shader_gather(glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_points *points, uint32_t known,
                         const glint_pattern_lanes *entries, uint32_t count)
{
    const glint_plan_pattern *own = &frame->plan->patterns->of[entries->material];
    const reading r = { own, own->program[GLINT_FIELD_SHADER]->inputs, entries, count };
    const uint32_t reads = (r.inputs & ~(NUMBERS | known)) | 7u << GLINT_INPUT_WORLD_X;
    glint_pattern_gather(&tile->pattern->inputs, frame, points, reads, entries, count);
    gather_material(tile, frame->plan, &r);
}

/// Computes the direction and distance from the batch to a sample of an area light.
static void store_sample_positions(glint_tile *tile, const glint_plan *plan, const batch *b, const reached *lit,
                                   const glint_plan_light *light, const glint_light_sample *sample)
{
    for (uint32_t k = lit->first; k < lit->first + lit->count; k++)
        for (uint32_t i = 0; i < GLINT_GROUP; i++) {
            double position[3];
            glint_tile_sample_position(tile, plan->desc.precision, sample, light->scale, b->groups[k] * GLINT_GROUP + i,
                                       position);
            for (int c = 0; c < 3; c++)
                tile->pattern->inputs.row[GLINT_INPUT_L_X + c][k * GLINT_GROUP + i] = position[c];
        }
}

/// Gathers the directions to a light and, if the program reads it, the distance.
static void gather_light_directions(glint_tile *tile, const glint_tile_frame *frame, const batch *b, const reached *lit,
                                    const glint_plan_light *light)
{
    glint_pattern_inputs *inputs = &tile->pattern->inputs;
    const glint_light_sample *sample = glint_tile_light_sample_of(tile, light);
    const size_t at = light->directional ? 0 : (size_t)lit->first * GLINT_GROUP; // one direction for all points
    const bool measured = glint_program_reads(b->program, GLINT_INPUT_DISTANCE) && !light->directional;
    glint_unit_args args = { .group_count = light->directional ? 1 : lit->count,
                             .position = sample ? NULL : light->position,
                             .length = measured ? glint_pattern_row(inputs, GLINT_INPUT_DISTANCE) + at : NULL };
    for (int c = 0; c < 3; c++) {
        double *direction = inputs->row[GLINT_INPUT_L_X + c] + at;
        args.to[c] = direction;
        args.from[c] = light->directional ? NULL : inputs->from[GLINT_INPUT_WORLD_X + c] + at;
        args.unit[c] = direction;
    }
    if (sample)
        store_sample_positions(tile, frame->plan, b, lit, light, sample);
    frame->stages->unit(&args);
    inputs->same &= ~(7u << GLINT_INPUT_L_X);
    if (!light->directional)
        return;
    inputs->same |= 7u << GLINT_INPUT_L_X;
    glint_pattern_put_number(inputs, GLINT_INPUT_DISTANCE, HUGE_VAL);
}

/// Gathers the light's colour at the points, after attenuation.
static void gather_color(glint_tile *tile, const batch *b, const glint_shader_light *from)
{
    for (int c = 0; c < 3; c++) {
        const float *weight = from->weight[c];
        const glint_input input = (glint_input)(GLINT_INPUT_LIGHT_R + c);
        if (!weight) {
            glint_pattern_put_number(&tile->pattern->inputs, input, from->light->diffuse[c]);
            continue;
        }
        double *to = glint_pattern_row(&tile->pattern->inputs, input);
        for (uint32_t k = 0; k < b->count; k++)
            for (uint32_t i = 0; i < GLINT_GROUP; i++)
                to[k * GLINT_GROUP + i] =
                    from->light->diffuse[c] * (double)weight[b->groups[k] * GLINT_GROUP + i];
    }
}

/// Computes the visible share of a partly covered light, without the attenuation, which is in its colour.
static void gather_share(const batch *b, const reached *lit, const glint_shader_light *from, float *share)
{
    for (uint32_t k = 0; k < lit->count; k++)
        for (uint32_t i = 0; i < GLINT_GROUP; i++) {
            const size_t at = b->groups[lit->first + k] * GLINT_GROUP + i;
            const float weight = from->weight[0] ? from->weight[0][at] : 1;
            share[k * GLINT_GROUP + i] = weight > 0 ? from->visible[at] / weight : from->visible[at];
        }
}

// ---- Results ----

/// Adds the contribution of one light to the sums or to the totals of a batch; with a single light, writes it into
/// planes.
static void add_light(glint_tile *tile, const glint_tile_frame *frame, const batch *b, const reached *lit,
                      const glint_shader_light *from, result to)
{
    struct glint_pattern *pattern = tile->pattern;
    _Alignas(64) float share[GLINT_PROGRAM_LANES];
    glint_program_args args = { .group_count = lit->count,
                                .wanted = lit->lanes + lit->first,
                                .groups = to == TO_TOTALS ? NULL : b->groups + lit->first,
                                .share = from->visible ? share : NULL };
    gather_light_directions(tile, frame, b, lit, from->light);
    gather_color(tile, b, from);
    if (from->visible)
        gather_share(b, lit, from, share);
    for (int k = 0; k < GLINT_SHADER_TERMS; k++) {
        args.plane[k] = to == TO_PLANES ? pattern->shaded[k] : NULL;
        args.total[k] = to == TO_SUMS     ? tile->film.sum[GLINT_TERM_DIFFUSE + k / 3][k % 3]
                        : to == TO_TOTALS ? pattern->total[k] + (size_t)lit->first * GLINT_GROUP
                                          : NULL;
    }
    glint_pattern_call(pattern, frame, &b->program->code, lit->first, &args);
    if (frame->plan->light_groups && from->light->group != GLINT_NO_GROUP) {
        for (int k = 0; k < GLINT_SHADER_TERMS; k++)
            args.total[k] = glint_group_sum(tile, from->light->group)[k / 3][k % 3];
        glint_pattern_call(pattern, frame, &b->program->code, lit->first, &args);
    }
    for (uint32_t k = 0; k < lit->count; k++)
        tile->counts.work.patterns += glint_count_lanes(lit->lanes[lit->first + k]);
}

/// Rounds the totals of a batch into planes.
static void round_totals(struct glint_pattern *pattern, const batch *b)
{
    for (int term = 0; term < GLINT_SHADER_TERMS; term++)
        for (uint32_t k = 0; k < b->count; k++) {
            const double *from = &pattern->total[term][k * GLINT_GROUP];
            float *to = &pattern->shaded[term][b->groups[k] * GLINT_GROUP];
            const unsigned lanes = b->entries[k].lanes;
            for (int i = 0; lanes == 0xffff && i < GLINT_GROUP; i++)
                to[i] = (float)from[i];
            for (int i = 0; lanes != 0xffff && i < GLINT_GROUP; i++)
                to[i] = lanes >> i & 1 ? (float)from[i] : to[i];
        }
}

/// Clears the planes that the program has no output for.
static void clear_missing(struct glint_pattern *pattern, const batch *b)
{
    for (uint32_t term = b->program->code.output_count; term < GLINT_SHADER_TERMS; term++)
        for (uint32_t k = 0; k < b->count; k++)
            for (unsigned bits = b->entries[k].lanes; bits; bits &= bits - 1)
                pattern->shaded[term][b->groups[k] * GLINT_GROUP + (unsigned)__builtin_ctz(bits)] = 0;
}

/// Runs the shader of one material for a batch of groups and all lights.
static void shade_batch(glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_points *points,
                        const batch *b, const glint_shader_light *lights, uint32_t light_count)
{
    const result to = frame->plan->accumulate ? TO_SUMS : light_count > 1 || lights->visible ? TO_TOTALS : TO_PLANES;
    bool gathered = false;
    for (int term = 0; to == TO_TOTALS && term < GLINT_SHADER_TERMS; term++)
        memset(tile->pattern->total[term], 0, (size_t)b->count * GLINT_GROUP * sizeof(double));
    for (uint32_t i = 0; i < light_count; i++) {
        reached lit;
        find_reached(b, lights[i].lit, &lit);
        if (!lit.count)
            continue;
        if (!gathered)
            glint_shader_gather(tile, frame, points, 0, b->entries, b->count);
        gathered = true;
        add_light(tile, frame, b, &lit, &lights[i], to);
    }
    if (to == TO_TOTALS)
        round_totals(tile->pattern, b);
    if (to == TO_PLANES)
        clear_missing(tile->pattern, b);
}

static bool has_shader(const glint_plan_pattern *own, uint32_t fields)
{
    (void)fields;
    return own->program[GLINT_FIELD_SHADER];
}

glint_pattern_points glint_shader_find_lanes(const glint_tile *tile, const glint_plan *plan, const uint16_t *lanes)
{
    glint_pattern_points points = glint_pattern_points_of(tile);
    points.hits = lanes;
    points.shading = true;
    for (int c = 0; c < 3; c++)
        points.normal[c] = tile->surface.normal[c];
    glint_pattern_find_lanes(tile->pattern, plan->patterns, &points, has_shader);
    return points;
}

/// Returns the lanes that any light reaches; `buffer` holds them if there are several lights.
static const uint16_t *find_lit(const glint_tile *tile, const glint_shader_light *lights, uint32_t light_count,
                                uint16_t buffer[GLINT_TILE_GROUPS])
{
    if (light_count == 1)
        return lights->lit;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        buffer[g] = 0;
        for (uint32_t i = 0; i < light_count; i++)
            buffer[g] |= lights[i].lit[g];
    }
    return buffer;
}

void glint_tile_shader(glint_tile *tile, const glint_tile_frame *frame, const glint_shader_light *lights, uint32_t light_count)
{
    uint16_t buffer[GLINT_TILE_GROUPS];
    const uint16_t *lit = find_lit(tile, lights, light_count, buffer);
    const glint_pattern_points points = glint_shader_find_lanes(tile, frame->plan, lit);
    const glint_pattern_lanes *entries;
    if (!tile->pattern->count)
        return;
    for (uint32_t taken; (taken = glint_pattern_take(tile->pattern, &entries));) {
        batch b = { .entries = entries, .count = taken };
        b.program = frame->plan->patterns->of[entries[0].material].program[GLINT_FIELD_SHADER];
        for (uint32_t k = 0; k < b.count; k++)
            b.groups[k] = entries[k].group;
        shade_batch(tile, frame, &points, &b, lights, light_count);
    }
    glint_tile_count_stage(tile, frame, GLINT_STAGE_SHADER, false);
}

static bool shades(const glint_plan *plan) { return glint_plan_is_lit(plan) && plan->patterns && plan->patterns->shaders; }

const glint_stage glint_stage_shader = {
    .name = "shader",
    .doc = "shaders of materials, once for each light",
    .called = shades,
    .remote = true,
    .adds = glint_tile_adds_anywhere,
};
