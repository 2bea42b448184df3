// groups: of the groups of a tile, those that something may show in, by its cells and how deep it is; and of their lanes, those that
// come near it. All groups are tested before the first is decided, and nothing branches on what a test gives: such branches are
// mispredicted, which costs more than the tests. Contract: stages.h, cast.
#ifndef GLINT_CAST_GROUPS_H
#define GLINT_CAST_GROUPS_H

#include "engine/stages/index/candidate.h"
#include "engine/stages/index/cover.h"
#include "engine/stages/index/screen.h"
#include "engine/stages/simd/real.h"

/// One of these groups. Where pixels lie anywhere, all are in one column.
typedef struct R(tile_group) {
    int x, y, g; ///< column, row, number
    const float *s, *t; ///< places of its rays
} R(tile_group);

/// Lanes of a group that come near something.
typedef struct R(near_group) {
    uint16_t lanes;
    uint8_t x, y;
} R(near_group);

/// Groups that lie in some of the cells, where something as far away as `near` still matters there: a bit each, that of cover.h or, of
/// pixels that lie anywhere, that of its number. gathered, a constant here and below: they do.
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

/// The group of the lowest bit.
INNER R(tile_group) R(lowest_group)(const R(tile_cast) * tile, const bool gathered, uint64_t groups)
{
    const int place = __builtin_ctzll(groups), x = gathered ? 0 : place % COVER_ACROSS,
              y = gathered ? place : place / COVER_ACROSS;
    return (R(tile_group)) { x, y, y * tile->across + x, gathered ? tile->pixels->s[y] : tile->s[x],
                             gathered ? tile->pixels->t[y] : tile->t[y] };
}

/// Lanes that have met nothing before `near`.
INNER unsigned R(open_lanes)(const R(tile_cast) * tile, const R(tile_group) * at, int i, float near)
{
    return fm_bits(f_le(f_set(near), f_load(tile->depth[at->g] + i)));
}

/// Notes lanes where there are any. Returns how many groups are noted.
INNER int R(note_near)(const R(tile_group) * at, unsigned lanes, R(near_group) * groups, int count)
{
    groups[count] = (R(near_group)) { (uint16_t)lanes, (uint8_t)at->x, (uint8_t)at->y };
    return count + (lanes != 0);
}

/// Notes how deep a group's hits are.
INNER void R(note_group)(R(tile_cast) * tile, const bool gathered, R(near_group) group)
{
    if (gathered)
        R(note_cells)(tile, group.y, R(depth_of_group)(tile, group.y));
    else
        R(note_depth)(tile, group.x, group.y);
}

#endif
