/// Programs of materials, run for the points that show them: up to sixteen groups at a time, each with its own lanes.
#include "engine/render/pattern/pattern.h"
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/render/pattern/work.h"
#include "engine/render/program/program.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Returns the sizes that a plan needs.
static glint_pattern_sizes sizes_for(const glint_plan *plan)
{
    const glint_plan_patterns *patterns = plan->patterns;
    return (glint_pattern_sizes) { .planes = (size_t)patterns->plane_count * GLINT_TILE_SAMPLES,
                                   .samples = plan->together ? (size_t)plan->desc.samples : 1,
                                   // all cached values of a first part may be live until its end
                                   .rows = patterns->row_count + GLINT_PROGRAM_OUTPUTS_MAX,
                                   .bumps = patterns->bumps };
}

struct glint_pattern *glint_pattern_create(const glint_plan *plan)
{
    struct glint_pattern *pattern = glint_alloc(1, sizeof *pattern);
    if (!pattern)
        return NULL;
    const glint_pattern_sizes sizes = sizes_for(plan);
    pattern->sizes = sizes;
    pattern->rows = glint_alloc(sizes.rows * GLINT_PROGRAM_LANES, sizeof *pattern->rows);
    bool good = pattern->rows;
    for (int walk = 0; walk < GLINT_WALK_COUNT; walk++) {
        const size_t samples = walk == GLINT_WALK_EYE ? sizes.samples : 1;
        pattern->planes[walk] = glint_alloc(samples * sizes.planes, sizeof *pattern->planes[walk]);
        pattern->normals[walk] = sizes.bumps ? glint_alloc(3 * GLINT_TILE_SAMPLES, sizeof(double)) : NULL;
        good = good && pattern->planes[walk] && (pattern->normals[walk] || !sizes.bumps);
    }
    if (good)
        return pattern;
    glint_pattern_destroy(pattern);
    return NULL;
}

bool glint_pattern_fits(const struct glint_pattern *pattern, const glint_plan *plan)
{
    if (!pattern || !plan->patterns)
        return !pattern && !plan->patterns;
    const glint_pattern_sizes sizes = sizes_for(plan), has = pattern->sizes;
    return sizes.planes == has.planes && sizes.samples == has.samples && sizes.rows == has.rows &&
           sizes.bumps == has.bumps;
}

void glint_pattern_destroy(struct glint_pattern *pattern)
{
    for (int walk = 0; pattern && walk < GLINT_WALK_COUNT; walk++) {
        free(pattern->planes[walk]);
        free(pattern->normals[walk]);
    }
    if (pattern)
        free(pattern->rows);
    free(pattern);
}

void glint_pattern_point(struct glint_pattern *pattern, glint_tile *tile, glint_walk walk)
{
    tile->pattern = pattern;
    tile->at.planes = NULL;
    for (int c = 0; c < 3; c++)
        tile->unbumped[c] = NULL;
    if (!pattern)
        return;
    const size_t sample = walk == GLINT_WALK_EYE ? tile->own_planes : 0;
    tile->at.planes = pattern->planes[walk] + sample * pattern->sizes.planes;
    for (int c = 0; c < 3 && pattern->normals[walk]; c++)
        tile->unbumped[c] = pattern->normals[walk] + (size_t)c * GLINT_TILE_SAMPLES;
}

float *glint_pattern_planes(struct glint_pattern *pattern, glint_walk walk) { return pattern->planes[walk]; }

// ---- Which lanes ----

/// Returns those of `lanes` that have material `m`.
static unsigned lanes_of(const uint32_t *material, uint32_t m, unsigned lanes)
{
    unsigned same = 0;
    for (unsigned i = 0; i < GLINT_GROUP; i++)
        same |= (unsigned)(material[i] == m) << i;
    return same & lanes;
}

