#include "engine/files/picture/exr.h"

#include "engine/base/status.h"
#include "engine/files/picture/pfm.h"
#include "engine/film/image.h"

#include <pthread.h>
#include <stdio.h>

#ifdef GLINT_HAVE_OPENEXR
#include <openexr.h>

#define CHANNEL_NAME (GLINT_PLANE_NAME_SIZE + 2)
#define FIRST_CAPACITY ((size_t)1 << 20)

static char library_name[48];

static void make_library_name(void)
{
    int major, minor, patch;
    const char *extra;
    exr_get_library_version(&major, &minor, &patch, &extra);
    snprintf(library_name, sizeof library_name, "OpenEXR %d.%d.%d", major, minor, patch);
}

const char *glint_exr_library(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_library_name);
    return library_name;
}

typedef struct channel {
    char name[CHANNEL_NAME];
    const float *plane;
    int of; ///< number of channels in the pass of this channel
    bool half;
} channel;

typedef struct exr_file {
    exr_context_t context;
    glint_bytes bytes;
    bool no_memory;
    channel *list; ///< owned
    int count, width, height;
} exr_file;

// ---- Channels -----------------------------------------------------------------------------------------------------

static void name_channel(const glint_image *image, glint_pass pass, int c, char out[CHANNEL_NAME])
{
    char buffer[GLINT_PLANE_NAME_SIZE];
    const char *name = glint_plane_name(image, pass, buffer);
    const bool is_place = pass == GLINT_PASS_NORMAL;
    const char letter = is_place ? "XYZ"[c] : "RGB"[c];
    if (pass >= GLINT_PASS_LIGHT)
        snprintf(out, CHANNEL_NAME, "light.%s.%c", glint_image_light_pass(image, (size_t)pass - GLINT_PASS_LIGHT), letter);
    else if (pass == GLINT_PASS_BEAUTY)
        snprintf(out, CHANNEL_NAME, "%c", letter);
    else if (pass == GLINT_PASS_ALPHA)
        snprintf(out, CHANNEL_NAME, "A");
    else if (glint_pass_channels(pass) == 3)
        snprintf(out, CHANNEL_NAME, "%s.%c", name, letter);
    else
        snprintf(out, CHANNEL_NAME, "%s.%s", name,
                 pass == GLINT_PASS_DEPTH       ? "Z"
                 : pass == GLINT_PASS_OBJECT_ID ? "ID"
                                                : "Y");
}

static void list_channels(exr_file *file, const glint_image *image, bool half)
{
    const int passes = GLINT_PASS_LIGHT + (int)image->light_count;
    for (int pass = 0; pass < passes; pass++)
        for (int c = 0; c < 3; c++) {
            const float *plane = glint_image_planes(image, (glint_pass)pass)[c];
            if (!plane)
                continue;
            channel *added = &file->list[file->count++];
            name_channel(image, (glint_pass)pass, c, added->name);
            added->plane = plane;
            added->of = glint_pass_channels((glint_pass)pass);
            added->half = half && ((added->of == 3 && (pass < GLINT_PASS_DERIVATIVE || pass >= GLINT_PASS_LIGHT)) || pass == GLINT_PASS_ALPHA);
        }
}

static const channel *find_channel(const exr_file *file, const char *name)
{
    const channel *found = file->list;
    while (strcmp(found->name, name) != 0)
        found++;
    return found;
}

/// Returns whether a name is too long for a file without the long-names flag.
static bool has_long_name(const exr_file *file)
{
    for (int i = 0; i < file->count; i++)
        if (strlen(file->list[i].name) > 31)
            return true;
    return false;
}

// ---- The file, in memory --------------------------------------------------------------------------------------------

static int64_t put_bytes(exr_const_context_t context, void *user, const void *bytes, uint64_t size, uint64_t offset,
                         exr_stream_error_func_ptr_t fail)
{
    exr_file *file = user;
    const size_t end = (size_t)(offset + size), used = file->bytes.size;
    if (end > file->bytes.capacity && !glint_bytes_reserve(&file->bytes, end - used + FIRST_CAPACITY)) {
        file->no_memory = true;
        fail(context, EXR_ERR_OUT_OF_MEMORY, "out of memory");
        return -1;
    }
    if (offset > used)
        memset(file->bytes.data + used, 0, (size_t)offset - used);
    memcpy(file->bytes.data + offset, bytes, (size_t)size);
    file->bytes.size = end > used ? end : used;
    return (int64_t)size;
}

/// Drops the library's message, which it would print; the result code is enough.
static void drop_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context, (void)code, (void)message;
}

