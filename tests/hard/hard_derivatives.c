/// Derivatives of pictures against central differences of the formulas in 113 bits: every differentiable field, every
/// model and kind of light, and shaders.
#include "tests/engine/cases/step.h"
#include "tests/hard/oracle/shaders.h"
#include "tests/hard/oracle/slopes.h"

#include <string.h>

#define WIDTH 48
#define HEIGHT 36
#define PI_Q ((quad)0x1.921fb54442d18p+1 + (quad)0x1.1a62633145c07p-53) ///< exact to 106 bits

/// How sphere and floor are described: directly, as parts of CSG shapes, or under a transform.
typedef enum dress { BARE, PARTS, TURNED, DRESSES } dress;

/// A sphere above a floor under one light: the differentiable parameters, each as three numbers, and the constants.
typedef struct world {
    quad diffuse[3], ambient[3], specular[3], shininess[3], roughness[3], f0[3];
    quad color[3], intensity[3], light_ambient[3], light_diffuse[3], light_specular[3], attenuation[3], position[3],
        direction[3], inner[3], outer[3], exponent[3];
    quad scene_ambient[3], background[3];
    quad ball[3], radius[3], point[3], normal[3], eye[3], at[3], up[3], fov[3];
    glint_model model;
    bool beckmann, normalized, matched, own_terms; ///< own_terms: whether the light has separate diffuse and specular
        ///< colours
    bool shader; ///< whether a shader computes the model and multiplies the result by a wave
    glint_light_kind kind;
    dress dress;
} world;

static const number numbers[] = {
    NUMBER("material", "diffuse", diffuse, 3),
    NUMBER("material", "ambient", ambient, 3),
    NUMBER("material", "specular", specular, 3),
    NUMBER("material", "shininess", shininess, 1),
    NUMBER("material", "roughness", roughness, 1),
    NUMBER("material", "f0", f0, 3),
    NUMBER("light", "color", color, 3),
    NUMBER("light", "intensity", intensity, 1),
    NUMBER("light", "ambient", light_ambient, 3),
    NUMBER("light", "diffuse", light_diffuse, 3),
    NUMBER("light", "specular", light_specular, 3),
    NUMBER("light", "attenuation", attenuation, 3),
    NUMBER("light", "position", position, 3),
    NUMBER("light", "direction", direction, 3),
    NUMBER("light", "inner_rad", inner, 1),
    NUMBER("light", "outer_rad", outer, 1),
    NUMBER("light", "exponent", exponent, 1),
    NUMBER("scene", "ambient", scene_ambient, 3),
    NUMBER("scene", "background", background, 3),
    NUMBER("sphere", "center", ball, 3),
    NUMBER("sphere", "radius", radius, 1),
    NUMBER("plane", "point", point, 3),
    NUMBER("plane", "normal", normal, 3),
    NUMBER("camera", "eye", eye, 3),
    NUMBER("camera", "at", at, 3),
    NUMBER("camera", "up", up, 3),
    NUMBER("camera", "fov_y_rad", fov, 1),
};

// ---- The formulas, from their definitions -------------------------------------------------------------------------

/// Computes the direction of the ray through a pixel's centre.
static void ray_of(const world *w, int x, int y, quad d[3])
{
    quad forward[3], right[3], up[3];
    const quad half = tanf128(w->fov[0] / 2);
    for (int c = 0; c < 3; c++)
        forward[c] = w->at[c] - w->eye[c];
    unit(forward);
    cross(forward, w->up, right);
    unit(right);
    cross(right, forward, up);
    const quad across = ((x + (quad)0.5) * 2 / WIDTH - 1) * WIDTH / HEIGHT, down = 1 - (y + (quad)0.5) * 2 / HEIGHT;
    for (int c = 0; c < 3; c++)
        d[c] = forward[c] + half * (across * right[c] + down * up[c]);
    unit(d);
}

/// Returns the distance to the sphere along a unit direction; negative for a miss.
static quad meet_ball(const world *w, const quad o[3], const quad d[3])
{
    quad f[3];
    for (int c = 0; c < 3; c++)
        f[c] = o[c] - w->ball[c];
    const quad b = dot(f, d), disc = b * b - (dot(f, f) - w->radius[0] * w->radius[0]);
    return disc < 0 ? -1 : -b - sqrtf128(disc);
}