/// Lists points that all have one material.
static void list_one_material(struct glint_pattern *pattern, const glint_plan_patterns *patterns,
                              const glint_pattern_points *points,
                              bool (*wants)(const glint_plan_pattern *own, uint32_t fields))
{
    const uint16_t *hits = points->hits;
    const uint32_t group_count = points->group_count;
    glint_pattern_lanes *entries = pattern->lanes;
    uint32_t count = 0, first = 0;
    pattern->first = pattern->count = 0;
    pattern->several = false;
    while (first < group_count && !hits[first])
        first++;
    if (first == group_count)
        return;
    const uint32_t m = points->material[first * GLINT_GROUP + (uint32_t)__builtin_ctz(hits[first])];
    if (!wants(&patterns->of[m], points->fields))
        return;
    for (uint32_t g = first; g < group_count; g++) {
        entries[count] = (glint_pattern_lanes) { m, (uint16_t)g, hits[g] };
        count += hits[g] != 0;
    }
    pattern->count = count;
}

void glint_pattern_find_lanes(struct glint_pattern *pattern, const glint_plan_patterns *patterns,
                              const glint_pattern_points *points,
                              bool (*wants)(const glint_plan_pattern *own, uint32_t fields))
{
    const uint16_t *hits = points->hits;
    const uint32_t *material = points->material, group_count = points->group_count;
    glint_pattern_lanes *entries = pattern->lanes;
    uint32_t count = 0, last = GLINT_MISS;
    bool wanted = false, several = false; // wanted: material `last` is wanted; several: there were other materials
    if (points->only) {
        list_one_material(pattern, patterns, points, wants);
        return;
    }
    for (uint32_t g = 0; g < group_count; g++, material += GLINT_GROUP)
        for (unsigned rest = hits[g], lanes; rest; rest &= ~lanes) {
            const uint32_t m = material[__builtin_ctz(rest)];
            lanes = glint_all_are(material, m) ? rest : lanes_of(material, m, rest);
            if (m != last) {
                wanted = wants(&patterns->of[m], points->fields);
                several = several || (wanted && count > 0 && entries[0].material != m);
            }
            last = m;
            if (wanted)
                entries[count++] = (glint_pattern_lanes) { m, (uint16_t)g, (uint16_t)lanes };
        }
    pattern->first = 0;
    pattern->count = count;
    pattern->several = several;
}

/// Moves the entries of one material to `taken`, from a list with several materials.
static uint32_t pick(struct glint_pattern *pattern)
{
    glint_pattern_lanes *lanes = pattern->lanes;
    uint32_t taken = 0;
    while (pattern->first < pattern->count && !lanes[pattern->first].lanes)
        pattern->first++;
    for (uint32_t k = pattern->first; k < pattern->count && taken < GLINT_PROGRAM_GROUPS; k++) {
        if (!lanes[k].lanes || (taken && lanes[k].material != pattern->taken[0].material))
            continue;
        pattern->taken[taken++] = lanes[k];
        lanes[k].lanes = 0;
    }
    return taken;
}

uint32_t glint_pattern_take(struct glint_pattern *pattern, const glint_pattern_lanes **entries)
{
    const uint32_t remaining = pattern->count - pattern->first;
    if (pattern->several) {
        *entries = pattern->taken;
        return pick(pattern);
    }
    *entries = &pattern->lanes[pattern->first];
    const uint32_t taken = remaining < GLINT_PROGRAM_GROUPS ? remaining : GLINT_PROGRAM_GROUPS;
    pattern->first += taken;
    return taken;
}

// ---- Planes derived from the results of programs ----

static float *plane_at(const glint_pattern_points *points, const glint_plan *plan, int field, int channel)
{
    return (float *)(uintptr_t)glint_plane_of(points->planes, plan, field, channel);
}

/// Returns the normalising factor of Phong's and Blinn-Phong's highlights.
static double even_factor(const glint_material_desc *desc, double s)
{
    if (desc->model != GLINT_MODEL_BLINN_PHONG)
        return (s + 2) / 2;
    return (s + 2) * (s + 4) / (8 * (glint_pow(2, -s / 2) + s));
}

