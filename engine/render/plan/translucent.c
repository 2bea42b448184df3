#include "engine/render/plan/translucent.h"

#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/render/plan/plan.h"
#include "engine/render/program/weigh.h"

#include <stdlib.h>

// ---- One material ----

static bool is_black(const double color[3]) { return color[0] == 0 && color[1] == 0 && color[2] == 0; }

/// Stores a program that was made: `out` owns it, and `field` of the description reads it.
static void own(glint_translucent *out, glint_program *program, glint_program **field)
{
    out->made[out->made_count++] = program;
    *field = program;
}

/// Multiplies a field by the opacity. A number times a program becomes a program.
static glint_status weigh(glint_translucent *out, const glint_share *share, double color[3], glint_program **field,
                          glint_error *error)
{
    glint_program *made = NULL;
    glint_status status = GLINT_OK;
    if (*field)
        status = glint_share_program(share, *field, &made, error);
    else if (share->program && !is_black(color))
        status = glint_share_color(share, color, &made, error);
    if (made)
        own(out, made, field);
    for (int c = 0; c < 3 && !made && color; c++)
        color[c] *= share->program ? 0 : share->number; // with a program it is black
    return status;
}

/// Multiplies all fields that contribute to a surface's light. resolved: the description with all derived values.
static glint_status weigh_all(glint_translucent *out, const glint_material_desc *resolved, const glint_share *share,
                              glint_error *error)
{
    glint_material_desc *d = &out->desc;
    glint_material_programs *programs = &d->program;
    glint_status status = weigh(out, share, d->diffuse, &programs->diffuse, error);
    if (!status && (d->has_ambient || programs->ambient)) // otherwise it follows fields that are multiplied
        status = weigh(out, share, d->ambient, &programs->ambient, error);
    for (int c = 0; c < 3; c++) {
        d->specular[c] = resolved->specular[c];
        d->mirror[c] = resolved->mirror[c];
    }
    d->has_specular = d->has_mirror = true;
    if (!status)
        status = weigh(out, share, d->specular, &programs->specular, error);
    if (!status && !glint_material_has_facets(d)) // they multiply `mirror` by `specular`
        status = weigh(out, share, d->mirror, &programs->mirror, error);
    if (!status)
        status = weigh(out, share, d->transmission, &programs->transmission, error);
    if (!status && programs->shader)
        status = weigh(out, share, NULL, &programs->shader, error);
    return status;
}

static glint_status fill(glint_translucent *out, const glint_material_desc *desc, glint_error *error)
{
    const glint_share share = { desc->program.opacity, desc->opacity };
    glint_material_desc resolved = *desc;
    out->desc = *desc;
    out->blends = glint_material_blends(desc);
    if (!out->blends)
        return GLINT_OK;
    glint_material_desc_resolve(&resolved);
    out->desc.opacity = 1;
    out->desc.program.opacity = NULL;
    out->clear = share.program ? 0 : 1 - share.number;
    glint_status status = weigh_all(out, &resolved, &share, error);
    if (!status && share.program)
        status = glint_share_rest(&share, &out->program, error);
    return status;
}

// ---- All of a plan ----

glint_status glint_plan_find_translucent(glint_plan *plan, glint_error *error)
{
    const glint_list *list = &plan->geometry->materials;
    glint_status status = GLINT_OK;
    bool any = false;
    for (size_t i = 0; i < list->count; i++)
        any = any || glint_material_blends(&((const glint_material *)list->items[i])->desc);
    if (!any)
        return GLINT_OK;
    plan->translucent = glint_alloc(list->count, sizeof *plan->translucent);
    if (!plan->translucent)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < list->count && !status; i++)
        status = fill(&plan->translucent[i], &((const glint_material *)list->items[i])->desc, error);
    return status;
}

void glint_plan_translucent_free(glint_plan *plan)
{
    for (size_t i = 0; plan->translucent && i < plan->geometry->materials.count; i++) {
        glint_program_release(plan->translucent[i].program);
        for (size_t k = 0; k < plan->translucent[i].made_count; k++)
            glint_program_release(plan->translucent[i].made[k]);
    }
    free(plan->translucent);
}

const glint_material_desc *glint_plan_material(const glint_plan *plan, size_t index)
{
    return plan->translucent ? &plan->translucent[index].desc
                             : &((const glint_material *)plan->geometry->materials.items[index])->desc;
}
