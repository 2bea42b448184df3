/// The pattern of a material's picture: map_Kd of .mtl files.
#include "engine/scene/mesh_mtl.h"

#include <math.h>

typedef struct painter {
    glint_builder *builder;
    glint_status status;
    glint_error *error;
} painter;

static glint_value number_of(painter *p, double number)
{
    glint_value out = 0;
    if (!p->status)
        p->status = glint_builder_number(p->builder, number, &out, p->error);
    return out;
}

static glint_value input_of(painter *p, glint_input input)
{
    glint_value out = 0;
    if (!p->status)
        p->status = glint_builder_input(p->builder, input, &out, p->error);
    return out;
}

static glint_value apply(painter *p, glint_op op, glint_value a, glint_value b)
{
    const glint_value operands[] = { a, b };
    glint_value out = 0;
    if (!p->status)
        p->status = glint_builder_op(p->builder, op, operands, &out, p->error);
    return out;
}

/// What is made of a number comes after the other value: a builder numbers them in the order in which they are made.
static glint_value with_number(painter *p, glint_op op, glint_value a, double number)
{
    const glint_value b = number_of(p, number);
    return apply(p, op, a, b);
}

/// A coordinate times the scale of the map, moved by its offset.
static glint_value place_of(painter *p, const glint_mesh_map *map, int axis)
{
    const glint_value at = input_of(p, axis ? GLINT_INPUT_UV_V : GLINT_INPUT_UV_U);
    return with_number(p, GLINT_OP_ADD, with_number(p, GLINT_OP_MUL, at, map->scale[axis]), map->offset[axis]);
}

glint_status glint_mesh_paint(const glint_texture *texture, const glint_mesh_map *map, const double kd[3],
                              glint_program **out, glint_error *error)
{
    painter p = { .error = error };
    glint_value color[4] = { 0 };
    p.status = glint_builder_create(GLINT_PROGRAM_PATTERN, &p.builder, error);
    const glint_value u = place_of(&p, map, 0), v = place_of(&p, map, 1);
    const double most = fmax(fabs(map->scale[0]), fabs(map->scale[1]));
    const glint_value width = with_number(&p, GLINT_OP_MUL, input_of(&p, GLINT_INPUT_UV_FOOTPRINT), most);
    if (!p.status)
        p.status = glint_builder_texel(p.builder, texture, u, v, width, color, error);
    for (int c = 0; c < 3; c++)
        color[c] = with_number(&p, GLINT_OP_MUL, color[c], kd[c]);
    if (!p.status)
        p.status = glint_builder_finish(p.builder, color, 3, out, error);
    glint_builder_destroy(p.builder);
    return p.status;
}
