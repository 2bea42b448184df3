// The fields that describe a frame and its file, read from a script's table and from the command line.
#include <errno.h>
#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/run.h"
#include "engine/glint_figures.h"

#define SEED_MAX 9007199254740992.0 // 2^53
#define DEPTH_MAX 2147483648.0 // 2^31

typedef enum sort {
    WHOLE, // an int64_t, min .. max
    REAL, // a number, also with fractions, min .. max
    CHOICE, // an enum
    COLORS, // a colour map and its range
    BITS,
    FLAG, // a bool
    OUTPUT,
    PASSES,
    REGION, // four int64_t; all 0: none
    ORBIT
} sort;

typedef struct detail {
    sort sort;
    size_t offset; // offset of the field in glintL_render
    double min, max;
    const char *const *names; // CHOICE
} detail;

static const char *const precisions[] = { "double", "float", NULL };
static const char *const visibilities[] = { "auto", "cast", "scan", NULL };
static const char *const transfers[] = { "srgb", "linear", "none", NULL };
static const char *const roundings[] = { "nearest", "truncate", NULL };
static const char *const outlines[] = { "none", "black", "white", NULL };
static const char *const encodes[] = { "fast", "small", NULL };

#define AT(member) offsetof(glintL_render, member)

const char *const glintL_tone_curves[] = { "clamp", "reinhard", "filmic", NULL };
const char *const glintL_pass_colormaps[] = { "none", "viridis", "magma", "cividis", "turbo", "coolwarm", NULL };
_Static_assert(sizeof glintL_pass_colormaps / sizeof *glintL_pass_colormaps == GLINT_COLORMAP_COUNT + 2, "a name each");

#define WITH_TEXT(name, kind, sort, member, min, max, words, text, help) \
    FIELD(name, kind, sort, member, min, max, words)

const glintL_field glintL_render_fields[GLINTL_RENDER_FIELDS + 1] = {
#define FIELD(field, letters, ...) { .name = #field, .type = GLINT_TYPE_##letters },
    GLINTL_RENDER_LIST(FIELD, WITH_TEXT) { .name = NULL },
#undef FIELD
};

static const detail details[GLINTL_RENDER_FIELDS] = {
#define FIELD(name, kind, sort, member, min, max, words) { sort, AT(member), min, max, words },
    GLINTL_RENDER_LIST(FIELD, WITH_TEXT)
#undef FIELD
};

glintL_render glintL_render_default(void)
{
    glintL_render render;
    memset(&render, 0, sizeof render);
    render.desc = glint_render_desc_default();
    render.desc.tone = glint_tone_desc_default();
    render.encode = GLINT_ENCODE_FAST;
    return render;
}

int glintL_render_find(const char *name)
{
    for (int i = 0; i < GLINTL_RENDER_FIELDS; i++)
        if (strcmp(glintL_render_fields[i].name, name) == 0)
            return i;
    return -1;
}

const char *const *glintL_render_choices(int field) { return field >= 0 ? details[field].names : NULL; }

static bool is_number(const detail *option)
{
    return option->sort == WHOLE || option->sort == REAL || option->sort == BITS;
}

// Returns the allowed values, for messages.
static void describe(const detail *option, char out[256])
{
    size_t used = 0;
    switch (option->sort) {
    case WHOLE:
        snprintf(out, 256, "whole number %.17g .. %.17g", option->min, option->max);
        break;
    case REAL:
        snprintf(out, 256, "number %.17g .. %.17g", option->min, option->max);
        break;
    case BITS:
        snprintf(out, 256, "8 or 16");
        break;
    case FLAG:
        snprintf(out, 256, "true or false");
        break;
    case CHOICE:
    case COLORS:
        for (const char *const *name = option->names; *name; name++)
            used += (size_t)snprintf(out + used, 256 - used, "%s\"%s\"",
                                     name == option->names ? "" : (name[1] ? ", " : " or "), *name);
        break;
    case OUTPUT:
        snprintf(out, 256, "file name");
        break;
    case REGION:
        snprintf(out, 256, "region X,Y,WIDTH,HEIGHT in whole pixels from the top left");
        break;
    case ORBIT:
        snprintf(out, 256, "true, false or YAW,PITCH,ZOOM,RIGHT,UP in degrees and heights of the picture, with ZOOM 0.001 .. 1000");
        break;
    case PASSES:
        for (int pass = 0; pass < GLINT_PASS_COUNT; pass++)
            used += (size_t)snprintf(out + used, 256 - used, "%s%s", pass ? ", " : "list of ", glint_pass_name(pass));
        snprintf(out + used, 256 - used, ", d:NAME, light:NAME, all");
        break;
    }
}

