#include "engine/base/pool.h"
#include "engine/base/status.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

// The stack of a worker: eight times the measured use of tiles. The default of musl, 128 KiB, is too small. With a
// default of 8 MiB, some hundred workers use up the address space that a process may have.
#define STACK_BYTES ((size_t)1 << 20)

struct worker {
    glint_pool *pool;
    pthread_t thread;
    int number;
};

struct glint_pool {
    pthread_mutex_t turn; ///< locked by the caller whose items run; that caller is worker 0
    pthread_mutex_t mutex; ///< protects all fields below; the job does not change while workers are busy
    pthread_cond_t work, done;
    unsigned long round; ///< counts the calls of glint_pool_run
    /// Threads working on this round's items; glint_pool_run does not wait for threads that find no items left
    int busy;
    bool stop;
    size_t count;
    glint_pool_item *item;
    void *context;
    atomic_size_t next;
    int threads; ///< including the caller's
    struct worker workers[]; ///< all threads except the caller's
};

static void run_items(glint_pool *pool, int number)
{
    size_t index;
    while ((index = atomic_fetch_add(&pool->next, 1)) < pool->count)
        pool->item(pool->context, index, number);
}

static void *work(void *argument)
{
    struct worker *self = argument;
    glint_pool *pool = self->pool;
    unsigned long seen = 0;
    pthread_mutex_lock(&pool->mutex);
    for (;;) {
        while (!pool->stop && pool->round == seen)
            pthread_cond_wait(&pool->work, &pool->mutex);
        if (pool->stop)
            break;
        seen = pool->round;
        if (atomic_load(&pool->next) >= pool->count)
            continue; // too late: all items of the round are taken
        pool->busy++;
        pthread_mutex_unlock(&pool->mutex);
        run_items(pool, self->number);
        pthread_mutex_lock(&pool->mutex);
        if (--pool->busy == 0)
            pthread_cond_signal(&pool->done);
    }
    pthread_mutex_unlock(&pool->mutex);
    return NULL;
}

/// Starts workers with all signals blocked, so that the main thread handles signals.
static int start_workers(glint_pool *pool, int threads)
{
    sigset_t all, old;
    pthread_attr_t how;
    if (pthread_attr_init(&how))
        return pool->threads;
    pthread_attr_setstacksize(&how, STACK_BYTES);
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &old);
    while (pool->threads < threads) {
        struct worker *worker = &pool->workers[pool->threads - 1];
        *worker = (struct worker) { .pool = pool, .number = pool->threads };
        if (pthread_create(&worker->thread, &how, work, worker))
            break;
        pool->threads++;
    }
    pthread_sigmask(SIG_SETMASK, &old, NULL);
    pthread_attr_destroy(&how);
    return pool->threads;
}

glint_status glint_pool_create(int threads, glint_pool **out, glint_error *error)
{
    if (threads < 1 || threads > 1024)
        return glint_fail(error, GLINT_ERR_INVALID, "threads: whole number 0 .. 1024 expected, got %d", threads);
    glint_pool *pool = calloc(1, sizeof *pool + (size_t)(threads - 1) * sizeof *pool->workers);
    if (!pool)
        return glint_fail_nomem(error);
    pool->threads = 1;
    pthread_mutex_init(&pool->turn, NULL);
    pthread_mutex_init(&pool->mutex, NULL);
    pthread_cond_init(&pool->work, NULL);
    pthread_cond_init(&pool->done, NULL);
    if (start_workers(pool, threads) < threads) {
        glint_pool_destroy(pool);
        return glint_fail(error, GLINT_ERR_NOMEM,
                          "threads: %d threads could not be started: out of memory, or at the system's limit of threads",
                          threads);
    }
    *out = pool;
    return GLINT_OK;
}

void glint_pool_destroy(glint_pool *pool)
{
    if (!pool)
        return;
    pthread_mutex_lock(&pool->mutex);
    pool->stop = true;
    pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->mutex);
    for (int i = 0; i < pool->threads - 1; i++)
        pthread_join(pool->workers[i].thread, NULL);
    pthread_cond_destroy(&pool->done);
    pthread_cond_destroy(&pool->work);
    pthread_mutex_destroy(&pool->mutex);
    pthread_mutex_destroy(&pool->turn);
    free(pool);
}

int glint_pool_threads(const glint_pool *pool) { return pool->threads; }

void glint_pool_run(glint_pool *pool, size_t count, glint_pool_item *item, void *context)
{
    pthread_mutex_lock(&pool->turn);
    pthread_mutex_lock(&pool->mutex);
    pool->count = count;
    pool->item = item;
    pool->context = context;
    atomic_store(&pool->next, 0);
    pool->round++;
    if (count > 1)
        pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->mutex);
    run_items(pool, 0);
    pthread_mutex_lock(&pool->mutex);
    while (pool->busy)
        pthread_cond_wait(&pool->done, &pool->mutex);
    pthread_mutex_unlock(&pool->mutex);
    pthread_mutex_unlock(&pool->turn);
}

void glint_run_items(glint_pool *pool, size_t count, glint_pool_item *item, void *context)
{
    if (pool && count > 1) {
        glint_pool_run(pool, count, item, context);
        return;
    }
    for (size_t i = 0; i < count; i++)
        item(context, i, 0);
}

int glint_pool_processors(void)
{
#ifdef GLINT_NO_THREADS
    const long count = 1;
#elif defined(__linux__) && !defined(GLINT_PORTABLE)
    cpu_set_t set;
    const long count = sched_getaffinity(0, sizeof set, &set) ? 1 : CPU_COUNT(&set);
#else
    const long count = sysconf(_SC_NPROCESSORS_ONLN);
#endif
    return count < 1 ? 1 : count > 1024 ? 1024 : (int)count;
}
