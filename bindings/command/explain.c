// glint explain SCRIPT: the plan of one frame: its effects and their origins, its stages, the expected rays.
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/command/points.h"
#include "bindings/run/order.h"

static void print_frame(FILE *out, const glintL_run *run, const glint_render_desc *desc)
{
    fprintf(out, "%s, frame %" PRId64 ": %" PRId64 " x %" PRId64 ", %" PRId64 " sample%s a pixel, decided in %s precision\n", run->script,
            run->explain_frame, desc->width, desc->height, desc->samples, desc->samples == 1 ? "" : "s",
            desc->precision == GLINT_PRECISION_FLOAT ? "float" : "double");
}

// Prints the stages that each axis of the sweep runs again, and the order of the axes.
static void print_order(FILE *out, const glintL_order *order)
{
    fputs("\nsweep\n  axes: ", out);
    for (int i = 0; i < order->axis_count; i++)
        fprintf(out, "%s runs %s; ", order->axes[i].name, order->axes[i].stages[0] ? order->axes[i].stages : "nothing");
    for (int i = 0; i < order->axis_count; i++)
        fprintf(out, "%s%s", i ? ", " : "order: ", order->axes[order->by_work[i]].name);
    fputc('\n', out);
}

// Prints `,"sweep":{"axes":[{"name":"lamp.position","stages":"light, occlude, shade"}],"order":["lamp.position"]}`.
static void print_order_json(FILE *out, const glintL_order *order)
{
    fputs(",\"sweep\":{\"axes\":[", out);
    for (int i = 0; i < order->axis_count; i++) {
        fputs(i ? "," : "", out);
        glintL_json(out, "{\"name\":%s,\"stages\":%s}", order->axes[i].name, order->axes[i].stages);
    }
    fputs("],\"order\":[", out);
    for (int i = 0; i < order->axis_count; i++) {
        fputs(i ? "," : "", out);
        glintL_json(out, "%s", order->axes[order->by_work[i]].name);
    }
    fputs("]}", out);
}

static double beyond_surfaces(const glint_ray_counts *rays)
{
    return (double)rays->mirror + (double)rays->refraction + (double)rays->indirect;
}

// Returns an upper bound of the shadow rays at the first hits of mirrored, refracted and indirect rays.
static double shadow_beyond(const glint_ray_counts *rays)
{
    return rays->primary ? beyond_surfaces(rays) * (double)(rays->shadow / rays->primary) : 0;
}

#define MANY 64 // shadow rays beyond a surface for each sample: worth a line

static void print_beyond(FILE *out, const glint_ray_counts *rays)
{
    const double count = shadow_beyond(rays);
    if (count == 0)
        return;
    fprintf(out, "  shadow     %.0f more at most where these rays hit first\n", count);
    if (count >= MANY * (double)rays->primary)
        fprintf(out, "             for each sample of a pixel: %.0f rays beyond the surface x %" PRIu64 " shadow rays. Fewer by reflection_samples,\n"
                     "             indirect = { samples = ... }, or samples of a lamp\n",
                beyond_surfaces(rays) / (double)rays->primary, rays->shadow / rays->primary);
}

static void write_for_people(FILE *out, const glintL_run *run)
{
    const glint_effect *effects;
    const glint_stage_info *stages;
    const glint_plan *plan = run->explain_plan;
    size_t effect_count = glint_plan_effects(plan, &effects), stage_count = glint_plan_stages(plan, &stages);
    glint_ray_counts rays = glint_plan_expected_rays(plan);
    print_frame(out, run, glint_plan_render_desc(plan));
    fputs("\neffects\n", out);
    for (size_t i = 0; i < effect_count; i++)
        fprintf(out, "  %-28s %s\n", effects[i].effect, effects[i].caller);
    if (effect_count == 0)
        fputs("  none\n", out);
    fputs("\nstages\n", out);
    for (size_t i = 0; i < stage_count; i++)
        fprintf(out, "  %-9s %.12s  %s\n", stages[i].name, stages[i].key, stages[i].why);
    fprintf(out, "\nrays\n  primary    %" PRIu64 "\n  shadow     %" PRIu64 " at most\n", rays.primary, rays.shadow);
    if (rays.mirror)
        fprintf(out, "  mirror     %" PRIu64 " at most\n", rays.mirror);
    if (rays.refraction)
        fprintf(out, "  refraction %" PRIu64 " at most\n", rays.refraction);
    if (rays.indirect)
        fprintf(out, "  indirect   %" PRIu64 " at most\n", rays.indirect);
    print_beyond(out, &rays);
    if (run->explain_order)
        print_order(out, run->explain_order);
}

// Prints the plan. The names in it come from the script. False: out of memory.
static bool print_for_people(FILE *out, const glintL_run *run)
{
    char *text = NULL;
    size_t size = 0;
    FILE *made = open_memstream(&text, &size);
    if (made)
        write_for_people(made, run);
    text = made ? glintL_close_text(made, &text) : NULL;
    if (text)
        glintL_put_text(out, text, size);
    const bool good = text != NULL;
    free(text);
    return good;
}

