/// Visible lights: their surfaces and brightness.
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/effects/visible_light/plan.h"
#include "engine/render/scene/area_light.h"

#include <stdlib.h>

/// Fills the edges of a polygon.
static void fill_edges(glint_plan_visible_light *visible_light, glint_plan_edge *edges, const glint_light_desc *desc)
{
    visible_light->edges = edges;
    visible_light->edge_count = desc->vertex_count;
    for (size_t i = 0; i < desc->vertex_count; i++) {
        double along[3];
        vec_copy(edges[i].corner, desc->vertices[i]);
        vec_sub(along, desc->vertices[(i + 1) % desc->vertex_count], desc->vertices[i]);
        vec_cross(edges[i].inwards, visible_light->normal, along);
        vec_normalize(edges[i].inwards, edges[i].inwards);
    }
}

static void fill(glint_plan_visible_light *visible_light, glint_plan_edge *edges, const glint_light_desc *desc)
{
    visible_light->ball = desc->kind == GLINT_LIGHT_SPHERE;
    visible_light->radius = desc->radius;
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
        fill_edges(visible_light, edges, desc);
    } else {
        vec_normalize(visible_light->normal, desc->normal);
    }
}

glint_status glint_visible_lights_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error)
{
    const glint_scene *scene = from->scene;
    size_t count = 0, edges = 0;
    double shown[3];
    for (size_t i = 0; i < scene->lights.count; i++) {
        const glint_light_desc *desc = &glint_scene_light(scene, i)->desc;
        const bool shows = glint_light_shows(desc, shown);
        count += shows;
        edges += shows ? desc->vertex_count : 0;
    }
    if (count == 0)
        return GLINT_OK;
    glint_visible_lights *lights = calloc(1, sizeof *lights + count * sizeof *lights->of + edges * sizeof(glint_plan_edge));
    if (!lights)
        return glint_fail_nomem(error);
    plan->own[GLINT_STAGE_VISIBLE_LIGHT] = lights;
    glint_plan_edge *edge = (glint_plan_edge *)(lights->of + count);
    for (uint32_t i = 0; i < scene->lights.count; i++) {
        const glint_light_desc *desc = &glint_scene_light(scene, i)->desc;
        if (!glint_light_shows(desc, shown))
            continue;
        glint_plan_visible_light *light = &lights->of[lights->count++];
        vec_copy(light->shown, shown);
        light->source = i;
        fill(light, edge, desc);
        edge += light->edge_count;
    }
    return GLINT_OK;
}
