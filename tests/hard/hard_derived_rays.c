/// Derivatives of pictures in mirrors and glass against central differences of the formulas in 113 bits: with respect
/// to mirror and transmission, positions, and the properties of the surfaces that secondary rays hit.
#include "engine/glint_programs.h"
#include "tests/engine/cases/step.h"
#include "tests/hard/oracle/slopes.h"

#include <string.h>

#define WIDTH 40
#define HEIGHT 30
#define DEPTH 3
#define NEAR ((quad)1e-18) ///< minimum distance of a hit from the ray's own surface

/// The material of the first ball.
typedef enum stuff { MIRROR, GLASS, PANE, VARNISH, STUFFS } stuff; ///< pane: glass without Fresnel reflectance;
    ///< varnish: an opaque material with it

/// A reflecting or refracting ball and a matt one above a mirroring floor.
typedef struct world {
    quad diffuse[3], specular[3], shininess[3], mirror[3], transmission[3], ior[3], absorption[3], floor_mirror[3];
    quad position[3], intensity[3], background[3];
    quad ball[3], radius[3], other[3], point[3], normal[3], eye[3], at[3];
    stuff stuff;
    bool shadows, absorbs;
} world;

static const number numbers[] = {
    NUMBER("ball's", "diffuse", diffuse, 3),
    NUMBER("ball's", "shininess", shininess, 1),
    NUMBER("ball's", "mirror", mirror, 3),
    NUMBER("ball's", "transmission", transmission, 3),
    NUMBER("ball's", "ior", ior, 1),
    NUMBER("ball's", "absorption", absorption, 3),
    NUMBER("floor's", "mirror", floor_mirror, 3),
    NUMBER("light", "position", position, 3),
    NUMBER("light", "intensity", intensity, 1),
    NUMBER("scene", "background", background, 3),
    NUMBER("ball", "center", ball, 3),
    NUMBER("ball", "radius", radius, 1),
    NUMBER("other", "center", other, 3),
    NUMBER("floor", "point", point, 3),
    NUMBER("floor", "normal", normal, 3),
    NUMBER("camera", "eye", eye, 3),
    NUMBER("camera", "at", at, 3),
};

enum { NOTHING, BALL, OTHER, FLOOR };

// ---- The formulas, from their definitions -------------------------------------------------------------------------

/// Intersects a line with a ball. t gets the two distances. Returns false for a miss.
static bool meet_ball(const quad center[3], quad radius, const quad o[3], const quad d[3], quad t[2])
{
    const quad f[3] = { o[0] - center[0], o[1] - center[1], o[2] - center[2] };
    const quad b = dot(f, d), disc = b * b - (dot(f, f) - radius * radius);
    t[0] = -b - sqrtf128(disc > 0 ? disc : 0);
    t[1] = -b + sqrtf128(disc > 0 ? disc : 0);
    return disc >= 0;
}

static int nearest(const world *w, const quad o[3], const quad d[3], quad *far)
{
    int found = NOTHING;
    quad t[2], n[3] = { w->normal[0], w->normal[1], w->normal[2] };
    const quad over[3] = { w->point[0] - o[0], w->point[1] - o[1], w->point[2] - o[2] };
    *far = 1e30;
    for (int k = BALL; k <= OTHER; k++)
        for (int i = 0; i < 2; i++)
            if (meet_ball(k == BALL ? w->ball : w->other, k == BALL ? w->radius[0] : 1, o, d, t) && t[i] > NEAR && t[i] < *far) {
                *far = t[i];
                found = k;
            }
    const quad on_floor = dot(n, over) / dot(n, d);
    if (on_floor > NEAR && on_floor < *far) {
        *far = on_floor;
        found = FLOOR;
    }
    return found;
}

/// Returns the light in channel c that reaches a point directly.
static quad reach(const world *w, const quad p[3], const quad l[3], quad distance, int c)
{
    quad t[2], left = 1;
    if (!w->shadows)
        return 1;
    for (int i = 0; i < 2; i++) {
        if (meet_ball(w->other, 1, p, l, t) && t[i] > NEAR && t[i] < distance)
            return 0;
        if (meet_ball(w->ball, w->radius[0], p, l, t) && t[i] > NEAR && t[i] < distance)
            left *= w->stuff == GLASS || w->stuff == PANE ? w->transmission[c] : 0;
    }
    if (w->absorbs && meet_ball(w->ball, w->radius[0], p, l, t) && t[1] > NEAR && t[0] < distance)
        left *= expf128(-w->absorption[c] * ((t[1] < distance ? t[1] : distance) - (t[0] > 0 ? t[0] : 0)));
    return left;
}

