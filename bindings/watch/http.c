// The server of the watch page: one poll() loop over a few non-blocking sockets, only on 127.0.0.1.
//
//   GET  /TOKEN/            the page
//   GET  /TOKEN/events      server-sent events: the state, at once and whenever it changes
//   GET  /TOKEN/picture     the last good picture, PNG; the text after '?' only distinguishes pictures
//   POST /TOKEN/frame       body: the number of the frame to show
//   POST /TOKEN/set         body: name=value, in the syntax of --set, for a parameter of the script
//   POST /TOKEN/reset       resets the parameters to their values on the command line
//
// Anything else is 404. The token is random, so that other users and pages of other sites cannot guess it.
#include <arpa/inet.h>
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bindings/watch/client.h"

#define CLIENTS_MAX 32
#define TOKEN_SIZE 33
#define POLICY \
    "Content-Security-Policy: default-src 'self'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; " \
    "frame-ancestors 'none'\r\n"

static const char page[] = {
#include "bindings/watch/page.html.h"
};

struct watch_server {
    pthread_t thread;
    pthread_mutex_t lock; // protects state, version, picture and stops
    int listener;
    glintL_wake wake;
    bool stops;
    char token[TOKEN_SIZE], host[32], url[96];
    watch_orders orders;
    char *state; // owned
    unsigned version, sent_version; // version of the state; sent_version is used only by the thread
    watch_picture *picture;
    watch_client *clients[CLIENTS_MAX];
    int count;
};

// ---- Replies ----

static void close_client(watch_server *server, int i)
{
    watch_client_destroy(server->clients[i]);
    server->clients[i] = server->clients[--server->count];
}

static bool begin_events(watch_server *server, watch_client *c)
{
    pthread_mutex_lock(&server->lock);
    const bool good = watch_client_listen(c, server->state);
    pthread_mutex_unlock(&server->lock);
    return good;
}

static bool reply_picture(watch_server *server, watch_client *c)
{
    pthread_mutex_lock(&server->lock);
    c->picture = server->picture ? watch_picture_retain(server->picture) : NULL;
    pthread_mutex_unlock(&server->lock);
    return c->picture ? watch_client_reply(c, "200 OK", "image/png", "", NULL, c->picture->size)
                      : watch_client_say(c, "404 Not Found");
}

// ---- Requests ----

// Compares in constant time, so that the time does not reveal how much was right.
static bool same_token(const char *text, const char *token)
{
    unsigned char difference = 0;
    for (int i = 0; i < TOKEN_SIZE - 1; i++) {
        difference |= (unsigned char)(text[i] ^ token[i]);
        if (!text[i])
            return false;
    }
    return difference == 0;
}

// Returns the value of a header, up to "\r
// ", or NULL.
static const char *header(const char *head, const char *name)
{
    size_t length = strlen(name);
    for (const char *line = strstr(head, "\r\n"); line; line = strstr(line, "\r\n")) {
        line += 2;
        if (strncasecmp(line, name, length) == 0 && line[length] == ':')
            return line + length + 1 + strspn(line + length + 1, " ");
    }
    return NULL;
}

// Returns whether a header appears more than once.
static bool is_repeated(const char *head, const char *name)
{
    const char *first = header(head, name);
    return first && header(first, name);
}

static bool is_own_name(const watch_server *server, const char *host)
{
    const char *port = strchr(server->host, ':');
    const size_t length = strcspn(host, "\r\n");
    return (length == strlen(server->host) && strncmp(host, server->host, length) == 0) ||
           (length == 9 + strlen(port) && strncmp(host, "localhost", 9) == 0 &&
            strncmp(host + 9, port, length - 9) == 0);
}

// Rejects another site's host name that resolves to this machine, and pages from another origin.
static bool is_own_page(const watch_server *server, const char *head)
{
    const char *host = header(head, "Host"), *origin = header(head, "Origin");
    return host && is_own_name(server, host) &&
           (!origin || (strncmp(origin, "http://", 7) == 0 && is_own_name(server, origin + 7)));
}

static bool take_order(watch_server *server, watch_client *c, const char *what, char *body)
{
    const watch_orders *orders = &server->orders;
    if (strcmp(what, "frame") == 0) {
        char *end;
        long long frame = strtoll(body, &end, 10);
        if (end == body || *end || frame < 1 || frame > GLINTL_FRAMES_MAX)
            return watch_client_say(c, "400 Bad Request");
        orders->frame(orders->context, frame);
    } else if (strcmp(what, "set") == 0) {
        char *equals = strchr(body, '=');
        if (!equals)
            return watch_client_say(c, "400 Bad Request");
        *equals = '\0';
        char reason[256];
        const watch_answer answer = orders->set(orders->context, body, equals + 1, reason, sizeof reason);
        if (answer == WATCH_WRONG)
            return watch_client_reply(c, "400 Bad Request", "text/plain; charset=utf-8", "", reason, strlen(reason));
        if (answer == WATCH_UNKNOWN)
            return watch_client_say(c, "404 Not Found");
    } else if (strcmp(what, "reset") == 0) {
        orders->reset(orders->context);
    } else {
        return watch_client_say(c, "404 Not Found");
    }
    return watch_client_say(c, "200 OK");
}

