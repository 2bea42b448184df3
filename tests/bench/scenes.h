/// The scenes of `make bench` as plain numbers: one generator for all sides of the table.
#ifndef GLINT_BENCH_SCENES_H
#define GLINT_BENCH_SCENES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define BENCH_WIDTH 1920
#define BENCH_HEIGHT 1080
#define BENCH_FRAMES 60 ///< frames of a job
#define BENCH_MATERIALS 16 ///< largest number of materials: sixteen floats fit in one vector register

typedef struct bench_material {
    float diffuse[3], specular, shininess;
    float mirror, transmission; ///< shares of reflected and transmitted light; transmission above 0: glass of index
        ///< 1.5, which has no matt term in POV-Ray
} bench_material;

typedef enum bench_solid_kind {
    BENCH_CUT, ///< a box minus a ball
    BENCH_PIECES, ///< the same box and ball as separate shapes
    BENCH_TORUS,
    BENCH_ROD, ///< a cylinder
    BENCH_TIP ///< a cone
} bench_solid_kind;

/// A solid shape, only for glint and POV-Ray.
typedef struct bench_solid {
    bench_solid_kind kind;
    uint32_t material;
    float center[3], size; ///< box: centre, half width; torus: centre, major radius; rod and tip: centre of the base,
        ///< radius
    float ball[4]; ///< box: centre and radius of the ball; torus: unit axis, minor radius; rod and tip: the other end
} bench_solid;

typedef struct bench_scene {
    size_t sphere_count;
    float *spheres; ///< x, y, z, radius of each sphere; binary32, so that all sides have identical numbers
    uint32_t *sphere_material;
    size_t solid_count;
    bench_solid *solids;
    size_t vertex_count, triangle_count; ///< numbers of vertices and triangles of a mesh with the first material
    float *vertices; ///< x, y, z of each vertex
    uint32_t *triangles; ///< indices of the three vertices of each triangle
    int material_count;
    bench_material materials[BENCH_MATERIALS];
    float eye[3], at[3], fov_y_degrees;
    float lens_radius, lens_focus; ///< radius and focus distance of the lens, if the options ask for a lens; only
        ///< glint and POV-Ray
    float height; ///< height of an orthographic view, in world units; 0: a perspective view; only glint and POV-Ray
    float light[3], light_radius; ///< a white light; light_radius is only for the area light
    float ambient[3], background[3];
} bench_scene;

/// Returns false for an unknown scene. The scenes:
///   workshop                 four balls on a large one
///   glassball                the same, one of them of glass
///   1k, 1M                   a cloud of 1,000 or 1,000,000 spheres; over1k, over1M: above the top of a large ball
///   floor100, floor1k, floor1M   spheres on such a floor; mirrorfloor: 1,000 on a mirror;
///                            glassfloor: 50, half of them of glass
///   glass                    24 mirrors, glass and matt spheres on a floor
///   cut1k, pieces1k          1,000 boxes minus a ball on such a floor; the same boxes and balls as separate shapes
///   tori                     24 tori on such a floor
///   box                      100,000 spheres, an orthographic view
///   inside                   100,000 spheres around the eye
///   cloud17k                 17,000 spheres
///   molecule                 1,000 balls, 1,000 rods and 250 tips
///   mesh, mesh100k           500,000 and 100,000 triangles; levelmesh: 100,000 in an orthographic view
///   glassmesh                20,000 triangles, of glass
bool bench_scene_create(const char *name, bench_scene *out);
void bench_scene_free(bench_scene *scene);

/// Stores the position of lamp `i` of `count`.
/// A single lamp is at the scene's position; several lamps are on a ring around it.
void bench_lamp(const bench_scene *scene, int i, int count, double position[3]);

/// The jobs of 60 frames, counted from 0: the position of a lamp that circles once,
/// and the shininess of a highlight that shrinks.
void bench_job_light(int frame, double position[3]);
double bench_job_shininess(int frame);

/// The camera's ray through (x, y), in pixels from the top left, is corner + x right + y down, not normalised.
typedef struct bench_camera {
    double corner[3], right[3], down[3];
} bench_camera;

bench_camera bench_camera_of(const bench_scene *scene);

#endif
