/// What the described objects hold. Internal to the engine; nothing below engine/ itself includes it.
#ifndef GLINT_OBJECTS_H
#define GLINT_OBJECTS_H

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

struct glint_shape {
    size_t references;
    uint64_t revision; ///< another one after every change; no two shapes ever have the same
    glint_shape_desc desc;
    size_t count; ///< spheres; 1 for other kinds
    double (*spheres)[4]; ///< GLINT_SHAPE_SPHERES: centre and radius of each
    uint32_t *index; ///< GLINT_SHAPE_SPHERES: material of each, or NULL
    glint_material **materials;
    size_t material_count;
};

typedef struct glint_geometry glint_geometry;

struct glint_scene {
    size_t references;
    glint_scene_desc desc;
    glint_list shapes, lights;
    glint_geometry *geometry; ///< made from the shapes by the last plan; a cache, see geometry.h
};

static inline glint_shape *glint_scene_shape(const glint_scene *scene, size_t i) { return scene->shapes.items[i]; }
static inline glint_light *glint_scene_light(const glint_scene *scene, size_t i) { return scene->lights.items[i]; }

/// "point_light 'lamp'", or "point_light #2" without a name. `number` counts from 1.
void glint_describe_light(const glint_light_desc *desc, size_t number, char *out, size_t size);
void glint_describe_material(const glint_material_desc *desc, const char *owner, char *out, size_t size);
void glint_describe_shape(const glint_shape_desc *desc, size_t number, char *out, size_t size);

#endif
