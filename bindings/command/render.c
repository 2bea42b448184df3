// glint render SCRIPT: the script's frames into files.
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/command/cli.h"
#include "bindings/run/film.h"

static bool finish_point(cli_script *script, const cli_options *options, glintL_run *run)
{
    bool good = cli_run_script(script, options, run) && glintL_call_settle(run);
    cli_close_script(script);
    return good;
}

// Whether a point of the sweep has none of this shard's frames, so that the script need not run for it.
static bool is_empty_point(glintL_run *run, int64_t frames)
{
    int64_t from, to, first = run->count + 1, last = run->count + frames;
    glintL_selection_part(&run->request.selection, 1, frames * run->point_count, &from, &to);
    int64_t before = glintL_selection_count(&run->request.selection, 1, run->count);
    int64_t here = glintL_selection_count(&run->request.selection, first, last);
    return here == 0 || before + 1 > to || before + here < from;
}

static bool run_points(cli_options *options, glintL_run *run)
{
    cli_script script;
    int64_t frames = 0;
    run->point_count = cli_sweep_points(options);
    if (run->point_count == 0)
        return finish_point(&script, options, run);
    for (run->point = 1; run->point <= run->point_count; run->point++) {
        run->point_first = run->count;
        if (frames > 0 && is_empty_point(run, frames)) {
            run->count += frames;
            continue;
        }
        cli_sweep_to(options, run, run->point);
        if (!finish_point(&script, options, run))
            return false;
        frames = script.has_jobs ? script.frames : 0;
    }
    return true;
}

bool cli_finish_frames(glintL_run *run, bool good)
{
    good = glintL_run_collect(run, true) && good; // what was handed over is finished in any case
    good = good && !run->interrupted && glintL_films_finish(run);
    // The calls of a loop are counted as they come: only now is it known what the selection leaves of them.
    good = good && (run->count == 0 || glintL_selection_settle(run, 1, run->count));
    if (good)
        cli_warn_clipped(run);
    return good;
}

int cli_render(cli_options *options, cli_output *output, glintL_run *run)
{
    if (!output->quiet)
        output->progress = cli_progress_create(output->color);
    bool good = run_points(options, run);
    if (!cli_finish_frames(run, good))
        glintL_films_keep(run);
    if (run->interrupted) {
        cli_report_error(output, 0, 128 + (int)run->interrupted, "interrupted");
    } else if (run->exit_code) {
        cli_report_error(output, run->failed_index, run->exit_code, run->message);
    } else {
        cli_report_end(output);
    }
    cli_progress_destroy(output->progress);
    output->progress = NULL;
    return run->exit_code;
}