// Prints the instructions of each program, one per line.
static void print_programs(FILE *out, const glint_plan *plan)
{
    glint_program_use use;
    for (size_t i = 0; glint_plan_program(plan, i, &use); i++) {
        char *listing = glint_program_listing(use.program);
        const bool named = use.material && use.material[0];
        fprintf(out, "\n%s%s%s%s.%s\n", use.material ? "material" : "scene", named ? " '" : "",
                named ? use.material : "", named ? "'" : "", use.field);
        for (char *line = listing, *end; line && *line; line = end) {
            end = line + strcspn(line, "\n");
            fprintf(out, "  %.*s\n", (int)(end - line), line);
            end += *end == '\n';
        }
        free(listing);
    }
}

// Prints `,"programs":[{"material":"floor","field":"diffuse","instructions":3,"rows":2,"listing":"..."}]`. The scene's
// own programs have no material.
static void print_programs_json(FILE *out, const glint_plan *plan)
{
    glint_program_use use;
    fputs(",\"programs\":[", out);
    for (size_t i = 0; glint_plan_program(plan, i, &use); i++) {
        char *listing = glint_program_listing(use.program);
        fputs(i ? ",{" : "{", out);
        if (use.material)
            glintL_json(out, "\"material\":%s,", use.material);
        glintL_json(out, "\"field\":%s", use.field);
        fprintf(out, ",\"instructions\":%zu,\"rows\":%zu", glint_program_length(use.program), glint_program_rows(use.program));
        glintL_json(out, ",\"listing\":%s}", listing ? listing : "");
        free(listing);
    }
    fputc(']', out);
}

static void print_json(FILE *out, const glintL_run *run, bool programs)
{
    const glint_effect *effects;
    const glint_stage_info *stages;
    const glint_plan *plan = run->explain_plan;
    const glint_render_desc *desc = glint_plan_render_desc(plan);
    size_t effect_count = glint_plan_effects(plan, &effects), stage_count = glint_plan_stages(plan, &stages);
    glint_ray_counts rays = glint_plan_expected_rays(plan);
    glintL_json(out, "{\"event\":\"plan\",\"script\":%s", run->script);
    fprintf(out,
            ",\"index\":%" PRId64 ",\"width\":%" PRId64 ",\"height\":%" PRId64 ",\"samples\":%" PRId64 ",\"precision\":\"%s\",\"effects\":[",
            run->explain_frame, desc->width, desc->height, desc->samples,
            desc->precision == GLINT_PRECISION_FLOAT ? "float" : "double");
    for (size_t i = 0; i < effect_count; i++) {
        fputs(i ? "," : "", out);
        glintL_json(out, "{\"effect\":%s,\"caller\":%s}", effects[i].effect, effects[i].caller);
    }
    fputs("],\"stages\":[", out);
    for (size_t i = 0; i < stage_count; i++) {
        fputs(i ? "," : "", out);
        glintL_json(out, "{\"name\":%s,\"key\":%s,\"why\":%s}", stages[i].name, stages[i].key, stages[i].why);
    }
    fputs("],", out);
    cli_print_rays(out, &rays);
    fprintf(out, ",\"shadow_beyond\":%.0f", shadow_beyond(&rays));
    if (run->explain_order)
        print_order_json(out, run->explain_order);
    if (programs)
        print_programs_json(out, plan);
    fputs("}\n", out);
}

// Runs the script for each value of --sweep, plans the frame, and finds the order. False: the script failed at some
// value, which was reported, or the run has failed.
static bool explain_points(cli_options *options, cli_output *output, glintL_run *run)
{
    cli_script script;
    cli_sweep_to(options, run, 1);
    cli_run_script(&script, options, run);
    const int64_t frames = script.has_jobs && script.frames == run->count ? script.frames : 0;
    const int64_t point = frames ? (run->explain_frame - 1) / frames + 1 : 1;
    cli_close_script(&script);
    if (run->exit_code || run->interrupted || !frames)
        return true;
    if (point > cli_sweep_points(options)) {
        run->count = frames * cli_sweep_points(options); // number of frames, for the message
        return true;
    }
    if (point > 1) {
        run->count = run->point_first = frames * (point - 1);
        cli_sweep_to(options, run, point);
        cli_run_script(&script, options, run);
        cli_close_script(&script);
    }
    return !run->explain_plan || cli_order_points(options, output, run);
}

int cli_explain(cli_options *options, cli_output *output, glintL_run *run)
{
    run->mode = GLINTL_MODE_EXPLAIN;
    run->explain_frame = options->frame;
    glintL_selection_clear(&run->request.selection); // here --frame is not a selection
    bool good = true;
    if (options->sweep_count) {
        good = explain_points(options, output, run);
    } else {
        cli_script script;
        cli_run_script(&script, options, run);
        cli_close_script(&script);
    }
    if (!run->exit_code && !run->interrupted && !run->explain_plan)
        glintL_run_fail(run, GLINTL_EXIT_USAGE, 0,
                        "--frame: expected a frame of the script, 1 .. %" PRId64 ", got '%" PRId64 "'", run->count,
                        options->frame);
    if (run->interrupted)
        return GLINTL_EXIT_FAILED;
    if (run->exit_code)
        return cli_report_error(output, run->failed_index, run->exit_code, run->message);
    if (options->json)
        print_json(output->data, run, options->programs);
    else
        good = print_for_people(output->data, run) && good;
    if (options->programs && !options->json)
        print_programs(output->data, run->explain_plan);
    return good ? GLINTL_EXIT_DONE : GLINTL_EXIT_USAGE;
}
