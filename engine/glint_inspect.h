/// What scenes, plans and frames are made of: the fields of objects, single rays, the stages of a plan and why it has
/// them, and the statistics of a frame.
#ifndef GLINT_INSPECT_H
#define GLINT_INSPECT_H

#include "glint_types.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

// ---- Fields of objects ---------------------------------------------------------------------------------------------

/// The type of a field in a description.
typedef enum glint_field_type {
    GLINT_TYPE_NUMBER, ///< double, finite
    GLINT_TYPE_WHOLE, ///< int64_t
    GLINT_TYPE_ANGLE, ///< double, radians; scripts and messages use degrees
    GLINT_TYPE_FLAG, ///< bool
    GLINT_TYPE_VECTOR, ///< double[3], finite
    GLINT_TYPE_DIRECTION, ///< double[3], finite, not zero
    GLINT_TYPE_COLOR, ///< double[3], linear RGB, finite, >= 0
    GLINT_TYPE_CHOICE, ///< an enumeration; `names` lists its values
    GLINT_TYPE_TEXT, ///< char[GLINT_NAME_SIZE]
    GLINT_TYPE_OBJECT, ///< a pointer to an object; `names[0]` is the kind of object
    GLINT_TYPE_POINTS, ///< const double (*)[3], followed by a size_t: the number of points
    GLINT_TYPE_DISTANCE, ///< a double, > 0, followed by a bool and a double[3]: if the bool is true, the point
        ///< replaces the distance. 0 and false: neither is set
    GLINT_TYPE_TRANSFORM, ///< glint_transform
    GLINT_TYPE_POSE, ///< a rigid map of the world to a camera's axes; `parts` begins with the rows of the fields that
        ///< it replaces: eye, at, direction and up
    GLINT_TYPE_PROGRAM, ///< a program only
    GLINT_TYPE_TABLE, ///< several fields of the same description, listed in `parts`, that are given together
    GLINT_TYPE_CUSTOM, ///< defined by the caller; no engine table uses it
    GLINT_TYPE_OTHER ///< defined by the caller; no engine table uses it
} glint_field_type;

#define GLINT_TAKES_PATTERN 1u ///< bits of glint_object_field.takes: a program evaluated at each point
#define GLINT_TAKES_TEXTURE 2u ///< a picture
#define GLINT_TAKES_SHADER 4u ///< a program evaluated for each light
#define GLINT_TAKES_VARIABLE 8u ///< a number with a slope; frames compute derivatives with respect to it

/// One field of an object: the row that defines its default, its check and its documentation.
typedef struct glint_object_field {
    const char *name; ///< name of the field in scripts and messages
    const char *member; ///< name of the member of the description; NULL: the field has no member of its own
    glint_field_type type; ///< type of the value in the description
    size_t offset; ///< in the description
    size_t set_offset; ///< offset of a bool that says whether the field is set; 0: the field always counts as set
    size_t unset_offset; ///< offset of a bool that is true while another field is used instead; 0: there is none
    size_t program_offset; ///< offset of a glint_program *; unless NULL, the program replaces the value. 0: there is
        ///< none
    unsigned takes; ///< what may replace a number: bits GLINT_TAKES_...
    bool required; ///< whether an object cannot be made without the field
    /// GLINT_TYPE_CHOICE: names of the values, from 0, ending with NULL; GLINT_TYPE_OBJECT: the kind
    const char *const *names;
    const struct glint_object_field *parts; ///< GLINT_TYPE_TABLE: ends with a row without a name
    double low, high; ///< smallest and largest number allowed, for each component; angles in radians
    const char *expected; ///< the allowed values in words, for messages: "number >= 0"
    double initial[3]; ///< the default, or the index of the default choice; components not given are 0
    const char *follows; ///< the field that supplies the value until this one is set; NULL: none
    const char *unit; ///< the unit, such as "world units"; NULL: none
    const char *doc; ///< the meaning of the field, in one line
    const void *custom; ///< GLINT_TYPE_CUSTOM: for the caller's use
} glint_object_field;

