/// The tables of fields by kind of object.
#include "engine/scene/fields.h"

const glint_object_field *glint_object_fields(glint_object_kind kind, size_t *count)
{
    const unsigned light = (unsigned)kind - GLINT_OBJECT_POINT_LIGHT;
    const glint_object_field *fields = kind == GLINT_OBJECT_MATERIAL ? glint_material_fields
                                       : kind == GLINT_OBJECT_SCENE  ? glint_scene_fields
                                       : light <= GLINT_LIGHT_SPHERE ? glint_light_fields[light]
                                                                     : NULL;
    size_t rows = 0;
    while (count && fields && fields[rows].name)
        rows++;
    if (count)
        *count = rows;
    return fields;
}
