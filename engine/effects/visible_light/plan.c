/// Visible lights: their surfaces and brightness.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/scene/area_light.h"
#include "engine/effects/visible_light/plan.h"
#include "engine/plan/light_groups.h"

#include <stdlib.h>

/// Adds the edges of a polygon to the plan's list.
static void add_edges(glint_plan *plan, glint_plan_visible_light *visible_light, const glint_light_desc *desc)
{
    visible_light->edges = plan->visible_light_edges + plan->visible_light_edge_count;
    visible_light->edge_count = desc->vertex_count;
    plan->visible_light_edge_count += desc->vertex_count;
    for (size_t i = 0; i < desc->vertex_count; i++) {
        glint_plan_edge *edge = &plan->visible_light_edges[plan->visible_light_edge_count - desc->vertex_count + i];
        double along[3];
        vec_copy(edge->corner, desc->vertices[i]);
        vec_sub(along, desc->vertices[(i + 1) % desc->vertex_count], desc->vertices[i]);
        vec_cross(edge->inwards, visible_light->normal, along);
        vec_normalize(edge->inwards, edge->inwards);
    }
}

static void add_visible_light(glint_plan *plan, const glint_light_desc *desc, const double shown[3])
{
    glint_plan_visible_light *visible_light = &plan->visible_lights[plan->visible_light_count++];
    *visible_light = (glint_plan_visible_light) { .ball = desc->kind == GLINT_LIGHT_SPHERE, .radius = desc->radius };
    vec_copy(visible_light->shown, shown);
    vec_copy(visible_light->center, desc->position);
    if (visible_light->ball)
        return;
    visible_light->one_sided = !desc->two_sided;
    if (desc->kind == GLINT_LIGHT_POLYGON) {
        glint_light_sample_polygon_normal(desc, visible_light->normal);
        vec_copy(visible_light->center, desc->vertices[0]);
        visible_light->radius = 0;
        for (size_t i = 1; i < desc->vertex_count; i++) { // the whole polygon is within this distance of its first corner
            double away[3];
            vec_sub(away, desc->vertices[i], desc->vertices[0]);
            visible_light->radius = fmax(visible_light->radius, sqrt(vec_dot(away, away)) * (1 + 1e-12));
        }
        add_edges(plan, visible_light, desc);
    } else {
        vec_normalize(visible_light->normal, desc->normal);
    }
}

glint_status glint_visible_lights_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error)
{
    const glint_scene *scene = from->scene;
    size_t lights = 0, edges = 0;
    double shown[3];
    for (size_t i = 0; i < scene->lights.count; i++) {
        const glint_light_desc *desc = &glint_scene_light(scene, i)->desc;
        const bool shows = glint_light_shows(desc, shown);
        lights += shows;
        edges += shows ? desc->vertex_count : 0;
    }
    if (lights == 0)
        return GLINT_OK;
    plan->visible_lights = glint_alloc(lights, sizeof *plan->visible_lights);
    plan->visible_light_edges = glint_alloc(edges + 1, sizeof *plan->visible_light_edges);
    if (!plan->visible_lights || !plan->visible_light_edges)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < scene->lights.count; i++) {
        const glint_light_desc *desc = &glint_scene_light(scene, i)->desc;
        if (!glint_light_shows(desc, shown))
            continue;
        add_visible_light(plan, desc, shown);
        plan->visible_lights[plan->visible_light_count - 1].group = glint_light_group_of(plan, i);
    }
    return GLINT_OK;
}

void glint_visible_lights_release(glint_plan *plan)
{
    free(plan->visible_lights);
    free(plan->visible_light_edges);
}
