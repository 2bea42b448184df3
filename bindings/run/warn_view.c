// Warnings about positions: a light inside a closed sphere, an object that no frame can show, a smooth mesh of so few
// faces that their own shadows are visible.
//
// Each is given only if it is certain, for single shapes and for shapes in groups, after their transforms. A bounding
// ball is outside the picture when it is outside one plane of the view. Its shadow (the points whose segment to the
// light meets the ball) is convex, so the same test applies: no part of the shadow is inside the plane if the ball is
// outside and the light is no further out than the ball's near side.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bindings/run/run.h"

#define MEMBERS_MAX 1000 // limit of shapes in a scene with its groups: in larger scenes single shapes are not checked
#define LIGHTS_MAX 64
#define BEND_MOST 11.0 // degrees between faces and normals of a smooth mesh: shadows cut off light at a cosine of 0.19
#define UNSEEN_MAX 1000 // shapes with an entry in a run's list; others are not reported

// Registry keys of two tables. NOTED, with weak keys: a shape's userdata -> its index in UNSEEN, or false once a frame
// may show it. UNSEEN: index -> description of the shape, which outlives the shape.
static const char NOTED, UNSEEN;

typedef struct view {
    double eye[3];
    double out[5][3], limit[5]; // planes: a point is outside where out . p > limit
    double forward[3];
    bool is_perspective;
} view;

// A bounding ball of a shape, in world space.
typedef struct ball {
    double center[3], radius;
    bool is_sphere; // the shape is exactly this sphere
} ball;

typedef struct members {
    const glint_light *lights[LIGHTS_MAX];
    int light_count;
    int shape_count; // number of shapes, including shapes in groups
    bool shows_more; // mirrors, a lens and the like can show objects outside the view
} members;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static bool normalize(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return length > 0 && isfinite(length);
}

// ---- The view ----

// Adds a plane of the view. Its outward normal is between `side` and the backward direction; in an orthographic view it
// is `side`.
static void add_plane(view *v, int i, const double side[3], double sign, double reach)
{
    for (int c = 0; c < 3; c++)
        v->out[i][c] = v->is_perspective ? sign * side[c] - reach * v->forward[c] : sign * side[c];
    normalize(v->out[i]);
    v->limit[i] = dot(v->out[i], v->eye) + (v->is_perspective ? 0 : reach);
}

bool glintL_view_axes(const glint_camera_desc *camera, double forward[3], double right[3], double up[3])
{
    for (int i = 0; i < 3; i++)
        forward[i] = camera->has_direction ? camera->direction[i] : camera->at[i] - camera->eye[i];
    memcpy(up, camera->up, sizeof camera->up);
    if (!normalize(forward) || !normalize(up))
        return false;
    cross(forward, up, right);
    if (dot(right, right) < 1e-6 || !normalize(right))
        return false;
    cross(right, forward, up);
    return true;
}

// Computes the view. False: the camera looks along its `up`.
static bool make_view(const glint_camera_desc *camera, const glint_render_desc *desc, view *v)
{
    double right[3], up[3], window[4];
    memcpy(v->eye, camera->eye, sizeof v->eye);
    if (!glintL_view_axes(camera, v->forward, right, up))
        return false;
    v->is_perspective = camera->projection == GLINT_PROJECTION_PERSPECTIVE;
    glint_camera_window(camera, desc->width, desc->height, window);
    for (int i = 0; i < 4; i++)
        add_plane(v, i, i < 2 ? right : up, i % 2 ? 1 : -1, i % 2 ? -window[i - 1] : window[i + 1]);
    for (int c = 0; c < 3; c++)
        v->out[4][c] = -v->forward[c];
    v->limit[4] = dot(v->out[4], v->eye);
    return true;
}

// Returns whether the whole ball is outside one plane and, with a light, also its whole shadow.
static bool is_outside(const view *v, const ball *all, const glint_light_desc *light)
{
    double radius = all->radius * (1 + 1e-9);
    for (int i = 0; i < 5; i++) {
        double near = dot(v->out[i], all->center) - radius, spread = 0; // of the shadow; < 0: inwards
        if (light && light->kind == GLINT_LIGHT_POINT)
            spread = near - dot(v->out[i], light->position);
        else if (light)
            spread = dot(v->out[i], light->direction);
        if (near > v->limit[i] + 1e-9 * fabs(v->limit[i]) && spread >= 0)
            return true;
    }
    return false;
}

// ---- The scene ----

