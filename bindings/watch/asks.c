// What the threads of glint watch ask of its loop: a changed file, a frame to show, a parameter's value.
#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "bindings/watch/watch.h"

bool watch_asks_open(watch_asks *asks, char message[GLINTL_MESSAGE_SIZE])
{
    memset(asks, 0, sizeof *asks);
    asks->wanted = 1;
    asks->wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (asks->wake < 0) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "watch: eventfd: %s", strerror(errno));
        return false;
    }
    pthread_mutex_init(&asks->lock, NULL);
    return true;
}

void watch_free_sets(glintL_set *sets, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        free((char *)sets[i].name);
        free((char *)sets[i].text);
    }
    free(sets);
}

void watch_asks_close(watch_asks *asks)
{
    close(asks->wake);
    watch_free_sets(asks->overrides, asks->override_count);
    pthread_mutex_destroy(&asks->lock);
}

// The lock is held. A preview ends soon, and showing it beats never showing any while a slider moves.
static void ask(watch_asks *asks, bool cancels_preview)
{
    uint64_t one = 1;
    if (asks->since_ms == 0)
        asks->since_ms = glintL_now_ms();
    if (asks->rendering && (!asks->is_preview || cancels_preview)) {
        glint_renderer_cancel(asks->rendering);
        asks->cancelled = true;
    }
    if (write(asks->wake, &one, sizeof one) < 0)
        return; // the counter is full: it is awake
}

void watch_asks_change(void *context, const char *path)
{
    watch_asks *asks = context;
    pthread_mutex_lock(&asks->lock);
    asks->script = true;
    snprintf(asks->changed, sizeof asks->changed, "%s", path);
    atomic_store(&asks->supersedes, true);
    ask(asks, true);
    pthread_mutex_unlock(&asks->lock);
}

static void ask_frame(void *context, int64_t frame)
{
    watch_asks *asks = context;
    pthread_mutex_lock(&asks->lock);
    asks->frame = asks->frame || frame != asks->wanted;
    if (frame != asks->wanted) {
        asks->wanted = frame;
        ask(asks, false);
    }
    pthread_mutex_unlock(&asks->lock);
}

// Puts a set in the place of one of the same name, or behind. False: out of memory.
static bool put(glintL_set **sets, size_t *count, const char *name, const char *text, bool is_known)
{
    size_t at = 0;
    while (at < *count && strcmp((*sets)[at].name, name) != 0)
        at++;
    char *copy = strdup(text), *own = at < *count ? NULL : strdup(name);
    glintL_set *grown = at < *count ? *sets : realloc(*sets, (at + 1) * sizeof *grown);
    if (grown)
        *sets = grown;
    if (!copy || !grown || (at == *count && !own)) {
        free(copy);
        free(own);
        return false;
    }
    if (at < *count)
        free((char *)grown[at].text);
    else
        grown[(*count)++].name = own;
    grown[at].text = copy;
    grown[at].is_known = is_known;
    return true;
}

static void ask_set(void *context, const char *name, const char *text)
{
    watch_asks *asks = context;
    pthread_mutex_lock(&asks->lock);
    if (put(&asks->overrides, &asks->override_count, name, text, false)) {
        asks->script = true;
        ask(asks, false);
    }
    pthread_mutex_unlock(&asks->lock);
}

static void ask_reset(void *context)
{
    watch_asks *asks = context;
    pthread_mutex_lock(&asks->lock);
    watch_free_sets(asks->overrides, asks->override_count);
    asks->overrides = NULL;
    asks->override_count = 0;
    asks->script = true;
    ask(asks, false);
    pthread_mutex_unlock(&asks->lock);
}

watch_orders watch_asks_orders(watch_asks *asks) { return (watch_orders) { asks, ask_frame, ask_set, ask_reset }; }

bool watch_asks_waiting(watch_asks *asks)
{
    pthread_mutex_lock(&asks->lock);
    bool waiting = asks->script || asks->frame;
    pthread_mutex_unlock(&asks->lock);
    return waiting;
}

bool watch_asks_take(watch_asks *asks, const glintL_run *run, watch_ask *out)
{
    struct pollfd wait = { .fd = asks->wake, .events = POLLIN };
    uint64_t count;
    while (!watch_asks_waiting(asks)) {
        // A signal between the test and poll() is seen at the next wake, a second later at most.
        if (run->interrupted)
            return false;
        if (poll(&wait, 1, 1000) > 0 && read(asks->wake, &count, sizeof count) < 0 && errno != EAGAIN)
            return false;
    }
    pthread_mutex_lock(&asks->lock);
    *out = (watch_ask) { .run_again = asks->script, .since_ms = asks->since_ms };
    memcpy(out->changed, asks->changed, sizeof out->changed);
    asks->changed[0] = '\0';
    asks->script = asks->frame = false;
    asks->since_ms = 0;
    atomic_store(&asks->supersedes, false);
    pthread_mutex_unlock(&asks->lock);
    return !run->interrupted;
}

int64_t watch_asks_frame(watch_asks *asks, int64_t last)
{
    pthread_mutex_lock(&asks->lock);
    if (last > 0 && asks->wanted > last)
        asks->wanted = last;
    int64_t wanted = asks->wanted;
    pthread_mutex_unlock(&asks->lock);
    return wanted;
}

void watch_asks_begin_render(watch_asks *asks, glint_renderer *renderer, bool is_preview)
{
    pthread_mutex_lock(&asks->lock);
    asks->rendering = renderer;
    asks->is_preview = is_preview;
    if ((asks->script || asks->frame) && !is_preview) { // asked since the loop looked
        glint_renderer_cancel(renderer);
        asks->cancelled = true;
    }
    pthread_mutex_unlock(&asks->lock);
}

bool watch_asks_end_render(watch_asks *asks)
{
    pthread_mutex_lock(&asks->lock);
    bool cancelled = asks->cancelled;
    asks->rendering = NULL;
    asks->cancelled = false;
    pthread_mutex_unlock(&asks->lock);
    return cancelled;
}

bool watch_asks_sets(watch_asks *asks, const glintL_set *given, size_t given_count, glintL_set **out, size_t *count)
{
    bool good = true;
    *out = NULL;
    *count = 0;
    pthread_mutex_lock(&asks->lock);
    for (size_t i = 0; i < given_count && good; i++)
        good = put(out, count, given[i].name, given[i].text, false);
    for (size_t i = 0; i < asks->override_count && good; i++) // the script may have lost the parameter since
        good = put(out, count, asks->overrides[i].name, asks->overrides[i].text, true);
    pthread_mutex_unlock(&asks->lock);
    if (!good)
        watch_free_sets(*out, *count);
    return good;
}
