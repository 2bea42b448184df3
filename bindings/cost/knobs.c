// The knobs of glint cost. A setting that trades accuracy for time is a row of the table at the end: its name, the part
// of the plan that it depends on, its values, how a value is applied, and where its error arises. Add a row for a new
// stage.
#include <stddef.h>
#include <string.h>

#include "bindings/cost/cost.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

static bool has_stage(const glint_plan *plan, const char *name)
{
    const glint_stage_info *stages;
    size_t count = glint_plan_stages(plan, &stages);
    for (size_t i = 0; i < count; i++)
        if (strcmp(stages[i].name, name) == 0)
            return true;
    return false;
}

static bool has_effect(const glint_plan *plan, const char *name)
{
    const glint_effect *effects;
    size_t count = glint_plan_effects(plan, &effects);
    for (size_t i = 0; i < count; i++)
        if (strcmp(effects[i].effect, name) == 0)
            return true;
    return false;
}

// ---- samples: rays per pixel ----

static void list_samples(const cost_subject *subject, cost_values *out)
{
    static const double counts[] = { 1, 4, 16, 64 };
    if (has_stage(subject->plan, "cast"))
        cost_list_numbers(counts, COUNT(counts), subject->render->desc.samples, out);
}

// ---- adaptive: the difference between neighbours from which all samples are taken ----

static void list_adaptive(const cost_subject *subject, cost_values *out)
{
    static const double thresholds[] = { 0, 0.01, 0.03, 0.1, 0.3 };
    if (has_stage(subject->plan, "cast") && subject->render->desc.samples > 1)
        cost_list_numbers(thresholds, COUNT(thresholds), subject->render->desc.adaptive, out);
}

// ---- shutter_times: the moments of an open shutter ----

// Lists the numbers of moments. The truth is the largest: fewer moments lack the light in between.
static void list_shutter_times(const cost_subject *subject, cost_values *out)
{
    double counts[COST_VALUES_MAX];
    const int count = cost_moments_counts(subject->moments, counts);
    if (count == 0)
        return;
    cost_list_numbers(counts + 1, count - 1, counts[0], out);
    out->has_truth = true;
    out->truth = out->count - 1;
}

static glint_status apply_shutter_times(cost_draft *draft, cost_value value, glint_error *error)
{
    (void)error;
    draft->shutter_times = (int)value.number;
    return GLINT_OK;
}

// ---- shadows ----

static bool is_soft(const glint_light_desc *light)
{
    const bool has_radius = light->kind == GLINT_LIGHT_DISK || light->kind == GLINT_LIGHT_SPHERE;
    return light->shadows && (light->kind == GLINT_LIGHT_POLYGON || (has_radius && light->radius > 0));
}

// Returns whether caps apply: all shapes are spheres and planes, and opaque.
static bool takes_caps(const cost_scene *scene)
{
    bool takes = true;
    for (size_t i = 0; i < scene->material_count; i++)
        for (int c = 0; c < 3; c++)
            takes = takes && scene->material_descs[i].transmission[c] == 0;
    for (size_t i = 0; i < glint_scene_shape_count(scene->scene); i++)
        takes = takes && glint_shape_get(glint_scene_shape_at(scene->scene, i))->kind <= GLINT_SHAPE_SPHERES;
    return takes;
}

static const char *const SHADOWS[] = { "off", "hard", "soft", "caps" };

// Lists the shadows: soft ones for lights with a surface; also caps for sphere lights, if the scene allows caps. The
// script's own value is the value of its first light with a surface.
static void list_shadows(const cost_subject *subject, cost_values *out)
{
    const cost_scene *scene = subject->scene;
    static const int own[] = { [GLINT_SHADOW_RAYS] = 2, [GLINT_SHADOW_HARD] = 1, [GLINT_SHADOW_CAPS] = 3 };
    const glint_light_desc *first = NULL;
    bool caps = false;
    for (size_t i = 0; i < scene->light_count; i++) {
        const glint_light_desc *light = &scene->light_descs[i];
        first = first || !is_soft(light) ? first : light;
        caps = caps || (is_soft(light) && light->kind == GLINT_LIGHT_SPHERE);
    }
    caps = caps && takes_caps(scene);
    const int count = caps ? 4 : first ? 3 : 2, at = first ? own[first->shadow] : 1;
    if (has_stage(subject->plan, "occlude"))
        cost_list_words(SHADOWS, count, at < count ? at : 2, out);
    out->truth = 2;
    out->has_truth = out->count > 0 && first;
}

