/// Translucent surfaces: materials as a frame reads them, with their reflectances multiplied by their opacity.
/// Internal.
///
/// A surface of opacity o gives o times the light of the material, and lets 1 - o of a ray go straight on. The first
/// part needs no stage: the light of a material is linear in its reflectances. The second part is
/// left to the effects that follow rays: bounce, indirect and transparent_shadow.
#ifndef GLINT_TRANSLUCENT_H
#define GLINT_TRANSLUCENT_H

#include "engine/glint.h"

#define GLINT_TRANSLUCENT_PROGRAMS 6 ///< fields that are multiplied by the opacity, including the model

typedef struct glint_translucent {
    glint_material_desc
        desc; ///< translucent material: multiplied by the opacity, which is 1 here; otherwise the material's own
            ///< description
    bool blends; ///< true if the material is translucent
    double clear; ///< 1 - o; 0 if a program gives it
    glint_program *program; ///< pattern of 1 - o, owned; NULL: a number
    glint_program *made[GLINT_TRANSLUCENT_PROGRAMS]; ///< the programs of `desc` that were made for it, owned
    size_t made_count;
} glint_translucent;

struct glint_plan;

/// Fills plan->translucent if some material is translucent. Runs before any other part of the plan reads a material.
glint_status glint_plan_find_translucent(struct glint_plan *plan, glint_error *error);
/// Frees plan->translucent.
void glint_plan_translucent_free(struct glint_plan *plan);
/// Returns a material of the geometry's list as the frame reads it. The description lasts as long as the plan and the
/// material.
const glint_material_desc *glint_plan_material(const struct glint_plan *plan, size_t index);

#endif
