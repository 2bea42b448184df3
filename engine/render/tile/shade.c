/// Calls shade and resolve: for one sample, whose terms are added to sums if there are several samples, or for all
/// samples of a tile together, so that the sums stay in registers.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/render/pattern/pattern.h"

#include <stdlib.h>
#include <string.h>

/// Returns the light in slot i as an argument of shade; `lit`: the lanes that it reaches.
static glint_shade_light shade_light(const glint_tile *tile, const glint_plan_light *light, uint32_t i,
                                     const uint16_t *lit)
{
    glint_shade_light out = { .joined = light->joined && i > 0,
                              .lit = lit,
                              .cosine = tile->at.light[i].cosine,
                              .attenuation = light->cap          ? tile->at.light[i].visible
                                             : light->attenuated ? tile->at.light[i].attenuation
                                                                 : NULL,
                              .log2_specular = tile->at.light[i].log2_specular,
                              .sine2 = tile->at.light[i].sine2,
                              .schlick = tile->at.light[i].schlick,
                              .summed = tile->at.light[i].summed,
                              .highlight = tile->at.light[i].log2_specular };
    vec_copy(out.diffuse, light->diffuse);
    vec_copy(out.specular, light->specular);
    return out;
}

glint_shade_args glint_tile_shade_args(const glint_tile *tile, const glint_tile_frame *frame, uint32_t from,
                                       uint32_t count, glint_shade_light *lights, glint_shade_planes *planes)
{
    const glint_plan *plan = frame->plan;
    glint_shade_args args = { .group_count = tile->group_count,
                              .active = tile->active,
                              .hits = tile->at.hits,
                              .material = tile->surface.material,
                              .only = tile->at.only ? &frame->geometry.prims[*tile->at.only].material : NULL,
                              .materials = plan->materials,
                              .planes = glint_tile_shade_planes(tile, plan, planes),
                              .facing = tile->at.facing,
                              .highlights = plan->highlights,
                              .first = from == 0,
                              .lights = lights };
    for (uint32_t i = 0; i < count; i++) {
        const glint_plan_light *light = &plan->lights[from + i];
        const uint16_t *open = light->shadows ? tile->at.light[i].unoccluded : tile->at.light[i].lit;
        if (!tile->at.light[i].summed || !light->joined || i == 0) // otherwise the light is already in the sum
            lights[args.light_count++] = shade_light(tile, light, i, open);
    }
    if (!tile->transparent)
        vec_copy(args.background, plan->background);
    return args;
}

void glint_tile_point_film(glint_tile *tile, const glint_plan *plan, float *film[GLINT_TERM_COUNT][3], float *beauty[3])
{
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < GLINT_TERM_COUNT; k++)
            film[k][c] = plan->desc.passes >> (GLINT_PASS_BACKGROUND + k) & 1 ? tile->film.terms[k][c] : NULL;
        beauty[c] = tile->film.beauty[c];
    }
}

/// Runs shaders for the lights of a call of shade.
static void run_shaders(glint_tile *tile, const glint_tile_frame *frame, uint32_t from, uint32_t count,
                        const glint_shade_light *lights)
{
    glint_shader_light seen[GLINT_LIGHT_CHUNK];
    for (uint32_t i = 0; i < count; i++) {
        const glint_plan_light *light = &frame->plan->lights[from + i];
        const float *weight = light->attenuated ? tile->at.light[i].attenuation : NULL;
        seen[i] = (glint_shader_light) { light, lights[i].lit, { weight, weight, weight }, NULL };
        seen[i].visible = light->cap ? tile->at.light[i].visible : NULL;
    }
    glint_tile_shader(tile, frame, seen, count);
}

bool glint_tile_adds_anywhere(const glint_tile *tile, const glint_tile_frame *frame, bool any)
{
    (void)tile, (void)frame, (void)any;
    return true;
}

bool glint_tile_adds_to_hits(const glint_tile *tile, const glint_tile_frame *frame, bool any)
{
    (void)tile, (void)frame;
    return any;
}

/// Returns whether one call of shade computes all light of the tile's only sample: no visible material needs
/// secondary rays, and no light is hidden by a transparent surface. Hits, materials and shadows must be known.
static bool is_direct(const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const bool any = glint_has_lanes(tile->at.hits, tile->group_count);
    if (!plan->accumulate || plan->desc.samples > 1 || plan->light_count > GLINT_LIGHT_CHUNK)
        return false;
    for (int id = 0; id < GLINT_STAGE_COUNT; id++) {
        const glint_stage *stage = glint_stage_table[id];
        if (plan->runs[id] && (stage->scales || (stage->adds && stage->adds(tile, frame, any))))
            return false;
    }
    return true;
}

