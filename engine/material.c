#include "engine/base/status.h"
#include "engine/objects.h"

#include <stdio.h>
#include <stdlib.h>

glint_material_desc glint_material_desc_default(void)
{
    return (
        glint_material_desc) { .model = GLINT_MODEL_PHONG, .diffuse = { 0.8, 0.8, 0.8 }, .shininess = 32, .ior = 1.5 };
}

static glint_status check(const glint_material_desc *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    if (desc->model > GLINT_MODEL_LAMBERT)
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

void glint_describe_material(const glint_material_desc *desc, const char *owner, char *out, size_t size)
{
    if (desc->name[0])
        snprintf(out, size, "material '%s'", desc->name);
    else
        snprintf(out, size, "material of %s", owner);
}
