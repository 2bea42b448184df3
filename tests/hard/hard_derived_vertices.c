/// Derivatives of flat and Gouraud shaded meshes against central differences of the formulas in 113 bits. Light is
/// computed once per face or vertex and interpolated at each sample, whose position moves with the eye.
#include "engine/glint_programs.h"
#include "tests/engine/cases/step.h"
#include "tests/hard/oracle/slopes.h"

#include <string.h>

#define WIDTH 40
#define HEIGHT 30
#define CORNERS 4
#define FACES 2

static const uint32_t faces[FACES][3] = { { 0, 1, 2 }, { 0, 2, 3 } };

/// A folded sheet in front of a background, under one light.
typedef struct world {
    quad corner[CORNERS][3], normal[CORNERS][3];
    quad eye[3], at[3], height[3], position[3], intensity[3], attenuation[3];
    quad diffuse[3], specular[3], shininess[3], ambient[3], background[3];
    bool flat, orthographic, fades;
} world;

static const number numbers[] = {
    NUMBER("camera", "eye", eye, 3),
    NUMBER("camera", "at", at, 3),
    NUMBER("camera", "height", height, 1),
    NUMBER("light", "position", position, 3),
    NUMBER("light", "intensity", intensity, 1),
    NUMBER("light", "attenuation", attenuation, 3),
    NUMBER("material", "diffuse", diffuse, 3),
    NUMBER("material", "specular", specular, 3),
    NUMBER("material", "shininess", shininess, 1),
    NUMBER("scene", "ambient", ambient, 3),
    NUMBER("scene", "background", background, 3),
};

// ---- The formulas, from their definitions -------------------------------------------------------------------------

static void look_of(const world *w, quad forward[3])
{
    for (int c = 0; c < 3; c++)
        forward[c] = w->at[c] - w->eye[c];
    unit(forward);
}

static void ray_of(const world *w, int x, int y, quad o[3], quad d[3])
{
    const quad above[3] = { 0, 1, 0 };
    quad forward[3], right[3], up[3];
    look_of(w, forward);
    cross(forward, above, right);
    unit(right);
    cross(right, forward, up);
    const quad half = w->orthographic ? w->height[0] / 2 : tanf128((quad)0.35);
    const quad across = half * ((x + (quad)0.5) * 2 / WIDTH - 1) * WIDTH / HEIGHT, over = half * (1 - (y + (quad)0.5) * 2 / HEIGHT);
    for (int c = 0; c < 3; c++) {
        const quad place = across * right[c] + over * up[c];
        o[c] = w->eye[c] + (w->orthographic ? place : 0);
        d[c] = forward[c] + (w->orthographic ? 0 : place);
    }
    unit(d);
}

/// Intersects a ray with a face. `share` gets the barycentric weights, *far the distance. Returns false for a miss.
static bool meet(const world *w, int face, const quad o[3], const quad d[3], quad share[3], quad *far)
{
    const quad *a = w->corner[faces[face][0]];
    quad f[3], g[3], s[3], p[3], q[3];
    for (int c = 0; c < 3; c++) {
        f[c] = w->corner[faces[face][1]][c] - a[c];
        g[c] = w->corner[faces[face][2]][c] - a[c];
        s[c] = o[c] - a[c];
    }
    cross(d, g, p);
    cross(s, f, q);
    const quad det = dot(f, p);
    share[1] = dot(s, p) / det;
    share[2] = dot(d, q) / det;
    share[0] = 1 - share[1] - share[2];
    *far = dot(g, q) / det;
    return share[0] > 0 && share[1] > 0 && share[2] > 0;
}

/// Computes Phong's light at a point, as seen from the eye.
static void light_of(const world *w, const quad p[3], const quad normal[3], quad out[3])
{
    quad l[3], v[3], n[3] = { normal[0], normal[1], normal[2] }, forward[3];
    look_of(w, forward);
    for (int c = 0; c < 3; c++) {
        l[c] = w->position[c] - p[c];
        v[c] = w->orthographic ? -forward[c] : w->eye[c] - p[c];
    }
    const quad distance = sqrtf128(dot(l, l));
    unit(l);
    unit(v);
    unit(n);
    const quad nl = dot(n, l), rv = 2 * nl * dot(n, v) - dot(l, v);
    const quad strength = w->intensity[0] / (w->attenuation[0] + w->attenuation[1] * distance + w->attenuation[2] * distance * distance);
    for (int c = 0; c < 3; c++)
        out[c] = nl > 0 ? strength * (w->diffuse[c] * nl + (rv > 0 ? w->specular[c] * powf128(rv, w->shininess[0]) : 0)) : 0;
}

