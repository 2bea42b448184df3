// The progress bar: one line on a terminal, drawn by a separate thread so that it moves during a long frame.
#include <inttypes.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "bindings/command/cli.h"
#include "bindings/run/system.h"

#define BAR_WIDTH 24
#define BAR_LEAST 4 // a narrower bar is not drawn
#define TEXT_SIZE 160
#define INTERVAL_MS 100
#define DELAY_MS 300 // a shorter run shows no bar

struct cli_progress {
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    bool stops, is_drawn, color;
    double start_ms;
    int64_t done, kept, todo; // numbers of frames; todo 0: unknown
    char what[80]; // name of the step of a study, or of a film; "": the bar counts frames
    glintL_step refined; // the last step of the current frame; number 0: none
    double done_ms, step_ms, remaining_ms;
    double film_ms; // start time of the film
    glint_renderer *renderer; // the renderer while it renders, otherwise NULL
};

static void format_time(char out[32], double seconds)
{
    int64_t whole = seconds < 1e9 ? (int64_t)(seconds + 0.5) : 0;
    if (whole >= 3600)
        snprintf(out, 32, "%" PRId64 ":%02d:%02d", whole / 3600, (int)(whole / 60 % 60), (int)(whole % 60));
    else
        snprintf(out, 32, "%d:%02d", (int)(whole / 60), (int)(whole % 60));
}

// Draws one line: the bar, as wide as fits the terminal, and the text. A longer line would wrap.
static void draw_line(cli_progress *progress, double share, const char *text)
{
    char bar[BAR_WIDTH + 1];
    struct winsize size = { 0 };
    const int columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
    int width = columns - (int)strlen(text) - 4; // for brackets, a space, and the last column, which stays empty
    width = width < BAR_WIDTH ? width : BAR_WIDTH;
    share = share < 1 ? share : 1;
    fputs("\r\033[K", stderr);
    if (width >= BAR_LEAST) {
        memset(bar, '.', (size_t)width);
        memset(bar, '#', (size_t)(share * width));
        bar[width] = '\0';
        fprintf(stderr, "%s[%s]%s ", progress->color ? "\033[36m" : "", bar, progress->color ? "\033[0m" : "");
    }
    glintL_put_text(stderr, text, strnlen(text, (size_t)(columns - 1)));
    fflush(stderr);
    progress->is_drawn = true;
}

static void draw_step(cli_progress *progress)
{
    char remaining[32], text[TEXT_SIZE];
    double now = progress->renderer ? glint_renderer_progress(progress->renderer) : 0;
    double done_ms = progress->done_ms + now * progress->step_ms;
    double remaining_ms = progress->remaining_ms + (1 - now) * progress->step_ms;
    format_time(remaining, remaining_ms * 1e-3);
    snprintf(text, sizeof text, "%s%s%s%s", progress->what, remaining_ms > 0 ? ", " : "",
             remaining_ms > 0 ? remaining : "", remaining_ms > 0 ? " left" : "");
    draw_line(progress, done_ms + remaining_ms > 0 ? done_ms / (done_ms + remaining_ms) : 0, text);
}

// The caller holds the lock.
static void draw(cli_progress *progress)
{
    char remaining[32] = "", total[32] = "", samples[64] = "", text[TEXT_SIZE];
    double elapsed = (glintL_now_ms() - progress->start_ms) * 1e-3;
    double now = progress->renderer ? glint_renderer_progress(progress->renderer) : 0;
    double fresh = (double)(progress->done - progress->kept) + now; // kept frames say nothing about the speed
    double rate = elapsed > 0 ? fresh / elapsed : 0, share = now;
    if (progress->todo > 0) {
        share = ((double)progress->done + now) / (double)progress->todo;
        snprintf(total, sizeof total, "/%" PRId64, progress->todo);
    }
    if (rate > 0 && progress->todo > 0)
        format_time(remaining, ((double)progress->todo - (double)progress->done - now) / rate);
    if (progress->refined.number > 0)
        snprintf(samples, sizeof samples, ", step %d, %.0f samples, %.1f s: error %.2g", progress->refined.number,
                 progress->refined.samples, progress->refined.ms * 1e-3, progress->refined.error);
    snprintf(text, sizeof text, "%" PRId64 "%s frames, %.*f/s%s%s%s%s%s", progress->done, total, rate < 10 ? 2 : 0, rate,
             *remaining ? ", " : "", remaining, *remaining ? " left" : "", samples,
             progress->renderer ? "" : ", in the script");
    draw_line(progress, share, text);
}

