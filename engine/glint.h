/// glint: a ray-tracing render engine. This header has the renderer; glint_files.h and others have the rest of the API.
///
/// The order of use: describe (materials, lights, shapes, a camera, a scene), plan (glint_plan_create takes a
/// snapshot of the scene and lists the stages that a frame needs), render (glint_render runs the plan), write.
///
/// Units     lengths are in world units, angles in radians (`_rad`; `_deg`: degrees), colours linear RGB with 1.0 =
///           display white.
/// Vectors   `double v[3]` is x, y, z or red, green, blue. The world is right-handed.
/// Errors    every function that can fail returns a glint_status and fills `error`, which may be NULL. On failure,
///           outputs and objects are unchanged. The message starts with the argument's name: "shininess: number >= 0
///           expected, got -1". NULL for a pointer that is not optional is GLINT_ERR_INVALID, too: "shape: pointer
///           expected, got NULL". Functions that return no status return 0, NULL, false or the identity transform
///           instead, or do nothing.
/// Ownership `_create` returns a reference that the caller owns and must release with `_release`; `_retain` adds one.
///           `_release(NULL)` does nothing. Pointers in a description struct are borrowed for the call only.
/// Growth    a struct that begins with `struct_size`, its sizeof, gets more fields in later versions; others do not grow.
///           glint_X_desc_default() returns the defaults with the size; glint_X_desc_init() does it for other languages.
///           A copy of what `_get` returns needs its own size: copy.struct_size = sizeof copy. A shorter struct is the
///           beginning of one: the other fields have their defaults, so programs compiled with an earlier version work. In
///           a longer one, all bytes after the known fields must be 0.
/// Threads   described objects (material, light, camera, shape, overlay, scene) belong to one thread at a time. Plans
///           and finished images are immutable. A renderer renders one frame at a time.
#ifndef GLINT_H
#define GLINT_H

#include "glint_types.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// The version of this header, as a text and as numbers.
#define GLINT_VERSION "0.3.0"
#define GLINT_VERSION_MAJOR 0
#define GLINT_VERSION_MINOR 3
#define GLINT_VERSION_PATCH 0

/// Returns the version of the library that the program runs with, such as "0.3.0"; a static string. The library fits
/// this header if the first number is equal and, while it is 0, the second, too.
const char *glint_version(void);

#define GLINT_SIDE_MAX 65535 ///< longest side of an image, in pixels

// ---- Scene ---------------------------------------------------------------------------------------------------------

/// The fields of a scene, except its lists of objects. Light in linear RGB, lengths in world units.
typedef struct glint_scene_desc {
    size_t struct_size; ///< sizeof(glint_scene_desc)
    glint_camera *camera; ///< retained; may be NULL until a frame is planned
    double ambient[3]; ///< ambient light; finite, >= 0; default 0
    double background[3]; ///< background colour; finite, >= 0; default 0
    /// Retained: a pattern that gives the background for the direction d of a ray, instead of `background`, as seen
    /// by the eye, in mirrors, through glass and by indirect light; NULL: none. d is unit. The pattern reads d as p
    /// and world, -d as n and v, the angle of a pixel in radians as footprint (0 with parallel rays), and the
    /// position of d in a panorama as uv: u = 1/2 + atan2(x, -z) / 2 pi, so that the middle column is -z, the first
    /// and last are +z, and +x is three quarters from the left; v = acos(-y) / pi, from straight down to straight up.
    /// A pattern of numbers only replaces `background` by these numbers. Other results that are NaN or below 0 become
    /// 0
    glint_program *background_program;
    /// Light fades towards a colour with the distance d from the eye to the first surface, as in the pass depth: the
    /// pixel gets f = min(max((d - near) / (far - near), 0), 1) of the colour and 1 - f of the light. The colour's
    /// part goes to the background pass. The background itself and light from mirrors do not fade
    bool has_depth_cue;
    bool has_depth_cue_color; ///< false: `background` is the colour; it must not be a pattern
    double depth_cue_color[3]; ///< finite, >= 0
    double depth_cue_near, depth_cue_far; ///< finite, 0 <= near < far; near is 0 by default, far must be set
    /// false: `ambient` replaces all light that surfaces receive from each other and from the background
    bool has_indirect;
    /// Indirect light paths from each visible point, in cosine-weighted directions. Their mean light times kd is the
    /// indirect light. 1 .. 65536; must be set if `has_indirect` is.
    int64_t indirect_samples;
    /// Diffuse surfaces at which a path continues; 0 .. 2^31. At the next diffuse surface `ambient`
    /// replaces the rest; with 0 that is the first one. The part of a material's `ambient` above its `diffuse` is
    /// emitted light and is always added.
    int64_t indirect_bounces;
    /// Ambient light is multiplied by the cosine-weighted unoccluded share of the sky above the point. This applies
    /// to `ambient` of a material up to its `diffuse`; the product goes to the pass `indirect`. The part above
    /// `diffuse` is emitted light and stays in the pass `ambient`. Not together with `has_indirect`, which computes
    /// the light that arrives
    bool has_ambient_occlusion;
    int64_t ambient_occlusion_samples; ///< number of rays from each visible point; 1 .. 65536, must be set
    /// World units, > 0, may be infinite: more distant surfaces do not occlude. A transmitting surface occludes only
    /// the light that it takes; the ray continues refracted, and the distance starts again there
    double ambient_occlusion_distance;
    /// Number of rays that a rough surface reflects or refracts for each sample of a pixel that shows it, from the
    /// distribution of its microfacets: 0 .. 65536; 16 in a new scene. 0: rough surfaces show lamps only
    int64_t reflection_samples;
} glint_scene_desc;

/// Writes a description with every field at its default.
void glint_scene_desc_init(glint_scene_desc *desc, size_t size);
GLINT_DESC_DEFAULT(scene);
/// Makes an empty scene without a camera. GLINT_ERR_NOMEM.
glint_status glint_scene_create(glint_scene **out, glint_error *error);
/// Replaces the description by a copy and retains its camera; on error nothing changes.
glint_status glint_scene_set(glint_scene *scene, const glint_scene_desc *desc, glint_error *error);
/// Returns the description; borrowed, valid until the scene is set or released.
const glint_scene_desc *glint_scene_get(const glint_scene *scene);
/// Takes another reference; returns its argument.
glint_scene *glint_scene_retain(glint_scene *scene);
/// Releases a reference; the last one frees the scene and releases what it retains. NULL: nothing.
void glint_scene_release(glint_scene *scene);
/// Adds or removes an object. Objects are numbered in the order they were added, and the scene retains them. Adding
/// an object twice is an error, and so is removing one that is not in the scene. An object may be in several scenes.
glint_status glint_scene_add_shape(glint_scene *scene, glint_shape *shape, glint_error *error);
glint_status glint_scene_add_light(glint_scene *scene, glint_light *light, glint_error *error);
glint_status glint_scene_remove_shape(glint_scene *scene, glint_shape *shape, glint_error *error);
glint_status glint_scene_remove_light(glint_scene *scene, glint_light *light, glint_error *error);
/// Returns how many shapes or lights were added; a group counts as one.
size_t glint_scene_shape_count(const glint_scene *scene);
size_t glint_scene_light_count(const glint_scene *scene);

/// Returns an object, `index` < the count, in the order they were added; borrowed from the scene.
glint_shape *glint_scene_shape_at(const glint_scene *scene, size_t index);
glint_light *glint_scene_light_at(const glint_scene *scene, size_t index);

