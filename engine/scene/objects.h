/// The structures of the described objects. Internal to the engine; nothing below engine/ itself includes it.
#ifndef GLINT_OBJECTS_H
#define GLINT_OBJECTS_H

#include "engine/base/hash.h"
#include "engine/base/list.h"
#include "engine/glint.h"

struct glint_material {
    size_t references;
    glint_material_desc desc;
};

struct glint_light {
    size_t references;
    glint_light_desc desc; ///< its `vertices` are the light's own
    double (*vertices)[3]; ///< or NULL
};

struct glint_camera {
    size_t references;
    glint_camera_desc desc;
};

/// Whether a mesh has an inside.
typedef struct glint_closure {
    bool found; ///< the rest is known
    bool inverted; ///< its triangles run clockwise as seen from outside
    uint32_t triangles; ///< of an edge along which not as many run one way as the other; 0: there is none, it is closed
    double edge[2][3]; ///< that edge, in the order in which the first of these runs
} glint_closure;

/// A mesh's triangles.
typedef struct glint_mesh {
    double (*vertices)[3];
    uint32_t (*triangles)[3]; ///< numbers of vertices
    size_t vertex_count, triangle_count;
    double (*normals)[3]; ///< unit, or 0: none; NULL: there are none
    uint32_t (*triangle_normals)[3]; ///< indices of normals; NULL: the same as of the vertices
    double (*uv)[2]; ///< coordinates on a picture; NULL: there are none
    uint32_t (*triangle_uv)[3]; ///< indices of these; NULL: the same as of the vertices
    glint_key uv_key; ///< of both
    size_t *uv_missing; ///< of each material, the first face that has a corner without, from 1; 0: none
    uint32_t *faces; ///< the face each triangle was cut from, from 0; NULL: each is a face
    size_t face_count;
    uint32_t (*shading_points)[3]; ///< gouraud shading: one index for each combination of vertex, normal and material;
                                   ///< NULL: the same as of the vertices
    size_t shading_point_count; ///< 0: not counted yet
    double center[3], radius, segments; ///< of a sphere of triangles; segments 0: it is none
    double bend; ///< see glint_mesh_bend; 0: none, or not looked for yet
    glint_closure closure; ///< see glint_mesh_find_closure
} glint_mesh;

struct glint_shape {
    size_t references;
    uint64_t revision; ///< another one after every change; no two shapes ever have the same
    glint_shape_desc desc;
    size_t count; ///< spheres, or triangles; 1 for other kinds
    glint_mesh *mesh; ///< GLINT_SHAPE_MESH
    glint_list children; ///< of a group or combined solid
    size_t level; ///< how many groups it has been within
    uint64_t stamp; ///< of the last search that came by
    size_t probed; ///< the level that search supposed
    uint64_t checked; ///< a group: the last revision given to any shape when its children were looked at
    uint64_t children_hash; ///< of their revisions then
    bool dressed; ///< it has a material of its own, not that of the whole
    double lower[3], upper[3]; ///< GLINT_SHAPE_SPHERES and GLINT_SHAPE_MESH: a box around them
    double (*spheres)[4]; ///< GLINT_SHAPE_SPHERES: centre and radius of each
    uint32_t *index; ///< GLINT_SHAPE_SPHERES and GLINT_SHAPE_MESH: material of each sphere or triangle, or NULL
    glint_material **materials;
    size_t material_count;
};

typedef struct glint_geometry glint_geometry; ///< geometry/geometry.h
void glint_geometry_release(glint_geometry *geometry); ///< NULL: nothing

struct glint_scene {
    size_t references;
    glint_scene_desc desc;
    glint_list shapes, lights, overlays;
    glint_geometry *geometry; ///< made from the shapes by the last plan; a cache, see geometry.h
};

static inline glint_shape *glint_scene_shape(const glint_scene *scene, size_t i) { return scene->shapes.items[i]; }
static inline glint_light *glint_scene_light(const glint_scene *scene, size_t i) { return scene->lights.items[i]; }

