// Reports of a run: one JSON object per line with --json, otherwise lines and a progress bar.
#include <errno.h>
#include <inttypes.h>
#include <string.h>

#include "bindings/command/cli.h"
#include "bindings/run/system.h"

#define SLOW_MS 10 // a line of a frame tells the time of a script that takes longer
#define CLIPPED_HINT 0.1 // share of clipped pixels above which a picture looks washed out

// Ends a line of data. If the reader has gone or the disk is full, the run ends.
void cli_end_line(cli_output *output)
{
    fputc('\n', output->data);
    cli_restart_calls(true);
    errno = 0;
    const bool good = fflush(output->data) == 0;
    cli_restart_calls(false);
    if (good || output->data_failed)
        return;
    output->data_failed = true;
    output->data_errno = errno;
    if (output->run)
        glintL_run_fail(output->run, errno == ENOSPC ? GLINTL_EXIT_LATER : GLINTL_EXIT_FAILED, 0, "stdout: %s",
                        strerror(errno));
}

// ---- Frames as JSON ----

static void print_ms(FILE *out, const char *before, double ms) { fprintf(out, "%s%.3f", before, ms); }

static void print_times(FILE *out, const glintL_record *record)
{
    const glint_frame_stats *stats = &record->stats;
    print_ms(out, ",\"ms\":{\"build\":", record->build_ms);
    print_ms(out, ",\"render\":", stats->render_ms);
    print_ms(out, ",\"tone\":", stats->tone_ms);
    print_ms(out, ",\"encode\":", record->encode_ms);
    print_ms(out, ",\"write\":", record->write_ms);
    fputs(",\"stages\":{", out);
    for (int i = 0; i < stats->stage_count; i++)
        fprintf(out, "%s\"%s\":%.3f", i ? "," : "", stats->stage_name[i], stats->stage_ms[i]);
    fputs("}},\"stages\":{", out);
    for (int i = 0; i < stats->stage_count; i++)
        fprintf(out, "%s\"%s\":\"%s\"", i ? "," : "", stats->stage_name[i],
                stats->stage_reused[i] == 1  ? "reused"
                : stats->stage_reused[i] > 0 ? "partial"
                                             : "run");
    fputc('}', out);
}

void cli_print_rays(FILE *out, const glint_ray_counts *rays)
{
    fprintf(out,
            "\"rays\":{\"primary\":%" PRIu64 ",\"shadow\":%" PRIu64 ",\"mirror\":%" PRIu64 ",\"refraction\":%" PRIu64
            ",\"indirect\":%" PRIu64 "}",
            rays->primary, rays->shadow, rays->mirror, rays->refraction, rays->indirect);
}

static void print_pass_files(FILE *out, const glintL_record *record)
{
    int count = 0;
    char name[GLINTL_PASS_NAME_SIZE];
    for (int pass = 0; pass < record->slots; pass++) {
        char light[GLINT_NAME_SIZE];
        if (pass == GLINT_PASS_BEAUTY || !record->files[pass])
            continue;
        fputs(count++ ? "," : ",\"passes\":{", out);
        if (pass < GLINT_PASS_DERIVATIVE)
            snprintf(name, sizeof name, "%s", glint_pass_name((glint_pass)pass));
        else if (pass < GLINT_PASS_LIGHT)
            snprintf(name, sizeof name, "d:%s", record->derivative[pass - GLINT_PASS_DERIVATIVE]);
        else if (glintL_light_pass_at(record->light_passes, (size_t)pass - GLINT_PASS_LIGHT, light))
            snprintf(name, sizeof name, "light:%s", light);
        glintL_json(out, "%s:%s", name, record->files[pass]);
    }
    if (count)
        fputc('}', out);
}

static void print_frame_json(cli_output *output, const glintL_record *record)
{
    FILE *out = output->data;
    fprintf(out, "{\"event\":\"frame\",\"index\":%" PRId64, record->index);
    glintL_json(out, ",\"file\":%s", record->files[GLINT_PASS_BEAUTY]);
    print_pass_files(out, record);
    fprintf(out, ",\"status\":\"%s\"", record->kept ? "kept" : "rendered");
    if (record->repeat)
        fprintf(out, ",\"repeat\":%d", record->repeat);
    if (record->samples > 0)
        glintL_json(out, ",\"samples\":%g,\"error\":%g", record->samples, record->error);
    print_times(out, record);
    fputc(',', out);
    cli_print_rays(out, &record->stats.rays);
    fprintf(out, ",\"refined\":%" PRIu64, record->stats.refined);
    if (*record->derivative[0] && !record->kept)
        glintL_json(out, ",\"shifted\":%g", (double)record->stats.shifted / record->pixel_count);
    if (record->kept) { // the pixels of a kept frame were not read
        fputs(",\"clipped\":null,\"nonfinite\":null}", out);
    } else {
        glintL_json(out, ",\"clipped\":%g", (double)record->stats.clipped / record->pixel_count);
        fprintf(out, ",\"nonfinite\":%" PRIu64 "}", record->stats.nonfinite);
    }
    cli_end_line(output);
}