/// Kinds of objects that have a table of fields.
typedef enum glint_object_kind {
    GLINT_OBJECT_NONE, ///< no object, no fields
    GLINT_OBJECT_MATERIAL, ///< fields of glint_material_desc
    GLINT_OBJECT_POINT_LIGHT, ///< the fields of glint_light_desc that this kind reads; the kind is
        ///< GLINT_OBJECT_POINT_LIGHT + a glint_light_kind
    GLINT_OBJECT_DIRECTIONAL_LIGHT, ///< fields of a directional light
    GLINT_OBJECT_SPOT_LIGHT, ///< fields of a spot light
    GLINT_OBJECT_DISK_LIGHT, ///< fields of a disk light
    GLINT_OBJECT_POLYGON_LIGHT, ///< fields of a polygon light
    GLINT_OBJECT_SPHERE_LIGHT, ///< fields of a sphere light
    GLINT_OBJECT_SCENE, ///< fields of glint_scene_desc
    GLINT_OBJECT_CAMERA, ///< fields of glint_camera_desc
    GLINT_OBJECT_SPHERE, ///< the fields of glint_shape_desc that this kind reads; the kind is GLINT_OBJECT_SPHERE + a
        ///< glint_shape_kind
    GLINT_OBJECT_PLANE, ///< fields of a plane
    GLINT_OBJECT_SPHERES, ///< fields of many spheres
    GLINT_OBJECT_MESH, ///< fields of a mesh
    GLINT_OBJECT_BOX, ///< fields of a box
    GLINT_OBJECT_DISK, ///< fields of a disk
    GLINT_OBJECT_CYLINDER, ///< fields of a cylinder
    GLINT_OBJECT_CONE, ///< fields of a cone
    GLINT_OBJECT_TORUS, ///< fields of a torus
    GLINT_OBJECT_CYLINDERS, ///< fields of many cylinders
    GLINT_OBJECT_GROUP, ///< fields of a group
    GLINT_OBJECT_UNION, ///< fields of a union
    GLINT_OBJECT_INTERSECTION, ///< fields of an intersection
    GLINT_OBJECT_DIFFERENCE, ///< fields of a difference
    GLINT_OBJECT_KINDS ///< number of kinds
} glint_object_kind;

/// Returns the fields of a kind of object, in the order of the documentation, followed by a row without a name.
/// Writes their number to `count` unless it is NULL. NULL: there is no such kind.
const glint_object_field *glint_object_fields(glint_object_kind kind, size_t *count);

// ---- Single rays ---------------------------------------------------------------------------------------------------

/// The first hit of a ray.
typedef struct glint_hit {
    double t; ///< point = origin + t direction, in units of the direction's length; t > 0
    double point[3]; ///< world units
    double normal[3]; ///< unit, geometric, outward. A plane has its own normal; a triangle's normal points to the
        ///< side from which its corners run counter-clockwise
    glint_shape *shape; ///< borrowed from the scene
    size_t element; ///< number, from 0, of the sphere in a GLINT_SHAPE_SPHERES shape, of the triangle in a mesh, or
        ///< of the part in a combined solid, where nested parts are counted individually
} glint_hit;

/// Computes the nearest hit of one ray with t > 0, by the kernels that a frame uses. `direction` is not zero and need
/// not be unit. Spheres and round solids smaller than 1e-150, in world units or as a fraction of their distance from
/// `origin`, are refused; a frame refuses them by their distance from the eye. *hit says whether there is a hit; *out
/// is written only then.
glint_status glint_scene_cast(const glint_scene *scene, const double origin[3], const double direction[3], bool *hit,
                              glint_hit *out, glint_error *error);

#define GLINT_SEGMENTS_MAX 64 ///< most segments of a path

/// A straight part of the path of a ray.
typedef struct glint_segment {
    double from[3], direction[3]; ///< start; unit direction
    bool hit; ///< whether the segment ends at a surface
    double to[3]; ///< its end; only if `hit`
} glint_segment;

/// Follows one ray through mirrored and refracted directions, by the kernels that a frame uses. `direction` is not zero
/// and need not be unit. A ray goes on from at most `depth` surfaces, and only while it carries at least a hundredth of
/// the light of the first one. Bumps and opacity are ignored, and a mirror or transmission by a program counts as 1.
/// *count: number of segments, at least 1. A segment precedes the segments that begin at its end.
glint_status glint_scene_path(const glint_scene *scene, const double origin[3], const double direction[3], uint32_t depth,
                              glint_segment out[GLINT_SEGMENTS_MAX], size_t *count, glint_error *error);

// ---- Meshes --------------------------------------------------------------------------------------------------------

/// Returns the largest angle between a face of a mesh and its corner normals, in radians, 0 .. pi / 2, in the mesh's
/// own space; 0 for other shapes and shading. Where light grazes a face at a smaller angle, the face shadows itself
/// although its shading is lit. To avoid this, set `terminator` or use more segments. The first call reads all triangles; do not call it for one mesh from two threads at once.
double glint_mesh_bend(const glint_shape *shape);

/// Returns the arguments with which glint_sphere_mesh_create made a shape. Returns false and writes nothing if
/// another function made the shape.
bool glint_sphere_mesh_get(const glint_shape *shape, double center[3], double *radius, int64_t *segments);

