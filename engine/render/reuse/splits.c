#include "engine/render/reuse/splits.h"
#include "engine/base/alloc.h"

#include <stdlib.h>
#include <string.h>

// Costs of computing the inputs of programs, in tenths of a nanosecond per sample.
#define COST_OF_POINTS 20u ///< cost of the points if all shapes are spheres and planes
#define COST_OF_SURFACES 40u ///< cost with other shapes, whose normals are computed together with the points

static const glint_key none;

static void clear_field(glint_split_field *f)
{
    free(f->numbers);
    free(f->changed);
    free(f->now);
    glint_split_destroy(f->split);
    *f = (glint_split_field) { .number_count = 0 };
}

void glint_splits_clear(glint_splits *splits)
{
    for (uint32_t i = 0; i < splits->material_count; i++)
        for (int field = 0; field < GLINT_FIELD_PLANES; field++)
            clear_field(&splits->of[i].of[field]);
    free(splits->of);
    *splits = (glint_splits) { .of = NULL };
}

// ---- Changes ---------------------------------------------------------------------------------------------

static glint_key like_of(const glint_plan_pattern *own, int field)
{
    const glint_program *program = own->program[field];
    const glint_key parts[] = { own->numbers, own->spaces };
    return program ? glint_key_add(program->structure, parts, sizeof parts) : none;
}

/// Records a program whose structure differs from the last frame's program. Returns false when out of memory.
static bool begin_field(glint_split_field *f, const glint_program *program, glint_key like)
{
    clear_field(f);
    if (!program)
        return true;
    f->numbers = malloc((program->number_count + 1u) * sizeof *f->numbers);
    f->changed = calloc(program->number_count + 1u, sizeof *f->changed);
    f->now = calloc(program->number_count + 1u, sizeof *f->now);
    if (!f->numbers || !f->changed || !f->now)
        return false;
    f->like = like;
    f->number_count = program->number_count;
    for (uint32_t i = 0; i < f->number_count; i++)
        f->numbers[i] = program->code.numbers[i][0];
    return true;
}

/// Marks the numbers that have changed since the last frame. Returns whether some changed for the first time.
static bool find_changes(glint_split_field *f, const glint_program *program)
{
    bool more = false;
    for (uint32_t i = 0; i < f->number_count; i++) {
        const double *number = &program->code.numbers[i][0];
        f->now[i] = memcmp(&f->numbers[i], number, sizeof *number) != 0;
        f->numbers[i] = *number;
        more = more || (f->now[i] && !f->changed[i]);
    }
    return more;
}

static bool any_changed(const glint_split_field *f)
{
    bool any = false;
    for (uint32_t i = 0; i < f->number_count; i++)
        any = any || f->changed[i];
    return any;
}

/// Returns whether a material's programs share planes: results of some programs are overwritten by planes derived
/// from them, so that all programs must run again.
static bool is_joined(const glint_plan_pattern *own)
{
    return own->made >> GLINT_FIELD_AMBIENT & 1 || own->desc.normalized;
}

/// Splits a material's programs. saved: the cost saved if no program runs as a whole. Returns false when out of memory.
static bool split(glint_split_material *m, const glint_plan_pattern *own, uint32_t saved)
{
    uint32_t cost = 0;
    m->again = 0;
    m->whole = false;
    for (int field = 0; field < GLINT_FIELD_PLANES; field++)
        m->again |= any_changed(&m->of[field]) ? 1u << field : 0;
    if (m->again && is_joined(own))
        m->again = own->made & GLINT_FIELDS_PLANES;
    for (int field = 0; field < GLINT_FIELD_PLANES; field++) {
        glint_split_field *f = &m->of[field];
        glint_split_destroy(f->split);
        f->split = NULL;
        if (!(m->again >> field & 1) || !own->program[field])
            continue;
        if (!glint_split_create(own->program[field], f->changed, &f->split))
            return false;
        m->whole = m->whole || !f->split;
        cost += f->split ? f->split->cost : 0;
        saved += f->split ? f->split->saved : 0;
    }
    m->whole = m->whole || cost >= saved;
    return true;
}

