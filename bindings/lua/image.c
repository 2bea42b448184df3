// Images, which scene:render returns.
#include <string.h>

#include "bindings/lua/lua.h"

static const glintL_field NO_FIELDS[] = { { .name = NULL } };

static int get_width(lua_State *L)
{
    lua_pushinteger(L, glint_image_width(glintL_check_object(L, 1, GLINTL_IMAGE)));
    return 1;
}

static int get_height(lua_State *L)
{
    lua_pushinteger(L, glint_image_height(glintL_check_object(L, 1, GLINTL_IMAGE)));
    return 1;
}

static int get_passes(lua_State *L)
{
    lua_Integer count = 0;
    lua_newtable(L);
    for (unsigned pass = 0; pass < GLINT_PASS_COUNT; pass++) {
        if (glint_image_has_pass(glintL_check_object(L, 1, GLINTL_IMAGE), (glint_pass)pass)) {
            lua_pushstring(L, glint_pass_name((glint_pass)pass));
            lua_rawseti(L, -2, ++count);
        }
    }
    const char *name;
    for (size_t i = 0; (name = glint_image_derivative(glintL_check_object(L, 1, GLINTL_IMAGE), i)); i++) {
        lua_pushfstring(L, "d:%s", name);
        lua_rawseti(L, -2, ++count);
    }
    for (size_t i = 0; (name = glint_image_light_pass(glintL_check_object(L, 1, GLINTL_IMAGE), i)); i++) {
        lua_pushfstring(L, "light:%s", name);
        lua_rawseti(L, -2, ++count);
    }
    return 1;
}

static int get_exposure(lua_State *L)
{
    lua_pushnumber(L, glint_image_exposure(glintL_check_object(L, 1, GLINTL_IMAGE)));
    return 1;
}

static const luaL_Reg GETTERS[] = {
    { "width", get_width },
    { "height", get_height },
    { "passes", get_passes },
    { "exposure", get_exposure },
    { NULL, NULL },
};

static const glintL_variant IMAGE = { .name = "image", .fields = NO_FIELDS, .getters = GETTERS };

static const glintL_variant *variant(const void *object)
{
    (void)object;
    return &IMAGE;
}

static void *retain(void *object) { return glint_image_retain(object); }

static void release(void *object) { glint_image_release(object); }

// Returns a whole number from 0 up to `count` - 1.
static int check_coordinate(lua_State *L, int index, const char *path, int count)
{
    double x = glintL_read_number(L, index, path);
    if (!(x >= 0 && x < count && x == (int)x)) {
        const char *got = glintL_push_spelling(L, index);
        glintL_error(L, "%s: whole number 0 .. %d expected, got %s", path, count - 1, got);
    }
    return (int)x;
}

// Returns the derivative by that name; GLINT_PASS_COUNT + GLINT_DERIVATIVES_MAX: there is none.
static glint_pass find_derivative(const glint_image *image, const char *name)
{
    size_t i = 0;
    while (i < GLINT_DERIVATIVES_MAX &&
           !(glint_image_derivative(image, i) && strcmp(glint_image_derivative(image, i), name) == 0))
        i++;
    return (glint_pass)(GLINT_PASS_DERIVATIVE + i);
}

// Returns the light pass by that name; GLINT_PASS_COUNT: there is none.
static glint_pass find_light_pass(const glint_image *image, const char *name)
{
    const char *own;
    for (size_t i = 0; (own = glint_image_light_pass(image, i)); i++)
        if (strcmp(own, name) == 0)
            return (glint_pass)(GLINT_PASS_LIGHT + i);
    return GLINT_PASS_COUNT;
}

// Returns the pass named at `index`, of the image at 1; nil: beauty.
static glint_pass check_pass(lua_State *L, int index, const char *path)
{
    if (lua_isnoneornil(L, index))
        return GLINT_PASS_BEAUTY;
    glint_pass pass = GLINT_PASS_COUNT;
    if (lua_type(L, index) == LUA_TSTRING)
        pass = glint_pass_from_name(lua_tostring(L, index));
    if (pass == GLINT_PASS_COUNT && lua_type(L, index) == LUA_TSTRING &&
        strncmp(lua_tostring(L, index), "d:", 2) == 0) {
        const char *name = lua_tostring(L, index) + 2;
        pass = find_derivative(glintL_check_object(L, 1, GLINTL_IMAGE), name);
        if (pass == GLINT_PASS_COUNT + GLINT_DERIVATIVES_MAX)
            glintL_error(L, "%s: 'd:%s' is not stored in this image", path, name);
        return pass;
    }
    if (pass == GLINT_PASS_COUNT && lua_type(L, index) == LUA_TSTRING && strncmp(lua_tostring(L, index), "light:", 6) == 0) {
        const char *name = lua_tostring(L, index) + 6;
        pass = find_light_pass(glintL_check_object(L, 1, GLINTL_IMAGE), name);
        if (pass == GLINT_PASS_COUNT)
            glintL_error(L, "%s: 'light:%s' is not stored in this image", path, name);
    }
    if (pass == GLINT_PASS_COUNT)
        glintL_refuse(L, index, path, "name of a pass");
    return pass;
}