// Answers a complete request. False: close the client.
static bool answer(watch_server *server, watch_client *c, char *body)
{
    char *path = strchr(c->request, ' '), *end = path ? strpbrk(path + 1, " \r\n") : NULL;
    if (!path || !end || *end != ' ')
        return watch_client_say(c, "400 Bad Request");
    if (!header(c->request, "Host") || is_repeated(c->request, "Host") || is_repeated(c->request, "Origin") ||
        is_repeated(c->request, "Content-Length"))
        return watch_client_say(c, "400 Bad Request");
    if (!is_own_page(server, c->request))
        return watch_client_say(c, "403 Forbidden");
    *path++ = *end = '\0';
    char *query = strchr(path, '?');
    if (query)
        *query = '\0';
    if (path[0] != '/' || !same_token(path + 1, server->token) || path[TOKEN_SIZE] != '/')
        return watch_client_say(c, "404 Not Found");
    path += TOKEN_SIZE + 1;
    if (strcmp(c->request, "POST") == 0)
        return take_order(server, c, path, body);
    if (strcmp(c->request, "GET") != 0)
        return watch_client_say(c, "405 Method Not Allowed");
    if (!*path)
        return watch_client_reply(c, "200 OK", "text/html; charset=utf-8", POLICY, page, sizeof page);
    if (strcmp(path, "events") == 0)
        return begin_events(server, c);
    if (strcmp(path, "picture") == 0)
        return reply_picture(server, c);
    return watch_client_say(c, "404 Not Found");
}

// Answers when the whole request has arrived. False: close the client.
static bool take_request(watch_server *server, watch_client *c)
{
    c->request[c->got] = '\0';
    char *head_end = strstr(c->request, "\r\n\r\n");
    if (!head_end)
        return c->got < WATCH_REQUEST_MAX && strlen(c->request) == c->got;
    head_end[2] = '\0'; // search for headers only in the head
    const char *length_text = header(c->request, "Content-Length");
    unsigned long length = length_text ? strtoul(length_text, NULL, 10) : 0;
    char *body = head_end + 4;
    if (length > (unsigned long)(c->request + WATCH_REQUEST_MAX - body))
        return watch_client_say(c, "413 Content Too Large");
    if ((unsigned long)(c->request + c->got - body) < length) {
        head_end[2] = '\r';
        return true;
    }
    body[length] = '\0';
    return answer(server, c, body);
}

// ---- Sockets; false: close the client ----

static bool read_client(watch_server *server, watch_client *c)
{
    char ignored[256];
    bool answered = c->size > 0 || c->listens;
    ssize_t got = answered ? recv(c->socket, ignored, sizeof ignored, 0)
                           : recv(c->socket, c->request + c->got, WATCH_REQUEST_MAX - c->got, 0);
    if (got <= 0)
        return got < 0 && (errno == EAGAIN || errno == EINTR);
    if (answered)
        return true;
    c->got += (size_t)got;
    return take_request(server, c);
}

// Returns the priority of a client: lowest if its reply is sent, then if it has requested nothing.
static int worth(const watch_client *c) { return c->lingers ? 0 : c->size == 0 ? 1 : c->listens ? 2 : 3; }

// Makes space for one more client: closes the one with the lowest priority, among equals the oldest.
static void make_room(watch_server *server)
{
    int least = 0;
    for (int i = 1; i < server->count; i++) {
        const watch_client *c = server->clients[i], *other = server->clients[least];
        if (worth(c) < worth(other) || (worth(c) == worth(other) && c->since_ms < other->since_ms))
            least = i;
    }
    if (server->count == CLIENTS_MAX)
        close_client(server, least);
}

static void accept_client(watch_server *server)
{
    int socket = glintL_accept(server->listener);
    if (socket < 0)
        return;
    make_room(server);
    watch_client *c = watch_client_create(socket);
    if (c)
        server->clients[server->count++] = c;
    else
        close(socket);
}

// Sends a new state to all listeners. False: the server ends.
static bool take_state(watch_server *server)
{
    pthread_mutex_lock(&server->lock);
    bool goes_on = !server->stops;
    bool is_new = server->version != server->sent_version;
    server->sent_version = server->version;
    for (int i = server->count - 1; i >= 0 && is_new; i--) {
        watch_client *c = server->clients[i];
        if (c->listens && !watch_client_tell(c, server->state))
            close_client(server, i);
    }
    pthread_mutex_unlock(&server->lock);
    return goes_on;
}

