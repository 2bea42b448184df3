/// A still life of spheres under one point light with hard shadows, for the engine and the textbook tracers.
#ifndef HARD_STILL_H
#define HARD_STILL_H

#include "tests/hard/oracle/drive.h"

#define STILL_MAX 16

typedef struct still_paint {
    double diffuse[3], specular, shininess; ///< parameters of Phong's model
} still_paint;

typedef struct hard_still {
    const char *name;
    int count;
    hard_sphere spheres[STILL_MAX];
    still_paint paint[STILL_MAX];
    double light[3];
    double eye[3], at[3], fov_y_rad;
    double ambient, background[3];
} hard_still;

/// A tracer's result for one pixel.
typedef struct still_pixel {
    int object; ///< object that the pixel shows, counted from 1; 0: background
    bool lit; ///< whether the light reaches the point and shines on its front
    double color[3]; ///< linear light
} still_pixel;

/// The textbook's tracer: (-b +- sqrt(b^2 - 4ac)) / 2a, p = o + t d, n = (p - c) / r, shadows beyond an epsilon. In
/// 113 bits it gives the truth for scenes whose numbers span at most twelve digits;
/// in 24 and 53 bits it serves for comparison.
still_pixel still_trace_113(const hard_still *still, int width, int height, int x, int y);
still_pixel still_trace_53(const hard_still *still, int width, int height, int x, int y);
still_pixel still_trace_24(const hard_still *still, int width, int height, int x, int y);

/// Makes a heap of spheres of about the size `scale` within `away` of the origin,
/// sometimes on a ground, in a room, or both.
hard_still still_random(double scale, double away);

/// Makes the same scene for the engine.
glint_scene *still_scene(const hard_still *still);
/// Reads a pixel of an image with the passes beauty, diffuse and object_id.
still_pixel still_engine_pixel(const glint_image *image, int x, int y);

#endif