// Returns whether the object has a field of this name with a value other than 0, black, false or nil.
static bool has(lua_State *L, const char *type, const void *object, const void *desc, int index, const char *name)
{
    const glintL_field *field = glintL_find_field(glintL_fields_of(glintL_class_of(L, type)->variant(object)), name);
    const char *at = (const char *)desc + (field ? field->offset : 0);
    if (!field)
        return false;
    if (field->type == GLINT_TYPE_COLOR)
        return ((const double *)(const void *)at)[0] != 0 || ((const double *)(const void *)at)[1] != 0 ||
               ((const double *)(const void *)at)[2] != 0;
    if (field->type == GLINT_TYPE_NUMBER)
        return *(const double *)(const void *)at != 0;
    if (index == 0)
        return true;
    bool given = lua_getfield(L, index, name) != LUA_TNIL;
    lua_pop(L, 1);
    return given;
}

static bool shows_through(lua_State *L, const glint_material *material)
{
    const glint_material_desc *desc = material ? glint_material_get(material) : NULL;
    return desc && (desc->fresnel || desc->program.opacity || desc->opacity < 1 ||
                    has(L, GLINTL_MATERIAL, material, desc, 0, "transmission") ||
                    has(L, GLINTL_MATERIAL, material, desc, 0, "mirror"));
}

// Calls `visit` for each object of the scene at `scene`, with its userdata on top.
static void each_member(lua_State *L, int scene, void (*visit)(lua_State *L, void *context), void *context)
{
    if (lua_getiuservalue(L, scene, 1) == LUA_TTABLE) {
        lua_pushnil(L);
        while (lua_next(L, -2)) {
            visit(L, context);
            lua_pop(L, 1);
        }
    }
    lua_pop(L, 1);
}

// Computes the ball of a shape before its transform; false: unknown.
static bool find_ball(const glint_shape *shape, ball *out)
{
    const glint_shape_desc *desc = glint_shape_get(shape);
    double half[3], square = 0, lower[3], upper[3];
    const bool is_torus = desc->kind == GLINT_SHAPE_TORUS;
    bool is_round = desc->kind == GLINT_SHAPE_SPHERE || desc->kind == GLINT_SHAPE_DISK || is_torus;
    bool is_long = desc->kind == GLINT_SHAPE_CYLINDER || desc->kind == GLINT_SHAPE_CONE;
    const bool is_many = glint_shape_bounds(shape, lower, upper);
    const double *low = is_many ? lower : is_long ? desc->base : desc->min;
    const double *high = is_many ? upper : is_long ? desc->top : desc->max;
    if (!is_round && !is_long && !is_many && desc->kind != GLINT_SHAPE_BOX)
        return false;
    for (int c = 0; c < 3; c++) {
        half[c] = is_round ? 0 : (high[c] - low[c]) / 2;
        out->center[c] = is_round ? desc->center[c] : low[c] + half[c];
        square += half[c] * half[c];
    }
    if (!is_torus && (is_round || is_long))
        square += desc->radius * desc->radius;
    out->radius = is_torus ? desc->major + desc->minor : sqrt(square);
    out->is_sphere = desc->kind == GLINT_SHAPE_SPHERE;
    return true;
}

// Transforms a ball. If the transform does not preserve angles, the result is a larger ball around the image.
static void move_ball(const glint_transform *t, ball *b)
{
    double from[3], squares[3] = { 0 }, between = 0;
    memcpy(from, b->center, sizeof from);
    for (int i = 0; i < 3; i++) {
        b->center[i] = dot(t->m[i], from) + t->m[i][3];
        for (int j = 0; j < 3; j++)
            squares[j] += t->m[i][j] * t->m[i][j];
    }
    for (int j = 0; j < 3; j++) {
        double product = 0; // dot product of two columns
        for (int i = 0; i < 3; i++)
            product += t->m[i][j] * t->m[i][(j + 1) % 3];
        between = fmax(between, fabs(product));
    }
    bool keeps_angles = between <= 1e-9 * squares[0] && fabs(squares[1] - squares[0]) <= 1e-9 * squares[0] &&
                        fabs(squares[2] - squares[0]) <= 1e-9 * squares[0];
    b->radius *= sqrt(keeps_angles ? squares[0] : squares[0] + squares[1] + squares[2]);
    b->is_sphere = b->is_sphere && keeps_angles;
}

// Enlarges `all` to contain both balls.
static void join_balls(ball *all, const ball *b)
{
    double way[3];
    for (int i = 0; i < 3; i++)
        way[i] = b->center[i] - all->center[i];
    const double length = sqrt(dot(way, way));
    if (length + b->radius <= all->radius)
        return;
    if (length + all->radius <= b->radius) {
        *all = *b;
        return;
    }
    const double radius = (length + all->radius + b->radius) / 2;
    for (int i = 0; i < 3; i++)
        all->center[i] += way[i] * ((radius - all->radius) / length);
    all->radius = radius;
}

