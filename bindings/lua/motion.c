// glint.ease and glint.keys: numbers that change with a frame's time. They use only sums and products, so that the
// results are the same on every machine.
#include "bindings/value/glintL.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define VALUE_MAX 16 // numbers in a key's value, at most

typedef enum easing { EASE_LINEAR, EASE_SMOOTH, EASE_SMOOTHER, EASE_IN, EASE_OUT, EASE_SPLINE } easing;

static const char *const easings[] = { "linear", "smooth", "smoother", "in", "out", "spline" };

typedef struct track {
    uint32_t count, size; ///< number of keys; numbers in a value
    bool is_list, cyclic;
    easing ease;
    double numbers[]; ///< the times, then the values, key by key
} track;

// ---- The curves ----

static double eased(easing kind, double t)
{
    t = t > 0 ? t < 1 ? t : 1 : 0;
    switch (kind) {
    case EASE_SMOOTH:
        return t * t * (3 - 2 * t);
    case EASE_SMOOTHER: // K. Perlin, "Improving Noise", SIGGRAPH 2002
        return t * t * t * (t * (t * 6 - 15) + 10);
    case EASE_IN:
        return t * t;
    case EASE_OUT:
        return t * (2 - t);
    default:
        return t;
    }
}

static double key_time(const track *k, uint32_t i) { return k->numbers[i]; }

static double key_value(const track *k, uint32_t i, uint32_t c) { return k->numbers[k->count + i * k->size + c]; }

/// Returns the slope at a key: the slope between its neighbours (E. Catmull, R. Rom, "A Class of Local Interpolating
/// Splines", 1974, for times that are not evenly spaced). At the ends, the slope of the first or last segment, or
/// around the cycle.
static double slope(const track *k, uint32_t i, uint32_t c)
{
    const uint32_t last = k->count - 1;
    if (i > 0 && i < last)
        return (key_value(k, i + 1, c) - key_value(k, i - 1, c)) / (key_time(k, i + 1) - key_time(k, i - 1));
    const double first_span = key_time(k, 1) - key_time(k, 0), last_span = key_time(k, last) - key_time(k, last - 1);
    const double first_rise = key_value(k, 1, c) - key_value(k, 0, c);
    const double last_rise = key_value(k, last, c) - key_value(k, last - 1, c);
    if (k->cyclic)
        return (first_rise + last_rise) / (first_span + last_span);
    return i == 0 ? first_rise / first_span : last_rise / last_span;
}

/// Returns component c between keys i and i + 1, at the fraction t of the interval.
static double between(const track *k, uint32_t i, double t, uint32_t c)
{
    const double a = key_value(k, i, c), b = key_value(k, i + 1, c);
    if (t <= 0 || t >= 1)
        return t <= 0 ? a : b;
    if (k->ease != EASE_SPLINE)
        return a + eased(k->ease, t) * (b - a);
    const double span = key_time(k, i + 1) - key_time(k, i), s = t * t * (3 - 2 * t), rest = 1 - t;
    return (a + s * (b - a)) + span * (t * rest * (rest * slope(k, i, c) - t * slope(k, i + 1, c)));
}

// ---- In and out ----

static easing read_easing(lua_State *L, int index, const char *path, int count)
{
    const char *name = lua_type(L, index) == LUA_TSTRING ? lua_tostring(L, index) : "";
    for (int i = 0; i < count; i++)
        if (strcmp(name, easings[i]) == 0)
            return (easing)i;
    glintL_refuse(L, index, path,
                  count > EASE_SPLINE ? "one of 'linear', 'smooth', 'smoother', 'in', 'out', 'spline'"
                                      : "one of 'linear', 'smooth', 'smoother', 'in', 'out'");
    return EASE_LINEAR;
}

static int motion_ease(lua_State *L)
{
    const double t = glintL_read_number(L, 1, "ease");
    if (isnan(t))
        glintL_refuse(L, 1, "ease", "number that is not NaN");
    const easing kind = lua_isnoneornil(L, 2) ? EASE_SMOOTH : read_easing(L, 2, "ease: kind", EASE_SPLINE);
    lua_pushnumber(L, eased(kind, t));
    return 1;
}

/// Pushes the value at a time. Upvalue 1: the track; 1: the time.
static int value_at(lua_State *L)
{
    const track *k = lua_touserdata(L, lua_upvalueindex(1));
    double t = glintL_read_number(L, 1, "keys"), out[VALUE_MAX];
    uint32_t i = 0;
    if (isnan(t))
        glintL_refuse(L, 1, "keys", "number that is not NaN");
    const double first = key_time(k, 0), whole = key_time(k, k->count - 1) - first;
    if (k->cyclic && (t < first || t >= first + whole))
        t -= whole * floor((t - first) / whole);
    while (i + 2 < k->count && t >= key_time(k, i + 1))
        i++;
    const double share = (t - key_time(k, i)) / (key_time(k, i + 1) - key_time(k, i));
    for (uint32_t c = 0; c < k->size; c++)
        out[c] = between(k, i, share, c);
    if (!k->is_list) {
        lua_pushnumber(L, out[0]);
    } else if (k->size == 3) {
        glintL_push_vector(L, out);
    } else {
        lua_createtable(L, (int)k->size, 0);
        for (uint32_t c = 0; c < k->size; c++) {
            lua_pushnumber(L, out[c]);
            lua_rawseti(L, -2, (lua_Integer)c + 1);
        }
    }
    return 1;
}

