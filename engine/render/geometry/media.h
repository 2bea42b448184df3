/// The media that contain a ray: transparent materials that it has entered and not yet left. Internal.
#ifndef GLINT_MEDIA_H
#define GLINT_MEDIA_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define GLINT_MEDIA_MAX 8 ///< most nested media; with more, the outermost are dropped
#define GLINT_NO_MEDIUM 0xffffffffu

typedef struct glint_media {
    uint32_t count;
    uint32_t material[GLINT_MEDIA_MAX]; ///< the innermost last
} glint_media;

static inline uint32_t glint_media_top(const glint_media *media)
{
    return media->count ? media->material[media->count - 1] : GLINT_NO_MEDIUM;
}

static inline bool glint_media_has(const glint_media *media, uint32_t material)
{
    for (uint32_t i = 0; i < media->count; i++)
        if (media->material[i] == material)
            return true;
    return false;
}

static inline void glint_media_enter(glint_media *media, uint32_t material)
{
    if (media->count == GLINT_MEDIA_MAX)
        memmove(media->material, media->material + 1, --media->count * sizeof *media->material);
    media->material[media->count++] = material;
}

/// Leaves the innermost object of the material; does nothing if there is none.
static inline void glint_media_leave(glint_media *media, uint32_t material)
{
    uint32_t i = media->count;
    while (i > 0 && media->material[i - 1] != material)
        i--;
    if (i == 0)
        return;
    memmove(media->material + i - 1, media->material + i, (media->count - i) * sizeof *media->material);
    media->count--;
}

/// Returns the medium of a path just before a surface. If the path hits an object from inside without having entered
/// it, this is the object's own material.
static inline uint32_t glint_media_before(const glint_media *media, uint32_t material, bool back)
{
    return back && !glint_media_has(media, material) ? material : glint_media_top(media);
}

/// Crosses a surface.
static inline void glint_media_cross(glint_media *media, uint32_t material, bool back)
{
    if (back)
        glint_media_leave(media, material);
    else
        glint_media_enter(media, material);
}

#endif
