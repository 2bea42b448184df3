/// What happens to a ray at a surface: the shares that mirrors and glass send on, and the ray that goes on. Internal.
#ifndef GLINT_PATHS_EVENT_H
#define GLINT_PATHS_EVENT_H

#include "engine/render/paths/batch.h"

/// How a ray goes on from a surface.
typedef enum glint_event {
    GLINT_EVENT_MIRROR,
    GLINT_EVENT_REFRACT, ///< refracted or totally reflected
    GLINT_EVENT_STRAIGHT, ///< straight on through a translucent surface
    GLINT_SPLITS, ///< number of the events above, into all of which a ray may split
    GLINT_EVENT_SCATTER = GLINT_SPLITS, ///< scattered by a matt surface
    GLINT_EVENTS,
    GLINT_EVENT_NONE = GLINT_EVENTS ///< the path ends
} glint_event;

#define GLINT_STRAIGHT_MAX 4096 ///< translucent surfaces that one ray may go straight through

/// Returns a throughput, limited to GLINT_WEIGHT_MAX.
static inline double glint_clamp_throughput(double x) { return x < GLINT_WEIGHT_MAX ? x : GLINT_WEIGHT_MAX; }

/// Returns whether any visible material passes a test. The materials must be known.
bool glint_tile_shows(const glint_tile *tile, const glint_tile_frame *frame, bool (*test)(const glint_bounce_material *));
/// Finds the media of sample `i` on the ray's side of its surface, and beyond: materials or GLINT_NO_MEDIUM.
void glint_event_sides(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                       uint32_t sides[2]);
/// Returns the refractive index on this side of the surface of sample i divided by the index beyond; 1 for a mirror
/// that does not transmit.
double glint_event_ratio(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i);
/// Computes the reflected and refracted directions at the samples of `tile` in batch->wanted. `tile` is the batch's
/// own, or one that the eye sees.
void glint_event_find_directions(glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame);
/// Computes the throughput of the rays that go on from sample `i`, after glint_event_find_directions. On entry, each is
/// that of the arriving ray. A ray that the material does not send gets 0.
void glint_bsdf_weights(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                        double throughput[GLINT_SPLITS][3]);
/// Starts ray n of `rays` at the hit of sample `i` of the tile, as an active ray. It inherits everything from the arriving
/// ray but direction and side.
void glint_ray_begin(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                     glint_rays *rays, uint32_t n);
/// Continues the ray of sample `i` as ray n of `rays` by an event before GLINT_SPLITS, after glint_event_find_directions.
/// The caller sets throughput and slopes. A ray of the eye gets the event's term.
void glint_ray_continue(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                        glint_event event, glint_rays *rays, uint32_t n);
/// Returns whether a direction scattered around a bumped normal leaves the surface of sample `i`.
bool glint_event_leaves(const glint_tile *tile, const glint_plan *plan, uint32_t i, const double direction[3]);
/// Updates the media of a ray that crosses the surface of sample i. A material that transmits has an inside; any
/// other translucent surface has none.
void glint_event_cross(const glint_tile *tile, const glint_tile_frame *frame, uint32_t i, glint_media *media);

#endif