/// Adds or removes an overlay. A scene draws its overlays in the order they were added, and retains them; an overlay
/// may be in several scenes. Adding one twice is an error, and so is removing one that is not in the scene.
glint_status glint_scene_add_overlay(glint_scene *scene, glint_overlay *overlay, glint_error *error);
glint_status glint_scene_remove_overlay(glint_scene *scene, glint_overlay *overlay, glint_error *error);
/// Returns how many overlays the scene has, and one of them, `index` < the count; borrowed from the scene.
size_t glint_scene_overlay_count(const glint_scene *scene);
glint_overlay *glint_scene_overlay_at(const glint_scene *scene, size_t index);
/// Takes another reference to an overlay; returns its argument.
glint_overlay *glint_overlay_retain(glint_overlay *overlay);
/// Releases a reference; the last one frees the overlay. NULL: nothing.
void glint_overlay_release(glint_overlay *overlay);
/// Writes the name of the light pass that light number `index` < the count belongs to: see glint_render_desc.
void glint_scene_light_pass(const glint_scene *scene, size_t index, char name[GLINT_NAME_SIZE]);

// ---- Camera --------------------------------------------------------------------------------------------------------

/// Rays through one point (perspective) or parallel rays (orthographic).
typedef enum glint_projection { GLINT_PROJECTION_PERSPECTIVE, GLINT_PROJECTION_ORTHOGRAPHIC } glint_projection;

/// The fields of a camera; lengths in world units.
typedef struct glint_camera_desc {
    size_t struct_size; ///< sizeof(glint_camera_desc)
    glint_projection projection; ///< default GLINT_PROJECTION_PERSPECTIVE
    double eye[3]; ///< world units, finite; default {0, 0, 10}
    bool has_direction; ///< true: looks along `direction`; false: looks at the point `at`
    /// Finite; `at` differs from `eye`, `direction` is not zero; defaults: the origin, {0, 0, -1}
    double at[3], direction[3];
    /// Default {0,1,0}; not zero. If parallel to the view, the world axis least aligned with the view replaces it
    double up[3];
    double fov_y_rad; ///< vertical field of view of a perspective camera, in (0, pi); default 40 degrees
    /// Focal lengths of a perspective camera in pixels, horizontal and vertical, > 0, instead of `fov_y_rad`. 0, the
    /// default: not given; `fy` 0: same as `fx`
    double fx, fy;
    /// The principal point, where the optical axis meets the picture: pixels from its left and upper edges; the
    /// centre of the first pixel is 0.5. Finite; default: the centre of the picture
    bool has_cx, has_cy;
    double cx, cy;
    double w, h; ///< the picture size that fx, fy, cx and cy refer to; other sizes scale them. 0, the default: they
        ///< hold for every size
    double height; ///< vertical extent of an orthographic camera, world units, > 0; default 10
    double pixel_offset; ///< position of the sample in its pixel if there is only one, 0 .. 1; default 0.5, the centre
    /// Time that the shutter is open, as a fraction of the time between frames, 0 .. 1; default 0, an instant. Used
    /// by callers that plan a frame for several times, see glint_plan_create_exposed
    double shutter;
    int64_t shutter_times; ///< number of times at which the scene is planned while the shutter is open,
        ///< 1 .. GLINT_SHUTTER_TIMES_MAX; default 8
    /// Radius of the lens, world units, >= 0; default 0: a pinhole, which shows everything sharp. Each sample starts
    /// at a point of the lens, in the plane through the eye perpendicular to the view, and passes through the point
    /// where the pinhole's ray crosses the plane of focus. At depth d, a point is blurred over a disk of diameter
    /// 2 aperture |1 - d / focus|. An orthographic camera has a lens for each ray. Many samples make the blur smooth.
    double aperture;
    /// Distance of the plane of focus along the view, > 0; default 0: given by `focus_point`, or else by `at`
    double focus;
    bool has_focus_point; ///< true: the plane of focus goes through `focus_point`; `focus` must be 0
    double focus_point[3]; ///< finite, in front of the eye
    /// 0: a round lens, the default; 3 .. 64: a regular polygon inscribed in that circle, a corner up
    int64_t blades;
    double blade_rotation_rad; ///< turns the polygon, counter-clockwise as seen by the eye; default 0
    char name[GLINT_NAME_SIZE]; ///< name for messages; "": none
} glint_camera_desc;
#define GLINT_SHUTTER_TIMES_MAX 1024

/// Describes a perspective camera at (0, 0, 10) that looks at the origin, with every field at its default.
void glint_camera_desc_init(glint_camera_desc *desc, size_t size);
GLINT_DESC_DEFAULT(camera);
/// Makes a camera from a copy of `desc`. GLINT_ERR_INVALID names the field that is out of range; GLINT_ERR_NOMEM.
glint_status glint_camera_create(const glint_camera_desc *desc, glint_camera **out, glint_error *error);
/// Replaces the whole description by a copy of `desc`; on error nothing changes.
glint_status glint_camera_set(glint_camera *camera, const glint_camera_desc *desc, glint_error *error);
/// Returns the description; borrowed, valid until the camera is set or released.
const glint_camera_desc *glint_camera_get(const glint_camera *camera);
/// Computes the view window of a picture of width x height pixels at distance 1: window[0] .. window[1] to the right
/// and window[2] .. window[3] up, world units. For an orthographic camera the window is the same at every distance.
void glint_camera_window(const glint_camera_desc *desc, double width, double height, double window[4]);
/// Computes the world point at a position in a picture of width x height pixels, at a distance from the eye along the
/// view. It is the inverse of glint_camera_project.
///   pixel   to the right and down from the picture's upper left corner.
void glint_camera_point(const glint_camera_desc *desc, double width, double height, const double pixel[2], double distance,
                        double point[3]);
/// Projects a world point into a picture of width x height pixels; occluders are ignored.
///   pixel   to the right and down from the picture's upper left corner; the centre of the first pixel is 0.5, 0.5
///   depth   as in the pass `depth`: the distance from the eye; for an orthographic camera, the distance along the view
/// Returns false and stores nothing if the point is not in front of the camera.
bool glint_camera_project(const glint_camera_desc *desc, double width, double height, const double point[3], double pixel[2],
                          double *depth);
/// Takes another reference; returns its argument.
glint_camera *glint_camera_retain(glint_camera *camera);
/// Releases a reference; the last one frees the camera. NULL: nothing.
void glint_camera_release(glint_camera *camera);

// ---- Lights --------------------------------------------------------------------------------------------------------

/// The shape of a light. Area lights (disk, polygon, sphere) cast soft shadows.
typedef enum glint_light_kind {
    GLINT_LIGHT_POINT, ///< shines equally in all directions from `position`
    GLINT_LIGHT_DIRECTIONAL, ///< parallel light along `direction`
    GLINT_LIGHT_SPOT, ///< a point light restricted to a cone
    GLINT_LIGHT_DISK, ///< the first of the area lights, which take `samples` points on their surface, different ones
        ///< for each pixel of a 4 x 4 block
    GLINT_LIGHT_POLYGON, ///< convex, flat; shines on one side unless `two_sided`
    GLINT_LIGHT_SPHERE ///< the surface of a ball
} glint_light_kind;

#define GLINT_CORNERS_MAX 4096 ///< most corners of a polygon light