static void find_normal(const world *w, int face, quad out[3])
{
    quad f[3], g[3];
    for (int c = 0; c < 3; c++) {
        f[c] = w->corner[faces[face][1]][c] - w->corner[faces[face][0]][c];
        g[c] = w->corner[faces[face][2]][c] - w->corner[faces[face][0]][c];
    }
    cross(f, g, out);
}

static void color_of(const world *w, int x, int y, quad out[3])
{
    quad o[3], d[3], share[3], far = 0, middle[3], normal[3], corner[3][3];
    int face = 0;
    ray_of(w, x, y, o, d);
    while (face < FACES && !meet(w, face, o, d, share, &far))
        face++;
    memcpy(out, w->background, 3 * sizeof *out);
    if (face == FACES)
        return;
    find_normal(w, face, normal);
    for (int c = 0; c < 3; c++)
        middle[c] = (w->corner[faces[face][0]][c] + w->corner[faces[face][1]][c] + w->corner[faces[face][2]][c]) / 3;
    for (int j = 0; j < 3; j++)
        light_of(w, w->flat ? middle : w->corner[faces[face][j]], w->flat ? normal : w->normal[faces[face][j]], corner[j]);
    const quad faded = w->fades ? (far - 2) / 18 : 0;
    for (int c = 0; c < 3; c++) {
        out[c] = w->diffuse[c] * w->ambient[c] + share[0] * corner[0][c] + share[1] * corner[1][c] + share[2] * corner[2][c];
        out[c] = (1 - faded) * out[c] + faded * (quad)0.25;
    }
}

// ---- The engine ---------------------------------------------------------------------------------------------------

static void add_mesh(const world *w, glint_scene *scene, glint_material *material)
{
    glint_mesh_desc d = glint_mesh_desc_default();
    const uint32_t sizes[FACES] = { 3, 3 };
    double vertices[CORNERS][3], normals[CORNERS][3];
    glint_shape *shape;
    glint_error error;
    for (int i = 0; i < CORNERS; i++) {
        put(vertices[i], w->corner[i], 3);
        put(normals[i], w->normal[i], 3);
    }
    d.vertices = vertices[0];
    d.vertex_count = CORNERS;
    d.corners = faces[0];
    d.face_sizes = sizes;
    d.face_count = FACES;
    d.normals = w->flat ? NULL : normals[0];
    d.normal_count = w->flat ? 0 : CORNERS;
    d.has_shading = true;
    d.shading = w->flat ? GLINT_SHADING_FLAT : GLINT_SHADING_GOURAUD;
    d.material = material;
    must(glint_mesh_create(&d, &shape, &error), &error);
    must(glint_scene_add_shape(scene, shape, &error), &error);
    glint_shape_release(shape);
}

static glint_material *make_material(const world *w)
{
    glint_material_desc d = glint_material_desc_default();
    glint_material *material;
    glint_error error;
    d.has_specular = true;
    put(d.diffuse, w->diffuse, 3);
    put(d.specular, w->specular, 3);
    put(&d.shininess, w->shininess, 1);
    d.has_ambient = true;
    put(d.ambient, w->diffuse, 3);
    must(glint_material_create(&d, &material, &error), &error);
    return material;
}

static glint_scene *make_scene(const world *w, glint_material *material, glint_light **light)
{
    glint_scene *scene = scene_new();
    glint_camera_desc camera = glint_camera_desc_default();
    glint_light_desc lamp = glint_light_desc_default(GLINT_LIGHT_POINT);
    glint_error error;
    put(camera.eye, w->eye, 3);
    put(camera.at, w->at, 3);
    put(&camera.height, w->height, 1);
    camera.fov_y_rad = 0.7;
    camera.projection = w->orthographic ? GLINT_PROJECTION_ORTHOGRAPHIC : GLINT_PROJECTION_PERSPECTIVE;
    scene_camera(scene, &camera);
    glint_scene_desc d = *glint_scene_get(scene);
    d.struct_size = sizeof d;
    put(d.ambient, w->ambient, 3);
    put(d.background, w->background, 3);
    d.has_depth_cue = d.has_depth_cue_color = w->fades;
    d.depth_cue_color[0] = d.depth_cue_color[1] = d.depth_cue_color[2] = 0.25;
    d.depth_cue_near = 2;
    d.depth_cue_far = 20;
    must(glint_scene_set(scene, &d, &error), &error);
    add_mesh(w, scene, material);
    put(lamp.position, w->position, 3);
    put(&lamp.intensity, w->intensity, 1);
    put(lamp.attenuation, w->attenuation, 3);
    must(glint_light_create(&lamp, light, &error), &error);
    must(glint_scene_add_light(scene, *light, &error), &error);
    return scene;
}

