// The files that a run has written, to warn when one picture replaces another.
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "bindings/run/run.h"

static uint64_t hash_step(uint64_t hash, char byte) { return (hash ^ (unsigned char)byte) * 0x100000001b3u; } // FNV-1a

// Hashes a path, ignoring "./" and doubled slashes. Never 0.
static uint64_t hash_path(const char *path)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (bool starts = true; *path; path++) {
        if (starts && path[0] == '.' && path[1] == '/')
            path++;
        else if (!starts || *path != '/' || hash == 0xcbf29ce484222325u)
            hash = hash_step(hash, *path);
        starts = *path == '/';
    }
    return hash ? hash : 1;
}

// Returns the identity of the file's picture: its key, or the frame if the file has none.
static uint64_t hash_picture(const glintL_file *file, int64_t index)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (const char *at = file->key; *at; at++)
        hash = hash_step(hash, *at);
    return file->key[0] ? hash : (uint64_t)index;
}

// Returns the entry of a path, or the free entry for it. The table always has free entries.
static glintL_written *find(glintL_written *table, size_t capacity, uint64_t path)
{
    size_t at = path % capacity;
    while (table[at].path && table[at].path != path)
        at = (at + 1) % capacity;
    return &table[at];
}

// Enlarges the table. False: out of memory.
static bool grow(glintL_run *run)
{
    size_t capacity = run->written_capacity ? 2 * run->written_capacity : 64;
    glintL_written *table = calloc(capacity, sizeof *table);
    if (!table)
        return false;
    for (size_t i = 0; i < run->written_capacity; i++)
        if (run->written[i].path)
            *find(table, capacity, run->written[i].path) = run->written[i];
    free(run->written);
    run->written = table;
    run->written_capacity = capacity;
    return true;
}

static void warn(glintL_run *run, const char *path, int64_t first, int64_t index)
{
    const char *dot = strrchr(path, '.');
    int stem = (int)(dot ? dot - path : (ptrdiff_t)strlen(path));
    glintL_run_warn(run,
                    "frame %" PRId64 ": output: '%.300s' is also the file of frame %" PRId64 ", whose picture is lost; put the "
                    "frame's number into the name: %.*s_%%04d%s",
                    index, path, first, stem < 300 ? stem : 300, path, dot ? dot : "");
}

// Returns whether this run has written another picture to the file; *first is the frame of that picture. Out of memory
// the result is false, and the run has failed.
static bool replaces(glintL_run *run, const char *name, uint64_t picture, int64_t index, int64_t *first)
{
    if (glintL_name_is_special(name))
        return false;
    if (2 * run->written_count >= run->written_capacity && !grow(run))
        return glintL_run_fail(run, GLINTL_EXIT_FAILED, index, "out of memory");
    const uint64_t path = hash_path(name);
    glintL_written *entry = find(run->written, run->written_capacity, path);
    *first = entry->index;
    if (entry->path)
        return entry->picture != picture;
    *entry = (glintL_written) { path, picture, index };
    run->written_count++;
    return false;
}

// Returns whether another run has written another picture to the file since this run began.
static bool is_of_other_run(const glintL_run *run, const glintL_file *file)
{
    struct stat info;
    const struct timespec *since = &run->written_since;
    if (glintL_name_is_special(file->path) || stat(file->path, &info) != 0 || !S_ISREG(info.st_mode))
        return false;
#ifdef __APPLE__
    const struct timespec then = info.st_mtimespec;
#else
    const struct timespec then = info.st_mtim;
#endif
    const bool is_later = then.tv_sec != since->tv_sec ? then.tv_sec > since->tv_sec : then.tv_nsec > since->tv_nsec;
    return is_later && !glint_file_has_key(file->path, file->key);
}

static void warn_of_other_run(glintL_run *run, const glintL_file *file, int64_t index)
{
    if (run->met_other_run || !is_of_other_run(run, file))
        return;
    run->met_other_run = true;
    glintL_run_warn(run, "frame %" PRId64 ": output: '%.300s' was written by another run after this one began, and that picture is lost; "
                    "give the runs different names", index, file->path);
}

bool glintL_places_add(glintL_run *run, const glintL_work *work)
{
    bool warned = false;
    for (int i = 0; i < work->file_count && !run->exit_code; i++) {
        int64_t first = 0;
        const glintL_file *file = &work->files[i];
        const bool replaced = replaces(run, file->path, hash_picture(file, work->index), work->index, &first);
        if (first == 0 && !work->follows_step) // the first picture of this run in the file
            warn_of_other_run(run, file, work->index);
        if (!replaced || warned)
            continue;
        warn(run, work->files[i].path, first, work->index);
        warned = true;
    }
    return run->exit_code == 0;
}

bool glintL_written_note(glintL_run *run, const char *what, const char *path, int64_t number)
{
    int64_t first = 0;
    if (replaces(run, path, (uint64_t)number, number, &first))
        glintL_run_warn(run, "%s: '%.300s' was already written in this run, and that picture is lost; give each file a different name", what,
                        path);
    return run->exit_code == 0;
}

void glintL_places_forget(glintL_run *run)
{
    free(run->written);
    run->written = NULL;
    run->written_count = run->written_capacity = 0;
    clock_gettime(CLOCK_REALTIME, &run->written_since);
}
