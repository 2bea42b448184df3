/// Applies defaults and checks from the tables of fields. Internal.
#ifndef GLINT_FIELDS_H
#define GLINT_FIELDS_H

#include "engine/glint_types.h"
#include "engine/glint_inspect.h"

#include <float.h>

/// The tables of fields, one per object, each defined in the object's file.
extern const glint_object_field glint_material_fields[];
extern const glint_object_field glint_scene_fields[];
extern const glint_object_field glint_camera_fields[];
extern const glint_object_field *const glint_light_fields[]; ///< of each glint_light_kind
extern const glint_object_field *const glint_shape_fields[]; ///< of each glint_shape_kind

/// The first members of a table row: a field of the type DESC, which the file defines, and the last part of its
/// GLINT_TYPE_ name.
#define GLINT_ROW(field, kind) GLINT_NAMED(#field, field, kind)
/// The same for a field that has another name in scripts.
#define GLINT_NAMED(script, field, kind) .name = script, .member = #field, .type = GLINT_TYPE_##kind, .offset = offsetof(DESC, field)
#define GLINT_AT_LEAST_0 .low = 0, .high = DBL_MAX, .expected = "number >= 0"
#define GLINT_ABOVE_0 .low = 4.9406564584124654e-324, .high = DBL_MAX, .expected = "number > 0"
#define GLINT_SHARE .low = 0, .high = 1, .expected = "number 0 .. 1"

/// Writes the defaults of the fields into a description.
void glint_fields_reset(const glint_object_field *fields, void *desc);
/// Checks the fields that are set, in the order of the table; the message names the first field that is wrong. The
/// caller checks the rest: numbers and angles without `expected`, and all types except numbers, vectors, colours,
/// choices and transforms.
glint_status glint_fields_check(const glint_object_field *fields, const void *desc, glint_error *error);
/// Returns how many doubles a field has: 3, 1 or 0.
int glint_field_numbers(const glint_object_field *field);

#endif
