/// The stage shader: programs that say what one light leaves of a material, in place of the built-in models.
#include "engine/program/program.h"
#include "engine/tile/pattern_work.h"

#include <math.h>

/// One light, or one sample of an area light, as shaders see it.
typedef struct shader_light {
    const glint_plan_light *light;
    const glint_light_sample *sample; ///< NULL: it is no area light
    const glint_shader_light *reach;
} shader_light;

static double *row(const glint_tile *tile, int input, uint32_t k)
{
    return &tile->pattern->inputs.row[input][(size_t)k * GLINT_GROUP];
}

/// Where group g sees the light, or its sample; of a directional one the way there.
static void place_light(const glint_tile *tile, const glint_plan *plan, const shader_light *from, uint32_t g,
                        double out[3][GLINT_GROUP])
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i++)
            out[c][i] = from->light->position[c];
    for (uint32_t i = 0; from->sample && i < GLINT_GROUP; i++) {
        double place[3];
        glint_tile_sample_place(tile, plan->desc.precision, from->sample, from->light->scale, g * GLINT_GROUP + i, place);
        for (int c = 0; c < 3; c++)
            out[c][i] = place[c];
    }
}

/// What of group g depends on the light: group k of the rows. Lanes without a hit get anything.
static void gather_light(const glint_tile *tile, const glint_plan *plan, const shader_light *from, uint32_t g,
                         uint32_t k)
{
    const glint_plan_light *light = from->light;
    double l[3][GLINT_GROUP], point[GLINT_GROUP], length[GLINT_GROUP];
    place_light(tile, plan, from, g, l);
    for (int c = 0; c < 3; c++) {
        if (light->directional)
            continue;
        glint_reals_of(tile->surface.point[c], plan->desc.precision, g, point);
        for (int i = 0; i < GLINT_GROUP; i++)
            l[c][i] -= point[i];
    }
    for (int i = 0; i < GLINT_GROUP; i++)
        length[i] = sqrt((l[0][i] * l[0][i] + l[1][i] * l[1][i]) + l[2][i] * l[2][i]);
    double *restrict distance = row(tile, GLINT_INPUT_DISTANCE, k);
    for (int i = 0; i < GLINT_GROUP; i++)
        distance[i] = light->directional ? HUGE_VAL : length[i];
    for (int c = 0; c < 3; c++) {
        double *restrict way = row(tile, GLINT_INPUT_L_X + c, k), *restrict color = row(tile, GLINT_INPUT_LIGHT_R + c, k);
        const float *weight = from->reach->weight[c];
        for (int i = 0; i < GLINT_GROUP; i++)
            way[i] = l[c][i] / length[i];
        for (int i = 0; i < GLINT_GROUP; i++)
            color[i] = light->diffuse[c] * (weight ? (double)weight[g * GLINT_GROUP + (uint32_t)i] : 1);
    }
}

/// A number of a material, or what a program gave of it, of group g: group k of an input's row, if it is read.
static void gather_field(const glint_tile *tile, const glint_plan *plan, const glint_plan_pattern *own, glint_field field,
                         int channel, double number, uint32_t g, int input, uint32_t k)
{
    double *restrict to = row(tile, input, k);
    if (!(own->program[GLINT_FIELD_SHADER]->inputs >> input & 1))
        return;
    const bool made = own->made >> field & 1;
    const float *plane = made ? glint_plane_of(tile->at.planes, plan, field, channel) + (size_t)g * GLINT_GROUP : NULL;
    for (int i = 0; i < GLINT_GROUP; i++)
        to[i] = plane ? (double)plane[i] : number;
}

