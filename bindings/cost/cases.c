// The settings that a study measures, each once, and the table rows that show them: one knob at a time, varied around
// the script's own setting.
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

bool cost_leave_out(cost_study *study, const char *format, ...)
{
    char line[512];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    char **grown = realloc(study->left_out, ((size_t)study->left_out_count + 1) * sizeof *grown);
    char *copy = grown ? strdup(line) : NULL;
    if (grown)
        study->left_out = grown;
    if (!copy)
        return glintL_run_fail(study->run, GLINTL_EXIT_FAILED, 0, "out of memory");
    study->left_out[study->left_out_count++] = copy;
    return true;
}

// Returns the index of the new case; -1: out of memory.
static int add_case(cost_study *study, const int choice[COST_KNOBS_MAX])
{
    cost_case *grown = realloc(study->cases, ((size_t)study->case_count + 1) * sizeof *grown);
    if (!grown)
        return -1;
    study->cases = grown;
    memset(&grown[study->case_count], 0, sizeof *grown);
    memcpy(grown[study->case_count].choice, choice, COST_KNOBS_MAX * sizeof *choice);
    return study->case_count++;
}

static bool add_row(cost_study *study, const cost_row *row)
{
    cost_row *grown = realloc(study->rows, ((size_t)study->row_count + 1) * sizeof *grown);
    if (!grown || row->measured < 0)
        return glintL_run_fail(study->run, GLINTL_EXIT_FAILED, 0, "out of memory");
    study->rows = grown;
    grown[study->row_count++] = *row;
    return true;
}

static void choose_base(int choice[COST_KNOBS_MAX])
{
    for (int i = 0; i < COST_KNOBS_MAX; i++)
        choice[i] = -1;
}

static bool add_knob(cost_study *study, int knob)
{
    const cost_values *values = &study->values[knob];
    int choice[COST_KNOBS_MAX];
    for (int i = 0; i < values->count; i++) {
        cost_row row = { .knob = knob, .value = i, .is_default = i == values->own };
        cost_value_text(values->value[i], row.label);
        choose_base(choice);
        choice[knob] = i;
        row.measured = i == values->base ? 0 : add_case(study, choice);
        if (!add_row(study, &row))
            return false;
        if (cost_knobs[knob].source == COST_ERROR_FILE)
            study->cases[row.measured].needs_file = true;
    }
    return true;
}

// Returns whether --knobs names the knob, or is not given.
static bool is_request(const char *list, const char *name)
{
    for (const char *at = list; at; at = *at ? at + 1 : NULL) {
        size_t length = strcspn(at, ",");
        if (strlen(name) == length && strncmp(at, name, length) == 0)
            return true;
        at += length;
    }
    return list == NULL;
}

// Reports that no knob of --knobs changes anything in this scene, and names those that would.
static bool refuse_knobs(cost_study *study, const cost_subject *subject)
{
    char others[256] = "";
    size_t used = 0;
    for (int i = 0; i < cost_knob_count; i++) {
        cost_values values = { 0 };
        cost_knobs[i].list(subject, &values);
        if (values.count > 0 && used < sizeof others)
            used += (size_t)snprintf(others + used, sizeof others - used, "%s%s", used ? ", " : "", cost_knobs[i].name);
    }
    return glintL_run_fail(study->run, GLINTL_EXIT_USAGE, 0,
                           "--knobs: expected a knob that changes this scene (%s), got '%.200s'", others,
                           study->options->knobs);
}

static bool list_values(cost_study *study, const cost_subject *subject)
{
    const char *request = study->options->knobs;
    int found = 0;
    for (int i = 0; i < cost_knob_count; i++) {
        const cost_knob *knob = &cost_knobs[i];
        if (!is_request(request, knob->name))
            continue;
        knob->list(subject, &study->values[i]);
        found += study->values[i].count > 0;
        if (request && study->values[i].count == 0 &&
            !cost_leave_out(study, "%s: changes nothing in this scene; it would need %s", knob->name, knob->needs))
            return false;
    }
    return found > 0 || refuse_knobs(study, subject);
}

bool cost_list_cases(cost_study *study, const cost_subject *subject)
{
    int choice[COST_KNOBS_MAX];
    if (!list_values(study, subject))
        return false;
    choose_base(choice);
    if (add_case(study, choice) < 0)
        return glintL_run_fail(study->run, GLINTL_EXIT_FAILED, 0, "out of memory");
    for (int i = 0; i < cost_knob_count; i++)
        if (!add_knob(study, i))
            return false;
    return true;
}

bool cost_add_combination(cost_study *study, const int choice[COST_KNOBS_MAX])
{
    cost_row row = { .knob = -1 };
    size_t used = 0;
    for (int i = 0; i < cost_knob_count; i++) {
        char text[32];
        if (choice[i] < 0)
            continue;
        cost_value_text(study->values[i].value[choice[i]], text);
        used += (size_t)snprintf(row.label + used, used < sizeof row.label ? sizeof row.label - used : 0, "%s%s=%s",
                                 used ? " " : "", cost_knobs[i].name, text);
        used = used < sizeof row.label ? used : sizeof row.label;
    }
    row.measured = add_case(study, choice);
    return add_row(study, &row);
}

const cost_knob *cost_row_knob(const cost_row *row) { return row->knob < 0 ? NULL : &cost_knobs[row->knob]; }

const glint_picture_error *cost_row_error(const cost_study *study, const cost_row *row)
{
    const cost_case *c = &study->cases[row->measured];
    const cost_knob *knob = cost_row_knob(row);
    if (!c->has_error)
        return NULL;
    if (!knob || knob->source == COST_ERROR_FILM)
        return &c->film;
    return &c->file;
}

void cost_row_name(const cost_row *row, char out[COST_LABEL_SIZE])
{
    const cost_knob *knob = cost_row_knob(row);
    if (knob)
        snprintf(out, COST_LABEL_SIZE, "%s %.64s", knob->name, row->label);
    else
        snprintf(out, COST_LABEL_SIZE, "%s", row->label);
}
