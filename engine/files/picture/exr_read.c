/// Reads the passes that relighting needs from an .exr: the picture and the light passes.
#include "engine/base/open.h"
#include "engine/base/status.h"
#include "engine/files/picture/relight.h"
#include "engine/glint_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef GLINT_HAVE_OPENEXR
#include "engine/files/picture/exr_chunks.h"

typedef struct exr_input {
    exr_context_t context;
    glint_image *image;
    bool half; ///< some light pass is stored as half
} exr_input;

// ---- Channels -----------------------------------------------------------------------------------------------------

/// Returns whether a channel belongs to a light pass: "light.key.R". Writes the pass's name, and the channel number *c.
static bool is_light(const char *channel, char name[GLINT_NAME_SIZE], int *c)
{
    const size_t length = strlen(channel);
    const char *letter = length > 8 ? strchr("RGB", channel[length - 1]) : NULL;
    if (!letter || strncmp(channel, "light.", 6) != 0 || channel[length - 2] != '.' || length - 8 >= GLINT_NAME_SIZE)
        return false;
    snprintf(name, GLINT_NAME_SIZE, "%.*s", (int)(length - 8), channel + 6);
    *c = *letter == 'R' ? 0 : *letter == 'G' ? 1 : 2;
    return true;
}

static size_t find_light(const glint_image *image, const char *name)
{
    size_t i = 0;
    while (i < image->light_count && strcmp(image->light_name[i], name) != 0)
        i++;
    return i;
}

/// Returns the plane for a channel's values; NULL: the channel is not needed.
static float *plane_of(const glint_image *image, const char *channel)
{
    char name[GLINT_NAME_SIZE];
    int c;
    if (is_light(channel, name, &c))
        return image->light[find_light(image, name)][c];
    if (strcmp(channel, "A") == 0)
        return image->plane[GLINT_PASS_ALPHA][0];
    return strlen(channel) == 1 && strchr("RGB", *channel) ? image->plane[GLINT_PASS_BEAUTY][*channel == 'R'   ? 0
                                                                                             : *channel == 'G' ? 1
                                                                                                               : 2]
                                                           : NULL;
}

/// Makes the image for the file's channels.
static glint_status make_image(exr_input *file, const exr_attr_chlist_t *channels, int width, int height,
                               glint_error *error)
{
    char(*names)[GLINT_NAME_SIZE] = calloc((size_t)channels->num_channels + 1, sizeof *names), name[GLINT_NAME_SIZE];
    uint32_t passes = 0, colors = 0;
    size_t count = 0, parts = 0;
    int c;
    if (!names)
        return glint_fail_nomem(error);
    for (int i = 0; i < channels->num_channels; i++) {
        const char *channel = channels->entries[i].name.str;
        file->half = file->half || channels->entries[i].pixel_type == EXR_PIXEL_HALF;
        if (is_light(channel, name, &c)) {
            size_t k = 0;
            while (k < count && strcmp(names[k], name) != 0)
                k++;
            if (k == count)
                memcpy(names[count++], name, sizeof name);
            parts++;
        } else if (strcmp(channel, "A") == 0) {
            passes |= 1u << GLINT_PASS_ALPHA;
        } else if (strlen(channel) == 1 && strchr("RGB", *channel)) {
            colors++;
        }
    }
    glint_status status = GLINT_OK;
    if (count == 0)
        status = glint_fail(error, GLINT_ERR_FORMAT, "no light passes; --passes 'light:*' writes them into an .exr");
    else if (colors != 3 || parts != 3 * count)
        status =
            glint_fail(error, GLINT_ERR_FORMAT, "expected channels R, G and B of the picture and of each light pass");
    if (!status)
        status = glint_image_create(width, height, passes | 1u << GLINT_PASS_BEAUTY, NULL, &file->image, error);
    if (!status)
        status = glint_image_add_lights(file->image, count, (const char(*)[GLINT_NAME_SIZE])names, error);
    free(names);
    return status;
}

// ---- Pixels -------------------------------------------------------------------------------------------------------

/// Returns whether the picture has a transparent background: glint:options contains alpha=true.
static bool has_cover(exr_const_context_t context)
{
    const char *options = NULL;
    int32_t length = 0;
    if (exr_attr_get_string(context, 0, "glint:options", &length, &options) != EXR_ERR_SUCCESS || !options)
        return false;
    return strstr(options, "alpha=true") != NULL;
}

static glint_status read_part(exr_input *file, glint_error *error)
{
    const exr_attr_chlist_t *channels = NULL;
    int width = 0, height = 0;
    glint_status status = glint_exr_open(file->context, (size_t)GLINT_SIDE_MAX * GLINT_SIDE_MAX, &channels, &width, &height, error);
    if (!status)
        status = make_image(file, channels, width, height, error);
    float **planes = status ? NULL : calloc((size_t)channels->num_channels, sizeof *planes);
    if (!status && !planes)
        status = glint_fail_nomem(error);
    for (int i = 0; !status && i < channels->num_channels; i++)
        planes[i] = plane_of(file->image, channels->entries[i].name.str);
    if (!status)
        status = glint_exr_read(file->context, &(glint_exr_planes){ planes, 1 }, error);
    free(planes);
    if (status)
        return status;
    file->image->alpha = file->image->plane[GLINT_PASS_ALPHA][0] && has_cover(file->context);
    file->image->channels = file->image->alpha ? 4 : 3;
    return glint_image_split_rest(file->image, file->half, error);
}

glint_status glint_lights_read(const char *path, glint_image **out, glint_error *error)
{
    GLINT_REFUSE_NULL(path, error);
    GLINT_REFUSE_NULL(out, error);
    exr_context_initializer_t how = glint_exr_reader();
    exr_input file = { .image = NULL };
    glint_error inner;
    glint_status status = glint_check_file(path, error);
    if (status)
        return status;
    const exr_result_t opened = exr_start_read(&file.context, path, &how);
    status = opened == EXR_ERR_FILE_ACCESS     ? glint_fail(&inner, GLINT_ERR_IO, "it cannot be read")
             : opened == EXR_ERR_OUT_OF_MEMORY ? glint_fail_nomem(&inner)
             : opened                          ? glint_fail(&inner, GLINT_ERR_FORMAT, "an OpenEXR file expected")
                                               : read_part(&file, &inner);
    if (!opened)
        exr_finish(&file.context);
    if (status) {
        glint_image_release(file.image);
        return glint_fail(error, status, "%s: %s", path, inner.message);
    }
    *out = file.image;
    return GLINT_OK;
}

#else

glint_status glint_lights_read(const char *path, glint_image **out, glint_error *error)
{
    (void)out;
    return glint_fail(error, GLINT_ERR_UNSUPPORTED, "%s: this build has no OpenEXR (libopenexr-dev)", path);
}

#endif