static void finish_exponent(const glint_plan_pattern *own, const glint_pattern_points *points, const glint_plan *plan,
                            uint32_t i)
{
    float *shininess = plane_at(points, plan, GLINT_FIELD_SHININESS, 0);
    if (own->program[GLINT_FIELD_SHADER])
        return;
    if (own->desc.model == GLINT_MODEL_BLINN_PHONG && own->desc.matched)
        shininess[i] *= 4;
    for (int c = 0; c < 3 && own->desc.normalized; c++) {
        float *specular = &plane_at(points, plan, GLINT_FIELD_SPECULAR, c)[i];
        const double ks = own->program[GLINT_FIELD_SPECULAR] ? (double)*specular : own->desc.specular[c];
        *specular = (float)fmin(ks * even_factor(&own->desc, (double)shininess[i]), GLINT_REFLECTANCE_MAX);
    }
}

/// Computes the ambient light that remains if indirect light replaces a part of it as large as the diffuse
/// reflectance; for a program's ambient also that part.
static void finish_ambient(const glint_plan_pattern *own, const glint_pattern_points *points, const glint_plan *plan,
                           uint32_t i)
{
    const bool program = own->program[GLINT_FIELD_AMBIENT];
    if (program && !(own->made >> GLINT_FIELD_REST & 1))
        return; // there is no indirect light
    for (int c = 0; c < 3; c++) {
        float *ambient = &plane_at(points, plan, GLINT_FIELD_AMBIENT, c)[i];
        const double ka = program ? (double)*ambient : own->desc.ambient[c];
        const double kd = own->made >> GLINT_FIELD_DIFFUSE & 1
                              ? (double)plane_at(points, plan, GLINT_FIELD_DIFFUSE, c)[i]
                              : own->desc.diffuse[c];
        if (program)
            plane_at(points, plan, GLINT_FIELD_REST, c)[i] = (float)fmin(ka, kd);
        *ambient = (float)fmax(ka - kd, 0);
    }
}

static void finish_roughness(const glint_plan_pattern *own, const glint_pattern_points *points, const glint_plan *plan,
                             uint32_t i)
{
    float *roughness = &plane_at(points, plan, GLINT_FIELD_ROUGHNESS, 0)[i];
    const double r = fmin((double)*roughness, 1);
    (void)own;
    *roughness = (float)fmax(r * r, 1e-18);
}

void glint_pattern_finish(const glint_pattern_batch *batch, const glint_pattern_points *points, const glint_plan *plan,
                          int field)
{
    static void (*const finishers[GLINT_FIELD_PLANES])(const glint_plan_pattern *, const glint_pattern_points *,
                                                       const glint_plan *, uint32_t) = {
        [GLINT_FIELD_AMBIENT] = finish_ambient,
        [GLINT_FIELD_SHININESS] = finish_exponent,
        [GLINT_FIELD_ROUGHNESS] = finish_roughness,
    };
    const glint_pattern_lanes *entries = batch->entries;
    for (uint32_t k = 0; k < batch->count && finishers[field]; k++)
        for (unsigned bits = entries[k].lanes; bits; bits &= bits - 1)
            finishers[field](batch->own, points, plan,
                             entries[k].group * GLINT_GROUP + (uint32_t)__builtin_ctz(bits));
}

// ---- The programs ----

void glint_pattern_call(struct glint_pattern *pattern, const glint_tile_frame *frame, const glint_program_code *code,
                        uint32_t first, glint_program_args *args)
{
    const glint_pattern_inputs *inputs = &pattern->inputs;
    args->code = code;
    args->rows = pattern->rows;
    args->same = inputs->same;
    for (uint32_t bits = inputs->used; bits; bits &= bits - 1) {
        const int input = __builtin_ctz(bits);
        args->input[input] = inputs->from[input] + (inputs->same >> input & 1 ? 0 : first * GLINT_GROUP);
    }
    frame->stages->program(args);
}

