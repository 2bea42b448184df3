#include "engine/base/number.h"
#include "engine/base/status.h"
#include "engine/render/effects/environment/plan.h"
#include "engine/render/plan/plan.h"
#include "engine/render/scene/area_light.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#define CALLERS_MAX 8 ///< largest number of objects named for one effect; the other objects are counted

typedef struct explainer {
    glint_plan *plan;
    glint_error *error;
    glint_status status;
    const char *effect; ///< the effect being collected
    size_t callers;
} explainer;

static void add_line(explainer *e, const char *effect, const char *caller)
{
    glint_plan *plan = e->plan;
    if (e->status)
        return;
    if (plan->effect_count == plan->effect_capacity) {
        const size_t capacity = plan->effect_capacity ? 2 * plan->effect_capacity : 16;
        glint_text_line *lines = realloc(plan->lines, capacity * sizeof *lines);
        if (!lines) {
            e->status = glint_fail_nomem(e->error);
            return;
        }
        plan->lines = lines;
        plan->effect_capacity = capacity;
    }
    glint_text_line *line = &plan->lines[plan->effect_count++];
    snprintf(line->effect, sizeof line->effect, "%s", effect);
    snprintf(line->caller, sizeof line->caller, "%s", caller);
}

static void begin(explainer *e, const char *effect)
{
    e->effect = effect;
    e->callers = 0;
}

static void called_by(explainer *e, const char *caller)
{
    if (e->callers++ < CALLERS_MAX)
        add_line(e, e->effect, caller);
}

static void end(explainer *e)
{
    if (e->callers <= CALLERS_MAX)
        return;
    char rest[64];
    snprintf(rest, sizeof rest, "and %zu more", e->callers - CALLERS_MAX);
    add_line(e, e->effect, rest);
}

typedef bool light_test(const glint_light_desc *desc);

static bool gives(const glint_light_desc *d)
{
    const double *diffuse = d->has_diffuse ? d->diffuse : d->color,
                 *specular = d->has_specular ? d->specular : d->color;
    bool any = false;
    for (int c = 0; c < 3; c++)
        any = any || diffuse[c] > 0 || specular[c] > 0;
    return any && (d->has_radiance ? d->radiance > 0 && glint_light_sample_area(d) > 0 : d->intensity > 0);
}
static bool gives_ambient(const glint_light_desc *d)
{
    return d->intensity > 0 && (d->ambient[0] > 0 || d->ambient[1] > 0 || d->ambient[2] > 0);
}
static bool is_point(const glint_light_desc *d) { return gives(d) && d->kind == GLINT_LIGHT_POINT; }
static bool is_directional(const glint_light_desc *d) { return gives(d) && d->kind == GLINT_LIGHT_DIRECTIONAL; }
static bool is_spot(const glint_light_desc *d) { return gives(d) && d->kind == GLINT_LIGHT_SPOT; }
static bool is_disk(const glint_light_desc *d) { return gives(d) && d->kind == GLINT_LIGHT_DISK; }
static bool is_polygon(const glint_light_desc *d) { return gives(d) && d->kind == GLINT_LIGHT_POLYGON; }
static bool is_sphere(const glint_light_desc *d) { return gives(d) && d->kind == GLINT_LIGHT_SPHERE; }
static bool has_size(const glint_light_desc *d)
{
    return is_polygon(d) || ((is_disk(d) || is_sphere(d)) && d->radius > 0);
}
static bool casts_hard_shadows(const glint_light_desc *d)
{
    return gives(d) && d->shadows && (!has_size(d) || d->shadow == GLINT_SHADOW_HARD);
}
static bool casts_soft_shadows(const glint_light_desc *d)
{
    return d->shadows && has_size(d) && d->shadow != GLINT_SHADOW_HARD;
}
static bool casts_caps(const glint_light_desc *d) { return casts_soft_shadows(d) && d->shadow == GLINT_SHADOW_CAPS; }
static bool casts_sampled(const glint_light_desc *d) { return casts_soft_shadows(d) && !casts_caps(d); }
static bool radiates(const glint_light_desc *d) { return gives(d) && d->has_radiance; }
static bool is_seen(const glint_light_desc *d)
{
    double shown[3];
    return glint_light_shows(d, shown);
}
static bool falls_off(const glint_light_desc *d)
{
    const double *a = d->attenuation;
    return gives(d) && d->kind != GLINT_LIGHT_DIRECTIONAL && (a[0] != 1 || a[1] != 0 || a[2] != 0);
}

static void lights(explainer *e, const glint_scene *scene, const char *effect, light_test *test)
{
    char caller[2 * GLINT_NAME_SIZE];
    begin(e, effect);
    for (size_t i = 0; i < scene->lights.count; i++) {
        const glint_light_desc *desc = &glint_scene_light(scene, i)->desc;
        if (!test(desc))
            continue;
        glint_describe_light(desc, i + 1, caller, sizeof caller);
        called_by(e, caller);
    }
    end(e);
}

