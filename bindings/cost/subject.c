// The numbers of a study's scene by which knobs decide whether they change anything.
#include "bindings/cost/cost.h"

// Returns whether caps apply: all shapes are spheres and planes, and opaque.
static bool takes_caps(const cost_scene *scene)
{
    bool takes = true;
    for (size_t i = 0; i < scene->material_count; i++)
        for (int c = 0; c < 3; c++)
            takes = takes && glint_material_get(scene->materials[i])->transmission[c] == 0;
    for (size_t i = 0; i < glint_scene_shape_count(scene->scene); i++)
        takes = takes && glint_shape_get(glint_scene_shape_at(scene->scene, i))->kind <= GLINT_SHAPE_SPHERES;
    return takes;
}

// Returns whether a material reflects or refracts rays.
static bool has_bounce(const cost_scene *scene)
{
    bool has = false;
    for (size_t i = 0; i < scene->material_count; i++) {
        const glint_material_desc *m = glint_material_get(scene->materials[i]);
        for (int c = 0; c < 3; c++)
            has = has || m->transmission[c] > 0 || (m->has_mirror ? m->mirror[c] > 0 : m->fresnel);
    }
    return has;
}

static void add_plan(lua_State *L, const glint_plan *plan)
{
    const glint_stage_info *stages;
    const glint_effect *effects;
    size_t count = glint_plan_stages(plan, &stages);
    lua_newtable(L);
    for (size_t i = 0; i < count; i++)
        glintL_set_flag(L, stages[i].name, true);
    lua_setfield(L, -2, "stages");
    count = glint_plan_effects(plan, &effects);
    lua_newtable(L);
    for (size_t i = 0; i < count; i++)
        glintL_set_flag(L, effects[i].effect, true);
    lua_setfield(L, -2, "effects");
}

static void add_lights(lua_State *L, const cost_scene *scene)
{
    static const char *const SHADOWS[] = {
        [GLINT_SHADOW_RAYS] = "soft", [GLINT_SHADOW_HARD] = "hard", [GLINT_SHADOW_CAPS] = "caps"
    };
    lua_newtable(L);
    for (size_t i = 0; i < scene->light_count; i++) {
        const glint_light_desc *light = glint_light_get(scene->lights[i]);
        lua_newtable(L);
        glintL_set_flag(L, "is_soft", cost_is_soft(light));
        glintL_set_flag(L, "is_sphere", light->kind == GLINT_LIGHT_SPHERE);
        glintL_set_text(L, "shadow", SHADOWS[light->shadow]);
        glintL_set_number(L, "samples", light->samples);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "lights");
}

static void add_meshes(lua_State *L, const cost_scene *scene)
{
    const cost_meshes meshes = cost_scene_meshes(scene);
    if (meshes.count > 0)
        glintL_set_text(L, "shading", meshes.is_mixed ? "mixed" : cost_shading_words[meshes.shading]);
    glintL_set_whole(L, "globes", (lua_Integer)meshes.globe_count);
    glintL_set_number(L, "segments", meshes.segments);
}

static void add_moments(lua_State *L, const cost_moments *moments)
{
    double counts[COST_VALUES_MAX];
    const int count = cost_moments_counts(moments, counts);
    lua_newtable(L);
    for (int i = 0; i < count; i++) {
        lua_pushnumber(L, counts[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "moments");
    glintL_set_text(L, "lack", cost_moments_lack(moments));
}

void cost_add_subject(lua_State *L, const cost_study *study)
{
    static const char *const FIELDS[] = { "width",     "height",    "samples", "seed",  "adaptive",
                                          "precision", "max_depth", "clamp", "bits", "encode" };
    const glint_scene_desc *desc = glint_scene_get(study->scene.original);
    for (size_t i = 0; i < sizeof FIELDS / sizeof *FIELDS; i++) {
        glintL_render_push(L, glintL_render_find(FIELDS[i]), study->own);
        lua_setfield(L, -2, FIELDS[i]);
    }
    for (int i = 0; i < COST_SCENE_NUMBERS; i++)
        glintL_set_number(L, cost_scene_numbers[i].name,
                          (double)*(const int64_t *)((const char *)desc + cost_scene_numbers[i].at));
    glintL_set_flag(L, "has_indirect", desc->has_indirect);
    glintL_set_flag(L, "has_ambient_occlusion", desc->has_ambient_occlusion);
    glintL_set_flag(L, "has_bounce", has_bounce(&study->scene));
    glintL_set_flag(L, "takes_caps", takes_caps(&study->scene));
    glintL_set_flag(L, "has_neighbour", study->run->retained_neighbour != NULL);
    glintL_set_flag(L, "is_pfm", glintL_name_is_linear(study->own->output));
    add_plan(L, study->run->explain_plan);
    add_lights(L, &study->scene);
    add_meshes(L, &study->scene);
    add_moments(L, study->moments);
}