/// Does the same when numbers change for the first time. First splits by all numbers that ever changed. If caching
/// does not pay then, splits only by the numbers that have just changed.
static bool split_again(glint_split_material *m, const glint_plan_pattern *own, uint32_t saved)
{
    for (int field = 0; field < GLINT_FIELD_PLANES; field++)
        for (uint32_t i = 0; i < m->of[field].number_count; i++)
            m->of[field].changed[i] = m->of[field].changed[i] || m->of[field].now[i];
    if (!split(m, own, saved))
        return false;
    if (!m->whole)
        return true;
    for (int field = 0; field < GLINT_FIELD_PLANES; field++)
        if (m->of[field].number_count)
            memcpy(m->of[field].changed, m->of[field].now, m->of[field].number_count * sizeof *m->of[field].now);
    return split(m, own, saved);
}

/// Compares a material's programs with the last frame's programs, and splits them by the numbers that changed.
/// Returns false when out of memory.
static bool follow(glint_split_material *m, const glint_plan_pattern *own, uint32_t saved)
{
    bool more = false, other = false;
    for (int field = 0; field < GLINT_FIELD_PLANES; field++) {
        const glint_key like = like_of(own, field);
        if (!glint_key_equal(m->of[field].like, like)) {
            other = true;
            if (!begin_field(&m->of[field], own->program[field], like))
                return false;
        }
        more = find_changes(&m->of[field], own->program[field]) || more;
    }
    return more ? split_again(m, own, saved) : !other || split(m, own, saved);
}

// ---- Cached values -------------------------------------------------------------------------------------------------

static uint32_t larger(uint32_t a, uint32_t b) { return a > b ? a : b; }

/// Assigns positions in the cache to a material's cached values.
static void assign_slots(glint_splits *splits, glint_split_material *m, const glint_plan_patterns *patterns,
                         uint32_t made)
{
    uint32_t numbers = 0, truths = 0;
    for (int field = 0; field < GLINT_FIELD_PLANES && !m->whole; field++) {
        glint_split_field *f = &m->of[field];
        for (uint32_t k = 0; f->split && k < f->split->first.output_count; k++)
            f->slot[k] = f->split->truths >> k & 1 ? truths++ : numbers++;
    }
    splits->numbers = larger(splits->numbers, numbers);
    splits->truths = larger(splits->truths, truths);
    if (made & GLINT_FIELDS_PLANES & ~m->again && !m->whole)
        splits->planes = patterns->plane_count;
}

/// Returns the key of everything that the cached values depend on.
static glint_key cached_key(const glint_splits *splits)
{
    glint_key key = splits->surface;
    for (uint32_t i = 0; i < splits->material_count; i++)
        for (int field = 0; field < GLINT_FIELD_PLANES; field++) {
            const glint_split_field *f = &splits->of[i].of[field];
            key = glint_key_add(key, &f->like, sizeof f->like);
            if (f->number_count)
                key = glint_key_add(key, f->changed, f->number_count * sizeof *f->changed);
            for (uint32_t n = 0; n < f->number_count; n++)
                if (!f->changed[n])
                    key = glint_key_add(key, &f->numbers[n], sizeof f->numbers[n]);
        }
    return key;
}

static bool begin(glint_splits *splits, const glint_plan *plan)
{
    if (splits->material_count == plan->material_count &&
        glint_key_equal(splits->surface, plan->keys[GLINT_STAGE_SURFACE]))
        return true;
    glint_splits_clear(splits);
    splits->of = glint_alloc(plan->material_count, sizeof *splits->of);
    splits->material_count = splits->of ? plan->material_count : 0;
    splits->surface = plan->keys[GLINT_STAGE_SURFACE];
    return splits->of;
}

void glint_splits_begin(glint_splits *splits, const glint_plan *plan)
{
    const glint_plan_patterns *patterns = plan->patterns;
    const glint_geometry_table *table = &plan->geometry->table;
    const uint32_t saved = table->triangles || table->solids ? COST_OF_SURFACES : COST_OF_POINTS;
    bool good = patterns && patterns->any && begin(splits, plan), any = false;
    for (uint32_t i = 0; good && i < plan->material_count; i++) {
        good = follow(&splits->of[i], &patterns->of[i], saved);
        any = any || (splits->of[i].again && !splits->of[i].whole);
    }
    if (!good) {
        glint_splits_clear(splits);
        return;
    }
    splits->numbers = splits->planes = splits->truths = 0;
    for (uint32_t i = 0; any && i < plan->material_count; i++)
        assign_slots(splits, &splits->of[i], patterns, patterns->of[i].made);
    splits->key = any ? cached_key(splits) : none;
}
