/// Decodes the chunks of an OpenEXR file into planes of floats.
#include "engine/base/status.h"
#include "engine/files/picture/exr.h"

#ifdef GLINT_HAVE_OPENEXR
#include "engine/files/picture/exr_chunks.h"

#include <stdlib.h>
#include <string.h>

/// The state of reading one part.
typedef struct reading {
    const glint_exr_planes *to;
    const exr_attr_chlist_t *channels;
    exr_attr_box2i_t data, shown;
    float *values; ///< one chunk of every needed channel, then one for all other channels
    size_t capacity; ///< of `values`
} reading;

static void drop_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context, (void)code, (void)message;
}

static void *allocate(size_t size) { return calloc(1, size); }

exr_context_initializer_t glint_exr_reader(void)
{
    exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    how.error_handler_fn = drop_message;
    how.alloc_fn = allocate; // the library passes on values that a damaged chunk lacks
    return how;
}

static size_t width_of(exr_attr_box2i_t box) { return (size_t)((int64_t)box.max.x - box.min.x + 1); }
static size_t height_of(exr_attr_box2i_t box) { return (size_t)((int64_t)box.max.y - box.min.y + 1); }

/// Returns the index of a channel in the file's list.
static int index_of(const exr_attr_chlist_t *list, const char *name)
{
    int i = 0;
    while (i < list->num_channels - 1 && strcmp(list->entries[i].name.str, name) != 0)
        i++;
    return i;
}

/// Copies one channel of a chunk into its plane, as far as the chunk lies in the display window. x and y are the
/// chunk's position in the display window.
static void place(const reading *in, const float *values, float *plane, int64_t x, int64_t y, const exr_chunk_info_t *chunk)
{
    const int64_t width = (int64_t)width_of(in->shown), height = (int64_t)height_of(in->shown);
    for (int64_t row = y < 0 ? -y : 0; row < chunk->height && y + row < height; row++)
        for (int64_t i = x < 0 ? -x : 0; i < chunk->width && x + i < width; i++)
            plane[(size_t)((y + row) * width + x + i) * in->to->stride] = values[row * chunk->width + i];
}

/// Decodes a chunk whose upper left pixel is x, y of the data window. The library may write all channels of a chunk, so
/// each has a buffer.
static exr_result_t decode(reading *in, exr_context_t context, const exr_chunk_info_t *chunk, int64_t x, int64_t y)
{
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    const size_t size = (size_t)chunk->width * (size_t)chunk->height, count = (size_t)in->channels->num_channels;
    size_t needed = 0, k = 0;
    if (chunk->width < 1 || chunk->height < 1 || (size_t)chunk->width > width_of(in->data) || (size_t)chunk->height > height_of(in->data))
        return EXR_ERR_BAD_CHUNK_LEADER;
    for (size_t i = 0; i < count; i++)
        needed += in->to->plane[i] != NULL;
    if ((needed + 1) * size > in->capacity) {
        free(in->values);
        in->capacity = (needed + 1) * size;
        if (!(in->values = malloc(in->capacity * sizeof *in->values)))
            return EXR_ERR_OUT_OF_MEMORY;
    }
    exr_result_t result = exr_decoding_initialize(context, 0, chunk, &pipe);
    for (int i = 0; i < pipe.channel_count && !result; i++) {
        exr_coding_channel_info_t *info = &pipe.channels[i];
        const bool wanted = in->to->plane[index_of(in->channels, info->channel_name)] && k < needed;
        info->decode_to_ptr = (uint8_t *)(in->values + (wanted ? k++ : needed) * size);
        info->user_data_type = EXR_PIXEL_FLOAT;
        info->user_bytes_per_element = sizeof(float);
        info->user_pixel_stride = sizeof(float);
        info->user_line_stride = (int32_t)((size_t)chunk->width * sizeof(float));
    }
    if (!result)
        result = exr_decoding_choose_default_routines(context, 0, &pipe);
    if (!result)
        result = exr_decoding_run(context, 0, &pipe);
    for (int i = 0; i < pipe.channel_count && !result; i++) {
        float *plane = in->to->plane[index_of(in->channels, pipe.channels[i].channel_name)];
        if (plane)
            place(in, (const float *)pipe.channels[i].decode_to_ptr, plane, x + in->data.min.x - in->shown.min.x,
                  y + in->data.min.y - in->shown.min.y, chunk);
    }
    exr_decoding_destroy(context, &pipe);
    return result;
}