/// How a light's shadows are computed.
typedef enum glint_shadow {
    GLINT_SHADOW_RAYS, ///< one ray to each sample of the light
    GLINT_SHADOW_HARD, ///< area lights: one ray to the centre of the light, for all of its samples
    GLINT_SHADOW_CAPS ///< sphere lights: the share of the light's apparent disk that is covered by spheres, computed
        ///< in closed form
} glint_shadow;

/// The fields of a light. Each kind reads the fields whose comment names it, and those whose comment names no kind.
typedef struct glint_light_desc {
    size_t struct_size; ///< sizeof(glint_light_desc)
    glint_light_kind kind; ///< kind of the light; glint_light_set cannot change it
    double color[3]; ///< default 1; finite, >= 0
    double intensity; ///< default 1; finite, >= 0; multiplies each of the three terms
    bool has_diffuse, has_specular; ///< false: the term's colour is `color`
    double ambient[3]; ///< default 0; neither attenuated nor shadowed
    double diffuse[3], specular[3]; ///< light colours for these two terms; finite, >= 0; default `color`
    double attenuation[3]; ///< c0, c1, c2 of A = 1/(c0 + c1 d + c2 d^2); >= 0, not all 0; default {1, 0, 0}
    bool shadows; ///< default true
    /// Area lights; default GLINT_SHADOW_RAYS. Caps are free of noise: the light's terms are computed for a point
    /// light at the centre and multiplied by the visible share of the light. With `radiance` L the irradiance is pi L
    /// r^2/d^2 (n.l), which is exact above the horizon. The share is exact with one sphere as occluder. With several
    /// it is the product of their shares, while the true share lies between 1 - the sum of the covered shares and the
    /// smallest visible share. Planes, and spheres that intersect the light, cover a share of its diameter. Scenes
    /// with other or transparent shapes use rays: see the effects of the plan
    glint_shadow shadow;
    /// Eye, mirror and glass rays see the light's surface, on the sides that shine; default false. With `radiance` L
    /// it shows pi L color: pixel values are pi times radiance, as for the background. With `intensity` I it shows
    /// color I A(D), where D is the light's radius (for a polygon, the radius of a disk of the same area). A visible
    /// light casts no shadow and is not an object: in the passes it is background with a depth and a normal. Lights
    /// without a surface ignore this field
    bool visible;
    double position[3]; ///< point and spot light; disk and sphere light: the centre
    double direction[3]; ///< directional and spot light: the direction of travel; not zero, need not be unit
    double inner_rad, outer_rad; ///< spot: half angles, 0 <= inner <= outer <= pi: full light inside, none outside,
        ///< smoothstep of the cosine between; default 20 and 30 degrees
    double exponent; ///< spot: the light is multiplied by cos^exponent of the angle to the axis; >= 0, default 0
    double normal[3]; ///< disk: normal on the side that emits light; not zero, need not be unit; default {0, -1, 0}
    double radius; ///< disk and sphere: >= 0, 0 is a point; with `radiance` 0 or 1e-150 .. 1e150; default 1
    /// Polygon: its corners, convex and in one plane, 3 .. GLINT_CORNERS_MAX; copied. It shines on the side from
    /// which they run counter-clockwise
    const double (*vertices)[3];
    size_t vertex_count;
    bool two_sided; ///< polygon: shines on both sides; default false
    int64_t samples; ///< area lights: number of shadow rays for each sample of a pixel; 1 .. 65536; default 16
    bool has_radiance; ///< area lights: `radiance` gives the strength, and `intensity` must be 1; false: it is ignored
    /// Name of the light pass that collects this group's lights; "": the light's own name
    char group[GLINT_NAME_SIZE];
    /// >= 0: the light adds kd times the integral of radiance cos cos' / distance^2 over its surface. With `intensity`,
    /// it adds the mean light of point lights spread over its surface
    double radiance;
    char name[GLINT_NAME_SIZE];
} glint_light_desc;

/// Writes a description with every field at the default for this kind.
void glint_light_desc_init(glint_light_desc *desc, size_t size, glint_light_kind kind);
GLINT_DESC_DEFAULT_OF(light);
/// Makes a light from a copy of `desc`. GLINT_ERR_INVALID names the field that is out of range; GLINT_ERR_NOMEM.
glint_status glint_light_create(const glint_light_desc *desc, glint_light **out, glint_error *error);
/// Replaces the description by a copy; on error nothing changes. `desc->kind` must be the light's kind.
glint_status glint_light_set(glint_light *light, const glint_light_desc *desc, glint_error *error);
/// Returns the description; borrowed, with its `vertices`, until the light is set or released.
const glint_light_desc *glint_light_get(const glint_light *light);
/// Takes another reference; returns its argument.
glint_light *glint_light_retain(glint_light *light);
/// Releases a reference; the last one frees the light. NULL: nothing.
void glint_light_release(glint_light *light);

// ---- Materials -----------------------------------------------------------------------------------------------------

/// The specular term S of one light. Unit vectors: n, the normal facing the viewer; l, towards the light; v, towards
/// the eye.
typedef enum glint_model {
    GLINT_MODEL_PHONG, ///< S = max(0, r.v)^shininess, r = 2(n.l)n - l
    GLINT_MODEL_BLINN_PHONG, ///< S = max(0, n.h)^shininess, h = (l + v)/|l + v|
    GLINT_MODEL_LAMBERT, ///< no specular term
    GLINT_MODEL_COOK_TORRANCE ///< S = pi D F G / (4 n.v): microfacets; F is Schlick's, from f0 or ior
} glint_model;

/// The distribution of microfacet slopes, with width alpha = roughness^2. G is Smith's, height-correlated (E. Heitz,
/// "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014; for Beckmann by the fit
/// of B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007).
typedef enum glint_distribution { GLINT_DISTRIBUTION_GGX, GLINT_DISTRIBUTION_BECKMANN } glint_distribution;

/// The meaning of an opacity between 0 and 1. In every mode a surface of opacity 0 is invisible and one of opacity 1
/// is opaque.
typedef enum glint_opacity_mode {
    GLINT_OPACITY_AUTO, ///< a number blends, a pattern cuts
    GLINT_OPACITY_CUT, ///< where the opacity is below 0.5 or NaN, the surface is absent for all rays of a frame;
        ///< elsewhere it is opaque. Objects behind a hole look as they do without the surface
    /// The light that the surface gives, including mirrored, refracted and indirect light, is multiplied by the
    /// opacity o. Eye, mirror, glass and indirect rays also continue straight on with weight 1 - o, and shadow rays
    /// pass with weight 1 - o. Each surface counts: a ray through a closed ball crosses two surfaces and keeps
    /// (1 - o)^2.
    GLINT_OPACITY_BLEND
} glint_opacity_mode;

/// Programs that replace a material's numbers; NULL: the number is used. A material retains its programs. A pattern
/// result that is NaN or below 0 becomes 0, and one above 2^100 becomes 2^100; both are counted in glint_frame_stats.
/// A program whose outputs are numbers is replaced by them, and glint_material_get returns them, except that an
/// opacity between 0 and 1 stays a pattern.
typedef struct glint_material_programs {
    glint_program *diffuse, *ambient, *specular, *mirror, *transmission; ///< patterns of a colour, or of one number
        ///< for a grey; `ambient` follows the pattern of `diffuse` until `ambient` is set or has a pattern of its own
    glint_program *shininess, *roughness; ///< patterns of one number; `roughness` above 1 counts as 1
    /// Pattern of one number, the height above the surface in world units. Lighting, reflection and refraction use
    /// the normal unit(n - (g - (g.n) n)), where g is the gradient of the height with respect to `p` and `world`. A
    /// point is lit only if n.l > 0 for the unperturbed n as well
    glint_program *bump;
    glint_program *opacity; ///< pattern of one number; see glint_opacity_mode
    glint_program *shader; ///< replaces `model`. The program computes the diffuse term of each light and, if it has
        ///< six outputs, also the specular term
} glint_material_programs;

