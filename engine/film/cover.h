/// The renderer's interface to overlays, which are drawn over a finished picture. engine/figures makes the overlays and
/// implements the functions below. Other parts do not know what the overlays show. Internal.
#ifndef GLINT_FILM_COVER_H
#define GLINT_FILM_COVER_H

#include "engine/base/hash.h"
#include "engine/glint_types.h"

#include <stdatomic.h>

#define GLINT_SIGHTS 16 ///< most points of one question of `hidden`

/// The camera of one frame. A sample at x, y of the picture has sx = 2 x - span[0], sy = span[1] - 2 y and the ray eye
/// + t (view[2] + sx view[0] + sy view[1]), for an orthographic camera eye + sx view[0] + sy view[1] + t view[2].
typedef struct glint_cover_camera {
    bool orthographic;
    double eye[3];
    double view[3][3]; ///< the vectors to the right and up, each half a pixel long, and the unit vector away from the
        ///< eye
    double span[2]; ///< see glint_plan_camera
    double pixel_offset; ///< position of the sample in its pixel, 0 .. 1
} glint_cover_camera;

/// Projects a point to the picture, in pixels from the upper left corner. Returns the point's distance along the view.
double glint_cover_project(const glint_cover_camera *camera, const double p[3], double out[2]);

/// Answers which points the camera does not see.
typedef struct glint_sights {
    /// Returns bit i if a surface hides point i. count: 1 .. GLINT_SIGHTS
    uint32_t (*hidden)(void *context, const glint_cover_camera *camera, const double (*points)[3], size_t count);
    void *context;
} glint_sights;

typedef struct glint_cover glint_cover;

/// The functions of overlays.
typedef struct glint_cover_maker {
    /// Frees an overlay.
    void (*destroy)(glint_overlay *overlay);
    /// Returns the kind of an overlay: "label", ...; its name, "" for none.
    const char *(*kind)(const glint_overlay *overlay);
    const char *(*name)(const glint_overlay *overlay);
    /// Copies the overlays of a frame, in drawing order. *out is NULL if none is visible.
    glint_status (*take)(glint_overlay *const *overlays, size_t count, int width, int height, const glint_cover_camera *camera,
                         glint_cover **out, glint_error *error);
    /// Writes the overlays with the parts that surfaces hide, as a reference of the caller's.
    glint_status (*hide)(glint_cover *cover, const glint_sights *sights, glint_cover **out, glint_error *error);
    /// Calls `warns` for what the picture cannot show. dpi: pixels per inch; 0: not given
    glint_status (*check)(const glint_cover *cover, double dpi, void (*warns)(void *context, const char *message), void *context,
                          glint_error *error);
    /// Extends a key by everything that the pixels depend on, except the codes below them and the file's dpi.
    glint_key (*key)(const glint_cover *cover, glint_key key);
    /// Frees the overlays of a frame.
    void (*free)(glint_cover *cover);
} glint_cover_maker;

/// How an overlay of a scene begins. One thread.
struct glint_overlay {
    const glint_cover_maker *maker;
    size_t references;
};

/// How the overlays of one frame begin. Immutable, reference counted; any thread.
struct glint_cover {
    const glint_cover_maker *maker;
    atomic_int references;
};

glint_cover *glint_cover_retain(glint_cover *cover); ///< NULL: no effect
void glint_cover_release(glint_cover *cover); ///< NULL: no effect

#endif