static double read_finite(lua_State *L, const char *path)
{
    const double x = glintL_read_number(L, -1, path);
    if (!isfinite(x))
        glintL_refuse(L, -1, path, "finite number");
    return x;
}

/// Returns how many numbers the value on top has: a number, a vector, or a list of numbers.
static uint32_t value_size(lua_State *L, const char *path, bool *is_list)
{
    *is_list = lua_type(L, -1) != LUA_TNUMBER;
    if (!*is_list)
        return 1;
    if (glintL_to_vector(L, -1))
        return 3;
    const size_t size = lua_istable(L, -1) ? glintL_check_list(L, lua_gettop(L), path, false) : 0;
    if (size < 1 || size > VALUE_MAX)
        glintL_refuse(L, -1, path, "number, vector or list of up to 16 numbers");
    return (uint32_t)size;
}

/// Reads the value on top, and checks that it has the form of the first key's value.
static void read_value(lua_State *L, const char *path, const track *k, double *out)
{
    bool is_list;
    const double *vector = glintL_to_vector(L, -1);
    if (value_size(L, path, &is_list) != k->size || is_list != k->is_list)
        glintL_error(L, "%s: expected a value of the same type and length as the first key's", path);
    for (uint32_t c = 0; c < k->size; c++) {
        if (vector || !is_list) {
            out[c] = vector ? vector[c] : read_finite(L, path);
            continue;
        }
        lua_rawgeti(L, -1, (lua_Integer)c + 1);
        out[c] = read_finite(L, path);
        lua_pop(L, 1);
    }
}

/// Pushes the time and the value of key i of the list at 1.
static void push_key(lua_State *L, uint32_t i, char *path, size_t path_size)
{
    snprintf(path, path_size, "keys[%u]", i + 1);
    lua_rawgeti(L, 1, (lua_Integer)i + 1);
    if (!lua_istable(L, -1) || glintL_check_list(L, lua_gettop(L), path, false) != 2)
        glintL_refuse(L, -1, path, "{time, value}");
    lua_rawgeti(L, -1, 1);
    lua_rawgeti(L, -2, 2);
    lua_remove(L, -3);
}

static void read_options(lua_State *L, track *k)
{
    lua_pushnil(L);
    while (lua_next(L, 1)) {
        const char *name = lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : NULL;
        if (name && strcmp(name, "ease") == 0)
            k->ease = read_easing(L, -1, "keys.ease", EASE_SPLINE + 1);
        else if (name && strcmp(name, "cyclic") == 0 && lua_isboolean(L, -1))
            k->cyclic = lua_toboolean(L, -1);
        else if (name && strcmp(name, "cyclic") == 0)
            glintL_refuse(L, -1, "keys.cyclic", "boolean");
        else if (name)
            glintL_no_such_field(L, "keys", name, glintL_nearer(name, glintL_nearer(name, NULL, "ease"), "cyclic"));
        lua_pop(L, 1);
    }
}

static int motion_keys(lua_State *L)
{
    char path[32];
    bool is_list;
    lua_settop(L, 1);
    if (!lua_istable(L, 1))
        glintL_refuse(L, 1, "keys", "list of {time, value}");
    const size_t count = glintL_check_list(L, 1, "keys", true);
    if (count < 2)
        glintL_error(L, "keys: two keys or more expected, got %d", (int)count);
    push_key(L, 0, path, sizeof path);
    const uint32_t size = value_size(L, path, &is_list);
    lua_pop(L, 2);
    track *k = lua_newuserdatauv(L, sizeof *k + count * (1 + size) * sizeof(double), 0);
    *k = (track) { .count = (uint32_t)count, .size = size, .is_list = is_list, .ease = EASE_SMOOTH };
    for (uint32_t i = 0; i < k->count; i++) {
        push_key(L, i, path, sizeof path);
        read_value(L, path, k, k->numbers + count + i * size);
        lua_pop(L, 1);
        k->numbers[i] = read_finite(L, path);
        if (i > 0 && !(k->numbers[i] > k->numbers[i - 1]))
            glintL_error(L, "%s: a time after %f expected, got %f", path, k->numbers[i - 1], k->numbers[i]);
        lua_pop(L, 1);
    }
    read_options(L, k);
    lua_pushcclosure(L, value_at, 1);
    return 1;
}

void glintL_open_motion(lua_State *L)
{
    static const luaL_Reg functions[] = { { "ease", motion_ease }, { "keys", motion_keys }, { NULL, NULL } };
    luaL_setfuncs(L, functions, 0);
}
