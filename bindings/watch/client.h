/// watch/client.c: one connection to the watch page's server: its request and its output buffer. Used only by the server's
/// thread; nothing blocks. After false, the caller closes the connection: the client is gone, or memory is.
#ifndef GLINTL_WATCH_CLIENT_H
#define GLINTL_WATCH_CLIENT_H

#include "bindings/watch/watch.h"

#define WATCH_REQUEST_MAX 8192 ///< head and body together

typedef struct watch_client {
    int socket;
    bool listens; ///< to events
    bool lingers; ///< all is sent; what still comes is read, or closing would take the reply away
    double since_ms; ///< when it came
    double until_ms; ///< when it is given up; 0: never
    size_t got, sent, size;
    char request[WATCH_REQUEST_MAX + 1];
    char *reply; ///< owned; `size` bytes, `sent` of them gone
    watch_picture *picture; ///< sent after the reply; else NULL
} watch_client;

/// Owns the socket from then on. NULL: out of memory; the socket is the caller's.
watch_client *watch_client_create(int socket);
void watch_client_destroy(watch_client *c);

/// Adds a whole reply, with `extra` headers; its body of `size` bytes follows by itself where it is NULL here.
bool watch_client_reply(watch_client *c, const char *status, const char *type, const char *extra, const char *body,
                        size_t size);
/// A reply whose body is its status.
bool watch_client_say(watch_client *c, const char *status);
/// Makes it listen to events; the state, if any, is the first.
bool watch_client_listen(watch_client *c, const char *state);
/// Adds an event.
bool watch_client_tell(watch_client *c, const char *state);

bool watch_client_writes(const watch_client *c); ///< whether anything waits to be sent
bool watch_client_send(watch_client *c); ///< as much as it takes now

#endif