// ---- Frames for people ----

// Prints one line for each range of kept frames, after its last frame.
static void print_kept(cli_output *output)
{
    if (output->kept_first == 0)
        return;
    if (output->kept_first == output->kept_last)
        fprintf(stderr, "frame %" PRId64 ": kept, already finished\n", output->kept_first);
    else
        fprintf(stderr, "frames %" PRId64 "-%" PRId64 ": kept, already finished\n", output->kept_first, output->kept_last);
    output->kept_first = 0;
}

static void print_frame_line(cli_output *output, const glintL_record *record)
{
    const char *file = record->files[GLINT_PASS_BEAUTY];
    double ms = record->stats.render_ms + record->stats.tone_ms + record->encode_ms + record->write_ms;
    if (output->kept_first == 0 || record->index != output->kept_last + 1 || !record->kept)
        print_kept(output);
    if (record->kept) {
        if (output->kept_first == 0)
            output->kept_first = record->index;
        output->kept_last = record->index;
        return;
    }
    fprintf(stderr, "frame %" PRId64, record->index);
    if (record->repeat)
        fprintf(stderr, ", repeat %d", record->repeat);
    fputs(": ", stderr);
    if (file)
        glintL_put_text(stderr, file, strlen(file));
    fputs(file ? ", " : "", stderr);
    if (record->build_ms >= SLOW_MS)
        fprintf(stderr, "script %.2f s, render %.2f s", record->build_ms * 1e-3, ms * 1e-3);
    else
        fprintf(stderr, "%.1f ms", ms);
    if (record->samples > 0)
        fprintf(stderr, ", %.0f samples, error %.3g", record->samples, record->error);
    fputc('\n', stderr);
}

static void warn_odd(const cli_output *output, int64_t index, const glint_odd *odd, glint_odd_kind kind)
{
    static const char *const is[] = { "NaN", "below 0", "above 2^100" };
    static const char *const cures[] = {
        "glint uses 0 there; look for 0 / 0, or the square root or logarithm of a negative number",
        "glint uses 0 there; write glint.max(0, x) to make this explicit", "glint uses 2^100 there; look for a division by 0"
    };
    const bool background = strcmp(odd->field, "background") == 0, named = odd->material[0];
    glintL_run_warn(output->run, "frame %" PRId64 ": %s%s%s%s.%s: the pattern is %s at %" PRIu64 " %s, such as (%.6g, %.6g, %.6g); %s",
                    index, background ? "scene" : "material", named ? " '" : "", odd->material, named ? "'" : "", odd->field,
                    is[kind], odd->count, background ? "directions" : "points", odd->point[0], odd->point[1], odd->point[2],
                    cures[kind]);
}

static void report_frame(void *context, const glintL_run *run, const glintL_record *record)
{
    cli_output *output = context;
    if (output->progress)
        cli_progress_clear(output->progress);
    if (output->json)
        print_frame_json(output, record);
    else if (!output->quiet && (!output->progress || record->repeat || record->samples > 0))
        print_frame_line(output, record);
    for (int kind = 0; kind < GLINT_ODD_COUNT; kind++)
        if (record->stats.odd[kind].count > 0 && !record->kept)
            warn_odd(output, record->index, &record->stats.odd[kind], (glint_odd_kind)kind);
    if (record->stats.nonfinite > 0 && !record->kept)
        glintL_run_warn(output->run,
                        "frame %" PRId64 ": %" PRIu64 " pixels are not finite; they are written as 0 or white",
                        record->index, record->stats.nonfinite);
    if (output->progress)
        cli_progress_update(output->progress, run, false);
}

static void report_rendering(void *context, const glintL_run *run, bool begins)
{
    cli_output *output = context;
    if (output->progress)
        cli_progress_update(output->progress, run, begins);
}

