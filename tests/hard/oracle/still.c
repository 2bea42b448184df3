#include "tests/hard/oracle/still.h"
#include "tests/hard/oracle/quad.h"

#include <string.h>

#define REAL quad
#define T(name) name##_113
#define SQRT sqrtf128
#define POW powf128
#define TAN tanf128
#define EPSILON 1e-15
#include "tests/hard/oracle/textbook.h"

#define REAL double
#define T(name) name##_53
#define SQRT sqrt
#define POW pow
#define TAN tan
#define EPSILON 1e-9
#include "tests/hard/oracle/textbook.h"

#define REAL float
#define T(name) name##_24
#define SQRT sqrtf
#define POW powf
#define TAN tanf
#define EPSILON 1e-4
#include "tests/hard/oracle/textbook.h"

static still_paint random_paint(void)
{
    still_paint paint = { .specular = chance(0.5) ? 0 : uniform(0, 0.5), .shininess = log_uniform(1, 1e4) };
    for (int c = 0; c < 3; c++)
        paint.diffuse[c] = uniform(0.1, 0.8);
    return paint;
}

hard_still still_random(double scale, double away)
{
    hard_still s = { .name = "random", .fov_y_rad = uniform(0.3, 1.5), .ambient = 0.125, .count = 2 };
    s.count += (int)(random_bits() % 6);
    double at[3], side[3], lamp[3];
    for (int c = 0; c < 3; c++)
        at[c] = uniform(-1, 1) * away;
    for (int i = 0; i < s.count; i++) {
        s.paint[i] = random_paint();
        s.spheres[i].r = scale * log_uniform(0.2, 2);
        for (int c = 0; c < 3; c++)
            s.spheres[i].c[c] = at[c] + scale * uniform(-3, 3);
    }
    if (chance(0.5)) { // adds a ground that the first sphere touches
        const double r = scale * log_uniform(1e2, 1e6);
        s.spheres[s.count] =
            (hard_sphere) { { s.spheres[0].c[0], s.spheres[0].c[1] - s.spheres[0].r - r, s.spheres[0].c[2] }, r };
        s.paint[s.count++] = random_paint();
    }
    if (chance(0.3)) { // adds a room around the eye
        s.spheres[s.count] = (hard_sphere) { { at[0], at[1], at[2] }, scale * log_uniform(20, 1e4) };
        s.paint[s.count++] = random_paint();
    }
    random_direction(lamp);
    const double far = scale * log_uniform(1, 300); // the light is inside or outside the room
    do
        random_direction(side);
    while (fabs(side[1]) > 0.9); // the textbook's camera has a fixed up vector
    for (int c = 0; c < 3; c++) {
        s.at[c] = s.spheres[0].c[c];
        s.eye[c] = s.at[c] + side[c] * scale * uniform(4, 10);
        s.light[c] = at[c] + lamp[c] * far;
    }
    return s;
}

glint_scene *still_scene(const hard_still *still)
{
    glint_scene *scene = scene_new();
    scene_light_up(scene, still->ambient, still->background);
    glint_camera_desc camera = glint_camera_desc_default();
    memcpy(camera.eye, still->eye, sizeof camera.eye);
    memcpy(camera.at, still->at, sizeof camera.at);
    camera.fov_y_rad = still->fov_y_rad;
    scene_camera(scene, &camera);
    for (int i = 0; i < still->count; i++) {
        const still_paint *paint = &still->paint[i];
        glint_material *material = material_new(GLINT_MODEL_PHONG, paint->diffuse, paint->specular, paint->shininess);
        scene_sphere(scene, &still->spheres[i], material);
        glint_material_release(material);
    }
    glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_POINT);
    memcpy(light.position, still->light, sizeof light.position);
    scene_light(scene, &light);
    return scene;
}

still_pixel still_engine_pixel(const glint_image *image, int x, int y)
{
    float color[3], diffuse[3], id[3];
    pixel(image, GLINT_PASS_BEAUTY, x, y, color);
    pixel(image, GLINT_PASS_DIFFUSE, x, y, diffuse);
    pixel(image, GLINT_PASS_OBJECT_ID, x, y, id);
    return (still_pixel) { .object = (int)id[0], .lit = diffuse[1] > 0, .color = { color[0], color[1], color[2] } };
}
