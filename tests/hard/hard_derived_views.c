/// Derivatives with respect to the camera against central differences of the formulas in 113 bits: perspective and
/// orthographic cameras, with and without a lens, and depth cueing, from outside and from inside an absorbing medium.
#include "engine/glint_programs.h"
#include "tests/engine/cases/step.h"
#include "tests/hard/oracle/slopes.h"

#include "engine/base/sequence.h"

#include <string.h>

#define WIDTH 40
#define HEIGHT 30
#define PI_Q ((quad)0x1.921fb54442d18p+1 + (quad)0x1.1a62633145c07p-53) ///< exact to 106 bits

typedef enum look { PINHOLE, SQUARE, LENS, SQUARE_LENS, LOOKS } look;

/// A ball above a floor in front of a background; in some worlds inside an absorbing ball.
typedef struct world {
    quad eye[3], at[3], up[3], fov[3], height[3], aperture[3], focus[3], focus_point[3];
    quad ball[3], radius[3], point[3], position[3], diffuse[3], shininess[3], background[3], ambient[3], absorption[3];
    quad cue_color[3], cue_near[3], cue_far[3];
    look look;
    bool cue, own_color, veil, by_direction;
    int focused; ///< where the lens focuses: 0: on the point that the camera looks at; 1: at a distance; 2: on
        ///< another point
} world;

static const number numbers[] = {
    NUMBER("camera", "eye", eye, 3),
    NUMBER("camera", "at", at, 3),
    NUMBER("camera", "direction", at, 3),
    NUMBER("camera", "up", up, 3),
    NUMBER("camera", "fov_y_rad", fov, 1),
    NUMBER("camera", "height", height, 1),
    NUMBER("camera", "aperture", aperture, 1),
    NUMBER("camera", "focus", focus, 1),
    NUMBER("camera", "focus_point", focus_point, 3),
    NUMBER("ball", "center", ball, 3),
    NUMBER("ball", "radius", radius, 1),
    NUMBER("floor", "point", point, 3),
    NUMBER("light", "position", position, 3),
    NUMBER("material", "diffuse", diffuse, 3),
    NUMBER("material", "shininess", shininess, 1),
    NUMBER("veil", "absorption", absorption, 3),
    NUMBER("scene", "background", background, 3),
    NUMBER("scene", "ambient", ambient, 3),
    NUMBER("scene", "depth_cue_color", cue_color, 3),
    NUMBER("scene", "depth_cue_near", cue_near, 1),
    NUMBER("scene", "depth_cue_far", cue_far, 1),
};

// ---- The formulas, from their definitions -------------------------------------------------------------------------

/// Maps a pixel's sample to a round lens of radius 1, by the formula of engine/render/plan/lens.c.
static void lens_point(int x, int y, quad out[2])
{
    double square[2];
    glint_sequence_scrambled((uint32_t)(x % 4 + y % 4 * 4), glint_sequence_mix(0, 0x6c656e73), square);
    const quad a = 2 * (quad)square[0] - 1, b = 2 * (quad)square[1] - 1;
    const bool across = (a < 0 ? -a : a) > (b < 0 ? -b : b);
    const quad radius = across ? a : b, angle = across ? PI_Q / 4 * (b / a) : PI_Q / 2 - PI_Q / 4 * (a / b);
    out[0] = radius * cosf128(angle);
    out[1] = radius * sinf128(angle);
}

static quad focus_of(const world *w, const quad forward[3])
{
    quad way[3];
    for (int c = 0; c < 3; c++)
        way[c] = (w->focused == 2 ? w->focus_point[c] : w->at[c]) - w->eye[c];
    return w->focused == 1 ? w->focus[0] : dot(way, forward);
}

