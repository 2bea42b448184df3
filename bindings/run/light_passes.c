// Passes light:NAME: their list in a frame's description, and the check that the scene has those lights.
#include <stdlib.h>
#include <string.h>

#include "bindings/run/run.h"

void glintL_render_point(glintL_render *render)
{
    render->desc.light_passes = *render->light_passes ? render->light_passes : NULL;
}

bool glintL_add_light_pass(glintL_render *to, const char *name)
{
    const size_t used = strlen(to->light_passes), length = strlen(name);
    if (length == 0 || length >= GLINT_NAME_SIZE || used + length + 2 > sizeof to->light_passes)
        return false;
    snprintf(to->light_passes + used, sizeof to->light_passes - used, "%s%s", used ? "," : "", name);
    return true;
}

// Copies the next name of a list; returns the rest of the list, NULL at the end.
static const char *next_name(const char *at, char name[GLINT_NAME_SIZE])
{
    const size_t length = strcspn(at, ",");
    snprintf(name, GLINT_NAME_SIZE, "%.*s", (int)length, at);
    return at[length] ? at + length + 1 : NULL;
}

bool glintL_light_pass_at(const char *list, size_t index, char name[GLINT_NAME_SIZE])
{
    for (; list && index > 0; index--)
        list = strchr(list, ',') ? strchr(list, ',') + 1 : NULL;
    if (list)
        next_name(list, name);
    return list;
}

// Returns whether the scene has a light pass of this name; otherwise `near` is the most similar name, or "".
static bool has_pass(const glint_scene *scene, const char *name, char near[GLINT_NAME_SIZE])
{
    char own[GLINT_NAME_SIZE];
    const char *best = glintL_nearer(name, NULL, "ambient");
    if (strcmp(name, "*") == 0 || strcmp(name, "ambient") == 0)
        return true;
    snprintf(near, GLINT_NAME_SIZE, "%s", best ? best : "");
    for (size_t i = 0; i < glint_scene_light_count(scene); i++) {
        glint_scene_light_pass(scene, i, own);
        if (strcmp(own, name) == 0)
            return true;
        if (glintL_nearer(name, *near ? near : NULL, own) == own)
            snprintf(near, GLINT_NAME_SIZE, "%s", own);
    }
    return false;
}

glint_status glintL_check_light_passes(const glint_scene *scene, const glintL_render *render, glint_error *error)
{
    char name[GLINT_NAME_SIZE], near[GLINT_NAME_SIZE];
    for (const char *at = *render->light_passes ? render->light_passes : NULL; at;) {
        at = next_name(at, name);
        if (has_pass(scene, name, near))
            continue;
        if (!*near) // the engine's message lists the passes
            return GLINT_OK;
        error->status = GLINT_ERR_INVALID;
        snprintf(error->message, sizeof error->message,
                 "passes: light:%s: the scene has no light of that group or name; did you mean 'light:%s'?", name,
                 near);
        return error->status;
    }
    return GLINT_OK;
}
