#include "engine/glint.h"
#include "engine/glint_figures.h"

#include "engine/figures/overlay/colormap_table.h"

static const struct {
    const char *name;
    const uint32_t *colors;
} maps[GLINT_COLORMAP_COUNT] = {
    [GLINT_COLORMAP_VIRIDIS] = { "viridis", VIRIDIS },    [GLINT_COLORMAP_MAGMA] = { "magma", MAGMA },
    [GLINT_COLORMAP_CIVIDIS] = { "cividis", CIVIDIS },    [GLINT_COLORMAP_TURBO] = { "turbo", TURBO },
    [GLINT_COLORMAP_COOLWARM] = { "coolwarm", COOLWARM },
};

const char *glint_colormap_name(glint_colormap map)
{
    return (unsigned)map < GLINT_COLORMAP_COUNT ? maps[map].name : NULL;
}

const uint32_t *glint_colormap_table(glint_colormap map)
{
    return (unsigned)map < GLINT_COLORMAP_COUNT ? maps[map].colors : NULL;
}
