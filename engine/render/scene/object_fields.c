/// The tables of fields by kind of object.
#include "engine/glint.h"
#include "engine/render/scene/fields.h"

static const glint_object_field *fields_of(glint_object_kind kind)
{
    const unsigned light = (unsigned)kind - GLINT_OBJECT_POINT_LIGHT, shape = (unsigned)kind - GLINT_OBJECT_SPHERE;
    if (light <= GLINT_LIGHT_SPHERE)
        return glint_light_fields[light];
    if (shape <= GLINT_SHAPE_DIFFERENCE)
        return glint_shape_fields[shape];
    return kind == GLINT_OBJECT_MATERIAL ? glint_material_fields
           : kind == GLINT_OBJECT_SCENE  ? glint_scene_fields
           : kind == GLINT_OBJECT_CAMERA ? glint_camera_fields
                                         : NULL;
}

const glint_object_field *glint_object_fields(glint_object_kind kind, size_t *count)
{
    const glint_object_field *fields = fields_of(kind);
    size_t rows = 0;
    while (count && fields && fields[rows].name)
        rows++;
    if (count)
        *count = rows;
    return fields;
}
