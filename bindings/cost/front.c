// Evaluates the measurements: the Pareto front of time and error, combinations worth measuring, and one sentence of
// advice.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

#define RESOLVED 10 // times the reference's own error: larger errors are resolved
#define CANDIDATES_MAX 4096
#define CLEARLY 0.95 // a knob is combined with others if it has less than this share of the time or error
#define CHEAPER 0.8 // a step that loses accuracy is advised if it takes less than this share of the time
#define STEEP 0.8 // of the steps worth at least this share of the best one, the fastest is advised

static double range_of(const cost_case *a, const cost_case *b)
{
    return fmax(cost_quartile_range(a), cost_quartile_range(b));
}

// ---- Combinations of good settings ----

typedef struct candidate {
    int choice[COST_KNOBS_MAX];
    double ms, error; // predicted
} candidate;

// Returns whether the value is clearly faster than the script's own, or clearly more accurate.
static bool is_useful(const cost_study *study, const cost_row *row)
{
    const cost_case *c = &study->cases[row->measured], *own = &study->cases[0];
    return c->has_error && c->run_count > 0 &&
           (c->guess_cpu_ms < CLEARLY * own->guess_cpu_ms || c->film.rmse < CLEARLY * own->film.rmse);
}

// Combines every candidate so far with each useful value of one more knob. Times multiply; errors are independent, so
// their squares add.
static int extend(const cost_study *study, int knob, candidate *list, int count)
{
    const cost_case *base = &study->cases[0];
    int before = count;
    for (int r = 0; r < study->row_count; r++) {
        const cost_row *row = &study->rows[r];
        const cost_case *c = &study->cases[row->measured];
        if (row->knob != knob || row->measured == 0 || !is_useful(study, row))
            continue;
        for (int i = 0; i < before && count < CANDIDATES_MAX; i++) {
            candidate *new = &list[count++];
            *new = list[i];
            new->choice[knob] = row->value;
            new->ms *= c->guess_cpu_ms / base->guess_cpu_ms;
            double square = new->error *new->error + c->film.rmse * c->film.rmse - base->film.rmse * base->film.rmse;
            new->error = sqrt(fmax(square, 0));
        }
    }
    return count;
}

static int turned(const candidate *c)
{
    int count = 0;
    for (int i = 0; i < COST_KNOBS_MAX; i++)
        count += c->choice[i] >= 0;
    return count;
}

static bool is_beaten(const candidate *list, int count, const candidate *c)
{
    for (int i = 0; i < count; i++)
        if (list[i].ms <= c->ms && list[i].error <= c->error && (list[i].ms < c->ms || list[i].error < c->error))
            return true;
    return false;
}

static int by_time(const void *a, const void *b)
{
    const candidate *left = a, *right = b;
    return (left->ms > right->ms) - (left->ms < right->ms);
}

// Moves the promising combinations to the front of the list, fastest first. Returns how many there are; -1: out of
// memory.
static int choose_candidates(candidate *list, int count)
{
    candidate *all = malloc((size_t)count * sizeof *all);
    int chosen = 0;
    if (!all)
        return -1;
    memcpy(all, list, (size_t)count * sizeof *all);
    for (int i = 0; i < count; i++)
        if (turned(&all[i]) > 1 && !is_beaten(all, count, &all[i]))
            list[chosen++] = all[i];
    free(all);
    qsort(list, (size_t)chosen, sizeof *list, by_time);
    return chosen;
}

bool cost_add_combinations(cost_study *study)
{
    candidate *list = malloc(CANDIDATES_MAX * sizeof *list);
    int count = 1;
    if (!list)
        return glintL_run_fail(study->run, GLINTL_EXIT_FAILED, 0, "out of memory");
    list[0] = (candidate) { .ms = study->cases[0].guess_cpu_ms, .error = study->cases[0].film.rmse };
    for (int i = 0; i < COST_KNOBS_MAX; i++)
        list[0].choice[i] = -1;
    for (int knob = 0; knob < cost_knob_count; knob++)
        if (cost_knobs[knob].combines)
            count = extend(study, knob, list, count);
    count = choose_candidates(list, count);
    bool good = count >= 0 || glintL_run_fail(study->run, GLINTL_EXIT_FAILED, 0, "out of memory");
    const int wanted = count < COST_COMBINATIONS_MAX ? count : COST_COMBINATIONS_MAX;
    for (int i = 0; i < wanted && good; i++) // evenly spread over the front
        good = cost_add_combination(study, list[wanted > 1 ? i * (count - 1) / (wanted - 1) : 0].choice);
    free(list);
    return good;
}

