// The values that a setting gives to knobs: read from Lua, and applied to the render options and the scene.
#include <stddef.h>
#include <string.h>

#include "bindings/cost/cost.h"

enum { SHADOWS_OFF, SHADOWS_HARD, SHADOWS_SOFT, SHADOWS_CAPS };
static const char *const SHADOWS[] = { "off", "hard", "soft", "caps", NULL };
const char *const cost_shading_words[] = { [GLINT_SHADING_FACETED] = "faceted",
                                           [GLINT_SHADING_PHONG] = "phong",
                                           [GLINT_SHADING_FLAT] = "flat",
                                           [GLINT_SHADING_GOURAUD] = "gouraud",
                                           NULL };
enum { MODEL_PHONG, MODEL_BLINN_PHONG, MODEL_MATCHED };
static const char *const MODELS[] = { "phong", "blinn_phong", "matched_blinn_phong", NULL };

#define NUMBER(name) \
    { \
#name, offsetof(glint_scene_desc, name) \
    }
const struct cost_scene_number cost_scene_numbers[COST_SCENE_NUMBERS] = {
    NUMBER(indirect_samples), NUMBER(indirect_bounces), NUMBER(ambient_occlusion_samples), NUMBER(reflection_samples)
};

// ---- Reading ----

static double number_at(lua_State *L, const char *name, double otherwise)
{
    const double value = lua_getfield(L, 1, name) == LUA_TNIL ? otherwise : lua_tonumber(L, -1);
    lua_pop(L, 1);
    return value;
}

// Returns the index of the word; -1: as in the script.
static int word_at(lua_State *L, const char *name, const char *const *words)
{
    const int index = lua_getfield(L, 1, name) == LUA_TNIL ? -1 : luaL_checkoption(L, -1, NULL, words);
    lua_pop(L, 1);
    return index;
}

static void read_render(lua_State *L, glintL_render *render)
{
    static const char *const FIELDS[] = { "samples", "adaptive", "precision", "max_depth", "clamp", "bits", "encode" };
    for (size_t i = 0; i < sizeof FIELDS / sizeof *FIELDS; i++) {
        if (lua_getfield(L, 1, FIELDS[i]) != LUA_TNIL)
            glintL_render_read(L, -1, "", glintL_render_find(FIELDS[i]), render);
        lua_pop(L, 1);
    }
}

static void read_shot(lua_State *L, const cost_study *study, cost_setting *out)
{
    enum { AS_FILE, AS_BOTH };
    static const char *const SHOTS[] = { "file", "both", "beauty", NULL };
    glint_render_desc *desc = &out->render.desc;
    const int shot = luaL_checkoption(L, 2, "file", SHOTS);
    desc->codes = shot <= AS_BOTH && !glintL_name_is_linear(study->own->output);
    desc->passes = shot == AS_FILE && desc->codes ? 0 : 1u << GLINT_PASS_BEAUTY;
    desc->samples = luaL_optinteger(L, 3, desc->samples);
    desc->seed = luaL_optinteger(L, 4, desc->seed);
    if (lua_toboolean(L, 5)) {
        desc->adaptive = 0;
        desc->rays = 0;
        desc->precision = GLINT_PRECISION_DOUBLE;
    }
}

void cost_setting_read(lua_State *L, const cost_study *study, cost_setting *out)
{
    static const char *const SWITCH[] = { "off", "on", NULL };
    double counts[COST_VALUES_MAX] = { 0 };
    cost_moments_counts(study->moments, counts);
    out->render = *study->own;
    read_render(L, &out->render);
    out->shutter_times = (int)number_at(L, "shutter_times", counts[0]);
    out->reuses = word_at(L, "reuse", SWITCH) == 1;
    out->shadows = word_at(L, "shadows", SHADOWS);
    out->model = word_at(L, "model", MODELS);
    out->shading = word_at(L, "shading", cost_shading_words);
    out->light_samples = (int64_t)number_at(L, "light_samples", -1);
    out->segments = (int64_t)number_at(L, "segments", -1); // "exact" is 0
    for (int i = 0; i < COST_SCENE_NUMBERS; i++)
        out->numbers[i] = (int64_t)number_at(L, cost_scene_numbers[i].name, -1);
    read_shot(L, study, out);
}

// ---- Applying ----

bool cost_is_soft(const glint_light_desc *light)
{
    const bool has_radius = light->kind == GLINT_LIGHT_DISK || light->kind == GLINT_LIGHT_SPHERE;
    return light->shadows && (light->kind == GLINT_LIGHT_POLYGON || (has_radius && light->radius > 0));
}

static glint_status edit_light(const cost_setting *setting, glint_light *light, glint_error *error)
{
    glint_light_desc desc = *glint_light_get(light);
    desc.struct_size = sizeof desc;
    const bool is_soft = cost_is_soft(&desc), is_sphere = desc.kind == GLINT_LIGHT_SPHERE;
    desc.shadows = desc.shadows && setting->shadows != SHADOWS_OFF;
    if (is_soft && setting->shadows == SHADOWS_HARD)
        desc.shadow = GLINT_SHADOW_HARD;
    else if (is_soft && setting->shadows >= SHADOWS_SOFT)
        desc.shadow = setting->shadows == SHADOWS_CAPS && is_sphere ? GLINT_SHADOW_CAPS : GLINT_SHADOW_RAYS;
    if (is_soft && setting->light_samples > 0)
        desc.samples = setting->light_samples;
    return glint_light_set(light, &desc, error);
}

static glint_status edit_material(const cost_setting *setting, glint_material *material, glint_error *error)
{
    glint_material_desc desc = *glint_material_get(material);
    desc.struct_size = sizeof desc;
    if (desc.model != GLINT_MODEL_PHONG && desc.model != GLINT_MODEL_BLINN_PHONG)
        return GLINT_OK;
    if (setting->model == MODEL_MATCHED && desc.model == GLINT_MODEL_PHONG)
        desc.shininess *= 4;
    desc.model = setting->model == MODEL_PHONG ? GLINT_MODEL_PHONG : GLINT_MODEL_BLINN_PHONG;
    return glint_material_set(material, &desc, error);
}

static glint_status edit_scene(const cost_setting *setting, glint_scene *scene, glint_error *error)
{
    glint_scene_desc desc = *glint_scene_get(scene);
    desc.struct_size = sizeof desc;
    for (int i = 0; i < COST_SCENE_NUMBERS; i++)
        if (setting->numbers[i] >= 0)
            memcpy((char *)&desc + cost_scene_numbers[i].at, &setting->numbers[i], sizeof setting->numbers[i]);
    return glint_scene_set(scene, &desc, error);
}

glint_status cost_setting_apply(const cost_setting *setting, cost_scene *scene, glint_error *error)
{
    const bool edits_lights = setting->shadows >= 0 || setting->light_samples > 0;
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < scene->light_count && edits_lights && !status; i++)
        status = edit_light(setting, scene->lights[i], error);
    for (size_t i = 0; i < scene->material_count && setting->model >= 0 && !status; i++)
        status = edit_material(setting, scene->materials[i], error);
    if (!status && setting->segments >= 0)
        status = cost_scene_set_segments(scene, setting->segments, error);
    if (!status && setting->shading >= 0)
        status = cost_scene_set_shading(scene, (glint_shading)setting->shading, error);
    return status ? status : edit_scene(setting, scene->scene, error);
}