static int fill_poll(const watch_server *server, struct pollfd *list)
{
    int timeout = -1;
    double now = glintL_now_ms();
    list[0] = (struct pollfd) { .fd = server->wake.from, .events = POLLIN };
    list[1] = (struct pollfd) { .fd = server->listener, .events = POLLIN };
    for (int i = 0; i < server->count; i++) {
        const watch_client *c = server->clients[i];
        const bool writes = watch_client_writes(c);
        list[2 + i] = (struct pollfd) { .fd = c->socket, .events = (short)(POLLIN | (writes ? POLLOUT : 0)) };
        int left = c->until_ms > 0 ? (int)(c->until_ms - now) + 1 : -1;
        if (c->until_ms > 0 && (timeout < 0 || left < timeout))
            timeout = left > 0 ? left : 0;
    }
    return timeout;
}

static void *serve(void *argument)
{
    watch_server *server = argument;
    struct pollfd list[2 + CLIENTS_MAX];
    while (take_state(server)) {
        for (int i = server->count - 1; i >= 0; i--) { // sends as much as possible at once
            watch_client *c = server->clients[i];
            if (!watch_client_send(c) || (c->until_ms > 0 && glintL_now_ms() > c->until_ms))
                close_client(server, i);
        }
        int timeout = fill_poll(server, list), polled = server->count;
        if (poll(list, (nfds_t)(2 + polled), timeout) < 0)
            continue;
        if (list[0].revents)
            glintL_wake_clear(&server->wake);
        for (int i = polled - 1; i >= 0; i--)
            if (list[2 + i].revents && !read_client(server, server->clients[i]))
                close_client(server, i);
        if (list[1].revents)
            accept_client(server);
    }
    return NULL;
}

// ---- Opening and closing ----

static bool open_listener(watch_server *server, int port, char *message)
{
    struct sockaddr_in address = { .sin_family = AF_INET, .sin_port = htons((uint16_t)port) };
    socklen_t size = sizeof address;
    int yes = 1;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    server->listener = glintL_socket(AF_INET, SOCK_STREAM);
    if (server->listener >= 0)
        setsockopt(server->listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (server->listener >= 0 && bind(server->listener, (void *)&address, sizeof address) == 0 &&
        listen(server->listener, CLIENTS_MAX) == 0 && getsockname(server->listener, (void *)&address, &size) == 0) {
        snprintf(server->host, sizeof server->host, "127.0.0.1:%d", ntohs(address.sin_port));
        return true;
    }
    return glintL_complain(message, "--http: port %d: %s%s", port, strerror(errno),
                           errno == EADDRINUSE ? "; --http without a number takes any free port" : "");
}

static bool make_token(watch_server *server)
{
    unsigned char random[(TOKEN_SIZE - 1) / 2];
    if (!glintL_random(random, sizeof random))
        return false;
    for (size_t i = 0; i < sizeof random; i++)
        snprintf(server->token + 2 * i, 3, "%02x", random[i]);
    snprintf(server->url, sizeof server->url, "http://%s/%s/", server->host, server->token);
    return true;
}

static void free_server(watch_server *server)
{
    while (server->count > 0)
        close_client(server, server->count - 1);
    if (server->listener >= 0)
        close(server->listener);
    glintL_wake_close(&server->wake);
    free(server->state);
    watch_picture_release(server->picture);
    pthread_mutex_destroy(&server->lock);
    free(server);
}

watch_server *watch_server_create(int port, const watch_orders *orders, char message[GLINTL_MESSAGE_SIZE])
{
    sigset_t all, before;
    watch_server *server = calloc(1, sizeof *server);
    snprintf(message, GLINTL_MESSAGE_SIZE, "out of memory");
    if (!server)
        return NULL;
    server->listener = -1;
    server->orders = *orders;
    pthread_mutex_init(&server->lock, NULL);
    if (!open_listener(server, port, message) || !glintL_wake_open(&server->wake) || !make_token(server)) {
        free_server(server);
        return NULL;
    }
    sigfillset(&all); // signals go to the script's thread
    pthread_sigmask(SIG_BLOCK, &all, &before);
    int failed = pthread_create(&server->thread, NULL, serve, server);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (!failed)
        return server;
    free_server(server);
    return NULL;
}

void watch_server_destroy(watch_server *server)
{
    if (!server)
        return;
    pthread_mutex_lock(&server->lock);
    server->stops = true;
    pthread_mutex_unlock(&server->lock);
    glintL_wake_call(&server->wake);
    pthread_join(server->thread, NULL);
    free_server(server);
}

const char *watch_server_url(const watch_server *server) { return server->url; }

void watch_server_publish(watch_server *server, const char *state, watch_picture *picture)
{
    char *copy = strdup(state);
    if (!copy)
        return; // the page keeps the last state
    pthread_mutex_lock(&server->lock);
    free(server->state);
    server->state = copy;
    server->version++;
    if (picture) {
        watch_picture_release(server->picture);
        server->picture = watch_picture_retain(picture);
    }
    pthread_mutex_unlock(&server->lock);
    glintL_wake_call(&server->wake);
}
