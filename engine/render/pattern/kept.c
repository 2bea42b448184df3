/// Split programs: the results of their first parts are cached for each tile, and only the second parts run. See
/// reuse/splits.h.
#include "engine/render/pattern/work.h"
#include "engine/render/program/program.h"

#include <string.h>

/// The cached results of a sample, in a tile whose key matches.
typedef struct cached_sample {
    double *numbers;
    float *planes;
    uint16_t *truths;
} cached_sample;

static cached_sample sample_at(const glint_cached_tile *cached, const glint_splits *splits, uint32_t k)
{
    cached_sample at = { .numbers = (double *)(void *)((char *)cached->values + k * glint_splits_bytes(splits)) };
    at.planes = (float *)(at.numbers + (size_t)splits->numbers * GLINT_TILE_SAMPLES);
    at.truths = (uint16_t *)(at.planes + (size_t)splits->planes * GLINT_TILE_SAMPLES);
    return at;
}

/// Returns whether all programs of the list are split, or need not run again at all.
static bool are_split(const struct glint_pattern *pattern, const glint_splits *splits)
{
    uint32_t last = GLINT_MISS;
    for (uint32_t i = 0; i < pattern->count; i++) {
        const uint32_t material = pattern->lanes[i].material;
        if (material != last && splits->of[material].whole)
            return false;
        last = material;
    }
    return true;
}

/// Returns whether this frame caches results of the tile. Planes cached for other reasons are stored elsewhere.
static bool may_cache(const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_splits *splits = &frame->reuse->splits;
    return tile->cached && glint_splits_are_on(splits) && !(splits->planes && frame->reuse->caches_pattern) &&
           are_split(tile->pattern, splits);
}

// ---- Booleans ----------------------------------------------------------------------------------------------------

/// Four lanes of numbers from four bits.
static const double numbers_of[16][4] = { { 0, 0, 0, 0 }, { 1, 0, 0, 0 }, { 0, 1, 0, 0 }, { 1, 1, 0, 0 },
                                          { 0, 0, 1, 0 }, { 1, 0, 1, 0 }, { 0, 1, 1, 0 }, { 1, 1, 1, 0 },
                                          { 0, 0, 0, 1 }, { 1, 0, 0, 1 }, { 0, 1, 0, 1 }, { 1, 1, 0, 1 },
                                          { 0, 0, 1, 1 }, { 1, 0, 1, 1 }, { 0, 1, 1, 1 }, { 1, 1, 1, 1 } };

static void unpack(unsigned bits, double to[GLINT_GROUP])
{
    for (int i = 0; i < GLINT_GROUP; i += 4)
        memcpy(to + i, numbers_of[bits >> i & 15], sizeof numbers_of[0]);
}

/// Packs a group's booleans into bits, for `lanes`. Returns false if a value is neither 0 nor 1, such as NaN.
static bool pack(const double from[GLINT_GROUP], unsigned lanes, uint16_t *bits)
{
    unsigned set = 0;
    for (unsigned rest = lanes; rest; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        if (!(from[i] == 0 || from[i] == 1))
            return false;
        set |= (unsigned)(from[i] == 1) << i;
    }
    *bits = (uint16_t)((*bits & ~lanes) | set);
    return true;
}

// ---- The first part -----------------------------------------------------------------------------------------------

/// Caches one of a batch's values. Returns false if that is impossible.
static bool cache_value(const glint_pattern_batch *batch, const double *value, bool truth, uint32_t value_slot,
                        const cached_sample *to)
{
    for (uint32_t k = 0; k < batch->count; k++, value += GLINT_GROUP) {
        const uint32_t group = batch->entries[k].group;
        double *numbers = to->numbers + (size_t)value_slot * GLINT_TILE_SAMPLES + (size_t)group * GLINT_GROUP;
        if (truth && !pack(value, batch->entries[k].lanes, &to->truths[value_slot * GLINT_TILE_GROUPS + group]))
            return false;
        for (unsigned bits = truth ? 0 : batch->entries[k].lanes; bits; bits &= bits - 1)
            numbers[__builtin_ctz(bits)] = value[__builtin_ctz(bits)];
    }
    return true;
}

static glint_program_code part_of(const glint_program_code *part, const glint_program *program)
{
    glint_program_code code = *part;
    code.numbers = program->code.numbers;
    code.textures = program->code.textures;
    return code;
}

