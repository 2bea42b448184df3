// The rows of glint cost for programs: one object a line, the advice last.
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "bindings/cost/cost.h"

static void print_number(FILE *out, const char *name, double value)
{
    fprintf(out, ",\"%s\":", name);
    glintL_json_number(out, value);
}

static void print_flag(FILE *out, const char *name, bool value)
{
    fprintf(out, ",\"%s\":%s", name, value ? "true" : "false");
}

static void print_value(FILE *out, cost_value value)
{
    if (value.text)
        glintL_json_string(out, value.text);
    else
        glintL_json_number(out, value.number);
}

static void print_setting(const cost_study *study, const cost_row *row, FILE *out)
{
    const cost_knob *knob = cost_row_knob(row);
    fputs("{\"knob\":", out);
    glintL_json_string(out, knob ? knob->name : "combination");
    fputs(",\"value\":", out);
    if (knob)
        print_value(out, study->values[row->knob].value[row->value]);
    else
        glintL_json_string(out, row->label);
}

static void print_ms(const cost_case *c, FILE *out)
{
    const cost_quartiles *time = &c->time[COST_TOTAL];
    fprintf(out, ",\"ms\":{\"min\":%.4f,\"q1\":%.4f,\"median\":%.4f,\"q3\":%.4f}", time->min, time->q1, time->median,
            time->q3);
}

static void print_error(const cost_study *study, const cost_row *row, FILE *out)
{
    const glint_picture_error *error = cost_row_error(study, row);
    const cost_case *c = &study->cases[row->measured];
    if (!error) {
        fputs(",\"rmse\":null,\"relmse\":null,\"max_code\":null,\"over1\":null,\"over8\":null,\"flip\":null,"
              "\"wrong_object\":null,\"wrong_shadow\":null",
              out);
        return;
    }
    print_number(out, "rmse", error->rmse);
    print_number(out, "relmse", error->relmse);
    print_number(out, "max_code", error->max_code);
    print_number(out, "over1", error->over1);
    print_number(out, "over8", error->over8);
    print_number(out, "flip", error->flip);
    fprintf(out, ",\"wrong_object\":%" PRIu64 ",\"wrong_shadow\":%" PRIu64, c->wrong_object, c->wrong_shadow);
}

static void print_counters(const cost_case *c, FILE *out)
{
    const glint_ray_counts *rays = &c->stats.rays;
    const double unknown = NAN; // printed as null
    fprintf(out,
            ",\"counters\":{\"primary\":%" PRIu64 ",\"shadow\":%" PRIu64 ",\"mirror\":%" PRIu64
            ",\"refraction\":%" PRIu64 ",\"indirect\":%" PRIu64,
            rays->primary, rays->shadow, rays->mirror, rays->refraction, rays->indirect);
    fprintf(out, ",\"refined\":%" PRIu64, c->stats.refined);
    print_number(out, "tests", c->is_counted ? (double)c->work.tests : unknown);
    print_number(out, "light_samples", c->is_counted ? (double)c->work.light_samples : unknown);
    print_number(out, "powers", c->is_counted ? (double)c->work.powers : unknown);
    print_number(out, "sites", c->is_counted ? (double)c->work.sites : unknown);
    print_number(out, "overlaps", c->is_counted ? (double)c->work.overlaps : unknown);
    print_number(out, "lights_seen", c->is_counted ? (double)c->work.lights_seen : unknown);
    fputc('}', out);
}

static void print_choice(const cost_study *study, const cost_case *c, FILE *out)
{
    const char *before = ",\"settings\":{";
    for (int i = 0; i < cost_knob_count; i++) {
        if (c->choice[i] < 0)
            continue;
        fprintf(out, "%s\"%s\":", before, cost_knobs[i].name);
        print_value(out, study->values[i].value[c->choice[i]]);
        before = ",";
    }
    fputc('}', out);
}

static void print_row(const cost_study *study, const cost_row *row, FILE *out)
{
    static const char *const differences[] = { "faster", "no difference", "slower" };
    const cost_case *c = &study->cases[row->measured];
    print_setting(study, row, out);
    print_ms(c, out);
    fprintf(out, ",\"x_fastest\":%.4f", row->x_fastest);
    print_error(study, row, out);
    print_counters(c, out);
    print_flag(out, "pareto", row->is_front);
    print_flag(out, "default", row->is_default);
    print_flag(out, "resolved", row->is_resolved);
    fprintf(out, ",\"difference\":\"%s\",\"runs\":%d,\"frames_a_run\":%d", differences[row->difference + 1],
            c->run_count, c->batch > 0 && !c->is_first_alone ? c->batch : 1);
    print_flag(out, "partial", row->is_partial);
    fprintf(out, ",\"parts\":{\"render\":%.4f,\"tone\":%.4f,\"encode\":%.4f},\"cpu_ms\":%.4f",
            c->time[COST_RENDER].median, c->time[COST_TONE].median, c->time[COST_ENCODE].median,
            c->time[COST_CPU].median);
    if (row->knob < 0)
        print_choice(study, c, out);
    fputs("}\n", out);
}

static void print_reference(const cost_study *study, FILE *out)
{
    if (!study->reference) {
        fputs(",\"reference\":null", out);
        return;
    }
    fprintf(out, ",\"reference\":{\"samples\":%.0f,\"seeds\":[%.0f,%.0f]", study->reference_samples,
            study->reference_seed[0], study->reference_seed[1]);
    print_number(out, "rmse", study->reference_error.rmse);
    print_number(out, "relmse", study->reference_error.relmse);
    print_number(out, "max_code", study->reference_error.max_code);
    print_number(out, "flip", study->reference_error.flip);
    fputc('}', out);
}

void cost_print_json(const cost_study *study, FILE *out)
{
    char machine[256];
    for (int i = 0; i < study->row_count; i++)
        if (study->cases[study->rows[i].measured].run_count > 0)
            print_row(study, &study->rows[i], out);
    cost_machine(study, machine);
    fputs("{\"event\":\"advice\",\"text\":", out);
    glintL_json_string(out, study->advice);
    print_reference(study, out);
    fputs(",\"left_out\":[", out);
    for (int i = 0; i < study->left_out_count; i++) {
        fputs(i ? "," : "", out);
        glintL_json_string(out, study->left_out[i]);
    }
    fputs("],\"machine\":", out);
    glintL_json_string(out, machine);
    fprintf(out, ",\"width\":%.0f,\"height\":%.0f,\"seconds\":%.3f", study->own->desc.width, study->own->desc.height,
            (glintL_now_ms() - study->start_ms) * 1e-3);
    print_flag(out, "complete", study->is_complete);
    fputs("}\n", out);
}