typedef bool material_test(const glint_material_desc *desc);

static bool any(const double c[3]) { return c[0] > 0 || c[1] > 0 || c[2] > 0; }

static bool is_mirror(const glint_material_desc *d) { return glint_material_mirrors(d) && !glint_material_is_rough(d); }
static bool is_refracting(const glint_material_desc *d) { return glint_material_transmits(d) && !glint_material_is_rough(d); }
static bool is_rough_mirror(const glint_material_desc *d) { return glint_material_mirrors(d) && glint_material_is_rough(d); }
static bool is_rough_glass(const glint_material_desc *d) { return glint_material_transmits(d) && glint_material_is_rough(d); }
static bool transmits_light(const glint_material_desc *d) { return glint_material_transmits(d) || glint_material_blends(d); }
static bool is_absorbing(const glint_material_desc *d) { return glint_material_transmits(d) && any(d->absorption); }

static bool shines_as(const glint_material_desc *d, glint_model model)
{
    return d->model == model && glint_material_is_shiny(d);
}
static bool is_phong(const glint_material_desc *d) { return shines_as(d, GLINT_MODEL_PHONG) && !d->normalized; }
static bool is_even_phong(const glint_material_desc *d) { return shines_as(d, GLINT_MODEL_PHONG) && d->normalized; }
static bool is_blinn(const glint_material_desc *d) { return shines_as(d, GLINT_MODEL_BLINN_PHONG) && !d->normalized; }
static bool is_even_blinn(const glint_material_desc *d)
{
    return shines_as(d, GLINT_MODEL_BLINN_PHONG) && d->normalized;
}
static bool is_matched(const glint_material_desc *d) { return shines_as(d, GLINT_MODEL_BLINN_PHONG) && d->matched; }
static bool is_ggx(const glint_material_desc *d)
{
    return shines_as(d, GLINT_MODEL_COOK_TORRANCE) && d->distribution == GLINT_DISTRIBUTION_GGX;
}
static bool is_beckmann(const glint_material_desc *d)
{
    return shines_as(d, GLINT_MODEL_COOK_TORRANCE) && d->distribution == GLINT_DISTRIBUTION_BECKMANN;
}

static void materials(explainer *e, const char *effect, material_test *test)
{
    glint_list seen = { 0 };
    char owner[2 * GLINT_NAME_SIZE], caller[4 * GLINT_NAME_SIZE];
    begin(e, effect);
    for (uint32_t i = 0; i < e->plan->geometry->part_count && !e->status; i++) {
        const glint_shape *shape = e->plan->geometry->parts[i].dress;
        for (size_t m = 0; m < shape->material_count && !e->status; m++) {
            glint_material *material = shape->materials[m];
            if (!test(&material->desc) || glint_list_find(&seen, material) < seen.count)
                continue;
            e->status = glint_list_add(&seen, material, e->error);
            glint_describe_shape(&shape->desc, i + 1, owner, sizeof owner);
            glint_describe_material(&material->desc, owner, caller, sizeof caller);
            called_by(e, caller);
        }
    }
    end(e);
    glint_list_free(&seen);
}

/// Adds a line for a program and its length. owner: "material 'floor'"
static void add_program(explainer *e, const glint_program *program, int field, const char *owner)
{
    char effect[sizeof e->plan->lines->effect], caller[2 * GLINT_NAME_SIZE];
    const size_t length = glint_program_length(program), rows = glint_program_rows(program);
    snprintf(effect, sizeof effect, "pattern: %s", glint_field_name(field));
    snprintf(caller, sizeof caller, "%s, %zu instruction%s, %zu row%s", owner, length, length == 1 ? "" : "s", rows,
             rows == 1 ? "" : "s");
    add_line(e, effect, caller);
}

/// Adds a line for each program of a material, with its length.
static void patterns(explainer *e)
{
    const glint_plan_patterns *all = e->plan->patterns;
    for (int field = 0; field < GLINT_FIELD_COUNT; field++)
        for (uint32_t i = 0; i < all->material_count; i++) {
            const glint_material *material = e->plan->geometry->materials.items[i];
            char owner[GLINT_NAME_SIZE + 16];
            if (!all->of[i].program[field])
                continue;
            if (material->desc.name[0])
                snprintf(owner, sizeof owner, "material '%s'", material->desc.name);
            else
                snprintf(owner, sizeof owner, "material #%u", i + 1);
            add_program(e, all->of[i].program[field], field, owner);
        }
}

typedef bool shape_test(const glint_shape *shape);