/// The fields of a material. Reflectances are fractions of light, in linear RGB.
typedef struct glint_material_desc {
    size_t struct_size; ///< sizeof(glint_material_desc)
    glint_model model; ///< default phong
    bool has_ambient; ///< false: `ambient` follows `diffuse`
    double ambient[3]; ///< reflectance: finite, >= 0; above 1 the surface gives off more light than it receives
    double diffuse[3]; ///< default 0.8
    bool has_specular; ///< cook_torrance: false means that `specular` is 1. The other models do not read the flag
    double specular[3]; ///< default 0
    double shininess; ///< exponent, finite, >= 0; default 32. 0 gives S = 1 wherever r.v > 0
    bool has_mirror; ///< false: `mirror` is ignored; it is 1 with `fresnel` or cook_torrance, otherwise 0
    /// Fraction of the light along the mirrored ray that is added; >= 0, default 0. cook_torrance: factor of the light
    /// that the facets reflect from everything but the lamps, whose highlights are `specular`; default 1
    double mirror[3];
    /// Fraction of the light along the refracted ray that is added; >= 0, default 0. It also tints the object's
    /// shadow, once for each surface that the light crosses. A totally reflected ray crosses no surface and keeps
    /// max(mirror, 1) of its light
    double transmission[3];
    double ior; ///< refractive index inside, > 0; default 1.5. Outside it is 1, or the index of the enclosing object
    /// Multiplies `mirror` by a dielectric's Fresnel reflectance R, `transmission` by 1 - R; default false
    bool fresnel;
    double absorption[3]; ///< absorption coefficient inside, per world unit, >= 0; default 0: light is multiplied by
        ///< exp(-absorption distance)
    /// Energy-conserving normalisation. phong: S = (s + 2)/2 (r.v)^s (n.l) (E. Lafortune and Y. Willems 1994);
    /// blinn_phong: S = (s + 2)(s + 4)/(8 (2^(-s/2) + s)) (n.h)^s (n.l) (F. Giesen, "Phong and Blinn-Phong
    /// normalization factors", 2009). Both are reciprocal. Other models ignore it
    bool normalized;
    /// blinn_phong: the exponent is 4 s, which gives the highlight closest to Phong's. Other models ignore it
    bool matched;
    /// false: models other than cook_torrance are smooth. cook_torrance always reads `roughness`
    bool has_roughness;
    /// 0 .. 1, default 0.3. cook_torrance: below 1e-9 it counts as 1e-9: a highlight narrower than any pixel. Other models: 0 is a
    /// smooth mirror or smooth glass; above, reflected and refracted rays have the distribution of microfacets, as
    /// with cook_torrance
    double roughness;
    glint_distribution distribution; ///< default GGX
    // cook_torrance:
    bool has_f0; ///< false: f0 = ((ior - 1) / (ior + 1))^2
    double f0[3]; ///< reflectance at normal incidence, 0 .. 1; coloured for metals
    double opacity; ///< 0 .. 1, default 1; see glint_opacity_mode. glint_scene_cast hits the surface at any opacity
    glint_opacity_mode opacity_mode; ///< default auto
    glint_material_programs program;
    char name[GLINT_NAME_SIZE];
} glint_material_desc;

/// Writes a description with every field at its default.
void glint_material_desc_init(glint_material_desc *desc, size_t size);
GLINT_DESC_DEFAULT(material);
/// Writes `ambient`, `specular`, `f0` and `mirror` if they follow other fields, and marks them as set.
void glint_material_desc_resolve(glint_material_desc *desc);
/// Makes a material from a copy of `desc`. GLINT_ERR_INVALID names the field that is out of range; GLINT_ERR_NOMEM.
glint_status glint_material_create(const glint_material_desc *desc, glint_material **out, glint_error *error);
/// Replaces the whole description by a copy of `desc`; existing plans keep the old one. On error nothing changes.
glint_status glint_material_set(glint_material *material, const glint_material_desc *desc, glint_error *error);
/// Returns the description; borrowed, valid until the material is set or released.
const glint_material_desc *glint_material_get(const glint_material *material);
/// Takes another reference; returns its argument.
glint_material *glint_material_retain(glint_material *material);
/// Releases a reference; the last one frees the material. NULL: nothing.
void glint_material_release(glint_material *material);

// ---- Shapes --------------------------------------------------------------------------------------------------------

/// The kind of a shape. It determines which fields of the description are used.
typedef enum glint_shape_kind {
    GLINT_SHAPE_SPHERE, ///< `center`, `radius`
    GLINT_SHAPE_PLANE, ///< `point`, `normal`; infinite
    GLINT_SHAPE_SPHERES, ///< made by glint_spheres_create
    GLINT_SHAPE_MESH, ///< made by the mesh functions
    GLINT_SHAPE_BOX, ///< `min`, `max`
    GLINT_SHAPE_DISK, ///< `center`, `normal`, `radius`
    GLINT_SHAPE_CYLINDER, ///< `base`, `top`, `radius`
    GLINT_SHAPE_CONE, ///< `base`, `top`, the apex, `radius` at the base
    GLINT_SHAPE_TORUS, ///< `center`, `axis`, `major`, `minor`
    GLINT_SHAPE_CYLINDERS, ///< made by glint_cylinders_create or glint_bonds_create; `capped`
    GLINT_SHAPE_GROUP, ///< a group of shapes; see glint_group_add
    GLINT_SHAPE_UNION, ///< a solid composed of parts: the points inside any of them; see glint_group_add
    GLINT_SHAPE_INTERSECTION, ///< the points inside all parts
    GLINT_SHAPE_DIFFERENCE ///< the points inside the first part and outside all others
} glint_shape_kind;

/// An affine map from (x, y, z) to out: out_i = m[i][0] x + m[i][1] y + m[i][2] z + m[i][3].
typedef struct glint_transform {
    double m[3][4]; ///< the last column is the translation, world units
} glint_transform;

/// Returns the identity.
glint_transform glint_transform_identity(void);
/// Returns the map that applies first `inner`, then `outer`.
glint_transform glint_transform_product(const glint_transform *outer, const glint_transform *inner);
/// Returns a translation by `by`, world units.
glint_transform glint_transform_translate(const double by[3]);
/// Returns the map that multiplies x, y and z by the three factors; negative ones mirror. Shapes refuse a factor of
/// 0.
glint_transform glint_transform_scale(const double by[3]);
/// Returns a rotation, counter-clockwise when the axis points at the eye. The axis is not zero and need not be unit;
/// quarter turns are exact.
glint_transform glint_transform_rotate_deg(const double axis[3], double degrees);

/// The points and normals at which the lighting of a mesh is computed. With flat and gouraud, the light on a face is
/// the same for all viewers: a mirror shows the highlights as the eye sees them directly.
typedef enum glint_shading {
    GLINT_SHADING_FACETED, ///< at each sample, with the normal of its face
    /// At each sample, with the normal interpolated between the corners in the mesh's own space, so that a transform
    /// moves normals as it moves faces. Only the faces decide hits and shadows: a face that looks away from a light
    /// is dark up to its edge, whatever its normals; see glint_mesh_bend
    GLINT_SHADING_PHONG,
    GLINT_SHADING_FLAT, ///< once per face, at its centroid, with its normal
    GLINT_SHADING_GOURAUD ///< once per vertex, interpolated by barycentric coordinates over triangles
} glint_shading;

