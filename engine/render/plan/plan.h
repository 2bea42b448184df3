/// A frame's plan: the tables that its stages read, the list of stages, and the key of each. Internal.
///
///   plan.c            assembles the plan
///   plan/stage.h      the declaration of a stage; core.c declares the core's stages, effects/*/ the others
///   plan/keys.c       hashes of the data that each stage reads
///   geometry.c        the primitives, shared by the plans of one scene
///   plan/camera.c     the view
///   plan/lens.c       where samples cross the camera's lens
///   plan/shading.c    materials and lights
///   plan/eye.c        the objects that contain the eye
///   plan/explain.c    the effects that the scene needs, and the objects that need them
///   effects/*/plan.c  an effect's part
#ifndef GLINT_PLAN_H
#define GLINT_PLAN_H

#include "engine/film/cover.h"
#include "engine/glint_inspect.h"
#include "engine/render/effects/derivative/plan.h"
#include "engine/render/effects/indirect/plan.h"
#include "engine/render/pattern/plan.h"
#include "engine/render/plan/translucent.h"
#include "engine/render/geometry/geometry.h"
#include "engine/render/geometry/media.h"
#include "engine/render/plan/stage.h"

typedef struct glint_plan_camera {
    bool orthographic;
    double eye[3], forward[3]; ///< forward is unit
    double right[3], up[3]; ///< from a pixel's centre to its edge
    /// Twice the distance from the picture's left and upper edges to the point where `forward` is seen, pixels
    double span[2];
    double pixel_offset;
    double aperture, focus; ///< radius of the lens; focus distance. With aperture 0 there is no lens, and the
        ///< following fields are not read
    uint32_t blades; ///< number of blades of the aperture; 0: the aperture is round
    double blade_rotation;
} glint_plan_camera;

/// The points where the rays of one sample cross the lens, by the lane of their pixel: offsets to the right and up,
/// in world units.
typedef struct glint_lens_points {
    double at[2][GLINT_GROUP];
} glint_lens_points;

/// A light, or one sample of an area light.
typedef struct glint_plan_light {
    bool directional, shadows, attenuated;
    bool joined; ///< whether this is another sample of the same area light as the light before it
    /// whether the stage `light` needs only another position than for the previous light. Neither light has samples or a
    /// cone
    bool same_but_position;
    bool is_spot;
    glint_spot spot;
    uint32_t source; ///< index of the described light in the scene
    uint32_t group; ///< in frames with light passes: its group, see light_groups/plan.h
    /// area light: its sample sets, one after another; otherwise NULL
    const glint_light_sample *light_samples;
    const glint_light_sample *cap; ///< if its shadows are computed with caps: describes the whole light; otherwise NULL
    bool hard; ///< area light: all samples share one shadow ray to `position`, the light's centre
    bool radiant_cap; ///< whether the light is as strong inside its radius as on its surface
    uint32_t sample_set_count; ///< number of sample sets; the samples of a pixel use the sets in turn
    double position[3]; ///< directional light: the unit vector towards the light; area light: only read if `hard`
    double scale; ///< see glint_light_args
    double coefficients[3];
    double diffuse[3], specular[3]; ///< colour times intensity
    glint_key key; ///< hash of the data that `light` and `occlude` read for this light
    glint_key position_key, color_key; ///< hash of `key` and of whether the light casts shadows; hash of
        ///< `position_key` and the colours
} glint_plan_light;

/// Upper bound of the plan's light and colours. Such values are white in any picture, and their products stay finite.
#define GLINT_STRENGTH_MAX 1e150

typedef struct glint_text_line {
    char effect[48];
    char caller[2 * GLINT_NAME_SIZE];
} glint_text_line;

/// What a plan is made from.
typedef struct glint_plan_input {
    const glint_scene *scene;
    const glint_render_desc *desc;
    struct glint_plan *const *times; ///< the plans of the shutter's times, whose lights the frame uses; NULL: its own lights
    uint32_t shutter_times; ///< number of times of the frame, or 0
} glint_plan_input;