// ---- The comparison -----------------------------------------------------------------------------------------------

/// Returns whether any pixel depends on the number.
/// A flat face depends on the camera only through its distance or its highlight.
static bool is_read(const world *w, const number *n)
{
    if (!strcmp(n->field, "height"))
        return w->orthographic && (!w->flat || w->fades);
    return strcmp(n->field, "at") != 0 || !w->flat || w->fades || w->orthographic;
}

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

static void compare(const world *w, const number *n, const glint_scene *scene, glint_material *material, glint_light *light)
{
    static double want[WIDTH * HEIGHT][3];
    double slope[3] = { 0 }, most;
    glint_render_desc desc = glint_render_desc_default();
    desc.width = WIDTH;
    desc.height = HEIGHT;
    for (int c = 0; c < n->components; c++)
        slope[c] = uniform(-1, 1);
    glint_slope s = { .field = n->field, .slope = { slope[0], slope[1], slope[2] } };
    s.light = !strcmp(n->object, "light") ? light : NULL;
    s.camera = !strcmp(n->object, "camera") ? glint_scene_get(scene)->camera : NULL;
    s.material = !strcmp(n->object, "material") ? material : NULL;
    glint_slope both[2] = { s, s };
    both[1].field = "ambient"; // both fields vary, because ambient equals diffuse
    const glint_derivative derivative = { "number", both, strcmp(n->field, "diffuse") == 0 ? 2 : 1 };
    glint_image *image = slope_picture(scene, desc, &derivative);
    true_slopes(w, n, slope, want);
    const double worst = slope_distance(image, WIDTH, HEIGHT, want, &most);
    hard_check(most > 0 && worst <= 1, "%s.%s, flat %d, orthographic %d: %.2f of the bound, steepest pixel %g", n->object, n->field,
               (int)w->flat, (int)w->orthographic, worst, most);
    if (hard_table)
        printf("| %s.%s | %d | %d | %.3g | %.2f |\n", n->object, n->field, (int)w->flat, (int)w->orthographic, most, worst);
    glint_image_release(image);
}

static world random_world(int turn)
{
    static const double place[CORNERS][3] = { { -2, -1.5, 0 }, { 2, -1.5, 0 }, { 2, 1.5, 0 }, { -2, 1.5, 0 } };
    world w = { .flat = turn % 2, .orthographic = turn / 2 % 2, .fades = turn / 4 % 2 };
    for (int i = 0; i < CORNERS; i++) {
        fill(w.corner[i], -0.3, 0.3);
        fill(w.normal[i], -0.3, 0.3);
        w.normal[i][2] += 1;
        for (int c = 0; c < 3; c++) {
            w.corner[i][c] = (double)(w.corner[i][c] + (quad)place[i][c]);
            w.normal[i][c] = (double)w.normal[i][c];
        }
    }
    fill(w.eye, -0.5, 0.5);
    fill(w.at, -0.2, 0.2);
    fill(w.height, 4, 5);
    fill(w.position, -2, 2);
    fill(w.intensity, 0.5, 2);
    fill(w.attenuation, 0.01, 0.3);
    fill(w.diffuse, 0.2, 0.9);
    fill(w.specular, 0.2, 0.9);
    fill(w.shininess, 2, 20);
    fill(w.ambient, 0.1, 0.4);
    fill(w.background, 0.1, 0.6);
    w.eye[2] += 7;
    w.position[2] += 4;
    for (int c = 0; c < 3; c++) // rounds the numbers as for the engine
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
            ((quad *)((char *)&w + numbers[i].offset))[c] = (double)((quad *)((char *)&w + numbers[i].offset))[c];
    return w;
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_test("D5", "derivatives of flat and Gouraud shaded meshes");
    if (hard_table)
        printf("| field | flat | orthographic | steepest pixel | error / bound |\n| --- | --- | --- | --- | --- |\n");
    for (int turn = 0; turn < 16; turn += (int)case_step()) {
        const world w = random_world(turn);
        glint_material *material = make_material(&w);
        glint_light *light;
        glint_scene *scene = make_scene(&w, material, &light);
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
            if (is_read(&w, &numbers[i]))
                compare(&w, &numbers[i], scene, material, light);
        glint_scene_release(scene);
        glint_light_release(light);
        glint_material_release(material);
    }
    return hard_end();
}