// Adds the bounds of a shape to `all`, whose radius is negative while it is empty. A plane has no ball. With a view, adds
// only balls that may be in it.
static void bound_shape(const glint_shape *shape, const glint_transform *around, const view *v, ball *all)
{
    ball b;
    const glint_transform placed = glint_transform_product(around, &glint_shape_get(shape)->transform);
    for (size_t i = 0; i < glint_group_count(shape); i++)
        bound_shape(glint_group_child(shape, i), &placed, v, all);
    if (!find_ball(shape, &b))
        return;
    move_ball(&placed, &b);
    if (v && is_outside(v, &b, NULL))
        return;
    if (all->radius < 0)
        *all = b;
    else
        join_balls(all, &b);
}

static void bound_shapes(const glint_scene *scene, const view *v, ball *all)
{
    const glint_transform here = glint_transform_identity();
    *all = (ball) { .radius = -1 };
    for (size_t i = 0; i < glint_scene_shape_count(scene); i++)
        bound_shape(glint_scene_shape_at(scene, i), &here, v, all);
}

bool glintL_bound_scene(const glint_scene *scene, double center[3], double *radius)
{
    ball all;
    bound_shapes(scene, NULL, &all);
    memcpy(center, all.center, sizeof all.center);
    *radius = all.radius;
    return all.radius > 0 && isfinite(all.radius);
}

bool glintL_may_show(const glint_scene *scene, const glint_camera_desc *camera, const glint_render_desc *desc)
{
    view v;
    ball all;
    bound_shapes(scene, make_view(camera, desc, &v) ? &v : NULL, &all);
    return all.radius >= 0;
}

// Returns whether a shape, or any shape in a group, has a mirror, a transparent material or holes. Counts the shapes
// visited.
static bool any_shows_through(lua_State *L, const glint_shape *shape, int *count)
{
    glint_material *const *list;
    const size_t materials = glint_shape_materials(shape, &list);
    if (++*count > MEMBERS_MAX)
        return true;
    for (size_t i = 0; i < materials; i++)
        if (shows_through(L, list[i]))
            return true;
    for (size_t i = 0; i < glint_group_count(shape); i++)
        if (any_shows_through(L, glint_group_child(shape, i), count))
            return true;
    return false;
}

static void gather(lua_State *L, void *context)
{
    members *all = context;
    const glint_light *light = glintL_test_object(L, -1, GLINTL_LIGHT);
    const glint_shape *shape = glintL_test_object(L, -1, GLINTL_SHAPE);
    const glint_light_desc *desc = light ? glint_light_get(light) : NULL;
    if (shape)
        all->shows_more = all->shows_more || any_shows_through(L, shape, &all->shape_count);
    if (!desc || !desc->shadows)
        return;
    // Other lights have an area or a cone; their shadows are not checked here.
    bool is_simple = desc->kind == GLINT_LIGHT_POINT || desc->kind == GLINT_LIGHT_DIRECTIONAL;
    if (is_simple && all->light_count < LIGHTS_MAX)
        all->lights[all->light_count++] = light;
    else
        all->shows_more = true;
}

// ---- Shapes ----

typedef struct look {
    glintL_run *run;
    int64_t number;
    const view *view; // NULL: unknown
    const members *all;
    int noted, unseen; // stack indices of the two tables
    bool whole; // every frame is rendered
} look;

static void describe(const glint_shape_desc *shape, const ball *b, char out[160])
{
    static const char *const names[] = {
        [GLINT_SHAPE_SPHERE] = "sphere", [GLINT_SHAPE_SPHERES] = "set of spheres", [GLINT_SHAPE_MESH] = "mesh",
        [GLINT_SHAPE_BOX] = "box",       [GLINT_SHAPE_DISK] = "disk",       [GLINT_SHAPE_CYLINDER] = "cylinder",
        [GLINT_SHAPE_CONE] = "cone",     [GLINT_SHAPE_TORUS] = "torus",     [GLINT_SHAPE_CYLINDERS] = "set of cylinders"
    };
    if (*shape->name)
        snprintf(out, 160, "%s '%s'", names[shape->kind], shape->name);
    else
        snprintf(out, 160, "the %s %s {%g, %g, %g}", names[shape->kind],
                 shape->kind == GLINT_SHAPE_SPHERES || shape->kind == GLINT_SHAPE_CYLINDERS || shape->kind == GLINT_SHAPE_MESH
                     ? "around" : "at", b->center[0],
                 b->center[1], b->center[2]);
}

