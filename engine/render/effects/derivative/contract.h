/// The contract of the stages of derivatives: values and slopes of sixteen points, all in double. Begin with
/// stages.h.
///
/// The kernels skip terms with a slope of 0. The sign of a zero slope is not defined.
#ifndef GLINT_CONTRACT_DERIVATIVE_H
#define GLINT_CONTRACT_DERIVATIVE_H

#include "engine/base/dual.h"
#include "engine/render/stages/contract/tables.h"

/// The fields of glint_shade_material that have slopes.
typedef struct glint_derivative_material {
    uint32_t varies; ///< 0: no field has a slope
    uint32_t highlight, lobe; ///< glint_highlight, glint_lobe; also set for a material that gets its highlight from a
        ///< plane or a derivative
    uint32_t unused; ///< 0: no padding
    glint_dual diffuse[3], specular[3], grazing[3], ambient[3], shininess, alpha;
} glint_derivative_material;

/// A light of the scene, or the fields that all samples of an area light share.
typedef struct glint_derivative_light {
    uint32_t varies;
    uint32_t moves; ///< 1: the light's shadows move; 0: they stay
    uint32_t turns; ///< 1: `position` or `axis` has a slope
    uint32_t shines; ///< 1: a field other than `position` and `axis` has a slope
    uint32_t directional, is_spot;
    uint32_t attenuated; ///< 1: the light gets weaker with distance
    uint32_t unused; ///< 0: no padding
    glint_dual position[3]; ///< directional: the unit vector towards the light; area light: all samples share the slope
    glint_dual coefficients[3], diffuse[3], specular[3];
    glint_dual axis[3], outer, inverse, exponent; ///< the cone of a spot, see glint_spot
} glint_derivative_light;

/// How a surface moves: slopes in world space.
typedef struct glint_derivative_part {
    uint32_t moves;
    uint32_t unused; ///< 0: no padding
    double position[3]; ///< slope of a sphere's centre, or of a plane's point
    double growth; ///< slope of a sphere's radius, divided by the radius
    double normal[3]; ///< slope of a plane's unit normal
    double pivot[3]; ///< the fixed point around which a plane turns
} glint_derivative_part;

/// How the eye and its lens move: slopes.
typedef struct glint_derivative_view {
    uint32_t moves;
    uint32_t unused; ///< 0: no padding
    double eye[3], forward[3], right[3], up[3]; ///< slopes of these fields of glint_plan_camera
    double lens[2][3]; ///< slopes of the unit axes of the lens, right and up. Without a lens, this and the next two
        ///< fields are 0
    double wider; ///< slope of the aperture, divided by the aperture
    double nearer; ///< slope of 1 / focus distance
} glint_derivative_view;

/// Points of a group: sixteen doubles each.
typedef struct glint_derivative_points {
    const double *point[3];
    const double *normal[3]; ///< unit, turned towards the eye
    const double *eye[3]; ///< unit, towards the eye
    const double *slope[3][3]; ///< slopes of point, normal and eye; slope[0][0] NULL: all slopes are 0
} glint_derivative_points;

/// The results of a material's programs for a group. They modify the fields of glint_derivative_material.
enum {
    GLINT_DERIVED_DIFFUSE, ///< three factors of the material's diffuse colour
    GLINT_DERIVED_SPECULAR = 3, ///< three factors of the specular colour
    GLINT_DERIVED_SHININESS = 6, ///< replaces the material's shininess
    GLINT_DERIVED_ALPHA, ///< replaces the material's alpha
    GLINT_DERIVED_COUNT
};

typedef struct glint_derivative_planes {
    const double *value[GLINT_DERIVED_COUNT]; ///< sixteen values for each field; NULL: the material's value
    const double *slope[GLINT_DERIVED_COUNT]; ///< slopes of these values; NULL: 0
} glint_derivative_planes;

/// A light, or one sample of a light, as seen from a group.
typedef struct glint_derivative_source {
    const double *position[3]; ///< position of the light; directional: the unit vector towards the light
    const double *normal[3]; ///< unit normals of the light's surface; only read for radiant lights
    const double *weight; ///< the share of the light that reaches the point; NULL: 1
    const double *tint[3], *tint_slope[3]; ///< the transmitted share of each colour; tint[0] NULL: 1
    bool radiant; ///< the light has the factor cos' / distance^2
    bool both; ///< only read for radiant lights: the light emits to both sides
} glint_derivative_source;

/// The light that arrives at points: unit direction to the light, arriving colour and distance, in the order of the
/// inputs from GLINT_INPUT_L_X on.
#define GLINT_ARRIVAL_COUNT 7
typedef struct glint_arrival_args {
    const glint_derivative_light *light;
    const glint_derivative_points *points;
    const glint_derivative_source *source;
    double *value[GLINT_ARRIVAL_COUNT], *slope[GLINT_ARRIVAL_COUNT]; ///< out, written in every lane; NULL: not wanted
} glint_arrival_args;

/// Unit vectors opposite to the directions of a group's rays.
typedef struct glint_eyes_args {
    const double *direction; ///< three rows of sixteen
    const double *more; ///< added to `direction`; NULL: nothing is added
    double *eye[3]; ///< out
} glint_eyes_args;

/// The camera that sees the hits, and how it changes with one parameter.
typedef struct glint_bend_camera {
    double eye[3], forward[3], right[3], up[3];
    double turn[3][3]; ///< for a pinhole: the rows of a matrix; the matrix times a direction from the eye is the rate
        ///< at which this direction turns
    double near; ///< one over the focus distance; 0 without a lens
    bool orthographic;
} glint_bend_camera;

/// Computes how fast visible hits on one sphere or plane move. They stay on their rays and on their surface.
typedef struct glint_bend_args {
    const glint_derivative_points *points;
    const glint_prim *prim; ///< a sphere or a plane
    const glint_derivative_part *part; ///< how the primitive moves
    const glint_derivative_view *view; ///< how the eye moves
    const glint_bend_camera *camera;
    /// The position of a sample in the picture, in half pixels from the centre to the right and up; NULL: the hits
    /// are seen from a point.
    const double *screen[2];
    const double *shift[3], *shift_slope[3]; ///< the position of the sample on the lens, and its slope
    double *slope[3][3]; ///< out, written in every lane: slopes of points, normals and eye vectors
} glint_bend_args;

/// Adds the derivative of the light that the lanes with one material reflect.
typedef struct glint_slope_args {
    const glint_derivative_light *light;
    const glint_derivative_material *material;
    const glint_derivative_planes *planes; ///< results of programs; NULL: none
    const glint_derivative_points *points;
    const glint_derivative_source *source;
    unsigned lanes; ///< one bit per lane
    double *sum[3]; ///< in and out: the slopes of the reflected light are added
    double *whole[3]; ///< in and out: the reflected light is added; whole[0] NULL: not wanted
} glint_slope_args;

#endif
