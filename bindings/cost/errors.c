// A picture against the reference, and decisions pixel by pixel: functions for the modules.
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

#define LIT 0x1p-10 // less than a quarter of an 8-bit step: a surface lit at grazing angles counts as dark

// ---- Decisions ----

// decisions(image, objects): returns whether each pixel is lit and, if asked for, the number of its object, 0 for the
// background, as two arrays.
static int decisions(lua_State *L)
{
    const glint_image *image = cost_image_at(L, 1);
    const int width = glint_image_width(image), height = glint_image_height(image);
    const size_t pixels = (size_t)width * (size_t)height;
    uint8_t *lit = lua_newuserdatauv(L, pixels, 0);
    float *objects = lua_toboolean(L, 2) ? lua_newuserdatauv(L, pixels * sizeof *objects, 0) : NULL;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            float v[3] = { 0 };
            glint_image_pixel(image, GLINT_PASS_OBJECT_ID, x, y, v, NULL);
            if (objects)
                *objects++ = v[0];
            glint_image_pixel(image, GLINT_PASS_DIFFUSE, x, y, v, NULL);
            *lit++ = v[0] > LIT || v[1] > LIT || v[2] > LIT;
        }
    return objects ? 2 : 1;
}

// differ(a, b): counts the pixels with different objects and, among the rest, those that different lights reach. Each
// list has the array of objects, then an array for each light.
static int differ(lua_State *L)
{
    const lua_Integer planes = luaL_len(L, 1);
    lua_Integer wrong_objects = 0, wrong_shadows = 0;
    lua_rawgeti(L, 1, 1);
    lua_rawgeti(L, 2, 1);
    const float *mine = lua_touserdata(L, 3), *truth = lua_touserdata(L, 4);
    const size_t pixels = lua_rawlen(L, 3) / sizeof *mine;
    uint8_t *shadows = lua_newuserdatauv(L, pixels + 1, 0);
    memset(shadows, 0, pixels + 1);
    for (lua_Integer plane = 2; plane <= planes; plane++) {
        lua_rawgeti(L, 1, plane);
        lua_rawgeti(L, 2, plane);
        const uint8_t *a = lua_touserdata(L, -2), *b = lua_touserdata(L, -1);
        for (size_t i = 0; i < pixels; i++)
            shadows[i] |= a[i] != b[i];
        lua_pop(L, 2);
    }
    for (size_t i = 0; i < pixels; i++) {
        wrong_objects += mine[i] != truth[i];
        wrong_shadows += mine[i] == truth[i] && shadows[i];
    }
    lua_pushinteger(L, wrong_objects);
    lua_pushinteger(L, wrong_shadows);
    return 2;
}

// ---- The reference ----

// reference(a, b, c, d): sets the reference to the mean of the pictures.
static int set_reference(lua_State *L)
{
    const glint_image *parts[] = { cost_image_at(L, 1), cost_image_at(L, 2), cost_image_at(L, 3), cost_image_at(L, 4) };
    cost_study *study = cost_study_of(L);
    glint_error error;
    if (glint_reference_create(parts, 4, &study->own->desc.tone, &study->reference, &error))
        return cost_fail(L, &error);
    return 0;
}

// errors(image, bits): returns the errors of the picture, or of its values in a file with so many bits; 0: no file.
static int errors(lua_State *L)
{
    glint_picture_error found;
    glint_error error;
    if (glint_reference_measure(cost_study_of(L)->reference, cost_image_at(L, 1), (int)luaL_checkinteger(L, 2), &found,
                                &error))
        return cost_fail(L, &error);
    lua_newtable(L);
    glintL_set_number(L, "rmse", found.rmse);
    glintL_set_number(L, "relmse", found.relmse);
    glintL_set_number(L, "max_code", found.max_code);
    glintL_set_number(L, "over1", found.over1);
    glintL_set_number(L, "over8", found.over8);
    glintL_set_number(L, "flip", found.flip);
    return 1;
}

// difference(image): returns 16 times the picture's difference from the reference.
static int difference(lua_State *L)
{
    const glint_image *image = cost_image_at(L, 1);
    glint_image **out = cost_push_image(L);
    glint_error error;
    return glint_reference_difference(cost_study_of(L)->reference, image, 16, out, &error) ? cost_fail(L, &error) : 1;
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
    glint_write_desc desc = { .path = "picture.png",
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

// ---- The estimate of --until ----

// partner_seed(samples): returns the seed of the partner of the frame with so many samples.
static int partner_seed(lua_State *L)
{
    glint_render_desc desc = cost_study_of(L)->own->desc;
    desc.samples = luaL_checknumber(L, 1);
    lua_pushnumber(L, glint_partner_seed(&desc));
    return 1;
}

// estimate(image, partner): returns the error of a picture as --until estimates it.
static int estimate(lua_State *L)
{
    double rmse;
    glint_error error;
    if (glint_estimate_error(cost_image_at(L, 1), cost_image_at(L, 2), &rmse, &error))
        return cost_fail(L, &error);
    lua_pushnumber(L, rmse);
    return 1;
}

const luaL_Reg cost_error_functions[] = {
    { "decisions", decisions },
    { "differ", differ },
    { "reference", set_reference },
    { "errors", errors },
    { "png", png },
    { "difference", difference },
    { "estimate", estimate },
    { "partner_seed", partner_seed },
    { NULL, NULL },
};
