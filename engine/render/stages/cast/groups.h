// groups: finds the groups of a tile in which a primitive may be visible, by the primitive's cells and depth, and the
// lanes of these groups whose rays come near the primitive. All groups are tested before the first is decided,
// without branches on test results: such branches are often mispredicted, which costs more than the tests.
// Contract: stages.h, cast.
#ifndef GLINT_CAST_GROUPS_H
#define GLINT_CAST_GROUPS_H

#include "engine/render/stages/index/candidate.h"
#include "engine/render/stages/index/cover.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/simd/real.h"

/// One group of a tile. If pixels can lie anywhere, all groups are in one column.
typedef struct R(tile_group) {
    int x, y, g; ///< column, row, number
    const float *s, *t; ///< screen positions of the group's rays
} R(tile_group);

/// The lanes of a group whose rays come near a primitive.
typedef struct R(near_group) {
    uint16_t lanes;
    uint8_t x, y;
} R(near_group);

/// Returns the groups that lie in some of the cells and in which a hit may be farther than `near`. There is one bit
/// per group, numbered as in cover.h or, for gathered pixels, by the group's index. gathered, a constant here and
/// below: whether the pixels can lie anywhere.
INNER uint64_t R(groups_behind)(const R(tile_cast) * tile, const bool gathered, screen_cells cells, float near)
{
    const unsigned columns = bit_range(first_column(cells), last_column(cells));
    uint64_t groups = 0;
    for (int y = first_row(cells); y <= last_row(cells); y++) {
        unsigned behind = behind_in_row((const float(*)[SCREEN_ACROSS])tile->far, y, near, columns);
        if (!gathered)
            groups |= (uint64_t)behind << COVER_ACROSS * y;
        for (; gathered && behind; behind &= behind - 1)
            groups |= tile->pixels->in_cell[y][__builtin_ctz(behind)];
    }
    return groups;
}

/// Returns the group with the lowest bit.
INNER R(tile_group) R(lowest_group)(const R(tile_cast) * tile, const bool gathered, uint64_t groups)
{
    const int slot = __builtin_ctzll(groups), x = gathered ? 0 : slot % COVER_ACROSS,
              y = gathered ? slot : slot / COVER_ACROSS;
    return (R(tile_group)) { x, y, y * tile->across + x, gathered ? tile->pixels->s[y] : tile->s[x],
                             gathered ? tile->pixels->t[y] : tile->t[y] };
}

/// Returns the lanes that have no hit nearer than `near`.
INNER unsigned R(lanes_in_front)(const R(tile_cast) * tile, const R(tile_group) * at, int i, float near)
{
    return fm_bits(f_le(f_set(near), f_load(tile->depth[at->g] + i)));
}

/// Appends a group with its lanes, if there are any. Returns the number of groups.
INNER int R(note_near)(const R(tile_group) * at, unsigned lanes, R(near_group) * groups, int count)
{
    groups[count] = (R(near_group)) { (uint16_t)lanes, (uint8_t)at->x, (uint8_t)at->y };
    return count + (lanes != 0);
}

/// Updates the stored distance of the farthest hit of a group.
INNER void R(note_group)(R(tile_cast) * tile, const bool gathered, R(near_group) group)
{
    if (gathered)
        R(note_cells)(tile, group.y, R(depth_of_group)(tile, group.y));
    else
        R(note_depth)(tile, group.x, group.y);
}

#endif
