/// The pattern of a material's picture: map_Kd, map_Ks, map_d and map_Bump of .mtl files.
#include "engine/base/maker.h"
#include "engine/files/mesh/mtl.h"

#include <math.h>

/// Makes the value of a texture coordinate: multiplied by the map's scale, plus the map's offset.
static glint_value coord_of(glint_maker *p, const glint_mesh_map *map, int axis)
{
    const glint_value at = glint_maker_input(p, axis ? GLINT_INPUT_UV_V : GLINT_INPUT_UV_U);
    return glint_maker_with(p, GLINT_OP_ADD, glint_maker_with(p, GLINT_OP_MUL, at, map->scale[axis]), map->offset[axis]);
}

glint_status glint_mesh_paint(const glint_texture *texture, const glint_mesh_map *map, const double factor[3], size_t channels,
                              glint_program **out, glint_error *error)
{
    glint_maker p = { .error = error };
    glint_value color[4] = { 0 };
    p.status = glint_builder_create(GLINT_PROGRAM_PATTERN, &p.builder, error);
    const glint_value u = coord_of(&p, map, 0), v = coord_of(&p, map, 1);
    const bool square = glint_texture_width(texture) == glint_texture_height(texture);
    const double most = fmax(fabs(map->scale[0]), fabs(map->scale[1]));
    glint_value width[2];
    for (int k = 0; k < 2; k++) {
        const glint_input input = square ? GLINT_INPUT_UV_FOOTPRINT : k ? GLINT_INPUT_UV_FOOTPRINT_V : GLINT_INPUT_UV_FOOTPRINT_U;
        width[k] = glint_maker_with(&p, GLINT_OP_MUL, glint_maker_input(&p, input), square ? most : fabs(map->scale[k]));
    }
    if (!p.status)
        p.status = glint_builder_texel_by_axis(p.builder, texture, u, v, width, color, error);
    for (int c = 0; c < 3; c++)
        color[c] = glint_maker_with(&p, GLINT_OP_MUL, color[c], factor[c]);
    if (!p.status)
        p.status = glint_builder_finish(p.builder, color, channels, out, error);
    glint_builder_destroy(p.builder);
    return p.status;
}

glint_status glint_mesh_find_grey(const glint_texture *texture, bool *grey, glint_error *error)
{
    static const double one[3] = { 1, 1, 1 },
                        // a footprint of 1 averages the whole picture
                        inputs[GLINT_INPUT_COUNT] = { [GLINT_INPUT_UV_FOOTPRINT] = 1,
                                                      [GLINT_INPUT_UV_FOOTPRINT_U] = 1,
                                                      [GLINT_INPUT_UV_FOOTPRINT_V] = 1 };
    const glint_mesh_map whole = { .scale = { 1, 1 } };
    double mean[3] = { 0 };
    glint_program *program = NULL;
    glint_status status = glint_mesh_paint(texture, &whole, one, 3, &program, error);
    if (!status)
        status = glint_program_evaluate(program, inputs, mean, error);
    glint_program_release(program);
    *grey = fabs(mean[0] - mean[1]) < 0.02 && fabs(mean[0] - mean[2]) < 0.02;
    return status;
}
