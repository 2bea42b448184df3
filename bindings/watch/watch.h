/// glint watch: renders a script again at every save. Private to bindings/.
///
///   watch.c           the loop: runs the script, renders a preview and then the full picture
///   watch/requests.c  requests from the other threads to the loop, and overrides of parameters
///   watch/files.c     a thread that waits for changes of files, which watch/track.lua reports to it
///   watch/client.c    one connection to the server: its request and its output buffer
///   watch/http.c      the server of the page, a thread with a poll loop; watch/page.html is the page
///   watch/picture.c   pictures as PNG in memory, and reduced for a terminal
///   watch/terminal.c  pictures in a terminal
///
/// Files, server and terminal do not depend on each other, nor on scripts.
#ifndef GLINT_WATCH_H
#define GLINT_WATCH_H

#include <pthread.h>
#include <stdatomic.h>

#include "bindings/run/system.h"
#include "bindings/run/run.h"

// ---- watch/picture.c ----

typedef struct watch_picture { ///< a PNG file in memory; immutable, usable by any thread
    atomic_int references;
    int width, height; ///< pixels
    size_t size;
    unsigned char *bytes;
} watch_picture;

/// Makes the beauty pass of a picture, as it would be written. NULL: `error` gives the reason.
watch_picture *watch_picture_create(const glint_image *image, const glintL_render *render, glint_error *error);
watch_picture *watch_picture_retain(watch_picture *picture);
void watch_picture_release(watch_picture *picture); ///< NULL: no effect

typedef struct watch_small { ///< a picture of sRGB bytes
    int width, height;
    unsigned char *rgb; ///< owned; top row first
} watch_small;

/// Scales a picture to `width` x `height` by averaging linear light. False: out of memory.
bool watch_small_create(const watch_picture *picture, int width, int height, watch_small *out);
/// Writes the picture to stderr as sixels.
void watch_sixels_put(const watch_small *small);

// ---- watch/files.c ----

typedef struct watch_files watch_files;

/// Starts watching. `changed` is called in a separate thread, a few milliseconds after the last change of a burst, with
/// the path of one changed file, borrowed. NULL: `message` gives the reason.
watch_files *watch_files_create(void (*changed)(void *context, const char *path), void *context,
                                char message[GLINTL_MESSAGE_SIZE]);
void watch_files_destroy(watch_files *files);
/// Begin and end a run. Files that a run does not add again are forgotten when it ends well.
void watch_files_begin(watch_files *files);
void watch_files_end(watch_files *files, bool good);
/// Adds a file that is about to be read, whether or not it exists. `optional`: only if its folder exists.
void watch_files_add(watch_files *files, const char *path, bool optional);
/// Ignores changes of a file, because the script itself writes it.
void watch_files_skip(watch_files *files, const char *path);
size_t watch_files_count(watch_files *files);

// ---- watch/http.c ----

typedef struct watch_server watch_server;

/// Whether a parameter was set.
typedef enum watch_answer { WATCH_SET, WATCH_UNKNOWN, WATCH_WRONG } watch_answer;

/// Requests from the page. Called in the server's thread; the texts are borrowed.
typedef struct watch_orders {
    void *context;
    void (*frame)(void *context, int64_t frame);
    /// Sets a parameter. WATCH_UNKNOWN: the script has no such parameter. WATCH_WRONG: `reason` says what is expected
    watch_answer (*set)(void *context, const char *name, const char *text, char *reason, size_t size);
    void (*reset)(void *context);
} watch_orders;

/// Serves only on 127.0.0.1, below a random path. `port` 0: any free port. Returns NULL on failure; `message` gives the
/// reason.
watch_server *watch_server_create(int port, const watch_orders *orders, char message[GLINTL_MESSAGE_SIZE]);
void watch_server_destroy(watch_server *server);
const char *watch_server_url(const watch_server *server);
/// Sends a state (one line of JSON, copied) to every listening page. `picture` is retained; NULL: keeps the last one.
void watch_server_publish(watch_server *server, const char *state, watch_picture *picture);

// ---- watch/terminal.c ----

typedef enum watch_graphics { WATCH_TEXT, WATCH_BLOCKS, WATCH_SIXEL, WATCH_KITTY } watch_graphics;

typedef struct watch_terminal {
    watch_graphics graphics;
    bool full_color, color, is_fresh; ///< is_fresh: nothing has been drawn yet
} watch_terminal;

/// Detects the abilities of stderr's terminal. `name` as in --terminal; NULL: queries the terminal.
void watch_terminal_open(watch_terminal *terminal, const char *name, bool color);
void watch_terminal_close(watch_terminal *terminal);
/// Draws a picture with a line below it.
void watch_terminal_draw(watch_terminal *terminal, const watch_picture *picture, const char *line);
void watch_terminal_error(watch_terminal *terminal, const char *message);

// ---- watch/requests.c ----

/// Pending requests to the loop, from the threads of files and server, and from signals.
typedef struct watch_requests {
    pthread_mutex_t lock;
    glintL_wake wake;
    bool script, frame; ///< run the script again; show another frame
    char changed[GLINTL_PATH_SIZE]; ///< a changed file; "": none
    double since_ms; ///< time of the first pending request
    int64_t wanted; ///< frame to show
    /// The script's parameters, a line each, after a line break: the name, "=", a letter for the type (n: number, w: whole
    /// number, b: boolean, c: choice, s: other), the least and the largest number, "=", and what is expected; owned. NULL: unknown
    char *names;
    glintL_set *overrides; ///< owned with their texts; only for these names
    size_t override_count;
    atomic_bool supersedes; ///< the running script's result is no longer needed
    glint_renderer *rendering; ///< the render that may be cancelled; otherwise NULL
    bool is_preview, cancelled;
} watch_requests;

bool watch_requests_open(watch_requests *requests, char message[GLINTL_MESSAGE_SIZE]);
void watch_requests_close(watch_requests *requests);
void watch_requests_change(void *requests, const char *path); ///< callback for watch_files
watch_orders watch_requests_orders(watch_requests *requests);
/// Sets the list of the parameters that the page may set; takes over `names`.
void watch_requests_know(watch_requests *requests, char *names);
typedef struct watch_request {
    bool run_again; ///< run the script; otherwise only another frame is shown
    double since_ms; ///< time of the request
    char changed[GLINTL_PATH_SIZE]; ///< the changed file; "": none
} watch_request;

/// Waits for a request, takes it and returns true. False: a signal arrived.
bool watch_requests_take(watch_requests *requests, const glintL_run *run, watch_request *out);
bool watch_requests_waiting(watch_requests *requests);
int64_t watch_requests_frame(watch_requests *requests, int64_t last); ///< the wanted frame, at most `last`
/// Call these around a render. A new request cancels the render, unless it is a preview, which ends soon.
void watch_requests_begin_render(watch_requests *requests, glint_renderer *renderer, bool is_preview);
bool watch_requests_end_render(watch_requests *requests); ///< true: it was cancelled, and its renderer is unusable
/// Returns the command line's sets with the overrides applied: owned by the caller, with copied texts. False: out of
/// memory.
bool watch_requests_sets(watch_requests *requests, const glintL_set *given, size_t given_count, glintL_set **out,
                         size_t *count);
void watch_free_sets(glintL_set *sets, size_t count);

#endif