static exr_result_t read_lines(reading *in, exr_context_t context)
{
    int32_t lines = 1;
    exr_result_t result = exr_get_scanlines_per_chunk(context, 0, &lines);
    for (int64_t y = 0; y < (int64_t)height_of(in->data) && !result; y += lines) {
        exr_chunk_info_t chunk;
        result = exr_read_scanline_chunk_info(context, 0, (int)(in->data.min.y + y), &chunk);
        if (!result)
            result = decode(in, context, &chunk, 0, y);
    }
    return result;
}

static exr_result_t read_tiles(reading *in, exr_context_t context)
{
    int32_t width = 0, height = 0;
    exr_result_t result = exr_get_tile_sizes(context, 0, 0, 0, &width, &height);
    if (!result && (width < 1 || height < 1))
        result = EXR_ERR_INVALID_ATTR;
    for (int y = 0; !result && y * (int64_t)height < (int64_t)height_of(in->data); y++)
        for (int x = 0; !result && x * (int64_t)width < (int64_t)width_of(in->data); x++) {
            exr_chunk_info_t chunk;
            result = exr_read_tile_chunk_info(context, 0, x, y, 0, 0, &chunk);
            if (!result)
                result = decode(in, context, &chunk, x * (int64_t)width, y * (int64_t)height);
        }
    return result;
}

/// Checks that a window has an area of at most `most` pixels.
static glint_status check_window(exr_attr_box2i_t box, size_t most, glint_error *error)
{
    const int64_t width = (int64_t)box.max.x - box.min.x + 1, height = (int64_t)box.max.y - box.min.y + 1;
    if (width < 1 || height < 1 || width > 65535 || height > 65535 || (size_t)width * (size_t)height > most)
        return glint_fail(error, GLINT_ERR_FORMAT, "a picture of at most %zu pixels expected, got %lld x %lld", most,
                          (long long)width, (long long)height);
    return GLINT_OK;
}

static const char NOT_WHOLE[] = "not a whole OpenEXR file";

glint_status glint_exr_open(exr_context_t context, size_t most, const exr_attr_chlist_t **channels, int *width,
                            int *height, glint_error *error)
{
    exr_attr_box2i_t data, shown;
    exr_storage_t storage;
    if (exr_get_storage(context, 0, &storage) || exr_get_channels(context, 0, channels) ||
        exr_get_data_window(context, 0, &data) || exr_get_display_window(context, 0, &shown))
        return glint_fail(error, GLINT_ERR_FORMAT, NOT_WHOLE);
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return glint_fail(error, GLINT_ERR_FORMAT, "an OpenEXR file of scan lines or tiles expected, got a deep one");
    glint_status status = check_window(data, most, error);
    if (!status)
        status = check_window(shown, most, error);
    if (!status) {
        *width = (int)width_of(shown);
        *height = (int)height_of(shown);
    }
    return status;
}

glint_status glint_exr_read(exr_context_t context, const glint_exr_planes *to, glint_error *error)
{
    reading in = { .to = to };
    exr_storage_t storage;
    exr_result_t result = exr_get_storage(context, 0, &storage);
    if (!result)
        result = exr_get_channels(context, 0, &in.channels);
    for (int i = 0; !result && i < in.channels->num_channels; i++) {
        const exr_attr_chlist_entry_t *entry = &in.channels->entries[i];
        if (entry->x_sampling != 1 || entry->y_sampling != 1) // the library mixes such channels up with others
            return glint_fail(error, GLINT_ERR_FORMAT, "channel %.60s: a value for every pixel expected, got one for %d x %d",
                              entry->name.str, entry->x_sampling, entry->y_sampling);
    }
    if (!result)
        result = exr_get_data_window(context, 0, &in.data);
    if (!result)
        result = exr_get_display_window(context, 0, &in.shown);
    for (int i = 0; !result && i < in.channels->num_channels; i++)
        for (size_t k = 0; to->plane[i] && k < width_of(in.shown) * height_of(in.shown); k++)
            to->plane[i][k * to->stride] = 0;
    if (!result)
        result = storage == EXR_STORAGE_TILED ? read_tiles(&in, context) : read_lines(&in, context);
    free(in.values);
    if (result == EXR_ERR_OUT_OF_MEMORY)
        return glint_fail_nomem(error);
    return result ? glint_fail(error, GLINT_ERR_FORMAT, "%s: %s", NOT_WHOLE, exr_get_default_error_message(result)) : GLINT_OK;
}

#endif
