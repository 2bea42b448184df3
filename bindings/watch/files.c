// The files of a watched script, watched through their folders, because editors often replace a file instead of writing
// into it.
#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bindings/run/system.h"
#include "bindings/watch/folders.h"
#include "bindings/watch/watch.h"

#define SETTLE_MS 6 // after a write: more writes of the burst may follow
#define GONE_MS 150 // after a deletion: editors may move a file away before they write it again
#define RETRY_MS 500 // interval for checking missing folders

typedef struct watched {
    char *folder, *name; // owned
    int folder_number; // -1: the folder is missing
    unsigned run; // the last run that added it
    bool skipped; // the script writes this file
} watched;

struct watch_files {
    pthread_t thread;
    pthread_mutex_t lock;
    watch_folders *folders;
    glintL_wake wake;
    bool stops;
    void (*changed)(void *context, const char *path);
    void *context;
    watched *list;
    size_t count;
    unsigned run;
    double due_ms; // time of the report; 0: nothing to report
    char path[GLINTL_PATH_SIZE]; // the file that changed
};

// ---- The list; the caller holds the lock ----

static void free_watched(watched *file)
{
    free(file->folder);
    free(file->name);
}

static bool is_in(const watch_files *files, int folder_number)
{
    for (size_t i = 0; i < files->count; i++)
        if (files->list[i].folder_number == folder_number)
            return true;
    return false;
}

static watched *find(watch_files *files, const char *folder, const char *name)
{
    for (size_t i = 0; i < files->count; i++)
        if (strcmp(files->list[i].name, name) == 0 && strcmp(files->list[i].folder, folder) == 0)
            return &files->list[i];
    return NULL;
}

// Adds a file, and takes over folder and name. NULL: out of memory, or an optional file without a folder; both are
// freed.
static watched *add(watch_files *files, char *folder, char *name, bool optional)
{
    watched *found = folder && name ? find(files, folder, name) : NULL;
    if (found) {
        free(folder);
        free(name);
        return found;
    }
    int number = folder && name ? watch_folders_add(files->folders, folder) : -1;
    bool wanted = folder && name && (number >= 0 || !optional);
    watched *grown = wanted ? realloc(files->list, (files->count + 1) * sizeof *grown) : NULL;
    if (!grown) {
        free(folder);
        free(name);
        return NULL;
    }
    files->list = grown;
    grown[files->count] = (watched) { .folder = folder, .name = name, .folder_number = number };
    return &grown[files->count++];
}

static void add_path(watch_files *files, const char *path, bool optional, bool skipped)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    if (!*name)
        return;
    char *folder = !slash ? strdup(".") : slash == path ? strdup("/") : strndup(path, (size_t)(slash - path));
    char *real = folder ? realpath(folder, NULL) : NULL; // one spelling for each folder
    if (real) {
        free(folder);
        folder = real;
    }
    watched *file = add(files, folder, strdup(name), optional);
    if (file) {
        file->skipped = skipped || (file->skipped && file->run == files->run);
        file->run = files->run;
    }
}

// Watches the file that a symbolic link leads to as well.
static void add_target(watch_files *files, const char *path, bool skipped)
{
    struct stat info;
    if (lstat(path, &info) != 0 || !S_ISLNK(info.st_mode))
        return;
    char *real = realpath(path, NULL);
    if (real)
        add_path(files, real, false, skipped);
    free(real);
}

static void note(watch_files *files, const char *path, bool optional, bool skipped)
{
    pthread_mutex_lock(&files->lock);
    add_path(files, path, optional, skipped);
    add_target(files, path, skipped);
    pthread_mutex_unlock(&files->lock);
    glintL_wake_call(&files->wake); // there may be a new folder to watch
}

void watch_files_add(watch_files *files, const char *path, bool optional) { note(files, path, optional, false); }
void watch_files_skip(watch_files *files, const char *path) { note(files, path, true, true); }

void watch_files_begin(watch_files *files)
{
    pthread_mutex_lock(&files->lock);
    files->run++;
    pthread_mutex_unlock(&files->lock);
}

void watch_files_end(watch_files *files, bool good)
{
    pthread_mutex_lock(&files->lock);
    for (size_t i = files->count; i-- > 0 && good;) {
        watched gone = files->list[i];
        if (gone.run == files->run)
            continue;
        files->list[i] = files->list[--files->count];
        if (gone.folder_number >= 0 && !is_in(files, gone.folder_number))
            watch_folders_remove(files->folders, gone.folder_number);
        free_watched(&gone);
    }
    pthread_mutex_unlock(&files->lock);
}

size_t watch_files_count(watch_files *files)
{
    size_t count = 0;
    pthread_mutex_lock(&files->lock);
    for (size_t i = 0; i < files->count; i++)
        count += !files->list[i].skipped;
    pthread_mutex_unlock(&files->lock);
    return count;
}

// ---- The thread; it holds the lock except in wait_for_changes ----