static void gather_material(const glint_tile *tile, const glint_plan *plan, const glint_plan_pattern *own,
                            const double *diffuse, uint32_t g, uint32_t k)
{
    for (int c = 0; c < 3; c++) {
        gather_field(tile, plan, own, GLINT_FIELD_DIFFUSE, c, diffuse[c], g, GLINT_INPUT_KD_R + c, k);
        gather_field(tile, plan, own, GLINT_FIELD_SPECULAR, c, own->desc.specular[c], g, GLINT_INPUT_KS_R + c,
                     k);
    }
    gather_field(tile, plan, own, GLINT_FIELD_SHININESS, 0, own->desc.shininess, g, GLINT_INPUT_SHININESS, k);
}

/// Adds what the shader gave to the sums.
static void add_terms(glint_tile *tile, const glint_shader_light *reach, const glint_pattern_lanes *entry, int terms)
{
    const size_t at = (size_t)entry->group * GLINT_GROUP;
    double share[GLINT_GROUP];
    for (size_t i = 0; i < GLINT_GROUP; i++)
        share[i] = reach->share ? (double)reach->share[at + i] : 1;
    for (int k = 0; k < terms; k++) {
        double *restrict sum = &tile->film.sum[GLINT_TERM_DIFFUSE + k / 3][k % 3][at];
        const float *restrict given = &tile->pattern->shaded[k][at];
        for (size_t i = 0; entry->lanes == 0xffff && i < GLINT_GROUP; i++)
            sum[i] += share[i] * (double)given[i];
        for (unsigned left = entry->lanes == 0xffff ? 0 : entry->lanes; left; left &= left - 1) {
            const unsigned i = (unsigned)__builtin_ctz(left);
            sum[i] += share[i] * (double)given[i];
        }
    }
}

/// One material's shader, for some groups that show it.
static void shade_material(glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_points *points,
                           const glint_plan_pattern *own, const shader_light *from, const glint_pattern_lanes *entries,
                           uint32_t count)
{
    const glint_program *program = own->program[GLINT_FIELD_SHADER];
    uint16_t wanted[GLINT_PROGRAM_GROUPS];
    uint32_t groups[GLINT_PROGRAM_GROUPS];
    for (uint32_t k = 0; k < count; k++) {
        groups[k] = entries[k].group;
        wanted[k] = entries[k].lanes;
        glint_pattern_gather(&tile->pattern->inputs, frame, points, program->inputs, groups[k], wanted[k], k);
        gather_light(tile, frame->plan, from, groups[k], k);
        gather_material(tile, frame->plan, own, glint_plan_diffuse(frame->plan, entries[0].material), groups[k], k);
        tile->counts.work.patterns += (uint64_t)__builtin_popcount(wanted[k]);
    }
    glint_program_args args = { .group_count = count, .wanted = wanted, .groups = groups };
    for (int k = 0; k < GLINT_SHADER_TERMS; k++)
        args.plane[k] = tile->pattern->shaded[k];
    glint_pattern_call(tile->pattern, frame, &program->code, &args);
    for (uint32_t k = 0; k < count; k++)
        add_terms(tile, from->reach, &entries[k], (int)program->code.output_count);
}

static bool has_shader(const glint_plan_pattern *own, uint32_t fields)
{
    (void)fields;
    return own->program[GLINT_FIELD_SHADER];
}

void glint_tile_shader(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light,
                       const glint_shader_light *reach)
{
    const shader_light from = { light, glint_tile_light_sample_of(tile, light), reach };
    glint_pattern_points points = glint_pattern_points_of(tile);
    points.hits = reach->lit;
    points.shading = true;
    for (int c = 0; c < 3; c++)
        points.normal[c] = tile->surface.normal[c];
    const uint32_t count = glint_pattern_find_lanes(tile->pattern, frame->plan->patterns, &points, has_shader);
    for (uint32_t first = 0; first < count; first++) {
        glint_pattern_lanes entries[GLINT_PROGRAM_GROUPS];
        const uint32_t taken = glint_pattern_take(tile->pattern, first, count, entries);
        if (taken)
            shade_material(tile, frame, &points, &frame->plan->patterns->of[entries[0].material], &from, entries,
                           taken);
    }
    glint_tile_count_stage(tile, frame, GLINT_STAGE_SHADER, false);
}
