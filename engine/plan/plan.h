/// A frame's plan: the tables its stages read, which stages there are, and the key of each. Internal.
///
///   plan.c            puts it together
///   plan/stage.h      what a stage declares; core.c has the core's, effects/*/ the others
///   plan/keys.c       what each stage reads, hashed
///   geometry.c        what rays meet, shared by the plans of one scene
///   plan/camera.c     the view
///   plan/lens.c       where samples go through the camera's lens
///   plan/shading.c    materials and lights
///   plan/eye.c        what the eye is inside of
///   plan/explain.c    which effects the scene calls for, and who called
///   effects/*/plan.c  an effect's part
#ifndef GLINT_PLAN_H
#define GLINT_PLAN_H

#include "engine/geometry/geometry.h"
#include "engine/geometry/media.h"
#include "engine/overlay/overlay.h"
#include "engine/effects/derivative/plan.h"
#include "engine/effects/pattern/plan.h"
#include "engine/effects/translucent/plan.h"
#include "engine/plan/stage.h"

typedef struct glint_plan_camera {
    bool orthographic;
    double eye[3], forward[3]; ///< forward is unit
    double right[3], up[3]; ///< from a pixel's centre to its edge
    double span[2]; ///< twice the way from the picture's left and upper edges to where `forward` is seen, pixels
    double pixel_offset;
    double aperture, focus; ///< of the lens; 0: there is none, and of the following nothing is read
    uint32_t blades; ///< 0: it is round
    double blade_rotation;
} glint_plan_camera;

/// Where the rays of one sample go through the lens, by the lane of their pixel: to the right and up, world units.
typedef struct glint_lens_points {
    double at[2][GLINT_GROUP];
} glint_lens_points;

/// A light, or one sample of an area light.
typedef struct glint_plan_light {
    bool directional, shadows, attenuated;
    bool joined; ///< a further sample of the area light before it
    bool alike; ///< without samples or a cone, as the light before it, and to the stage `light` different by its place alone
    bool is_spot;
    glint_spot spot;
    uint32_t source; ///< which light of the scene
    uint32_t group; ///< of the frame's light passes; GLINT_NO_GROUP: none
    const glint_light_sample *light_samples; ///< of an area light: the pattern of each turn, turn after turn; else NULL
    const glint_light_sample *cap; ///< shadows by caps: the whole light; else NULL
    bool hard; ///< area: one ray to `position`, its middle, decides for all samples
    bool radiant_cap; ///< within its radius the light is no stronger than at it
    uint32_t turn_count; ///< samples of a pixel take the turns one after the other
    double position[3]; ///< directional: the unit vector towards the light; area: read where `hard`
    double scale; ///< see glint_light_args
    double coefficients[3];
    double diffuse[3], specular[3]; ///< colour times intensity
    glint_key key; ///< of what `light` reads for this light; `occlude` reads the same
    glint_key place_key, look_key; ///< of that and whether it casts shadows; of the place and the colours
} glint_plan_light;

/// An edge of a polygon: where it begins, and the unit vector across it.
typedef struct glint_plan_edge {
    double corner[3], inwards[3];
} glint_plan_edge;

/// The surface of a light that rays see.
typedef struct glint_plan_visible_light {
    bool ball; ///< else flat
    bool one_sided; ///< flat: to the side of the normal
    double center[3], radius; ///< of a ball around all of it; disk, ball: its own
    double normal[3]; ///< flat: unit
    const glint_plan_edge *edges; ///< polygon
    size_t edge_count; ///< 0: a disk
    double shown[3]; ///< pi times its radiance: as everything in the film
    uint32_t group; ///< as a light's
} glint_plan_visible_light;

/// A background that a program gives.
typedef struct glint_plan_environment {
    glint_program *program; ///< owned reference
    glint_program *uv; ///< of p, a direction: where it is in a picture of all of them; NULL: the other does not read it
    uint32_t row_count; ///< the most that one of them needs
    double pixel; ///< the angle of a pixel; 0: rays are parallel
    double most; ///< bound of what it gives
} glint_plan_environment;

/// What a material sends on.
typedef struct glint_bounce_material {
    double mirror[3], transmission[3], absorption[3], ior;
    double clear; ///< the share that goes straight on; 0 if a program gives it
    bool fresnel, mirrors, transmits; ///< the latter: some channel
    bool clears; ///< true if the material is translucent
} glint_bounce_material;