static quad smith_beckmann(quad alpha, quad x)
{
    const quad c = x / (alpha * sqrtf128(1 - x * x));
    return c < (quad)1.6 ? (1 - (quad)1.259 * c + (quad)0.396 * c * c) / ((quad)3.535 * c + (quad)2.181 * c * c) : 0;
}

/// Returns pi D G / (4 n.v), without the factor F.
static quad facets(const world *w, quad nh, quad nl, quad nv)
{
    const quad alpha = w->roughness[0] * w->roughness[0], aa = alpha * alpha, nh2 = nh * nh;
    if (w->beckmann) {
        const quad d = expf128((nh2 - 1) / (nh2 * aa)) / (PI_Q * aa * nh2 * nh2);
        return PI_Q * d / (4 * nv) / (1 + smith_beckmann(alpha, nl) + smith_beckmann(alpha, nv));
    }
    const quad below = nh2 * (aa - 1) + 1, d = aa / (PI_Q * below * below);
    const quad g = 2 * nl * nv / (nv * sqrtf128(aa + (1 - aa) * nl * nl) + nl * sqrtf128(aa + (1 - aa) * nv * nv));
    return PI_Q * d * g / (4 * nv);
}

static void specular_of(const world *w, const quad n[3], const quad l[3], const quad v[3], quad out[3])
{
    const quad nl = dot(n, l), nv = dot(n, v), rv = 2 * nl * nv - dot(l, v);
    quad h[3], s = w->shininess[0] * (w->matched ? 4 : 1), strength = 0;
    for (int c = 0; c < 3; c++)
        h[c] = l[c] + v[c];
    unit(h);
    if (w->model == GLINT_MODEL_PHONG)
        strength = rv > 0 ? powf128(rv, s) * (w->normalized ? (s + 2) / 2 * nl : 1) : 0;
    if (w->model == GLINT_MODEL_BLINN_PHONG)
        strength = powf128(dot(n, h), s) *
                   (w->normalized ? (s + 2) * (s + 4) / (8 * (exp2f128(-s / 2) + s)) * nl : 1);
    for (int c = 0; c < 3; c++)
        out[c] = w->specular[c] * strength;
    for (int c = 0; c < 3 && w->model == GLINT_MODEL_COOK_TORRANCE; c++)
        out[c] = w->specular[c] * facets(w, dot(n, h), nl, nv) *
                 (w->f0[c] + (1 - w->f0[c]) * powf128(1 - dot(v, h), 5));
}

/// Returns the factor that only shaders apply. It depends on the point in the shape's space, the point in the world,
/// and the light's distance.
static quad wave(const world *w, const quad p[3], quad distance)
{
    const quad own = w->dress == TURNED ? p[1] / 2 : p[0], far = w->kind == GLINT_LIGHT_DIRECTIONAL ? 0 : distance;
    return w->shader ? (quad)1.5 + sinf128(3 * own) / 4 + sinf128(p[2]) / 4 + far / 16 : 1;
}

static quad cone(const world *w, const quad l[3])
{
    quad axis[3] = { w->direction[0], w->direction[1], w->direction[2] };
    unit(axis);
    const quad c = -dot(axis, l), inner = cosf128(w->inner[0]), outer = cosf128(w->outer[0]);
    quad x = (c - outer) / (inner - outer);
    x = x < 0 ? 0 : x > 1 ? 1 : x;
    return c > 0 ? x * x * (3 - 2 * x) * powf128(c, w->exponent[0]) : 0;
}

/// Adds the light that reaches a point.
static void add_light(const world *w, const quad p[3], const quad n[3], const quad v[3], bool on_floor, quad out[3])
{
    quad l[3], strength = w->intensity[0], specular[3];
    for (int c = 0; c < 3; c++)
        l[c] = w->kind == GLINT_LIGHT_DIRECTIONAL ? -w->direction[c] : w->position[c] - p[c];
    const quad distance = sqrtf128(dot(l, l));
    unit(l);
    if (dot(n, l) <= 0 || (on_floor && meet_ball(w, p, l) > 0))
        return;
    if (w->kind != GLINT_LIGHT_DIRECTIONAL)
        strength /= w->attenuation[0] + w->attenuation[1] * distance + w->attenuation[2] * distance * distance;
    if (w->kind == GLINT_LIGHT_SPOT)
        strength *= cone(w, l);
    strength *= wave(w, p, distance);
    specular_of(w, n, l, v, specular);
    for (int c = 0; c < 3; c++)
        out[c] += strength * (w->diffuse[c] * dot(n, l) * (w->own_terms ? w->light_diffuse[c] : w->color[c]) +
                              specular[c] * (w->own_terms ? w->light_specular[c] : w->color[c]));
}