static bool is_mesh(const glint_shape *shape) { return shape->mesh; }
static bool is_shaded(const glint_shape *shape, glint_shading shading)
{
    return shape->mesh && shape->desc.shading == shading;
}
static bool is_uncapped(const glint_shape *shape)
{
    const glint_shape_kind kind = shape->desc.kind;
    return (kind == GLINT_SHAPE_CYLINDER || kind == GLINT_SHAPE_CYLINDERS || kind == GLINT_SHAPE_CONE) &&
           !shape->desc.capped;
}
static bool is_smooth(const glint_shape *shape) { return is_shaded(shape, GLINT_SHADING_PHONG); }
static bool is_flat(const glint_shape *shape) { return is_shaded(shape, GLINT_SHADING_FLAT); }
static bool is_gouraud(const glint_shape *shape) { return is_shaded(shape, GLINT_SHADING_GOURAUD); }

static void shapes(explainer *e, const char *effect, shape_test *test)
{
    char caller[2 * GLINT_NAME_SIZE];
    begin(e, effect);
    for (uint32_t i = 0; i < e->plan->geometry->whole_count; i++) {
        const glint_shape *shape = e->plan->geometry->parts[i].shape;
        if (!test(shape))
            continue;
        glint_describe_shape(&shape->desc, i + 1, caller, sizeof caller);
        called_by(e, caller);
    }
    end(e);
}

__attribute__((format(printf, 4, 5))) static void one(explainer *e, bool called, const char *effect, const char *format, ...)
{
    if (!called)
        return;
    char caller[2 * GLINT_NAME_SIZE];
    va_list args;
    va_start(args, format);
    glint_print_list(caller, sizeof caller, format, args);
    va_end(args);
    add_line(e, effect, caller);
}

static void eye_medium(explainer *e)
{
    const glint_plan *plan = e->plan;
    char caller[2 * GLINT_NAME_SIZE];
    if (!plan->eye_medium.on)
        return;
    const glint_material *material = plan->geometry->materials.items[glint_media_top(&plan->eye_media)];
    glint_describe_material(&material->desc, "glass around the eye", caller, sizeof caller);
    add_line(e, "absorption before the eye", caller);
}

static void overlays(explainer *e, const glint_scene *scene)
{
    char caller[2 * GLINT_NAME_SIZE];
    begin(e, "drawn over the picture");
    for (size_t i = 0; i < glint_scene_overlay_count(scene); i++) {
        const glint_overlay *overlay = glint_scene_overlay_at(scene, i);
        const char *kind = overlay->maker->kind(overlay), *name = overlay->maker->name(overlay);
        if (name[0])
            snprintf(caller, sizeof caller, "%s '%s'", kind, name);
        else
            snprintf(caller, sizeof caller, "%s #%zu", kind, i + 1);
        called_by(e, caller);
    }
    end(e);
}

