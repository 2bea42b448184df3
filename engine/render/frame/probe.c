/// Single rays and reflections, computed by the frame's own kernels, for debugging and tests.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/plan/plan.h"

#include <stdlib.h>

#define LEAST 0.01 ///< share of the first ray's light below which a path does not follow a ray

/// A group of which only lane 0 is used.
typedef struct lane_group {
    _Alignas(64) double origin[3][GLINT_GROUP], direction[3][GLINT_GROUP], point[3][GLINT_GROUP],
        normal[3][GLINT_GROUP];
    _Alignas(64) double reflected[3][GLINT_GROUP], refracted[3][GLINT_GROUP];
    _Alignas(64) double t[GLINT_GROUP], ratio[GLINT_GROUP], reflectance[GLINT_GROUP];
    _Alignas(64) uint32_t prim[GLINT_GROUP], material[GLINT_GROUP], leaving[GLINT_GROUP];
    _Alignas(64) float cosine[GLINT_GROUP], log2_specular[GLINT_GROUP];
    _Alignas(64) float facing[GLINT_GROUP], sine2[GLINT_GROUP], schlick[GLINT_GROUP];
    _Alignas(64) double sum[GLINT_TERM_COUNT][3][GLINT_GROUP];
    uint16_t active, hits, lit, back, dark, inward, total;
} lane_group;

static void cast_lane(const glint_stages *stages, const glint_geometry_table *geometry, lane_group *g)
{
    glint_cast_args cast = { .group_count = 1, .active = &g->active, .geometry = geometry, .leaving = g->leaving,
                             .inward = &g->inward, .t = g->t, .prim = g->prim, .hits = &g->hits };
    glint_surface_args surface = { .group_count = 1,
                                   .hits = &g->hits,
                                   .prim = g->prim,
                                   .prims = geometry->prims,
                                   .mixed = geometry->triangles || geometry->solids,
                                   .scale = geometry->scale,
                                   .solids = geometry->solids,
                                   .t = g->t,
                                   .material = g->material,
                                   .back = &g->back,
                                   .dark = &g->dark };
    for (int c = 0; c < 3; c++) {
        cast.origin[c] = surface.origin[c] = g->origin[c];
        cast.direction[c] = surface.direction[c] = g->direction[c];
        surface.point[c] = g->point[c];
        surface.normal[c] = g->normal[c];
    }
    stages->geometry[GLINT_PRECISION_DOUBLE].cast_rays(&cast);
    if (g->hits & 1)
        stages->geometry[GLINT_PRECISION_DOUBLE].surface(&surface);
}

/// Returns the number of a part of a combined solid, from 0. whole: id of the solid. id: id of the part or, if the
/// part is a mesh, of one of its triangles.
static size_t part_number(const glint_geometry *geometry, uint32_t whole, uint32_t id)
{
    // triangles come after
    const uint32_t count = geometry->hull_count ? geometry->hulls[0].first : geometry->member_count;
    size_t parts = 0;
    for (uint32_t i = 0; i < count; i++) {
        const glint_prim *member = &geometry->members[i];
        const bool first = member->kind == GLINT_PRIM_PLANE || member->face <= 1; // the first primitive of a part
        parts += member->id > whole && member->id <= id && first;
    }
    return parts - 1;
}

static void read_hit(const glint_geometry *geometry, uint32_t id, const lane_group *g, double scale, glint_hit *out)
{
    const glint_part *part = &geometry->parts[geometry->prim_part[id]];
    *out = (glint_hit) { .t = g->t[0] * scale, .shape = part->shape, .element = id - part->first_prim };
    for (uint32_t whole = id; part->whole; whole--) { // the id of a solid precedes the ids of its parts
        const glint_part *other = &geometry->parts[geometry->prim_part[whole]];
        if (other->whole)
            continue;
        out->shape = part->whole;
        out->element = part_number(geometry, whole, id);
        break;
    }
    const double sign = g->back & 1 ? -1 : 1;
    for (int c = 0; c < 3; c++) {
        out->point[c] = g->point[c][0];
        out->normal[c] = g->normal[c][0] * sign;
    }
}

/// Chooses kernels for single rays and materials: the reference's in a build that leaves some of them out.
static glint_status choose_stages(const glint_stages **out, glint_error *error)
{
    const glint_status status = glint_choose_isa(NULL, out, error);
    if (!status && !((*out)->geometry[GLINT_PRECISION_DOUBLE].bounce && (*out)->geometry[GLINT_PRECISION_DOUBLE].facet))
        *out = &glint_stages_ref;
    return status;
}

