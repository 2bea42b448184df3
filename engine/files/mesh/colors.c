/// Colours and pictures of vertices and faces. Each face gets a material of one colour: the face's colour, or the
/// mean colour of its corners.
#include "engine/base/status.h"
#include "engine/files/mesh/mtl.h"
#include "engine/glint_files.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define GREY_CODE 231 ///< 8-bit value of default materials: 0.8 of the light
#define FAR_ABOVE_1 16.0 ///< no colour with the range 0 .. 1 has numbers this large

/// Computes the light of each 8-bit value.
static void fill_lights(double lights[256])
{
    for (int code = 0; code < 256; code++)
        lights[code] = glint_srgb_decode(code / 255.0);
}

/// Returns the 8-bit value of the mean light of a face's corners in channel c. If all corners have the same value,
/// returns exactly this value.
static uint8_t mean_code(const uint8_t (*colors)[3], const uint32_t *corners, uint32_t count, int c,
                         const double lights[256])
{
    double sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += lights[colors[corners[i]][c]];
    return (uint8_t)(glint_srgb_encode(sum / count) * 255 + 0.5);
}

static glint_status add_material(glint_mesh_array *materials, uint32_t color, const double lights[256],
                                 glint_error *error)
{
    glint_material_desc desc = glint_material_desc_default();
    glint_material *material;
    for (int c = 0; c < 3; c++)
        desc.diffuse[c] = lights[color >> (16 - 8 * c) & 255];
    snprintf(desc.name, sizeof desc.name, "#%06x", (unsigned)color);
    glint_status status = glint_material_create(&desc, &material, error);
    if (!status && (status = glint_mesh_append(materials, &material, error)))
        glint_material_release(material);
    return status;
}

/// Returns whether numbers are 8-bit values 0 .. 255. Colours with the range 0 .. 1 may be a little above 1, but then
/// have fractional numbers.
static bool are_codes(const double *numbers, size_t count)
{
    double most = 0;
    bool whole = true;
    for (size_t i = 0; i < count; i++) {
        most = fmax(most, numbers[i]);
        whole = whole && numbers[i] == floor(numbers[i]);
    }
    return most > (whole ? 1 : FAR_ABOVE_1);
}

glint_status glint_mesh_take_colors(glint_mesh_reader *r, size_t count)
{
    const double *v = r->numbers_of_colors.items;
    const size_t known = r->numbers_of_colors.count;
    const double scale = are_codes(v, 3 * known) ? 1 : 255;
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < count && !status; i++) {
        uint8_t codes[3];
        for (size_t c = 0; c < 3; c++) {
            const bool has = i < known && v[3 * i + c] != GLINT_MESH_NO_COLOR;
            codes[c] = has ? (uint8_t)(fmin(v[3 * i + c] * scale, 255) + 0.5) : GREY_CODE;
        }
        status = glint_mesh_append(&r->colors, codes, r->error);
    }
    return status;
}

glint_status glint_mesh_color_faces(glint_mesh_reader *r)
{
    const uint8_t(*colors)[3] = r->colors.items;
    const uint32_t *corners = r->corners.items, *sizes = r->sizes.items;
    glint_mesh_array shades = { .size = sizeof(uint32_t) }; // the colour 0xrrggbb of each material
    glint_mesh_set set = { 0 };
    glint_status status = GLINT_OK;
    double lights[256];
    fill_lights(lights);
    for (size_t i = 0; i < r->sizes.count && !status; corners += sizes[i++]) {
        uint32_t color = 0, number = 0;
        for (int c = 0; c < 3; c++)
            color = color << 8 | (r->colors_of_faces ? colors[i][c] : mean_code(colors, corners, sizes[i], c, lights));
        status = glint_mesh_find(&set, &shades, &color, sizeof color, &number, r->error);
        if (!status && shades.count > r->materials.count)
            status = add_material(&r->materials, color, lights, r->error);
        if (!status)
            status = glint_mesh_append(&r->material_index, &number, r->error);
    }
    free(shades.items);
    free(set.slots);
    return status;
}

/// Makes a material whose diffuse colour is a picture.
static glint_status make_painted(const glint_texture *texture, const char *name, glint_material **out,
                                 glint_error *error)
{
    static const glint_mesh_map whole = { .scale = { 1, 1 } };
    static const double one[3] = { 1, 1, 1 };
    glint_material_desc desc = glint_material_desc_default();
    glint_program *paint = NULL;
    glint_status status = glint_mesh_paint(texture, &whole, one, 3, &paint, error);
    desc.program.diffuse = paint;
    snprintf(desc.name, sizeof desc.name, "%.60s", name);
    if (!status)
        status = glint_material_create(&desc, out, error);
    glint_program_release(paint);
    return status;
}

glint_status glint_mesh_picture_faces(glint_mesh_reader *r, const char *name)
{
    const glint_texture_desc desc = glint_texture_desc_default();
    glint_texture *texture = NULL;
    glint_material *material = NULL;
    glint_error inner;
    char *path = glint_mesh_sibling(r->text.path, name);
    if (!path)
        return glint_fail_nomem(r->error);
    if (r->desc->reads)
        r->desc->reads(r->desc->context, path);
    glint_status status = glint_texture_read(path, &desc, &texture, &inner);
    free(path);
    if (status == GLINT_ERR_NOMEM)
        return glint_fail_nomem(r->error);
    if (status) {
        glint_mesh_note_that(r, GLINT_MESH_NOTE_PICTURE, 0, "its picture is ignored: %.120s", inner.message);
        return GLINT_OK;
    }
    status = make_painted(texture, name, &material, r->error);
    glint_texture_release(texture);
    if (!status && (status = glint_mesh_append(&r->materials, &material, r->error)))
        glint_material_release(material);
    return status;
}
