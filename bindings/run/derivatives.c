// Passes d:NAME: finds the variables of a frame's derivatives, and the slopes stored in the scene's objects.
#include <stdlib.h>
#include <string.h>

#include "bindings/run/carried.h"

#define PI 0x1.921fb54442d18p+1

static const char LIST; // address used as the registry key for the slopes of the current frame

bool glintL_wants_variable(const glintL_run *run, const char *name)
{
    const char *text = run->request.render_text[glintL_render_find("passes")];
    const size_t length = strlen(name);
    for (const char *at = text; at && *at;) {
        at += strspn(at, " ,");
        const size_t size = strcspn(at, " ,");
        if (size == length + 2 && strncmp(at, "d:", 2) == 0 && strncmp(at + 2, name, length) == 0)
            return true;
        at += size;
    }
    return false;
}

typedef struct gathering {
    const glint_scene *scene;
    glint_slope *out; // NULL: only counts
    size_t count;
} gathering;

// The slopes of a frame. Retains their objects, which the script may have dropped: an object in no scene is found until
// it is collected.
typedef struct slope_list {
    size_t slope_count;
    glint_derivative of[GLINT_DERIVATIVES_MAX];
    char names[GLINT_DERIVATIVES_MAX][GLINT_DERIVATIVE_NAME_SIZE];
    glint_slope slopes[];
} slope_list;

static int drop_list(lua_State *L)
{
    slope_list *list = lua_touserdata(L, 1);
    for (; list->slope_count > 0; list->slope_count--) {
        const glint_slope *slope = &list->slopes[list->slope_count - 1];
        glint_material_release((glint_material *)slope->material);
        glint_light_release((glint_light *)slope->light);
        glint_shape_release((glint_shape *)slope->shape);
        glint_camera_release((glint_camera *)slope->camera);
    }
    return 0;
}

// Returns the derivative of a field's program by a variable; NULL: it is 0, or there is no program.
static const glint_program *find_tangent(const glintL_class *class, const void *object, const glintL_field *field, int variable)
{
    union {
        max_align_t align;
        char bytes[GLINTL_DESC_SIZE];
    } desc;
    const glint_program *program;
    if (!field->program_offset)
        return NULL;
    class->get(object, &desc);
    memcpy(&program, desc.bytes + field->program_offset, sizeof program);
    return program ? glint_program_tangent(program, (size_t)variable) : NULL;
}

// Adds the slopes by a variable of the object whose userdata is at `index`. Allocates nothing.
static void gather_object(lua_State *L, int index, const char *type, int variable, gathering *g)
{
    const glintL_class *class = glintL_class_of(L, type);
    void *object = glintL_test_object(L, index, type);
    if (!object || (strcmp(type, GLINTL_SCENE) == 0 && object != g->scene))
        return;
    for (const glintL_field *field = glintL_fields_of(class->variant(object)); field->name; field++) {
        glint_slope slope = { .field = field->member ? field->member : field->name, .program = find_tangent(class, object, field, variable) };
        if (!glintL_get_slope(L, index, field, variable, slope.slope) && !slope.program)
            continue;
        for (int c = 0; c < 3 && field->type == GLINT_TYPE_ANGLE; c++)
            slope.slope[c] *= PI / 180;
        slope.material = strcmp(type, GLINTL_MATERIAL) == 0 ? object : NULL;
        slope.light = strcmp(type, GLINTL_LIGHT) == 0 ? object : NULL;
        slope.shape = strcmp(type, GLINTL_SHAPE) == 0 ? object : NULL;
        slope.camera = strcmp(type, GLINTL_CAMERA) == 0 ? object : NULL;
        if (g->out) {
            g->out[g->count] = slope;
            if (strcmp(type, GLINTL_SCENE) != 0)
                class->retain(object); // drop_list releases it
        }
        g->count++;
    }
}

static void gather(lua_State *L, int variable, gathering *g)
{
    static const char *const types[] = { GLINTL_MATERIAL, GLINTL_LIGHT, GLINTL_SHAPE, GLINTL_CAMERA, GLINTL_SCENE };
    glintL_push_all_sloped(L);
    for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1))
        for (size_t i = 0; i < sizeof types / sizeof *types; i++)
            gather_object(L, lua_gettop(L) - 1, types[i], variable, g);
    lua_pop(L, 1);
}

static void refuse_name(lua_State *L, const char *name)
{
    const char *near = glintL_near_variable(L, name);
    if (near)
        luaL_error(L, "passes: d:%s: no variable of that name; did you mean 'd:%s'?", name, near);
    luaL_error(L,
               "passes: d:%s: no variable of that name; make one with glint.variable(\"%s\", x), or use --passes "
               "d:%s with the name of a parameter that the script reads",
               name, name, name);
}

void glintL_find_derivatives(lua_State *L, const glint_scene *scene, glintL_render *render)
{
    const int top = lua_gettop(L), count = render->derivative_count;
    size_t total = 0, first[GLINT_DERIVATIVES_MAX + 1] = { 0 };
    render->desc.derivatives = NULL;
    render->desc.derivative_count = 0;
    if (count == 0)
        return;
    luaL_checkstack(L, 16, "derivatives");
    for (int i = 0; i < count; i++) {
        gathering g = { .scene = scene };
        const int variable = glintL_find_variable(L, render->derivative[i]);
        if (variable < 0)
            refuse_name(L, render->derivative[i]);
        gather(L, variable, &g);
        total += g.count;
        first[i + 1] = total;
    }
    // The allocation may collect objects, and their finalizers may change others. So at most as many slopes are stored
    // as were counted.
    slope_list *list = glintL_push_owner(L, sizeof *list + total * sizeof *list->slopes, "glint.slopes", drop_list);
    list->slope_count = total;
    lua_rawsetp(L, LUA_REGISTRYINDEX, &LIST);
    for (int i = 0; i < count; i++) {
        gathering g = { .scene = scene };
        const int variable = glintL_find_variable(L, render->derivative[i]);
        gather(L, variable, &g);
        if (g.count > first[i + 1] - first[i])
            luaL_error(L, "passes: d:%s: a finalizer (__gc) changed values that it depends on", render->derivative[i]);
        g = (gathering) { .scene = scene, .out = list->slopes + first[i] };
        gather(L, variable, &g);
        memcpy(list->names[i], render->derivative[i], sizeof list->names[i]);
        list->of[i] = (glint_derivative) { list->names[i], list->slopes + first[i], g.count };
    }
    render->desc.derivatives = list->of;
    render->desc.derivative_count = (size_t)count;
    lua_settop(L, top);
}
