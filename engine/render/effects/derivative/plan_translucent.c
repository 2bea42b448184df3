/// Derivatives of translucent materials. A frame reads their reflectances k times their opacity o:
/// (o k)' = o k' + o' k.
#include "engine/base/status.h"
#include "engine/render/effects/derivative/slopes.h"

static void weigh(double slope[3], const double color[3], double opacity, double changes)
{
    for (int c = 0; c < 3; c++)
        slope[c] = opacity * slope[c] + changes * color[c];
}

/// Returns why a material has no derivative, or NULL. slopes: the slopes of its own description.
static const char *find_obstacle(const glint_translucent *material, const glint_material_desc *desc,
                                 const glint_material_desc *slopes)
{
    static const glint_material_desc level = { 0 };
    if (desc->program.opacity && memcmp(slopes, &level, sizeof level) != 0)
        return "a material has no derivative where a pattern blends it; use a plain number as opacity";
    if (slopes->opacity != 0 && !material->blends)
        return "0, 1 and cut-outs have no derivative; use a number between 0 and 1 that blends";
    if (slopes->opacity != 0 && material->made_count > 0)
        return "it has no derivative where patterns or a shader give the material's colours; use plain colours";
    return NULL;
}

glint_status glint_derivative_weigh(const glint_plan *plan, const glint_derivative *d, glint_scene_slopes *slopes,
                                    glint_error *error)
{
    for (size_t i = 0; i < plan->geometry->materials.count; i++) {
        static const glint_translucent opaque = { .blends = false };
        const glint_translucent *material = plan->translucent ? &plan->translucent[i] : &opaque;
        glint_material_desc desc = ((const glint_material *)plan->geometry->materials.items[i])->desc;
        glint_material_desc *slope = &slopes->materials[i];
        const double o = desc.opacity, changes = slope->opacity;
        const char *why = material->blends || changes != 0 ? find_obstacle(material, &desc, slope) : NULL;
        if (why)
            return glint_fail(error, GLINT_ERR_INVALID, "derivative '%s': material.opacity: %s", d->name, why);
        if (!material->blends)
            continue;
        glint_material_desc_resolve(&desc);
        weigh(slope->diffuse, desc.diffuse, o, changes);
        weigh(slope->ambient, desc.ambient, o, changes);
        weigh(slope->specular, desc.specular, o, changes);
        weigh(slope->mirror, desc.mirror, o, changes);
        weigh(slope->transmission, desc.transmission, o, changes);
    }
    return GLINT_OK;
}
