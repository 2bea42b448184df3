// Requests from the threads of glint watch to its main loop: a changed file, a frame to show, a parameter's value.
#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bindings/watch/watch.h"

bool watch_requests_open(watch_requests *requests, char message[GLINTL_MESSAGE_SIZE])
{
    memset(requests, 0, sizeof *requests);
    requests->wanted = 1;
    if (!glintL_wake_open(&requests->wake))
        return glintL_complain(message, "watch: %s", strerror(errno));
    pthread_mutex_init(&requests->lock, NULL);
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

void watch_requests_close(watch_requests *requests)
{
    glintL_wake_close(&requests->wake);
    watch_free_sets(requests->overrides, requests->override_count);
    free(requests->names);
    pthread_mutex_destroy(&requests->lock);
}

// Notes a request and wakes the loop. The caller holds the lock. A preview is usually not cancelled, because it ends
// soon: otherwise no preview would appear while a slider moves.
static void post(watch_requests *requests, bool cancels_preview)
{
    if (requests->since_ms == 0)
        requests->since_ms = glintL_now_ms();
    if (requests->rendering && (!requests->is_preview || cancels_preview)) {
        glint_renderer_cancel(requests->rendering);
        requests->cancelled = true;
    }
    glintL_wake_call(&requests->wake);
}

void watch_requests_change(void *context, const char *path)
{
    watch_requests *requests = context;
    pthread_mutex_lock(&requests->lock);
    requests->script = true;
    snprintf(requests->changed, sizeof requests->changed, "%s", path);
    atomic_store(&requests->supersedes, true);
    post(requests, true);
    pthread_mutex_unlock(&requests->lock);
}

static void request_frame(void *context, int64_t frame)
{
    watch_requests *requests = context;
    pthread_mutex_lock(&requests->lock);
    requests->frame = requests->frame || frame != requests->wanted;
    if (frame != requests->wanted) {
        requests->wanted = frame;
        post(requests, false);
    }
    pthread_mutex_unlock(&requests->lock);
}

// Replaces the set with the same name, or appends it. False: out of memory.
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
        grown[(*count)++] = (glintL_set) { .name = own };
    grown[at].text = copy;
    grown[at].is_known = is_known;
    return true;
}

void watch_requests_know(watch_requests *requests, char *names)
{
    pthread_mutex_lock(&requests->lock);
    free(requests->names);
    requests->names = names;
    pthread_mutex_unlock(&requests->lock);
}

// Returns the rest of a parameter's line, after "="; NULL: there is no such parameter. The caller holds the lock.
static const char *find_name(const watch_requests *requests, const char *name)
{
    const size_t length = strlen(name);
    const char *at = length && !strchr(name, '\n') ? requests->names : NULL;
    while (at && (at = strstr(at, name)) && !(at[-1] == '\n' && at[length] == '='))
        at += length;
    return at ? at + length + 1 : NULL;
}

// Returns whether a text is one of "a, b or c", to the end of the line.
static bool is_choice(const char *expected, const char *text)
{
    const size_t length = strlen(text);
    for (const char *at = expected; length && (at = strstr(at, text)) && at < expected + strcspn(expected, "\n"); at++)
        if ((at == expected || (at - expected > 1 && memcmp(at - 2, ", ", 2) == 0) || (at - expected > 3 && memcmp(at - 4, " or ", 4) == 0)) &&
            (strchr(",\n", at[length]) || strncmp(at + length, " or ", 4) == 0))
            return true;
    return false;
}

// Returns whether a text is a value of the type and range in the rest of a parameter's line.
static bool is_value(const char *kind, const char *text)
{
    char *end;
    if (*kind == 'b')
        return strcmp(text, "true") == 0 || strcmp(text, "false") == 0;
    if (*kind == 'c')
        return is_choice(strchr(kind, '=') + 1, text);
    if (*kind == 's')
        return true;
    const double least = strtod(kind + 1, &end), most = strtod(end, &end), value = strtod(text, &end);
    return end != text && !*end && isfinite(value) && value >= least && value <= most && (*kind == 'n' || value == floor(value));
}