static void *draw_until_stopped(void *argument)
{
    cli_progress *progress = argument;
    struct timespec until;
    pthread_mutex_lock(&progress->lock);
    while (!progress->stops) {
        clock_gettime(GLINTL_COND_CLOCK, &until);
        until.tv_nsec += INTERVAL_MS * 1000000L;
        until.tv_sec += until.tv_nsec / 1000000000L;
        until.tv_nsec %= 1000000000L;
        pthread_cond_timedwait(&progress->wake, &progress->lock, &until);
        if (progress->stops || glintL_now_ms() - progress->start_ms <= DELAY_MS)
            continue;
        if (*progress->what)
            draw_step(progress);
        else
            draw(progress);
    }
    pthread_mutex_unlock(&progress->lock);
    return NULL;
}

cli_progress *cli_progress_create(bool color)
{
    const char *term = getenv("TERM");
    sigset_t stops, before;
    if (!isatty(STDERR_FILENO) || !term || strcmp(term, "dumb") == 0)
        return NULL;
    cli_progress *progress = calloc(1, sizeof *progress);
    if (!progress)
        return NULL;
    progress->color = color;
    progress->start_ms = glintL_now_ms();
    pthread_mutex_init(&progress->lock, NULL);
    glintL_cond_init(&progress->wake);
    sigemptyset(&stops); // the main thread handles these
    sigaddset(&stops, SIGINT);
    sigaddset(&stops, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &stops, &before);
    int failed = pthread_create(&progress->thread, NULL, draw_until_stopped, progress);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (!failed)
        return progress;
    pthread_cond_destroy(&progress->wake);
    pthread_mutex_destroy(&progress->lock);
    free(progress);
    return NULL;
}

// The caller holds the lock.
static void clear(cli_progress *progress)
{
    if (progress->is_drawn)
        fputs("\r\033[K", stderr);
    progress->is_drawn = false;
}

void cli_progress_destroy(cli_progress *progress)
{
    if (!progress)
        return;
    pthread_mutex_lock(&progress->lock);
    progress->stops = true;
    clear(progress);
    pthread_cond_signal(&progress->wake);
    pthread_mutex_unlock(&progress->lock);
    pthread_join(progress->thread, NULL);
    pthread_cond_destroy(&progress->wake);
    pthread_mutex_destroy(&progress->lock);
    free(progress);
}

void cli_progress_update(cli_progress *progress, const glintL_run *run, bool rendering)
{
    pthread_mutex_lock(&progress->lock);
    if (progress->done != run->done)
        progress->refined.number = 0;
    progress->done = run->done;
    progress->kept = run->kept;
    progress->todo = run->todo;
    progress->renderer = rendering ? run->renderer : NULL;
    pthread_mutex_unlock(&progress->lock);
}

void cli_progress_samples(cli_progress *progress, const glintL_step *step)
{
    pthread_mutex_lock(&progress->lock);
    progress->refined = *step;
    pthread_mutex_unlock(&progress->lock);
}

void cli_progress_step(cli_progress *progress, const char *what, double done_ms, double step_ms, double remaining_ms)
{
    pthread_mutex_lock(&progress->lock);
    snprintf(progress->what, sizeof progress->what, "%s", what);
    progress->done_ms = done_ms;
    progress->step_ms = step_ms;
    progress->remaining_ms = remaining_ms > 0 ? remaining_ms : 0;
    pthread_mutex_unlock(&progress->lock);
}

void cli_progress_film(cli_progress *progress, const char *film, size_t done, size_t count)
{
    pthread_mutex_lock(&progress->lock);
    if (!film)
        clear(progress);
    if (!film || done == 0)
        progress->film_ms = glintL_now_ms();
    progress->renderer = NULL;
    progress->step_ms = 0;
    progress->done_ms = glintL_now_ms() - progress->film_ms;
    progress->remaining_ms = done ? progress->done_ms / (double)done * (double)(count - done) : 0;
    progress->what[0] = '\0';
    if (film)
        snprintf(progress->what, sizeof progress->what, "%s %.60s", done < count ? "making" : "finishing", film);
    pthread_mutex_unlock(&progress->lock);
}

void cli_progress_watch(cli_progress *progress, glint_renderer *renderer)
{
    pthread_mutex_lock(&progress->lock);
    progress->renderer = renderer;
    pthread_mutex_unlock(&progress->lock);
}

void cli_progress_clear(cli_progress *progress)
{
    pthread_mutex_lock(&progress->lock);
    clear(progress);
    pthread_mutex_unlock(&progress->lock);
}