static bool is_dark(const glint_light_desc *light)
{
    return light->intensity == 0 || (light->color[0] == 0 && light->color[1] == 0 && light->color[2] == 0);
}

// Warns about a light inside a sphere: no light leaves the sphere, and from outside the sphere hides everything lit.
static void look_for_inner_light(const look *l, const glint_shape_desc *shape, const ball *sphere)
{
    char name[160];
    double to_eye[3], distance = 0;
    for (int c = 0; c < 3; c++)
        to_eye[c] = l->view->eye[c] - sphere->center[c];
    distance = l->view->is_perspective ? sqrt(dot(to_eye, to_eye)) : -dot(to_eye, l->view->forward);
    for (int i = 0; i < l->all->light_count && distance > sphere->radius; i++) {
        const glint_light_desc *light = glint_light_get(l->all->lights[i]);
        double off[3];
        for (int c = 0; c < 3; c++)
            off[c] = light->position[c] - sphere->center[c];
        if (light->kind != GLINT_LIGHT_POINT || is_dark(light) || dot(off, off) >= sphere->radius * sphere->radius)
            continue;
        describe(shape, sphere, name);
        l->run->told_of_view = true;
        glintL_run_warn(
            l->run,
            "frame %lld: a point_light%s%s%s is inside %s, which lets none of its light out; move it, or set "
            "its shadows = false",
            (long long)l->number, *light->name ? " '" : "", light->name, *light->name ? "'" : "", name);
    }
}

// Warns about coarse smooth meshes. Shadows come from the faces, shading from the normals: where a light grazes a face
// whose normals are turned towards it, the face is dark to its edge. Only for spheres of triangles, since the script
// chooses their number of faces, unlike a model's.
static void look_for_bends(const look *l, const glint_shape *shape, const ball *b)
{
    char name[160];
    bool shadows = false;
    double center[3], radius;
    int64_t segments;
    if (!glint_sphere_mesh_get(shape, center, &radius, &segments))
        return;
    if (glint_shape_get(shape)->terminator > 0)
        return;
    const double bend = glint_mesh_bend(shape) * (180 / 0x1.921fb54442d18p+1);
    for (int i = 0; i < l->all->light_count; i++)
        shadows = shadows || (glint_light_get(l->all->lights[i])->shadows && !is_dark(glint_light_get(l->all->lights[i])));
    if (!shadows || !(bend > BEND_MOST) || (l->view && is_outside(l->view, b, NULL)))
        return;
    describe(glint_shape_get(shape), b, name);
    glintL_run_warn(l->run,
                    "%s: its smooth normals differ from its flat faces by up to %.0f degrees, so its shadow in "
                    "grazing light follows the flat faces; set its terminator = 1, or use more segments",
                    name, bend);
}

static bool is_unseen(const look *l, const ball *b)
{
    bool unseen = is_outside(l->view, b, NULL);
    for (int i = 0; i < l->all->light_count && unseen; i++)
        unseen = is_outside(l->view, b, glint_light_get(l->all->lights[i]));
    return unseen;
}

// Adds the shape to the list of unseen shapes, and pushes its index; pushes nil when the list is full.
static void push_place(lua_State *L, const look *l, const glint_shape_desc *shape, const ball *b)
{
    char name[160];
    lua_rawgeti(L, l->unseen, 0);
    lua_Integer place = lua_tointeger(L, -1) + 1;
    lua_pop(L, 1);
    if (place > UNSEEN_MAX) {
        lua_pushnil(L);
        return;
    }
    describe(shape, b, name);
    lua_pushstring(L, name);
    lua_rawseti(L, l->unseen, place);
    lua_pushinteger(L, place);
    lua_pushvalue(L, -1);
    lua_rawseti(L, l->unseen, 0);
}

// Records whether any frame has shown the shape whose userdata is on top.
static void look_for_unseen(lua_State *L, const look *l, const glint_shape_desc *shape, const ball *b)
{
    lua_pushvalue(L, -1);
    int before = lua_rawget(L, l->noted);
    lua_Integer place = lua_tointeger(L, -1);
    lua_pop(L, 1);
    bool seen = !l->view || l->all->shows_more || !is_unseen(l, b);
    if (before == LUA_TBOOLEAN || (before == LUA_TNUMBER && !seen))
        return;
    if (before == LUA_TNUMBER) {
        lua_pushnil(L);
        lua_rawseti(L, l->unseen, place);
    }
    lua_pushvalue(L, -1);
    if (seen)
        lua_pushboolean(L, false);
    else
        push_place(L, l, shape, b);
    lua_rawset(L, l->noted);
}