static void color_of(const world *w, int x, int y, quad out[3])
{
    quad d[3], p[3], n[3] = { w->normal[0], w->normal[1], w->normal[2] }, v[3], over[3];
    ray_of(w, x, y, d);
    unit(n);
    for (int c = 0; c < 3; c++)
        over[c] = w->point[c] - w->eye[c];
    const quad on_ball = meet_ball(w, w->eye, d), on_floor = dot(n, over) / dot(n, d);
    const bool is_ball = on_ball > 0 && !(on_floor > 0 && on_floor < on_ball);
    memcpy(out, w->background, 3 * sizeof *out);
    if (!is_ball && on_floor <= 0)
        return;
    for (int c = 0; c < 3; c++) {
        p[c] = w->eye[c] + (is_ball ? on_ball : on_floor) * d[c];
        v[c] = -d[c];
        n[c] = is_ball ? (p[c] - w->ball[c]) / w->radius[0] : n[c];
        out[c] = w->ambient[c] * (w->scene_ambient[c] + w->light_ambient[c] * w->intensity[0]);
    }
    add_light(w, p, n, v, !is_ball, out);
}

// ---- The engine ---------------------------------------------------------------------------------------------------

static glint_material *make_material(const world *w)
{
    glint_material_desc d = glint_material_desc_default();
    glint_material *material;
    glint_error error;
    d.model = w->model;
    d.distribution = w->beckmann ? GLINT_DISTRIBUTION_BECKMANN : GLINT_DISTRIBUTION_GGX;
    d.normalized = w->normalized;
    d.matched = w->matched;
    d.has_ambient = d.has_specular = d.has_f0 = true;
    put(d.diffuse, w->diffuse, 3);
    put(d.ambient, w->ambient, 3);
    put(d.specular, w->specular, 3);
    put(&d.shininess, w->shininess, 1);
    put(&d.roughness, w->roughness, 1);
    put(d.f0, w->f0, 3);
    d.program.shader = w->shader ? make_shader(w->model, w->kind == GLINT_LIGHT_DIRECTIONAL) : NULL;
    must(glint_material_create(&d, &material, &error), &error);
    glint_program_release(d.program.shader);
    return material;
}

static glint_light *make_light(const world *w)
{
    glint_light_desc d = glint_light_desc_default(w->kind);
    glint_light *light;
    glint_error error;
    d.has_diffuse = d.has_specular = w->own_terms;
    put(d.color, w->color, 3);
    put(&d.intensity, w->intensity, 1);
    put(d.ambient, w->light_ambient, 3);
    put(d.diffuse, w->light_diffuse, 3);
    put(d.specular, w->light_specular, 3);
    put(d.attenuation, w->attenuation, 3);
    put(d.position, w->position, 3);
    put(d.direction, w->direction, 3);
    put(&d.inner_rad, w->inner, 1);
    put(&d.outer_rad, w->outer, 1);
    put(&d.exponent, w->exponent, 1);
    must(glint_light_create(&d, &light, &error), &error);
    return light;
}

/// Transforms a direction from world space to a shape's space if the shape is rotated: world = size (-y, x, z).
static void undress(const world *w, double v[3], double size)
{
    const double x = v[0], y = v[1], z = v[2];
    if (w->dress != TURNED)
        return;
    v[0] = y / size;
    v[1] = -x / size;
    v[2] = z / size;
}

/// Puts the shape and an invisible distant sphere with another material into `whole`.
static void make_part(glint_shape *whole, glint_shape *shape)
{
    glint_shape_desc far = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    glint_shape *other;
    glint_error error;
    far.center[2] = 1000;
    far.radius = 0.1;
    must(glint_shape_create(&far, &other, &error), &error);
    must(glint_group_add(whole, shape, &error), &error);
    must(glint_group_add(whole, other, &error), &error);
    glint_shape_release(other);
}

