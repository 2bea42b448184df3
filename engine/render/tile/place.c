/// The position of a tile in the picture.
#include "engine/render/tile/tile.h"

void glint_tile_activate(glint_tile *tile)
{
    memset(tile->active, 0xff, sizeof tile->active);
    if (tile->width == GLINT_TILE_WIDTH && tile->height == GLINT_TILE_HEIGHT)
        return;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const uint32_t columns = tile->width - 4 * (g % tile->groups_across);
        const uint32_t rows = tile->height - 4 * (g / tile->groups_across);
        const uint32_t in_row = columns < 4 ? (1u << columns) - 1 : 15;
        const uint32_t in_rows = rows < 4 ? (1u << 4 * rows) - 1 : 0xffff;
        tile->active[g] = (uint16_t)(in_row * 0x1111 & in_rows);
    }
}

void glint_tile_place_at(glint_tile *tile, const glint_plan *plan, uint32_t column, uint32_t row)
{
    const uint32_t width = (uint32_t)plan->desc.width, height = (uint32_t)plan->desc.height;
    tile->x0 = column * GLINT_TILE_WIDTH;
    tile->y0 = row * GLINT_TILE_HEIGHT;
    tile->transparent = plan->desc.alpha;
    tile->width = width - tile->x0 < GLINT_TILE_WIDTH ? width - tile->x0 : GLINT_TILE_WIDTH;
    tile->height = height - tile->y0 < GLINT_TILE_HEIGHT ? height - tile->y0 : GLINT_TILE_HEIGHT;
    tile->groups_across = (tile->width + 3) / 4;
    tile->group_count = tile->groups_across * ((tile->height + 3) / 4);
    glint_tile_activate(tile);
}
