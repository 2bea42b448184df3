// Films made by ffmpeg. It receives raw frames through a socket and writes a draft, which is renamed on success.
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "bindings/run/film.h"
#include "bindings/run/system.h"

#define WAIT_MS 50 // time between checks for an interrupt
#define GRACE_MS 2000 // time from SIGTERM to SIGKILL
#define ARGUMENTS_MAX 64

extern char **environ;

bool glintL_has_ffmpeg(void)
{
    const char *path = getenv("PATH");
    char name[GLINTL_PATH_SIZE];
    while (path && *path) {
        size_t length = strcspn(path, ":");
        snprintf(name, sizeof name, "%.*s/ffmpeg", (int)length, length ? path : ".");
        if (access(name, X_OK) == 0)
            return true;
        path += length + (path[length] == ':');
    }
    return false;
}

typedef struct encoder {
    const glintL_run *run;
    const glintL_film *film;
    int width, height; // size of a frame, pixels
    int sent_width, sent_height; // rounded up to even where the format requires it
    pid_t process;
    int socket; // our end of ffmpeg's input; -1: closed
    FILE *said; // ffmpeg's output
} encoder;

// ---- Starting ----

// Lists the arguments. Input is sRGB; output is BT.709 of limited range, so that players show the colours of the
// frames. The file contains no dates or versions.
static void list_arguments(const encoder *e, const char *target, const char **list, char numbers[2][64])
{
    static const char *const mp4[] = { "-c:v", "libx264",   "-preset",    "medium", "-crf",
                                       "18",   "-movflags", "+faststart", NULL };
    static const char *const webm[] = { "-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", NULL };
    static const char *const video[] = { "-vf",
                                         "scale=out_color_matrix=bt709:out_range=tv",
                                         "-pix_fmt",
                                         "yuv420p",
                                         "-colorspace",
                                         "bt709",
                                         "-color_primaries",
                                         "bt709",
                                         "-color_trc",
                                         "iec61966-2-1",
                                         NULL };
    static const char *const gif[] = { "-vf", "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1",
                                       "-loop", "0", NULL };
    static const char *const plain[] = { "-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact", NULL };
    bool is_gif = e->film->kind == GLINTL_FILM_GIF, is_mp4 = e->film->kind == GLINTL_FILM_MP4;
    const char *const *parts[] = { is_gif ? gif : is_mp4 ? mp4 : webm, is_gif ? NULL : video, plain };
    const char *const head[] = { "ffmpeg",     "-hide_banner", "-loglevel", "error",  "-nostdin",    "-y",
                                 "-f",         "rawvideo",     "-pix_fmt",  "rgb24",  "-video_size", numbers[0],
                                 "-framerate", numbers[1],     "-i",        "pipe:0", NULL };
    size_t count = 0;
    snprintf(numbers[0], 64, "%dx%d", e->sent_width, e->sent_height);
    snprintf(numbers[1], 64, "%.10g", e->film->fps);
    for (const char *const *at = head; *at; at++)
        list[count++] = *at;
    for (size_t i = 0; i < 3; i++)
        for (const char *const *at = parts[i]; at && *at; at++)
            list[count++] = *at;
    list[count++] = "-f";
    list[count++] = is_gif ? "gif" : is_mp4 ? "mp4" : "webm";
    list[count++] = target;
    list[count] = NULL;
}

// Starts ffmpeg in its own process group, so that Ctrl-C reaches only glint, which stops it. Returns 0 or an errno.
static int spawn(encoder *e, int input, const char *target)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    const char *arguments[ARGUMENTS_MAX];
    char numbers[2][64];
    sigset_t none;
    list_arguments(e, target, arguments, numbers);
    sigemptyset(&none);
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(e->said), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(e->said), STDERR_FILENO);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setsigmask(&attributes, &none);
    int code = posix_spawnp(&e->process, "ffmpeg", &actions, &attributes, (char *const *)(uintptr_t)arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return code;
}

