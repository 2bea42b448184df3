// The brightness of a run's pictures: warns about clipped values in 16-bit linear files, and finds the largest value
// for --exposure auto.
#include <stdlib.h>
#include <string.h>

#include "bindings/run/run.h"

bool glintL_tone_is_data(const glint_tone_desc *tone)
{
    return tone->bits == 16 && tone->transfer != GLINT_TRANSFER_SRGB && tone->curve == GLINT_TONE_CLAMP;
}

void glintL_warn_of_clipping(glintL_run *run)
{
    const glint_brightness *seen = &run->brightness;
    if (seen->clipped == 0)
        return;
    const double exposure = glint_exposure_for(seen->most);
    const double share = 100 * (double)seen->clipped / (double)seen->values;
    if (run->is_command)
        glintL_run_warn(
            run,
            "%.3g %% of the 16-bit linear values are clipped at 65535: the brightest would be %.4g times white; use "
            "--exposure %.2f to keep all values, or --exposure auto for one exposure of a whole set",
            share, seen->most, exposure);
    else
        glintL_run_warn(
            run,
            "%.3g %% of the 16-bit linear values are clipped at 65535: the brightest would be %.4g times white; set "
            "exposure = %.2f to keep all values",
            share, seen->most, exposure);
}

void glintL_look_at_brightness(glintL_run *run, const glint_image *image, const glint_tone_desc *tone)
{
    glint_error error;
    const bool first = run->brightness.clipped == 0;
    if (!run->measures && !glintL_tone_is_data(tone))
        return;
    glint_image_brightness(image, tone->exposure, &run->brightness,
                           &error); // without linear beauty there is nothing to measure
    if (first && !run->is_command) // the command reports the whole run at its end
        glintL_warn_of_clipping(run);
}

// ---- Folders ----

static size_t folder_size(const char *output)
{
    const char *slash = strrchr(output, '/');
    return slash ? (size_t)(slash + 1 - output) : 0;
}

static glintL_folder_light *find_folder(const glintL_run *run, const char *output)
{
    const size_t size = folder_size(output);
    for (size_t i = 0; i < run->folder_count; i++)
        if (strncmp(run->folders[i].folder, output, size) == 0 && !run->folders[i].folder[size])
            return &run->folders[i];
    return NULL;
}

const glintL_folder_light *glintL_find_folder(const glintL_run *run, const char *output) { return find_folder(run, output); }

void glintL_note_folder(glintL_run *run, const char *output, const glint_image *image, const glint_tone_desc *tone)
{
    glintL_folder_light *folder = find_folder(run, output);
    glint_error error;
    if (!folder) {
        glintL_folder_light *more = realloc(run->folders, (run->folder_count + 1) * sizeof *more);
        char *name = strndup(output, folder_size(output));
        run->folders = more ? more : run->folders;
        if (!more || !name) {
            free(name);
            glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
            return;
        }
        folder = &more[run->folder_count++];
        *folder = (glintL_folder_light) { .folder = name };
    }
    glint_image_brightness(image, tone->exposure, &folder->seen, &error);
}

void glintL_forget_folders(glintL_run *run)
{
    for (size_t i = 0; i < run->folder_count; i++)
        free(run->folders[i].folder);
    free(run->folders);
    run->folders = NULL;
    run->folder_count = 0;
}