// Stores a number. False: it is not allowed, or the field takes no number.
static bool set_number(glintL_render *render, const detail *option, double value)
{
    char *field = (char *)render + option->offset;
    int bits = value == 16 ? 16 : 8;
    int64_t whole;
    switch (option->sort) {
    case WHOLE:
        // Within the limits the conversion is exact. NaN fails the comparison.
        if (!(value >= option->min && value <= option->max) || value != (double)(int64_t)value)
            return false;
        whole = (int64_t)value;
        memcpy(field, &whole, sizeof whole);
        return true;
    case REAL:
        if (!(value >= option->min && value <= option->max))
            return false;
        memcpy(field, &value, sizeof value);
        return true;
    case BITS:
        memcpy(field, &bits, sizeof bits);
        return value == bits;
    default:
        return false;
    }
}

static bool set_choice(glintL_render *render, const detail *option, const char *text)
{
    for (unsigned value = 0; option->names[value]; value++) {
        if (strcmp(option->names[value], text) == 0) {
            memcpy((char *)render + option->offset, &value, sizeof value); // enums are stored as int by GCC and Clang
            return true;
        }
    }
    return false;
}

// Reads "viridis" or "viridis:1:9". False: the name is wrong, or the range. Only a wrong range
// writes `message`.
static bool set_colors(glintL_render *render, const detail *option, const char *text, char message[GLINTL_MESSAGE_SIZE])
{
    char name[32];
    const size_t length = strcspn(text, ":");
    glintL_render read = *render;
    *message = '\0';
    snprintf(name, sizeof name, "%.*s", length < sizeof name ? (int)length : (int)sizeof name - 1, text);
    if (!set_choice(&read, option, name) || !glintL_read_range(text + length, read.range, message))
        return false;
    *render = read;
    return true;
}

// Returns the nearest choice; NULL: none is near.
static const char *nearest_choice(const detail *option, const char *text)
{
    const char *near = NULL;
    for (const char *const *name = option->names; *name; name++)
        near = glintL_nearer(text, near, *name);
    return near;
}

static bool set_flag(glintL_render *render, const detail *option, const char *text)
{
    const bool value = strcmp(text, "true") == 0;
    memcpy((char *)render + option->offset, &value, sizeof value);
    return value || strcmp(text, "false") == 0;
}

static bool add_derivative(glintL_render *to, const char *name)
{
    for (int i = 0; i < to->derivative_count; i++)
        if (strcmp(to->derivative[i], name) == 0)
            return true;
    const size_t length = strlen(name);
    if (length == 0 || length >= sizeof *to->derivative || to->derivative_count == GLINT_DERIVATIVES_MAX)
        return false;
    memcpy(to->derivative[to->derivative_count++], name, length + 1);
    return true;
}

// Adds a pass to `to`. Reading a list replaces all passes of a frame.
static bool add_pass(glintL_render *to, const char *name, size_t length)
{
    char copy[GLINTL_PASS_NAME_SIZE];
    if (length >= sizeof copy)
        return false;
    memcpy(copy, name, length);
    copy[length] = '\0';
    if (strncmp(copy, "d:", 2) == 0)
        return add_derivative(to, copy + 2);
    if (strcmp(copy, "all") == 0) {
        to->file_passes |= ((1u << GLINT_PASS_COUNT) - 1) & ~(1u << GLINT_PASS_BEAUTY);
        return true;
    }
    if (strncmp(copy, "light:", 6) == 0)
        return glintL_add_light_pass(to, copy + 6);
    glint_pass pass = glint_pass_from_name(copy);
    if (pass == GLINT_PASS_COUNT)
        return false;
    if (pass != GLINT_PASS_BEAUTY) // beauty is always written
        to->file_passes |= 1u << pass;
    return true;
}