// Checks one shape, or all in a group, under the transforms around it; its userdata is on top, or nil.
static void look_into(lua_State *L, const look *l, const glint_shape *shape, const glint_transform *outer, int *count)
{
    ball b;
    const glint_shape_desc *desc = glint_shape_get(shape);
    const glint_transform placed = glint_transform_product(outer, &desc->transform);
    if (++*count > MEMBERS_MAX || desc->kind >= GLINT_SHAPE_UNION) // skips parts of combined solids
        return;
    for (size_t i = 0; i < glint_group_count(shape); i++) {
        const glint_shape *child = glint_group_child(shape, i);
        glintL_push_remembered(L, child);
        look_into(L, l, child, &placed, count);
        lua_pop(L, 1);
    }
    if (!find_ball(shape, &b))
        return;
    move_ball(&placed, &b);
    if (l->view && b.is_sphere && !shows_through(L, desc->material))
        look_for_inner_light(l, desc, &b);
    if (desc->kind == GLINT_SHAPE_MESH)
        look_for_bends(l, shape, &b);
    if (l->whole && !lua_isnil(L, -1))
        look_for_unseen(L, l, desc, &b);
}

static void look_at(lua_State *L, void *context)
{
    const look *l = context;
    const glint_shape *shape = glintL_test_object(L, -1, GLINTL_SHAPE);
    const glint_transform here = glint_transform_identity();
    int count = 0;
    if (shape)
        look_into(L, l, shape, &here, &count);
}

// Records which frames use their camera's lens.
static void note_focus(glintL_run *run, const glint_camera_desc *camera)
{
    run->has_aperture = run->has_aperture || camera->aperture > 0;
    run->has_focus = run->has_focus || camera->focus > 0 || camera->has_focus_point || camera->blades > 0;
}

void glintL_observe_frame(lua_State *L, glintL_run *run, int scene_index, const glint_render_desc *desc, int64_t number)
{
    const glint_scene *scene = glintL_test_object(L, scene_index, GLINTL_SCENE);
    const glint_camera *camera = scene ? glint_scene_get(scene)->camera : NULL;
    view v;
    members all = { .light_count = 0 };
    bool observes = run->mode == GLINTL_MODE_RENDER || run->mode == GLINTL_MODE_WATCH;
    if (!camera || !observes || run->request.warnings == GLINTL_WARNINGS_NONE ||
        glint_scene_shape_count(scene) + glint_scene_light_count(scene) > MEMBERS_MAX)
        return;
    luaL_checkstack(L, 16 + GLINT_GROUP_DEPTH, "scene");
    scene_index = lua_absindex(L, scene_index);
    glintL_push_weak_table(L, &NOTED, "k");
    glintL_push_table(L, &UNSEEN);
    look l = { .run = run, .number = number, .all = &all, .noted = lua_gettop(L) - 1, .unseen = lua_gettop(L) };
    l.view = make_view(glint_camera_get(camera), desc, &v) ? &v : NULL;
    l.whole = glintL_selection_is_whole(&run->request.selection);
    note_focus(run, glint_camera_get(camera));
    all.shows_more = glint_camera_get(camera)->aperture > 0 || has(L, GLINTL_SCENE, scene, glint_scene_get(scene), scene_index, "indirect");
    each_member(L, scene_index, gather, &all);
    each_member(L, scene_index, look_at, &l);
    lua_pop(L, 2);
}

void glintL_report_unseen(lua_State *L, glintL_run *run)
{
    const char *first = NULL;
    int count = 0;
    luaL_checkstack(L, 8, "warnings");
    glintL_push_table(L, &UNSEEN);
    lua_pushnil(L);
    while (lua_next(L, -2)) {
        const char *name = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : NULL;
        if (name && (!first || strcmp(name, first) < 0)) // tables have no order; the list retains the string
            first = name;
        count += name != NULL;
        lua_pop(L, 1);
    }
    run->told_of_view = run->told_of_view || count > 0;
    if (run->has_focus && !run->has_aperture)
        glintL_run_warn(run, "camera.focus and camera.blades change nothing while its aperture is 0: set aperture, the "
                             "radius of the lens");
    if (count > 1)
        glintL_run_warn(run,
                        "%s and %d more are outside the view in every frame, with their shadows; move them, or the "
                        "camera",
                        first, count - 1);
    else if (count == 1)
        glintL_run_warn(run, "%s is outside the view in every frame, with its shadow; move it, or the camera", first);
    lua_pop(L, 1);
}
