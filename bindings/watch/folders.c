#include "bindings/watch/folders.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#if defined(__linux__) && !defined(GLINT_PORTABLE)

#include <sys/inotify.h>

#define EVENTS \
    (IN_CLOSE_WRITE | IN_CREATE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR)

struct watch_folders {
    int notify;
};

watch_folders *watch_folders_create(void)
{
    watch_folders *folders = calloc(1, sizeof *folders);
    if (folders)
        folders->notify = inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
    if (folders && folders->notify >= 0)
        return folders;
    free(folders);
    return NULL;
}

void watch_folders_destroy(watch_folders *folders)
{
    if (folders)
        close(folders->notify);
    free(folders);
}

int watch_folders_add(watch_folders *folders, const char *path)
{
    return inotify_add_watch(folders->notify, path, EVENTS);
}

void watch_folders_remove(watch_folders *folders, int number) { inotify_rm_watch(folders->notify, number); }

int watch_folders_poll(const watch_folders *folders, int *look_ms)
{
    *look_ms = -1;
    return folders->notify;
}

static watch_change change_of(unsigned mask)
{
    if (mask & IN_Q_OVERFLOW)
        return WATCH_OVERFLOW;
    if (mask & (IN_IGNORED | IN_DELETE_SELF | IN_MOVE_SELF))
        return WATCH_LOST;
    if (mask & (IN_DELETE | IN_MOVED_FROM))
        return WATCH_REMOVED;
    return mask & IN_CREATE ? WATCH_CREATED : WATCH_WRITTEN;
}

void watch_folders_read(watch_folders *folders, void (*take)(void *user, int number, const char *name, watch_change change),
                        void *user)
{
    union { // aligned like an event
        struct inotify_event first;
        char bytes[16384];
    } buffer;
    ssize_t size;
    while ((size = read(folders->notify, buffer.bytes, sizeof buffer.bytes)) > 0)
        for (ssize_t at = 0; at < size;) {
            const struct inotify_event *event = (const void *)(buffer.bytes + at);
            take(user, event->wd, event->len ? event->name : "", change_of(event->mask));
            if (event->mask & IN_MOVE_SELF) // the watch has moved with the folder
                inotify_rm_watch(folders->notify, event->wd);
            at += (ssize_t)(sizeof *event + event->len);
        }
}

#else

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>

#define LOOK_MS 20

// A file in a folder at the last check.
typedef struct entry {
    char *name; // owned
    struct stat info;
    bool seen; // in the current check
} entry;

typedef struct folder {
    char *path; // owned; NULL: unused
    ino_t inode;
    entry *entries; // owned
    size_t count;
} folder;

struct watch_folders {
    folder *list;
    int count;
};

watch_folders *watch_folders_create(void) { return calloc(1, sizeof(watch_folders)); }

static void forget(folder *f)
{
    for (size_t i = 0; i < f->count; i++)
        free(f->entries[i].name);
    free(f->entries);
    free(f->path);
    *f = (folder) { 0 };
}

void watch_folders_destroy(watch_folders *folders)
{
    for (int i = 0; folders && i < folders->count; i++)
        forget(&folders->list[i]);
    if (folders)
        free(folders->list);
    free(folders);
}

static entry *find(const folder *f, const char *name)
{
    for (size_t i = 0; i < f->count; i++)
        if (strcmp(f->entries[i].name, name) == 0)
            return &f->entries[i];
    return NULL;
}

static bool is_same(const struct stat *a, const struct stat *b)
{
#ifdef __APPLE__
    const bool same_time = a->st_mtimespec.tv_sec == b->st_mtimespec.tv_sec && a->st_mtimespec.tv_nsec == b->st_mtimespec.tv_nsec;
#else
    const bool same_time = a->st_mtim.tv_sec == b->st_mtim.tv_sec && a->st_mtim.tv_nsec == b->st_mtim.tv_nsec;
#endif
    return same_time && a->st_ino == b->st_ino && a->st_size == b->st_size;
}

// Compares the folder with the last check, and stores its files. False: the folder is gone or was replaced.
static bool look(folder *f, int number, void (*take)(void *user, int number, const char *name, watch_change change),
                 void *user)
{
    struct stat info;
    DIR *directory = stat(f->path, &info) == 0 && info.st_ino == f->inode ? opendir(f->path) : NULL;
    if (!directory)
        return false;
    for (size_t i = 0; i < f->count; i++)
        f->entries[i].seen = false;
    for (struct dirent *d; (d = readdir(directory));) {
        entry *e = find(f, d->d_name);
        if (fstatat(dirfd(directory), d->d_name, &info, AT_SYMLINK_NOFOLLOW) != 0)
            continue;
        const bool changed = !e || !is_same(&e->info, &info);
        if (!e) {
            entry *grown = realloc(f->entries, (f->count + 1) * sizeof *grown);
            f->entries = grown ? grown : f->entries;
            char *name = grown ? strdup(d->d_name) : NULL;
            if (!name)
                continue; // out of memory: it counts as new at the next check
            e = &f->entries[f->count++];
            e->name = name;
        }
        e->info = info;
        e->seen = true;
        if (changed && take)
            take(user, number, e->name, WATCH_WRITTEN);
    }
    closedir(directory);
    for (size_t i = f->count; i-- > 0;)
        if (!f->entries[i].seen) {
            entry gone = f->entries[i];
            f->entries[i] = f->entries[--f->count];
            if (take)
                take(user, number, gone.name, WATCH_REMOVED);
            free(gone.name);
        }
    return true;
}

int watch_folders_add(watch_folders *folders, const char *path)
{
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISDIR(info.st_mode))
        return -1;
    int number = folders->count;
    for (int i = folders->count; i-- > 0;) {
        if (folders->list[i].path && folders->list[i].inode == info.st_ino)
            return i;
        if (!folders->list[i].path)
            number = i;
    }
    if (number == folders->count) {
        folder *grown = realloc(folders->list, (size_t)(number + 1) * sizeof *grown);
        if (!grown)
            return -1;
        folders->list = grown;
        grown[folders->count++] = (folder) { 0 };
    }
    folder *f = &folders->list[number];
    f->path = strdup(path);
    f->inode = info.st_ino;
    if (f->path && look(f, number, NULL, NULL))
        return number;
    forget(f);
    return -1;
}

void watch_folders_remove(watch_folders *folders, int number) { forget(&folders->list[number]); }

int watch_folders_poll(const watch_folders *folders, int *look_ms)
{
    (void)folders;
    *look_ms = LOOK_MS;
    return -1;
}

void watch_folders_read(watch_folders *folders, void (*take)(void *user, int number, const char *name, watch_change change),
                        void *user)
{
    for (int i = 0; i < folders->count; i++)
        if (folders->list[i].path && !look(&folders->list[i], i, take, user)) {
            forget(&folders->list[i]);
            take(user, i, "", WATCH_LOST);
        }
}

#endif
