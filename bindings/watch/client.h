/// watch/client.c: one connection to the watch page's server: its request and its output buffer. Used only by the
/// server's thread; nothing blocks. When a function returns false, the client is gone or memory is short, and the
/// caller closes the connection.
#ifndef GLINTL_WATCH_CLIENT_H
#define GLINTL_WATCH_CLIENT_H

#include "bindings/watch/watch.h"

#define WATCH_REQUEST_MAX 8192 ///< head and body together

typedef struct watch_client {
    int socket;
    bool listens; ///< to events
    bool lingers; ///< all is sent; the rest of the request is read, because closing earlier could discard the reply
    double since_ms; ///< time of the connection
    double until_ms; ///< timeout; 0: never
    size_t got, sent, size;
    char request[WATCH_REQUEST_MAX + 1];
    char *reply; ///< owned; `size` bytes, of which `sent` are sent
    watch_picture *picture; ///< sent after the reply; otherwise NULL
} watch_client;

/// Makes a client that owns the socket. NULL: out of memory; the caller still owns the socket.
watch_client *watch_client_create(int socket);
void watch_client_destroy(watch_client *c);

/// Adds a whole reply with `extra` headers. If `body` is NULL, its `size` bytes follow separately.
bool watch_client_reply(watch_client *c, const char *status, const char *type, const char *extra, const char *body,
                        size_t size);
/// Adds a reply whose body is its status.
bool watch_client_say(watch_client *c, const char *status);
/// Subscribes the client to events. The first event is the state, if there is one.
bool watch_client_listen(watch_client *c, const char *state);
/// Adds an event.
bool watch_client_tell(watch_client *c, const char *state);

bool watch_client_writes(const watch_client *c); ///< whether there are unsent bytes
bool watch_client_send(watch_client *c); ///< sends as much as possible without blocking

#endif
