/// The structures of the described objects. Internal: only scene/ and geometry/ include this header.
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
    glint_light_desc desc; ///< its `vertices` point to the copy below
    double (*vertices)[3]; ///< owned copy of the corners; or NULL
};

struct glint_camera {
    size_t references;
    glint_camera_desc desc;
};

/// Whether a mesh has an inside.
typedef struct glint_closure {
    bool computed; ///< whether the other fields are valid
    bool inverted; ///< whether triangles run clockwise as seen from outside
    uint32_t triangles; ///< number of triangles at the open edge, where the two directions do not balance; 0: the
        ///< mesh is closed
    double edge[2][3]; ///< the open edge, in the direction of the first of these triangles
} glint_closure;

/// A mesh's triangles.
typedef struct glint_mesh {
    double (*vertices)[3];
    uint32_t (*triangles)[3]; ///< indices of vertices
    size_t vertex_count, triangle_count;
    double (*normals)[3]; ///< normals of length 1, or 0 for no normal; NULL: there are none
    uint32_t (*triangle_normals)[3]; ///< indices of the normals of each triangle's corners; NULL: equal to the vertex
        ///< indices
    bool averaged; ///< the normals were computed from the faces
    double (*uv)[2]; ///< texture coordinates; NULL: there are none
    uint32_t (*triangle_uv)[3]; ///< indices of the uv pairs of each triangle's corners; NULL: equal to the vertex
        ///< indices
    glint_key uv_key; ///< hash of `uv` and `triangle_uv`
    size_t *uv_missing; ///< for each material, the first face with a corner without coordinates, from 1; 0: none
    uint32_t *faces; ///< the face that each triangle was cut from, from 0; NULL: each triangle is a face
    size_t face_count;
    uint32_t (*shading_points)[3]; ///< gouraud shading: one index for each combination of vertex, normal and
        ///< material; NULL: equal to the vertex indices
    size_t shading_point_count; ///< 0: not computed yet
    double center[3], radius; ///< of a triangulated sphere
    int64_t segments; ///< of such a sphere; 0: the mesh is not one
    double bend; ///< see glint_mesh_bend; 0: none, or not computed yet
    glint_closure closure; ///< see glint_mesh_find_closure
} glint_mesh;

struct glint_shape {
    size_t references;
    uint64_t revision; ///< changes with every change of the shape; unique among all shapes
    glint_shape_desc desc;
    size_t count; ///< number of spheres, cylinders or triangles; 1 for other kinds
    glint_mesh *mesh; ///< GLINT_SHAPE_MESH
    glint_list children; ///< members of a group, or parts of a combined solid
    size_t level; ///< largest depth of nesting that the shape has had
    uint64_t stamp; ///< `stamp` of the last search that visited this shape
    size_t probed; ///< the depth of nesting at which this search visited the shape
    uint64_t checked; ///< for a group: the latest revision of any shape when the group's children were last checked
    uint64_t children_hash; ///< hash of the children's revisions at that time
    bool dressed; ///< as a part: whether it has its own material instead of the material of the whole solid
    double lower[3], upper[3]; ///< many spheres or cylinders, and GLINT_SHAPE_MESH: bounding box
    double *items; ///< many spheres or cylinders: the GLINT_SPHERE_NUMBERS or GLINT_CYLINDER_NUMBERS of each
    uint32_t *index; ///< many spheres or cylinders, and GLINT_SHAPE_MESH: index of the material of each sphere,
        ///< cylinder or triangle; or NULL
    glint_material **materials;
    size_t material_count;
};

typedef struct glint_geometry glint_geometry; ///< defined in geometry/geometry.h
void glint_geometry_release(glint_geometry *geometry); ///< NULL: nothing

struct glint_scene {
    size_t references;
    glint_scene_desc desc;
    glint_list shapes, lights, overlays;
    glint_geometry *geometry; ///< made from the shapes by the last plan; a cache, see geometry.h
};

static inline glint_shape *glint_scene_shape(const glint_scene *scene, size_t i) { return scene->shapes.items[i]; }
static inline glint_light *glint_scene_light(const glint_scene *scene, size_t i) { return scene->lights.items[i]; }