glint_status glint_scene_cast(const glint_scene *scene, const double origin[3], const double direction[3], bool *hit,
                              glint_hit *out, glint_error *error)
{
    GLINT_REFUSE_NULL(scene, error);
    GLINT_REFUSE_NULL(origin, error);
    GLINT_REFUSE_NULL(direction, error);
    GLINT_REFUSE_NULL(hit, error);
    GLINT_REFUSE_NULL(out, error);
    const glint_stages *stages;
    glint_status status = glint_check_vector("origin", origin, error);
    if (!status)
        status = glint_check_direction("direction", direction, error);
    if (!status)
        status = choose_stages(&stages, error);
    if (status)
        return status;
    double scaled[3];
    const double scale = vec_rescale(scaled, direction);
    lane_group *g = glint_alloc(1, sizeof *g);
    if (!g)
        return glint_fail_nomem(error);
    glint_geometry *geometry = NULL;
    glint_geometry_table table;
    status = glint_geometry_of(scene, &geometry, error);
    if (!status)
        status = glint_geometry_check_reach(geometry, "origin", origin, error);
    if (!status)
        status = glint_geometry_index(geometry, NULL, &table, error);
    if (!status) {
        g->active = 1;
        for (int i = 0; i < GLINT_GROUP; i++) {
            g->leaving[i] = GLINT_MISS;
            for (int c = 0; c < 3; c++) {
                g->origin[c][i] = origin[c];
                g->direction[c][i] = scaled[c];
            }
        }
        cast_lane(stages, &table, g);
        *hit = g->hits & 1;
        if (*hit)
            read_hit(geometry, table.prims[g->prim[0]].id, g, scale, out);
    }
    glint_geometry_release(geometry);
    free(g);
    return status;
}

// ---- Paths ----

typedef struct ray {
    double weight; ///< share of the first ray's light, the mean of red, green and blue
    glint_media media; ///< the media that contain its origin
    uint32_t depth; ///< number of surfaces before its origin
    uint32_t leaving; ///< primitive that it starts on, or GLINT_MISS
    bool inward; ///< whether it goes into that primitive
} ray;

typedef struct tracer {
    const glint_stages *stages;
    const glint_geometry *geometry;
    glint_geometry_table table;
    lane_group *g;
    ray rays[GLINT_SEGMENTS_MAX]; ///< the ray of each segment
    glint_segment *segments;
    size_t count;
} tracer;

static const glint_material_desc *material_at(const tracer *t, uint32_t index)
{
    return glint_material_get(t->geometry->materials.items[index]);
}

static double index_of(const tracer *t, uint32_t medium)
{
    return medium == GLINT_NO_MEDIUM ? 1 : material_at(t, medium)->ior;
}

/// Casts ray number `i` and computes the surface that it hits.
static void cast_segment(tracer *t, size_t i)
{
    lane_group *g = t->g;
    glint_segment *segment = &t->segments[i];
    for (int c = 0; c < 3; c++) {
        g->origin[c][0] = segment->from[c];
        g->direction[c][0] = segment->direction[c];
    }
    g->active = 1;
    g->leaving[0] = t->rays[i].leaving;
    g->inward = t->rays[i].inward;
    cast_lane(t->stages, &t->table, g);
    segment->hit = g->hits & 1;
    for (int c = 0; c < 3; c++)
        segment->to[c] = g->point[c][0];
}

/// Computes the directions in which a ray goes on from the hit in the lanes. ratio: the refractive index on its side
/// divided by the index beyond.
static void bounce(tracer *t, double ratio)
{
    lane_group *g = t->g;
    glint_bounce_args args = { .group_count = 1, .wanted = &g->active, .ratio = g->ratio,
                               .reflectance = g->reflectance, .total = &g->total };
    g->ratio[0] = ratio;
    for (int c = 0; c < 3; c++) {
        args.direction[c] = g->direction[c];
        args.normal[c] = g->normal[c];
        args.reflected[c] = g->reflected[c];
        args.refracted[c] = g->refracted[c];
    }
    t->stages->geometry[GLINT_PRECISION_DOUBLE].bounce(&args);
}

