/// Light passes: the groups of lights, and those that a frame needs.
#include "engine/render/light_groups/plan.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/render/effects/visible_light/plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct glint_light_groups groups;

// ---- Names ----

static uint32_t find_pass(const groups *g, const char *name)
{
    uint32_t i = 0;
    while (i < g->pass_count && strcmp(g->name[i], name) != 0)
        i++;
    return i;
}

/// Returns whether a name is allowed in a list, in a file name and in the name of a channel.
static bool is_usable(const char *name)
{
    for (const char *at = name; *at; at++)
        if ((unsigned char)*at < ' ' || strchr(",/\\*\"", *at))
            return false;
    return name[0] != ' ' && name[0] != '.' && name[strlen(name) - 1] != ' ';
}

/// Returns whether a light of the scene has this group.
static bool is_group(const glint_scene *scene, const char *name)
{
    char own[GLINT_NAME_SIZE];
    for (size_t i = 0; i < scene->lights.count; i++) {
        glint_scene_light_pass(scene, i, own);
        if (strcmp(own, name) == 0)
            return true;
    }
    return false;
}

/// Lists the scene's groups, for messages.
static void list_groups(const glint_scene *scene, char out[320])
{
    char own[GLINT_NAME_SIZE];
    size_t used = (size_t)snprintf(out, 320, "'%s'", GLINT_LIGHT_REST);
    for (size_t i = 0; i < scene->lights.count && used < 200; i++) {
        glint_scene_light_pass(scene, i, own);
        used += (size_t)snprintf(out + used, 320 - used, ", '%s'", own);
    }
}

/// Adds a pass, once.
static glint_status add_pass(groups *g, const char *name, glint_error *error)
{
    if (find_pass(g, name) < g->pass_count)
        return GLINT_OK;
    if (!is_usable(name))
        return glint_fail(error, GLINT_ERR_INVALID,
                          "light '%s': for its light pass, expected a group or name without , / \\ * \" and control "
                          "characters, not beginning with a space or '.'",
                          name);
    if (strcmp(name, GLINT_LIGHT_REST) == 0)
        g->rest = g->pass_count;
    snprintf(g->name[g->pass_count++], GLINT_NAME_SIZE, "%s", name);
    return GLINT_OK;
}

/// Adds the passes of one entry of the list.
static glint_status add_entry(groups *g, const glint_scene *scene, const char *name, glint_error *error)
{
    char own[GLINT_NAME_SIZE], all[320];
    glint_status status = GLINT_OK;
    if (strcmp(name, "*") == 0) {
        for (size_t i = 0; i < scene->lights.count && !status; i++) {
            glint_scene_light_pass(scene, i, own);
            status = add_pass(g, own, error);
        }
        return status ? status : add_pass(g, GLINT_LIGHT_REST, error);
    }
    if (strcmp(name, GLINT_LIGHT_REST) == 0 || is_group(scene, name))
        return add_pass(g, name, error);
    list_groups(scene, all);
    return glint_fail(error, GLINT_ERR_INVALID,
                      "light_passes: no light of the scene has the group or name '%s'; the scene has %s", name, all);
}

static glint_status read_list(groups *g, const glint_scene *scene, const char *list, glint_error *error)
{
    glint_status status = GLINT_OK;
    for (const char *at = list; !status;) {
        char name[GLINT_NAME_SIZE];
        const size_t length = strcspn(at, ",");
        if (length == 0 || length >= sizeof name)
            return glint_fail(error, GLINT_ERR_INVALID, "light_passes: names of 1 .. %d bytes expected, got '%.*s'",
                              GLINT_NAME_SIZE - 1, (int)(length < 80 ? length : 80), at);
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        status = add_entry(g, scene, name, error);
        if (!at[length])
            break;
        at += length + 1;
    }
    return status;
}

// ---- Groups ----

static size_t entries_of(const char *list)
{
    size_t count = 1;
    for (; *list; list++)
        count += *list == ',';
    return count;
}

static void destroy(groups *g)
{
    if (!g)
        return;
    free(g->name);
    free(g->list);
    free(g->of_light);
    free(g->ambient);
    free(g);
}

static groups *make(size_t passes, size_t lights)
{
    groups *g = glint_alloc(1, sizeof *g);
    if (!g)
        return NULL;
    g->rest = GLINT_NO_GROUP;
    g->name = glint_alloc(passes, sizeof *g->name);
    g->list = glint_alloc(passes, sizeof *g->name);
    g->of_light = glint_alloc(lights, sizeof *g->of_light);
    g->ambient = glint_alloc(passes + 1, sizeof *g->ambient);
    if (g->name && g->list && g->of_light && g->ambient)
        return g;
    destroy(g);
    return NULL;
}

void glint_light_groups_release(glint_plan *plan) { destroy(plan->light_groups); }

static void join_names(groups *g)
{
    size_t used = 0;
    for (uint32_t i = 0; i < g->pass_count; i++)
        used += (size_t)sprintf(g->list + used, "%s%s", i ? "," : "", g->name[i]);
}