/// Called before the first call of shade for the eye's hits: clears the sums, if they are used.
static void begin_sums(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    tile->direct = is_direct(tile, frame);
    for (int k = 0; k < GLINT_TERM_COUNT && plan->accumulate && !tile->direct; k++)
        if (glint_plan_has_term(plan, (glint_term)k))
            memset(tile->film.sum[k], 0, sizeof tile->film.sum[k]);
}

void glint_tile_shade(glint_tile *tile, const glint_tile_frame *frame, uint32_t from, uint32_t count)
{
    const glint_plan *plan = frame->plan;
    glint_shade_light lights[GLINT_LIGHT_CHUNK];
    glint_shade_planes planes;
    if (!tile->batch && tile->sample == 0 && from == 0)
        begin_sums(tile, frame);
    glint_shade_args args = glint_tile_shade_args(tile, frame, from, count, lights, &planes);
    for (int k = 0; k < GLINT_TERM_COUNT; k++)
        for (int c = 0; c < 3; c++)
            args.sum[k][c] = plan->accumulate && !tile->direct ? tile->film.sum[k][c] : NULL;
    glint_tile_point_film(tile, plan, args.film, args.beauty);
    for (glint_stage_set bits = plan->before_shade; bits; bits &= bits - 1)
        glint_stage_table[__builtin_ctzll(bits)]->before_shade(tile, frame, &args, lights, from, count);
    if (count > 0 && plan->runs[GLINT_STAGE_SHADER] && glint_tile_shows_shader(tile, plan)) // then no light is summed
        run_shaders(tile, frame, from, count, lights);
    frame->stages->shade(&args);
    for (glint_stage_set bits = plan->after_shade; bits; bits &= bits - 1)
        glint_stage_table[__builtin_ctzll(bits)]->after_shade(tile, frame, &args, from, count);
    glint_tile_count_powers(tile, frame, from, count);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_SHADE, false);
}

void glint_tile_resolve(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    glint_resolve_args args = { .group_count = tile->group_count, .samples = plan->desc.samples };
    for (int k = 0; k < GLINT_TERM_COUNT; k++)
        for (int c = 0; c < 3; c++)
            args.sum[k][c] = glint_plan_has_term(plan, (glint_term)k) ? tile->film.sum[k][c] : NULL;
    glint_tile_point_film(tile, plan, args.film, args.beauty);
    frame->stages->resolve(&args);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_RESOLVE, false);
}

// ---- Samples shaded together ----

struct glint_samples {
    _Alignas(64) uint32_t material[GLINT_LIGHT_CHUNK][GLINT_TILE_SAMPLES];
    uint16_t hits[GLINT_LIGHT_CHUNK][GLINT_TILE_GROUPS];
    glint_shade_light lights[GLINT_LIGHT_CHUNK];
    glint_shade_args shade[GLINT_LIGHT_CHUNK];
    glint_shade_planes planes[GLINT_LIGHT_CHUNK];
};

struct glint_samples *glint_samples_create(void) { return glint_alloc(1, sizeof(struct glint_samples)); }

void glint_samples_destroy(struct glint_samples *samples) { free(samples); }

void glint_tile_remember_sample(glint_tile *tile, const glint_tile_frame *frame, uint32_t light_count)
{
    struct glint_samples *samples = tile->samples;
    const uint32_t k = tile->sample;
    glint_shade_args *shade = &samples->shade[k];
    *shade =
        glint_tile_shade_args(tile, frame, 0, light_count, &samples->lights[tile->own_lights], &samples->planes[k]);
    memcpy(samples->hits[k], tile->at.hits, tile->group_count * sizeof *samples->hits[k]);
    shade->hits = samples->hits[k];
    memcpy(samples->material[k], tile->surface.material,
           tile->group_count * GLINT_GROUP * sizeof *samples->material[k]);
    shade->material = samples->material[k];
    glint_tile_count_powers(tile, frame, 0, light_count);
}

void glint_tile_resolve_samples(glint_tile *tile, const glint_tile_frame *frame)
{
    const uint32_t count = (uint32_t)frame->plan->desc.samples;
    glint_shade_args *shade = tile->samples->shade;
    glint_tile_point_film(tile, frame->plan, shade->film, shade->beauty);
    frame->stages->resolve_samples(shade, count);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_SHADE, false);
    tile->counts.runs[GLINT_STAGE_SHADE] += count - 1;
    glint_tile_count_stage(tile, frame, GLINT_STAGE_RESOLVE, false);
}