const glint_program_code *glint_pattern_point_planes(glint_pattern_batch *batch, const glint_tile_frame *frame,
                                                     const glint_pattern_points *points, int field,
                                                     const glint_program_code *code, glint_program_code *buffer)
{
    const int planes = frame->plan->patterns->planes[field];
    for (int c = 0; c < planes; c++)
        batch->args.plane[c] = plane_at(points, frame->plan, field, c);
    if (code->output_count >= (uint32_t)planes)
        return code;
    *buffer = *code;
    for (; buffer->output_count < (uint32_t)planes; buffer->output_count++)
        buffer->outputs[buffer->output_count] = buffer->outputs[0];
    return buffer;
}

static bool is_before(const double a[3], const double b[3])
{
    for (int c = 0; c < 3; c++)
        if (a[c] != b[c])
            return a[c] < b[c];
    return false;
}

void glint_odd_pattern_add(glint_odd_pattern *to, const glint_odd_pattern *more)
{
    const uint64_t count = to->count + more->count;
    if (more->count && (!to->count || is_before(more->point, to->point)))
        *to = *more;
    to->count = count;
}

void glint_odd_patterns_add(glint_odd_patterns *to, const glint_odd_patterns *more)
{
    for (int kind = 0; kind < GLINT_ODD_COUNT; kind++)
        glint_odd_pattern_add(&to->of[kind], &more->of[kind]);
}

void glint_odd_patterns_note(glint_odd_patterns *to, const glint_odd_pattern *one, const double *outputs, size_t step, uint32_t count)
{
    bool is_nan = false, is_negative = false;
    for (uint32_t k = 0; k < count; k++) {
        is_nan = is_nan || isnan(outputs[k * step]);
        is_negative = is_negative || outputs[k * step] < 0;
    }
    glint_odd_pattern_add(&to->of[is_nan ? GLINT_ODD_NAN : is_negative ? GLINT_ODD_NEGATIVE : GLINT_ODD_HUGE], one);
}

bool glint_pattern_any_odd(const glint_pattern_batch *batch)
{
    unsigned any = 0;
    for (uint32_t k = 0; k < batch->count; k++)
        any |= batch->called.odd[k];
    return any;
}

/// Records the points where the last call, of `code`, gave an invalid reflectance. Planes do not distinguish NaN from
/// a negative number, so the program is run again for its outputs.
static void note_odd(struct glint_pattern *pattern, const glint_pattern_batch *batch, const glint_tile_frame *frame,
                     const glint_pattern_points *points, int field, const glint_program_code *code, glint_tile_counts *counts)
{
    _Alignas(64) double output[GLINT_PROGRAM_OUTPUTS_MAX][GLINT_PROGRAM_LANES];
    glint_program_args args = { .group_count = batch->count, .wanted = batch->called.wanted };
    if (!glint_pattern_any_odd(batch))
        return;
    for (uint32_t k = 0; k < code->output_count; k++)
        args.result[k] = output[k];
    glint_pattern_call(pattern, frame, code, 0, &args);
    for (uint32_t k = 0; k < batch->count; k++)
        for (unsigned bits = batch->called.odd[k]; bits; bits &= bits - 1) {
            const uint32_t lane = (uint32_t)__builtin_ctz(bits), i = batch->entries[k].group * GLINT_GROUP + lane;
            glint_odd_pattern one = { .count = 1, .material = batch->entries[k].material, .field = field };
            for (int c = 0; c < 3; c++)
                one.point[c] = glint_real_at(points->point[c], frame->plan->desc.precision, i);
            glint_odd_patterns_note(&counts->odd, &one, &output[0][k * GLINT_GROUP + lane], GLINT_PROGRAM_LANES, code->output_count);
        }
}

