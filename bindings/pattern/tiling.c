// glint.checker, stripe and brick: made from parity and floor; with a footprint, the mean over a box of that width.
#include "bindings/pattern/pattern.h"

static glintL_term number(double x) { return glintL_number_term(x); }

static glintL_term add(lua_State *L, glintL_term a, glintL_term b) { return glintL_apply2(L, GLINT_OP_ADD, a, b); }

static glintL_term sub(lua_State *L, glintL_term a, glintL_term b) { return glintL_apply2(L, GLINT_OP_SUB, a, b); }

static glintL_term mul(lua_State *L, glintL_term a, glintL_term b) { return glintL_apply2(L, GLINT_OP_MUL, a, b); }

static glintL_term div(lua_State *L, glintL_term a, glintL_term b) { return glintL_apply2(L, GLINT_OP_DIV, a, b); }

static glintL_term choose(lua_State *L, glintL_term width, glintL_term mean, glintL_term sharp)
{
    const glintL_term is_wide = glintL_apply2(L, GLINT_OP_LESS, number(0), width);
    return glintL_apply3(L, GLINT_OP_SELECT, is_wide, mean, sharp);
}

// Returns the mean over x - w/2 .. x + w/2 of the wave that is 1 in the first `share` of each unit and 0 in the rest:
// the difference of its integral, floor(x) share + min(fract(x), share). The whole unit of x is subtracted first, so
// that no digits are lost far from the origin. Rounding may leave 0 .. 1 slightly, so the result is clamped.
static glintL_term mean_of_wave(lua_State *L, glintL_term x, glintL_term share, glintL_term width)
{
    const glintL_term position = glintL_apply1(L, GLINT_OP_FRACT, x), half = mul(L, number(0.5), width);
    glintL_term integral[2];
    for (int end = 0; end < 2; end++) {
        const glintL_term at = end ? add(L, position, half) : sub(L, position, half);
        const glintL_term part = glintL_apply2(L, GLINT_OP_MIN, glintL_apply1(L, GLINT_OP_FRACT, at), share);
        integral[end] = add(L, mul(L, glintL_apply1(L, GLINT_OP_FLOOR, at), share), part);
    }
    const glintL_term mean = div(L, sub(L, integral[1], integral[0]), width);
    return glintL_apply3(L, GLINT_OP_CLAMP, mean, number(0), number(1));
}

// Integrates the wave that is 1 in every even unit and -1 in every odd one.
static glintL_term mean_sign(lua_State *L, glintL_term x, glintL_term width)
{
    const glintL_term half = mul(L, number(0.5), x), narrow = mul(L, number(0.5), width);
    const glintL_term mean = mean_of_wave(L, half, number(0.5), narrow);
    return sub(L, mul(L, number(2), mean), number(1));
}

static glintL_term parity_of(lua_State *L, glintL_term x, glintL_term y, glintL_term z)
{
    glintL_term parity;
    glintL_apply(L, GLINT_OP_PARITY, (const glintL_term[3]) { x, y, z }, &parity);
    return parity;
}

// Returns the sign of one component of a checker, or its mean with a footprint. Whole numbers are not averaged: x is
// then the plane of the surface, such as y = 0 for a floor, and the mean would mix both sides.
static glintL_term sign_of(lua_State *L, glintL_term x, glintL_term width)
{
    const glintL_term odd = parity_of(L, x, number(0), number(0));
    const glintL_term sharp = sub(L, number(1), mul(L, number(2), odd));
    const glintL_term is_whole = glintL_apply2(L, GLINT_OP_EQUAL, glintL_apply1(L, GLINT_OP_FLOOR, x), x);
    const glintL_term mean = glintL_apply3(L, GLINT_OP_SELECT, is_whole, sharp, mean_sign(L, x, width));
    return choose(L, width, mean, sharp);
}

// Returns the parity of the unit cube: 0 or 1. Its mean is (1 - product of the signs' means) / 2.
static int checker(lua_State *L)
{
    glintL_term p[3];
    glintL_operand width;
    const int end = glintL_read_position(L, 1, "checker", p);
    if (lua_gettop(L) > end)
        return glintL_error(L, "checker: a vector and a footprint expected, got more");
    if (lua_isnoneornil(L, end)) {
        glintL_push_choice(L, parity_of(L, p[0], p[1], p[2]));
        return 1;
    }
    glintL_read_operand(L, end, "checker: footprint", &width);
    glintL_term product = sign_of(L, p[0], width.at[0]);
    for (int i = 1; i < 3; i++)
        product = mul(L, product, sign_of(L, p[i], width.at[i]));
    glintL_push_term(L, mul(L, number(0.5), sub(L, number(1), product)));
    return 1;
}

// Returns the parity of floor(x): 0 or 1.
static int stripe(lua_State *L)
{
    const glintL_term x = glintL_read_term(L, 1, "stripe");
    glintL_term parity = parity_of(L, x, number(0), number(0));
    if (lua_gettop(L) > 2)
        return glintL_error(L, "stripe: a number and a footprint expected, got more");
    if (!lua_isnoneornil(L, 2)) {
        const glintL_term width = glintL_read_term(L, 2, "stripe: footprint");
        const glintL_term mean = mul(L, number(0.5), sub(L, number(1), mean_sign(L, x, width)));
        parity = choose(L, width, mean, parity);
    }
    glintL_push_choice(L, parity);
    return 1;
}

// Returns 1 in the first `share` of each unit.
static glintL_term band(lua_State *L, glintL_term x, glintL_term share)
{
    return glintL_apply2(L, GLINT_OP_LESS, glintL_apply1(L, GLINT_OP_FRACT, x), share);
}

// Returns 1 on a brick and 0 on mortar. Bricks are one by one unit in x and y, with every other row shifted by half a
// brick. Mortar is `mortar` wide along the left and lower side of each brick.
static int brick(lua_State *L)
{
    glintL_term p[3], mortar = number(0.1);
    glintL_read_position(L, 1, "brick", p);
    if (!lua_istable(L, 1) && !glintL_to_vector(L, 1))
        return glintL_error(L, "brick: a vector expected as the first argument: brick(p, mortar, footprint)");
    if (lua_gettop(L) > 3)
        return glintL_error(L, "brick: expected a vector, the mortar's width and a footprint, got more");
    if (!lua_isnoneornil(L, 2))
        mortar = glintL_read_term(L, 2, "brick: mortar");
    const glintL_term odd = parity_of(L, p[1], number(0), number(0));
    const glintL_term x = sub(L, add(L, p[0], mul(L, number(0.5), odd)), mortar), y = sub(L, p[1], mortar);
    const glintL_term share = sub(L, number(1), mortar);
    glintL_term inside = mul(L, band(L, x, share), band(L, y, share));
    if (!lua_isnoneornil(L, 3)) {
        const glintL_term width = glintL_read_term(L, 3, "brick: footprint");
        const glintL_term mean = mul(L, mean_of_wave(L, x, share, width), mean_of_wave(L, y, share, width));
        inside = choose(L, width, mean, inside);
    }
    glintL_push_choice(L, inside);
    return 1;
}

void glintL_open_tiling(lua_State *L)
{
    static const luaL_Reg functions[] = {
        { "checker", checker },
        { "stripe", stripe },
        { "brick", brick },
        { NULL, NULL },
    };
    luaL_setfuncs(L, functions, 0);
}