static void report_step(void *context, const glintL_step *step)
{
    cli_output *output = context;
    if (output->progress)
        cli_progress_samples(output->progress, step);
    if (output->json) {
        glintL_json(output->data, "{\"event\":\"step\",\"index\":%g,\"step\":%g,\"samples\":%g,\"ms\":%g,\"error\":%g}", (double)step->index,
                    (double)step->number, step->samples, step->ms, step->error);
        cli_end_line(output);
    } else if (!output->progress && !output->quiet) {
        print_kept(output);
        fprintf(stderr, "frame %" PRId64 ": step %d, %.0f samples, %.2f s, error %.3g\n", step->index, step->number, step->samples,
                step->ms * 1e-3, step->error);
    }
}

static void report_warning(void *context, const char *message)
{
    cli_output *output = context;
    print_kept(output);
    cli_print_warning(output, message);
    cli_warning_event(output, message);
}

void cli_warning_event(cli_output *output, const char *message)
{
    if (!output->json)
        return;
    glintL_json(output->data, "{\"event\":\"warning\",\"message\":%s}", message);
    cli_end_line(output);
}

static void report_figure(void *context, const char *kind, const char *path, int64_t count)
{
    cli_output *output = context;
    if (output->progress)
        cli_progress_film(output->progress, NULL, 0, 0);
    if (output->json) {
        glintL_json(output->data, "{\"event\":%s,\"file\":%s", kind, path);
        fprintf(output->data, ",\"frames\":%" PRId64 "}", count);
        cli_end_line(output);
    } else if (!output->quiet) {
        print_kept(output);
        glintL_put_text(stderr, path, strlen(path));
        fprintf(stderr, ": %s of %" PRId64 " frame%s\n", kind, count, count == 1 ? "" : "s");
    }
}

static void report_making(void *context, const char *path, size_t done, size_t count)
{
    cli_output *output = context;
    if (output->progress)
        cli_progress_film(output->progress, glintL_base_name(path), done, count);
}

glintL_reporter cli_reporter(cli_output *output)
{
    return (glintL_reporter) { .context = output,
                               .rendering = report_rendering,
                               .frame = report_frame,
                               .step = report_step,
                               .warn = report_warning,
                               .figure = report_figure,
                               .making = report_making };
}

// ---- The end ----

int cli_report_error(cli_output *output, int64_t index, int exit_code, const char *message)
{
    print_kept(output);
    cli_print_error(output, message);
    output->failure_printed = output->failure_printed || output->data_failed;
    if (!output->json || output->data_failed)
        return exit_code;
    fputs("{\"event\":\"error\"", output->data);
    if (index > 0)
        fprintf(output->data, ",\"index\":%" PRId64, index);
    glintL_json(output->data, ",\"message\":%s", message);
    fprintf(output->data, ",\"exit\":%d}", exit_code);
    cli_end_line(output);
    return exit_code;
}

void cli_warn_clipped(glintL_run *run)
{
    glintL_warn_of_clipping(run);
    double clipped = run->pixels ? (double)run->clipped / (double)run->pixels : 0;
    if (clipped > CLIPPED_HINT && run->brightness.clipped == 0)
        glintL_run_warn(run,
                        "%.0f %% of the pixels are brighter than white and lose detail; use dimmer lights, "
                        "--exposure -1 or --tone filmic",
                        100 * clipped);
}

// Prints the numbered names that replace a name without a number, because the job has several frames.
static void print_numbering(const glintL_run *run)
{
    const char *name = run->request.render_text[glintL_render_find("output")];
    const char *dot = name ? strrchr(name, '.') : NULL;
    if (!dot || run->count < 2 || run->done == 0 || glintL_name_has_number(name) ||
        glintL_film_kind_of(name, run->request.apng) != GLINTL_FILM_NONE)
        return;
    const int stem = (int)(dot - name);
    fprintf(stderr,
            "-o %s: writing %" PRId64 " numbered files, %.*s_####%s; to make a film, use -o %.*s.mp4, .webm, .gif or "
            ".apng\n",
            name, run->count, stem, name, dot, stem, name);
}

void cli_report_end(cli_output *output)
{
    const glintL_run *run = output->run;
    double seconds = (glintL_now_ms() - output->start_ms) * 1e-3;
    if (output->json) {
        fprintf(output->data,
                "{\"event\":\"end\",\"frames\":%" PRId64 ",\"kept\":%" PRId64 ",\"seconds\":%.3f,\"peak_bytes\":%lld}",
                run->done, run->kept, seconds, glintL_peak_bytes());
        cli_end_line(output);
    }
    if (output->quiet)
        return;
    if (output->progress)
        cli_progress_clear(output->progress);
    print_kept(output);
    if (!output->json)
        print_numbering(run);
    if (!output->json)
        fprintf(stderr, "%" PRId64 " frame%s in %.2f s, %" PRId64 " kept\n", run->done, run->done == 1 ? "" : "s",
                seconds, run->kept);
}
