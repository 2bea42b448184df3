/// glint watch: a script rendered again at every save. Private to bindings/.
///
///   watch.c           the loop: runs the script, renders a preview and then the picture in full
///   watch/requests.c      what the other threads request of the loop, and the overrides of parameters
///   watch/files.c     a thread that waits for changes of files; watch_track.lua tells it which
///   watch/client.c    one connection to that server: its request and its output buffer
///   watch/http.c      the server of the page, a thread with a poll loop; watch_page.html is the page
///   watch/picture.c   pictures as PNG in memory, and made small for a terminal
///   watch/terminal.c  pictures in a terminal
///
/// Files, server and terminal know nothing of each other, nor of scripts.
#ifndef GLINT_WATCH_H
#define GLINT_WATCH_H

#include <pthread.h>
#include <stdatomic.h>

#include "bindings/run/system.h"
#include "bindings/run/run.h"

// ---- watch/picture.c ----

typedef struct watch_picture { ///< a PNG file in memory; immutable, of any thread
    atomic_int references;
    int width, height; ///< pixels
    size_t size;
    unsigned char *bytes;
} watch_picture;

/// The beauty pass of a picture as it would be written. NULL: `error` says why.
watch_picture *watch_picture_create(const glint_image *image, const glintL_render *render, glint_error *error);
watch_picture *watch_picture_retain(watch_picture *picture);
void watch_picture_release(watch_picture *picture); ///< NULL: nothing

typedef struct watch_small { ///< a picture of sRGB bytes
    int width, height;
    unsigned char *rgb; ///< owned; rows from the top
} watch_small;

/// Scales a picture to `width` x `height` by means over its linear light. False: out of memory.
bool watch_small_create(const watch_picture *picture, int width, int height, watch_small *out);
/// Writes it to stderr as sixels.
void watch_sixels_put(const watch_small *small);

// ---- watch/files.c ----

typedef struct watch_files watch_files;

/// `changed` is called in a thread of its own, a few milliseconds after the last of a burst of changes; with the path
/// of one of them, borrowed. NULL: `message` says why.
watch_files *watch_files_create(void (*changed)(void *context, const char *path), void *context,
                                char message[GLINTL_MESSAGE_SIZE]);
void watch_files_destroy(watch_files *files);
/// A run begins: what it does not add again is forgotten when it has ended well.
void watch_files_begin(watch_files *files);
void watch_files_end(watch_files *files, bool good);
/// A file is about to be read, whether it is there or not. `optional`: only when its folder is there.
void watch_files_add(watch_files *files, const char *path, bool optional);
/// The script writes this file: its changes are the script's own.
void watch_files_skip(watch_files *files, const char *path);
size_t watch_files_count(watch_files *files);

// ---- watch/http.c ----

typedef struct watch_server watch_server;

/// Requests of the page. Called in the server's thread; the texts are borrowed.
typedef struct watch_orders {
    void *context;
    void (*frame)(void *context, int64_t frame);
    bool (*set)(void *context, const char *name, const char *text); ///< false: the script has no such parameter
    void (*reset)(void *context);
} watch_orders;

/// Serves on 127.0.0.1 only, below a random path. `port` 0: any free port. Returns NULL on failure; `message` says why.
watch_server *watch_server_create(int port, const watch_orders *orders, char message[GLINTL_MESSAGE_SIZE]);
void watch_server_destroy(watch_server *server);
const char *watch_server_url(const watch_server *server);
/// Sends a state (one line of JSON, copied) to every page that listens. `picture` is retained; NULL: the last one stays.
void watch_server_publish(watch_server *server, const char *state, watch_picture *picture);

// ---- watch/terminal.c ----

typedef enum watch_graphics { WATCH_TEXT, WATCH_BLOCKS, WATCH_SIXEL, WATCH_KITTY } watch_graphics;

typedef struct watch_terminal {
    watch_graphics graphics;
    bool full_color, color, is_fresh; ///< is_fresh: nothing is drawn yet
} watch_terminal;

/// Finds out the abilities of stderr's terminal. `name` as in --terminal; NULL: query the terminal.
void watch_terminal_open(watch_terminal *terminal, const char *name, bool color);
void watch_terminal_close(watch_terminal *terminal);
/// Draws a picture with a line below it.
void watch_terminal_draw(watch_terminal *terminal, const watch_picture *picture, const char *line);
void watch_terminal_error(watch_terminal *terminal, const char *message);

// ---- watch/requests.c ----

/// The next things to do, requested by the threads of files and server, and by signals.
typedef struct watch_requests {
    pthread_mutex_t lock;
    glintL_wake wake;
    bool script, frame; ///< the script runs again; another frame is shown
    char changed[GLINTL_PATH_SIZE]; ///< a file that has; "": none
    double since_ms; ///< of the first request that waits
    int64_t wanted; ///< frame to show
    char *names; ///< of the script's parameters, each between two line breaks; owned. NULL: not known yet
    glintL_set *overrides; ///< owned with their texts; of such names alone
    size_t override_count;
    atomic_bool supersedes; ///< the running script is of no use any more
    glint_renderer *rendering; ///< what may be cancelled; else NULL
    bool is_preview, cancelled;
} watch_requests;

bool watch_requests_open(watch_requests *requests, char message[GLINTL_MESSAGE_SIZE]);
void watch_requests_close(watch_requests *requests);
void watch_requests_change(void *requests, const char *path); ///< of watch_files
watch_orders watch_requests_orders(watch_requests *requests);
/// Takes the names of the parameters that the page may set; `names` is owned from then on.
void watch_requests_know(watch_requests *requests, char *names);
typedef struct watch_request {
    bool run_again; ///< the script; else only another frame is shown
    double since_ms; ///< when it was made
    char changed[GLINTL_PATH_SIZE]; ///< the file whose change it is; "": none
} watch_request;

/// Waits for a request, takes it and returns true; false: a signal came.
bool watch_requests_take(watch_requests *requests, const glintL_run *run, watch_request *out);
bool watch_requests_waiting(watch_requests *requests);
int64_t watch_requests_frame(watch_requests *requests, int64_t last); ///< the wanted frame, at most `last`
/// Around a render: a request that comes in cancels it, unless it is a preview that will end soon.
void watch_requests_begin_render(watch_requests *requests, glint_renderer *renderer, bool is_preview);
bool watch_requests_end_render(watch_requests *requests); ///< true: it was cancelled, and its renderer is spent
/// The sets of the command line with the overrides: owned by the caller, with texts of their own. False: out of memory.
bool watch_requests_sets(watch_requests *requests, const glintL_set *given, size_t given_count, glintL_set **out,
                         size_t *count);
void watch_free_sets(glintL_set *sets, size_t count);

#endif
