// One frame: its plan, its files and their keys, rendering, and the transfer to the writer.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/run.h"
#include "engine/glint_figures.h"

static glint_status fail(glint_error *error, glint_status status, const char *what, const char *text, const char *rest)
{
    error->status = status;
    snprintf(error->message, sizeof error->message, "%s%.100s%s", what, text, rest);
    return status;
}

// Returns whether a region writes depth to a .png, which is scaled by the nearest point of the whole frame.
static bool is_depth_of_part(const glintL_render *render)
{
    return render->desc.region[2] > 0 && render->file_passes >> GLINT_PASS_DEPTH & 1 &&
           !glintL_name_is_linear(render->output);
}

glint_status glintL_work_create(const glint_scene *scene, const glintL_render *render, int64_t index, bool writes,
                                bool keep_image, glintL_work **out, glint_error *error)
{
    glintL_work *work = calloc(1, sizeof *work);
    if (!work)
        return fail(error, GLINT_ERR_NOMEM, "out of memory", "", "");
    bool is_linear = writes && glintL_name_is_linear(render->output);
    if (writes && is_depth_of_part(render)) {
        free(work);
        return fail(error, GLINT_ERR_INVALID, "region: depth in a .png is scaled by the nearest point of the whole "
                                              "frame, which is unknown in a part of it; ", "", ".pfm, .npy or .exr expected");
    }
    work->index = index;
    work->render = *render;
    glint_render_desc *desc = &work->render.desc;
    desc->passes = writes || keep_image ? render->file_passes : 0;
    desc->codes = writes ? !is_linear : !keep_image; // a run that writes nothing makes pixel values too, for its timing
    if (keep_image || is_linear || (writes && glintL_tone_is_data(&desc->tone)))
        desc->passes |= 1u << GLINT_PASS_BEAUTY;
    glint_status status = glintL_check_light_passes(scene, render, error);
    if (writes || keep_image)
        glintL_render_point(&work->render);
    if (!status)
        status = glintL_orbit_plan(scene, &render->orbit, desc, &work->camera, &work->plan, error);
    if (status) {
        free(work);
        return status;
    }
    *out = work;
    return GLINT_OK;
}

glint_status glintL_work_expose(glintL_work *work, const glint_scene *scene, glint_plan **times, size_t count,
                                glint_error *error)
{
    glint_plan *plan;
    glint_camera_desc before;
    const bool is_turned = glintL_orbit_begin(scene, &work->render.orbit, &work->render.desc, &before);
    glint_status status = glint_plan_create_exposed(scene, &work->render.desc, times, count, &plan, error);
    if (is_turned)
        glintL_orbit_end(scene, &before);
    if (status)
        return status;
    glint_plan_destroy(work->plan);
    work->plan = plan;
    return GLINT_OK;
}

void glintL_work_destroy(glintL_work *work)
{
    if (!work)
        return;
    glint_plan_destroy(work->plan);
    glint_image_release(work->image);
    free(work->files);
    free(work->sweep);
    free(work->names);
    free(work);
}

static glint_write_desc write_desc(const glintL_work *work, const glintL_file *file)
{
    glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .path = file->path, .pass = file->pass };
    desc.tone = work->render.desc.tone;
    desc.encode = work->render.encode;
    desc.dpi = work->render.dpi;
    desc.colormap = work->render.colormap;
    memcpy(desc.range, work->render.range, sizeof desc.range);
    return desc;
}

// Names one pass's file and computes its keys.
static glint_status add_file(glintL_work *work, const glintL_naming *naming, glint_pass pass, glint_error *error)
{
    char name[GLINTL_PASS_NAME_SIZE];
    glintL_file *file = &work->files[work->file_count];
    file->pass = pass;
    if (!glintL_name_file(naming, work->index, glintL_pass_name(work, pass, name), file->path))
        return fail(error, GLINT_ERR_INVALID, "output: the file name '", naming->pattern, "...' is too long");
    for (int i = 0; i < work->file_count && pass >= GLINT_PASS_LIGHT; i++)
        if (strcmp(work->files[i].path, file->path) == 0)
            return fail(error, GLINT_ERR_INVALID, "passes: ", name, ": another light's file has the same name; set "
                                                                    "the light's group to a name with different "
                                                                    "letters and digits");
    file->key[0] = file->whole[0] = '\0';
    if (!glintL_name_is_linear(file->path) && !glintL_name_is_vector(file->path) && !glintL_name_is_special(file->path)) {
        glint_write_desc desc = write_desc(work, file);
        glint_frame_key(work->plan, &desc, file->key);
        if (work->render.desc.region[2] > 0)
            glint_whole_key(work->plan, &desc, file->whole);
    }
    work->file_count++;
    return GLINT_OK;
}

