// Schedules the runs: one case at a time in random order, so that a slow phase of the machine affects all cases
// equally.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

// Returns the next number of SplitMix64: good enough for the order of runs, and the same with every C library.
static uint64_t next_random(cost_study *study)
{
    uint64_t z = study->random += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

double cost_left_ms(const cost_study *study)
{
    return study->deadline_ms > 0 ? study->deadline_ms - glintL_now_ms() : INFINITY;
}

void cost_show(const cost_study *study, const char *what, double step_ms, double remaining_ms)
{
    if (study->output->progress)
        cli_progress_step(study->output->progress, what, glintL_now_ms() - study->start_ms, step_ms, remaining_ms);
}

// ---- The budget ----

double cost_round_ms(const cost_study *study)
{
    double sum = 0;
    for (int i = 0; i < study->case_count; i++)
        sum += study->cases[i].is_left_out ? 0 : study->cases[i].estimate_ms;
    return sum;
}

static void name_case(const cost_study *study, int index, char out[COST_LABEL_SIZE])
{
    for (int i = 0; i < study->row_count; i++)
        if (study->rows[i].measured == index)
            cost_row_name(&study->rows[i], out);
}

// Drops the slowest case except the script's own. False: there is no other.
static bool drop_slowest(cost_study *study)
{
    char name[COST_LABEL_SIZE];
    int slowest = 0;
    for (int i = 1; i < study->case_count; i++) {
        const cost_case *c = &study->cases[i];
        if (!c->is_left_out && c->run_count > 0 && (slowest == 0 || c->estimate_ms > study->cases[slowest].estimate_ms))
            slowest = i;
    }
    if (slowest == 0)
        return false;
    study->cases[slowest].is_left_out = true;
    name_case(study, slowest, name);
    return cost_leave_out(study, "%s: timed once: the budget leaves no time for %d runs", name, COST_RUNS_LEAST);
}

static bool fit_budget(cost_study *study)
{
    const int wanted = study->runs;
    while (cost_round_ms(study) * COST_RUNS_LEAST > cost_left_ms(study) && drop_slowest(study))
        ;
    const double fitting = floor(cost_left_ms(study) / cost_round_ms(study));
    if (fitting < study->runs)
        study->runs = fitting > 1 ? (int)fitting : 1;
    if (study->runs < wanted)
        cost_leave_out(study, "%d of %d runs of each setting", wanted - study->runs, wanted);
    return !study->run->exit_code;
}

// ---- The runs ----

static void shuffle(cost_study *study, int *order, int count)
{
    for (int i = count - 1; i > 0; i--) {
        int j = (int)(next_random(study) % ((uint64_t)i + 1)), other = order[j];
        order[j] = order[i];
        order[i] = other;
    }
}

static bool run_round(cost_study *study, int *order, int count, double remaining)
{
    shuffle(study, order, count);
    for (int i = 0; i < count; i++) {
        cost_case *c = &study->cases[order[i]];
        const double step = c->estimate_ms;
        remaining -= step;
        cost_show(study, "timing", step, remaining);
        if (cost_is_stopped(study) || !cost_run(study, c))
            return false;
    }
    return true;
}

static bool is_timed(const cost_case *c) { return !c->is_left_out && c->run_count > 0; }

// Lists the timed cases; with `more`, only cases that are too close to a neighbour and may run again. *ms: the time
// of one round.
static int list_cases(cost_study *study, bool more, int *order, double *ms)
{
    int count = 0;
    *ms = 0;
    if (more)
        cost_summarize(study);
    for (int i = 0; i < study->case_count; i++) {
        const cost_case *c = &study->cases[i];
        if (!is_timed(c) || (more && (c->run_count >= study->most_runs || cost_is_apart(study, i))))
            continue;
        order[count++] = i;
        *ms += c->estimate_ms;
    }
    return count;
}

// Runs the cases again whose quartile range overlaps a neighbour's. If the ranges always overlap, the two cost the
// same.
static bool distinguish(cost_study *study, int *order)
{
    double ms;
    int count;
    while ((count = list_cases(study, true, order, &ms)) > 0 && ms <= cost_left_ms(study))
        if (!run_round(study, order, count, ms))
            return false;
    return count == 0 || cost_leave_out(study, "more runs of %d settings whose times still overlap: the budget "
                                               "leaves no time", count);
}

bool cost_time_cases(cost_study *study)
{
    double ms;
    bool good = fit_budget(study);
    int *order = malloc(((size_t)study->case_count + 1) * sizeof *order);
    if (!order)
        return glintL_run_fail(study->run, GLINTL_EXIT_FAILED, 0, "out of memory");
    const int count = list_cases(study, false, order, &ms);
    for (int round = 0; round < study->runs && good; round++)
        good = run_round(study, order, count, ms * (study->runs - round));
    if (good && study->runs >= COST_RUNS_LEAST)
        good = distinguish(study, order);
    free(order);
    return good;
}

// ---- Quartiles ----

static int by_value(const void *a, const void *b)
{
    double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

static double quantile(const double *sorted, int count, double share)
{
    double at = share * (count - 1);
    int low = (int)at, high = low + 1 < count ? low + 1 : low;
    return sorted[low] + (at - low) * (sorted[high] - sorted[low]);
}

void cost_summarize(cost_study *study)
{
    double sorted[COST_RUNS_MAX];
    for (int i = 0; i < study->case_count; i++) {
        cost_case *c = &study->cases[i];
        for (int part = 0; part < COST_PART_COUNT && c->run_count > 0; part++) {
            memcpy(sorted, c->ms[part], sizeof sorted);
            qsort(sorted, (size_t)c->run_count, sizeof *sorted, by_value);
            c->time[part] =
                (cost_quartiles) { sorted[0], quantile(sorted, c->run_count, 0.25), quantile(sorted, c->run_count, 0.5),
                                   quantile(sorted, c->run_count, 0.75) };
        }
    }
}

double cost_time_ms(const cost_case *c) { return c->time[COST_CPU].median; }

double cost_quartile_range(const cost_case *c) { return c->time[COST_CPU].q3 - c->time[COST_CPU].q1; }

bool cost_is_apart(const cost_study *study, int index)
{
    const cost_case *c = &study->cases[index], *below = NULL, *above = NULL;
    for (int i = 0; i < study->case_count; i++) {
        const cost_case *other = &study->cases[i];
        if (i == index || !is_timed(other))
            continue;
        const double ms = cost_time_ms(other);
        if (ms <= cost_time_ms(c) && (!below || ms > cost_time_ms(below)))
            below = other;
        if (ms >= cost_time_ms(c) && (!above || ms < cost_time_ms(above)))
            above = other;
    }
    return (!below || below->time[COST_CPU].q3 < c->time[COST_CPU].q1) &&
           (!above || above->time[COST_CPU].q1 > c->time[COST_CPU].q3);
}