static void clear_passes(glintL_render *render)
{
    render->file_passes = 0;
    render->derivative_count = 0;
    memset(render->light_passes, 0, sizeof render->light_passes);
    memset(render->derivative, 0, sizeof render->derivative);
}

// Writes the message: "normals" is not a pass; did you mean ...
static void complain_pass(const char *name, size_t length, char message[GLINTL_MESSAGE_SIZE])
{
    char copy[64], allowed[256];
    const char *near = NULL;
    snprintf(copy, sizeof copy, "%.*s", length < sizeof copy ? (int)length : (int)sizeof copy - 1, name);
    if (strncmp(copy, "d:", 2) == 0) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "'%s': expected a name of 1 .. %d bytes after d:, and at most %d "
                                               "derivatives",
                 copy, GLINT_DERIVATIVE_NAME_SIZE - 1, GLINT_DERIVATIVES_MAX);
        return;
    }
    if (strncmp(copy, "light:", 6) == 0) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "'%s': expected a light's name or group of 1 .. %d bytes after "
                                               "light:, and at most %zu bytes for all light passes",
                 copy, GLINT_NAME_SIZE - 1, sizeof ((glintL_render *)0)->light_passes - 1);
        return;
    }
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++)
        near = glintL_nearer(copy, near, glint_pass_name((glint_pass)pass));
    describe(&(detail) { .sort = PASSES }, allowed);
    if (near)
        snprintf(message, GLINTL_MESSAGE_SIZE, "'%s' is not a pass; did you mean '%s'?", copy, near);
    else
        snprintf(message, GLINTL_MESSAGE_SIZE, "'%s' is not a pass; %s expected", copy, allowed);
}

// Reads "ambient,depth"; "" and "none": no files except the beauty.
static bool read_passes(const char *text, glintL_render *render, char message[GLINTL_MESSAGE_SIZE])
{
    glintL_render read = *render;
    clear_passes(&read);
    if (*text && strcmp(text, "none") != 0) {
        for (const char *at = text;;) {
            at += strspn(at, " ");
            size_t length = strcspn(at, ", ");
            const char *after = at + length + strspn(at + length, " ");
            if ((*after && *after != ',') || !add_pass(&read, at, length)) {
                complain_pass(at, *after && *after != ',' ? strcspn(at, ",") : length, message);
                return false;
            }
            if (!*after)
                break;
            at = after + 1;
        }
    }
    *render = read;
    return true;
}

// Reads "X,Y,W,H". Planning the frame checks that the region is inside the frame.
static bool set_region(int64_t region[4], const char *text)
{
    int64_t read[4];
    const char *at = text;
    for (int i = 0; i < 4; i++) {
        char *end;
        const long value = strtol(at, &end, 10);
        if (end == at || *at < '0' || *at > '9' || value > GLINT_SIDE_MAX || *end != (i < 3 ? ',' : '\0'))
            return false;
        read[i] = value;
        at = end + 1;
    }
    if (read[2] < 1 || read[3] < 1)
        return false;
    memcpy(region, read, sizeof read);
    return true;
}

// Sets a field whose value is a word. False: `message` is written.
static bool set_word(glintL_render *render, const detail *option, const char *text, char message[GLINTL_MESSAGE_SIZE])
{
    char allowed[256];
    bool good = false;
    if (option->sort == OUTPUT) {
        if (!glintL_name_check(text, message))
            return false;
        snprintf(render->output, sizeof render->output, "%s", text);
        return true;
    }
    if (option->sort == CHOICE)
        good = set_choice(render, option, text);
    else if (option->sort == FLAG)
        good = set_flag(render, option, text);
    else if (option->sort == REGION)
        good = set_region(render->desc.region, text);
    else if (option->sort == ORBIT)
        good = glintL_orbit_read(text, &render->orbit);
    else if (option->sort == PASSES)
        return read_passes(text, render, message);
    else if (option->sort == COLORS)
        good = set_colors(render, option, text, message);
    if (good || (option->sort == COLORS && *message))
        return good;
    describe(option, allowed);
    const char *near = option->names ? nearest_choice(option, text) : NULL;
    return glintL_complain(message, "%s expected, got '%.200s'%s%s%s", allowed, text, near ? "; did you mean '" : "",
                           near ? near : "", near ? "'?" : "");
}

