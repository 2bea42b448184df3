// --exposure auto, --colormap MAP:auto: finds one exposure and one range for all pictures of a script, in a first run
// that writes no picture.
//
// The first run renders every frame, even those that -f, --shard, --region and earlier runs exclude, so that every part
// of a job finds the same values.
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "bindings/command/cli.h"

// Silences print and io.write, since the second run prints. os.exit ends the first run like the end of the script.
void cli_hush_script(lua_State *L)
{
    static const char text[] = "print = function() end\n"
                               "if io and io.output then io.output '/dev/null' end\n"
                               "if os and os.exit then os.exit = ... end\n";
    if (luaL_loadstring(L, text) != LUA_OK)
        lua_error(L);
    lua_pushcfunction(L, glintL_stop_script);
    lua_call(L, 1, 0);
}

// folder  NULL: of all pictures.
static void report_exposure(cli_output *output, const char *stops, const char *folder, const glint_brightness *seen)
{
    if (output->json) {
        fprintf(output->data, "{\"event\":\"exposure\",\"stops\":%s", stops);
        if (folder)
            glintL_json(output->data, ",\"folder\":%s", folder);
        glintL_json(output->data, ",\"brightest\":%g", seen->most);
        fprintf(output->data, ",\"frames\":%" PRIu64 "}", seen->pictures);
        cli_end_line(output);
    } else if (!output->quiet) {
        fprintf(stderr, "exposure %s", stops);
        fputs(folder ? " in " : "", stderr);
        if (folder)
            glintL_put_text(stderr, folder, strlen(folder));
        fprintf(stderr, ": the brightest value of %" PRIu64 " picture%s is %.6g\n", seen->pictures,
                seen->pictures == 1 ? "" : "s", seen->most);
    }
}

static void report_range(cli_output *output, const double range[2])
{
    if (output->json) {
        glintL_json(output->data, "{\"event\":\"range\",\"low\":%g,\"high\":%g}", range[0], range[1]);
        cli_end_line(output);
    } else if (!output->quiet) {
        fprintf(stderr, "colours from %.6g to %.6g\n", range[0], range[1]);
    }
}

void cli_begin_measuring(const cli_options *options, cli_output *output, glintL_run *run, glintL_request *request)
{
    *request = run->request;
    run->finds_range = options->finds_range;
    run->measures = run->keeps_images = run->no_sheets = true;
    run->range[0] = HUGE_VAL;
    run->range[1] = -HUGE_VAL;
    run->request.selection = (glintL_selection) { 0 };
    run->request.repeat = 1;
    run->request.warnings = GLINTL_WARNINGS_NONE;
    if (output->progress)
        cli_progress_step(output->progress, "measuring all pictures", 0, 0, 0);
}

static void take_exposure(cli_options *options, cli_output *output, glintL_run *run, const glint_brightness *seen)
{
    snprintf(options->exposure, sizeof options->exposure, "%.2f", glint_exposure_for(seen->most));
    run->request.render_text[glintL_render_find("exposure")] = options->exposure;
    for (size_t i = 0; i < run->folder_count; i++) {
        glintL_folder_light *folder = &run->folders[i];
        snprintf(folder->stops, sizeof folder->stops, "%.2f", glint_exposure_for(folder->seen.most));
        if (run->folder_count > 1)
            report_exposure(output, folder->stops, *folder->folder ? folder->folder : ".", &folder->seen);
    }
    if (run->folder_count < 2)
        report_exposure(output, options->exposure, NULL, seen);
}

// Sets the range. If there is no range, no pass is shown in colours, and a warning says so.
static void take_range(cli_options *options, cli_output *output, glintL_run *run, const double range[2])
{
    const char **text = &run->request.render_text[glintL_render_find("colormap")];
    if (!(range[0] < range[1]))
        return;
    snprintf(options->colormap, sizeof options->colormap, "%s:%.9g:%.9g", *text, range[0], range[1]);
    *text = options->colormap;
    report_range(output, range);
}

bool cli_end_measuring(cli_options *options, cli_output *output, glintL_run *run, const glintL_request *request,
                       bool good)
{
    const glint_brightness seen = run->brightness;
    run->measures = run->keeps_images = run->no_sheets = false;
    run->request = *request;
    if (output->progress)
        cli_progress_film(output->progress, NULL, 0, 0);
    if (run->exit_code || run->interrupted || !(good || run->is_stopped))
        return false;
    glintL_run_reset(run);
    if (options->finds_exposure)
        take_exposure(options, output, run, &seen);
    if (options->finds_range)
        take_range(options, output, run, run->range);
    return true;
}