static quad local_light(const world *w, int what, const quad p[3], const quad n[3], const quad v[3], int c)
{
    quad l[3] = { w->position[0] - p[0], w->position[1] - p[1], w->position[2] - p[2] };
    const quad distance = sqrtf128(dot(l, l));
    unit(l);
    const quad nl = dot(n, l), rv = 2 * nl * dot(n, v) - dot(l, v);
    if (nl <= 0)
        return 0;
    const quad strength = w->intensity[0] / (1 + (quad)0.0625 * distance * distance) * reach(w, p, l, distance, c);
    const quad shine = what == BALL && rv > 0 ? w->specular[c] * powf128(rv, w->shininess[0]) : 0;
    return strength * ((what == BALL ? w->diffuse[c] : what == OTHER ? (quad)0.5 : (quad)0.75) * nl + shine);
}

static quad trace(const world *w, const quad o[3], const quad d[3], bool inside, int depth, int c);

/// Returns the light that the ball reflects and transmits at p. n faces the ray.
static quad send_on(const world *w, const quad p[3], const quad n[3], const quad d[3], bool inside, int depth, int c)
{
    const bool glass = w->stuff == GLASS || w->stuff == PANE, fresnel = w->stuff == GLASS || w->stuff == VARNISH;
    const quad cosine = -dot(n, d), ratio = inside ? w->ior[0] : 1 / w->ior[0];
    const quad k2 = 1 - ratio * ratio * (1 - cosine * cosine), s = sqrtf128(k2 > 0 ? k2 : 0);
    const quad p1 = (ratio * cosine - s) / (ratio * cosine + s), p2 = (cosine - ratio * s) / (cosine + ratio * s);
    const quad reflected = k2 > 0 ? (p1 * p1 + p2 * p2) / 2 : 1;
    const bool total = glass && k2 <= 0;
    quad up[3], on[3], mirror = w->mirror[c] * (fresnel ? reflected : 1);
    for (int i = 0; i < 3; i++) {
        up[i] = d[i] + 2 * cosine * n[i];
        on[i] = ratio * d[i] + (ratio * cosine - s) * n[i];
    }
    if (total)
        mirror += fresnel || w->mirror[c] > 1 ? 0 : 1 - w->mirror[c];
    quad light = mirror * trace(w, p, up, inside, depth + 1, c);
    if (glass && !total)
        light += w->transmission[c] * (fresnel ? 1 - reflected : 1) * trace(w, p, on, !inside, depth + 1, c);
    return light;
}

/// Returns the light in channel c along a ray from o.
static quad trace(const world *w, const quad o[3], const quad d[3], bool inside, int depth, int c)
{
    quad far, p[3], n[3] = { w->normal[0], w->normal[1], w->normal[2] }, v[3], up[3], light;
    const int what = nearest(w, o, d, &far);
    if (what == NOTHING)
        return inside && w->absorbs ? 0 : w->background[c];
    unit(n);
    for (int i = 0; i < 3; i++) {
        p[i] = o[i] + far * d[i];
        v[i] = -d[i];
        n[i] = what == FLOOR ? n[i] : what == BALL ? (p[i] - w->ball[i]) / w->radius[0] : p[i] - w->other[i];
    }
    const quad side = dot(n, v) < 0 ? -1 : 1;
    for (int i = 0; i < 3; i++) {
        n[i] *= side;
        up[i] = d[i] + 2 * dot(n, v) * n[i];
    }
    light = local_light(w, what, p, n, v, c);
    if (depth < DEPTH && what == FLOOR)
        light += w->floor_mirror[c] * trace(w, p, up, inside, depth + 1, c);
    if (depth < DEPTH && what == BALL)
        light += send_on(w, p, n, d, inside, depth, c);
    return light * (inside && w->absorbs ? expf128(-w->absorption[c] * far) : 1);
}

static quad color_of(const world *w, int x, int y, int c)
{
    quad forward[3], right[3], up[3], d[3];
    for (int i = 0; i < 3; i++)
        forward[i] = w->at[i] - w->eye[i];
    unit(forward);
    right[0] = -forward[2], right[1] = 0, right[2] = forward[0]; // perpendicular to the world's y axis
    unit(right);
    for (int i = 0; i < 3; i++)
        up[i] = right[(i + 1) % 3] * forward[(i + 2) % 3] - right[(i + 2) % 3] * forward[(i + 1) % 3];
    const quad half = tanf128((quad)0.35), across = ((x + (quad)0.5) * 2 / WIDTH - 1) * WIDTH / HEIGHT;
    for (int i = 0; i < 3; i++)
        d[i] = forward[i] + half * (across * right[i] + (1 - (y + (quad)0.5) * 2 / HEIGHT) * up[i]);
    unit(d);
    return trace(w, w->eye, d, false, 0, c);
}

