// A picture against the reference: functions for the modules.
#include <stdlib.h>

#include "bindings/cost/cost.h"

#define REFERENCE_PARTS 4

// reference(slot, image, ...): sets reference 0, the truth, or 1, the script's own setting, to the mean of the pictures.
static int set_reference(lua_State *L)
{
    const glint_image *parts[REFERENCE_PARTS];
    cost_study *study = cost_study_of(L);
    glint_reference **out = &study->references[lua_toboolean(L, 1)];
    size_t count = 0;
    glint_error error;
    while (count < REFERENCE_PARTS && count + 1 < (size_t)lua_gettop(L)) {
        parts[count] = cost_image_at(L, (int)count + 2);
        count++;
    }
    glint_reference_destroy(*out);
    *out = NULL;
    return glint_reference_create(parts, count, &study->own->desc.tone, out, &error) ? cost_fail(L, &error) : 0;
}

// errors(image, bits, slot): returns the errors of the picture against a reference, or of its values in a file with so
// many bits; 0: no file.
static int errors(lua_State *L)
{
    glint_picture_error found;
    glint_error error;
    if (glint_reference_measure(cost_study_of(L)->references[lua_toboolean(L, 3)], cost_image_at(L, 1),
                                (int)luaL_checkinteger(L, 2), &found, &error))
        return cost_fail(L, &error);
    const double values[] = { found.rmse, found.relmse, found.max_code, found.over1, found.over8, found.flip };
    static const char *const NAMES[] = { "rmse", "relmse", "max_code", "over1", "over8", "flip" };
    lua_newtable(L);
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++)
        glintL_set_number(L, NAMES[i], values[i]);
    return 1;
}

// distance(a, b): returns the mean squared difference of two pictures; b nil: of a picture and the reference.
static int distance(lua_State *L)
{
    const bool is_alone = lua_isnoneornil(L, 2);
    double rmse;
    glint_error error;
    if (glint_estimate_error(cost_image_at(L, 1),
                             is_alone ? glint_reference_image(cost_study_of(L)->references[0]) : cost_image_at(L, 2),
                             NULL, &rmse, &error))
        return cost_fail(L, &error);
    lua_pushnumber(L, rmse * rmse);
    return 1;
}

// difference(image): returns 16 times the picture's difference from the reference.
static int difference(lua_State *L)
{
    const glint_image *image = cost_image_at(L, 1);
    glint_image **out = cost_push_image(L);
    glint_error error;
    return glint_reference_difference(cost_study_of(L)->references[0], image, 16, out, &error) ? cost_fail(L, &error) : 1;
}

static int drop_bytes(lua_State *L)
{
    uint8_t **bytes = lua_touserdata(L, 1);
    free(*bytes);
    *bytes = NULL;
    return 0;
}

// png(image): returns the bytes of an 8-bit PNG.
static int png(lua_State *L)
{
    const glint_image *image = cost_image_at(L, 1);
    glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .path = "picture.png",
                              .tone = cost_study_of(L)->own->desc.tone,
                              .encode = GLINT_ENCODE_SMALL };
    uint8_t **bytes = glintL_push_owner(L, sizeof *bytes, "cost.bytes", drop_bytes);
    size_t size;
    glint_error error;
    desc.tone.bits = 8;
    if (glint_image_to_bytes(image, &desc, bytes, &size, &error))
        return cost_fail(L, &error);
    lua_pushlstring(L, (const char *)*bytes, size);
    free(*bytes);
    *bytes = NULL;
    return 1;
}

const luaL_Reg cost_error_functions[] = {
    { "reference", set_reference },
    { "errors", errors },
    { "png", png },
    { "difference", difference },
    { "distance", distance },
    { NULL, NULL },
};