/// The triangles of a mesh. The pointers belong to the shape.
typedef struct glint_mesh_data {
    const double *vertices; ///< x, y, z of each vertex
    size_t vertex_count; ///< number of vertices
    const uint32_t *triangles; ///< three indices of vertices, from 0, for each triangle
    size_t triangle_count; ///< number of triangles
    const double *normals; ///< normals of length 1, 0 for a corner without a normal; NULL: none were given
    /// Index of the normal of each corner of `triangles`; NULL: each vertex has one normal, in order
    const uint32_t *normal_corners;
    const double *uv; ///< u, v pairs; NULL: there are none
    const uint32_t *uv_corners; ///< the same for the pairs
    const uint32_t *faces; ///< the face that each triangle was cut from, from 0; NULL: each triangle is a face
} glint_mesh_data;

/// Describes the triangles of a mesh. Returns false and writes nothing for another shape.
bool glint_mesh_get(const glint_shape *shape, glint_mesh_data *out);
/// Returns whether a shape was given a material. Otherwise its material has default fields, or, in a combined solid, is
/// that of the whole. False for many spheres and cylinders.
bool glint_shape_has_material(const glint_shape *shape);

// ---- Stages of a plan ----------------------------------------------------------------------------------------------

/// Why a stage is in a plan. Both texts belong to the plan.
typedef struct glint_effect {
    const char *effect; ///< "hard shadow", "specular phong", ...
    const char *caller; ///< the object that needs it: "point_light 'lamp'"
} glint_effect;

/// A stage of a plan. The texts belong to the plan.
typedef struct glint_stage_info {
    const char *name; ///< "camera", "cast", "surface", "view", "light", "facet", "occlude", "vertex", ...
    char key[33]; ///< hex XXH3-128 of all data that the stage reads
    const char *why; ///< the reason for the stage, in one line for people
} glint_stage_info;

/// Numbers of rays by type.
typedef struct glint_ray_counts {
    uint64_t primary, shadow, mirror, refraction, indirect; ///< 0 if none is cast
} glint_ray_counts;

/// Return the number of effects or stages, and their list; the lists belong to the plan.
size_t glint_plan_effects(const glint_plan *plan, const glint_effect **list);
size_t glint_plan_stages(const glint_plan *plan, const glint_stage_info **list);

/// Returns the expected numbers of rays. Primary rays are exact. Shadow rays are an upper bound, as if every sample
/// hit a surface facing every light that casts shadows; they exclude the shadow rays of mirrored, refracted and
/// indirect rays and of transparent objects. mirror, refraction and indirect are 0 or the first generation.
glint_ray_counts glint_plan_expected_rays(const glint_plan *plan);
/// Estimates the work of rendering `plan` right after `before`, from their keys. Each stage whose key differs counts
/// 1. The stages `light` and `occlude` count 1 for each light or light sample that differs; `shade` counts a half if
/// only highlights of materials differ. Bit i of *stages is set if stage number i of glint_plan_stages must run. 0:
/// the two pictures are identical.
double glint_plan_work_after(const glint_plan *plan, const glint_plan *before, uint64_t *stages);

/// A program that a frame runs for a material or for the background.
typedef struct glint_program_use {
    const char *material; ///< the material's name; may be empty; NULL: the scene's background
    const char *field; ///< "diffuse"; "model" for a shader; "background"
    const glint_program *program; ///< owned by the plan
} glint_program_use;

/// Describes number `index` of the plan's programs, from 0; pointers belong to the plan. Returns false and writes
/// nothing if there are fewer.
bool glint_plan_program(const glint_plan *plan, size_t index, glint_program_use *out);

// ---- Statistics of a frame -----------------------------------------------------------------------------------------

#define GLINT_STAGE_MAX 64 ///< most stages of a plan

/// Work counters of a frame. Unlike times, they are free of noise.
typedef struct glint_work {
    uint64_t tests; ///< ray-primitive tests: pairs that the BVH and the filters could not rule out
    uint64_t light_samples; ///< evaluated pairs of a point and a light, or of a point and a sample of an area light
    uint64_t powers; ///< highlights computed (powers of a cosine)
    uint64_t sites; ///< sides of faces and vertices whose light was computed, for flat and gouraud shading
    uint64_t lights_seen; ///< rays that end on a visible light
    uint64_t patterns; ///< points at which a material's programs were run
    uint64_t environment; ///< rays that left the scene, so that the background's program was run for them
    uint64_t overlaps; ///< tests of how much of a light a sphere or plane covers from a point, for caps
} glint_work;

/// Kinds of pattern results that are not valid for any field: NaN and numbers below 0 become 0, numbers above 2^100
/// become 2^100.
typedef enum glint_odd_kind { GLINT_ODD_NAN, GLINT_ODD_NEGATIVE, GLINT_ODD_HUGE, GLINT_ODD_COUNT } glint_odd_kind;

