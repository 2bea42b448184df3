#include "engine/render/effects/environment/plan.h"
#include "engine/render/effects/environment/sky.h"
#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(environment, "environment", "scene.background", "pattern or texture as the background",
               from->scene->desc.background_program)

glint_status glint_sky_find(glint_plan *plan, glint_error *error)
{
    (void)plan, (void)error;
    return GLINT_OK;
}

void glint_sky_draw(const glint_sky *sky, const double u[2], double direction[3])
{
    (void)sky, (void)u, (void)direction;
}

double glint_sky_density(const glint_sky *sky, const double direction[3])
{
    (void)sky, (void)direction;
    return 0;
}
