/// Adaptive sampling: chooses the pixels of a tile that need all samples, and stores the border pixels that
/// neighbouring tiles compare. Internal.
///
/// A frame with adaptive sampling has two steps. The first, the base, takes one sample in the middle of each pixel. The
/// second takes all samples for the pixels chosen here. Every pixel is bit-identical to that of a frame with one sample
/// or of a frame with all samples. Pixels within a tile are compared as soon as the tile is rendered. Pixels at the
/// borders of tiles are compared when all tiles are rendered (adaptive/choose.h), so that the choice does not
/// depend on tiles, threads or the cache.
///
/// A pixel and one of its eight neighbours are both chosen if they show two objects, or one object and nothing; if
/// their normals are more than 25.8 degrees apart; or if their pixel values differ by more than the threshold. This
/// difference is the sum over red, green and blue, in units of the value for white, in sRGB, like POV-Ray's +A.
///
/// A base without pixel values uses estimates, which need no table and are vectorised. Exact values are only computed
/// where the estimates cannot decide.
#ifndef GLINT_TILE_REFINE_H
#define GLINT_TILE_REFINE_H

#include "engine/film/image.h"
#include "engine/render/stages/stages.h"

#define GLINT_REFINE_NORMAL 0.9f ///< cosine

typedef struct glint_refine_tile {
    uint64_t pixels; ///< stamp of the compared pixels of the base, see glint_film_stamp; 0: unknown
    // Chosen pixels, for each row from the top: one bit per pixel, the leftmost lowest.
    uint32_t inside[GLINT_TILE_HEIGHT]; ///< pixels that differ from another one of the tile
    uint32_t chosen[GLINT_TILE_HEIGHT]; ///< pixels that differ from one of any tile; with a lens also pixels near these
    uint32_t above; ///< pixels of the first row that differ from one in the tiles above
    uint64_t clipped, nonfinite; ///< counts of the base's pixels, if it has pixel values
    /// The compared values of the first and last column; light if pixel values are estimated
    float side[2][GLINT_DIFFER_VALUES][GLINT_DIFFER_LENGTH];
} glint_refine_tile;

typedef struct glint_refine {
    const glint_stages *stages;
    const glint_image *base;
    bool coded; ///< the base's pixel values are compared; otherwise estimates
    bool whole; ///< tiles without a chosen pixel are copied from the base unchanged
    bool in_place; ///< the base is rendered into the picture that is made from it
    glint_tone_desc tone; ///< tone of the pixel values
    uint32_t least; ///< sum of differences of pixel values up to which pixels are equal
    float low, high, gain; ///< see glint_differ_args, glint_estimate_args
    glint_refine_tile *tiles; ///< the tiles of the whole picture, left to right, top to bottom
    uint32_t across, down; ///< tiles in each direction
    float *edges; ///< owned, like `tiles`; see glint_refine_edge
    size_t edge_length; ///< numbers per line
    uint64_t count; ///< chosen pixels
} glint_refine;

/// Returns one value (GLINT_DIFFER_ID ..) of the first (last = 0) or last (1) row of pixels of a row of tiles: a line
/// as wide as the picture, with light if pixel values are estimated.
static inline float *glint_refine_edge(const glint_refine *refine, uint32_t row, int last, int value)
{
    return refine->edges + ((2 * (size_t)row + (size_t)last) * GLINT_DIFFER_VALUES + (size_t)value) * refine->edge_length;
}

/// Two lines of the base.
typedef struct glint_refine_lines {
    glint_differ_args args; ///< lines and counts
    const float *light[2][3]; ///< light of the pixels, if pixel values are estimated
    bool grouped; ///< four pixels of each group are contiguous: the lines are rows of a tile; otherwise all pixels are
        ///< contiguous
} glint_refine_lines;

/// Computes which pixels of two lines differ, as glint_differences does.
void glint_refine_compare(const glint_refine *refine, const glint_refine_lines *lines,
                          uint32_t differ[GLINT_DIFFER_DIRECTIONS]);

#endif