/// The fields of a shape. Each kind reads the fields whose comment names it, and those whose comment names no kind.
/// Lengths in world units.
typedef struct glint_shape_desc {
    size_t struct_size; ///< sizeof(glint_shape_desc)
    glint_shape_kind kind; ///< kind of the shape; glint_shape_create makes all kinds except spheres, meshes and cylinders
    /// Retained by the shape. NULL: a material with default fields; for a part of a combined solid, the solid's
    /// material; for the solid, the material of its first part that has one. A group has none
    glint_material *material;
    /// From the shape's own space to its group or the world; default identity; must be invertible
    glint_transform transform;
    bool two_sided; ///< default true: the normal is turned to the viewer; false: back faces get ambient light only
    /// Sphere, disk (also radius of cylinder and cone, center of torus): finite, radius > 0; see glint_scene_cast
    double center[3], radius;
    double point[3], normal[3]; ///< plane (and disk: normal): finite, normal not zero, need not be unit
    double min[3], max[3]; ///< box: finite, min < max; default -1, 1
    double base[3], top[3]; ///< cylinder, cone: the centres of its ends, which differ; the cone's top is its apex
    bool capped; ///< cylinder: closed at both ends; cone: closed at its base; default true. False: only the curved
        ///< side, which is visible from inside, too. The shape then has no inside: rays refract as at a solid without
        ///< end
    double axis[3]; ///< torus: not zero, need not be unit; default {0, 1, 0}
    double major, minor; ///< torus: radius of the circle in the middle of the tube, and radius of the tube;
        ///< 0 < minor < major, so that the tube does not intersect itself; default 1, 0.25
    glint_shading shading; ///< mesh
    double terminator; ///< mesh: see glint_mesh_desc
    char name[GLINT_NAME_SIZE];
} glint_shape_desc;

/// Writes a description with every field at the default for this kind.
void glint_shape_desc_init(glint_shape_desc *desc, size_t size, glint_shape_kind kind);
GLINT_DESC_DEFAULT_OF(shape);
/// Makes a shape from a copy of `desc` and retains its material. GLINT_ERR_INVALID names the field; GLINT_ERR_NOMEM.
glint_status glint_shape_create(const glint_shape_desc *desc, glint_shape **out, glint_error *error);
/// Replaces the description by a copy of the same kind; on error nothing changes.
glint_status glint_shape_set(glint_shape *shape, const glint_shape_desc *desc, glint_error *error);
/// Returns the description; borrowed. Many spheres or cylinders, meshes, groups and combined solids define only some
/// fields: kind, transform and name; all but groups two_sided and material, the first one, which setting replaces;
/// cylinders `capped`; meshes `shading` and `terminator`.
const glint_shape_desc *glint_shape_get(const glint_shape *shape);
/// Takes another reference; returns its argument.
glint_shape *glint_shape_retain(glint_shape *shape);
/// Releases a reference; the last one frees the shape and releases what it retains. NULL: nothing.
void glint_shape_release(glint_shape *shape);

/// Returns the number of materials of a shape, 1 for most shapes, and writes their list, owned by the shape.
size_t glint_shape_materials(const glint_shape *shape, glint_material *const **list);

/// Computes a box around all spheres, cylinders or vertices of a GLINT_SHAPE_SPHERES, GLINT_SHAPE_CYLINDERS or
/// GLINT_SHAPE_MESH shape, before its transform. Returns false and leaves the box unchanged for other kinds, whose description gives their position.
bool glint_shape_bounds(const glint_shape *shape, double lower[3], double upper[3]);

#define GLINT_GROUP_DEPTH 64 ///< largest depth of nested groups and combined solids

// Combined solids. Parts are spheres, boxes, capped cylinders and cones, tori, planes (half-spaces, inside is the
// side opposite to the normal), closed meshes, other combined solids, and groups, which stand for the union of their
// shapes. A solid has at most 64 parts; a torus counts as two, a mesh as four.
//
// A mesh is closed if each edge is used by as many triangles in one direction as in the other; corners at the same
// position count as one. Its shading is faceted or phong. A point is inside if a path from it leaves the mesh more
// often than it enters. A mesh of negative volume is turned inside out first.
//
// A combined solid is one object. A part is visible only where it bounds the solid, and has its own material there, in
// its own space. Light that enters through any part is in one medium, with `ior` and `absorption` of the solid's
// material. `two_sided` of parts is ignored. Coincident faces enclose nothing: a box minus a box that ends at the
// same face is open there. Where several parts bound the solid at the same place, the first defined is visible.

/// Adds a shape to a group or combined solid, which retains it. The shape may also be in other groups and scenes: it
/// appears in each, under all transforms around it, and a change to it shows everywhere. Refused: a group inside
/// itself, the same shape twice, and in a combined solid a shape without an inside. The message then names an open
/// edge of a mesh.
glint_status glint_group_add(glint_shape *group, glint_shape *child, glint_error *error);
/// Removes the shape from the group or combined solid and releases it. GLINT_ERR_INVALID if the shape is not in it.
glint_status glint_group_remove(glint_shape *group, glint_shape *child, glint_error *error);
/// Returns the number of shapes directly in the group or combined solid, not counting those in nested groups.
size_t glint_group_count(const glint_shape *group);
glint_shape *glint_group_child(const glint_shape *group, size_t index); ///< borrowed

/// Many spheres in one shape, given as one array.
typedef struct glint_spheres_desc {
    size_t struct_size; ///< sizeof(glint_spheres_desc)
    const void *data; ///< count times x, y, z, radius; any alignment; copied
    size_t count; ///< 1 .. 2^30
    bool is_float; ///< true: `data` is binary32, false: binary64; native byte order
    glint_material *const *materials; ///< materials, retained; NULL entries are not allowed
    size_t material_count; ///< number of materials; 0: one material with default fields
    /// Material of each sphere: `count` numbers < material_count, copied; NULL: all are 0
    const uint32_t *material_index;
    bool two_sided; ///< default true: the normal is turned to the viewer
    char name[GLINT_NAME_SIZE]; ///< name for messages; "": none
} glint_spheres_desc;

/// Makes spheres. A message names the first invalid sphere, counted from 1: "data: sphere 12: radius > 0 expected,
/// got -1".
glint_status glint_spheres_create(const glint_spheres_desc *desc, glint_shape **out, glint_error *error);
/// Returns the numbers of all spheres or cylinders, 4 or 7 each; owned by the shape. NULL for other kinds.
const double *glint_spheres_data(const glint_shape *shape);
/// Returns the material of each sphere, cylinder or triangle, from 0; owned by the shape. NULL: all have the first.
const uint32_t *glint_spheres_index(const glint_shape *shape);
/// Makes cylinders from the same description: `data` is count times base, top and radius, 7 numbers. They are capped
/// until glint_shape_set changes it. Messages name the first invalid cylinder as glint_spheres_create does.
glint_status glint_cylinders_create(const glint_spheres_desc *desc, glint_shape **out, glint_error *error);

/// Number of spheres or cylinders; of triangles for a mesh; 1 for other shapes
size_t glint_spheres_count(const glint_shape *shape);