bool glint_pattern_next(struct glint_pattern *pattern, const glint_tile_frame *frame, glint_pattern_batch *batch)
{
    glint_pattern_called *called = &batch->called;
    batch->count = glint_pattern_take(pattern, &batch->entries);
    if (!batch->count)
        return false;
    batch->own = &frame->plan->patterns->of[batch->entries[0].material];
    batch->args.group_count = batch->count;
    batch->args.wanted = called->wanted;
    batch->args.groups = called->groups;
    batch->args.odd = called->odd;
    for (uint32_t k = 0; k < batch->count; k++) {
        called->groups[k] = batch->entries[k].group;
        called->wanted[k] = batch->entries[k].lanes;
    }
    return true;
}

static void count_lanes(const glint_pattern_batch *batch, glint_tile_counts *counts)
{
    for (uint32_t k = 0; k < batch->count; k++)
        counts->work.patterns += glint_count_lanes(batch->entries[k].lanes);
}

void glint_pattern_run_batch(struct glint_pattern *pattern, const glint_tile_frame *frame,
                             const glint_pattern_points *points, glint_pattern_batch *batch, glint_tile_counts *counts)
{
    const glint_plan_pattern *own = batch->own;
    for (int field = 0; field < GLINT_FIELD_PLANES; field++) {
        if (!(own->made & points->fields & 1u << field))
            continue;
        if (own->program[field]) {
            glint_program_code buffer;
            const glint_program_code *code =
                glint_pattern_point_planes(batch, frame, points, field, &own->program[field]->code, &buffer);
            glint_pattern_call(pattern, frame, code, 0, &batch->args);
            note_odd(pattern, batch, frame, points, field, code, counts);
        }
        glint_pattern_finish(batch, points, frame->plan, field);
    }
}

static bool has_planes(const glint_plan_pattern *own, uint32_t fields) { return own->made & fields; }

/// Runs the programs of all listed entries.
static void run_list(struct glint_pattern *pattern, const glint_tile_frame *frame, const glint_pattern_points *points,
                     glint_tile_counts *counts)
{
    glint_pattern_batch batch = { .count = 0 };
    while (glint_pattern_next(pattern, frame, &batch)) {
        count_lanes(&batch, counts);
        glint_pattern_gather(&pattern->inputs, frame, points, batch.own->reads, batch.entries, batch.count);
        glint_pattern_run_batch(pattern, frame, points, &batch, counts);
    }
}

bool glint_pattern_run(struct glint_pattern *pattern, const glint_tile_frame *frame, const glint_pattern_points *points,
                       glint_tile_counts *counts)
{
    glint_pattern_find_lanes(pattern, frame->plan->patterns, points, has_planes);
    const bool any = pattern->count > 0;
    run_list(pattern, frame, points, counts);
    return any;
}

glint_pattern_points glint_pattern_points_of(const glint_tile *tile)
{
    glint_pattern_points points; // field by field: an initializer would clear everything first, which is slower
    points.group_count = tile->group_count;
    points.hits = tile->at.hits;
    points.back = tile->hit.back;
    points.prim = tile->at.prim;
    points.material = tile->surface.material;
    points.only = tile->at.only;
    points.t = tile->owner ? NULL : tile->at.t;
    points.tile = tile;
    points.planes = tile->at.planes;
    points.fields = GLINT_FIELDS_PLANES;
    points.shading = false;
    for (int c = 0; c < 3; c++) {
        points.direction[c] = NULL;
        points.point[c] = tile->surface.point[c];
        points.normal[c] = tile->unbumped[c] ? (const void *)tile->unbumped[c] : tile->surface.normal[c];
    }
    return points;
}

bool glint_pattern_needs_normals(const glint_plan *plan)
{
    const uint32_t normals = 1u << GLINT_INPUT_N_X | 1u << GLINT_INPUT_N_Y | 1u << GLINT_INPUT_N_Z;
    const glint_plan_patterns *patterns = plan->patterns;
    return patterns && (patterns->bumps || patterns->shaders || patterns->reads & normals);
}