glint_status glintL_work_name(glintL_work *work, const glintL_naming *naming, glint_error *error)
{
    uint32_t passes = work->render.file_passes | 1u << GLINT_PASS_BEAUTY;
    size_t lights = 0;
    glint_status status = GLINT_OK;
    work->file_count = 0;
    work->film = naming->film;
    if (!naming->pattern)
        return GLINT_OK;
    if (glintL_name_is_exr(naming->pattern)) {
        passes = 1u << GLINT_PASS_BEAUTY; // this one file contains all passes
    } else {
        passes |= ((1u << work->render.derivative_count) - 1) << GLINT_PASS_DERIVATIVE;
        while (glint_plan_light_pass(work->plan, lights))
            lights++;
    }
    free(work->files);
    if (!(work->files = calloc(GLINTL_PASSES_MAX + lights, sizeof *work->files)))
        return fail(error, GLINT_ERR_NOMEM, "out of memory", "", "");
    for (unsigned pass = 0; pass < GLINTL_PASSES_MAX && !status; pass++)
        if (passes >> pass & 1)
            status = add_file(work, naming, (glint_pass)pass, error);
    for (size_t i = 0; i < lights && !status; i++)
        status = add_file(work, naming, (glint_pass)(GLINT_PASS_LIGHT + i), error);
    return status;
}

// Returns whether an earlier frame of this run is still being written to one of the work's files.
static bool is_awaited(const glintL_run *run, const glintL_work *work)
{
    for (const glintL_record *record = run->head; record; record = record->next)
        for (int pass = 0; pass < record->slots; pass++)
            for (int i = 0; i < work->file_count && record->files[pass]; i++)
                if (strcmp(record->files[pass], work->files[i].path) == 0)
                    return true;
    return false;
}

bool glintL_work_is_kept(glintL_run *run, const glintL_work *work)
{
    if (is_awaited(run, work))
        glintL_run_collect(run, true);
    for (int i = 0; i < work->file_count; i++) {
        const glintL_file *file = &work->files[i];
        if (file->key[0] == '\0' || !glint_file_has_key(file->path, file->key))
            return false;
    }
    return work->file_count > 0;
}

// Warns once for each light of the run.
static void warn_of_caps(glintL_run *run, const glint_plan *plan)
{
    const glint_effect *effects;
    const size_t count = glint_plan_effects(plan, &effects);
    for (size_t i = 0; i < count; i++)
        if (strcmp(effects[i].effect, "rays in place of caps") == 0)
            glintL_run_warn(run,
                            "%s.shadow: only scenes of opaque spheres and planes have shadow caps; this scene uses "
                            "shadow rays instead; set shadow = \"rays\"",
                            effects[i].caller);
}

// Warns that each sample goes through one point of the lens. Not for previews and command lines that ask for one
// sample.
static void warn_of_lens(glintL_run *run, const glint_plan *plan)
{
    const glint_effect *effects;
    const size_t count = glint_plan_effects(plan, &effects);
    const bool is_meant = run->preview_side > 0 || run->request.render_text[glintL_render_find("samples")];
    for (size_t i = 0; i < count && !is_meant && glint_plan_render_desc(plan)->samples == 1; i++)
        if (strcmp(effects[i].effect, "lens") == 0)
            glintL_run_warn(run, "one sample a pixel shows the blur of a lens as a pattern of dots; set samples = "
                                 "16, or more, next to width, or use --samples 16");
}

static void warn_of_colormap(glintL_run *run, const glintL_work *work)
{
    const glintL_render *render = &work->render;
    if (!render->colormap)
        return;
    if (!(render->file_passes >> GLINT_PASS_DEPTH & 1) && !render->derivative_count)
        glintL_run_warn(run, "colormap: colours only the passes depth and d:NAME, and none of them is written; use "
                             "--passes depth, or passes = \"depth\"");
    else if (work->file_count > 0 && glintL_name_is_linear(work->files[0].path))
        glintL_run_warn(run, "colormap has no effect on .pfm, .npy and .exr, which store plain numbers; use -o with "
                             "a name ending in .png, or output = \"name.png\"");
}

static void warn_of_overlay(void *run, const char *message) { glintL_run_warn(run, "%s", message); }

// Returns whether the picture's brightness counts: it is written as integer values, or would be without -o none.
static bool is_looked_at(const glintL_run *run, const glintL_work *work)
{
    return work->render.desc.codes || (run->measures && strcmp(work->render.output, "none") == 0);
}

glint_status glintL_work_warn(glintL_run *run, const glintL_work *work, glint_error *error)
{
    warn_of_caps(run, work->plan);
    warn_of_lens(run, work->plan);
    warn_of_colormap(run, work);
    return glint_plan_check_overlays(work->plan, work->render.dpi, warn_of_overlay, run, error);
}

glint_status glintL_work_draw(glintL_run *run, glintL_work *work, glint_error *error)
{
    glint_image *image = NULL;
    if (!glintL_run_open(run, error))
        return error->status;
    if (run->reporter.rendering)
        run->reporter.rendering(run->reporter.context, run, true);
    const glint_status status = glint_render(run->renderer, work->plan, &image, &work->stats, error);
    if (run->reporter.rendering)
        run->reporter.rendering(run->reporter.context, run, false);
    if (status == GLINT_OK) {
        glint_image_release(work->image);
        work->image = image;
    }
    return status;
}

