/// The data of a base for adaptive sampling: the pixels of a tile that need all samples, and the pixels that its neighbours compare. Internal.
///
/// A frame with it is two: a base, of one sample in the middle of each pixel, and of the pixels chosen here the frame with
/// all its samples. Each pixel has the bits of the one or of the other. Pixels of one tile are compared as soon as it is rendered,
/// those at its borders when all are (effects/adaptive/choose.h), so that the choice does not depend on tiles, threads or the cache.
///
/// Two of eight neighbours are both chosen where they show two objects, or one and nothing; where their normals are more
/// than 25.8 degrees apart; or where the codes that they would be shown with differ, red, green and blue together, by more
/// than the threshold: as POV-Ray's +A does, in shares of the code for white, sRGB.
///
/// A base without codes has their estimates, which need no table and are made by vectors. Only where these leave the choice open the
/// codes are made, by their definition.
#ifndef GLINT_TILE_REFINE_H
#define GLINT_TILE_REFINE_H

#include "engine/film/image.h"

#define GLINT_REFINE_NORMAL 0.9f ///< cosine

/// The least and the most that some pixels have.
typedef struct glint_refine_range {
    float id[2], normal[3][2], code[3][2]; ///< codes: estimates
} glint_refine_range;

typedef struct glint_refine_tile {
    uint64_t pixels; ///< stamp of the base's that were compared, see glint_film_stamp; 0: not known
    // Pixels chosen: of each row, top first, a bit a pixel, the leftmost lowest.
    uint32_t inside[GLINT_TILE_HEIGHT]; ///< they differ from another of the tile
    uint32_t chosen[GLINT_TILE_HEIGHT]; ///< from any
    uint32_t above; ///< of the first row: from one of the tiles above
    uint64_t clipped, nonfinite; ///< counts of the base's pixels, where it has codes
    glint_refine_range range; ///< of all pixels
    bool ranged; ///< that is known
    /// The compared values of the first and last column; light if codes are estimated
    float side[2][GLINT_DIFFER_VALUES][GLINT_DIFFER_LENGTH];
} glint_refine_tile;

typedef struct glint_refine {
    const glint_stages *stages;
    const glint_image *base;
    bool coded; ///< its codes are compared; else estimates of them
    bool whole; ///< tiles without a chosen pixel are the base's as they are
    bool in_place; ///< the base is in the picture that is made of it
    bool in_codes; ///< likewise, and the picture is codes alone: the base's light is left only of tiles of which some is clipped or
                   ///< not finite
    glint_tone_desc tone; ///< of the codes
    uint32_t least; ///< sum of differences of codes that is not enough
    float low, high, gain; ///< see glint_differ_args, glint_estimate_args
    glint_refine_tile *tiles; ///< of the whole picture, left to right, top to bottom
    uint32_t across, down; ///< of them
    float *edges; ///< owned, as `tiles` is; see glint_refine_edge
    size_t edge_length; ///< numbers of a line of these
    uint64_t count; ///< pixels chosen
} glint_refine;

/// One value (GLINT_DIFFER_ID ..) of the first (last = 0) or last (1) row of pixels of a row of tiles: a line as wide as the picture, with
/// light where codes are estimated.
static inline float *glint_refine_edge(const glint_refine *refine, uint32_t row, int last, int value)
{
    return refine->edges + ((2 * (size_t)row + (size_t)last) * GLINT_DIFFER_VALUES + (size_t)value) * refine->edge_length;
}

/// Two lines of the base.
typedef struct glint_refine_lines {
    glint_differ_args args; ///< lines and counts
    const float *light[2][3]; ///< of their pixels, where codes are estimated
    bool grouped; ///< four pixels lie together in each group: the lines are rows of a tile; else all do
} glint_refine_lines;

/// Whether pixels in these ranges are so much alike that no two of them can differ.
bool glint_refine_alike(const glint_refine *refine, const glint_refine_range *a, const glint_refine_range *b);

/// Which of their pixels differ, as glint_differences has it.
void glint_refine_compare(const glint_refine *refine, const glint_refine_lines *lines, uint32_t differ[GLINT_DIFFER_WAYS]);

#endif
