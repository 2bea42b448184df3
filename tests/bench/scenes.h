/// The scenes of `make bench`, as plain numbers: one generator for every side of the table.
#ifndef GLINT_BENCH_SCENES_H
#define GLINT_BENCH_SCENES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define BENCH_WIDTH 1920
#define BENCH_HEIGHT 1080
#define BENCH_FRAMES 60 ///< of a job
#define BENCH_MATERIALS 16 ///< at most: sixteen floats are one vector register

typedef struct bench_material {
    float diffuse[3], specular, shininess;
    float mirror, transmission; ///< above 0: glass with an index of 1.5, of which POV-Ray's twin shows nothing matt
} bench_material;

typedef enum bench_solid_kind {
    BENCH_CUT, ///< a box less a ball
    BENCH_PIECES, ///< that box and that ball, each by itself
    BENCH_TORUS,
    BENCH_ROD, ///< a cylinder
    BENCH_TIP ///< a cone
} bench_solid_kind;

/// Only for glint and POV-Ray.
typedef struct bench_solid {
    bench_solid_kind kind;
    uint32_t material;
    float center[3], size; ///< of the box, half its width; of the torus, the radius of its ring; of rod and tip the middle of the base,
        ///< and its radius
    float ball[4]; ///< centre and radius; of a torus its axis, unit, and the radius of its tube; of rod and tip the other end
} bench_solid;

typedef struct bench_scene {
    size_t sphere_count;
    float *spheres; ///< x, y, z, radius of each; binary32, so that all sides have the same numbers
    uint32_t *sphere_material;
    size_t solid_count;
    bench_solid *solids;
    size_t vertex_count, triangle_count; ///< a mesh of the first material
    float *vertices; ///< x, y, z of each
    uint32_t *triangles; ///< three vertices of each
    int material_count;
    bench_material materials[BENCH_MATERIALS];
    float eye[3], at[3], fov_y_degrees;
    float lens_radius, lens_focus; ///< of a lens, where one is called for; for glint and POV-Ray alone
    float height; ///< above 0: of an orthographic view, world units; for glint and POV-Ray alone
    float light[3], light_radius; ///< a white light; the radius belongs to the area light
    float ambient[3], background[3];
} bench_scene;

/// False when there is no such scene. There are:
///   workshop                 four balls on a large one
///   glassball                the same, one of them of glass
///   1k, 1M                   a cloud of so many spheres; over1k, over1M: above the top of a large ball
///   floor100, floor1k, floor1M   so many spheres resting on such a floor; mirrorfloor: 1,000 on one that mirrors; glassfloor: 50, half of glass
///   glass                    24 mirrors, glass and matt spheres on a floor
///   cut1k, pieces1k          1,000 boxes less a ball on such a floor; these boxes and balls, each by itself
///   tori                     24 tori on such a floor
///   box                      100,000 spheres, an orthographic view
///   inside                   100,000 spheres around the eye
///   cloud17k                 17,000 spheres
///   molecule                 1,000 balls, 1,000 rods and 250 tips
///   mesh, mesh100k           500,000 and 100,000 triangles; levelmesh: 100,000 in an orthographic view
///   glassmesh                20,000 triangles, of glass
bool bench_scene_create(const char *name, bench_scene *out);
void bench_scene_free(bench_scene *scene);

/// Where lamp `i` of `count` hangs: one in the scene's place, several on a ring around it.
void bench_lamp(const bench_scene *scene, int i, int count, double position[3]);

/// The jobs of 60 frames, counted from 0: a lamp that goes round once, and a highlight that shrinks.
void bench_job_light(int frame, double position[3]);
double bench_job_shininess(int frame);

/// The camera's ray through (x, y), pixels from the top left, is corner + x right + y down; not of unit length.
typedef struct bench_camera {
    double corner[3], right[3], down[3];
} bench_camera;

bench_camera bench_camera_of(const bench_scene *scene);

#endif
