#include "engine/base/status.h"
#include "engine/scene/objects.h"

#include <stdio.h>
#include <stdlib.h>

glint_material_desc glint_material_desc_default(void)
{
    return (glint_material_desc) {
        .model = GLINT_MODEL_PHONG, .diffuse = { 0.8, 0.8, 0.8 }, .shininess = 32, .roughness = 0.3, .ior = 1.5
    };
}

static glint_status check_f0(const double f0[3], glint_error *error)
{
    glint_status status = glint_check_color("f0", f0, error);
    for (int c = 0; c < 3 && !status; c++)
        if (f0[c] > 1)
            status =
                glint_fail(error, GLINT_ERR_INVALID, "f0: at most 1 expected, got %g: no surface reflects more", f0[c]);
    return status;
}

static glint_status check(const glint_material_desc *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    if (desc->model > GLINT_MODEL_COOK_TORRANCE)
        status = glint_fail(error, GLINT_ERR_INVALID, "model: no such model");
    if (!status && desc->has_ambient)
        status = glint_check_color("ambient", desc->ambient, error);
    if (!status)
        status = glint_check_color("diffuse", desc->diffuse, error);
    if (!status)
        status = glint_check_color("specular", desc->specular, error);
    if (!status)
        status = glint_check_range("shininess", desc->shininess, 0, 1.7976931348623157e308, "number >= 0", error);
    if (!status && desc->has_mirror)
        status = glint_check_color("mirror", desc->mirror, error);
    if (!status)
        status = glint_check_color("transmission", desc->transmission, error);
    if (!status)
        status =
            glint_check_range("ior", desc->ior, 4.9406564584124654e-324, 1.7976931348623157e308, "number > 0", error);
    if (!status)
        status = glint_check_color("absorption", desc->absorption, error);
    if (!status)
        status = glint_check_range("roughness", desc->roughness, 0, 1, "number 0 .. 1", error);
    if (!status && desc->distribution > GLINT_DISTRIBUTION_BECKMANN)
        status = glint_fail(error, GLINT_ERR_INVALID, "distribution: no such distribution");
    if (!status && desc->has_f0)
        status = check_f0(desc->f0, error);
    return status;
}

glint_status glint_material_create(const glint_material_desc *desc, glint_material **out, glint_error *error)
{
    glint_status status = check(desc, error);
    if (status)
        return status;
    glint_material *material = malloc(sizeof *material);
    if (!material)
        return glint_fail_nomem(error);
    *material = (glint_material) { .references = 1, .desc = *desc };
    *out = material;
    return GLINT_OK;
}

glint_status glint_material_set(glint_material *material, const glint_material_desc *desc, glint_error *error)
{
    glint_status status = check(desc, error);
    if (!status)
        material->desc = *desc;
    return status;
}

const glint_material_desc *glint_material_get(const glint_material *material) { return &material->desc; }

glint_material *glint_material_retain(glint_material *material)
{
    if (material)
        material->references++;
    return material;
}

void glint_material_release(glint_material *material)
{
    if (material && --material->references == 0)
        free(material);
}

void glint_material_desc_resolve(glint_material_desc *desc)
{
    const double r = desc->ior < 1e300 ? (desc->ior - 1) / (desc->ior + 1) : 1;
    for (int c = 0; c < 3; c++) {
        if (!desc->has_ambient)
            desc->ambient[c] = desc->diffuse[c];
        if (!desc->has_specular && desc->model == GLINT_MODEL_COOK_TORRANCE)
            desc->specular[c] = 1;
        if (!desc->has_f0)
            desc->f0[c] = r * r;
        if (!desc->has_mirror)
            desc->mirror[c] = desc->fresnel;
    }
    desc->has_ambient = desc->has_specular = desc->has_f0 = desc->has_mirror = true;
}

bool glint_material_is_shiny(const glint_material_desc *desc)
{
    glint_material_desc d = *desc;
    glint_material_desc_resolve(&d);
    return d.model != GLINT_MODEL_LAMBERT && (d.specular[0] > 0 || d.specular[1] > 0 || d.specular[2] > 0);
}

void glint_describe_material(const glint_material_desc *desc, const char *owner, char *out, size_t size)
{
    if (desc->name[0])
        snprintf(out, size, "material '%s'", desc->name);
    else
        snprintf(out, size, "material of %s", owner);
}