/// Polygons with shared vertices. A face of more than three corners is cut into triangles: as a fan from its first
/// corner, or by ear clipping if the fan would leave the polygon. The front is the side from which corners run
/// counter-clockwise.
typedef struct glint_mesh_desc {
    size_t struct_size; ///< sizeof(glint_mesh_desc)
    const double *vertices; ///< x, y, z of each vertex; finite; copied, like all arrays here
    size_t vertex_count; ///< number of vertices, 3 .. 2^31 - 2
    const uint32_t *corners; ///< indices of vertices, from 0, face after face
    const uint32_t *face_sizes; ///< number of corners of each face, 3 or more
    size_t face_count; ///< number of faces, 1 .. 2^31 - 2; the same limit holds for the number of triangles
    const double *normals; ///< x, y, z of each normal; finite, not zero, need not be unit; NULL: none
    size_t normal_count; ///< number of normals; 0 without `normals`
    /// Index of a normal, from 0, for each entry of `corners`; GLINT_NO_NORMAL: none there. NULL: each vertex has one
    /// normal, in order
    const uint32_t *normal_corners;
    const double *uv; ///< texture coordinates, u and v of each pair; finite; NULL: none
    size_t uv_count; ///< number of u, v pairs; 0 without `uv`
    /// Index of a u, v pair, from 0, for each entry of `corners`; GLINT_NO_UV: none there, and no program may read
    /// the coordinates of this mesh. NULL: each vertex has one pair, in order
    const uint32_t *uv_corners;
    bool has_shading; ///< false: phong if there are normals, otherwise faceted
    /// Phong and gouraud without normals: the normals of the faces around a vertex are averaged, weighted by area
    glint_shading shading;
    /// 0 (default) .. 1: share of the distance by which points P of a phong mesh move outwards, before light and shadow are
    /// computed: the mean over its corners v of -min(0, (P - v) . n) n, weighted as at P, with the normals n on the viewer's
    /// side (J. Hanika, Ray Tracing Gems II, 2021). Refused by frames if a material of the mesh transmits light
    double terminator;
    glint_material *material; ///< material of all faces, retained; NULL: `materials`, the file's materials, or one
        ///< material with default fields
    /// Materials of individual faces: retained, instead of `material`; no NULL entries
    glint_material *const *materials;
    size_t material_count; ///< number of `materials`; 0: all faces have `material`
    /// Material of each face: face_count numbers < material_count, copied; NULL: all are 0
    const uint32_t *material_index;
    glint_transform transform; ///< default identity
    bool two_sided;
    char name[GLINT_NAME_SIZE];
    /// called by glint_mesh_load before a file is opened; NULL: not called
    void (*reads)(void *context, const char *path);
    /// called by glint_mesh_load when something in the file is ignored; the message names the file; NULL: not called
    void (*warns)(void *context, const char *message);
    void *context; ///< passed to both functions as `context`
} glint_mesh_desc;

#define GLINT_NO_NORMAL 0xffffffffu
#define GLINT_NO_UV 0xffffffffu

/// Writes the defaults: no faces, two-sided, identity transform.
void glint_mesh_desc_init(glint_mesh_desc *desc, size_t size);
GLINT_DESC_DEFAULT(mesh);
/// Makes a mesh. A message names the first invalid face and vertex, counted from 1: "faces[3]: vertex 1 .. 8
/// expected, got 9", "faces[3]: a face with an area expected: its vertices 1, 2, 3 are on one line". A triangle
/// without area inside a larger face is left out.
glint_status glint_mesh_create(const glint_mesh_desc *desc, glint_shape **out, glint_error *error);

/// Counts of faces that had to be left out or changed.
typedef struct glint_mesh_faults {
    size_t flat; ///< faces without an area, which are left out
    size_t crossed; ///< polygons that cross themselves, which are cut as fans
} glint_mesh_faults;

/// Makes a mesh of the usable faces, and counts the others instead of failing.
glint_status glint_mesh_create_counting(const glint_mesh_desc *desc, glint_mesh_faults *faults, glint_shape **out,
                                        glint_error *error);
/// Makes a sphere of `segments`, 3 .. 16384, around the equator and half as many, rounded up, from pole
/// to pole. The vertices have the sphere's exact normals. `desc` gives shading (default phong), material, sides and
/// name.
glint_status glint_sphere_mesh_create(const double center[3], double radius, int64_t segments,
                                      const glint_mesh_desc *desc, glint_shape **out, glint_error *error);

// ---- A frame -------------------------------------------------------------------------------------------------------

/// The arithmetic that decides hits, their order and shadows: binary64, or binary32 to show the errors that it
/// causes.
typedef enum glint_precision { GLINT_PRECISION_DOUBLE, GLINT_PRECISION_FLOAT } glint_precision;

/// How visible surfaces are found. The pictures are identical bit by bit, except where rays lie in the plane of a
/// triangle, so that rounding decides its edges: about one pixel in some thousand pictures taken from such planes.
typedef enum glint_visibility {
    GLINT_VISIBILITY_AUTO, ///< chooses the method that is likely to be faster
    GLINT_VISIBILITY_CAST, ///< casts a ray through each sample
    GLINT_VISIBILITY_SCAN ///< projects triangles; casts rays at other shapes
} glint_visibility;

/// The values stored for a pixel, as linear float32. Light is the mean over the samples.
typedef enum glint_pass {
    /// (((((background + ambient) + diffuse) + specular) + indirect) + mirror) + transmission, in float32
    GLINT_PASS_BEAUTY,
    GLINT_PASS_BACKGROUND, ///< light of samples that hit nothing, and the light that the colour of the depth cue adds
    GLINT_PASS_AMBIENT, ///< ambient terms
    GLINT_PASS_DIFFUSE, ///< diffuse terms of all lights
    GLINT_PASS_SPECULAR, ///< specular terms of all lights
    GLINT_PASS_INDIRECT, ///< diffuse light from other surfaces
    GLINT_PASS_MIRROR, ///< mirror times the light along mirrored rays
    GLINT_PASS_TRANSMISSION, ///< transmission times the light along refracted rays
    GLINT_PASS_DEPTH, ///< one channel: distance from the eye, +inf where nothing is hit; at the pixel's centre
    GLINT_PASS_NORMAL, ///< shading normal facing the eye, 0 where nothing is hit; at the pixel's centre
    GLINT_PASS_OBJECT_ID, ///< one channel: 1.. in order of definition, 0 where nothing is hit; at the pixel's centre
    GLINT_PASS_ALPHA, ///< one channel, 0 .. 1: the share of the samples that hit something. A sample that reaches the
        ///< background through glass or translucent surfaces, without a reflection, counts as 1 - the mean of its
        ///< weights in the three channels
    GLINT_PASS_OUTLINE, ///< one channel: 1 at silhouettes, at borders between objects and at edges of objects, else
        ///< 0; at the pixel's centre
    GLINT_PASS_REFINED, ///< one channel: 1 where `adaptive` took all samples, else 0; without `adaptive` 1 everywhere
    GLINT_PASS_ALBEDO, ///< diffuse reflectance plus what is mirrored and transmitted at normal incidence, at most 1; 0
        ///< where nothing is hit; at the pixel's centre
    GLINT_PASS_COUNT, ///< number of passes
    /// The first derivative of the frame, see glint_render_desc; the others follow it. Three channels
    GLINT_PASS_DERIVATIVE = GLINT_PASS_COUNT,
    /// The first light pass of the frame, see glint_render_desc; the others follow it. Three channels
    GLINT_PASS_LIGHT = GLINT_PASS_DERIVATIVE + GLINT_DERIVATIVES_MAX
} glint_pass;