static int pixel(lua_State *L)
{
    float out[3];
    glint_error error;
    const glint_image *image = glintL_check_object(L, 1, GLINTL_IMAGE);
    int x = check_coordinate(L, 2, "pixel.x", glint_image_width(image));
    int y = check_coordinate(L, 3, "pixel.y", glint_image_height(image));
    glint_pass pass = check_pass(L, 4, "pixel.pass");
    glintL_check_status(L, "pixel", &error, glint_image_pixel(image, pass, x, y, out, &error));
    int channels = glint_pass_channels(pass);
    for (int c = 0; c < channels; c++)
        lua_pushnumber(L, (lua_Number)out[c]);
    return channels;
}

// Reads the name of a colour map such as "viridis", with a range ("viridis:1:9"), or nil, from the top of the stack,
// and pops it.
static void take_colormap(lua_State *L, glint_write_desc *desc)
{
    static const glintL_field name = { .name = "colormap", .type = GLINT_TYPE_CHOICE, .names = glintL_pass_colormaps };
    char message[GLINTL_MESSAGE_SIZE];
    const char *text = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : NULL, *colon = text ? strchr(text, ':') : NULL;
    if (colon)
        lua_pushlstring(L, text, (size_t)(colon - text));
    else
        lua_pushvalue(L, -1);
    if (!lua_isnil(L, -1))
        glintL_read_field(L, -1, "save", &name, &desc->colormap);
    if (colon && !glintL_read_range(colon, desc->range, message))
        glintL_error(L, "save.colormap: %s", message);
    lua_pop(L, 2);
}

static void read_options(lua_State *L, glint_write_desc *desc)
{
    static const char *const transfers[] = { "srgb", "linear", "none", NULL };
    static const char *const roundings[] = { "nearest", "truncate", NULL }, *const encodes[] = { "fast", "small",
                                                                                                 NULL };
    typedef struct options {
        glint_write_desc desc;
        double bits;
    } options;
    static const glintL_field fields[] = {
        { .name = "bits", .type = GLINT_TYPE_NUMBER, .offset = offsetof(options, bits) },
        { .name = "transfer",
          .type = GLINT_TYPE_CHOICE,
          .offset = offsetof(options, desc.tone.transfer),
          .names = transfers },
        { .name = "rounding",
          .type = GLINT_TYPE_CHOICE,
          .offset = offsetof(options, desc.tone.rounding),
          .names = roundings },
        { .name = "tone",
          .type = GLINT_TYPE_CHOICE,
          .offset = offsetof(options, desc.tone.curve),
          .names = glintL_tone_curves },
        { .name = "exposure", .type = GLINT_TYPE_NUMBER, .offset = offsetof(options, desc.tone.exposure) },
        { .name = "dither", .type = GLINT_TYPE_FLAG, .offset = offsetof(options, desc.tone.dither) },
        { .name = "encode", .type = GLINT_TYPE_CHOICE, .offset = offsetof(options, desc.encode), .names = encodes },
        { .name = "dpi", .type = GLINT_TYPE_NUMBER, .offset = offsetof(options, desc.dpi) },
        { .name = "colormap", .type = GLINT_TYPE_OTHER },
        { .name = "pass", .type = GLINT_TYPE_OTHER },
        { .name = NULL },
    };
    options read = { .desc = *desc, .bits = desc->tone.bits };
    glintL_read_table(L, 3, "save", fields, &read, false);
    if (read.bits != 8 && read.bits != 16)
        glintL_error(L, "save.bits: 8 or 16 expected, got %f", read.bits);
    read.desc.tone.bits = (int)read.bits;
    lua_pushliteral(L, "colormap");
    lua_rawget(L, 3);
    take_colormap(L, &read.desc);
    lua_pushliteral(L, "pass");
    lua_rawget(L, 3);
    read.desc.pass = check_pass(L, -1, "save.pass");
    lua_pop(L, 1);
    *desc = read.desc;
}

