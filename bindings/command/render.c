// glint render SCRIPT: renders the script's frames to files.
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/command/cli.h"
#include "bindings/command/points.h"
#include "bindings/run/film.h"

static bool run_once(const cli_options *options, glintL_run *run)
{
    cli_script script;
    const bool good = cli_run_script(&script, options, run) && glintL_call_settle(run);
    cli_close_script(&script);
    return good;
}

static bool run_script(cli_options *options, cli_output *output, glintL_run *run, bool *reported)
{
    return options->sweep_count ? cli_run_points(options, output, run, reported) : run_once(options, run);
}

// For --exposure auto and --colormap MAP:auto: runs the script once to find the values, and sets them in the request.
static bool measure(cli_options *options, cli_output *output, glintL_run *run, bool *reported)
{
    glintL_request request;
    cli_begin_measuring(options, output, run, &request);
    const bool good = run_script(options, output, run, reported);
    return cli_end_measuring(options, output, run, &request, good);
}

bool cli_finish_frames(glintL_run *run, bool good)
{
    good = glintL_run_collect(run, true) && good; // submitted frames are finished in any case
    good = good && !run->interrupted && glintL_films_finish(run);
    // Calls in a loop are counted as they occur. Only now is the number of selected calls known.
    good = good && (run->count == 0 || glintL_selection_settle(run, 1, run->count));
    if (good)
        cli_warn_clipped(run);
    return good;
}

static bool run_all(cli_options *options, cli_output *output, glintL_run *run, bool *reported)
{
    char message[GLINTL_MESSAGE_SIZE];
    int code = 0;
    char *live = options->is_live ? cli_live(options, &run->request, &code, message) : NULL;
    if (options->is_live && !live)
        return glintL_run_fail(run, code, 0, "%s", message);
    run->live = live;
    const bool good = run_script(options, output, run, reported);
    run->live = NULL;
    free(live);
    return good;
}

int cli_render(cli_options *options, cli_output *output, glintL_run *run)
{
    if (!output->quiet)
        output->progress = cli_progress_create(output->color);
    bool reported = false;
    if (glintL_run_refines(run)) { // a finished file does not tell its error, and no two pictures share results
        run->request.starts_anew = run->request.force;
        run->request.force = run->request.no_reuse = run->keeps_images = true;
    }
    bool good = !(options->finds_exposure || options->finds_range) || measure(options, output, run, &reported);
    good = good && run_all(options, output, run, &reported);
    if (!cli_finish_frames(run, good))
        glintL_films_keep(run);
    if (run->interrupted) {
        cli_report_error(output, 0, 128 + (int)run->interrupted, "interrupted");
    } else if (run->exit_code && !reported) {
        cli_report_error(output, run->failed_index, run->exit_code, run->message);
    } else if (!run->exit_code) {
        cli_report_end(output);
    }
    cli_progress_destroy(output->progress);
    output->progress = NULL;
    return run->exit_code;
}