/// The passes in the order of glint_pass: PASS(ID, name, channels, LOOK) for each one. The look is how a picture shows
/// the pass: LIGHT by the tone curve, SHARE as grey from 0 to 1, DEPTH, NORMAL and OBJECT as bindings/README.md says.
#define GLINT_PASSES(PASS) \
    PASS(BEAUTY, "beauty", 3, LIGHT) \
    PASS(BACKGROUND, "background", 3, LIGHT) \
    PASS(AMBIENT, "ambient", 3, LIGHT) \
    PASS(DIFFUSE, "diffuse", 3, LIGHT) \
    PASS(SPECULAR, "specular", 3, LIGHT) \
    PASS(INDIRECT, "indirect", 3, LIGHT) \
    PASS(MIRROR, "mirror", 3, LIGHT) \
    PASS(TRANSMISSION, "transmission", 3, LIGHT) \
    PASS(DEPTH, "depth", 1, DEPTH) \
    PASS(NORMAL, "normal", 3, NORMAL) \
    PASS(OBJECT_ID, "object_id", 1, OBJECT) \
    PASS(ALPHA, "alpha", 1, SHARE) \
    PASS(OUTLINE, "outline", 1, SHARE) \
    PASS(REFINED, "refined", 1, SHARE) \
    PASS(ALBEDO, "albedo", 3, LIGHT)

/// Returns "beauty", "background", ...; NULL if out of range.
const char *glint_pass_name(glint_pass pass);
/// Returns the pass of that name; GLINT_PASS_COUNT if there is none.
glint_pass glint_pass_from_name(const char *name);
int glint_pass_channels(glint_pass pass); ///< 1 or 3

/// The encoding of light as integer pixel values.
typedef enum glint_transfer {
    GLINT_TRANSFER_SRGB, ///< IEC 61966-2-1:1999
    GLINT_TRANSFER_LINEAR, ///< pixel values are linear, and the file says so (gAMA): viewers brighten them
    GLINT_TRANSFER_NONE ///< pixel values are linear, but the file does not say so: viewers take them for sRGB
} glint_transfer;
/// The rounding of pixel values to integers.
typedef enum glint_rounding { GLINT_ROUNDING_NEAREST, GLINT_ROUNDING_TRUNCATE } glint_rounding;

/// The tone curve, applied to each channel separately. x is the light after exposure, the result is 0 .. 1.
typedef enum glint_tone_curve {
    GLINT_TONE_CLAMP, ///< min(x, 1)
    GLINT_TONE_REINHARD, ///< x / (1 + x): Reinhard, Stark, Shirley and Ferwerda 2002, equation 3. Nothing is clipped
    /// h(2 x) / h(11.2), where h is Hable's curve of "Uncharted 2" (Filmic Games, 2010): white from 5.6 on
    GLINT_TONE_FILMIC
} glint_tone_curve;

#define GLINT_EXPOSURE_MAX 32 ///< largest exposure in stops, in both directions

/// The conversion of linear light to integer pixel values, 0 .. M: exposure, curve, transfer, rounding. NaN and
/// negative values become 0; values above the range become M.
typedef struct glint_tone_desc {
    glint_tone_curve curve; ///< default clamp
    glint_transfer transfer; ///< default sRGB, IEC 61966-2-1:1999
    glint_rounding rounding; ///< default nearest: floor(x M + 0.5); truncate: floor(x M)
    int bits; ///< 8 (default) or 16: M = 255 or 65535
    double exposure; ///< stops: light is multiplied by 2^exposure first, in float; default 0
    /// With 8 bits: floor(x M + t) instead of `rounding`; t by B. E. Bayer's matrix (ICC 1973) of 8 x 8 pixels of the frame
    bool dither;
} glint_tone_desc;

/// Returns the defaults: clamp, sRGB, nearest, 8 bits, no exposure, no dithering.
glint_tone_desc glint_tone_desc_default(void);
/// Writes the smallest float of light, after exposure, that a valid tone maps to each of the 8-bit values 1 .. 255.
/// For programs that display exactly the pixel values of a file.
void glint_tone_steps(const glint_tone_desc *tone, float least[255]);

/// Lines drawn into a PNG of beauty where the pass `outline` is 1.
typedef enum glint_outline_color { GLINT_OUTLINE_NONE, GLINT_OUTLINE_BLACK, GLINT_OUTLINE_WHITE } glint_outline_color;

/// One frame: its size, samples and passes.
typedef struct glint_render_desc {
    size_t struct_size; ///< sizeof(glint_render_desc)
    int64_t width, height; ///< pixels, 1 .. GLINT_SIDE_MAX; default 1280 x 720
    int64_t samples; ///< samples per pixel; 1 .. 65536; default 1
    /// 0 (default): every pixel takes all samples. Above 0, at most 3: each pixel first takes one sample, at its
    /// centre. A pixel takes all samples if it and one of its eight neighbours show different objects, normals 26
    /// degrees apart, or pixel values that differ by more than this, summed over red, green and blue, in fractions of
    /// white. Such a pixel is then as without `adaptive`, and every other pixel as with one sample. With one sample
    /// it has no effect
    double adaptive;
    glint_precision precision; ///< the precision of hits and shadows; default GLINT_PRECISION_DOUBLE
    glint_visibility visibility; ///< default GLINT_VISIBILITY_AUTO
    int64_t seed; ///< 0 .. 2^53; each seed gives another, equally good sample pattern; 0: the pattern is not shifted
    /// Longest chain of reflections and refractions; 0 .. 2^31; default 5. At most 31 if a material has
    /// both and its mirror + transmission is above 1, because rays then double at each surface. From the 17th surface
    /// of a chain on, one of the two rays, chosen at random, represents both
    int64_t max_depth;
    /// 0 (default): no limit. Above 0, at most 1e9: the most light, in its largest channel, that a random path (indirect
    /// light, rough surfaces) brings from a surface after its first ray, as if the pixel had no other path
    double clamp;
    uint32_t passes; ///< bits 1u << GLINT_PASS_...; stored in the image as linear float planes. Beauty may be left
        ///< out. With `outline`, the passes that it needs (depth, normal and object_id) are stored, too
    bool codes; ///< compute integer pixel values of the beauty pass while rendering, by `tone`; see glint_files.h. Files and
        ///< glint_image_rgba compute missing ones from the stored light
    /// Pixels that hit nothing are transparent: the background is black there and pixel values have alpha, so that a
    /// PNG of beauty is RGBA. Passes hold premultiplied light; pixel values hold unpremultiplied light, beauty /
    /// alpha. The background is also left out behind glass and translucent surfaces: see GLINT_PASS_ALPHA. Mirrored
    /// and totally reflected rays show the scene's background. If beauty is stored, so is GLINT_PASS_ALPHA
    bool alpha;
    /// Drawn only in files: planes and pixel values do not have it; the pass is stored. Default none
    glint_outline_color outline;
    glint_tone_desc tone;
    /// x, y, width and height, in pixels, of the part of the frame to render. Its pixels are identical to the same
    /// pixels of the whole frame; the image has the size of the part. All 0 (default): the whole frame
    int64_t region[4];
    /// Derivative number i is stored in the image as pass GLINT_PASS_DERIVATIVE + i. Borrowed by glint_plan_create; a
    /// plan's own description has only the count
    const glint_derivative *derivatives;
    size_t derivative_count; ///< 0 (default) .. GLINT_DERIVATIVES_MAX
    /// Light passes, separated by commas: names of light groups, "ambient" for light that no lamp emits, "*" for all
    /// groups of the scene in the order of their first lights, then "ambient". NULL (default): none. A light belongs
    /// to the pass of its `group`; if it has none, of its name; if it has no name, of "point_light_2", by its kind
    /// and its number among the scene's lights.
    ///
    /// A light pass holds all light of the picture that those lights emit: direct, in mirrors, through glass,
    /// indirect, and their visible surfaces. "ambient" is the rest: the scene's ambient light, background, the depth
    /// cue's colour. Light pass number i is stored in the image as pass GLINT_PASS_LIGHT + i. Beauty is the same with
    /// or without light passes, and all of them add up to it within a relative error of 2^-21. Borrowed by
    /// glint_plan_create; a plan's own description has them without "*".
    const char *light_passes;
    /// 0 (default): no limit. Above 0, at most 65536: the most rays of each kind that a sample sends: to an area light,
    /// for indirect light or ambient occlusion, and from a rough surface. For quick pictures of a scene that is edited
    int64_t rays;
} glint_render_desc;