/// Returns whether a material sends on rays of any kind.
static inline bool glint_sends_on(const glint_bounce_material *m) { return m->mirrors || m->transmits || m->clears; }

/// Indirect light; all 0: there is none.
typedef struct glint_plan_indirect {
    uint32_t samples, bounces;
    uint32_t *light_rows; ///< the first of plan->lights that belongs to each light, and one beyond
    uint32_t light_count;
    double (*rest)[3]; ///< beside materials: what `ambient` adds where light is followed no further
    double least; ///< the share of its first weight below which a path of light ends
    bool is_sky; ///< ambient occlusion: paths look for open sky alone
    double distance; ///< then, within which surfaces close it; may be infinite
} glint_plan_indirect;

#define GLINT_BOUNCE_LEVELS 32 ///< times that the weaker of two rays may be followed first; see effects/bounce/bounce.c
#define GLINT_BOUNCE_SPLITS 16 ///< surfaces of a chain at which both rays are followed
#define GLINT_BOUNCE_LOSS 0x1p-20 ///< of linear light: what weak rays that are not followed may hold together, a sample

typedef struct glint_text_line {
    char effect[48];
    char caller[2 * GLINT_NAME_SIZE];
} glint_text_line;

struct glint_plan {
    glint_render_desc desc;
    uint32_t shutter_times; ///< light is the mean of so many times of the scene; 0: of one instant
    struct glint_plan **times; ///< these, each rendered by itself, owned; NULL: lights alone differ, and are in `lights`
    bool is_base; ///< it is what adaptive sampling looks at, the next field of another
    struct glint_plan *base; ///< of the picture that adaptive sampling looks at, of one sample a pixel; NULL: it is off
    glint_plan_camera camera;
    glint_lens_points *lens; ///< of each sample; NULL: the camera has no lens

    glint_geometry *geometry;
    glint_translucent *translucent; ///< beside the geometry's materials; NULL: none is translucent
    glint_shade_material *materials; ///< in the geometry's order
    uint32_t material_count;
    glint_plan_patterns *patterns; ///< what programs give of materials; NULL: no material has any
    bool highlights; ///< some material and some light make one: of the next two kinds
    bool powers, facets; ///< Phong's and Blinn-Phong's; of microfacets
    glint_plan_light *lights;
    glint_light_sample *light_samples; ///< of all area lights
    bool caps; ///< shapes and materials allow shadows by caps
    uint32_t light_count, shadow_count; ///< of these, rows that cast shadows, and
    uint32_t spared_count; ///< among those, rows that need no rays of their own
    double ambient[3], background[3]; ///< the latter 0 where there is an environment
    glint_plan_environment *environment; ///< NULL: the background is plain
    struct {
        bool on;
        double color[3], near, far; ///< see glint_scene_desc
    } depth_cue;
    struct {
        bool on;
        uint32_t material; ///< the innermost medium's
        double absorption[3];
    } veil; ///< the eye is inside what absorbs
    glint_plan_visible_light *visible_lights; ///< NULL: no light is seen
    glint_plan_edge *visible_light_edges; ///< of all of them
    uint32_t visible_light_count;
    size_t visible_light_edge_count;

    glint_plan_derivatives *derivatives; ///< NULL: none is wanted
    struct glint_light_groups *light_groups; ///< NULL: no light pass is wanted

    glint_bounce_material *bouncing; ///< beside materials; NULL: none of them sends rays on
    bool mirrors, transmits, clears, absorbs; ///< some material; the last: one that transmits
    glint_plan_indirect indirect;
    glint_media eye_media; ///< what the eye of a perspective camera is inside of
    bool tints; ///< some light casts shadows, and something transmits or is translucent
    bool dims; ///< and something absorbs what goes through it
    double brightest; ///< bound of what any ray can bring; may be infinite

    glint_overlays *overlays; ///< drawn over the finished picture; NULL: none