/// Runs a program's first part on gathered inputs, and caches its results. Returns false if that is impossible.
static bool cache_first(struct glint_pattern *pattern, const glint_tile_frame *frame, const glint_pattern_batch *batch,
                        const glint_split_field *of, const glint_program *program, const cached_sample *to)
{
    const glint_program_code code = part_of(&of->split->first, program);
    glint_program_args args = { .group_count = batch->count, .wanted = batch->called.wanted };
    bool good = true;
    for (uint32_t k = 0; k < code.output_count; k++)
        args.result[k] = pattern->values[k];
    glint_pattern_call(pattern, frame, &code, 0, &args);
    for (uint32_t k = 0; k < code.output_count && good; k++)
        good = cache_value(batch, pattern->values[k], of->split->truths >> k & 1, of->slot[k], to);
    return good;
}

// ---- The second ---------------------------------------------------------------------------------------------------

static bool are_in_order(const glint_pattern_batch *batch)
{
    for (uint32_t k = 1; k < batch->count; k++)
        if (batch->called.groups[k] != batch->called.groups[0] + k)
            return false;
    return true;
}

/// Sets an input of the second part to a cached value.
static void read_value(struct glint_pattern *pattern, glint_pattern_batch *batch, uint32_t k, bool truth,
                       uint32_t value_slot, const cached_sample *from)
{
    const uint32_t *groups = batch->called.groups;
    const double *numbers = from->numbers + (size_t)value_slot * GLINT_TILE_SAMPLES;
    double *row = pattern->values[k];
    const bool in_place = !truth && are_in_order(batch);
    batch->args.input[k] = in_place ? numbers + (size_t)groups[0] * GLINT_GROUP : row;
    for (uint32_t e = 0; e < batch->count && !in_place; e++, row += GLINT_GROUP) {
        if (truth)
            unpack(from->truths[value_slot * GLINT_TILE_GROUPS + groups[e]] & batch->called.wanted[e], row);
        else
            memcpy(row, numbers + (size_t)groups[e] * GLINT_GROUP, GLINT_GROUP * sizeof *row);
    }
}

/// Computes a second part that only selects by cached booleans, without rows. Returns false if it does more.
static bool choose_outputs(const glint_tile_frame *frame, const glint_pattern_batch *batch, const glint_split_field *of,
                           const glint_program_code *code, const cached_sample *from)
{
    glint_choose_args calls[GLINT_PROGRAM_OUTPUTS_MAX];
    for (uint32_t k = 0; k < code->output_count; k++) {
        glint_choose_args *call = &calls[k];
        const glint_instruction *by = glint_find_choice(code, k, call->number);
        const uint32_t value = by ? by->in[0] - GLINT_ROW_INPUT : GLINT_PROGRAM_OUTPUTS_MAX; // larger for a row or a number
        if (value >= GLINT_PROGRAM_OUTPUTS_MAX || !(of->split->truths >> value & 1))
            return false;
        call->group_count = batch->count;
        call->groups = batch->called.groups;
        call->wanted = batch->called.wanted;
        call->truths = from->truths + (size_t)of->slot[value] * GLINT_TILE_GROUPS;
        call->plane = batch->args.plane[k];
    }
    for (uint32_t k = 0; k < code->output_count; k++)
        frame->stages->choose(&calls[k]);
    return true;
}

/// Runs the second part of a field's program. Returns false if it gave an invalid reflectance.
static bool run_field(glint_tile *tile, const glint_tile_frame *frame, glint_pattern_batch *batch,
                      const glint_split_field *of, const glint_program_code *code, const cached_sample *from)
{
    for (uint32_t k = 0; k < of->split->first.output_count; k++)
        read_value(tile->pattern, batch, k, of->split->truths >> k & 1, of->slot[k], from);
    batch->args.code = code;
    batch->args.rows = tile->pattern->rows;
    batch->args.same = 0;
    frame->stages->program(&batch->args);
    return !glint_pattern_any_odd(batch);
}

/// Runs the second parts of a batch's programs and computes the derived planes. Returns false if one gave an invalid
/// reflectance, which has to be reported with its point.
static bool run_second(glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_points *points,
                       glint_pattern_batch *batch, const cached_sample *from)
{
    const glint_split_material *split = &frame->reuse->splits.of[batch->entries[0].material];
    for (int field = 0; field < GLINT_FIELD_PLANES; field++) {
        const glint_split_field *of = &split->of[field];
        if (!(split->again >> field & 1))
            continue;
        if (of->split) {
            const glint_program_code second = part_of(&of->split->second, batch->own->program[field]);
            glint_program_code buffer;
            const glint_program_code *code = glint_pattern_point_planes(batch, frame, points, field, &second, &buffer);
            if (!choose_outputs(frame, batch, of, code, from) && !run_field(tile, frame, batch, of, code, from))
                return false;
        }
        glint_pattern_finish(batch, points, frame->plan, field);
    }
    return true;
}