bool glintL_render_set_text(glintL_render *render, int field, const char *text, char message[GLINTL_MESSAGE_SIZE])
{
    const detail *option = &details[field];
    char allowed[256], *end;
    if (!is_number(option))
        return set_word(render, option, text, message);
    double value = strtod(text, &end);
    if (end != text && *end == '\0' && set_number(render, option, value))
        return true;
    describe(option, allowed);
    return glintL_complain(message, "%s expected, got '%.200s'", allowed, text);
}

// ---- From Lua ----

static int refuse(lua_State *L, int index, const char *path, int field)
{
    char full[128], allowed[256];
    snprintf(full, sizeof full, "%s%s", path, glintL_render_fields[field].name);
    describe(&details[field], allowed);
    return glintL_refuse(L, index, full, allowed);
}

static void read_pass_list(lua_State *L, int index, const char *path, int field, glintL_render *render)
{
    char full[128];
    char message[GLINTL_MESSAGE_SIZE];
    glintL_render read = *render;
    size_t length = 0;
    clear_passes(&read);
    snprintf(full, sizeof full, "%s%s", path, glintL_render_fields[field].name);
    size_t count = glintL_check_list(L, index, full, false);
    for (size_t i = 1; i <= count; i++) {
        lua_rawgeti(L, index, (lua_Integer)i);
        const char *name = lua_type(L, -1) == LUA_TSTRING ? lua_tolstring(L, -1, &length) : NULL;
        if (!name)
            refuse(L, -1, path, field);
        if (!add_pass(&read, name, length)) {
            complain_pass(name, length, message);
            glintL_error(L, "%s: %s", full, message);
        }
        lua_pop(L, 1);
    }
    *render = read;
}

// Reads {x, y, width, height}.
static void read_region(lua_State *L, int index, const char *path, int field, glintL_render *render)
{
    char text[128] = "", full[128];
    size_t used = 0;
    snprintf(full, sizeof full, "%s%s", path, glintL_render_fields[field].name);
    if (glintL_check_list(L, index, full, false) != 4)
        refuse(L, index, path, field);
    for (int i = 1; i <= 4; i++) {
        lua_Integer value = 0;
        int is_whole = 0;
        if (lua_rawgeti(L, index, i) == LUA_TNUMBER)
            value = lua_tointegerx(L, -1, &is_whole);
        if (!is_whole)
            refuse(L, -1, path, field);
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%lld", i > 1 ? "," : "", (long long)value);
        lua_pop(L, 1);
    }
    if (!set_region(render->desc.region, text))
        refuse(L, index, path, field);
}

void glintL_render_read(lua_State *L, int index, const char *path, int field, glintL_render *render)
{
    const detail *option = &details[field];
    char message[GLINTL_MESSAGE_SIZE];
    size_t length;
    index = lua_absindex(L, index);
    luaL_checkstack(L, 6, "field");
    if (is_number(option)) {
        if (lua_type(L, index) != LUA_TNUMBER || !set_number(render, option, lua_tonumber(L, index)))
            refuse(L, index, path, field);
        return;
    }
    if (option->sort == FLAG || (option->sort == ORBIT && lua_isboolean(L, index))) {
        if (!lua_isboolean(L, index))
            refuse(L, index, path, field);
        set_word(render, option, lua_toboolean(L, index) ? "true" : "false", message);
        return;
    }
    if (option->sort == PASSES && lua_istable(L, index)) {
        read_pass_list(L, index, path, field, render);
        return;
    }
    if (option->sort == REGION && lua_istable(L, index)) {
        read_region(L, index, path, field, render);
        return;
    }
    if (lua_type(L, index) != LUA_TSTRING)
        refuse(L, index, path, field);
    const char *text = lua_tolstring(L, index, &length);
    if (strlen(text) != length)
        refuse(L, index, path, field);
    if (option->sort == OUTPUT && glintL_get_run(L)->request.is_untrusted && !glintL_name_is_plain(text, length))
        glintL_error(L, "%s%s: " GLINTL_PLAIN_NAME " expected, got '%s'", path, glintL_render_fields[field].name, text);
    if (!set_word(render, option, text, message))
        glintL_error(L, "%s%s: %s", path, glintL_render_fields[field].name, message);
}