/// Adds a shape whose description is in world space.
static glint_shape *add_shape(const world *w, glint_scene *scene, glint_shape_desc desc)
{
    const glint_transform turn = glint_transform_rotate_deg((const double[3]) { 0, 0, 1 }, 90),
                          grow = glint_transform_scale((const double[3]) { 2, 2, 2 });
    const glint_shape_desc together = glint_shape_desc_default(GLINT_SHAPE_UNION);
    glint_shape *shape, *whole;
    glint_error error;
    undress(w, desc.center, 2);
    undress(w, desc.point, 2);
    undress(w, desc.normal, 1);
    if (w->dress == TURNED) {
        desc.transform = glint_transform_product(&grow, &turn);
        desc.radius /= 2;
    }
    must(glint_shape_create(&desc, &shape, &error), &error);
    must(glint_shape_create(&together, &whole, &error), &error);
    if (w->dress == PARTS)
        make_part(whole, shape);
    must(glint_scene_add_shape(scene, w->dress == PARTS ? whole : shape, &error), &error);
    glint_shape_release(whole);
    glint_shape_release(shape);
    return shape;
}

static glint_scene *make_scene(const world *w, glint_material *material, glint_light *light, glint_shape *shapes[2])
{
    glint_scene *scene = scene_new();
    glint_camera_desc camera = glint_camera_desc_default();
    glint_error error;
    double background[3];
    glint_shape_desc sphere = glint_shape_desc_default(GLINT_SHAPE_SPHERE), floor = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    put(sphere.center, w->ball, 3);
    put(&sphere.radius, w->radius, 1);
    put(floor.point, w->point, 3);
    put(floor.normal, w->normal, 3);
    sphere.material = floor.material = material;
    put(camera.eye, w->eye, 3);
    put(camera.at, w->at, 3);
    put(camera.up, w->up, 3);
    put(&camera.fov_y_rad, w->fov, 1);
    put(background, w->background, 3);
    scene_light_up(scene, 0, background);
    scene_camera(scene, &camera);
    glint_scene_desc d = *glint_scene_get(scene);
    d.struct_size = sizeof d;
    put(d.ambient, w->scene_ambient, 3);
    must(glint_scene_set(scene, &d, &error), &error);
    shapes[0] = add_shape(w, scene, sphere);
    shapes[1] = add_shape(w, scene, floor);
    must(glint_scene_add_light(scene, light, &error), &error);
    return scene;
}

/// Returns whether the picture depends on the number.
static bool is_read(const world *w, const number *n)
{
    const bool power = w->model == GLINT_MODEL_PHONG || w->model == GLINT_MODEL_BLINN_PHONG;
    const bool directional = w->kind == GLINT_LIGHT_DIRECTIONAL, spot = w->kind == GLINT_LIGHT_SPOT;
    const bool own = !strcmp(n->object, "light") && (!strcmp(n->field, "diffuse") || !strcmp(n->field, "specular"));
    if (!strcmp(n->field, "shininess"))
        return power;
    if (!strcmp(n->field, "roughness") || !strcmp(n->field, "f0"))
        return w->model == GLINT_MODEL_COOK_TORRANCE;
    if (!strcmp(n->field, "specular") && w->model == GLINT_MODEL_LAMBERT)
        return false;
    if (own || !strcmp(n->field, "color"))
        return own == w->own_terms;
    if (!strcmp(n->field, "position") || !strcmp(n->field, "attenuation"))
        return !directional;
    if (!strcmp(n->field, "inner_rad") || !strcmp(n->field, "outer_rad") || !strcmp(n->field, "exponent"))
        return spot;
    // under a directional light, hits that move along their rays keep all their angles
    if (!strcmp(n->field, "point"))
        return !directional || w->shader;
    return strcmp(n->field, "direction") != 0 || directional || spot;
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
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        quad high[3], low[3];
        color_of(&more, i % WIDTH, i / WIDTH, high);
        color_of(&less, i % WIDTH, i / WIDTH, low);
        for (int c = 0; c < 3; c++)
            out[i][c] = (double)((high[c] - low[c]) / (2 * (quad)STEP));
    }
}

