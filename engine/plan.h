/// A frame's plan: the tables its stages read, which stages there are, and the key of each. Internal.
///
///   plan.c            puts it together; keys
///   plan_geometry.c   camera, primitives, what each light and the eye know of each primitive
///   plan_shading.c    materials and lights
///   plan_explain.c    which effects the scene calls for, and who called
#ifndef GLINT_PLAN_H
#define GLINT_PLAN_H

#include "engine/base/hash.h"
#include "engine/glint.h"
#include "engine/objects.h"
#include "engine/stages/stages.h"

/// In the order a frame runs them.
typedef enum glint_stage_id {
    GLINT_STAGE_CAMERA,
    GLINT_STAGE_CAST,
    GLINT_STAGE_SURFACE,
    GLINT_STAGE_LIGHT,
    GLINT_STAGE_OCCLUDE,
    GLINT_STAGE_SHADE,
    GLINT_STAGE_RESOLVE,
    GLINT_STAGE_TONE,
    GLINT_STAGE_COUNT
} glint_stage_id;

extern const char *const glint_stage_names[GLINT_STAGE_COUNT];

typedef struct glint_plan_camera {
    bool orthographic;
    double eye[3], forward[3]; ///< forward is unit
    double right[3], up[3]; ///< from a pixel's centre to its edge
    double pixel_offset;
} glint_plan_camera;

typedef struct glint_plan_light {
    bool directional, shadows, attenuated;
    double position[3]; ///< directional: the unit vector towards the light
    double scale; ///< see glint_light_args
    double coefficients[3];
    double diffuse[3], specular[3]; ///< colour times intensity
    int8_t *light_side; ///< per primitive, when it casts shadows; owned
    glint_key key; ///< of what `light` reads for this light; `occlude` reads the same
} glint_plan_light;

/// The cone of directions in which a sphere is seen from an origin; for culling.
typedef struct glint_cone {
    double axis[3]; ///< unit, towards the sphere
    double cosine, sine; ///< of its half angle; the origin is inside: cosine = -1
} glint_cone;

typedef struct glint_text_line {
    char effect[48];
    char caller[2 * GLINT_NAME_SIZE];
} glint_text_line;

struct glint_plan {
    glint_render_desc desc;
    glint_plan_camera camera;

    glint_prim *prims; ///< in order of definition: index + 1 is the object id
    uint32_t prim_count;
    uint32_t *prim_shape; ///< which shape of the scene each is of
    glint_bundle_prim *bundle; ///< NULL for an orthographic camera
    glint_cone *cones; ///< with bundle
    double reference[3], filter_scale;

    glint_shade_material *materials;
    uint32_t material_count, phong_end, blinn_end;
    glint_plan_light *lights;
    uint32_t light_count, shadow_count;
    double ambient[3], background[3];

    bool runs[GLINT_STAGE_COUNT];
    glint_key keys[GLINT_STAGE_COUNT];
    bool accumulate; ///< sums over samples or over chunks of lights

    glint_stage_info stage_list[GLINT_STAGE_COUNT];
    size_t stage_count;
    glint_text_line *lines;
    glint_effect *effects;
    size_t effect_count, effect_capacity;
};

/// The stages of an instruction set by name; NULL: the environment's GLINT_ISA, else the best.
glint_status glint_choose_isa(const char *isa, const glint_stages **out, glint_error *error);

void glint_plan_camera_init(glint_plan_camera *out, const glint_camera_desc *desc, const glint_render_desc *render);
/// All that a primitive's place is made of, for keys.
void glint_prim_place(const glint_prim *prim, double out[8]);
/// Fills prims, prim_shape, and with `materials` (scene order) the unsorted material index of each.
glint_status glint_plan_prims(glint_plan *plan, const glint_scene *scene, glint_list *materials, glint_error *error);
/// What rays from `origin` know of every primitive. Either output may be NULL.
void glint_plan_bundle(const glint_plan *plan, const double origin[3], glint_bundle_prim *bundle, glint_cone *cones);
glint_status glint_plan_light_sides(const glint_plan *plan, glint_plan_light *light, glint_error *error);

/// Sorts materials by highlight, renumbers the primitives' and fills the lights that give light.
glint_status glint_plan_shading(glint_plan *plan, const glint_scene *scene, const glint_list *materials,
                                glint_error *error);
/// Fills one material's row. `light_ambient` is Ia.
void glint_shade_material_init(glint_shade_material *out, const glint_material_desc *desc, const double ambient[3]);

glint_status glint_plan_explain(glint_plan *plan, const glint_scene *scene, glint_error *error);

#endif