    bool runs[GLINT_STAGE_COUNT];
    uint32_t steps[GLINT_TIME_COUNT]; ///< of these, the stages that take a step at a time, a bit each
    uint32_t limits, admits; ///< and those with these functions
    bool reads_normals; ///< some of them is likely to
    glint_key where; ///< the geometry's, of its places
    glint_key keys[GLINT_STAGE_COUNT];
    glint_key *material_keys, *matte_keys; ///< of each row of materials; of what it reads where it has no highlight
    glint_key all_materials_key, all_lights_key, background_key;
    glint_key vertex_key; ///< of what the light of faces and vertices is worked out from
    glint_key output_key; ///< of what pictures are made of pixels
    glint_key setting_key; ///< of the view, and of lights' places and colours: where another, few pixels stay
    bool raster; ///< triangles are found by projecting them, not by casting
    bool needs_index; ///< some stage walks it
    bool accumulate; ///< sums over samples or over chunks of lights
    bool local; ///< light comes from nowhere but the stages shade, in one call a sample, and vertex
    bool together; ///< all samples of a tile are shaded in one, by what was found for each: they need no sums

    glint_stage_info stage_list[GLINT_STAGE_COUNT];
    size_t stage_count;
    glint_text_line *lines;
    glint_effect *effects;
    size_t effect_count, effect_capacity;
};

/// Whether anything can add to a term.
static inline bool glint_plan_has_term(const glint_plan *plan, glint_term term)
{
    return term < GLINT_TERM_LOCAL ||
           plan->runs[term == GLINT_TERM_INDIRECT ? GLINT_STAGE_INDIRECT : GLINT_STAGE_BOUNCE];
}

/// The diffuse reflectance of a material, as far as it is a number; where a program gives it, 1 or what it would be without.
static inline const double *glint_plan_diffuse(const glint_plan *plan, uint32_t material)
{
    return plan->patterns ? plan->patterns->of[material].desc.diffuse : plan->materials[material].diffuse;
}

/// Whether lights give light to surfaces.
static inline bool glint_plan_is_lit(const glint_plan *plan)
{
    return plan->geometry->table.prim_count > 0 && plan->light_count > 0;
}

/// Whether some material turns normals.
static inline bool glint_plan_bumps(const glint_plan *plan) { return plan->patterns && plan->patterns->bumps; }
/// Whether some surface has holes.
static inline bool glint_plan_cuts(const glint_plan *plan) { return plan->patterns && plan->patterns->cut_outs; }

/// The stages of an instruction set by name; NULL: the environment's GLINT_ISA, else the best.
glint_status glint_choose_isa(const char *isa, const glint_stages **out, glint_error *error);

/// The passes that `outline` is made of.
#define GLINT_OUTLINE_READS (1u << GLINT_PASS_DEPTH | 1u << GLINT_PASS_NORMAL | 1u << GLINT_PASS_OBJECT_ID)

/// The passes of the ray through the pixel's centre.
#define GLINT_CENTRE_PASSES (GLINT_OUTLINE_READS | 1u << GLINT_PASS_ALBEDO | 1u << GLINT_PASS_OUTLINE)
/// The passes that are means of the samples.
#define GLINT_LIGHT_PASSES (((1u << (GLINT_PASS_TRANSMISSION + 1)) - 1) | 1u << GLINT_PASS_ALPHA)

/// Whether a frame's plan and those of its times differ in lights alone, and light adds up in the frame.
bool glint_plan_adds_up(const glint_plan *plan, glint_plan *const *times, size_t count);
/// Gives a plan the lights of all times, each with its share, in place of its own. After shading.
glint_status glint_plan_take_lights(glint_plan *plan, glint_plan *const *times, size_t count, glint_error *error);
void glint_plan_free_times(glint_plan **times, size_t count); ///< and the list; NULL: nothing

/// Adaptive sampling of a frame compares codes of this tone, which the base has where it must: else they are estimated.
glint_tone_desc glint_plan_compared(const glint_render_desc *desc);
bool glint_plan_compares_codes(const glint_render_desc *desc);
/// The base frame, of one sample a pixel: the passes and codes of `desc`, or the codes that are compared.
glint_render_desc glint_plan_base(const glint_render_desc *desc);

/// What of a frame is rendered: a rectangle of tiles, and its pixels.
typedef struct glint_extent {
    uint32_t tile_x, tile_y, across, down; ///< the first tile, and how many
    int x, y, width, height; ///< pixels
} glint_extent;

/// All of a frame; of a region the tiles that have a pixel of it or one at most two away, as outlines and adaptive sampling
/// look at neighbours.
glint_extent glint_plan_extent(const glint_render_desc *desc);

/// Where sample `k` of a pixel lies in it: 0 .. 1 across and down.
void glint_plan_sample_offset(const glint_plan *plan, uint32_t k, double out[2]);
/// Where the centre of a pixel lies in it, likewise.
void glint_plan_centre_offset(const glint_plan *plan, double out[2]);
/// Whether the passes of the pixels' centres (GLINT_CENTRE_PASSES) need rays of their own: no sample goes there first, or only
/// through a lens.
bool glint_plan_casts_centres(const glint_plan *plan);