static const char *check_path(lua_State *L)
{
    size_t length;
    if (lua_type(L, 2) != LUA_TSTRING)
        glintL_refuse(L, 2, "save.path", "file name");
    const char *path = lua_tolstring(L, 2, &length);
    if (length == 0 || strlen(path) != length)
        glintL_refuse(L, 2, "save.path", "file name without zero bytes");
    const glintL_request *request = &glintL_get_run(L)->request;
    if (!request->is_untrusted)
        return path;
    if (!request->folder || !glintL_name_is_plain(path, length))
        glintL_refuse(L, 2, "save.path",
                      request->folder ? GLINTL_PLAIN_NAME : "no file, because this run writes no pictures,");
    lua_pushfstring(L, "%s/%s", request->folder, path);
    lua_replace(L, 2);
    path = lua_tostring(L, 2);
    if (glintL_name_is_special(path))
        glintL_refuse(L, 2, "save.path", "regular file (not a pipe or device)");
    return path;
}

static int save(lua_State *L)
{
    glint_error error;
    glintL_run *run = glintL_get_run(L);
    glintL_check_object(L, 1, GLINTL_IMAGE);
    glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .path = check_path(L), .pass = GLINT_PASS_BEAUTY, .tone = glint_tone_desc_default() };
    if (!lua_isnoneornil(L, 3))
        read_options(L, &desc);
    glint_status status = glint_image_write(glintL_check_object(L, 1, GLINTL_IMAGE), &desc, &error);
    if (status == GLINT_ERR_IO || status == GLINT_ERR_NO_SPACE) { // nil and a message, as from io.open
        luaL_pushfail(L);
        lua_pushstring(L, error.message);
        return 2;
    }
    glintL_check_status(L, "save", &error, status);
    if (desc.pass == GLINT_PASS_BEAUTY && !run->measures && !glintL_name_is_linear(desc.path))
        glintL_look_at_brightness(run, glintL_check_object(L, 1, GLINTL_IMAGE), &desc.tone);
    if (!run->measures && !glintL_written_note(run, "save", desc.path, run->count))
        return glintL_error(L, "save: %s", run->message);
    lua_pushboolean(L, true);
    return 1;
}

// Pushes a buffer with the float32 of the pass named at 2.
static float *push_floats(lua_State *L, const char *path, size_t *pixels, size_t *channels)
{
    glint_error error;
    glintL_check_object(L, 1, GLINTL_IMAGE);
    const glint_pass pass = check_pass(L, 2, path);
    lua_settop(L, 1);
    const glint_image *image = glintL_check_object(L, 1, GLINTL_IMAGE);
    *pixels = (size_t)glint_image_width(image) * (size_t)glint_image_height(image);
    *channels = (size_t)glint_pass_channels(pass);
    float *out = lua_newuserdatauv(L, *pixels * *channels * sizeof *out, 0);
    image = glintL_check_object(L, 1, GLINTL_IMAGE); // a finalizer could have closed it
    glintL_check_status(L, path, &error, glint_image_floats(image, pass, out, &error));
    return out;
}

// Returns the pass as float32, little endian, row by row from the top, as string.unpack and NumPy read it.
static int bytes(lua_State *L)
{
    luaL_Buffer out;
    size_t pixels, channels;
    const float *values = push_floats(L, "bytes.pass", &pixels, &channels);
    char *to = luaL_buffinitsize(L, &out, pixels * channels * 4);
    for (size_t i = 0; i < pixels * channels; i++)
        to = glintL_put_float(to, values[i]);
    luaL_pushresultsize(&out, pixels * channels * 4);
    return 1;
}

// Returns the pass as an array with a row for each pixel, row by row of the picture from the top.
static int to_array(lua_State *L)
{
    size_t pixels, channels;
    const float *values = push_floats(L, "array.pass", &pixels, &channels);
    glintL_array *out = glintL_push_array(L, pixels, channels, false);
    for (size_t i = 0; i < pixels * channels; i++)
        out->numbers[i] = values[i];
    return 1;
}

static const luaL_Reg METHODS[] = { { "array", to_array }, { "bytes", bytes }, { "pixel", pixel }, { "save", save }, { NULL, NULL } };

static const glintL_class CLASS = {
    .type = GLINTL_IMAGE,
    .variant = variant,
    .retain = retain,
    .release = release,
    .methods = METHODS,
};

void glintL_open_image(lua_State *L)
{
    glintL_open_class(L, &CLASS);
    glintL_list_object(L, &IMAGE, &CLASS);
}
