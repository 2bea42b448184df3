#include "engine/film/cover.h"

#include "engine/base/vec.h"
#include "engine/glint.h"

double glint_cover_project(const glint_cover_camera *camera, const double p[3], double out[2])
{
    double d[3], s[2];
    vec_sub(d, p, camera->eye);
    const double depth = vec_dot(d, camera->view[2]), shift = 0.5 - camera->pixel_offset;
    for (int i = 0; i < 2; i++)
        s[i] = vec_dot(d, camera->view[i]) / vec_dot(camera->view[i], camera->view[i]) / (camera->orthographic ? 1 : depth);
    out[0] = (camera->span[0] + s[0]) / 2 + shift;
    out[1] = (camera->span[1] - s[1]) / 2 + shift;
    return depth;
}

glint_overlay *glint_overlay_retain(glint_overlay *overlay)
{
    if (overlay)
        overlay->references++;
    return overlay;
}

void glint_overlay_release(glint_overlay *overlay)
{
    if (overlay && --overlay->references == 0)
        overlay->maker->destroy(overlay);
}

glint_cover *glint_cover_retain(glint_cover *cover)
{
    if (cover)
        atomic_fetch_add_explicit(&cover->references, 1, memory_order_relaxed);
    return cover;
}

void glint_cover_release(glint_cover *cover)
{
    if (cover && atomic_fetch_sub_explicit(&cover->references, 1, memory_order_acq_rel) == 1)
        cover->maker->free(cover);
}
