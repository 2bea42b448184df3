// A frame's scene at the times of an open shutter, for every number of times in the rows of shutter_times. The state of
// each object is recorded while the script runs its frame function, and restored when a row is planned.
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

#define NOTES_MAX (1 << 20) // limit of shape descriptions in all moments

static const int COUNTS[] = { 1, 2, 4, 8, 16, 32 };

// The recorded state of each object at one time.
typedef struct moment {
    int times, k;
    cost_scene scene;
    glint_shape_desc *shape_descs; // of the scene's shapes; their materials are retained
} moment;

struct cost_moments {
    moment *list; // the last is the frame's own instant
    size_t count, notes;
    bool is_odd; // the objects differ between the times
    bool is_large;
};

// ---- Recording ----

static bool note_shapes(moment *m)
{
    m->shape_descs = calloc(m->scene.shape_count + 1, sizeof *m->shape_descs);
    for (size_t i = 0; i < m->scene.shape_count && m->shape_descs; i++) {
        m->shape_descs[i] = *glint_shape_get(m->scene.shapes[i]);
        m->shape_descs[i].struct_size = sizeof m->shape_descs[i];
        if (m->shape_descs[i].material)
            glint_material_retain(m->shape_descs[i].material);
    }
    return m->shape_descs != NULL;
}

static bool has_same_objects(const moment *m, const moment *n)
{
    const cost_scene *a = &m->scene, *b = &n->scene;
    return a->shape_count == b->shape_count && a->light_count == b->light_count &&
           a->material_count == b->material_count && a->camera == b->camera &&
           !memcmp(a->shapes, b->shapes, a->shape_count * sizeof *a->shapes) &&
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
    if (!cost_scene_open(&m->scene, scene) || !note_shapes(m))
        return false;
    moments->notes += m->scene.shape_count;
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
    for (size_t i = 0; m->shape_descs && i < m->scene.shape_count; i++)
        glint_material_release(m->shape_descs[i].material);
    cost_scene_close(&m->scene);
    free(m->shape_descs);
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
    return moments->is_odd     ? "the frame function creates new objects at each time"
           : moments->is_large ? "the scene is too large"
                               : NULL;
}

int cost_moments_counts(const cost_moments *moments, double out[COST_VALUES_MAX])
{
    int found = 0;
    for (size_t i = 0; i < moments->count && !cost_moments_lack(moments); i++)
        if (moments->list[i].times > 0 && moments->list[i].k == 0 && found < COST_VALUES_MAX)
            out[found++] = moments->list[i].times;
    return found;
}

glint_status cost_moments_enter(const cost_moments *moments, int times, int k, cost_scene **scene, glint_error *error)
{
    moment *m = moments->list;
    while (m->times != times || m->k != k)
        m++;
    *scene = &m->scene;
    glint_status status = cost_scene_restore(&m->scene, error);
    for (size_t i = 0; i < m->scene.shape_count && !status; i++)
        if (memcmp(glint_shape_get(m->scene.shapes[i]), &m->shape_descs[i], sizeof *m->shape_descs))
            status = glint_shape_set(m->scene.shapes[i], &m->shape_descs[i], error);
    return status;
}