static void push_passes(lua_State *L, const glintL_render *render)
{
    int count = 0;
    lua_newtable(L);
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++) {
        if (render->file_passes >> pass & 1) {
            lua_pushstring(L, glint_pass_name(pass));
            lua_rawseti(L, -2, ++count);
        }
    }
    for (int i = 0; i < render->derivative_count; i++) {
        lua_pushfstring(L, "d:%s", render->derivative[i]);
        lua_rawseti(L, -2, ++count);
    }
    char name[GLINT_NAME_SIZE];
    const char *lights = *render->light_passes ? render->light_passes : NULL;
    for (size_t i = 0; glintL_light_pass_at(lights, i, name); i++) {
        lua_pushfstring(L, "light:%s", name);
        lua_rawseti(L, -2, ++count);
    }
}

static void push_region(lua_State *L, const int64_t region[4])
{
    if (region[2] == 0) {
        lua_pushnil(L);
        return;
    }
    lua_createtable(L, 4, 0);
    for (int i = 0; i < 4; i++) {
        lua_pushinteger(L, region[i]);
        lua_rawseti(L, -2, i + 1);
    }
}

bool glintL_render_spell(const glintL_render *render, int field, char out[96])
{
    const detail *option = &details[field];
    const char *at = (const char *)render + option->offset;
    int64_t whole;
    double number;
    unsigned value;
    switch (option->sort) {
    case WHOLE:
        memcpy(&whole, at, sizeof whole);
        snprintf(out, 64, "%" PRId64, whole);
        return true;
    case REAL:
        memcpy(&number, at, sizeof number);
        snprintf(out, 64, "%.17g", number);
        return true;
    case BITS:
        snprintf(out, 64, "%d", render->desc.tone.bits);
        return true;
    case FLAG:
        snprintf(out, 64, "%s", *(const bool *)at ? "true" : "false");
        return true;
    case CHOICE:
        memcpy(&value, at, sizeof value);
        snprintf(out, 64, "%s", option->names[value]);
        return true;
    case COLORS:
        glintL_spell_colormap(render->colormap, render->range, out);
        return true;
    case REGION:
        snprintf(out, 96, "%" PRId64 ",%" PRId64 ",%" PRId64 ",%" PRId64, render->desc.region[0], render->desc.region[1],
                 render->desc.region[2], render->desc.region[3]);
        return render->desc.region[2] > 0;
    case ORBIT:
        return glintL_orbit_spell(&render->orbit, out);
    default:
        return false;
    }
}

void glintL_render_push(lua_State *L, int field, const glintL_render *render)
{
    const detail *option = &details[field];
    const char *at = (const char *)render + option->offset;
    char spelt[64];
    int64_t whole;
    double number;
    unsigned value;
    switch (option->sort) {
    case WHOLE:
        memcpy(&whole, at, sizeof whole);
        lua_pushinteger(L, whole);
        break;
    case REAL:
        memcpy(&number, at, sizeof number);
        lua_pushnumber(L, number);
        break;
    case BITS:
        lua_pushinteger(L, render->desc.tone.bits);
        break;
    case FLAG:
        lua_pushboolean(L, *(const bool *)at);
        break;
    case CHOICE:
        memcpy(&value, at, sizeof value);
        lua_pushstring(L, option->names[value]);
        break;
    case COLORS:
        glintL_spell_colormap(render->colormap, render->range, spelt);
        lua_pushstring(L, spelt);
        break;
    case PASSES:
        push_passes(L, render);
        break;
    case OUTPUT:
        if (*at)
            lua_pushstring(L, at);
        else
            lua_pushnil(L);
        break;
    case REGION:
        push_region(L, render->desc.region);
        break;
    case ORBIT:
        lua_pushboolean(L, render->orbit.is_allowed);
        break;
    }
}