/// Computes the ray through a pixel's centre, from o along the unit vector d.
static void ray_of(const world *w, int x, int y, quad o[3], quad d[3])
{
    quad forward[3], right[3], up[3], lens[2] = { 0 };
    const bool parallel = w->look == SQUARE || w->look == SQUARE_LENS;
    for (int c = 0; c < 3; c++)
        forward[c] = w->by_direction ? w->at[c] : w->at[c] - w->eye[c];
    unit(forward);
    cross(forward, w->up, right);
    unit(right);
    cross(right, forward, up);
    if (w->look == LENS || w->look == SQUARE_LENS)
        lens_point(x, y, lens);
    const quad half = parallel ? w->height[0] / 2 : tanf128(w->fov[0] / 2), focus = focus_of(w, forward);
    const quad across = half * ((x + (quad)0.5) * 2 / WIDTH - 1) * WIDTH / HEIGHT, over = half * (1 - (y + (quad)0.5) * 2 / HEIGHT);
    for (int c = 0; c < 3; c++) {
        const quad place = across * right[c] + over * up[c], shift = w->aperture[0] * (lens[0] * right[c] + lens[1] * up[c]);
        o[c] = w->eye[c] + (parallel ? place : 0) + shift;
        d[c] = forward[c] + (parallel ? 0 : place) - shift / focus;
    }
    unit(d);
}

static quad meet_ball(const world *w, const quad o[3], const quad d[3])
{
    quad f[3];
    for (int c = 0; c < 3; c++)
        f[c] = o[c] - w->ball[c];
    const quad b = dot(f, d), disc = b * b - (dot(f, f) - w->radius[0] * w->radius[0]);
    return disc < 0 ? -1 : -b - sqrtf128(disc);
}

/// Computes light by Phong's formula; the floor is matt.
static void light_of(const world *w, const quad p[3], const quad n[3], const quad d[3], bool on_ball, quad out[3])
{
    quad l[3], distance;
    for (int c = 0; c < 3; c++)
        l[c] = w->position[c] - p[c];
    distance = sqrtf128(dot(l, l));
    unit(l);
    const quad nl = dot(n, l), rv = -2 * nl * dot(n, d) + dot(l, d), strength = 1 / (1 + (quad)0.0625 * distance * distance);
    for (int c = 0; c < 3; c++)
        out[c] = w->diffuse[c] * w->ambient[c];
    for (int c = 0; c < 3 && nl > 0; c++)
        out[c] += strength * (w->diffuse[c] * nl + (on_ball && rv > 0 ? powf128(rv, w->shininess[0]) / 2 : 0));
}

static void color_of(const world *w, int x, int y, quad out[3])
{
    quad o[3], d[3], p[3], n[3] = { 0, 1, 0 };
    ray_of(w, x, y, o, d);
    const quad ball = meet_ball(w, o, d), floor = (w->point[1] - o[1]) / d[1];
    const bool on_ball = ball > 0 && !(floor > 0 && floor < ball);
    const quad way = on_ball ? ball : floor, share = (way - w->cue_near[0]) / (w->cue_far[0] - w->cue_near[0]);
    for (int c = 0; c < 3; c++) // the far side of the absorbing ball has faded completely
        out[c] = w->veil && w->cue && w->own_color ? w->cue_color[c] : w->veil && !w->cue ? 0 : w->background[c];
    if (!(way > 0))
        return;
    for (int c = 0; c < 3; c++) {
        p[c] = o[c] + way * d[c];
        n[c] = on_ball ? (p[c] - w->ball[c]) / w->radius[0] : n[c];
    }
    light_of(w, p, n, d, on_ball, out);
    for (int c = 0; c < 3; c++) {
        const quad faded = !w->cue || share < 0 ? 0 : share < 1 ? share : 1;
        const quad left = w->veil ? expf128(-w->absorption[c] * way) : 1;
        out[c] = (1 - faded) * left * out[c] + faded * (w->own_color ? w->cue_color[c] : w->background[c]);
    }
}

// ---- The engine ---------------------------------------------------------------------------------------------------

typedef struct made {
    glint_scene *scene;
    glint_material *matt, *material, *glass;
    glint_light *light;
    glint_shape *ball, *floor;
} made;

static void set_camera(const world *w, glint_scene *scene)
{
    glint_camera_desc d = glint_camera_desc_default();
    put(d.eye, w->eye, 3);
    put(w->by_direction ? d.direction : d.at, w->at, 3);
    d.has_direction = w->by_direction;
    put(d.up, w->up, 3);
    put(&d.fov_y_rad, w->fov, 1);
    put(&d.height, w->height, 1);
    d.projection = w->look == SQUARE || w->look == SQUARE_LENS ? GLINT_PROJECTION_ORTHOGRAPHIC : GLINT_PROJECTION_PERSPECTIVE;
    if (w->look == LENS || w->look == SQUARE_LENS)
        put(&d.aperture, w->aperture, 1);
    if (w->focused == 1)
        put(&d.focus, w->focus, 1);
    d.has_focus_point = w->focused == 2;
    put(d.focus_point, w->focus_point, 3);
    scene_camera(scene, &d);
}

