// One connection to the watch page's server: its unsent bytes and its timeouts.
#include "bindings/watch/client.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define REQUEST_MS 5000 // time limit for receiving a request
#define REPLY_MS 30000 // time limit for sending a reply
#define LINGER_MS 1000
#define BACKLOG_MAX (1 << 20) // unread events beyond this size close the connection
#define SECRECY \
    "Cache-Control: no-store\r\nReferrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\n" \
    "Cross-Origin-Resource-Policy: same-origin\r\n"

watch_client *watch_client_create(int socket)
{
    watch_client *c = calloc(1, sizeof *c);
    if (!c)
        return NULL;
    c->socket = socket;
    c->since_ms = glintL_now_ms();
    c->until_ms = c->since_ms + REQUEST_MS;
    return c;
}

void watch_client_destroy(watch_client *c)
{
    close(c->socket);
    free(c->reply);
    watch_picture_release(c->picture);
    free(c);
}

// Appends bytes to the output buffer. Returns false when out of memory.
static bool add_bytes(watch_client *c, const char *bytes, size_t size)
{
    if (c->sent == c->size)
        c->sent = c->size = 0;
    char *grown = realloc(c->reply, c->size + size);
    if (!grown)
        return false;
    c->reply = grown;
    memcpy(grown + c->size, bytes, size);
    c->size += size;
    return true;
}

bool watch_client_reply(watch_client *c, const char *status, const char *type, const char *extra, const char *body,
                        size_t size)
{
    char head[1024];
    int length = snprintf(head, sizeof head,
                          "HTTP/1.1 %s\r\nContent-Type: %s\r\nContent-Length: %zu\r\n%s%sConnection: close\r\n\r\n",
                          status, type, size, extra, SECRECY);
    c->until_ms = glintL_now_ms() + REPLY_MS;
    return add_bytes(c, head, (size_t)length) && (!body || add_bytes(c, body, size));
}

bool watch_client_say(watch_client *c, const char *status)
{
    return watch_client_reply(c, status, "text/plain; charset=utf-8", "", status, strlen(status));
}

bool watch_client_listen(watch_client *c, const char *state)
{
    static const char head[] =
        "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\n" SECRECY "Connection: close\r\n\r\nretry: 1000\n\n";
    c->listens = true;
    c->until_ms = 0;
    return add_bytes(c, head, sizeof head - 1) && (!state || watch_client_tell(c, state));
}

bool watch_client_tell(watch_client *c, const char *state)
{
    return c->size - c->sent <= BACKLOG_MAX && add_bytes(c, "data: ", 6) && add_bytes(c, state, strlen(state)) &&
           add_bytes(c, "\n\n", 2);
}

static bool linger(watch_client *c)
{
    c->lingers = true;
    c->until_ms = glintL_now_ms() + LINGER_MS;
    return shutdown(c->socket, SHUT_WR) == 0;
}

bool watch_client_writes(const watch_client *c) { return !c->lingers && (c->sent < c->size || c->picture); }

bool watch_client_send(watch_client *c)
{
    if (c->lingers)
        return true;
    while (c->sent < c->size || c->picture) {
        size_t body = c->picture ? c->picture->size : 0, from_body = c->sent > c->size ? c->sent - c->size : 0;
        const void *at =
            c->sent < c->size ? (const void *)(c->reply + c->sent) : (const void *)(c->picture->bytes + from_body);
        size_t left = c->sent < c->size ? c->size - c->sent : body - from_body;
        if (left == 0)
            return linger(c); // the whole picture is sent
        ssize_t sent = send(c->socket, at, left, MSG_NOSIGNAL);
        if (sent < 0)
            return errno == EAGAIN || errno == EINTR;
        c->sent += (size_t)sent;
    }
    return c->listens || c->size == 0 || linger(c); // other replies end the connection
}