struct glint_plan {
    glint_render_desc desc;
    uint32_t shutter_times; ///< the frame's light is the mean over this number of times; 0: one instant
    /// These times, each rendered separately, owned; NULL: only lights differ, and `lights` has them
    struct glint_plan **times;
    bool is_base; ///< whether this plan is the `base` of another plan
    struct glint_plan *base; ///< adaptive sampling: the plan of the picture with one sample per pixel, which is
        ///< examined; NULL: off
    glint_plan_camera camera;
    glint_lens_points *lens; ///< lens points of each sample; NULL: the camera has no lens

    glint_geometry *geometry;
    glint_translucent *translucent; ///< one per material of the geometry; NULL: none is translucent
    glint_shade_material *materials; ///< one per material, in the order of the geometry
    uint32_t material_count;
    glint_plan_patterns *patterns; ///< the programs of materials; NULL: there are none
    bool highlights; ///< whether some material and some light make a highlight of one of the two kinds below
    bool powers, facets; ///< whether there are highlights of Phong and Blinn-Phong; of microfacets
    glint_plan_light *lights;
    glint_light_sample *light_samples; ///< samples of all area lights
    bool caps; ///< whether shapes and materials allow shadows by caps
    uint32_t light_count, shadow_count; ///< number of rows in `lights`; number of these rows that cast shadows
    uint32_t spared_count; ///< number of rows that cast shadows but need no shadow rays of their own
    double ambient[3], background[3]; ///< ambient light; background colour, 0 if there is an environment
    struct glint_plan_environment *environment; ///< NULL: the background is plain
    const struct glint_sky *sky; ///< the background's bright parts, for sampling; NULL: none, or not needed. A reference
    struct {
        bool on;
        uint32_t material; ///< the innermost medium
        double absorption[3];
    } eye_medium; ///< the medium that contains the eye; `on`: it absorbs light

    glint_plan_derivatives *derivatives; ///< NULL: none is requested
    struct glint_light_groups *light_groups; ///< NULL: no light pass is requested

    struct glint_bounce_material *bouncing; ///< one per material; NULL: none needs secondary rays
    bool mirrors, transmits, clears, absorbs; ///< whether some material has a mirror, transmits, is translucent;
        ///< absorbs: transmits and absorbs light
    bool sharp; ///< whether some material is a smooth mirror or smooth glass
    uint32_t rough_samples; ///< rays that a rough surface reflects or refracts for each sample; 0: no surface does
    glint_plan_indirect indirect;
    glint_media eye_media; ///< the media that contain the eye of a perspective camera
    bool tints; ///< whether some light casts shadows and some material transmits or is translucent, so that shadows
        ///< may be tinted
    bool absorbs_transmitted; ///< whether, in addition, some material absorbs transmitted light
    double brightest; ///< upper bound of the light along any ray; may be infinite

    glint_cover *cover; ///< overlays, drawn over the finished picture; NULL: none

    bool runs[GLINT_STAGE_COUNT];
    void *own[GLINT_STAGE_COUNT]; ///< what only this stage reads, see glint_stage; owned
    glint_stage_set steps[GLINT_TIME_COUNT]; ///< for each time of the walk, the stages that have a step then, one bit each
    glint_stage_set limits, admits, singles; ///< the stages that have the functions `limit`, `admit` and `singles`, one bit each
    glint_stage_set before_shade, after_shade; ///< those that have these functions
    bool reads_normals; ///< whether some stage is likely to read normals
    glint_key where; ///< hash of the geometry's positions
    glint_key keys[GLINT_STAGE_COUNT];
    glint_key *material_keys, *matte_keys; ///< keys of each material, and of only the fields that are read where a
        ///< material has no highlight
    glint_key all_materials_key, all_lights_key, background_key;
    glint_key vertex_key; ///< key of everything that the light of faces and vertices depends on
    glint_key output_key; ///< key of the conversion to pixel values
    /// Hash of the view, and of the lights' positions and colours: if it changes, few pixels stay the same
    glint_key setting_key;
    bool walks; ///< whether some stage after `cast` traverses the BVH
    bool needs_index; ///< whether any does
    bool accumulate; ///< whether light must be summed over samples or over chunks of lights
    bool local; ///< whether all light comes from the stages shade (with one call per sample) and vertex
    bool together; ///< whether all samples of a tile are shaded together, without sums

    glint_stage_info stage_list[GLINT_STAGE_COUNT];
    size_t stage_count;
    glint_text_line *lines;
    glint_effect *effects;
    size_t effect_count, effect_capacity;
};

