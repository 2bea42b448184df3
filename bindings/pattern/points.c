// Runs a pattern's function in plain Lua at 64 points and compares the results with the traced program.
//
// Lua 5.4 cannot intercept `if`, `and`, `or` and `==` on a symbol: a symbol is always true and equal to no number. A
// function that uses them returns other numbers in plain Lua at some of the points. A function that uses random numbers
// differs at all of them.
#include "bindings/pattern/pattern.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define POINTS 64
#define POWER_TOLERANCE 1e-6 // relative; for functions with `^`, which plain Lua computes with C's pow

// Returns the next number, 0 .. 1, of SplitMix64: G. Steele et al., "Fast splittable pseudorandom number generators",
// OOPSLA 2014.
static double next_number(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

static double between(uint64_t *state, double low, double high) { return low + (high - low) * next_number(state); }

// Makes a unit vector with z above 0.1.
static void make_direction(uint64_t *state, double v[3])
{
    const double z = between(state, 0.1, 1), side = sqrt(1 - z * z), angle = between(state, 0, 6.283185307179586);
    v[0] = side * cos(angle);
    v[1] = side * sin(angle);
    v[2] = z;
}

// Chooses a point, usually anywhere in -20 .. 20. Some points are near the origin, at whole numbers, and at 0.
static void make_position(uint64_t *state, int number, double p[3])
{
    for (int i = 0; i < 3; i++) {
        p[i] = between(state, -20, 20);
        if (number % 8 == 7)
            p[i] /= 20;
        else if (number % 8 == 6)
            p[i] = floor(p[i]);
        if (number == 0)
            p[i] = 0;
    }
}

static void make_inputs(uint64_t *state, int number, double in[GLINT_INPUT_COUNT])
{
    make_position(state, number, &in[GLINT_INPUT_P_X]);
    make_position(state, number, &in[GLINT_INPUT_WORLD_X]);
    make_direction(state, &in[GLINT_INPUT_N_X]);
    make_direction(state, &in[GLINT_INPUT_V_X]);
    make_direction(state, &in[GLINT_INPUT_L_X]);
    for (int i = 0; i < 3; i++) {
        in[GLINT_INPUT_LIGHT_R + i] = between(state, 0, 2);
        in[GLINT_INPUT_KD_R + i] = between(state, 0, 1);
        in[GLINT_INPUT_KS_R + i] = between(state, 0, 1);
    }
    in[GLINT_INPUT_UV_U] = between(state, 0, 1);
    in[GLINT_INPUT_UV_V] = between(state, 0, 1);
    in[GLINT_INPUT_FOOTPRINT] = number % 4 == 3 ? 0 : between(state, 0, 0.5);
    in[GLINT_INPUT_UV_FOOTPRINT] = number % 4 == 3 ? 0 : between(state, 0, 0.1);
    in[GLINT_INPUT_UV_FOOTPRINT_U] = in[GLINT_INPUT_UV_FOOTPRINT_V] = in[GLINT_INPUT_UV_FOOTPRINT];
    in[GLINT_INPUT_DISTANCE] = between(state, 1, 30);
    in[GLINT_INPUT_SHININESS] = between(state, 1, 200);
}

static bool is_same(double a, double b, double tolerance)
{
    if (a == b || (isnan(a) && isnan(b)))
        return true;
    return fabs(a - b) <= tolerance * fmax(fabs(a), fabs(b)); // false for NaN
}

static void refuse(lua_State *L, int index, const double in[GLINT_INPUT_COUNT], double lua, double program)
{
    lua_Debug where;
    char text[192];
    const glintL_pattern *pattern = lua_touserdata(L, index);
    const double *at = &in[pattern->kind == GLINT_PROGRAM_SHADER ? GLINT_INPUT_L_X : GLINT_INPUT_P_X];
    const double scale = fmax(fabs(lua), fabs(program));
    const int digits = fabs(lua - program) > 0.01 * scale ? 3 : 17;
    lua_getiuservalue(L, index, 1);
    lua_getinfo(L, ">S", &where);
    snprintf(text, sizeof text, "the Lua function gives %.*g, the compiled program %.*g at %s(%.3g, %.3g, %.3g)", digits, lua, digits, program,
             pattern->kind == GLINT_PROGRAM_SHADER ? "s.l = " : "", at[0], at[1], at[2]);
    lua_pushfstring(L,
                    "%s:%d: %s: does the function have an `if`, `and` or `or` on a value of the point, or a random "
                    "number? use glint.select",
                    where.short_src, where.linedefined, text);
    lua_error(L);
}

// Returns output i. A single number is grey; a missing specular part is black.
static double at(const double *outputs, size_t count, size_t i)
{
    return count == 1 ? outputs[0] : i < count ? outputs[i] : 0;
}

void glintL_compare_points(lua_State *L, int index, const glintL_traced *traced)
{
    uint64_t state = 20261;
    const size_t count = glint_program_output_count(traced->program);
    const double tolerance = traced->has_power ? POWER_TOLERANCE : 0;
    glint_error error;
    for (int number = 0; number < POINTS; number++) {
        double in[GLINT_INPUT_COUNT], lua[6], program[GLINT_PROGRAM_OUTPUTS_MAX];
        make_inputs(&state, number, in);
        const size_t lua_count = glintL_run_on_numbers(L, index, in, lua);
        glintL_check_status(L, "", &error, glint_program_evaluate(traced->program, in, program, &error));
        for (size_t i = 0; i < (count > lua_count ? count : lua_count); i++) {
            const double a = at(lua, lua_count, i), b = at(program, count, i);
            if (!is_same(a, b, tolerance))
                refuse(L, index, in, a, b);
        }
    }
}