/// Returns a light whose arrays begin at group g.
static glint_shade_light light_from(const glint_shade_light *light, uint32_t g)
{
    glint_shade_light out = *light;
    const float **const arrays[] = { &out.cosine, &out.attenuation, &out.log2_specular, &out.highlight };
    out.lit += g;
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        if (*arrays[i])
            *arrays[i] += (size_t)g * GLINT_GROUP;
    return out;
}

/// Returns the arguments of the k-th sample, from those of the first one in `all`. Fills in `lights`.
static glint_shade_args stacked_sample(const glint_shade_args *all, uint32_t k, glint_shade_light *lights)
{
    const uint32_t g = k * all->group_count;
    glint_shade_args args = *all;
    args.hits += g;
    args.material += (size_t)g * GLINT_GROUP;
    args.lights = lights;
    for (uint32_t i = 0; i < all->light_count; i++)
        lights[i] = light_from(&all->lights[i], g);
    return args;
}

/// Shades and resolves all samples without sums.
static void resolve_stacked(const glint_tile *tile, const glint_tile_frame *frame, const glint_shade_args *all, uint32_t samples)
{
    struct glint_samples *memory = tile->samples;
    for (uint32_t k = 0; k < samples; k++)
        memory->shade[k] = stacked_sample(all, k, memory->lights + k * all->light_count);
    frame->stages->resolve_samples(memory->shade, samples);
}

/// Adds the light of faces and vertices in sample k of each pixel.
static void add_point_light(glint_tile *tile, const glint_tile_frame *frame,
                            const double (*point_light)[3][GLINT_TILE_SAMPLES], uint32_t count, uint32_t k,
                            uint32_t samples)
{
    for (int term = 0; term < (frame->plan->highlights ? 2 : 1); term++)
        for (int c = 0; c < 3; c++)
            for (uint32_t p = 0; p < count; p++)
                tile->film.sum[GLINT_TERM_DIFFUSE + term][c][p] += point_light[term][c][p * samples + k];
}

/// Adds the samples to the sums.
static void add_stacked(glint_tile *tile, const glint_tile_frame *frame, const glint_shade_args *all, uint32_t samples, bool begins,
                        const double (*point_light)[3][GLINT_TILE_SAMPLES], uint32_t count)
{
    glint_shade_light lights[GLINT_LIGHT_CHUNK];
    const size_t size = all->group_count * GLINT_GROUP * sizeof(double);
    for (int k = 0; k < GLINT_TERM_LOCAL && begins; k++)
        for (int c = 0; c < 3 && glint_plan_has_term(frame->plan, (glint_term)k); c++)
            memset(tile->film.sum[k][c], 0, size);
    for (uint32_t k = 0; k < samples; k++) {
        glint_shade_args args = stacked_sample(all, k, lights);
        for (int term = 0; term < GLINT_TERM_COUNT; term++)
            for (int c = 0; c < 3; c++)
                args.sum[term][c] = tile->film.sum[term][c];
        frame->stages->shade(&args);
        if (point_light)
            add_point_light(tile, frame, point_light, count, k, samples);
    }
}

/// Computes the means of the sums.
static void resolve_sums(glint_tile *tile, const glint_tile_frame *frame, uint32_t groups, float *const beauty[3])
{
    glint_resolve_args args = { .group_count = groups, .samples = frame->plan->desc.samples };
    for (int k = 0; k < GLINT_TERM_COUNT; k++)
        for (int c = 0; c < 3; c++)
            args.sum[k][c] = glint_plan_has_term(frame->plan, (glint_term)k) ? tile->film.sum[k][c] : NULL;
    memcpy(args.beauty, beauty, sizeof args.beauty);
    frame->stages->resolve(&args);
}

void glint_tile_shade_stacked(glint_tile *tile, const glint_tile_frame *frame, uint32_t light_count, uint32_t first,
                              uint32_t samples, const double (*point_light)[3][GLINT_TILE_SAMPLES], uint32_t count,
                              float *const beauty[3])
{
    const glint_plan *plan = frame->plan;
    const bool last = first + samples == (uint32_t)plan->desc.samples;
    glint_shade_light lights[GLINT_LIGHT_CHUNK];
    glint_shade_args all = glint_tile_shade_args(tile, frame, 0, light_count, lights, NULL);
    all.group_count /= samples;
    memcpy(all.beauty, beauty, sizeof all.beauty);
    if (plan->together)
        resolve_stacked(tile, frame, &all, samples);
    else
        add_stacked(tile, frame, &all, samples, first == 0, point_light, count);
    glint_tile_count_powers(tile, frame, 0, light_count);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_SHADE, false);
    if (!last)
        return;
    if (!plan->together)
        resolve_sums(tile, frame, all.group_count, beauty);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_RESOLVE, false);
}