/// A shape of `count` primitives with room for `material_count` materials, none there yet; NULL: no memory.
glint_shape *glint_shape_alloc(const glint_shape_desc *desc, size_t material_count);
/// Makes the box of the shape hold a ball around the point, too; `first`: it holds nothing yet.
void glint_shape_stretch(glint_shape *shape, const double center[3], double radius, bool first);
static inline bool glint_shape_combines(const glint_shape *shape) { return shape->desc.kind >= GLINT_SHAPE_UNION; }
/// Whether it is nothing but its children.
static inline bool glint_shape_has_children(const glint_shape *shape) { return shape->desc.kind >= GLINT_SHAPE_GROUP; }
/// Whether rays meet it by the rules of solids: a box, disk, cylinder, cone or torus.
static inline bool glint_shape_is_solid(const glint_shape *shape)
{
    return shape->desc.kind >= GLINT_SHAPE_BOX && shape->desc.kind <= GLINT_SHAPE_TORUS;
}
/// Refuses a part of a combined solid that has no inside. who: the solid, for the message.
glint_status glint_check_part(const char *who, const glint_shape *part, glint_error *error);
/// "difference", ... of a kind.
const char *glint_shape_kind_name(glint_shape_kind kind);
/// Gives a shape a new revision.
void glint_shape_changed(glint_shape *shape);
/// Its revision; of a group, another one after every change of anything within.
uint64_t glint_shape_revision(glint_shape *shape);

bool glint_transform_is_identity(const glint_transform *t);
/// Returns whether a map preserves angles up to rounding, and the factor of lengths.
bool glint_transform_similar(const glint_transform *t, double *factor);
void glint_transform_point(const glint_transform *t, const double p[3], double out[3]);
void glint_transform_linear(const glint_transform *t, double out[3][3]);
/// Rows of the matrix that takes normals along, and its determinant.
double glint_linear_cofactors(double m[3][3], double out[3][3]);
glint_status glint_check_transform(const char *name, const glint_transform *t, glint_error *error);

/// Returns whether a pattern consists only of numbers, 0 .. most, which can replace it; one number stands for all three. Others
/// are run, so that those that are out of range become what a pattern's are, and are counted.
bool glint_pattern_numbers(const glint_program *program, double most, double out[3]);

/// Takes a reference to `material`, or makes one with default fields.
glint_material *glint_material_or_default(glint_material *material, glint_error *error);
void glint_mesh_free(glint_mesh *mesh);
/// Makes what a mesh lacks to be shaded so: normals of the vertices, and the numbers of its sites.
/// index: the material of each triangle; NULL: they have one.
glint_status glint_mesh_prepare(glint_mesh *mesh, const uint32_t *index, glint_shading shading, glint_error *error);
glint_status glint_check_shading(glint_shading shading, glint_error *error);
/// Fills `closure`, once.
glint_status glint_mesh_find_closure(glint_mesh *mesh, glint_error *error);

/// "point_light 'lamp'", or "point_light #2" without a name. `number` counts from 1.
void glint_describe_light(const glint_light_desc *desc, size_t number, char *out, size_t size);
/// Whether it has a specular term that is not black, as far as its numbers say.
bool glint_material_is_shiny(const glint_material_desc *desc);
/// Whether light goes through, somewhere; whether it has a mirror.
bool glint_material_transmits(const glint_material_desc *desc);
bool glint_material_mirrors(const glint_material_desc *desc);
bool glint_material_is_cut(const glint_material_desc *desc); ///< returns whether its surfaces may have holes
bool glint_material_blends(const glint_material_desc *desc); ///< returns whether it is translucent
void glint_describe_material(const glint_material_desc *desc, const char *owner, char *out, size_t size);
void glint_describe_shape(const glint_shape_desc *desc, size_t number, char *out, size_t size);

#endif
