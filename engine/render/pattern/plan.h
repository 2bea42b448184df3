/// The programs that replace fields of materials, in the form that tiles run. Internal.
#ifndef GLINT_PATTERNS_H
#define GLINT_PATTERNS_H

#include "engine/base/hash.h"
#include "engine/glint.h"
#include "engine/render/stages/stages.h"

/// The fields that a program can compute. The first ones have planes: one float per sample, or three for a colour.
typedef enum glint_field {
    GLINT_FIELD_DIFFUSE,
    GLINT_FIELD_AMBIENT, ///< has planes unless constant or equal to diffuse: see glint_plan_find_indirect
    GLINT_FIELD_REST, ///< the part of a program's ambient that indirect light replaces; not a field of a material
    GLINT_FIELD_SPECULAR,
    GLINT_FIELD_MIRROR,
    GLINT_FIELD_TRANSMISSION,
    GLINT_FIELD_SHININESS,
    GLINT_FIELD_ROUGHNESS,
    GLINT_FIELD_CLEAR, ///< 1 - opacity of a translucent material
    GLINT_FIELD_PLANES, ///< number of fields with planes
    GLINT_FIELD_BUMP = GLINT_FIELD_PLANES,
    GLINT_FIELD_OPACITY, ///< opacity of a material that cuts holes
    GLINT_FIELD_SHADER,
    GLINT_FIELD_COUNT,
    GLINT_FIELD_BACKGROUND = GLINT_FIELD_COUNT ///< belongs to the scene, not to a material
} glint_field;

/// Bits of the inputs about texture coordinates.
#define GLINT_READS_UV_FOOTPRINT \
    (1u << GLINT_INPUT_UV_FOOTPRINT | 1u << GLINT_INPUT_UV_FOOTPRINT_U | 1u << GLINT_INPUT_UV_FOOTPRINT_V)
#define GLINT_READS_UV (1u << GLINT_INPUT_UV_U | 1u << GLINT_INPUT_UV_V | GLINT_READS_UV_FOOTPRINT)

#define GLINT_FIELDS_PLANES ((1u << GLINT_FIELD_PLANES) - 1) ///< bits of the fields with planes

/// "diffuse", "model", "background"
const char *glint_field_name(int field);
/// Returns the program of a material's field. NULL: none.
const glint_program *glint_pattern_program_of(const glint_material_desc *desc, int field);
/// Returns the number of channels of a field.
static inline int glint_field_channels(int field) { return field < GLINT_FIELD_SHININESS ? 3 : 1; }

/// A material's programs.
typedef struct glint_plan_pattern {
    const glint_program *program[GLINT_FIELD_COUNT]; ///< owned references; NULL: a number, or nothing
    glint_program *slope; ///< derivatives of the bump by p, world and, if it reads them, u and v; NULL: no bump
    glint_material_desc desc; ///< resolved; its program pointers are not used
    uint32_t made; ///< fields computed by programs, and the fields derived from them, one bit each
    uint32_t reads; ///< inputs of the programs that run at surfaces, one bit each
    bool any; ///< it has programs
    bool cut; ///< the material's surfaces may have holes
    bool repaints; ///< some derivative of the frame depends on numbers of its programs
    bool ambient_follows; ///< ambient equals diffuse
    glint_key numbers; ///< hash of the fields that are read in addition to the programs
    glint_key spaces; ///< hash of the spaces of the shapes with this material
} glint_plan_pattern;

/// A shape's own space, and the constants of its surface there.
typedef struct glint_pattern_space {
    bool mapped; ///< false: world space
    double inverse[3][4]; ///< own point = inverse world point
    double forward[3][3]; ///< own normal = transpose(forward) world normal, up to its length
    glint_shape_kind kind;
    int axis; ///< plane and disk: the axis that its normal is parallel to; -1: none
    double face; ///< plane and disk: the common coordinate of all points on that axis
    double lower[3], upper[3]; ///< box
    double origin[3], along[3],
        side[2][3]; ///< for surface coordinates: plane and disk: a point, and two tangents; cylinder and cone: the
    ///< base, its axis divided by its squared length, and two unit vectors perpendicular to it; torus: its
    ///< centre, its unit axis, and two such vectors
    double shrink; ///< ratio of own lengths to world lengths
    double radius, length; ///< cylinder and cone; torus: radius of its tube, length of the circle in the middle of the
        ///< tube
    const struct glint_mesh *mesh; ///< the mesh whose coordinates are read; its triangles are the primitives from
        ///< `first_prim` on
    uint32_t first_prim; ///< by id
} glint_pattern_space;

typedef struct glint_plan_patterns {
    glint_plan_pattern *of; ///< one for each material of the plan
    glint_pattern_space *spaces; ///< one for each part of the geometry
    int plane[GLINT_FIELD_PLANES]; ///< the first plane of a field; -1: no material has it
    int planes[GLINT_FIELD_PLANES]; ///< number of planes: one per channel, or one if every material is grey
    uint32_t plane_count;
    uint32_t row_count; ///< the largest number of rows that a program needs
    uint32_t reads; ///< inputs read by all materials
    uint32_t material_count;
    bool any; ///< some material has planes
    bool bumps, cut_outs, shaders;
    double pixel; ///< width of a pixel in an orthographic view; in a perspective view, at distance 1
    bool parallel; ///< the view is orthographic
} glint_plan_patterns;

struct glint_plan;

/// Fills plan->patterns if a material has programs. Comes before shading. indirect: there may be indirect light.
glint_status glint_plan_find_patterns(struct glint_plan *plan, bool indirect, glint_error *error);
void glint_plan_patterns_free(glint_plan_patterns *patterns); ///< NULL: nothing
/// Continues a key with a material's programs for `fields` (one bit each).
glint_key glint_pattern_key(const glint_plan_patterns *patterns, uint32_t material, uint32_t fields, glint_key key);
/// The same for all materials of a plan.
glint_key glint_programs_key(const struct glint_plan *plan, uint32_t fields, glint_key key);
/// Returns whether any program reads the eye's position. `patterns` may be NULL.
bool glint_patterns_see(const glint_plan_patterns *patterns);

#endif