static exr_result_t write_head(exr_file *file, const glint_text *text, size_t text_count)
{
    int part = 0;
    exr_result_t result = has_long_name(file) ? exr_set_longname_support(file->context, 1) : EXR_ERR_SUCCESS;
    if (!result)
        result = exr_add_part(file->context, "glint", EXR_STORAGE_SCANLINE, &part);
    if (!result)
        result =
            exr_initialize_required_attr_simple(file->context, part, file->width, file->height, EXR_COMPRESSION_ZIP);
    for (int i = 0; i < file->count && !result; i++)
        result =
            exr_add_channel(file->context, part, file->list[i].name,
                            file->list[i].half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (size_t i = 0; i < text_count && !result; i++)
        if (*text[i].value)
            result = exr_attr_set_string(file->context, part, text[i].keyword, text[i].value);
    return result ? result : exr_write_header(file->context);
}

/// Writes the rows of a chunk, from row y on, as floats: channel after channel in the encoder's order.
static void fill_chunk(const exr_file *file, exr_encode_pipeline_t *pipe, int y, float *buffer)
{
    const size_t width = (size_t)file->width;
    for (int c = 0; c < pipe->channel_count; c++) {
        exr_coding_channel_info_t *info = &pipe->channels[c];
        const channel *from = find_channel(file, info->channel_name);
        const size_t count = (size_t)info->height * width;
        for (size_t i = 0; i < count; i++)
            buffer[i] = glint_pfm_value(from->of, from->plane[(size_t)y * width + i]);
        info->user_data_type = EXR_PIXEL_FLOAT;
        info->user_bytes_per_element = sizeof(float);
        info->user_pixel_stride = sizeof(float);
        info->user_line_stride = (int32_t)(width * sizeof(float));
        info->encode_from_ptr = (const uint8_t *)buffer;
        buffer += count;
    }
}

static exr_result_t write_rows(exr_file *file, float *buffer, int lines)
{
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t result = EXR_ERR_SUCCESS;
    for (int y = 0; y < file->height && !result; y += lines) {
        exr_chunk_info_t chunk;
        result = exr_write_scanline_chunk_info(file->context, 0, y, &chunk);
        if (!result)
            result = y ? exr_encoding_update(file->context, 0, &chunk, &pipe)
                       : exr_encoding_initialize(file->context, 0, &chunk, &pipe);
        if (result)
            break;
        fill_chunk(file, &pipe, y, buffer);
        if (y == 0)
            result = exr_encoding_choose_default_routines(file->context, 0, &pipe);
        if (!result)
            result = exr_encoding_run(file->context, 0, &pipe);
    }
    exr_encoding_destroy(file->context, &pipe);
    return result;
}

static exr_result_t write_file(exr_file *file, const glint_text *text, size_t text_count)
{
    int32_t lines = 1;
    exr_result_t result = write_head(file, text, text_count);
    if (!result)
        result = exr_get_scanlines_per_chunk(file->context, 0, &lines);
    if (result)
        return result;
    float *buffer = malloc((size_t)lines * (size_t)file->width * (size_t)file->count * sizeof *buffer);
    result = buffer ? write_rows(file, buffer, lines) : EXR_ERR_OUT_OF_MEMORY;
    free(buffer);
    return result;
}

glint_status glint_exr_encode(const glint_image *image, bool half, const glint_text *text, size_t text_count,
                              glint_bytes *out, glint_error *error)
{
    exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_file *file = calloc(1, sizeof *file);
    if (!file)
        return glint_fail_nomem(error);
    file->width = image->width;
    file->height = image->height;
    file->list = calloc(GLINT_PLANE_COUNT + image->light_count, 3 * sizeof *file->list);
    if (!file->list) {
        free(file);
        return glint_fail_nomem(error);
    }
    list_channels(file, image, half);
    how.user_data = file;
    how.write_fn = put_bytes;
    how.error_handler_fn = drop_message;
    exr_result_t result = exr_start_write(&file->context, "memory.exr", EXR_WRITE_FILE_DIRECTLY, &how);
    if (!result) {
        result = write_file(file, text, text_count);
        const exr_result_t last = exr_finish(&file->context);
        result = result ? result : last;
    }
    const bool appended = !result && glint_bytes_append(out, file->bytes.data, file->bytes.size);
    const bool no_memory = file->no_memory || result == EXR_ERR_OUT_OF_MEMORY ||
                           result == EXR_ERR_CORRUPT_CHUNK || // returned when zlib runs out of memory while compressing
                           (!result && !appended);
    free(file->bytes.data);
    free(file->list);
    free(file);
    if (appended)
        return GLINT_OK;
    return no_memory
               ? glint_fail_nomem(error)
               : glint_fail(error, GLINT_ERR_IO, "%s: %s", glint_exr_library(), exr_get_default_error_message(result));
}

#else

const char *glint_exr_library(void) { return NULL; }

glint_status glint_exr_encode(const glint_image *image, bool half, const glint_text *text, size_t text_count,
                              glint_bytes *out, glint_error *error)
{
    (void)image, (void)half, (void)text, (void)text_count, (void)out;
    return glint_fail(error, GLINT_ERR_UNSUPPORTED,
                      "path: this build has no OpenEXR (libopenexr-dev); a name ending in .pfm or .npy expected");
}

#endif