// ---- Comparing rows ----

static bool is_point(const cost_study *study, const cost_row *row)
{
    const cost_knob *knob = cost_row_knob(row);
    return !(knob && knob->is_other_time) && cost_row_error(study, row) && study->cases[row->measured].run_count > 0;
}

// Returns whether row a beats row b: a is more accurate and not slower, or as accurate and faster. Times differ only if
// by more than the smaller of the two quartile ranges, so that a disturbed row does not pass for fast; with equal
// errors any difference counts. As accurate: within the reference's own error.
static bool beats(const cost_study *study, const cost_row *a, const cost_row *b)
{
    const cost_case *ca = &study->cases[a->measured], *cb = &study->cases[b->measured];
    const double ea = cost_row_error(study, a)->rmse, eb = cost_row_error(study, b)->rmse;
    const double ta = cost_time_ms(ca), tb = cost_time_ms(cb);
    const double noise = fmin(cost_quartile_range(ca), cost_quartile_range(cb));
    return (ea < eb && ta <= tb + noise) || (ea == eb && ta < tb) ||
           (ea <= eb + study->reference_error.rmse && ta < tb - noise);
}

static void judge_row(cost_study *study, cost_row *row)
{
    const cost_case *c = &study->cases[row->measured], *own = &study->cases[0];
    const glint_picture_error *error = cost_row_error(study, row);
    const double difference = cost_time_ms(c) - cost_time_ms(own);
    row->is_resolved = error && error->rmse >= RESOLVED * study->reference_error.rmse;
    row->is_partial = !error || (!c->is_left_out && c->run_count < study->runs) || c->is_first_alone;
    row->difference = fabs(difference) <= range_of(c, own) ? 0 : difference < 0 ? -1 : 1;
    row->is_apart = cost_is_apart(study, row->measured);
    row->is_front = is_point(study, row);
    for (int i = 0; i < study->row_count && row->is_front; i++)
        if (is_point(study, &study->rows[i]) && beats(study, &study->rows[i], row))
            row->is_front = false;
}

static void compare_times(cost_study *study)
{
    double fastest = INFINITY;
    for (int i = 0; i < study->row_count; i++)
        if (study->cases[study->rows[i].measured].run_count > 0)
            fastest = fmin(fastest, cost_time_ms(&study->cases[study->rows[i].measured]));
    for (int i = 0; i < study->row_count; i++)
        study->rows[i].x_fastest = cost_time_ms(&study->cases[study->rows[i].measured]) / fastest;
}

// ---- The advice ----

static void spell_share(double share, char out[48])
{
    static const struct {
        double share;
        const char *words;
    } known[] = { { 1.0 / 2, "half the" },
                  { 1.0 / 3, "a third of the" },
                  { 2.0 / 3, "two thirds of the" },
                  { 1.0 / 4, "a quarter of the" },
                  { 3.0 / 4, "three quarters of the" },
                  { 1.0 / 5, "a fifth of the" },
                  { 1.0 / 10, "a tenth of the" },
                  { 1, "the same" } };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (fabs(share / known[i].share - 1) < 0.06) {
            snprintf(out, 48, "%s", known[i].words);
            return;
        }
    snprintf(out, 48, share < 0.1 ? "%.1g of the" : "%.2g times the", share);
}

// Writes "samples 4 -> 16" or "samples=16 precision=float instead of the script's setting".
static void spell_step(const cost_study *study, const cost_row *row, char out[2 * COST_LABEL_SIZE])
{
    char own[32];
    const cost_knob *knob = cost_row_knob(row);
    if (!knob) {
        snprintf(out, 2 * COST_LABEL_SIZE, "%s instead of the script's setting", row->label);
        return;
    }
    cost_value_text(study->values[row->knob].value[study->values[row->knob].own], own);
    snprintf(out, 2 * COST_LABEL_SIZE, "%s %s -> %s", knob->name, own, row->label);
}