uint32_t glint_tile_fields_shown(const glint_tile *tile, const glint_plan *plan)
{
    uint32_t fields = 0, last = GLINT_MISS;
    for (uint32_t g = 0; plan->patterns && g < tile->group_count; g++) {
        const uint32_t *material = tile->surface.material + (size_t)g * GLINT_GROUP;
        if (glint_all_are(material, last)) // the common case
            continue;
        for (unsigned bits = tile->at.hits[g]; bits; bits &= bits - 1) {
            const uint32_t m = material[__builtin_ctz(bits)];
            if (m == last)
                continue;
            last = m;
            fields |= plan->patterns->of[m].made;
            if (tile->at.only)
                return fields;
        }
    }
    return fields;
}

bool glint_tile_find_painted(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_pattern_points points = { .group_count = tile->group_count,
                                          .hits = tile->at.hits,
                                          .material = tile->surface.material,
                                          .only = tile->at.only,
                                          .fields = GLINT_FIELDS_PLANES }; // the list only depends on these
    glint_pattern_find_lanes(tile->pattern, frame->plan->patterns, &points, has_planes);
    return tile->pattern->count > 0;
}

void glint_tile_painted_lanes(const glint_tile *tile, uint16_t painted[GLINT_TILE_GROUPS])
{
    memset(painted, 0, GLINT_TILE_GROUPS * sizeof *painted);
    for (uint32_t k = 0; k < tile->pattern->count; k++)
        painted[tile->pattern->lanes[k].group] |= tile->pattern->lanes[k].lanes;
}

bool glint_tile_pattern_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    glint_cached_tile *cached = tile->cached;
    const bool known = cached && glint_key_equal(cached->pattern, frame->plan->keys[GLINT_STAGE_PATTERN]);
    if (known || (cached && frame->reuse->caches_pattern &&
                  (k ? cached->planes != NULL : glint_reuse_hold_planes(frame->reuse, cached))))
        tile->at.planes = cached->planes + (size_t)k * frame->plan->patterns->plane_count * GLINT_TILE_SAMPLES;
    return known;
}

void glint_tile_pattern(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_pattern_points points = glint_pattern_points_of(tile);
    run_list(tile->pattern, frame, &points, &tile->counts);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_PATTERN, false);
}

void glint_tile_find_patterns(glint_tile *tile, const glint_tile_frame *frame)
{
    if (glint_tile_find_painted(tile, frame))
        glint_tile_pattern(tile, frame);
}

const glint_shade_planes *glint_tile_shade_planes(const glint_tile *tile, const glint_plan *plan,
                                                  glint_shade_planes *planes)
{
    if (!plan->patterns || !(plan->patterns->any || plan->patterns->shaders))
        return NULL;
    for (int c = 0; c < 3; c++) {
        planes->diffuse[c] = glint_plane_of(tile->at.planes, plan, GLINT_FIELD_DIFFUSE, c);
        planes->ambient[c] = glint_plane_of(tile->at.planes, plan, GLINT_FIELD_AMBIENT, c);
        planes->specular[c] = glint_plane_of(tile->at.planes, plan, GLINT_FIELD_SPECULAR, c);
    }
    planes->shininess = glint_plane_of(tile->at.planes, plan, GLINT_FIELD_SHININESS, 0);
    planes->alpha = glint_plane_of(tile->at.planes, plan, GLINT_FIELD_ROUGHNESS, 0);
    for (int k = 0; k < GLINT_SHADER_TERMS; k++)
        planes->shaded[k / 3][k % 3] =
            plan->runs[GLINT_STAGE_SHADER] && !plan->accumulate ? tile->pattern->shaded[k] : NULL;
    vec_copy(planes->ambient_light, plan->ambient);
    return planes;
}
