/// A pool of worker threads that run numbered items. Internal.
#ifndef GLINT_BASE_POOL_H
#define GLINT_BASE_POOL_H

#include "engine/glint_types.h"

typedef struct glint_pool glint_pool;

/// Runs item `index` on worker `worker` (0 .. threads - 1). A worker runs one item at a time.
typedef void glint_pool_item(void *context, size_t index, int worker);

/// Creates a pool. threads: 1 .. 1024.
glint_status glint_pool_create(int threads, glint_pool **out, glint_error *error);
void glint_pool_destroy(glint_pool *pool);
int glint_pool_threads(const glint_pool *pool);
/// Runs items 0 .. count - 1, in any order, and returns when all have run. The caller is worker 0 and counts as one
/// of the `threads`; a pool of one thread uses only the caller. Concurrent callers take turns.
void glint_pool_run(glint_pool *pool, size_t count, glint_pool_item *item, void *context);
/// Runs items on the pool's workers, or in order on the calling thread if there is no pool or only one item.
void glint_run_items(glint_pool *pool, size_t count, glint_pool_item *item, void *context);
/// Returns the number of processors that this process may use.
int glint_pool_processors(void);

#endif