void glint_plan_camera_init(glint_plan_camera *out, const glint_camera_desc *desc, const glint_render_desc *render);
/// Fills the lens, after the camera.
glint_status glint_plan_find_lens(glint_plan *plan, const glint_camera_desc *desc, glint_error *error);
/// Of sample k, as kernels read it.
void glint_plan_lens_at(const glint_plan *plan, uint32_t k, glint_lens *out);
/// Where a point of the unit square, of `square`, lies on a lens of radius 1; blades: 0, or at least 3.
void glint_lens_point(const double square[2], uint32_t blades, double rotation, double out[2]);

/// Fills materials and the lights that give light.
glint_status glint_plan_shading(glint_plan *plan, const glint_scene *scene, glint_error *error);
/// Says which lights are alike, and how many cast shadows.
void glint_plan_count_lights(glint_plan *plan);
/// Fills one material's row. `light_ambient` is Ia.
void glint_shade_material_init(glint_shade_material *out, const glint_material_desc *desc, const double ambient[3]);

/// Fills the environment.
glint_status glint_plan_find_environment(glint_plan *plan, const glint_scene_desc *scene, glint_error *error);
void glint_plan_environment_free(glint_plan_environment *environment); ///< NULL: nothing
/// Whether there may be indirect light or ambient occlusion.
bool glint_plan_has_indirect(const glint_scene_desc *scene);
/// Fills what indirect light needs, after shading, and takes from the materials' ambient light what it stands for.
glint_status glint_plan_find_indirect(glint_plan *plan, const glint_scene_desc *scene, glint_error *error);
/// Fills what mirrors and transparent materials need, after that.
glint_status glint_plan_bounce(glint_plan *plan, glint_error *error);
/// Continues a key with what light is left of by a transparent material.
glint_key glint_transmission_key(const glint_bounce_material *m, glint_key key);
/// Fills what the eye of a perspective camera is inside of, which glint_plan_bounce does where something transmits.
glint_status glint_plan_eye(glint_plan *plan, glint_error *error);

/// Fills the derivatives that `desc` wants, after shading.
glint_status glint_plan_find_derivatives(glint_plan *plan, const glint_scene *scene, const glint_render_desc *desc,
                                         glint_error *error);
/// Whether all of the frame that depends on them has derivatives; its stages are chosen.
glint_status glint_plan_check_derivatives(const glint_plan *plan, const glint_scene *scene, glint_error *error);
/// Continues a key with all that one of them reads beside the frame.
glint_key glint_derivative_key(const glint_plan *plan, size_t index, glint_key key);

/// Fills the lights that are seen.
glint_status glint_plan_visible_lights(glint_plan *plan, const glint_scene *scene, glint_error *error);
/// Whether rays see a light, and what they see: pi times its radiance.
///
/// By `radiance` L: pi L color. By `intensity` I: color I A(D), A its fall-off and D the radius of a disk of its area (of a
/// sphere: its own). A light that falls off as 1/(c2 d^2) so looks like what lights the same from afar, I/(c2 area); one
/// that does not fall off looks as bright as the white surface it lights.
bool glint_light_shows(const glint_light_desc *desc, double shown[3]);

glint_status glint_plan_keys(glint_plan *plan, glint_error *error);
/// The key of the whole picture up to a stage, with all times of it.
glint_key glint_plan_picture_key(const glint_plan *plan, glint_stage_id stage);

/// A plan's keys as they would be if its surfaces were elsewhere: a copy that owns nothing of the plan's.
typedef struct glint_plan_twin {
    glint_plan plan; ///< of which all keys, and those of the lights, differ
} glint_plan_twin;

/// where: see glint_geometry. False: no memory. To be freed either way.
bool glint_plan_twin_make(glint_plan_twin *twin, const glint_plan *plan, glint_key where);
void glint_plan_twin_free(glint_plan_twin *twin);

glint_status glint_plan_explain(glint_plan *plan, const glint_scene *scene, glint_error *error);

/// What absorption, per unit of length, leaves of light over a distance.
static inline double glint_plan_left(double absorption, double distance)
{
    return absorption > 0 ? glint_exp(-absorption * distance) : 1;
}

#endif
