/// Reads the picture of an .exr as floats: its colours, or those of its first layer that has them, or luminance.
#include "engine/base/status.h"
#include "engine/files/picture/exr.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef GLINT_HAVE_OPENEXR
#include "engine/files/picture/exr_chunks.h"

static int64_t size_of(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const glint_bytes *)user)->size;
}

static int64_t read_bytes(exr_const_context_t context, void *user, void *to, uint64_t size, uint64_t offset,
                          exr_stream_error_func_ptr_t fail)
{
    const glint_bytes *bytes = user;
    (void)context, (void)fail;
    if (offset > bytes->size)
        return -1;
    const uint64_t count = size < bytes->size - offset ? size : bytes->size - offset;
    memcpy(to, bytes->data + offset, (size_t)count);
    return (int64_t)count;
}

/// Returns the index of a channel with the same layer as channel i and another last letter; -1: there is none.
static int beside(const exr_attr_chlist_t *list, int i, char letter)
{
    const char *name = list->entries[i].name.str;
    const size_t length = strlen(name);
    for (int k = 0; k < list->num_channels; k++) {
        const char *other = list->entries[k].name.str;
        if (strlen(other) == length && strncmp(other, name, length - 1) == 0 && other[length - 1] == letter)
            return k;
    }
    return -1;
}

/// Returns whether a channel's name without its layer is one letter.
static bool is_named(const char *name, char letter)
{
    const size_t length = strlen(name);
    return length > 0 && name[length - 1] == letter && (length == 1 || name[length - 2] == '.');
}

/// Finds the channels of the picture: R, G and B without a layer, or of the first layer; otherwise a luminance. Returns
/// their number, or 0.
static int find_channels(const exr_attr_chlist_t *list, int channel[3])
{
    int found = -1, grey = -1;
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str;
        const bool whole = is_named(name, 'R') && beside(list, i, 'G') >= 0 && beside(list, i, 'B') >= 0;
        if (whole && (found < 0 || strlen(name) == 1))
            found = i;
        if (is_named(name, 'Y') && beside(list, i, 'X') < 0 && (grey < 0 || strlen(name) == 1))
            grey = i; // with X, it is a coordinate
    }
    channel[0] = found >= 0 ? found : grey;
    for (int c = 1; found >= 0 && c < 3; c++)
        channel[c] = beside(list, found, "RGB"[c]);
    return found >= 0 ? 3 : grey >= 0 ? 1 : 0;
}

/// Returns whether a luminance has chroma channels: RY and BY in its layer.
static bool has_chroma(const exr_attr_chlist_t *list, const char *luminance)
{
    const size_t layer = strlen(luminance) - 1;
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str;
        if (strncmp(name, luminance, layer) == 0 && (strcmp(name + layer, "RY") == 0 || strcmp(name + layer, "BY") == 0))
            return true;
    }
    return false;
}

static glint_status refuse_channels(const exr_attr_chlist_t *list, glint_error *error)
{
    char names[160] = "";
    size_t used = 0;
    for (int i = 0; i < list->num_channels && used < sizeof names; i++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "", list->entries[i].name.str);
    return glint_fail(error, GLINT_ERR_FORMAT, "an OpenEXR file with the channels R, G and B, or Y, expected, got %s", names);
}

static glint_status read_part(exr_context_t context, size_t most, glint_pfm *out, glint_error *error)
{
    const exr_attr_chlist_t *list = NULL;
    int channel[3];
    glint_status status = glint_exr_open(context, most, &list, &out->width, &out->height, error);
    if (status)
        return status;
    if (!(out->channels = find_channels(list, channel)))
        return refuse_channels(list, error);
    const char *first = list->entries[channel[0]].name.str;
    if (out->channels == 1 && has_chroma(list, first))
        return glint_fail(error, GLINT_ERR_FORMAT, "an OpenEXR file of luminance and chroma (%.60s and RY, BY); glint reads R, G and B, or Y", first);
    float **planes = calloc((size_t)list->num_channels, sizeof *planes);
    out->values = malloc((size_t)out->width * (size_t)out->height * (size_t)out->channels * sizeof(float));
    for (int c = 0; planes && out->values && c < out->channels; c++)
        planes[channel[c]] = out->values + c;
    const glint_exr_planes to = { planes, (size_t)out->channels };
    status = planes && out->values ? glint_exr_read(context, &to, error) : glint_fail_nomem(error);
    free(planes);
    return status;
}

glint_status glint_exr_decode(const glint_bytes *bytes, size_t most, glint_pfm *out, glint_error *error)
{
    exr_context_initializer_t how = glint_exr_reader();
    exr_context_t context;
    glint_pfm picture = { .values = NULL };
    how.user_data = (void *)(uintptr_t)bytes;
    how.size_fn = size_of;
    how.read_fn = read_bytes;
    const exr_result_t opened = exr_start_read(&context, "picture", &how);
    const glint_status status = opened == EXR_ERR_OUT_OF_MEMORY ? glint_fail_nomem(error)
                                : opened ? glint_fail(error, GLINT_ERR_FORMAT, "not a whole OpenEXR file")
                                         : read_part(context, most, &picture, error);
    if (!opened)
        exr_finish(&context);
    if (status)
        free(picture.values);
    else
        *out = picture;
    return status;
}

#else

glint_status glint_exr_decode(const glint_bytes *bytes, size_t most, glint_pfm *out, glint_error *error)
{
    (void)bytes, (void)most, (void)out;
    return glint_fail(error, GLINT_ERR_UNSUPPORTED, "is OpenEXR, which this build of glint cannot read (libopenexr-dev)");
}

#endif
