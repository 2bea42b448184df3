/// Shared by the two packet tracers hand.c and embree.c:
/// the scene in vectors of sixteen, and the frame in bands of four rows.
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
    vec eye, corner, right, down; ///< the camera; each lane of `corner` is the corner of its pixel in block (0, 0)
    float sample[64][2], sample_weight; ///< sample positions in a pixel, and one over the number of samples
    float light[3];
    vf diffuse[3], ambient[3], specular, shininess; ///< tables with one entry per material
    float light_offset[LIGHT_SAMPLES][3]; ///< sample positions relative to the light's centre
    vf turn_cos, turn_sin; ///< rotation of the light's samples about y, for each pixel of a block
    void *side; ///< data private to the tracer
} packet_scene;

/// Linear light of four rows of pixels: red, green, blue.
typedef struct packet_band {
    float rgb[3][BAND][BENCH_WIDTH];
} packet_band;

/// Reads the scene that the options name. Ends the program when there is none.
void packet_scene_init(packet_scene *scene, const bench_options *options);
void packet_scene_free(packet_scene *scene);
/// Fills the tables of the materials. A `shininess` above 0 replaces the shininess of every shiny material.
void packet_scene_set_materials(packet_scene *scene, float shininess);

/// Renders the band that starts at row y. packet_frame calls it for every band of a frame, on the scene's threads.
typedef void packet_render(const packet_scene *scene, int y, packet_band *band);
typedef void packet_use(void *user, int y, const packet_band *band);
/// Renders a frame in bands. Calls `use`, unless it is NULL, with each finished band, on any thread.
void packet_frame(const packet_scene *scene, packet_render *render, packet_use *use, void *user);

#endif