static void set_scene(const world *w, glint_scene *scene)
{
    glint_error error;
    glint_scene_desc d = *glint_scene_get(scene);
    d.struct_size = sizeof d;
    put(d.ambient, w->ambient, 3);
    put(d.background, w->background, 3);
    d.has_depth_cue = w->cue;
    d.has_depth_cue_color = w->own_color;
    put(d.depth_cue_color, w->cue_color, 3);
    put(&d.depth_cue_near, w->cue_near, 1);
    put(&d.depth_cue_far, w->cue_far, 1);
    must(glint_scene_set(scene, &d, &error), &error);
}

static glint_material *make_material(const glint_material_desc *desc)
{
    glint_material *material;
    glint_error error;
    must(glint_material_create(desc, &material, &error), &error);
    return material;
}

static void make_materials(const world *w, made *m)
{
    glint_material_desc d = glint_material_desc_default();
    put(d.diffuse, w->diffuse, 3);
    m->matt = make_material(&d);
    d.has_specular = true;
    for (int c = 0; c < 3; c++)
        d.specular[c] = 0.5;
    put(&d.shininess, w->shininess, 1);
    m->material = make_material(&d);
    d = glint_material_desc_default();
    for (int c = 0; c < 3; c++)
        d.transmission[c] = 1;
    d.ior = 1;
    put(d.absorption, w->absorption, 3);
    m->glass = make_material(&d);
}

static made make_scene(const world *w)
{
    made m = { .scene = scene_new() };
    glint_light_desc lamp = glint_light_desc_default(GLINT_LIGHT_POINT);
    glint_error error;
    hard_sphere ball, around = { .r = 1e5 };
    hard_plane floor = { .n = { 0, 1, 0 } };
    make_materials(w, &m);
    put(ball.c, w->ball, 3);
    put(&ball.r, w->radius, 1);
    put(floor.p, w->point, 3);
    set_camera(w, m.scene);
    set_scene(w, m.scene);
    m.ball = scene_sphere(m.scene, &ball, m.material);
    m.floor = scene_plane(m.scene, &floor, m.matt);
    if (w->veil)
        scene_sphere(m.scene, &around, m.glass);
    put(lamp.position, w->position, 3);
    lamp.attenuation[2] = 0.0625;
    lamp.shadows = false;
    must(glint_light_create(&lamp, &m.light, &error), &error);
    must(glint_scene_add_light(m.scene, m.light, &error), &error);
    return m;
}

static void unmake_scene(made *m)
{
    glint_scene_release(m->scene);
    glint_light_release(m->light);
    glint_material_release(m->matt);
    glint_material_release(m->material);
    glint_material_release(m->glass);
}

/// Returns whether the picture depends on the number.
static bool is_read(const world *w, const number *n)
{
    const bool parallel = w->look == SQUARE || w->look == SQUARE_LENS, lens = w->look >= LENS;
    const char *f = n->field;
    if (!strcmp(f, "at") || !strcmp(f, "direction"))
        return w->by_direction == !strcmp(f, "direction");
    if (!strcmp(f, "fov_y_rad") || !strcmp(f, "height"))
        return parallel == !strcmp(f, "height");
    if (!strcmp(f, "aperture"))
        return lens;
    if (!strcmp(f, "focus") || !strcmp(f, "focus_point"))
        return lens && w->focused == (!strcmp(f, "focus") ? 1 : 2);
    if (!strcmp(f, "absorption"))
        return w->veil;
    if (!strcmp(f, "background"))
        return (!w->veil && !parallel) || (w->cue && !w->own_color); // orthographic cameras see the floor everywhere
    if (!strcmp(f, "depth_cue_color"))
        return w->cue && w->own_color;
    return strncmp(f, "depth_cue", 9) != 0 || w->cue;
}

// ---- The comparison -----------------------------------------------------------------------------------------------

static void true_slopes(const world *w, const number *n, const double slope[3], double (*out)[3])
{
    world more = *w, less = *w;
    for (int c = 0; c < 3; c++) {
        ((quad *)((char *)&more + n->offset))[c] += (quad)STEP * slope[c];
        ((quad *)((char *)&less + n->offset))[c] -= (quad)STEP * slope[c];
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        quad high[3], low[3];
        color_of(&more, i % WIDTH, i / WIDTH, high);
        color_of(&less, i % WIDTH, i / WIDTH, low);
        for (int c = 0; c < 3; c++)
            out[i][c] = (double)((high[c] - low[c]) / (2 * (quad)STEP));
    }
}