void glintL_work_show(glintL_run *run, const glintL_work *work)
{
    if (is_looked_at(run, work))
        glintL_look_at_brightness(run, work->image, &work->render.desc.tone);
    if (run->measures && work->render.desc.codes && *work->render.output)
        glintL_note_folder(run, work->render.output, work->image, &work->render.desc.tone);
    if (run->reporter.image)
        run->reporter.image(run->reporter.context, run, work);
}

glint_status glintL_work_render(glintL_run *run, glintL_work *work, glint_error *error)
{
    glint_status status = glintL_work_warn(run, work, error);
    if (status == GLINT_OK)
        status = glintL_work_draw(run, work, error);
    if (status == GLINT_OK)
        glintL_work_show(run, work);
    return status;
}

// ---- To the writer ----

static glint_status submit(glintL_run *run, const glintL_work *work, const glintL_file *file, glintL_record *record,
                           glint_error *error)
{
    glintL_provenance provenance;
    glint_write_desc desc = write_desc(work, file);
    if (!glintL_provenance_take(&provenance, run, work, file))
        return fail(error, GLINT_ERR_NOMEM, "out of memory", "", "");
    desc.text = provenance.text;
    desc.text_count = provenance.count;
    glint_status status = glint_writer_submit(run->writer, work->image, &desc, record, error);
    glintL_provenance_drop(&provenance);
    return status;
}

// Passes a work's files to the writer. record: of the work, for the results.
static void submit_files(glintL_run *run, const glintL_work *work, glintL_record *record)
{
    glint_error error;
    record->files_left = work->file_count;
    for (int i = 0; i < work->file_count; i++) {
        glint_status status = submit(run, work, &work->files[i], record, &error);
        if (status) {
            record->files_left -= work->file_count - i;
            record->failed = true;
            glintL_run_fail(run, glintL_run_exit_code(status), work->index, "%s", error.message);
            break;
        }
        run->files_pending++;
    }
}

bool glintL_work_leave(glintL_run *run, const glintL_work *work)
{
    glintL_record *record = glintL_run_add(run, work);
    if (!record)
        return false;
    record->is_step = true;
    submit_files(run, work, record);
    return glintL_run_collect(run, true);
}

bool glintL_work_finish(glintL_run *run, glintL_work *work, bool kept)
{
    if (kept)
        memset(&work->stats, 0, sizeof work->stats);
    if (!glintL_places_add(run, work))
        return false;
    glintL_record *record = glintL_run_add(run, work);
    if (!record)
        return false;
    record->kept = kept;
    record->is_last = true;
    record->repeat = run->request.repeat > 1 ? run->request.repeat : 0;
    if (!kept)
        submit_files(run, work, record);
    return glintL_run_collect(run, false);
}

// Renders, and reports all but the last repeat.
static bool render_repeats(glintL_run *run, glintL_work *work)
{
    glint_error error;
    for (int repeat = 1; repeat <= run->request.repeat; repeat++) {
        glint_status status = glintL_work_render(run, work, &error);
        if (status == GLINT_ERR_CANCELLED)
            return glintL_run_fail(run, GLINTL_EXIT_FAILED, work->index, "interrupted");
        if (status)
            return glintL_run_fail(run, glintL_run_exit_code(status), work->index, "%s", error.message);
        if (repeat < run->request.repeat) {
            glintL_record *record = glintL_run_add(run, work);
            if (!record)
                return false;
            record->repeat = repeat;
            glintL_run_collect(run, false);
        }
    }
    return true;
}

// Measures the pass that is scaled for viewing. Several such passes may differ in range, so they are an error.
static bool measure_range(glintL_run *run, const glintL_work *work)
{
    glint_error error;
    const glintL_render *render = &work->render;
    const bool depth = render->file_passes >> GLINT_PASS_DEPTH & 1;
    if (depth + render->derivative_count > 1)
        return glintL_run_fail(run, GLINTL_EXIT_USAGE, work->index,
                               "--colormap: auto works for exactly one of the passes depth and d:NAME, got %d; "
                               "expected NAME:LOW:HIGH",
                               depth + render->derivative_count);
    if (depth + render->derivative_count == 1)
        glint_image_range(work->image, depth ? GLINT_PASS_DEPTH : GLINT_PASS_DERIVATIVE, run->range, &error);
    return true;
}

bool glintL_work_measure(glintL_run *run, glintL_work *work)
{
    glint_error error;
    const glint_status status = glintL_work_render(run, work, &error);
    if (status)
        return glintL_run_fail(run, glintL_run_exit_code(status), work->index, "%s", error.message);
    return !run->finds_range || measure_range(run, work);
}

bool glintL_work_run(glintL_run *run, glintL_work *work, bool force)
{
    if (run->measures)
        return !is_looked_at(run, work) || glintL_work_measure(run, work);
    if (!force && run->request.repeat == 1 && glintL_work_is_kept(run, work))
        return glintL_work_finish(run, work, true);
    return render_repeats(run, work) && glintL_work_finish(run, work, false);
}