/// Takes a stage out of a copy of a plan.
static inline void glint_plan_drop(glint_plan *plan, glint_stage_id id)
{
    const glint_stage_set others = ~((glint_stage_set)1 << id);
    plan->runs[id] = false;
    for (int time = 0; time < GLINT_TIME_COUNT; time++)
        plan->steps[time] &= others;
    plan->limits &= others;
    plan->admits &= others;
    plan->singles &= others;
    plan->before_shade &= others;
    plan->after_shade &= others;
}

/// Returns whether anything in the scene can contribute to a term of the light.
static inline bool glint_plan_has_term(const glint_plan *plan, glint_term term)
{
    return term < GLINT_TERM_LOCAL ||
           (term == GLINT_TERM_INDIRECT ? plan->runs[GLINT_STAGE_INDIRECT]
                                        : plan->runs[GLINT_STAGE_BOUNCE] || plan->runs[GLINT_STAGE_ROUGH]);
}

/// Returns whether rays are cast from surfaces, other than shadow rays.
static inline bool glint_plan_sends_rays(const glint_plan *plan)
{
    return plan->runs[GLINT_STAGE_BOUNCE] || plan->runs[GLINT_STAGE_ROUGH] || plan->runs[GLINT_STAGE_INDIRECT];
}

/// Returns the constant diffuse reflectance of a material; if a program computes it, 1 or the value without the
/// program.
static inline const double *glint_plan_diffuse(const glint_plan *plan, uint32_t material)
{
    return plan->patterns ? plan->patterns->of[material].desc.diffuse : plan->materials[material].diffuse;
}

/// Returns the number of rays of one kind that a sample sends: `samples`, limited by the frame's `rays`.
uint32_t glint_plan_rays(const glint_plan *plan, int64_t samples);

/// Returns whether lights illuminate surfaces.
static inline bool glint_plan_is_lit(const glint_plan *plan)
{
    return plan->geometry->table.prim_count > 0 && plan->light_count > 0;
}

/// Computes a colour times a factor, at most GLINT_STRENGTH_MAX. 0 times infinity is 0.
static inline void glint_plan_bounded(double out[3], const double color[3], double factor)
{
    for (int c = 0; c < 3; c++)
        out[c] = color[c] == 0 ? 0 : fmin(color[c] * factor, GLINT_STRENGTH_MAX);
}

/// Returns whether some material turns normals.
static inline bool glint_plan_bumps(const glint_plan *plan) { return plan->patterns && plan->patterns->bumps; }
/// Returns whether some surface has holes.
static inline bool glint_plan_cuts(const glint_plan *plan) { return plan->patterns && plan->patterns->cut_outs; }

/// Selects the kernels of an instruction set by name; NULL: by the environment variable GLINT_ISA, otherwise the
/// best.
glint_status glint_choose_isa(const char *isa, const glint_stages **out, glint_error *error);

/// The passes that `outline` is computed from.
#define GLINT_OUTLINE_READS (1u << GLINT_PASS_DEPTH | 1u << GLINT_PASS_NORMAL | 1u << GLINT_PASS_OBJECT_ID)

/// The passes of the ray through the pixel's centre.
#define GLINT_CENTRE_PASSES (GLINT_OUTLINE_READS | 1u << GLINT_PASS_ALBEDO | 1u << GLINT_PASS_OUTLINE)
/// The passes that take the mean of all samples of a pixel: beauty, the terms of its light, and alpha.
#define GLINT_LIGHT_PASSES (((1u << (GLINT_PASS_TRANSMISSION + 1)) - 1) | 1u << GLINT_PASS_ALPHA)

/// Creates a plan.
glint_status glint_plan_make(const glint_plan_input *from, glint_plan **out, glint_error *error);

/// Returns the tone curve of the pixel values that adaptive sampling compares. The base has pixel values only if
/// necessary; otherwise the comparison estimates them.
glint_tone_desc glint_plan_compared(const glint_render_desc *desc);
bool glint_plan_compares_codes(const glint_render_desc *desc);
/// Returns the description of the base frame with one sample per pixel: with the passes and pixel values of `desc`,
/// or with the pixel values that are compared.
glint_render_desc glint_plan_base(const glint_render_desc *desc);

