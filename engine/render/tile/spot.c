/// Spot lights that miss a whole tile.
#include "engine/base/vec.h"
#include "engine/render/tile/tile.h"

#define SPOT_SLACK 1e-3 ///< tolerance for a cosine, far above its rounding error, also in float

/// Returns whether certainly no point of a box is in a spot's cone. Tests the direction from the apex to the ball
/// around the box that is nearest to the axis.
static bool is_past(const glint_spot *spot, const double apex[3], const glint_point_box *box)
{
    double offset[3], half[3], size = 0;
    for (int c = 0; c < 3; c++) {
        offset[c] = 0.5 * (box->lower[c] + box->upper[c]) - apex[c];
        half[c] = 0.5 * (box->upper[c] - box->lower[c]);
        size = fmax(size, fmax(fabs(apex[c]), fmax(fabs(box->lower[c]), fabs(box->upper[c]))));
    }
    const double distance = sqrt(vec_dot(offset, offset)), radius = sqrt(vec_dot(half, half));
    if (!(distance - radius > SPOT_SLACK * size)) // too close: rounding may change the direction
        return false;
    const double sine = radius / distance, cosine = sqrt(1 - sine * sine);
    const double along = vec_dot(offset, spot->axis) / distance, across = sqrt(fmax(1 - along * along, 0));
    return along < cosine && along * cosine + across * sine < spot->outer - SPOT_SLACK;
}

bool glint_tile_is_past_spot(const glint_tile *tile, const glint_plan_light *light)
{
    return light->is_spot && !light->light_samples && tile->at.box && is_past(&light->spot, light->position, tile->at.box);
}