static void compare(const world *w, const number *n, const glint_scene *scene, glint_material *material,
                    glint_light *light, glint_shape *const shapes[2])
{
    static double want[WIDTH * HEIGHT][3];
    double slope[3] = { 0 }, most;
    glint_render_desc desc = glint_render_desc_default();
    desc.width = WIDTH;
    desc.height = HEIGHT;
    for (int c = 0; c < n->components; c++)
        slope[c] = uniform(-1, 1);
    glint_slope s = { .field = n->field, .slope = { slope[0], slope[1], slope[2] } };
    s.material = strcmp(n->object, "material") == 0 ? material : NULL;
    s.light = strcmp(n->object, "light") == 0 ? light : NULL;
    s.shape = strcmp(n->object, "sphere") == 0 ? shapes[0] : strcmp(n->object, "plane") == 0 ? shapes[1] : NULL;
    s.camera = strcmp(n->object, "camera") == 0 ? glint_scene_get(scene)->camera : NULL;
    if (s.shape && n->components == 3)
        undress(w, s.slope, strcmp(n->field, "normal") == 0 ? 1 : 2);
    else if (s.shape && w->dress == TURNED)
        s.slope[0] /= 2;
    const glint_derivative derivative = { "number", &s, 1 };
    glint_image *image = slope_picture(scene, desc, &derivative);
    true_slopes(w, n, slope, want);
    const double worst = slope_distance(image, WIDTH, HEIGHT, want, &most);
    hard_check(most > 0 && worst <= 1, "%s.%s, model %d, light %d, dress %d, shader %d: %.2f of the bound, steepest pixel %g",
               n->object, n->field, (int)w->model, (int)w->kind, (int)w->dress, w->shader, worst, most);
    if (hard_table)
        printf("| %s.%s | %d | %d | %.3g | %.2f |\n", n->object, n->field, (int)w->model, (int)w->kind, most, worst);
    glint_image_release(image);
}

static world random_world(int turn)
{
    world w = { .model = (glint_model)(turn % 4), .kind = (glint_light_kind)(turn / 4 % 3) };
    w.beckmann = turn % 8 == 7;
    w.normalized = turn / 4 % 2;
    w.matched = w.model == GLINT_MODEL_BLINN_PHONG && turn % 3 == 0;
    w.own_terms = turn % 5 == 0;
    w.shader = turn >= 24;
    if (w.shader) {
        w.model = turn % 2 ? GLINT_MODEL_PHONG : GLINT_MODEL_BLINN_PHONG;
        w.normalized = w.matched = w.own_terms = false;
    }
    w.dress = (dress)((turn / 2 + turn / 12) % DRESSES);
    fill(w.diffuse, 0.2, 0.9);
    fill(w.ambient, 0.1, 0.5);
    fill(w.specular, 0.2, 0.9);
    fill(w.shininess, 2, 60);
    fill(w.roughness, 0.2, 0.7);
    fill(w.f0, 0.1, 0.9);
    fill(w.color, 0.3, 1);
    fill(w.intensity, 0.5, 2);
    fill(w.light_ambient, 0, 0.2);
    fill(w.light_diffuse, 0.3, 1);
    fill(w.light_specular, 0.3, 1);
    fill(w.attenuation, 0.01, 0.3);
    fill(w.position, 2.5, 5);
    fill(w.direction, -1.2, -0.8);
    fill(w.inner, 0.1, 0.2);
    fill(w.outer, 0.4, 0.7);
    fill(w.exponent, 0.5, 4);
    fill(w.scene_ambient, 0.1, 0.4);
    fill(w.background, 0.1, 0.6);
    fill(w.ball, -0.3, 0.3);
    fill(w.radius, 1, 1.3);
    fill(w.point, -1.5, -1.3);
    fill(w.normal, turn % 4 ? -0.1 : 0, turn % 4 ? 0.1 : 0); // also tests axis-aligned normals
    fill(w.eye, 0.5, 1.5);
    fill(w.at, -0.2, 0.2);
    fill(w.up, -0.1, 0.1);
    fill(w.fov, 0.6, 0.8);
    w.normal[1] += 1;
    w.up[1] += 1;
    w.eye[2] += 7;
    for (int c = 0; c < 3; c++) { // rounds the numbers as for the engine
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
            ((quad *)((char *)&w + numbers[i].offset))[c] = (double)((quad *)((char *)&w + numbers[i].offset))[c];
    }
    return w;
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_test("D1", "every field that has a derivative, of each model and light, and of shaders");
    if (hard_table)
        printf("| field | model | light | steepest pixel | error / bound |\n| --- | --- | --- | --- | --- |\n");
    for (int turn = 0; turn < 36; turn += (int)case_step()) {
        const world w = random_world(turn);
        glint_material *material = make_material(&w);
        glint_light *light = make_light(&w);
        glint_shape *shapes[2];
        glint_scene *scene = make_scene(&w, material, light, shapes);
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
            if (is_read(&w, &numbers[i]))
                compare(&w, &numbers[i], scene, material, light, shapes);
        glint_scene_release(scene);
        glint_light_release(light);
        glint_material_release(material);
    }
    return hard_end();
}