static glint_status apply_shadows(cost_draft *draft, cost_value value, glint_error *error)
{
    cost_scene *scene = draft->scene;
    const int sort = cost_find_word(value, SHADOWS, COUNT(SHADOWS));
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < scene->light_count && !status; i++) {
        glint_light_desc desc = *glint_light_get(scene->lights[i]);
        desc.shadows = desc.shadows && sort > 0;
        if (is_soft(&desc) && sort == 1)
            desc.shadow = GLINT_SHADOW_HARD;
        else if (is_soft(&desc) && sort >= 2)
            desc.shadow = sort == 3 && desc.kind == GLINT_LIGHT_SPHERE ? GLINT_SHADOW_CAPS : GLINT_SHADOW_RAYS;
        status = cost_scene_set_light(scene, i, &desc, error);
    }
    return status;
}

// ---- light_samples: rays to each light with a surface ----

// Returns the largest of the lights' own samples. In that row each light keeps its own.
static double most_light_samples(const cost_scene *scene)
{
    double most = 0;
    for (size_t i = 0; i < scene->light_count; i++)
        if (is_soft(&scene->light_descs[i]) && scene->light_descs[i].samples > most)
            most = scene->light_descs[i].samples;
    return most;
}

static void list_light_samples(const cost_subject *subject, cost_values *out)
{
    static const double counts[] = { 1, 4, 16, 64, 256 };
    if (has_effect(subject->plan, "soft shadow"))
        cost_list_numbers(counts, COUNT(counts), most_light_samples(subject->scene), out);
}

static glint_status apply_light_samples(cost_draft *draft, cost_value value, glint_error *error)
{
    cost_scene *scene = draft->scene;
    const bool own = value.number == most_light_samples(scene);
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < scene->light_count && !own && !status; i++) {
        glint_light_desc desc = *glint_light_get(scene->lights[i]);
        if (!is_soft(&scene->light_descs[i]))
            continue;
        desc.samples = value.number;
        status = cost_scene_set_light(scene, i, &desc, error);
    }
    return status;
}

// ---- precision: the numbers that decide hits and shadows ----

static const char *const PRECISIONS[] = { [GLINT_DOUBLE] = "double", [GLINT_FLOAT] = "float" };

static void list_precision(const cost_subject *subject, cost_values *out)
{
    if (has_stage(subject->plan, "cast"))
        cost_list_words(PRECISIONS, COUNT(PRECISIONS), (int)subject->render->desc.precision, out);
}

static glint_status apply_precision(cost_draft *draft, cost_value value, glint_error *error)
{
    (void)error;
    draft->render.desc.precision = (glint_precision)cost_find_word(value, PRECISIONS, COUNT(PRECISIONS));
    return GLINT_OK;
}

// ---- model: the model of highlights ----

static const char *const MODELS[] = { "phong", "blinn_phong", "matched_blinn_phong" };

// Lists the models. matched_blinn_phong replaces every Phong highlight by a Blinn-Phong one with four times the
// exponent, which is as wide. A scene with highlights of both models has its own setting "mixed".
static void list_model(const cost_subject *subject, cost_values *out)
{
    const bool phong = has_effect(subject->plan, "Phong highlight");
    const bool blinn = has_effect(subject->plan, "Blinn-Phong highlight");
    if (!phong && !blinn)
        return;
    cost_list_words(MODELS, phong ? 3 : 2, phong ? 0 : 1, out);
    if (phong && blinn) {
        out->value[3].text = "mixed";
        out->count = 4;
        out->own = out->base = 3;
    }
}