static watch_answer request_set(void *context, const char *name, const char *text, char *reason, size_t size)
{
    watch_requests *requests = context;
    pthread_mutex_lock(&requests->lock);
    const char *kind = find_name(requests, name);
    const watch_answer answer = !kind ? WATCH_UNKNOWN : is_value(kind, text) ? WATCH_SET : WATCH_WRONG;
    if (answer == WATCH_WRONG) {
        const char *expected = strchr(kind, '=') + 1;
        snprintf(reason, size, "%s: %.*s expected, got '%s'", name, (int)strcspn(expected, "\n"), expected, text);
    } else if (answer == WATCH_SET && put(&requests->overrides, &requests->override_count, name, text, false)) {
        requests->script = true;
        post(requests, false);
    }
    pthread_mutex_unlock(&requests->lock);
    return answer;
}

static void request_reset(void *context)
{
    watch_requests *requests = context;
    pthread_mutex_lock(&requests->lock);
    watch_free_sets(requests->overrides, requests->override_count);
    requests->overrides = NULL;
    requests->override_count = 0;
    requests->script = true;
    post(requests, false);
    pthread_mutex_unlock(&requests->lock);
}

watch_orders watch_requests_orders(watch_requests *requests)
{
    return (watch_orders) { requests, request_frame, request_set, request_reset };
}

bool watch_requests_waiting(watch_requests *requests)
{
    pthread_mutex_lock(&requests->lock);
    bool waiting = requests->script || requests->frame;
    pthread_mutex_unlock(&requests->lock);
    return waiting;
}

bool watch_requests_take(watch_requests *requests, const glintL_run *run, watch_request *out)
{
    struct pollfd wait = { .fd = requests->wake.from, .events = POLLIN };
    while (!watch_requests_waiting(requests)) {
        // A signal between this test and poll() is noticed at the next wake-up, at most a second later.
        if (run->interrupted)
            return false;
        if (poll(&wait, 1, 1000) > 0)
            glintL_wake_clear(&requests->wake);
    }
    pthread_mutex_lock(&requests->lock);
    *out = (watch_request) { .run_again = requests->script, .since_ms = requests->since_ms };
    memcpy(out->changed, requests->changed, sizeof out->changed);
    requests->changed[0] = '\0';
    requests->script = requests->frame = false;
    requests->since_ms = 0;
    atomic_store(&requests->supersedes, false);
    pthread_mutex_unlock(&requests->lock);
    return !run->interrupted;
}

int64_t watch_requests_frame(watch_requests *requests, int64_t last)
{
    pthread_mutex_lock(&requests->lock);
    if (last > 0 && requests->wanted > last)
        requests->wanted = last;
    int64_t wanted = requests->wanted;
    pthread_mutex_unlock(&requests->lock);
    return wanted;
}

void watch_requests_begin_render(watch_requests *requests, glint_renderer *renderer, bool is_preview)
{
    pthread_mutex_lock(&requests->lock);
    requests->rendering = renderer;
    requests->is_preview = is_preview;
    if ((requests->script || requests->frame) && !is_preview) { // requested after the loop last checked
        glint_renderer_cancel(renderer);
        requests->cancelled = true;
    }
    pthread_mutex_unlock(&requests->lock);
}

bool watch_requests_end_render(watch_requests *requests)
{
    pthread_mutex_lock(&requests->lock);
    bool cancelled = requests->cancelled;
    requests->rendering = NULL;
    requests->cancelled = false;
    pthread_mutex_unlock(&requests->lock);
    return cancelled;
}

bool watch_requests_sets(watch_requests *requests, const glintL_set *given, size_t given_count, glintL_set **out,
                         size_t *count)
{
    bool good = true;
    *out = NULL;
    *count = 0;
    pthread_mutex_lock(&requests->lock);
    for (size_t i = 0; i < given_count && good; i++)
        good = put(out, count, given[i].name, given[i].text, false);
    for (size_t i = 0; i < requests->override_count && good; i++) // the script may no longer have the parameter
        good = put(out, count, requests->overrides[i].name, requests->overrides[i].text, true);
    pthread_mutex_unlock(&requests->lock);
    if (!good)
        watch_free_sets(*out, *count);
    return good;
}