/// Adds a ray from the end of segment `i`, if it carries enough light and there is space.
static void send(tracer *t, size_t i, const ray *r, double direction[3][GLINT_GROUP])
{
    if (r->weight < LEAST || t->count == GLINT_SEGMENTS_MAX)
        return;
    glint_segment *segment = &t->segments[t->count];
    vec_copy(segment->from, t->segments[i].to);
    for (int c = 0; c < 3; c++)
        segment->direction[c] = direction[c][0];
    t->rays[t->count++] = *r;
}

static double mean(const double color[3]) { return (color[0] + color[1] + color[2]) / 3; }

/// Returns the share of the light along the mirrored ray, without Fresnel's formula.
static double mirror_of(const glint_material_desc *desc)
{
    return desc->program.mirror ? 1 : desc->has_mirror ? mean(desc->mirror) : desc->fresnel;
}

/// Sends on the rays of the hit of segment `i`, which is in the lanes.
static void go_on(tracer *t, size_t i)
{
    const lane_group *g = t->g;
    const glint_prim *prim = &t->table.prims[g->prim[0]];
    const glint_material_desc *desc = material_at(t, g->material[0]);
    const bool back = g->back & 1;
    const double transmission = desc->program.transmission ? 1 : mean(desc->transmission);
    ray mirrored = t->rays[i], refracted = mirrored;
    uint32_t before = glint_media_top(&mirrored.media), beyond = g->material[0];
    if (transmission > 0) {
        before = glint_media_before(&mirrored.media, prim->medium, back);
        glint_media_cross(&refracted.media, prim->medium, back);
        beyond = glint_media_top(&refracted.media);
    }
    bounce(t, transmission > 0 || desc->fresnel ? index_of(t, before) / index_of(t, beyond) : 1);
    const bool total = g->total & 1;
    const double part = desc->fresnel ? g->reflectance[0] : 1, mirror = total && transmission > 0 ? 1 : mirror_of(desc) * part;
    mirrored.depth = refracted.depth = mirrored.depth + 1;
    mirrored.leaving = refracted.leaving = g->prim[0];
    mirrored.inward = back;
    refracted.inward = !back;
    mirrored.weight *= mirror;
    refracted.weight *= total ? 0 : transmission * (desc->fresnel ? 1 - part : 1);
    send(t, i, &refracted, t->g->refracted);
    send(t, i, &mirrored, t->g->reflected);
}

/// Follows the ray of the first segment. Returns the number of segments.
static size_t follow(tracer *t, uint32_t depth)
{
    t->rays[0] = (ray) { .weight = 1, .leaving = GLINT_MISS };
    t->count = 1;
    for (size_t i = 0; i < t->count; i++) {
        cast_segment(t, i);
        if (t->segments[i].hit && t->rays[i].depth < depth)
            go_on(t, i);
    }
    return t->count;
}

glint_status glint_scene_path(const glint_scene *scene, const double origin[3], const double direction[3], uint32_t depth,
                              glint_segment out[GLINT_SEGMENTS_MAX], size_t *count, glint_error *error)
{
    GLINT_REFUSE_NULL(scene, error);
    GLINT_REFUSE_NULL(origin, error);
    GLINT_REFUSE_NULL(direction, error);
    GLINT_REFUSE_NULL(out, error);
    GLINT_REFUSE_NULL(count, error);
    glint_status status = glint_check_vector("origin", origin, error);
    if (!status)
        status = glint_check_direction("direction", direction, error);
    if (status)
        return status;
    tracer *t = calloc(1, sizeof *t);
    lane_group *g = glint_alloc(1, sizeof *g);
    glint_geometry *geometry = NULL;
    if (!t || !g)
        status = glint_fail_nomem(error);
    else
        status = choose_stages(&t->stages, error);
    if (!status)
        status = glint_geometry_of(scene, &geometry, error);
    if (!status)
        status = glint_geometry_check_reach(geometry, "origin", origin, error);
    if (!status)
        status = glint_geometry_index(geometry, NULL, &t->table, error);
    if (!status) {
        t->geometry = geometry;
        t->g = g;
        t->segments = out;
        vec_copy(out[0].from, origin);
        vec_normalize(out[0].direction, direction);
        *count = follow(t, depth);
    }
    glint_geometry_release(geometry);
    free(g);
    free(t);
    return status;
}

// ---- Reflections ----