// ---- The engine ---------------------------------------------------------------------------------------------------

typedef struct made {
    glint_scene *scene;
    glint_material *ball, *other, *floor;
    glint_light *light;
    glint_shape *shapes[3];
} made;

static glint_material *make_material(const glint_material_desc *desc)
{
    glint_material *material;
    glint_error error;
    must(glint_material_create(desc, &material, &error), &error);
    return material;
}

static void make_materials(const world *w, made *m)
{
    glint_material_desc matt = glint_material_desc_default(), d = matt;
    matt.model = GLINT_MODEL_LAMBERT;
    matt.has_ambient = d.has_ambient = true;
    for (int c = 0; c < 3; c++) {
        matt.ambient[c] = d.ambient[c] = 0;
        matt.diffuse[c] = 0.5;
    }
    m->other = make_material(&matt);
    matt.has_mirror = d.has_mirror = d.has_specular = true;
    put(matt.mirror, w->floor_mirror, 3);
    for (int c = 0; c < 3; c++)
        matt.diffuse[c] = 0.75;
    m->floor = make_material(&matt);
    put(d.diffuse, w->diffuse, 3);
    put(d.specular, w->specular, 3);
    put(&d.shininess, w->shininess, 1);
    put(d.mirror, w->mirror, 3);
    put(&d.ior, w->ior, 1);
    d.fresnel = w->stuff == GLASS || w->stuff == VARNISH;
    if (w->stuff == GLASS || w->stuff == PANE)
        put(d.transmission, w->transmission, 3);
    if (w->absorbs)
        put(d.absorption, w->absorption, 3);
    m->ball = make_material(&d);
}

static made make_scene(const world *w)
{
    made m = { .scene = scene_new() };
    glint_light_desc lamp = glint_light_desc_default(GLINT_LIGHT_POINT);
    glint_camera_desc camera = glint_camera_desc_default();
    glint_error error;
    hard_sphere ball, other = { .r = 1 };
    hard_plane floor;
    double background[3];
    make_materials(w, &m);
    put(ball.c, w->ball, 3);
    put(&ball.r, w->radius, 1);
    put(other.c, w->other, 3);
    put(floor.p, w->point, 3);
    put(floor.n, w->normal, 3);
    put(camera.eye, w->eye, 3);
    put(camera.at, w->at, 3);
    camera.fov_y_rad = 0.7;
    put(background, w->background, 3);
    scene_light_up(m.scene, 0, background);
    scene_camera(m.scene, &camera);
    m.shapes[0] = scene_sphere(m.scene, &ball, m.ball);
    m.shapes[1] = scene_sphere(m.scene, &other, m.other);
    m.shapes[2] = scene_plane(m.scene, &floor, m.floor);
    put(lamp.position, w->position, 3);
    put(&lamp.intensity, w->intensity, 1);
    lamp.attenuation[2] = 0.0625;
    lamp.shadows = w->shadows;
    must(glint_light_create(&lamp, &m.light, &error), &error);
    must(glint_scene_add_light(m.scene, m.light, &error), &error);
    return m;
}

static void unmake_scene(made *m)
{
    glint_scene_release(m->scene);
    glint_light_release(m->light);
    glint_material_release(m->ball);
    glint_material_release(m->other);
    glint_material_release(m->floor);
}

/// Returns whether the picture depends on the number and has a derivative with respect to it.
static bool is_read(const world *w, const number *n)
{
    const bool glass = w->stuff == GLASS || w->stuff == PANE, absorbed_shadows = w->absorbs && w->shadows && glass;
    const bool moves = n->offset >= offsetof(world, ball) || !strcmp(n->field, "position");
    if (!strcmp(n->field, "transmission"))
        return glass;
    if (!strcmp(n->field, "absorption"))
        return glass && w->absorbs && !absorbed_shadows;
    if (!strcmp(n->field, "ior"))
        return w->stuff != MIRROR && !absorbed_shadows;
    return !(moves && absorbed_shadows);
}

// ---- The comparison -----------------------------------------------------------------------------------------------