static void list_effects(explainer *e, const glint_scene *scene)
{
    const glint_plan *plan = e->plan;
    const bool surfaces = plan->geometry->table.prim_count > 0;
    one(e, plan->camera.orthographic, "orthographic projection", "camera");
    one(e, plan->lens, "lens", "camera.aperture = %g, focus %g away", plan->camera.aperture, plan->camera.focus);
    one(e, any(plan->background), "background", "scene.background");
    lights(e, scene, "visible light", is_seen);
    if (surfaces) {
        one(e, any(scene->desc.ambient), "ambient light", "scene.ambient");
        lights(e, scene, "ambient light", gives_ambient);
        lights(e, scene, "point light", is_point);
        lights(e, scene, "directional light", is_directional);
        lights(e, scene, "distance fall-off", falls_off);
        lights(e, scene, "spot light", is_spot);
        lights(e, scene, "disk light", is_disk);
        lights(e, scene, "polygon light", is_polygon);
        lights(e, scene, "sphere light", is_sphere);
        lights(e, scene, "light by radiance", radiates);
        lights(e, scene, "hard shadow", casts_hard_shadows);
        lights(e, scene, "soft shadow", plan->caps ? casts_sampled : casts_soft_shadows);
        lights(e, scene, plan->caps ? "soft shadow by caps" : "rays in place of caps", casts_caps);
        one(e, plan->runs[GLINT_STAGE_INDIRECT], plan->indirect.is_sky ? "ambient occlusion" : "indirect light",
            plan->indirect.is_sky ? "scene.ambient_occlusion" : "scene.indirect");
        one(e, plan->sky, "sky with bright parts", "scene.background: half of the scattered rays are drawn by its brightness");
        shapes(e, "triangles", is_mesh);
        one(e, plan->runs[GLINT_STAGE_RASTER], "scan conversion", "%s: %u triangles",
            plan->desc.visibility == GLINT_VISIBILITY_SCAN ? "visibility = scan" : "faster here than casting rays",
            plan->geometry->table.triangles);
        shapes(e, "smooth normals", is_smooth);
        if (plan->runs[GLINT_STAGE_VERTEX_SHADING]) {
            shapes(e, "flat shading", is_flat);
            shapes(e, "Gouraud shading", is_gouraud);
        }
        shapes(e, "solid by an affine map", glint_shape_is_solid);
        shapes(e, "combined solid", glint_shape_combines);
        shapes(e, "open cylinder or cone", is_uncapped);
    }
    if (plan->patterns)
        patterns(e);
    if (plan->environment)
        add_program(e, plan->environment->program, GLINT_FIELD_BACKGROUND, "scene");
    if (glint_plan_cuts(plan))
        materials(e, "cut-out", glint_material_is_cut);
    if (plan->highlights) {
        materials(e, "Phong highlight", is_phong);
        materials(e, "normalised Phong highlight", is_even_phong);
        materials(e, "Blinn-Phong highlight", is_blinn);
        materials(e, "normalised Blinn-Phong highlight", is_even_blinn);
        materials(e, "exponent matched to Phong's", is_matched);
        materials(e, "GGX microfacets", is_ggx);
        materials(e, "Beckmann microfacets", is_beckmann);
    }
    if (plan->runs[GLINT_STAGE_ROUGH]) {
        materials(e, "rough reflection", is_rough_mirror);
        materials(e, "rough refraction", is_rough_glass);
    }
    if (plan->runs[GLINT_STAGE_BOUNCE] || plan->runs[GLINT_STAGE_ROUGH]) {
        materials(e, "mirror reflection", is_mirror);
        materials(e, "refraction", is_refracting);
        materials(e, "absorption inside", is_absorbing);
        materials(e, "translucent surface", glint_material_blends);
    }
    if (plan->tints)
        materials(e, "tinted shadow", transmits_light);
    for (int id = 0; id < GLINT_STAGE_COUNT; id++)
        one(e, plan->own[id] && glint_stage_table[id]->effect, glint_stage_table[id]->effect, "%s",
            glint_stage_table[id]->caller);
    eye_medium(e);
    static const char *const inks[] = { "none", "black", "white" };
    one(e, plan->desc.outline, "outline", "outline = %s", inks[plan->desc.outline]);
    overlays(e, scene);
    one(e, plan->desc.alpha, "transparent background", "alpha = true");
    one(e, plan->shutter_times, "shutter", "camera: mean of %u times", plan->shutter_times);
    one(e, plan->desc.samples > 1, "several samples a pixel", "samples = %" PRId64, plan->desc.samples);
    one(e, plan->runs[GLINT_STAGE_ADAPTIVE], "samples only where needed", "adaptive = %g", plan->desc.adaptive);
    one(e, plan->desc.precision == GLINT_PRECISION_FLOAT, "float decides hits and shadows", "precision = float");
    static const char *const curves[] = { "clamp", "reinhard", "filmic" };
    const glint_tone_desc *tone = &plan->desc.tone;
    one(e, tone->curve != GLINT_TONE_CLAMP, "tone curve", "tone = %s", curves[tone->curve]);
    one(e, tone->exposure != 0, "exposure", "exposure = %g", tone->exposure);
    for (int pass = GLINT_PASS_BACKGROUND; pass < GLINT_PASS_COUNT; pass++)
        one(e, plan->desc.passes >> pass & 1, "pass", "passes: %s", glint_pass_name((glint_pass)pass));
    for (size_t i = 0; plan->derivatives && i < plan->derivatives->count; i++)
        one(e, true, "derivative", "passes: d:%s", plan->derivatives->of[i].name);
    for (size_t i = 0; glint_plan_light_pass(plan, i); i++)
        one(e, true, "light pass", "passes: light:%s", glint_plan_light_pass(plan, i));
}

static void list_stages(glint_plan *plan)
{
    for (int id = 0; id < GLINT_STAGE_COUNT; id++) {
        if (!plan->runs[id] || !glint_stage_table[id]->name)
            continue;
        glint_stage_info *stage = &plan->stage_list[plan->stage_count++];
        stage->name = glint_stage_table[id]->name;
        stage->why = glint_stage_table[id]->doc;
        glint_key_hex(plan->keys[id], stage->key);
    }
}

glint_status glint_plan_explain(glint_plan *plan, const glint_scene *scene, glint_error *error)
{
    explainer e = { .plan = plan, .error = error };
    list_stages(plan);
    list_effects(&e, scene);
    if (e.status)
        return e.status;
    plan->effects = malloc((plan->effect_count + 1) * sizeof *plan->effects);
    if (!plan->effects)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < plan->effect_count; i++)
        plan->effects[i] = (glint_effect) { plan->lines[i].effect, plan->lines[i].caller };
    return GLINT_OK;
}