/// Runs the stages of microfacets, after `light`.
static void evaluate_facets(const glint_stages *stages, const glint_light_args *light, lane_group *g)
{
    glint_view_args view = { .group_count = 1, .hits = &g->hits, .facing = g->facing };
    glint_facet_args facet = { .group_count = 1,
                               .material = light->material,
                               .materials = light->materials,
                               .directional = true,
                               .scale = 1,
                               .sample_count = 1,
                               .lit = { &g->lit },
                               .sine2 = { g->sine2 },
                               .schlick = { g->schlick } };
    vec_copy(facet.position, light->position);
    for (int c = 0; c < 3; c++) {
        facet.point[c] = g->point[c];
        facet.normal[c] = view.normal[c] = g->normal[c];
        facet.direction[c] = view.direction[c] = g->direction[c];
    }
    stages->geometry[GLINT_PRECISION_DOUBLE].view(&view);
    stages->geometry[GLINT_PRECISION_DOUBLE].facet(&facet);
}

static void evaluate_lane(const glint_stages *stages, const glint_material_desc *desc, const double to_light[3],
                          lane_group *g)
{
    static const double black[3] = { 0 }, white[3] = { 1, 1, 1 };
    glint_shade_material material;
    glint_shade_material_init(&material, desc, black);
    glint_light_args light = { .group_count = 1,
                               .hits = &g->hits,
                               .material = g->material,
                               .materials = &material,
                               .dark = &g->dark,
                               .directional = true,
                               .scale = 1,
                               .sample_count = 1,
                               .highlights = material.highlight && material.highlight != GLINT_HIGHLIGHT_FACETS,
                               .lit = { &g->lit },
                               .cosine = { g->cosine },
                               .log2_specular = { g->log2_specular } };
    vec_copy(light.position, to_light);
    glint_shade_light strength = {
        .lit = &g->lit, .cosine = g->cosine, .log2_specular = g->log2_specular, .sine2 = g->sine2, .schlick = g->schlick
    };
    vec_copy(strength.diffuse, white);
    vec_copy(strength.specular, white);
    glint_shade_args shade = { .group_count = 1,
                               .active = &g->active,
                               .hits = &g->hits,
                               .material = g->material,
                               .materials = &material,
                               .facing = g->facing,
                               .highlights = material.highlight,
                               .first = true,
                               .lights = &strength,
                               .light_count = 1 };
    for (int c = 0; c < 3; c++) {
        light.point[c] = g->point[c];
        light.normal[c] = g->normal[c];
        light.direction[c] = g->direction[c];
        for (int k = 0; k < GLINT_TERM_COUNT; k++)
            shade.sum[k][c] = g->sum[k][c];
    }
    stages->geometry[GLINT_PRECISION_DOUBLE].light(&light);
    if (material.highlight == GLINT_HIGHLIGHT_FACETS)
        evaluate_facets(stages, &light, g);
    stages->shade(&shade);
}

glint_status glint_material_evaluate(const glint_material *material, const double normal[3], const double to_light[3],
                                     const double to_eye[3], glint_reflection *out, glint_error *error)
{
    GLINT_REFUSE_NULL(material, error);
    GLINT_REFUSE_NULL(normal, error);
    GLINT_REFUSE_NULL(to_light, error);
    GLINT_REFUSE_NULL(to_eye, error);
    GLINT_REFUSE_NULL(out, error);
    const glint_stages *stages;
    glint_status status = glint_check_direction("normal", normal, error);
    if (!status)
        status = glint_check_direction("to_light", to_light, error);
    if (!status)
        status = glint_check_direction("to_eye", to_eye, error);
    if (!status)
        status = choose_stages(&stages, error);
    if (status)
        return status;
    double n[3], l[3], v[3];
    glint_material_desc desc = material->desc;
    desc.program = (glint_material_programs) { 0 };
    vec_normalize(n, normal);
    vec_normalize(l, to_light);
    vec_normalize(v, to_eye);
    const double sign = vec_dot(n, v) < 0 ? -1 : 1;
    lane_group *g = glint_alloc(1, sizeof *g);
    if (!g)
        return glint_fail_nomem(error);
    g->active = g->hits = 1;
    for (int c = 0; c < 3; c++) {
        g->normal[c][0] = n[c] * sign;
        g->direction[c][0] = -v[c];
    }
    evaluate_lane(stages, &desc, l, g);
    for (int c = 0; c < 3; c++) {
        out->diffuse[c] = g->sum[GLINT_TERM_DIFFUSE][c][0];
        out->specular[c] = g->sum[GLINT_TERM_SPECULAR][c][0];
    }
    free(g);
    return GLINT_OK;
}
