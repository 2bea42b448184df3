#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(shutter, "shutter", "camera.shutter", "shutter", from->times)

void glint_shutter_desc(glint_render_desc *desc) { (void)desc; }

glint_status glint_plan_create_exposed(const glint_scene *scene, const glint_render_desc *desc, glint_plan **times,
                                       size_t count, glint_plan **out, glint_error *error)
{
    (void)scene, (void)desc, (void)times, (void)count, (void)out;
    return GLINT_FAIL_LEFT_OUT(error, "shutter", "camera.shutter", "shutter");
}
