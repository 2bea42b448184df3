/// Adaptive sampling: which pixels of a picture of one sample each are worth all samples. Internal. The rule, and the pixels inside
/// of a tile: effects/adaptive/refine.h.
///
/// Through a lens a pixel of the base shows one point of it, and 4 x 4 neighbours all 16 that there are: what any of them see
/// otherwise is in the blur of all. So pixels are chosen as well that are up to GLINT_REFINE_SPREAD from such a pair.
#ifndef GLINT_REFINE_H
#define GLINT_REFINE_H

#include "engine/base/pool.h"
#include "engine/plan/plan.h"
#include "engine/effects/adaptive/refine.h"

#define GLINT_REFINE_SPREAD 2 ///< pixels, in every direction

/// Before a base is rendered into `image`, which must stay until the choice. `desc`: of it, with the threshold. Makes room for its tiles;
/// the keys of those that are there are kept. GLINT_ERR_NOMEM.
glint_status glint_refine_begin(glint_refine *refine, const glint_stages *stages, const glint_image *image,
                                const glint_render_desc *desc, glint_error *error);
/// After that: brings together what its tiles have found, compares pixels across their borders, and sets `count`. lens: pixels around
/// those chosen are chosen as well. Any number of threads gives the same.
void glint_refine_choose(glint_refine *refine, const glint_extent *extent, bool lens, glint_pool *pool);
/// Frees what it owns; zeroed memory is a beginning.
void glint_refine_clear(glint_refine *refine);

#endif
