/// What all headers of glint share: the status of a call, and the names of the objects. glint.h includes it.
#ifndef GLINT_TYPES_H
#define GLINT_TYPES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define GLINT_NAME_SIZE 64 ///< bytes of an object's name, with the ending NUL
#define GLINT_DERIVATIVES_MAX 8 ///< most derivatives of one frame, see glint_programs.h

/// The result of a call that can fail.
typedef enum glint_status {
    GLINT_OK = 0, ///< done
    GLINT_ERR_INVALID, ///< an argument is out of its range
    GLINT_ERR_NOMEM, ///< out of memory; nothing was changed
    GLINT_ERR_IO, ///< a failure of the system: a file that cannot be opened, a short write
    GLINT_ERR_NO_SPACE, ///< disk or quota full; a later attempt may succeed
    GLINT_ERR_FORMAT, ///< a file with invalid contents
    GLINT_ERR_CANCELLED, ///< glint_renderer_cancel was called
    GLINT_ERR_UNSUPPORTED ///< this machine or build cannot do it
} glint_status;

/// Defines glint_NAME_desc_default(), which returns the description that glint_NAME_desc_init() writes.
#define GLINT_DESC_DEFAULT(name) \
    static inline glint_##name##_desc glint_##name##_desc_default(void) \
    { \
        glint_##name##_desc desc; \
        glint_##name##_desc_init(&desc, sizeof desc); \
        return desc; \
    } \
    typedef struct glint_##name##_desc glint_##name##_desc
/// The same for a description of several kinds.
#define GLINT_DESC_DEFAULT_OF(name) \
    static inline glint_##name##_desc glint_##name##_desc_default(glint_##name##_kind kind) \
    { \
        glint_##name##_desc desc; \
        glint_##name##_desc_init(&desc, sizeof desc, kind); \
        return desc; \
    } \
    typedef struct glint_##name##_desc glint_##name##_desc

/// Why a call failed. Written only on failure.
typedef struct glint_error {
    glint_status status; ///< never GLINT_OK
    char message[512]; ///< UTF-8, one line, begins with the argument's name
} glint_error;

typedef struct glint_scene glint_scene; ///< shapes, lights and overlays, with one camera
typedef struct glint_camera glint_camera; ///< where the eye is, where it looks and how wide
typedef struct glint_light glint_light; ///< a source of light
typedef struct glint_material glint_material; ///< how a surface reflects and transmits light
typedef struct glint_shape glint_shape; ///< a surface, a solid, or a group of them
typedef struct glint_program glint_program; ///< a pattern or a shader, see glint_programs.h; immutable
typedef struct glint_overlay glint_overlay; ///< a label, an arrow, a chart over the picture, see glint_figures.h
typedef struct glint_plan glint_plan; ///< the stages that one frame needs, with a snapshot of all data that they
    ///< read; immutable, any thread
typedef struct glint_renderer glint_renderer; ///< worker threads, and the cache between frames
typedef struct glint_image glint_image; ///< a rendered picture: the planes of its passes, and its pixel values;
    ///< immutable, reference counted, any thread
typedef struct glint_frame_stats glint_frame_stats; ///< times and counts of a frame, see glint_inspect.h
typedef struct glint_derivative glint_derivative; ///< of the picture with respect to a number, see glint_programs.h

#endif
