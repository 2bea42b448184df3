/// Shared by the two packet tracers here, hand.c and embree.c: the scene in vectors of sixteen, and the frame in
/// bands of four rows.
#ifndef GLINT_BENCH_PACKET_H
#define GLINT_BENCH_PACKET_H

#include <stdint.h>

#include "tests/bench/options.h"
#include "tests/bench/scenes.h"
#include "tests/bench/wide.h"

enum { LIGHT_SAMPLES = 16, BAND = 4 };

typedef struct packet_hit {
    vm mask; ///< lanes with a hit
    vec point, normal; ///< normal: unit length, towards the viewer
    vi material;
} packet_hit;

/// A scene in the packets' format.
typedef struct packet_scene {
    bench_scene plain;
    bench_options options;
    vec eye, corner, right, down; ///< of the camera; `corner` has per lane the corner of its pixel in block (0, 0)
    float sample[64][2], sample_weight; ///< sample positions in a pixel, and one over their number
    float light[3];
    vf diffuse[3], ambient[3], specular, shininess; ///< tables by material
    float light_offset[LIGHT_SAMPLES][3]; ///< from the light's centre
    vf turn_cos, turn_sin; ///< rotation about y of the light's points, per pixel of a block
    void *side; ///< private to the tracer
} packet_scene;

/// Linear light of four rows: red, green, blue.
typedef struct packet_band {
    float rgb[3][BAND][BENCH_WIDTH];
} packet_band;

/// Reads the scene that the options name. Ends the program when there is none.
void packet_scene_init(packet_scene *scene, const bench_options *options);
void packet_scene_free(packet_scene *scene);
/// Makes the tables of the materials. `shininess` above 0 replaces that of every shiny material.
void packet_scene_set_materials(packet_scene *scene, float shininess);

/// Renders the band that starts at row y. packet_frame calls it for every band of a frame, on the scene's threads.
typedef void packet_render(const packet_scene *scene, int y, packet_band *band);
typedef void packet_use(void *user, int y, const packet_band *band);
/// Renders a frame in bands. `use` may be NULL; it receives each finished band, on any thread.
void packet_frame(const packet_scene *scene, packet_render *render, packet_use *use, void *user);

#endif