/// The rendered part of a frame: a rectangle of tiles, and its pixels.
typedef struct glint_extent {
    uint32_t tile_x, tile_y, across, down; ///< the first tile, and the number of tiles
    int x, y, width, height; ///< pixels
} glint_extent;

/// Returns the whole frame; for a region, the tiles with a pixel in the region or at most two pixels away, because
/// outlines and adaptive sampling read neighbours.
glint_extent glint_plan_extent(const glint_render_desc *desc);

/// Computes the position of sample `k` in its pixel: 0 .. 1 to the right and down.
void glint_plan_sample_offset(const glint_plan *plan, uint32_t k, double out[2]);
/// Computes the position of a pixel's centre in the same units.
void glint_plan_centre_offset(const glint_plan *plan, double out[2]);
/// Returns whether the passes of the pixels' centres (GLINT_CENTRE_PASSES) need their own rays: the first sample is
/// not at the centre, or goes through a lens.
bool glint_plan_casts_centres(const glint_plan *plan);

/// Fills the camera for a picture of this size in pixels, which may have fractions.
void glint_plan_camera_init(glint_plan_camera *out, const glint_camera_desc *desc, double width, double height);
/// Returns the camera for overlays.
glint_cover_camera glint_plan_cover_camera(const glint_plan_camera *camera);
/// Fills the lens, after the camera.
glint_status glint_plan_find_lens(glint_plan *plan, const glint_camera_desc *desc, glint_error *error);
/// Writes the lens of sample k for kernels.
void glint_plan_lens_at(const glint_plan *plan, uint32_t k, glint_lens *out);
/// Maps a point of the unit square to a lens of radius 1. blades: 0 for a round lens, otherwise at least 3.
void glint_lens_point(const double square[2], uint32_t blades, double rotation, double out[2]);

/// Fills the materials, and the lights that illuminate surfaces.
glint_status glint_plan_shading(glint_plan *plan, const glint_scene *scene, glint_error *error);
/// Marks similar lights, and counts those that cast shadows.
void glint_plan_count_lights(glint_plan *plan);
/// Fills one material's row. `ambient` is Ia.
void glint_shade_material_init(glint_shade_material *out, const glint_material_desc *desc, const double ambient[3]);

/// Returns whether a scene asks for indirect light or ambient occlusion.
static inline bool glint_plan_has_indirect(const glint_scene_desc *scene)
{
    return scene->has_ambient_occlusion || (scene->has_indirect && scene->indirect_bounces > 0);
}
/// Finds the media that contain the eye of a perspective camera, if some material transmits.
glint_status glint_plan_eye(glint_plan *plan, glint_error *error);

/// Returns whether a light is visible, and writes its brightness: pi times its radiance.
///
/// With `radiance` L: pi L color. With `intensity` I: color I A(D), where A is the light's fall-off and D the radius of
/// a disk with the light's area (for a sphere, the sphere's radius). So a light that falls off as 1/(c2 d^2) looks as
/// bright as its distant illumination requires, I/(c2 area); a light that does not fall off looks as bright as a white
/// surface that it illuminates.
bool glint_light_shows(const glint_light_desc *desc, double shown[3]);

glint_status glint_plan_keys(glint_plan *plan, glint_error *error);
/// Returns the key of the whole picture up to a stage, including all its times.
glint_key glint_plan_picture_key(const glint_plan *plan, glint_stage_id stage);

/// A copy of a plan with the keys that it would have with its surfaces at other positions. The copy owns nothing.
typedef struct glint_plan_twin {
    glint_plan plan; ///< the copy; its stage keys and the keys of its lights differ from the plan's
} glint_plan_twin;

/// where: see glint_geometry. Returns false when out of memory. The twin must be freed in both cases.
bool glint_plan_twin_make(glint_plan_twin *twin, const glint_plan *plan, glint_key where);
void glint_plan_twin_free(glint_plan_twin *twin);

glint_status glint_plan_explain(glint_plan *plan, const glint_scene *scene, glint_error *error);

/// Returns the share of light that remains after a distance, in a medium with this absorption per unit of length.
static inline double glint_plan_transmittance(double absorption, double distance)
{
    return absorption > 0 ? glint_exp(-absorption * distance) : 1;
}

#endif
