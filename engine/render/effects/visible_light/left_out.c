#include "engine/render/effects/left_out.h"

static bool any_light_shows(const glint_scene *scene)
{
    double shown[3];
    bool any = false;
    for (size_t i = 0; i < scene->lights.count; i++)
        any = any || glint_light_shows(&glint_scene_light(scene, i)->desc, shown);
    return any;
}

GLINT_LEFT_OUT(visible_light, "visible_light", "light.visible", "visible lights", any_light_shows(from->scene))
