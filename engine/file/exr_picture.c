/// Reads the picture of an .exr as floats: its colours, or those of its first layer that has them, or luminance.
#include "engine/base/status.h"
#include "engine/file/exr.h"

#include <stdlib.h>
#include <string.h>

#ifdef GLINT_HAVE_OPENEXR
#include <openexr.h>

typedef struct exr_picture {
    exr_context_t context;
    const exr_attr_chlist_t *channels;
    int channel[3]; ///< indices of the channels of the picture
    glint_pfm out;
} exr_picture;

static void drop_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context, (void)code, (void)message;
}

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

/// Finds the channels: R, G and B without a layer, or of the first layer; otherwise a luminance.
static bool find_channels(exr_picture *picture)
{
    const exr_attr_chlist_t *list = picture->channels;
    int found = -1, grey = -1;
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str;
        const bool whole = is_named(name, 'R') && beside(list, i, 'G') >= 0 && beside(list, i, 'B') >= 0;
        if (whole && (found < 0 || strlen(name) == 1))
            found = i;
        if (is_named(name, 'Y') && (grey < 0 || strlen(name) == 1))
            grey = i;
    }
    picture->out.channels = found >= 0 ? 3 : 1;
    picture->channel[0] = found >= 0 ? found : grey;
    for (int c = 1; found >= 0 && c < 3; c++)
        picture->channel[c] = beside(list, found, "RGB"[c]);
    for (int c = 0; c < picture->out.channels; c++) {
        const int i = picture->channel[c];
        if (i < 0 || list->entries[i].x_sampling != 1 || list->entries[i].y_sampling != 1)
            return false;
    }
    return true;
}

/// Decodes a chunk whose upper left pixel is x, y.
static exr_result_t decode(exr_picture *picture, const exr_chunk_info_t *chunk, int x, int y)
{
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    const size_t each = (size_t)picture->out.channels, row = each * (size_t)picture->out.width;
    exr_result_t result = exr_decoding_initialize(picture->context, 0, chunk, &pipe);
    for (int i = 0; i < pipe.channel_count && !result; i++) {
        exr_coding_channel_info_t *info = &pipe.channels[i];
        info->decode_to_ptr = NULL;
        for (size_t c = 0; c < each; c++)
            if (strcmp(info->channel_name, picture->channels->entries[picture->channel[c]].name.str) == 0)
                info->decode_to_ptr = (uint8_t *)(picture->out.values + (size_t)y * row + (size_t)x * each + c);
        info->user_data_type = EXR_PIXEL_FLOAT;
        info->user_bytes_per_element = sizeof(float);
        info->user_pixel_stride = (int32_t)(each * sizeof(float));
        info->user_line_stride = (int32_t)(row * sizeof(float));
    }
    if (!result)
        result = exr_decoding_choose_default_routines(picture->context, 0, &pipe);
    if (!result)
        result = exr_decoding_run(picture->context, 0, &pipe);
    exr_decoding_destroy(picture->context, &pipe);
    return result;
}

static exr_result_t read_rows(exr_picture *picture, int top)
{
    int32_t lines = 1;
    exr_result_t result = exr_get_scanlines_per_chunk(picture->context, 0, &lines);
    for (int y = 0; y < picture->out.height && !result; y += lines) {
        exr_chunk_info_t chunk;
        result = exr_read_scanline_chunk_info(picture->context, 0, top + y, &chunk);
        if (!result)
            result = decode(picture, &chunk, 0, y);
    }
    return result;
}

static exr_result_t read_tiles(exr_picture *picture)
{
    int32_t width = 0, height = 0;
    exr_result_t result = exr_get_tile_sizes(picture->context, 0, 0, 0, &width, &height);
    if (!result && (width < 1 || height < 1))
        result = EXR_ERR_INVALID_ATTR;
    for (int y = 0; !result && y * (int64_t)height < picture->out.height; y++)
        for (int x = 0; !result && x * (int64_t)width < picture->out.width; x++) {
            exr_chunk_info_t chunk;
            result = exr_read_tile_chunk_info(picture->context, 0, x, y, 0, 0, &chunk);
            if (!result)
                result = decode(picture, &chunk, x * width, y * height);
        }
    return result;
}

static glint_status read_part(exr_picture *picture, size_t most, glint_error *error)
{
    exr_attr_box2i_t window;
    exr_storage_t storage;
    if (exr_get_storage(picture->context, 0, &storage) || exr_get_channels(picture->context, 0, &picture->channels) ||
        exr_get_data_window(picture->context, 0, &window))
        return glint_fail(error, GLINT_ERR_FORMAT, "not a whole OpenEXR file");
    const int64_t width = (int64_t)window.max.x - window.min.x + 1, height = (int64_t)window.max.y - window.min.y + 1;
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return glint_fail(error, GLINT_ERR_FORMAT, "an OpenEXR file of scan lines or tiles expected, got a deep one");
    if (!find_channels(picture))
        return glint_fail(error, GLINT_ERR_FORMAT, "an OpenEXR file with the channels R, G and B, or Y, of every pixel expected");
    if (width < 1 || height < 1 || width > 65535 || height > 65535 || (size_t)width * (size_t)height > most)
        return glint_fail(error, GLINT_ERR_FORMAT, "a picture of at most %zu pixels expected, got %lld x %lld", most,
                          (long long)width, (long long)height);
    picture->out.width = (int)width;
    picture->out.height = (int)height;
    picture->out.values = calloc((size_t)width * (size_t)height * (size_t)picture->out.channels, sizeof(float));
    if (!picture->out.values)
        return glint_fail_nomem(error);
    const exr_result_t result = storage == EXR_STORAGE_TILED ? read_tiles(picture) : read_rows(picture, window.min.y);
    return result ? glint_fail(error, GLINT_ERR_FORMAT, "not a whole OpenEXR file: %s", exr_get_default_error_message(result))
                  : GLINT_OK;
}

glint_status glint_exr_decode(const glint_bytes *bytes, size_t most, glint_pfm *out, glint_error *error)
{
    exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_picture picture = { .channels = NULL };
    how.error_handler_fn = drop_message;
    how.user_data = (void *)(uintptr_t)bytes;
    how.size_fn = size_of;
    how.read_fn = read_bytes;
    const exr_result_t opened = exr_start_read(&picture.context, "picture", &how);
    const glint_status status = opened == EXR_ERR_OUT_OF_MEMORY ? glint_fail_nomem(error)
                                : opened ? glint_fail(error, GLINT_ERR_FORMAT, "not a whole OpenEXR file")
                                         : read_part(&picture, most, error);
    if (!opened)
        exr_finish(&picture.context);
    if (status)
        free(picture.out.values);
    else
        *out = picture.out;
    return status;
}

#else

glint_status glint_exr_decode(const glint_bytes *bytes, size_t most, glint_pfm *out, glint_error *error)
{
    (void)bytes, (void)most, (void)out;
    return glint_fail(error, GLINT_ERR_UNSUPPORTED, "is OpenEXR, which this build of glint cannot read (libopenexr-dev)");
}

#endif