// ---- A sample -----------------------------------------------------------------------------------------------------

/// Runs both parts, and the programs that need no split, whose planes are cached.
static bool cache_batch(glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_points *points,
                        glint_pattern_batch *batch, const cached_sample *to)
{
    const glint_split_material *split = &frame->reuse->splits.of[batch->entries[0].material];
    const uint64_t odd = glint_odd_patterns_count(&tile->counts.odd);
    glint_pattern_points rest = *points;
    rest.fields = GLINT_FIELDS_PLANES & ~split->again;
    glint_pattern_gather(&tile->pattern->inputs, frame, points, batch->own->reads, batch->entries, batch->count);
    glint_pattern_run_batch(tile->pattern, frame, &rest, batch, &tile->counts);
    bool good = glint_odd_patterns_count(&tile->counts.odd) == odd; // later frames must report it, too
    for (int field = 0; field < GLINT_FIELD_PLANES && good; field++)
        if (split->of[field].split)
            good = cache_first(tile->pattern, frame, batch, &split->of[field], batch->own->program[field], to);
    return good && run_second(tile, frame, points, batch, to);
}

/// Runs all listed programs, and adds to the counts. known: the values of the first parts are cached.
static bool run_split(glint_tile *tile, const glint_tile_frame *frame, const cached_sample *at, bool known)
{
    const glint_odd_patterns odd = tile->counts.odd;
    const uint64_t patterns = tile->counts.work.patterns;
    const glint_pattern_points points = glint_pattern_points_of(tile);
    glint_pattern_batch batch = { .count = 0 };
    bool good = true;
    while (good && glint_pattern_next(tile->pattern, frame, &batch)) {
        for (uint32_t k = 0; k < batch.count; k++)
            tile->counts.work.patterns += glint_count_lanes(batch.entries[k].lanes);
        good = known ? run_second(tile, frame, &points, &batch, at) : cache_batch(tile, frame, &points, &batch, at);
    }
    if (good) {
        glint_tile_count_stage(tile, frame, GLINT_STAGE_PATTERN, false);
        return true;
    }
    tile->counts.odd = odd;
    tile->counts.work.patterns = patterns;
    glint_tile_find_painted(tile, frame); // entries were taken off the list
    return false;
}

bool glint_tile_recall_pattern(glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    const glint_splits *splits = &frame->reuse->splits;
    tile->painted++;
    if (!may_cache(tile, frame) || !glint_key_equal(tile->cached->split, splits->key))
        return false;
    const cached_sample at = sample_at(tile->cached, splits, k);
    if (splits->planes)
        tile->at.planes = at.planes;
    return run_split(tile, frame, &at, true);
}

void glint_tile_cache_pattern(glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    const glint_splits *splits = &frame->reuse->splits;
    const bool caches = may_cache(tile, frame) && !glint_key_equal(tile->cached->split, splits->key) &&
                        glint_reuse_hold_values(frame->reuse, tile->cached);
    if (caches) {
        const cached_sample at = sample_at(tile->cached, splits, k);
        tile->cached->split = (glint_key) { 0 };
        if (splits->planes)
            tile->at.planes = at.planes;
        if (run_split(tile, frame, &at, false)) {
            tile->cached_samples++;
            return;
        }
    }
    glint_tile_pattern(tile, frame);
}

static void sign(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    (void)walk;
    if (frame->reuse->caches_pattern && tile->cached->planes)
        tile->cached->pattern = frame->plan->keys[GLINT_STAGE_PATTERN];
    if (tile->cached_samples > 0 && tile->cached_samples == tile->painted)
        tile->cached->split = frame->reuse->splits.key;
}

static bool gives_numbers(const glint_plan *plan)
{
    return plan->geometry->table.prim_count > 0 && plan->patterns && (plan->patterns->any || plan->patterns->bumps);
}

static glint_key own_key(const glint_plan *plan, glint_key key) { return glint_programs_key(plan, GLINT_FIELDS_PLANES, key); }

const glint_stage glint_stage_pattern = {
    .name = "pattern",
    .doc = "programs of materials at each visible point",
    .called = gives_numbers,
    .own = own_key,
    .reads = GLINT_READS_OWN(PATTERN),
    .step[GLINT_AT_KEYS] = sign,
    .aside = true, // stages that read its results also read the materials with their programs
};