static glint_status apply_model(cost_draft *draft, cost_value value, glint_error *error)
{
    cost_scene *scene = draft->scene;
    const int model = cost_find_word(value, MODELS, COUNT(MODELS));
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < scene->material_count && !status && strcmp(value.text, "mixed") != 0; i++) {
        glint_material_desc desc = scene->material_descs[i];
        if (desc.model != GLINT_MODEL_PHONG && desc.model != GLINT_MODEL_BLINN_PHONG)
            continue;
        if (model == 2 && desc.model == GLINT_MODEL_PHONG)
            desc.shininess *= 4;
        desc.model = model == 0 ? GLINT_MODEL_PHONG : GLINT_MODEL_BLINN_PHONG;
        status = cost_scene_set_material(scene, i, &desc, error);
    }
    return status;
}

// ---- segments: spheres of triangles, compared with the exact sphere ----

#define TRIANGLES_MAX 0x1p21 // limit of the triangles of all spheres together; no setting exceeds it

// Lists the segments. The truth is the exact sphere, which the triangles approximate.
static void list_segments(const cost_subject *subject, cost_values *out)
{
    static const double counts[] = { 16, 64, 256, 1024 };
    const cost_meshes meshes = cost_scene_meshes(subject->scene);
    int count = 0;
    while (count < COUNT(counts) && counts[count] * counts[count] * (double)meshes.globe_count <= TRIANGLES_MAX)
        count++;
    if (meshes.globe_count == 0 || !has_effect(subject->plan, "triangles"))
        return;
    if (meshes.segments > 0) {
        cost_list_numbers(counts, count, meshes.segments, out);
    } else {
        for (int i = 0; i < count; i++)
            out->value[i].number = counts[i];
        out->value[count].text = "mixed";
        out->own = out->base = count;
        out->count = count + 1;
    }
    out->has_truth = true;
    out->truth = out->count;
    out->value[out->count++].text = "exact";
}

static glint_status apply_segments(cost_draft *draft, cost_value value, glint_error *error)
{
    if (value.text && strcmp(value.text, "mixed") == 0)
        return GLINT_OK;
    return cost_scene_set_segments(draft->scene, value.text ? 0 : value.number, error);
}

// ---- shading: where meshes are lit ----

static const char *const SHADINGS[] = { "flat", "gouraud", "phong", "faceted", "mixed" };
static const glint_shading SHADING[] = { GLINT_SHADING_FLAT, GLINT_SHADING_GOURAUD, GLINT_SHADING_PHONG,
                                         GLINT_SHADING_FACETED };

static void list_shading(const cost_subject *subject, cost_values *out)
{
    const cost_meshes meshes = cost_scene_meshes(subject->scene);
    int own = 0;
    if (meshes.count == 0 || !has_stage(subject->plan, "light"))
        return;
    while (!meshes.is_mixed && SHADING[own] != meshes.shading)
        own++;
    cost_list_words(SHADINGS, 3, own, out);
    if (meshes.is_mixed || own == 3) {
        out->value[3].text = SHADINGS[meshes.is_mixed ? 4 : 3];
        out->count = 4;
        out->own = out->base = 3;
    }
}

static glint_status apply_shading(cost_draft *draft, cost_value value, glint_error *error)
{
    const int shading = cost_find_word(value, SHADINGS, COUNT(SHADINGS));
    return shading < COUNT(SHADING) ? cost_scene_set_shading(draft->scene, SHADING[shading], error) : GLINT_OK;
}

// ---- max_depth: chains of mirrors and refractions ----

// Looks only at the materials, because a script with depth 0 has no stage for mirrors and glass.
static bool has_bounce(const cost_scene *scene)
{
    bool has = false;
    for (size_t i = 0; i < scene->material_count; i++) {
        const glint_material_desc *m = &scene->material_descs[i];
        for (int c = 0; c < 3; c++)
            has = has || m->transmission[c] > 0 || (m->has_mirror ? m->mirror[c] > 0 : m->fresnel);
    }
    return has;
}

// Lists the depths. The truth is the largest: smaller depths lack light.
static void list_max_depth(const cost_subject *subject, cost_values *out)
{
    static const double depths[] = { 0, 1, 2, 5, 10 };
    const double own = subject->render->desc.max_depth;
    if (!has_stage(subject->plan, "bounce") &&
        !(own == 0 && has_stage(subject->plan, "cast") && has_bounce(subject->scene)))
        return;
    cost_list_numbers(depths, COUNT(depths), own, out);
    out->has_truth = true;
    out->truth = out->count - 1;
}