// Returns 0 or an errno.
static int start(encoder *e, const char *target)
{
    int ends[2];
    size_t capacity = strlen(target) + 8;
    char *url = malloc(capacity); // so that a ':' in a name is not read as a protocol
    e->said = tmpfile();
    if (!url || !e->said || !glintL_socket_pair(ends)) {
        int code = url && errno ? errno : ENOMEM;
        free(url);
        return code;
    }
    snprintf(url, capacity, "file:%s", target);
    int code = spawn(e, ends[1], url);
    free(url);
    close(ends[1]);
    e->socket = ends[0];
    return code;
}

// ---- Feeding ----

// Sends all of the data. False: the run was interrupted, or ffmpeg has ended.
static bool send_all(const encoder *e, const uint8_t *data, size_t size)
{
    struct pollfd wait = { .fd = e->socket, .events = POLLOUT };
    while (size > 0 && !e->run->interrupted) {
        if (poll(&wait, 1, WAIT_MS) <= 0)
            continue;
        ssize_t done = send(e->socket, data, size, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (done < 0 && errno != EAGAIN && errno != EINTR)
            return false;
        if (done > 0) {
            data += done;
            size -= (size_t)done;
        }
    }
    return size == 0;
}

// Sends a frame. An added column or row, which makes a side even, repeats the last one.
static bool send_frame(const encoder *e, const glint_picture *picture, uint8_t *row)
{
    size_t width = (size_t)e->width, sent = (size_t)e->sent_width;
    bool good = true;
    for (int y = 0; y < e->sent_height && good; y++) {
        if (y < e->height)
            glint_picture_row(picture, y, 0, row);
        if (sent > width)
            memcpy(row + 3 * width, row + 3 * (width - 1), 3);
        good = send_all(e, row, 3 * sent);
    }
    return good;
}

// Sends all frames. Returns the exit code; 0 also when ffmpeg has ended early, since it reports the reason.
static int feed(const encoder *e, char *message)
{
    glint_error error;
    bool good = true;
    int code = GLINTL_EXIT_DONE;
    uint8_t *row = malloc(3 * (size_t)e->sent_width);
    if (!row) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "out of memory");
        return GLINTL_EXIT_FAILED;
    }
    for (size_t i = 0; i < e->film->count && good && !code; i++) {
        glint_picture *picture = NULL;
        glintL_film_tell(e->run, e->film, i);
        glint_status status = glint_picture_read(e->film->files[i], true, &picture, &error);
        if (status) {
            snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
            code = glintL_run_exit_code(status);
        } else if (glint_picture_width(picture) != e->width || glint_picture_height(picture) != e->height) {
            snprintf(message, GLINTL_MESSAGE_SIZE, "%.200s: its size changed while the film was made", e->film->files[i]);
            code = GLINTL_EXIT_FAILED;
        } else {
            good = send_frame(e, picture, row);
        }
        glint_picture_destroy(picture);
    }
    free(row);
    return code;
}

// ---- Ending ----

// Waits for ffmpeg, and ends it if `stop` is set or the run is interrupted. Returns its status.
static int wait_for(const encoder *e, bool stop)
{
    const struct timespec pause = { 0, WAIT_MS / 5 * 1000000L };
    double stopped_ms = 0;
    int status = 0;
    while (waitpid(e->process, &status, WNOHANG) == 0) {
        if ((stop || e->run->interrupted) && stopped_ms == 0) {
            kill(e->process, SIGTERM);
            stopped_ms = glintL_now_ms();
        } else if (stopped_ms > 0 && glintL_now_ms() - stopped_ms > GRACE_MS) {
            kill(e->process, SIGKILL);
        }
        nanosleep(&pause, NULL);
    }
    return status;
}

// Returns the end of ffmpeg's output, on one line.
static void read_said(FILE *said, char *out, size_t capacity)
{
    long size = ftell(said);
    fseek(said, 0, SEEK_END);
    size = ftell(said);
    fseek(said, size > (long)capacity - 1 ? size - (long)capacity + 1 : 0, SEEK_SET);
    size_t used = fread(out, 1, capacity - 1, said);
    while (used > 0 && (out[used - 1] == '\n' || out[used - 1] == ' '))
        used--;
    out[used] = '\0';
    for (char *c = out; *c; c++)
        *c = (unsigned char)*c < ' ' ? ' ' : *c;
}