static void compare(const world *w, const number *n, const made *m)
{
    static double want[WIDTH * HEIGHT][3];
    double slope[3] = { 0 }, most;
    glint_render_desc desc = glint_render_desc_default();
    desc.width = WIDTH;
    desc.height = HEIGHT;
    for (int c = 0; c < n->components; c++)
        slope[c] = uniform(-1, 1);
    glint_slope s = { .field = n->field, .slope = { slope[0], slope[1], slope[2] } };
    glint_slope both[2];
    s.light = !strcmp(n->object, "light") ? m->light : NULL;
    s.shape = !strcmp(n->object, "ball") ? m->ball : !strcmp(n->object, "floor") ? m->floor : NULL;
    s.camera = !strcmp(n->object, "camera") ? glint_scene_get(m->scene)->camera : NULL;
    s.material = !strcmp(n->object, "veil") ? m->glass : !strcmp(n->object, "material") ? m->material : NULL;
    both[0] = both[1] = s;
    both[1].material = m->matt;
    const glint_derivative derivative = { "number", both, s.material == m->material ? 2 : 1 };
    glint_image *image = slope_picture(m->scene, desc, &derivative);
    true_slopes(w, n, slope, want);
    const double worst = slope_distance(image, WIDTH, HEIGHT, want, &most);
    hard_check(most > 0 && worst <= 1, "%s.%s, look %d, cue %d, veil %d: %.2f of the bound, steepest pixel %g", n->object, n->field,
               (int)w->look, (int)w->cue, (int)w->veil, worst, most);
    if (hard_table)
        printf("| %s.%s | %d | %d | %d | %.3g | %.2f |\n", n->object, n->field, (int)w->look, (int)w->cue, (int)w->veil, most, worst);
    glint_image_release(image);
}

static world random_world(int turn)
{
    world w = { .look = (look)(turn % LOOKS), .cue = turn / LOOKS % 2, .own_color = turn / 8 % 2, .veil = turn / 6 % 2 };
    // only the eye of a perspective camera can be inside a medium
    w.veil = w.veil && w.look != SQUARE && w.look != SQUARE_LENS;
    w.focused = turn % 3;
    w.by_direction = turn % 5 == 0 && w.focused;
    fill(w.eye, 0.5, 1.5);
    fill(w.at, -0.2, 0.2);
    fill(w.up, -0.1, 0.1);
    fill(w.fov, 0.6, 0.8);
    fill(w.height, 4, 5);
    fill(w.aperture, 0.1, 0.4);
    fill(w.focus, 4, 9);
    fill(w.focus_point, -1, 1);
    fill(w.ball, -0.3, 0.3);
    fill(w.radius, 1, 1.3);
    fill(w.point, -1.5, -1.3);
    fill(w.position, 2.5, 5);
    fill(w.diffuse, 0.2, 0.9);
    fill(w.shininess, 2, 60);
    fill(w.background, 0.1, 0.6);
    fill(w.ambient, 0.1, 0.4);
    fill(w.absorption, 0.02, 0.2);
    fill(w.cue_color, 0.1, 0.9);
    fill(w.cue_near, 5, 7);
    fill(w.cue_far, 10, 20);
    w.up[1] += 1;
    w.eye[2] += 7;
    for (int c = 0; c < 3 && w.by_direction; c++)
        w.at[c] -= w.eye[c];
    for (int c = 0; c < 3; c++) // rounds the numbers as for the engine
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
            ((quad *)((char *)&w + numbers[i].offset))[c] = (double)((quad *)((char *)&w + numbers[i].offset))[c];
    return w;
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_test("D4", "derivatives by cameras, lenses and what light fades by");
    if (hard_table)
        printf("| field | look | cue | veil | steepest pixel | error / bound |\n| --- | --- | --- | --- | --- | --- |\n");
    for (int turn = 0; turn < 24; turn += (int)case_step()) {
        const world w = random_world(turn);
        made m = make_scene(&w);
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
            if (is_read(&w, &numbers[i]))
                compare(&w, &numbers[i], &m);
        unmake_scene(&m);
    }
    return hard_end();
}