// ---- indirect_samples, indirect_bounces: paths of light from surface to surface ----

static void list_indirect_samples(const cost_subject *subject, cost_values *out)
{
    static const double counts[] = { 1, 4, 16, 64, 256 };
    if (has_stage(subject->plan, "indirect") && subject->scene->desc.has_indirect)
        cost_list_numbers(counts, COUNT(counts), subject->scene->desc.indirect_samples, out);
}

// Lists the numbers of bounces. 0 replaces indirect light by the ambient light. The truth is the largest: fewer bounces
// lack light.
static void list_indirect_bounces(const cost_subject *subject, cost_values *out)
{
    static const double counts[] = { 0, 1, 2, 4, 8 };
    if (!has_stage(subject->plan, "indirect") || !subject->scene->desc.has_indirect)
        return;
    cost_list_numbers(counts, COUNT(counts), subject->scene->desc.indirect_bounces, out);
    out->has_truth = true;
    out->truth = out->count - 1;
}

// ---- ambient_occlusion_samples: rays towards the sky ----

static void list_occlusion_samples(const cost_subject *subject, cost_values *out)
{
    static const double counts[] = { 1, 4, 16, 64, 256 };
    if (has_stage(subject->plan, "indirect") && subject->scene->desc.has_ambient_occlusion)
        cost_list_numbers(counts, COUNT(counts), subject->scene->desc.ambient_occlusion_samples, out);
}

// ---- reflection_samples: rays of rough surfaces ----

static void list_reflection_samples(const cost_subject *subject, cost_values *out)
{
    static const double counts[] = { 1, 4, 16, 64, 256 };
    if (has_stage(subject->plan, "rough"))
        cost_list_numbers(counts, COUNT(counts), subject->scene->desc.reflection_samples, out);
}

// ---- bits, encode: the file ----

static void list_bits(const cost_subject *subject, cost_values *out)
{
    static const double depths[] = { 8, 16 };
    if (!subject->is_pfm)
        cost_list_numbers(depths, COUNT(depths), subject->render->desc.tone.bits, out);
}

static glint_status apply_bits(cost_draft *draft, cost_value value, glint_error *error)
{
    (void)error;
    draft->render.desc.tone.bits = (int)value.number;
    return GLINT_OK;
}

static const char *const ENCODERS[] = { [GLINT_ENCODE_FAST] = "fast", [GLINT_ENCODE_SMALL] = "small" };

static void list_encode(const cost_subject *subject, cost_values *out)
{
    if (!subject->is_pfm)
        cost_list_words(ENCODERS, COUNT(ENCODERS), (int)subject->render->encode, out);
}

static glint_status apply_encode(cost_draft *draft, cost_value value, glint_error *error)
{
    (void)error;
    draft->render.encode = (glint_encode)cost_find_word(value, ENCODERS, COUNT(ENCODERS));
    return GLINT_OK;
}

// ---- reuse: a frame after its neighbour, with the neighbour's cached results ----

static const char *const SWITCH[] = { "off", "on" };

static void list_reuse(const cost_subject *subject, cost_values *out)
{
    if (!subject->has_neighbour)
        return;
    cost_list_words(SWITCH, COUNT(SWITCH), 1, out);
    out->base = 0; // every other row renders a whole frame
}

static glint_status apply_reuse(cost_draft *draft, cost_value value, glint_error *error)
{
    (void)error;
    draft->reuses = strcmp(value.text, "on") == 0;
    return GLINT_OK;
}

// ---- The table, in the order of the output ----

#define SURFACES "a visible surface"
#define INDIRECT "indirect light"
#define PNG "an output in .png"
#define IN_RENDER(field) .render_at = offsetof(glint_render_desc, field)
#define IN_SCENE(field) .scene_at = offsetof(glint_scene_desc, field)

