/// The stage shader: programs that say what one light leaves of a material, in place of the built-in models.
#include "engine/base/vec.h"
#include "engine/program/program.h"
#include "engine/tile/pattern_work.h"

/// One light, or one sample of an area light, as shaders see it.
typedef struct shader_light {
    const glint_plan_light *light;
    const glint_light_sample *sample; ///< NULL: it is no area light
    const glint_shader_light *reach;
} shader_light;

static double *row(const glint_tile *tile, int input, uint32_t lane) { return &tile->pattern->inputs.row[input][lane]; }

/// Towards the light, unit; returns its distance.
static double to_light(const glint_tile *tile, const glint_plan *plan, const shader_light *from, uint32_t i,
                       double l[3])
{
    for (int c = 0; c < 3; c++) {
        l[c] = from->sample ? from->sample->position[c][i % GLINT_GROUP] : from->light->position[c];
        if (!from->light->directional)
            l[c] -= glint_real_at(tile->surface.point[c], plan->desc.precision, i);
    }
    const double distance = sqrt(vec_dot(l, l));
    for (int c = 0; c < 3; c++)
        l[c] /= distance;
    return from->light->directional ? HUGE_VAL : distance;
}

/// What of a sample depends on the light: sample i of the tile, lane `to` of the rows.
static void gather_light(const glint_tile *tile, const glint_plan *plan, const shader_light *from, uint32_t i,
                         uint32_t to)
{
    double l[3];
    *row(tile, GLINT_INPUT_DISTANCE, to) = to_light(tile, plan, from, i, l);
    for (int c = 0; c < 3; c++) {
        const float *weight = from->reach->weight[c];
        *row(tile, GLINT_INPUT_L_X + c, to) = l[c];
        *row(tile, GLINT_INPUT_LIGHT_R + c, to) = from->light->diffuse[c] * (weight ? (double)weight[i] : 1);
    }
}

/// What of a sample is the material's.
static void gather_material(const glint_tile *tile, const glint_plan *plan, const glint_plan_pattern *own, uint32_t i,
                            uint32_t to)
{
    const uint32_t m = tile->surface.material[i];
    double kd_room[3], ks_room[3];
    const double *kd = glint_tile_diffuse(tile, plan, i, kd_room);
    const double *ks = glint_color_at(tile->at.planes, plan, GLINT_FIELD_SPECULAR, m, i, own->desc.specular, ks_room);
    for (int c = 0; c < 3; c++) {
        *row(tile, GLINT_INPUT_KD_R + c, to) = kd[c];
        *row(tile, GLINT_INPUT_KS_R + c, to) = ks[c];
    }
    *row(tile, GLINT_INPUT_SHININESS, to) =
        own->made >> GLINT_FIELD_SHININESS & 1
            ? (double)glint_plane_of(tile->at.planes, plan, GLINT_FIELD_SHININESS, 0)[i]
            : own->desc.shininess;
}

/// Adds what the shader gave to the sums.
static void add_terms(glint_tile *tile, const glint_shader_light *reach, const glint_pattern_lanes *entry, int terms)
{
    for (unsigned left = entry->lanes; left; left &= left - 1) {
        const uint32_t i = entry->group * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
        const double share = reach->share ? (double)reach->share[i] : 1;
        for (int k = 0; k < terms; k++)
            tile->film.sum[GLINT_TERM_DIFFUSE + k / 3][k % 3][i] += share * (double)tile->pattern->shaded[k][i];
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
        for (unsigned left = wanted[k]; left; left &= left - 1) {
            const uint32_t lane = (uint32_t)__builtin_ctz(left), i = groups[k] * GLINT_GROUP + lane;
            gather_light(tile, frame->plan, from, i, k * GLINT_GROUP + lane);
            gather_material(tile, frame->plan, own, i, k * GLINT_GROUP + lane);
        }
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
