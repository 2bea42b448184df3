/// The contract of the stages of derivatives: values and slopes of sixteen points, all in double. Begin with stages.h.
///
/// A slope that is 0 is not worked with, and adds nothing: a slope may be 0 of either sign.
#ifndef GLINT_CONTRACT_DERIVATIVE_H
#define GLINT_CONTRACT_DERIVATIVE_H

#include "engine/base/dual.h"
#include "engine/stages/contract/tables.h"

/// A material, as glint_shade_material has it.
typedef struct glint_derivative_material {
    uint32_t varies; ///< 0: nothing of it has a slope
    uint32_t highlight, lobe; ///< glint_highlight, glint_lobe; of a material without a highlight that gets one, too
    uint32_t unused; ///< 0: no padding
    glint_dual diffuse[3], specular[3], grazing[3], ambient[3], shininess, alpha;
} glint_derivative_material;

/// A light of the scene, or what its samples have in common.
typedef struct glint_derivative_light {
    uint32_t varies;
    uint32_t moves; ///< its shadows do
    uint32_t turns; ///< `position` or `axis` has a slope
    uint32_t shines; ///< another number has
    uint32_t directional, is_spot;
    uint32_t attenuated; ///< by distance
    uint32_t unused; ///< 0: no padding
    glint_dual position[3]; ///< directional: the unit vector towards it; of an area light the slope is that of its samples
    glint_dual coefficients[3], diffuse[3], specular[3];
    glint_dual axis[3], outer, inverse, exponent; ///< of a spot, see glint_spot
} glint_derivative_light;

/// A surface that moves; slopes, in the world.
typedef struct glint_derivative_part {
    uint32_t moves;
    uint32_t unused; ///< 0: no padding
    double place[3]; ///< of a sphere's centre or a plane's point
    double growth; ///< of a sphere's radius, in shares of it
    double normal[3]; ///< of a plane's unit normal
    double pivot[3]; ///< around which a plane turns: no slope
} glint_derivative_part;

/// The eye and its lens; slopes.
typedef struct glint_derivative_view {
    uint32_t moves;
    uint32_t unused; ///< 0: no padding
    double eye[3], forward[3], right[3], up[3]; ///< as in glint_plan_camera
    double lens[2][3]; ///< of the unit axes of the lens, to the right and up; without a lens 0, and so the next
    double wider; ///< of the aperture, in shares of it
    double nearer; ///< of one over the distance of its focus
} glint_derivative_view;

/// Points of a group: sixteen doubles each.
typedef struct glint_derivative_points {
    const double *point[3];
    const double *normal[3]; ///< unit, turned to the eye
    const double *eye[3]; ///< unit, towards it
    const double *slope[3][3]; ///< of the three; slope[0][0] NULL: all are 0
} glint_derivative_points;

/// The results of a material's programs for a group, in addition to the numbers of glint_derivative_material.
enum {
    GLINT_DERIVED_DIFFUSE, ///< three, by which the material's are multiplied; and so of the next
    GLINT_DERIVED_SPECULAR = 3,
    GLINT_DERIVED_SHININESS = 6, ///< in the place of the material's, and so the next
    GLINT_DERIVED_ALPHA,
    GLINT_DERIVED_COUNT
};

typedef struct glint_derivative_planes {
    const double *value[GLINT_DERIVED_COUNT]; ///< sixteen each; NULL: the material's own
    const double *slope[GLINT_DERIVED_COUNT]; ///< NULL: 0
} glint_derivative_planes;

/// A light as a group sees it, or one sample of it.
typedef struct glint_derivative_source {
    const double *position[3]; ///< directional: the unit vector towards it
    const double *normal[3]; ///< of its surface; read of radiant ones
    const double *weight; ///< share of it that reaches the point; NULL: 1
    const double *tint[3], *tint_slope[3]; ///< transmitted share of its colours; tint[0] NULL: all
    bool radiant; ///< with cos' / distance^2
    bool both; ///< radiant: to both sides
} glint_derivative_source;

/// How a light comes to points: the unit way to it, what of its colour arrives, and how far it is, as the inputs from
/// GLINT_INPUT_L_X on.
#define GLINT_ARRIVAL_COUNT 7
typedef struct glint_arrival_args {
    const glint_derivative_light *light;
    const glint_derivative_points *points;
    const glint_derivative_source *source;
    double *value[GLINT_ARRIVAL_COUNT], *slope[GLINT_ARRIVAL_COUNT]; ///< out: of every lane; NULL: not wanted
} glint_arrival_args;

/// Unit vectors against the directions of a group's rays.
typedef struct glint_eyes_args {
    const double *direction; ///< three rows of sixteen
    const double *more; ///< added to these; NULL: nothing
    double *eye[3]; ///< out
} glint_eyes_args;

/// The camera that some hits are seen by, as one derivative changes it.
typedef struct glint_bend_camera {
    double eye[3], forward[3], right[3], up[3];
    double turn[3][3]; ///< how fast a way from the eye turns, of a pinhole: rows, by that way
    double near; ///< one over the distance of its lens' focus; without a lens 0
    bool orthographic;
} glint_bend_camera;

/// How fast hits on one sphere or plane move that an eye sees; they stay on their rays and their surface.
typedef struct glint_bend_args {
    const glint_derivative_points *points;
    const glint_prim *prim; ///< a sphere or a plane
    const glint_derivative_part *part; ///< how that moves
    const glint_derivative_view *view; ///< how the eye does
    const glint_bend_camera *camera;
    /// A sample's place in the picture, in pixels' halves from the middle, to the right and up; NULL: seen from a point
    const double *place[2];
    const double *shift[3], *shift_slope[3]; ///< its place on the lens
    double *slope[3][3]; ///< out: of points, of normals, of eyes; in every lane
} glint_bend_args;

/// Adds how fast what a light leaves on some lanes changes, which show one material.
typedef struct glint_slope_args {
    const glint_derivative_light *light;
    const glint_derivative_material *material;
    const glint_derivative_planes *planes; ///< results of programs; NULL: none
    const glint_derivative_points *points;
    const glint_derivative_source *source;
    unsigned lanes; ///< a bit each
    double *sum[3]; ///< in and out: slopes
    double *whole[3]; ///< in and out: what the light leaves; whole[0] NULL: not wanted
} glint_slope_args;

#endif