static int judge(const encoder *e, int status, char *message)
{
    char said[600];
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return GLINTL_EXIT_DONE;
    read_said(e->said, said, sizeof said);
    if (WIFSIGNALED(status))
        snprintf(message, GLINTL_MESSAGE_SIZE, "%.200s: ffmpeg ended by signal %d%s%s", e->film->path, WTERMSIG(status),
                 *said ? ": " : "", said);
    else
        snprintf(message, GLINTL_MESSAGE_SIZE, "%.200s: ffmpeg failed with exit code %d%s%s", e->film->path,
                 WEXITSTATUS(status), *said ? ": " : "", said);
    return strstr(said, "No space left") ? GLINTL_EXIT_LATER : GLINTL_EXIT_FAILED;
}

static int encode(encoder *e, const char *target, char *message)
{
    int failure = start(e, target);
    if (failure) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "ffmpeg: %s", strerror(failure));
        if (e->socket >= 0)
            close(e->socket);
        return GLINTL_EXIT_FAILED;
    }
    int code = feed(e, message);
    close(e->socket);
    glintL_film_tell(e->run, e->film, e->film->count); // ffmpeg still encodes the frames that it has buffered
    int status = wait_for(e, code != 0);
    if (e->run->interrupted) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "interrupted");
        return GLINTL_EXIT_FAILED;
    }
    return code ? code : judge(e, status, message);
}

static int fail_without(const glintL_run *run, const glintL_film *film, char *message)
{
    bool gaps = run->request.selection.range_count > 0; // with gaps the shell lists the files, else the pattern
    if (film->pattern)
        snprintf(
            message, GLINTL_MESSAGE_SIZE,
            "%.200s: ffmpeg is not installed (Debian: apt-get install ffmpeg). The frames are finished; make the "
            "film later with:  glint assemble %s%.200s.frames/%s.png%s -o '%.200s' --fps %.10g",
            film->path, gaps ? "" : "'", film->path, gaps ? "*" : "%04d", gaps ? "" : "'", film->path, film->fps);
    else
        snprintf(message, GLINTL_MESSAGE_SIZE,
                 "%.200s: ffmpeg is not installed (Debian: apt-get install ffmpeg); -o NAME.png, an animated PNG, "
                 "does not need it",
                 film->path);
    return GLINTL_EXIT_FAILED;
}

int glintL_film_pipe(glintL_run *run, const glintL_film *film, char message[GLINTL_MESSAGE_SIZE])
{
    glint_error error;
    glint_picture *first = NULL;
    glint_draft *draft = NULL;
    encoder e = { .run = run, .film = film, .socket = -1 };
    if (!glintL_has_ffmpeg())
        return fail_without(run, film, message);
    glint_status status = glint_picture_read(film->files[0], false, &first, &error);
    if (!status)
        status = glint_draft_create(film->path, &draft, &error);
    if (status) {
        glint_picture_destroy(first);
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
        return glintL_run_exit_code(status);
    }
    int odd = film->kind == GLINTL_FILM_GIF ? 0 : 1; // 4:2:0 needs even sides
    e.width = glint_picture_width(first);
    e.height = glint_picture_height(first);
    e.sent_width = e.width + (e.width & odd);
    e.sent_height = e.height + (e.height & odd);
    glint_picture_destroy(first);
    int code = encode(&e, glint_draft_name(draft), message);
    if (!code && glint_draft_finish(draft, &error)) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
        code = glintL_run_exit_code(error.status);
    }
    glint_draft_destroy(draft);
    if (e.said)
        fclose(e.said);
    if (!code && (e.sent_width > e.width || e.sent_height > e.height))
        glintL_run_warn(run, "%s: %dx%d pixels: the format needs even sides, so the last %s repeated", film->path,
                        e.sent_width, e.sent_height,
                        e.sent_width > e.width && e.sent_height > e.height ? "column and row are"
                        : e.sent_width > e.width                           ? "column is"
                                                                           : "row is");
    return code;
}
