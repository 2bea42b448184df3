/// Adaptive sampling: the choice of pixels that get all samples, in a picture with one sample each. Internal. The
/// rule, and the pixels inside a tile: adaptive/refine.h.
///
/// Through a lens, a pixel of the base shows one point of the lens, and 4 x 4 neighbours show all 16. A difference at
/// any of these points is blurred over all of them. So pixels up to GLINT_REFINE_SPREAD away from a differing pair
/// are chosen, too.
#ifndef GLINT_REFINE_H
#define GLINT_REFINE_H

#include "engine/base/pool.h"
#include "engine/render/adaptive/refine.h"
#include "engine/render/plan/plan.h"

#define GLINT_REFINE_SPREAD 2 ///< pixels, in every direction

/// Called before a base is rendered into `image`, which must live until the choice. `desc`: the description of the
/// base, with the threshold. Allocates the base's tiles; existing tiles keep their keys. Fails with GLINT_ERR_NOMEM.
glint_status glint_refine_begin(glint_refine *refine, const glint_stages *stages, const glint_image *image,
                                const glint_render_desc *desc, glint_error *error);
/// Called after the base is rendered: collects the results of the tiles, compares pixels across borders of tiles, and
/// sets `count`. lens: also chooses pixels around the chosen ones. The result does not depend on the number of
/// threads.
void glint_refine_choose(glint_refine *refine, const glint_extent *extent, bool lens, glint_pool *pool);
/// Frees what it owns. Zeroed memory is a valid initial state.
void glint_refine_clear(glint_refine *refine);

#endif
