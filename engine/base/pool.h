/// A pool of worker threads that run numbered items. Internal.
#ifndef GLINT_BASE_POOL_H
#define GLINT_BASE_POOL_H

#include "engine/glint.h"

typedef struct glint_pool glint_pool;

/// Runs item `index` on worker `worker` (0 .. threads - 1); no two items run on one worker at a time.
typedef void glint_pool_item(void *context, size_t index, int worker);

/// threads: 1 .. 1024.
glint_status glint_pool_create(int threads, glint_pool **out, glint_error *error);
void glint_pool_destroy(glint_pool *pool);
int glint_pool_threads(const glint_pool *pool);
/// Runs items 0 .. count - 1, in any order, and returns when all have run. The caller is worker 0, so that `threads` is what
/// computes; one belongs only to the caller. Callers of several threads take turns.
void glint_pool_run(glint_pool *pool, size_t count, glint_pool_item *item, void *context);
/// Runs items on the pool's workers, or one after the other on the calling thread when there is no pool or one item.
void glint_run_items(glint_pool *pool, size_t count, glint_pool_item *item, void *context);
/// Processors this process may use.
int glint_pool_processors(void);

#endif
