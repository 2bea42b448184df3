// glint._bonds: the cylinders of bonds between close atoms. Only for scripts/lib.
#include <string.h>

#include "bindings/lua/many.h"
#include "engine/glint.h"
#include "engine/glint_data.h"

typedef struct arguments {
    glint_bonds_desc desc;
    double closest, radius;
    double low[3], size[3], tilt[3], periodic[3];
} arguments;

#define NUMBER(field) { .name = #field, .type = GLINT_TYPE_NUMBER, .offset = offsetof(arguments, field) }
#define VECTOR(field) { .name = #field, .type = GLINT_TYPE_VECTOR, .offset = offsetof(arguments, field) }

static const glintL_field FIELDS[] = {
    NUMBER(closest), NUMBER(radius), VECTOR(low), VECTOR(size), VECTOR(tilt), VECTOR(periodic),
    { .name = "points", .type = GLINT_TYPE_OTHER },
    { .name = "reach", .type = GLINT_TYPE_OTHER },
    { .name = "materials", .type = GLINT_TYPE_OTHER },
    { .name = "index", .type = GLINT_TYPE_OTHER },
    { .name = NULL },
};

enum { ARGUMENT = 1, BOX, POINTS, REACH, INDEX, INDEX_BUFFER, MATERIAL, MATERIALS, POINTERS, KEPT };

static const glintL_many MANY = { .object = "bonds", .each = "atom", .material = MATERIAL, .materials = MATERIALS,
                                  .index = INDEX, .index_buffer = INDEX_BUFFER, .pointers = POINTERS, .kept = KEPT };

static const glintL_array *check_array(lua_State *L, const char *name, int index)
{
    glintL_many_fetch(L, name, index);
    const glintL_array *array = glintL_to_array(L, index);
    if (!array || array->is_whole)
        glintL_refuse(L, index, name, "array of numbers");
    return array;
}

// Reads the positions of the atoms, from an array or from glint.spheres.
static void read_points(lua_State *L, glint_bonds_desc *desc)
{
    glintL_many_fetch(L, "points", POINTS);
    const glint_shape *shape = glintL_test_object(L, POINTS, GLINTL_SHAPE);
    if (shape && glint_shape_get(shape)->kind == GLINT_SHAPE_SPHERES) {
        desc->points = glint_spheres_data(shape);
        desc->stride = 4;
        desc->count = glint_spheres_count(shape);
        return;
    }
    const glintL_array *points = check_array(L, "points", POINTS);
    desc->points = points->numbers;
    desc->stride = points->width;
    desc->count = points->count;
}

// Returns the cylinders and the number of bonds; nil and 0 if there are none.
int glintL_new_bonds(lua_State *L)
{
    arguments a = { .radius = 1, .size = { 1, 1, 1 } };
    glint_shape *shape = NULL;
    glint_error error;
    lua_settop(L, 1);
    glintL_box *box = glintL_new_box(L, GLINTL_SHAPE);
    lua_settop(L, KEPT);
    glintL_read_table(L, ARGUMENT, "bonds", FIELDS, &a, false);
    a.desc = (glint_bonds_desc) { .closest = a.closest, .radius = a.radius,
                                  .xy = a.tilt[0], .xz = a.tilt[1], .yz = a.tilt[2] };
    read_points(L, &a.desc);
    const glintL_array *reach = check_array(L, "reach", REACH);
    if (reach->width != 1 || reach->count != a.desc.count)
        return glintL_error(L, "bonds: a position and a reach for each atom expected");
    a.desc.reach = reach->numbers;
    for (int c = 0; c < 3; c++) {
        a.desc.low[c] = a.low[c];
        a.desc.size[c] = a.size[c];
        a.desc.periodic[c] = a.periodic[c] != 0;
    }
    glint_material **pointers = glintL_many_prepare(L, &MANY, &a.desc.material_count);
    const glint_shape *spheres = glintL_test_object(L, POINTS, GLINTL_SHAPE);
    if (!spheres)
        a.desc.material_index = glintL_many_index(L, &MANY, a.desc.count, a.desc.material_count);
    else if (a.desc.material_count > 1)
        a.desc.material_index = glint_spheres_index(spheres);
    glintL_many_read(L, &MANY, a.desc.material_count, pointers);
    a.desc.materials = pointers;
    const glint_status status = glint_bonds_create(&a.desc, &shape, &error);
    if (status)
        return glintL_error(L, "bonds: %s", error.message);
    box->object = shape;
    const size_t count = shape ? glint_spheres_count(shape) : 0;
    glintL_many_keep(L, &MANY, BOX);
    lua_settop(L, BOX);
    if (shape) {
        glintL_remember(L, shape);
        glintL_charge(L, count * 7 * sizeof(double));
    } else
        lua_pushnil(L);
    lua_pushinteger(L, (lua_Integer)(count / 2));
    return 2;
}
