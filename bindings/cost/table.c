// The table of glint cost for people.
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

void cost_machine(const cost_study *study, char out[256])
{
    char line[256], model[128] = "processor unknown";
    FILE *file = fopen("/proc/cpuinfo", "re");
    while (file && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon)
            continue;
        snprintf(model, sizeof model, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
        break;
    }
    if (file)
        fclose(file);
    const glint_renderer *renderer = study->renderers[false][false];
    int threads = glint_renderer_threads(renderer);
    snprintf(out, 256, "%.100s, %d thread%s, %s, glint " GLINT_VERSION ", compiler %.40s", model, threads,
             threads == 1 ? "" : "s", glint_renderer_isa(renderer), __VERSION__);
}

static void print_head(const cost_study *study, FILE *out)
{
    char machine[256], truth[COST_LABEL_SIZE];
    cost_machine(study, machine);
    cost_truth_name(study, truth);
    fprintf(out, "%s\n", machine);
    if (study->reference)
        fprintf(
            out,
            "reference: the mean of two pictures of %.0f samples a pixel, decided in double, seeds %.0f and %.0f%s; "
            "its own error %.2g RMSE\n",
            study->reference_samples, study->reference_seed[0], study->reference_seed[1], truth,
            study->reference_error.rmse);
    fprintf(out, "\n%-24s %8s %7s %6s %8s %8s %6s %6s %6s %7s %6s %6s %6s\n", "", "ms", "+-", "x", "rmse", "relmse",
            "codes", ">1", ">8", "FLIP", "object", "shadow", "Mrays");
}

static void print_error(const cost_study *study, const cost_row *row, FILE *out)
{
    const glint_picture_error *error = cost_row_error(study, row);
    const cost_case *c = &study->cases[row->measured];
    if (!error)
        fprintf(out, " %8s %8s %6s %6s %6s %7s %6s %6s", "-", "-", "-", "-", "-", "-", "-", "-");
    else
        fprintf(out, " %8.2g %8.2g %6.3g %5.2g%% %5.2g%% %7.2g %6" PRIu64 " %6" PRIu64, error->rmse, error->relmse,
                error->max_code, 100 * error->over1, 100 * error->over8, error->flip, c->wrong_object, c->wrong_shadow);
}

static void print_remarks(const cost_study *study, const cost_row *row, FILE *out)
{
    const cost_case *c = &study->cases[row->measured];
    if (row->is_front)
        fputs("  front", out);
    if (row->measured != 0 && !row->is_partial && row->difference == 0)
        fputs("  no difference in time", out);
    if (cost_row_error(study, row) && !row->is_resolved)
        fputs("  error not resolved", out);
    if (row->is_partial || c->is_left_out)
        fprintf(out, "  partial, %d run%s", c->run_count, c->run_count == 1 ? "" : "s");
    fputc('\n', out);
}

static void print_row(const cost_study *study, const cost_row *row, FILE *out)
{
    const cost_case *c = &study->cases[row->measured];
    const glint_ray_counts *rays = &c->stats.rays;
    double all = (double)rays->primary + (double)rays->shadow + (double)rays->mirror + (double)rays->refraction +
                 (double)rays->indirect;
    if (strlen(row->label) > 22) { // a line of its own
        fprintf(out, " %s%s\n", row->is_default ? "*" : " ", row->label);
        fprintf(out, "  %22s", "");
    } else {
        fprintf(out, " %s%-22s", row->is_default ? "*" : " ", row->label);
    }
    fprintf(out, " %8.4g %7.2g %6.3g", c->time[COST_TOTAL].median, cost_quartile_range(c) / 2, row->x_fastest);
    print_error(study, row, out);
    fprintf(out, " %6.3g", all * 1e-6);
    print_remarks(study, row, out);
}

void cost_print_table(const cost_study *study, FILE *out)
{
    int knob = COST_KNOBS_MAX;
    print_head(study, out);
    for (int i = 0; i < study->row_count; i++) {
        const cost_row *row = &study->rows[i];
        if (study->cases[row->measured].run_count == 0)
            continue;
        if (row->knob != knob)
            fprintf(out, "%s\n", row->knob < 0 ? "combinations" : cost_knobs[row->knob].name);
        knob = row->knob;
        print_row(study, row, out);
    }
    fprintf(
        out,
        "\n* the script's own setting. ms: the median of %d runs, rendering, codes and encoding of a whole frame, +- "
        "half the\nquartile range; x: times the fastest. codes: steps of 8 bits, >1 and >8 the share of pixels. "
        "object, shadow: pixels\nthat see or shade the wrong thing.\n",
        study->runs);
    if (study->left_out_count > 0)
        fputs("left out:\n", out);
    for (int i = 0; i < study->left_out_count; i++)
        fprintf(out, "  %s\n", study->left_out[i]);
    fprintf(out, "\n%s\n", study->advice);
}