// Returns whether a row may be advised: only if it decides no more pixels wrongly than the script's own setting.
static bool is_eligible(const cost_study *study, const cost_row *row)
{
    const cost_case *c = &study->cases[row->measured], *own = &study->cases[0];
    return row->measured != 0 && is_point(study, row) &&
           c->wrong_object + c->wrong_shadow <= own->wrong_object + own->wrong_shadow;
}

// Returns the value of a step: accuracy gained for its time, or time saved for the same picture; 0: not advised.
static double worth(const cost_study *study, const cost_row *row)
{
    const cost_case *c = &study->cases[row->measured], *own = &study->cases[0];
    if (!is_eligible(study, row))
        return 0;
    const double e = own->film.rmse / cost_row_error(study, row)->rmse;
    const double t = cost_time_ms(c) / cost_time_ms(own);
    if (e >= 0.98 && row->difference < 0) // as accurate or better, and faster
        return 1e3 / t;
    if (!(e >= 1.5))
        return 0;
    return row->difference == 0 ? 1e3 * e : log(e) / log(fmax(t, 1.01)); // 1e3: more accurate at no cost
}

// Returns the fastest step among those with nearly the best value.
static const cost_row *find_step(const cost_study *study)
{
    const cost_row *step = NULL;
    double best = 0;
    for (int i = 0; i < study->row_count; i++)
        best = fmax(best, worth(study, &study->rows[i]));
    for (int i = 0; i < study->row_count && best > 0; i++) {
        const cost_row *row = &study->rows[i];
        if (worth(study, row) >= STEEP * best && (!step || row->x_fastest < step->x_fastest))
            step = row;
    }
    return step;
}

static void advise_step(cost_study *study, const cost_row *row)
{
    char step[2 * COST_LABEL_SIZE], error[48], time[48];
    const cost_case *c = &study->cases[row->measured], *own = &study->cases[0];
    spell_step(study, row, step);
    spell_share(cost_row_error(study, row)->rmse / own->film.rmse, error);
    spell_share(cost_time_ms(c) / cost_time_ms(own), time);
    if (row->difference == 0)
        snprintf(time, sizeof time, "no difference in the");
    snprintf(study->advice, sizeof study->advice, "%s: %s time, %s error%s", step, time, error,
             row->is_resolved ? "" : " or less (too small to resolve against the reference)");
}

// Returns the row with the least error among those that save much time. Used when no setting is more accurate than the
// script's.
static const cost_row *find_cheaper(const cost_study *study)
{
    const cost_row *best = NULL;
    for (int i = 0; i < study->row_count; i++) {
        const cost_row *row = &study->rows[i];
        const double share = cost_time_ms(&study->cases[row->measured]) / cost_time_ms(&study->cases[0]);
        if (is_eligible(study, row) && row->is_resolved && row->difference < 0 && share < CHEAPER &&
            (!best || cost_row_error(study, row)->rmse < cost_row_error(study, best)->rmse))
            best = row;
    }
    return best;
}

static void advise(cost_study *study)
{
    const cost_row *best = study->cases[0].has_error ? find_step(study) : NULL;
    if (!study->cases[0].has_error || study->cases[0].run_count == 0)
        snprintf(study->advice, sizeof study->advice, "no advice: %s",
                 study->is_complete ? "the budget left no time for another setting"
                                    : "the study was interrupted too early");
    else if (best || (best = find_cheaper(study)) != NULL)
        advise_step(study, best);
    else
        snprintf(study->advice, sizeof study->advice, "keep the script's setting: no setting here is faster or more "
                                                      "accurate");
}

void cost_judge(cost_study *study)
{
    cost_summarize(study);
    compare_times(study);
    for (int i = 0; i < study->row_count; i++)
        judge_row(study, &study->rows[i]);
    advise(study);
}