/// Computes the picture's derivative along `slope` from the formulas.
static void true_slopes(const world *w, const number *n, const double slope[3], double (*out)[3])
{
    world more = *w, less = *w;
    for (int c = 0; c < 3; c++) {
        ((quad *)((char *)&more + n->offset))[c] += (quad)STEP * slope[c];
        ((quad *)((char *)&less + n->offset))[c] -= (quad)STEP * slope[c];
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 0; c < 3; c++)
            out[i][c] = (double)((color_of(&more, i % WIDTH, i / WIDTH, c) - color_of(&less, i % WIDTH, i / WIDTH, c)) /
                                 (2 * (quad)STEP));
}

static void compare(const world *w, const number *n, const made *m)
{
    static double want[WIDTH * HEIGHT][3];
    double slope[3] = { 0 }, most;
    glint_render_desc desc = glint_render_desc_default();
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.max_depth = DEPTH;
    for (int c = 0; c < n->components; c++)
        slope[c] = uniform(-1, 1);
    glint_slope s = { .field = n->field, .slope = { slope[0], slope[1], slope[2] } };
    s.material = !strcmp(n->object, "ball's") ? m->ball : !strcmp(n->object, "floor's") ? m->floor : NULL;
    s.light = !strcmp(n->object, "light") ? m->light : NULL;
    s.shape = !strcmp(n->object, "ball")    ? m->shapes[0]
              : !strcmp(n->object, "other") ? m->shapes[1]
              : !strcmp(n->object, "floor") ? m->shapes[2]
                                            : NULL;
    s.camera = !strcmp(n->object, "camera") ? glint_scene_get(m->scene)->camera : NULL;
    const glint_derivative derivative = { "number", &s, 1 };
    glint_image *image = slope_picture(m->scene, desc, &derivative);
    true_slopes(w, n, slope, want);
    const double worst = slope_distance(image, WIDTH, HEIGHT, want, &most);
    hard_check(most > 0 && worst <= 1, "%s %s, stuff %d, shadows %d: %.2f of the bound, steepest pixel %g", n->object,
               n->field, (int)w->stuff, (int)w->shadows, worst, most);
    if (hard_table)
        printf("| %s %s | %d | %d | %.3g | %.2f |\n", n->object, n->field, (int)w->stuff, (int)w->shadows, most, worst);
    glint_image_release(image);
}

static world random_world(int turn)
{
    world w = { .stuff = (stuff)(turn % STUFFS), .shadows = turn / STUFFS % 2, .absorbs = turn % 3 != 0 };
    w.absorbs = w.absorbs && (w.stuff == GLASS || w.stuff == PANE);
    fill(w.diffuse, 0.1, 0.4);
    fill(w.specular, 0.2, 0.6);
    fill(w.shininess, 2, 30);
    fill(w.mirror, 0.3, 0.8);
    fill(w.transmission, 0.4, 0.9);
    fill(w.ior, 1.2, 1.8);
    fill(w.absorption, 0.1, 0.5);
    fill(w.floor_mirror, 0.2, 0.5);
    fill(w.position, 2.5, 5);
    fill(w.intensity, 0.5, 2);
    fill(w.background, 0.1, 0.6);
    fill(w.ball, -0.2, 0.2);
    fill(w.radius, 1, 1.2);
    fill(w.other, -0.2, 0.2);
    fill(w.point, -1.5, -1.3);
    fill(w.normal, -0.1, 0.1);
    fill(w.eye, 0.5, 1.5);
    fill(w.at, -0.2, 0.2);
    w.ball[0] -= (quad)0.7;
    w.other[0] += (quad)1.4;
    w.other[2] -= (quad)1.5;
    w.normal[1] += 1;
    w.eye[2] += 7;
    for (int c = 0; c < 3; c++) // rounds the numbers as for the engine
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
            ((quad *)((char *)&w + numbers[i].offset))[c] = (double)((quad *)((char *)&w + numbers[i].offset))[c];
    for (int c = 0; c < 3; c++)
        w.specular[c] = (double)w.specular[c];
    return w;
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_test("D2", "derivatives of what mirrors and glass show");
    if (hard_table)
        printf("| field | stuff | shadows | steepest pixel | error / bound |\n| --- | --- | --- | --- | --- |\n");
    for (int turn = 0; turn < 3 * STUFFS; turn += (int)case_step()) {
        const world w = random_world(turn);
        made m = make_scene(&w);
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
            if (is_read(&w, &numbers[i]))
                compare(&w, &numbers[i], &m);
        unmake_scene(&m);
    }
    return hard_end();
}