/// Writes the defaults: 1280 x 720, 1 sample, double, passes = beauty, codes = false.
void glint_render_desc_init(glint_render_desc *desc, size_t size);
GLINT_DESC_DEFAULT(render);

// ---- Plan ----------------------------------------------------------------------------------------------------------

/// Takes a snapshot of the scene for one frame and lists the stages that it needs. The scene may be edited
/// afterwards. Fails if the scene has no camera, if a field of `desc` is out of range, or if a derivative depends on
/// something that has no derivative: the message then begins with "derivative 'NAME': ".
glint_status glint_plan_create(const glint_scene *scene, const glint_render_desc *desc, glint_plan **out,
                               glint_error *error);
/// Turns the description of a frame with an open shutter into that of each point in time: the passes that can be
/// averaged, no pixel values.
void glint_shutter_desc(glint_render_desc *desc);
/// Plans a frame with an open shutter. `times` are `count` plans of the scene at different times,
/// 1 .. GLINT_SHUTTER_TIMES_MAX, made with glint_shutter_desc. Light and alpha are the mean over the times.
/// Everything else comes from `scene` as it is now: the plan's effects and stages, and depth, normal, object_id,
/// albedo, outline and refined. If only lights differ, each such light is replaced by one light per time with its
/// share of the strength. A derivative of the frame is the mean of the derivatives of the same name at the times; a
/// time without it counts as 0. The new plan owns the plans and the list, which malloc allocated; on failure the caller
/// keeps them.
glint_status glint_plan_create_exposed(const glint_scene *scene, const glint_render_desc *desc, glint_plan **times,
                                       size_t count, glint_plan **out, glint_error *error);
/// Frees the plan; images rendered from it stay valid. NULL: nothing.
void glint_plan_destroy(glint_plan *plan);
/// Returns the description of the frame as planned, including passes that other passes require. The plan owns the
/// description.
const glint_render_desc *glint_plan_render_desc(const glint_plan *plan);
/// Returns the name of light pass number `index`, from 0; owned by the plan. NULL: the plan has fewer passes.
const char *glint_plan_light_pass(const glint_plan *plan, size_t index);

// ---- Render --------------------------------------------------------------------------------------------------------

/// The fields of a renderer.
typedef struct glint_renderer_desc {
    size_t struct_size; ///< sizeof(glint_renderer_desc)
    int threads; ///< 1 .. 1024 worker threads; 0 (default): one per processor available to the process
    /// "ref", "generic" (also "sse2"), "avx2", "avx512"; NULL: the variable GLINT_ISA, else the best
    const char *isa;
    bool time_stages; ///< measure the time of each stage on each tile (costs a few per cent)
    bool count_work; ///< count the work for the statistics (costs some per cent)
    bool no_reuse; ///< cache nothing between frames; the pictures are the same
    size_t reuse_memory; ///< bytes that may be cached between frames; 0 (default): a quarter of the machine's memory
} glint_renderer_desc;

/// Writes the defaults: one thread per processor, the best instruction set, reuse within a quarter of the memory.
void glint_renderer_desc_init(glint_renderer_desc *desc, size_t size);
GLINT_DESC_DEFAULT(renderer);
/// Starts the threads. GLINT_ERR_UNSUPPORTED if the machine lacks the instruction set, GLINT_ERR_INVALID if there is
/// none of that name.
glint_status glint_renderer_create(const glint_renderer_desc *desc, glint_renderer **out, glint_error *error);
/// Ends the threads and frees the cache; no frame may be running. NULL: nothing.
void glint_renderer_destroy(glint_renderer *renderer);
/// Returns the instruction set in use: "avx2". A static string.
const char *glint_renderer_isa(const glint_renderer *renderer);
/// Returns the number of workers, including the calling thread.
int glint_renderer_threads(const glint_renderer *renderer);
/// Cancels: the current glint_render, and all later ones of this renderer, return GLINT_ERR_CANCELLED, at the latest
/// after the current tile. Async-signal-safe.
void glint_renderer_cancel(glint_renderer *renderer);
/// Returns the finished share of the current frame, 0 .. 1. Any thread.
double glint_renderer_progress(const glint_renderer *renderer);

/// Renders one frame. *out holds the passes and pixel values that the plan's description names. stats: times and counts,
/// see glint_inspect.h; may be NULL.
glint_status glint_render(glint_renderer *renderer, const glint_plan *plan, glint_image **out, glint_frame_stats *stats,
                          glint_error *error);

// ---- Images --------------------------------------------------------------------------------------------------------

/// Takes another reference; returns its argument. Any thread.
glint_image *glint_image_retain(glint_image *image);
/// Releases a reference; the last one frees the image. NULL: nothing. Any thread.
void glint_image_release(glint_image *image);
/// Size in pixels.
int glint_image_width(const glint_image *image);
int glint_image_height(const glint_image *image);
/// Returns whether the pass is stored; beauty may exist only as pixel values.
bool glint_image_has_pass(const glint_image *image, glint_pass pass);
/// Returns the name of derivative number `index`, from 0; owned by the image. NULL: the image has fewer derivatives.
const char *glint_image_derivative(const glint_image *image, size_t index);
/// Returns the name of light pass number `index`, from 0; owned by the image. NULL: the image has fewer passes.
const char *glint_image_light_pass(const glint_image *image, size_t index);
/// Returns whether all pixel values except alpha are 0; without pixel values, whether no value of beauty is above 0.
/// Stops at the first other value. False if the image has neither.
bool glint_image_is_black(const glint_image *image);
/// Returns the exposure, in stops, that the frame's pixel values have or would have.
double glint_image_exposure(const glint_image *image);

/// Widens range[0] .. range[1] to the finite values of a pass: for depth, the nearest and farthest; for a derivative,
/// plus and minus the largest slope of a channel. Starts as +inf, -inf. GLINT_ERR_INVALID: the image lacks that pass,
/// or the pass is neither depth nor a derivative.
glint_status glint_image_range(const glint_image *image, glint_pass pass, double range[2], glint_error *error);

/// Reads one pixel of a stored pass; (0, 0) is the top left. One-channel passes give the same number three times.
glint_status glint_image_pixel(const glint_image *image, glint_pass pass, int x, int y, float out[3],
                               glint_error *error);
/// Copies all pixels of a stored pass, row by row from the top, each with the channels of the pass, to `out`, which has
/// space for width x height x glint_pass_channels(pass) numbers.
glint_status glint_image_floats(const glint_image *image, glint_pass pass, float *out, glint_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