const cost_knob cost_knobs[] = {
    { "samples", SURFACES, COST_ERROR_FILM, true, false, list_samples, IN_RENDER(samples) },
    { "adaptive", "several samples a pixel", COST_ERROR_FILM, true, false, list_adaptive, IN_RENDER(adaptive) },
    { "shutter_times", "an animation whose camera has an open shutter", COST_ERROR_FILM, true, false,
      list_shutter_times, .apply = apply_shutter_times },
    { "shadows", "a light that casts shadows", COST_ERROR_FILM, true, false, list_shadows, .apply = apply_shadows },
    { "light_samples", "a light with a surface and soft shadows", COST_ERROR_FILM, true, false, list_light_samples,
      .apply = apply_light_samples },
    { "precision", SURFACES, COST_ERROR_FILM, true, false, list_precision, .apply = apply_precision },
    { "model", "a highlight", COST_ERROR_FILM, true, false, list_model, .apply = apply_model },
    { "segments", "a sphere_mesh", COST_ERROR_FILM, true, false, list_segments, .apply = apply_segments },
    { "shading", "a mesh and a light", COST_ERROR_FILM, true, false, list_shading, .apply = apply_shading },
    { "max_depth", "a mirror or glass", COST_ERROR_FILM, true, false, list_max_depth, IN_RENDER(max_depth) },
    { "indirect_samples", INDIRECT, COST_ERROR_FILM, true, false, list_indirect_samples, IN_SCENE(indirect_samples) },
    { "indirect_bounces", INDIRECT, COST_ERROR_FILM, true, false, list_indirect_bounces, IN_SCENE(indirect_bounces) },
    { "ambient_occlusion_samples", "ambient occlusion", COST_ERROR_FILM, true, false, list_occlusion_samples,
      IN_SCENE(ambient_occlusion_samples) },
    { "reflection_samples", "a rough surface that reflects", COST_ERROR_FILM, true, false, list_reflection_samples,
      IN_SCENE(reflection_samples) },
    { "bits", PNG, COST_ERROR_FILE, false, false, list_bits, .apply = apply_bits },
    { "encode", PNG, COST_ERROR_FILM, false, false, list_encode, .apply = apply_encode },
    { "reuse", "a second frame (in a loop of scene:render, choose a later frame than the first with --frame)",
      COST_ERROR_FILM, false, true, list_reuse, .apply = apply_reuse },
};
const int cost_knob_count = COUNT(cost_knobs);
_Static_assert(COUNT(cost_knobs) <= COST_KNOBS_MAX, "a study has room for every knob");

glint_status cost_knob_apply(const cost_knob *knob, cost_draft *draft, cost_value value, glint_error *error)
{
    glint_scene_desc desc = *glint_scene_get(draft->scene->scene);
    if (knob->apply)
        return knob->apply(draft, value, error);
    char *at = knob->scene_at ? (char *)&desc + knob->scene_at : (char *)&draft->render.desc + knob->render_at;
    memcpy(at, &value.number, sizeof value.number);
    return knob->scene_at ? cost_scene_set(draft->scene, &desc, error) : GLINT_OK;
}

int cost_knob_find(const char *name, size_t length)
{
    for (int i = 0; i < cost_knob_count; i++)
        if (strlen(cost_knobs[i].name) == length && strncmp(cost_knobs[i].name, name, length) == 0)
            return i;
    return -1;
}

bool cost_knobs_check(const char *list, char message[GLINTL_MESSAGE_SIZE])
{
    for (const char *at = list; at; at = *at ? at + 1 : NULL) {
        const size_t length = strcspn(at, ",");
        char name[64], allowed[256];
        const char *near = NULL;
        size_t used = 0;
        if (cost_knob_find(at, length) < 0) {
            snprintf(name, sizeof name, "%.*s", length < 60 ? (int)length : 60, at);
            for (int i = 0; i < cost_knob_count; i++) {
                near = glintL_nearer(name, near, cost_knobs[i].name);
                used +=
                    (size_t)snprintf(allowed + used, sizeof allowed - used, "%s%s", i ? ", " : "", cost_knobs[i].name);
            }
            return glintL_complain(message, "list of %s expected, got '%s'%s%s%s", allowed, name,
                                   near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "");
        }
        at += length;
    }
    return true;
}