static void tell_later(watch_files *files, const watched *file, double delay_ms)
{
    snprintf(files->path, sizeof files->path, "%s/%s", file->folder, file->name);
    files->due_ms = glintL_now_ms() + delay_ms;
}

// Returns whether a file is a symbolic link. A new link is reported at once, a new file only when it has been written.
static bool is_link(const watched *file)
{
    char path[GLINTL_PATH_SIZE];
    struct stat info;
    snprintf(path, sizeof path, "%s/%s", file->folder, file->name);
    return lstat(path, &info) == 0 && S_ISLNK(info.st_mode);
}

static void take_change(void *user, int number, const char *name, watch_change change)
{
    watch_files *files = user;
    for (size_t i = 0; i < files->count; i++) {
        watched *file = &files->list[i];
        if (change == WATCH_OVERFLOW) {
            tell_later(files, file, SETTLE_MS);
            continue;
        }
        if (file->folder_number != number)
            continue;
        if (change == WATCH_LOST)
            file->folder_number = -1;
        if (file->skipped || (change != WATCH_LOST && strcmp(name, file->name) != 0))
            continue;
        if (change == WATCH_LOST || change == WATCH_REMOVED)
            tell_later(files, file, GONE_MS);
        else if (change != WATCH_CREATED || is_link(file))
            tell_later(files, file, SETTLE_MS);
    }
}

// Looks for missing folders. Returns whether some are still missing.
static bool find_folders(watch_files *files)
{
    bool lacking = false;
    for (size_t i = 0; i < files->count; i++) {
        watched *file = &files->list[i];
        if (file->folder_number >= 0)
            continue;
        file->folder_number = watch_folders_add(files->folders, file->folder);
        lacking = lacking || file->folder_number < 0;
        if (file->folder_number >= 0 && !file->skipped)
            tell_later(files, file, SETTLE_MS);
    }
    return lacking;
}

static void wait_for_changes(watch_files *files, int timeout_ms)
{
    int look_ms;
    struct pollfd wait[2] = { { .fd = watch_folders_poll(files->folders, &look_ms), .events = POLLIN },
                              { .fd = files->wake.from, .events = POLLIN } };
    if (look_ms >= 0 && (timeout_ms < 0 || look_ms < timeout_ms))
        timeout_ms = look_ms;
    pthread_mutex_unlock(&files->lock);
    if (poll(wait, 2, timeout_ms) > 0 && wait[1].revents)
        glintL_wake_clear(&files->wake);
    pthread_mutex_lock(&files->lock);
}

static void *watch(void *argument)
{
    watch_files *files = argument;
    char path[GLINTL_PATH_SIZE];
    pthread_mutex_lock(&files->lock);
    while (!files->stops) {
        int timeout = find_folders(files) ? RETRY_MS : -1;
        double left = files->due_ms - glintL_now_ms();
        if (files->due_ms > 0 && left <= 0) {
            files->due_ms = 0;
            memcpy(path, files->path, sizeof path);
            pthread_mutex_unlock(&files->lock);
            files->changed(files->context, path);
            pthread_mutex_lock(&files->lock);
            continue;
        }
        if (files->due_ms > 0 && (timeout < 0 || left < timeout))
            timeout = (int)left + 1;
        wait_for_changes(files, timeout);
        watch_folders_read(files->folders, take_change, files);
    }
    pthread_mutex_unlock(&files->lock);
    return NULL;
}

watch_files *watch_files_create(void (*changed)(void *context, const char *path), void *context,
                                char message[GLINTL_MESSAGE_SIZE])
{
    sigset_t all, before;
    watch_files *files = calloc(1, sizeof *files);
    if (!files) {
        snprintf(message, GLINTL_MESSAGE_SIZE, "out of memory");
        return NULL;
    }
    files->changed = changed;
    files->context = context;
    pthread_mutex_init(&files->lock, NULL);
    files->folders = watch_folders_create();
    bool good = files->folders && glintL_wake_open(&files->wake);
    sigfillset(&all); // signals go to the script's thread
    pthread_sigmask(SIG_BLOCK, &all, &before);
    good = good && pthread_create(&files->thread, NULL, watch, files) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (good)
        return files;
    snprintf(message, GLINTL_MESSAGE_SIZE, "watch: folders: %s%s", strerror(errno),
             errno == EMFILE ? "; the system setting fs.inotify.max_user_instances limits them" : "");
    watch_folders_destroy(files->folders);
    glintL_wake_close(&files->wake);
    pthread_mutex_destroy(&files->lock);
    free(files);
    return NULL;
}

void watch_files_destroy(watch_files *files)
{
    if (!files)
        return;
    pthread_mutex_lock(&files->lock);
    files->stops = true;
    pthread_mutex_unlock(&files->lock);
    glintL_wake_call(&files->wake);
    pthread_join(files->thread, NULL);
    watch_folders_destroy(files->folders);
    glintL_wake_close(&files->wake);
    for (size_t i = 0; i < files->count; i++)
        free_watched(&files->list[i]);
    free(files->list);
    pthread_mutex_destroy(&files->lock);
    free(files);
}
