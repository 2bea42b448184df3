/// What materials take from programs in place of their numbers, as the tiles run them. Internal.
#ifndef GLINT_PATTERNS_H
#define GLINT_PATTERNS_H

#include "engine/base/hash.h"
#include "engine/glint.h"
#include "engine/stages/stages.h"

/// What a program of a material gives; the first have planes, a float a sample, three where it is a colour.
typedef enum glint_field {
    GLINT_FIELD_DIFFUSE,
    GLINT_FIELD_AMBIENT, ///< where it is neither a number nor the diffuse reflectance: see glint_plan_find_indirect
    GLINT_FIELD_REST, ///< of a program's ambient: what indirect light stands for; no program's own
    GLINT_FIELD_SPECULAR,
    GLINT_FIELD_MIRROR,
    GLINT_FIELD_TRANSMISSION,
    GLINT_FIELD_SHININESS,
    GLINT_FIELD_ROUGHNESS,
    GLINT_FIELD_PLANES, ///< how many have planes
    GLINT_FIELD_BUMP = GLINT_FIELD_PLANES,
    GLINT_FIELD_OPACITY,
    GLINT_FIELD_SHADER,
    GLINT_FIELD_COUNT,
    GLINT_FIELD_BACKGROUND = GLINT_FIELD_COUNT ///< of no material: the scene's
} glint_field;

/// Bits of the inputs that say where a point is on a picture.
#define GLINT_READS_UV (1u << GLINT_INPUT_UV_U | 1u << GLINT_INPUT_UV_V | 1u << GLINT_INPUT_UV_FOOTPRINT)

#define GLINT_FIELDS_PLANES ((1u << GLINT_FIELD_PLANES) - 1) ///< bits of those that have planes

/// "diffuse", "model", "background"
const char *glint_field_name(int field);
/// The program of a field among a material's. NULL: none.
const glint_program *glint_pattern_program_of(const glint_material_programs *programs, int field);
/// How many numbers a field is.
static inline int glint_field_channels(int field) { return field < GLINT_FIELD_SHININESS ? 3 : 1; }

/// A material's programs.
typedef struct glint_plan_pattern {
    const glint_program *program[GLINT_FIELD_COUNT]; ///< owned references; NULL: a number, or nothing
    glint_program *slope; ///< of the bump: its derivatives by p, world and, where it reads them, u and v; NULL: there is none
    glint_material_desc desc; ///< resolved; its own programs mean nothing
    uint32_t made; ///< fields that programs give, a bit each, and what follows from these
    uint32_t reads; ///< inputs of the programs that are run at surfaces, a bit each
    bool any; ///< it has programs
    bool cut; ///< there are holes in its surfaces, or may be
    bool repaints; ///< a derivative of the frame is by numbers of its programs
    bool ambient_follows; ///< ambient is diffuse
    glint_key numbers; ///< of the description, that are read beside the programs
    glint_key places; ///< of the shapes that show it
} glint_plan_pattern;

/// A shape's own space, and what is known of its surface there.
typedef struct glint_pattern_place {
    bool mapped; ///< false: world space
    double inverse[3][4]; ///< own point = inverse world point
    double forward[3][3]; ///< own normal = transpose(forward) world normal, but for its length
    glint_shape_kind kind;
    int axis; ///< plane and disk: the axis that its normal is; -1: none
    double face; ///< of these: the coordinate of all of its points
    double lower[3], upper[3]; ///< box
    double origin[3], along[3],
        side[2][3]; ///< of s.uv: plane and disk: a point, and two tangents; cylinder and cone: the
    ///< base, its axis divided by its squared length, and two unit vectors across it; torus: its centre, its unit axis, alike
    double shrink; ///< own lengths over the world's
    double radius, length; ///< cylinder and cone; torus: of its tube, of the circle in the middle of that
    const struct glint_mesh *mesh; ///< whose coordinates are read; its triangles are primitives from `first_prim` on
    uint32_t first_prim; ///< by id
} glint_pattern_place;

typedef struct glint_plan_patterns {
    glint_plan_pattern *of; ///< beside the plan's materials
    glint_pattern_place *places; ///< of each part of the geometry
    int plane[GLINT_FIELD_PLANES]; ///< the first plane of a field; -1: no material has it
    int planes[GLINT_FIELD_PLANES]; ///< how many it has: one a channel, or one for all where every material's is grey
    uint32_t plane_count;
    uint32_t row_count; ///< the most that a program needs
    uint32_t reads; ///< of all materials
    uint32_t material_count;
    bool any; ///< some material has planes
    bool bumps, cut_outs, shaders;
    double pixel; ///< width of a pixel, in an orthographic view; in a perspective one at distance 1
    bool parallel; ///< the view is orthographic
} glint_plan_patterns;

struct glint_plan;

/// Fills plan->patterns where some material has programs, before shading. indirect: there may be indirect light.
glint_status glint_plan_find_patterns(struct glint_plan *plan, bool indirect, glint_error *error);
void glint_plan_patterns_free(glint_plan_patterns *patterns); ///< NULL: nothing
/// Continues a key with a material's programs: those of `fields`, a bit each.
glint_key glint_pattern_key(const glint_plan_patterns *patterns, uint32_t material, uint32_t fields, glint_key key);
/// Whether any program reads where the eye is; NULL: there is none.
bool glint_patterns_see(const glint_plan_patterns *patterns);

#endif
