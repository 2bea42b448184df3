// A frame's scene at the times of an open shutter, for every number of times in the rows of shutter_times. The state of
// each object is recorded while the script runs its frame function, and restored when a row is planned.
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

#define NOTES_MAX (1 << 20) // limit of shape descriptions in all moments

static const int COUNTS[] = { 1, 2, 4, 8, 16, 32 };

// The recorded state of each object at one time: the description of each shape, and owned copies (notes) of the other
// objects. The objects themselves are borrowed. Descriptions and notes retain the objects that they refer to.
typedef struct moment {
    int times, k;
    glint_shape **shapes;
    glint_shape_desc *shape_descs; // their materials are retained
    glint_light **lights, **light_notes;
    glint_material **materials, **material_notes;
    glint_camera *camera, *camera_note;
    glint_scene *scene_note;
    size_t shape_count, light_count, material_count;
} moment;

struct cost_moments {
    moment *list; // the last is the frame's own instant, if `closed`
    size_t count, notes;
    bool is_odd; // the objects differ between the times
    bool is_large;
};

// ---- Recording ----

static size_t gather_shapes(glint_shape *shape, glint_shape **out)
{
    size_t count = 1;
    if (out)
        *out = shape;
    for (size_t i = 0; i < glint_group_count(shape); i++)
        count += gather_shapes(glint_group_child(shape, i), out ? out + count : NULL);
    return count;
}

static bool note_shapes(moment *m, const glint_scene *scene)
{
    size_t count = 0;
    for (size_t i = 0; i < glint_scene_shape_count(scene); i++)
        count += gather_shapes(glint_scene_shape_at(scene, i), NULL);
    m->shapes = calloc(count + 1, sizeof *m->shapes);
    m->shape_descs = calloc(count + 1, sizeof *m->shape_descs);
    if (!m->shapes || !m->shape_descs)
        return false;
    for (size_t i = 0; i < glint_scene_shape_count(scene); i++)
        m->shape_count += gather_shapes(glint_scene_shape_at(scene, i), m->shapes + m->shape_count);
    for (size_t i = 0; i < m->shape_count; i++) {
        m->shape_descs[i] = *glint_shape_get(m->shapes[i]);
        if (m->shape_descs[i].material)
            glint_material_retain(m->shape_descs[i].material);
    }
    return true;
}

static bool note_lights(moment *m, const glint_scene *scene)
{
    bool good = true;
    m->light_count = glint_scene_light_count(scene);
    m->lights = calloc(m->light_count + 1, sizeof *m->lights);
    m->light_notes = calloc(m->light_count + 1, sizeof *m->light_notes);
    good = m->lights && m->light_notes;
    for (size_t i = 0; i < m->light_count && good; i++) {
        m->lights[i] = glint_scene_light_at(scene, i);
        good = glint_light_create(glint_light_get(m->lights[i]), &m->light_notes[i], NULL) == GLINT_OK;
    }
    return good;
}

static bool note_materials(moment *m, glint_scene *scene)
{
    cost_scene all;
    bool good = cost_scene_open(&all, scene);
    m->material_notes = good ? calloc(all.material_count + 1, sizeof *m->material_notes) : NULL;
    m->materials = good ? calloc(all.material_count + 1, sizeof *m->materials) : NULL;
    good = m->materials && m->material_notes;
    for (size_t i = 0; good && i < all.material_count; i++) {
        m->materials[i] = all.materials[i];
        good = glint_material_create(&all.material_descs[i], &m->material_notes[i], NULL) == GLINT_OK;
        m->material_count += good;
    }
    cost_scene_close(&all);
    return good;
}

static bool note_scene(moment *m, const glint_scene *scene)
{
    m->camera = glint_scene_get(scene)->camera;
    return glint_camera_create(glint_camera_get(m->camera), &m->camera_note, NULL) == GLINT_OK &&
           glint_scene_create(&m->scene_note, NULL) == GLINT_OK &&
           glint_scene_set(m->scene_note, glint_scene_get(scene), NULL) == GLINT_OK;
}

