/// Hidden files that killed processes left behind; and the drafts of this process, which its last signal removes.
///
/// A draft is called .NAME.HOST.PID.NUMBER.tmp, and its process holds a lock on it. The next process that opens a draft
/// in the folder, or looks there for a finished picture, removes leftover drafts: a draft of this host when its process
/// is gone and its lock is free; a draft of another host, whose process cannot be checked, one day after its last
/// write.
#include "engine/files/picture/file.h"
#include "engine/glint_files.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define FOREIGN_AGE_S (24 * 3600)
#define FOLDERS_CACHED 16 // number of recently searched folders that are remembered
#define LIVE_MAX 64 // most drafts that a signal removes

void glint_host_name(char out[GLINT_HOST_SIZE])
{
    snprintf(out, GLINT_HOST_SIZE, "host");
    gethostname(out, GLINT_HOST_SIZE);
    out[GLINT_HOST_SIZE - 1] = '\0';
    for (char *c = out; *c; c++)
        if (*c == '/')
            *c = '-';
}

// ---- Owners of files ----

/// Removes ".DIGITS" from the end of name[0 .. *length) and returns the number. -1: there is none.
static long take_number(const char *name, size_t *length)
{
    size_t at = *length;
    long number = 0;
    while (at > 0 && isdigit((unsigned char)name[at - 1]))
        at--;
    if (at == *length || *length - at > 9 || at < 1 || name[at - 1] != '.')
        return -1;
    for (size_t i = at; i < *length; i++)
        number = 10 * number + (name[i] - '0');
    *length = at - 1;
    return number;
}

/// Returns whether a draft has this name; writes its process, and whether the process is on this host.
static bool is_draft(const char *name, const char *host, long *process, bool *is_ours)
{
    size_t length = strlen(name);
    const size_t host_length = strlen(host);
    if (name[0] != '.' || length < 4 || strcmp(name + length - 4, ".tmp") != 0)
        return false;
    length -= 4;
    if (take_number(name, &length) < 0 || (*process = take_number(name, &length)) <= 0)
        return false;
    *is_ours = length > host_length + 1 && name[length - host_length - 1] == '.' &&
               strncmp(name + length - host_length, host, host_length) == 0;
    return length > 1;
}

/// Returns whether the process that wrote the file is gone, as far as this process can tell.
static bool is_leftover(int folder, const char *name, long process, bool is_ours, const struct stat *info)
{
    if (!S_ISREG(info->st_mode) || info->st_uid != geteuid())
        return false;
    if (!is_ours)
        return time(NULL) - info->st_mtime > FOREIGN_AGE_S;
    if (process == (long)getpid() || kill((pid_t)process, 0) == 0 || errno != ESRCH)
        return false;
    // The process may live in another container of this host, where its number means nothing here. Then it holds the
    // lock.
    const int file = openat(folder, name, O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    const bool is_free = file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0;
    if (file >= 0)
        close(file);
    return is_free;
}

void glint_drafts_collect(const char *path)
{
    if (!path)
        return;
    char host[GLINT_HOST_SIZE];
    DIR *folder = opendir(path);
    glint_host_name(host);
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        struct stat info;
        long process = 0;
        bool is_ours = false;
        if (is_draft(entry->d_name, host, &process, &is_ours) &&
            fstatat(dirfd(folder), entry->d_name, &info, AT_SYMLINK_NOFOLLOW) == 0 &&
            is_leftover(dirfd(folder), entry->d_name, process, is_ours, &info))
            unlinkat(dirfd(folder), entry->d_name, 0);
    }
    if (folder)
        closedir(folder);
}

/// Calls glint_drafts_collect, unless this process searched the folder recently.
static void collect_once(const char *path)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    static struct { dev_t device; ino_t number; } seen[FOLDERS_CACHED];
    static size_t count;
    struct stat info;
    if (stat(path, &info) != 0)
        return;
    bool is_new = true;
    pthread_mutex_lock(&lock);
    for (size_t i = 0; i < (count < FOLDERS_CACHED ? count : FOLDERS_CACHED); i++)
        is_new = is_new && (seen[i].device != info.st_dev || seen[i].number != info.st_ino);
    if (is_new) {
        seen[count % FOLDERS_CACHED].device = info.st_dev;
        seen[count++ % FOLDERS_CACHED].number = info.st_ino;
    }
    pthread_mutex_unlock(&lock);
    if (is_new)
        glint_drafts_collect(path);
}

void glint_drafts_collect_in_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, slash == path ? 1 : (size_t)(slash - path)) : NULL;
    if (folder || !slash)
        collect_once(slash ? folder : ".");
    free(folder);
}

// ---- The drafts of this process ----

static _Atomic(const char *) live[LIVE_MAX];

void glint_draft_enlist(const char *temporary)
{
    for (int i = 0; i < LIVE_MAX; i++) {
        const char *none = NULL;
        if (atomic_compare_exchange_strong(&live[i], &none, temporary))
            return;
    }
}

void glint_draft_delist(const char *temporary)
{
    for (int i = 0; i < LIVE_MAX; i++) {
        const char *own = temporary;
        if (atomic_compare_exchange_strong(&live[i], &own, NULL))
            return;
    }
}

void glint_drafts_abandon(void)
{
    for (int i = 0; i < LIVE_MAX; i++) {
        const char *temporary = atomic_load(&live[i]);
        if (temporary)
            unlink(temporary);
    }
}