/// How often a frame's patterns gave one kind of invalid result, and one place where they did.
typedef struct glint_odd {
    uint64_t count; ///< number of points with such a result; for the background, number of directions
    /// Field of one such result: static string, "diffuse"; "background" of the scene; NULL: there is none
    const char *field;
    char material[GLINT_NAME_SIZE]; ///< name of the material; may be empty
    double point[3]; ///< position in the world; for the background, the direction
} glint_odd;

/// The statistics of a frame.
struct glint_frame_stats {
    double build_ms; ///< wall time of building the BVH; near 0 if it was cached
    double render_ms; ///< wall time of the stages before the film
    double tone_ms; ///< wall time of computing pixel values
    int stage_count; ///< the plan's stages, in its order
    const char *stage_name[GLINT_STAGE_MAX]; ///< static strings
    double stage_ms[GLINT_STAGE_MAX]; ///< summed over workers; 0 unless the renderer times stages
    /// Share of the stage's results taken from earlier frames: 0 all were computed, 1 none
    double stage_reused[GLINT_STAGE_MAX];
    glint_ray_counts rays; ///< rays cast; stages whose results are reused cast none
    glint_work work; ///< work counters; 0 unless the renderer counts work; reused results cost none
    uint64_t refined; ///< number of pixels that took all samples with `adaptive`; otherwise 0
    /// Pixels rendered; for a region, all pixels of the tiles that it touches. `clipped` and `nonfinite` count these
    uint64_t pixels;
    uint64_t clipped; ///< pixels with a channel above 1; 0 without pixel values
    uint64_t nonfinite; ///< pixels with a channel that is not finite; 0 without pixel values
    uint64_t shifted; ///< pixels within a soft shadow, or next to an edge of a shape or shadow that a derivative's
        ///< parameter moves. The derivative does not include the motion of the edge. 0 without derivatives
    glint_odd odd[GLINT_ODD_COUNT]; ///< invalid results of patterns
};

// ---- Values of a picture -------------------------------------------------------------------------------------------

/// The brightness of several pictures together; starts as { 0 }.
typedef struct glint_brightness {
    double most; ///< largest finite value of a channel, before exposure; 0: none is above 0
    uint64_t pictures; ///< number of images added
    uint64_t values; ///< number of channel values: three per pixel
    uint64_t clipped; ///< finite values that are above 1 after exposure
} glint_brightness;

/// Adds an image's linear beauty to *sum; counts clipping after `exposure` stops. GLINT_ERR_INVALID: the image has no
/// linear beauty.
glint_status glint_image_brightness(const glint_image *image, double exposure, glint_brightness *sum, glint_error *error);
/// Returns the greatest exposure, in whole hundredths of a stop within GLINT_EXPOSURE_MAX, at which light of `most`
/// does not exceed 1; 0 if `most` is 0. The same on every machine.
double glint_exposure_for(double most);

// ---- Materials -----------------------------------------------------------------------------------------------------

/// The two terms of one light of strength 1, from the kernels that a frame uses.
typedef struct glint_reflection {
    double diffuse[3]; ///< kd (n.l), 0 where n.l <= 0
    double specular[3]; ///< ks S, 0 where n.l <= 0
} glint_reflection;

/// Evaluates a material at a point from its numeric fields; programs are ignored. The three vectors point away from
/// the surface and need not be unit; finite, not zero.
glint_status glint_material_evaluate(const glint_material *material, const double normal[3], const double to_light[3],
                                     const double to_eye[3], glint_reflection *out, glint_error *error);

// ---- Reuse -----------------------------------------------------------------------------------------------------------

/// Makes a renderer cache the hits of every frame, also of the first one with its view, for a program in which someone
/// changes one value after the other. By default the second frame with a view caches them. The pictures are the same.
void glint_renderer_cache_hits(glint_renderer *renderer);

// ---- What pictures depend on -----------------------------------------------------------------------------------------

/// Writes a hash of everything that the samples of a plan's picture depend on.
void glint_plan_key(const glint_plan *plan, uint64_t key[2]);
/// Extends a hash by what else the picture of one pass, a glint_pass, depends on: overlays, and options of its stages.
void glint_plan_add_pass_key(const glint_plan *plan, int pass, uint64_t key[2]);

/// Calls `warns` for each overlay that the plan's picture cannot show as described: text outside the picture, lines
/// wider than the picture, letters missing from the font, points behind the camera, an arrow of no length. The
/// message names the overlay. dpi: pixels per inch of the file; 0: not set.
glint_status glint_plan_check_overlays(const glint_plan *plan, double dpi, void (*warns)(void *context, const char *message),
                                       void *context, glint_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