static bool has_same_objects(const moment *a, const moment *b)
{
    return a->shape_count == b->shape_count && a->light_count == b->light_count && a->material_count == b->material_count &&
           a->camera == b->camera && !memcmp(a->shapes, b->shapes, a->shape_count * sizeof *a->shapes) &&
           !memcmp(a->lights, b->lights, a->light_count * sizeof *a->lights) &&
           !memcmp(a->materials, b->materials, a->material_count * sizeof *a->materials);
}

// Records the scene at one time, see glintL_moments. times 0: the frame's own instant.
static bool see(void *data, glint_scene *scene, int times, int k)
{
    cost_moments *moments = data;
    if (moments->is_large || moments->is_odd)
        return true;
    moment *grown = realloc(moments->list, (moments->count + 1) * sizeof *grown);
    if (!grown)
        return false;
    moments->list = grown;
    moment *m = &grown[moments->count++];
    *m = (moment) { .times = times, .k = k };
    if (!note_shapes(m, scene) || !note_lights(m, scene) || !note_materials(m, scene) || !note_scene(m, scene))
        return false;
    moments->notes += m->shape_count;
    moments->is_large = moments->notes > NOTES_MAX;
    moments->is_odd = !has_same_objects(m, grown);
    return true;
}

cost_moments *cost_moments_open(glintL_moments *out)
{
    cost_moments *moments = calloc(1, sizeof *moments);
    *out = (glintL_moments) { COUNTS, sizeof COUNTS / sizeof *COUNTS, moments ? see : NULL, moments };
    return moments;
}

static void free_moment(moment *m)
{
    for (size_t i = 0; i < m->shape_count; i++)
        glint_material_release(m->shape_descs[i].material);
    for (size_t i = 0; m->light_notes && i < m->light_count; i++)
        glint_light_release(m->light_notes[i]);
    for (size_t i = 0; i < m->material_count; i++)
        glint_material_release(m->material_notes[i]);
    glint_camera_release(m->camera_note);
    glint_scene_release(m->scene_note);
    free(m->shapes);
    free(m->shape_descs);
    free(m->lights);
    free(m->light_notes);
    free(m->materials);
    free(m->material_notes);
}

void cost_moments_close(cost_moments *moments)
{
    for (size_t i = 0; moments && i < moments->count; i++)
        free_moment(&moments->list[i]);
    if (moments)
        free(moments->list);
    free(moments);
}

// ---- Reading ----

const char *cost_moments_lack(const cost_moments *moments)
{
    return moments->is_odd ? "the frame function creates new objects at each time" : moments->is_large ? "the scene is too large" : NULL;
}

int cost_moments_counts(const cost_moments *moments, double out[COST_VALUES_MAX])
{
    int found = 0;
    for (size_t i = 0; i < moments->count && !cost_moments_lack(moments); i++)
        if (moments->list[i].times > 0 && moments->list[i].k == 0 && found < COST_VALUES_MAX)
            out[found++] = moments->list[i].times;
    return found;
}

glint_status cost_moments_enter(const cost_moments *moments, glint_scene *scene, int times, int k, glint_error *error)
{
    const moment *m = moments->list;
    while (m->times != times || m->k != k)
        m++;
    glint_status status = glint_camera_set(m->camera, glint_camera_get(m->camera_note), error);
    if (!status)
        status = glint_scene_set(scene, glint_scene_get(m->scene_note), error);
    for (size_t i = 0; i < m->material_count && !status; i++)
        status = glint_material_set(m->materials[i], glint_material_get(m->material_notes[i]), error);
    for (size_t i = 0; i < m->light_count && !status; i++)
        status = glint_light_set(m->lights[i], glint_light_get(m->light_notes[i]), error);
    for (size_t i = 0; i < m->shape_count && !status; i++)
        if (memcmp(glint_shape_get(m->shapes[i]), &m->shape_descs[i], sizeof *m->shape_descs))
            status = glint_shape_set(m->shapes[i], &m->shape_descs[i], error);
    return status;
}