/// Adds a light's share of Ia to its group. Ia is the ambient light of the scene and of all lights; see
/// glint_plan_shading.
static void share_ambient(groups *g, const glint_plan *plan, const glint_light_desc *desc, uint32_t group)
{
    for (int c = 0; c < 3 && group != GLINT_NO_GROUP; c++)
        if (plan->ambient[c] > 0) {
            g->ambient[group][c] += desc->ambient[c] * desc->intensity / plan->ambient[c];
            g->has_ambient = g->has_ambient || g->ambient[group][c] > 0;
        }
}

/// Finds the groups of the scene's lights. Fails if no light of the scene has a group of the list.
static glint_status find_groups(glint_plan *plan, const glint_scene *scene, const char *list, glint_error *error)
{
    char own[GLINT_NAME_SIZE];
    groups *g = make(entries_of(list) + scene->lights.count + 1, scene->lights.count);
    if (!g)
        return glint_fail_nomem(error);
    plan->light_groups = g;
    for (size_t i = 0; i < scene->lights.count; i++) {
        glint_scene_light_pass(scene, i, own);
        if (strcmp(own, GLINT_LIGHT_REST) == 0)
            return glint_fail(error, GLINT_ERR_INVALID,
                              "light '%s': use another name: this one is reserved for the light pass of the light that "
                              "comes from no lamp",
                              own);
    }
    glint_status status = read_list(g, scene, list, error);
    if (status)
        return status;
    join_names(g);
    plan->desc.light_passes = g->list;
    g->count = g->pass_count;
    for (size_t i = 0; i < scene->lights.count; i++) {
        glint_scene_light_pass(scene, i, own);
        const uint32_t pass = find_pass(g, own), others = g->rest == GLINT_NO_GROUP ? GLINT_NO_GROUP : g->pass_count;
        g->of_light[i] = pass < g->pass_count ? pass : others;
        if (g->of_light[i] == g->pass_count)
            g->count = g->pass_count + 1;
        share_ambient(g, plan, &glint_scene_light(scene, i)->desc, g->of_light[i]);
    }
    return GLINT_OK;
}

glint_status glint_light_groups_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error)
{
    if (!plan->desc.light_passes)
        return GLINT_OK;
    const glint_status status = find_groups(plan, from->scene, plan->desc.light_passes, error);
    if (status)
        return status;
    const uint32_t *of_light = plan->light_groups->of_light;
    for (uint32_t i = 0; i < plan->light_count && !from->times; i++) // lights of a shutter's times have their groups
        plan->lights[i].group = of_light[plan->lights[i].source];
    glint_visible_lights *visible = plan->own[GLINT_STAGE_VISIBLE_LIGHT];
    for (uint32_t i = 0; visible && i < visible->count; i++)
        visible->of[i].group = of_light[visible->of[i].source];
    return GLINT_OK;
}

// ---- Keys ----

glint_key glint_light_groups_key(const glint_plan *plan, glint_key key)
{
    const groups *g = plan->light_groups;
    key = glint_key_add_string(key, g->list);
    for (uint32_t i = 0; i < plan->light_count; i++)
        key = glint_key_add(key, &plan->lights[i].group, sizeof plan->lights[i].group);
    const glint_visible_lights *visible = glint_visible_lights_of(plan);
    for (uint32_t i = 0; i < visible->count; i++)
        key = glint_key_add(key, &visible->of[i].group, sizeof visible->of[i].group);
    return glint_key_add(key, g->ambient, g->count * sizeof *g->ambient);
}

glint_key glint_light_pass_key(const glint_plan *plan, int number, glint_key key)
{
    const groups *g = plan->light_groups;
    const uint32_t pass = (uint32_t)(number - GLINT_PASS_LIGHT);
    if (number < GLINT_PASS_LIGHT || pass >= g->pass_count)
        return key;
    const bool rest = pass == g->rest;
    key = glint_key_add(key, &rest, sizeof rest);
    for (uint32_t i = 0; i < plan->light_count && !rest; i++) {
        const bool own = plan->lights[i].group == pass;
        key = glint_key_add(key, &own, sizeof own);
    }
    const glint_visible_lights *visible = glint_visible_lights_of(plan);
    for (uint32_t i = 0; i < visible->count && !rest; i++) {
        const bool own = visible->of[i].group == pass;
        key = glint_key_add(key, &own, sizeof own);
    }
    return rest ? key : glint_key_add(key, g->ambient[pass], sizeof g->ambient[pass]);
}

bool glint_light_groups_equal(const glint_plan *a, const glint_plan *b)
{
    const groups *g = a->light_groups, *h = b->light_groups;
    return !g == !h &&
           (!g || (strcmp(g->list, h->list) == 0 && g->count == h->count && !g->has_ambient && !h->has_ambient));
}

const char *glint_plan_light_pass(const glint_plan *plan, size_t index)
{
    if (!plan)
        return NULL;
    const groups *g = plan->light_groups;
    return g && index < g->pass_count ? g->name[index] : NULL;
}
