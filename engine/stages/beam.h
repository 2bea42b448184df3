// beam: the points of a tile as their light sees them, a screen (screen.h) of their own. Segments from points to one light
// are a bundle as a camera's rays are.

#define BEAM_DOWN 32 ///< rows of cells
#define BEAM_NEAREST 0.25f ///< least k of a point: nearer to the light a place is not worth much
#define BEAM_WIDEST 1.0f ///< largest tangent of an angle to the axis

/// Sets the frame's axes: `away` from the light, and `along` as far as it is across it, which becomes the second. All
/// may have any length but 0.
static bool make_beam_axes(const double away[3], const double along[3], screen_view *view)
{
    const double length = sqrt(DOT(away, away)), share = DOT(along, away) / (length * length);
    double down[3], across[3];
    for (int k = 0; k < 3; k++)
        down[k] = along[k] - share * away[k];
    const double width = sqrt(DOT(down, down));
    if (!(width > 1e-3 * sqrt(DOT(along, along))) || !(length > 0) || !(length < HUGE_VAL))
        return false;
    for (int k = 0; k < 3; k++)
        across[k] = (down[(k + 1) % 3] * away[(k + 2) % 3] - down[(k + 2) % 3] * away[(k + 1) % 3]) / (width * length);
    for (int k = 0; k < 3; k++) {
        view->axis[0][k] = (float)across[k];
        view->axis[1][k] = (float)(down[k] / width);
        view->axis[2][k] = (float)(away[k] / length);
    }
    return true;
}

/// On which side of a triangle the light is: 1 in front, -1 behind, or 0 where float cannot tell.
static int side_of_light(const shape_on_screen *triangle, const float middle[3], const screen_view *view)
{
    // from a corner to the light, times the share `inverse` of the way where there is one
    const float corner[3] = { triangle->across[0], triangle->down[0], triangle->w[0] };
    const float *a = triangle->across, *b = triangle->down, *c = triangle->w;
    const float f[3] = { a[1] - a[0], b[1] - b[0], c[1] - c[0] }, g[3] = { a[2] - a[0], b[2] - b[0], c[2] - c[0] };
    float side = 0, size = 0;
    for (int k = 0; k < 3; k++) {
        const float way = -view->inverse * (middle[k] + corner[k]) - (k == 2 ? 1.0f : 0.0f);
        side += (f[(k + 1) % 3] * g[(k + 2) % 3] - f[(k + 2) % 3] * g[(k + 1) % 3]) * way;
        size += fabsf(way);
    }
    const float doubt = triangle->size * (triangle->size * (0x1p-16f * size + 16 * triangle->slack * view->inverse) +
                                          16 * triangle->slack * size);
    return side > doubt ? 1 : side < -doubt ? -1 : 0;
}