/// Allocates a shape with space for `material_count` materials, none set yet; NULL: out of memory.
glint_shape *glint_shape_alloc(const glint_shape_desc *desc, size_t material_count);
/// Extends the bounding box by a ball; `first`: the box is empty so far.
void glint_shape_stretch(glint_shape *shape, const double center[3], double radius, bool first);
static inline bool glint_shape_combines(const glint_shape *shape) { return shape->desc.kind >= GLINT_SHAPE_UNION; }
/// Returns whether a shape consists only of its children.
static inline bool glint_shape_has_children(const glint_shape *shape) { return shape->desc.kind >= GLINT_SHAPE_GROUP; }
enum { GLINT_SPHERE_NUMBERS = 4, GLINT_CYLINDER_NUMBERS = 7 }; ///< centre and radius; base, top and radius
/// Returns whether a kind consists of many spheres or cylinders.
static inline bool glint_shape_is_many(glint_shape_kind kind)
{
    return kind == GLINT_SHAPE_SPHERES || kind == GLINT_SHAPE_CYLINDERS;
}
/// Returns whether rays intersect a shape as a solid: a box, disk, cone or torus, one or many cylinders.
static inline bool glint_shape_is_solid(const glint_shape *shape)
{
    return shape->desc.kind >= GLINT_SHAPE_BOX && shape->desc.kind <= GLINT_SHAPE_CYLINDERS;
}
/// Refuses a part of a combined solid that has no inside. who: the name of the combined solid, for the message.
glint_status glint_check_part(const char *who, const glint_shape *part, glint_error *error);
/// Returns the name of a kind: "difference", ...
const char *glint_shape_kind_name(glint_shape_kind kind);
/// Gives a shape a new revision.
void glint_shape_changed(glint_shape *shape);
/// Returns the revision; a group's revision changes with every change of a shape in the group.
uint64_t glint_shape_revision(glint_shape *shape);

bool glint_transform_is_identity(const glint_transform *t);
/// Returns whether a map preserves angles up to rounding, and writes the factor by which the map scales lengths.
bool glint_transform_similar(const glint_transform *t, double *factor);
void glint_transform_point(const glint_transform *t, const double p[3], double out[3]);
void glint_transform_linear(const glint_transform *t, double out[3][3]);
/// Computes the matrix that transforms normals; returns the determinant of `m`.
double glint_linear_cofactors(double m[3][3], double out[3][3]);
glint_status glint_check_transform(const char *name, const glint_transform *t, glint_error *error);

/// Returns whether a pattern consists only of numbers 0 .. `most`, which can replace the pattern. If the pattern has
/// one number, it is used for all three. Patterns with numbers out of range are run, so that the numbers are clamped
/// and counted like other pattern results.
bool glint_pattern_numbers(const glint_program *program, double most, double out[3]);

/// Retains `material`, or makes one with default fields if it is NULL.
glint_material *glint_material_or_default(glint_material *material, glint_error *error);
void glint_mesh_free(glint_mesh *mesh);
/// Computes the data that a mesh needs for a kind of shading: vertex normals and shading points. index: the material
/// of each triangle; NULL: all have the same.
glint_status glint_mesh_prepare(glint_mesh *mesh, const uint32_t *index, glint_shading shading, glint_error *error);
glint_status glint_check_shading(glint_shading shading, glint_error *error);
/// Fills in `closure` on the first call.
glint_status glint_mesh_find_closure(glint_mesh *mesh, glint_error *error);

/// Writes "point_light 'lamp'", or "point_light #2" without a name. `number` counts from 1.
void glint_describe_light(const glint_light_desc *desc, size_t number, char *out, size_t size);
/// Returns whether a material has a specular term that is not black, judging by its numbers.
bool glint_material_is_shiny(const glint_material_desc *desc);
/// Return whether the material transmits light anywhere, and whether it has a mirror.
bool glint_material_transmits(const glint_material_desc *desc);
bool glint_material_mirrors(const glint_material_desc *desc);
bool glint_material_has_facets(const glint_material_desc *desc); ///< returns whether its highlights are of microfacets
/// Returns whether the rays that it reflects and refracts are spread by microfacets.
bool glint_material_is_rough(const glint_material_desc *desc);
bool glint_material_is_cut(const glint_material_desc *desc); ///< returns whether its surfaces may have holes
bool glint_material_blends(const glint_material_desc *desc); ///< returns whether it is translucent
void glint_describe_material(const glint_material_desc *desc, const char *owner, char *out, size_t size);
void glint_describe_shape(const glint_shape_desc *desc, size_t number, char *out, size_t size);

#endif
