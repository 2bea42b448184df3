/// Changes of the files in folders: inotify's events on Linux, elsewhere the differences between two looks.
#ifndef GLINT_WATCH_FOLDERS_H
#define GLINT_WATCH_FOLDERS_H

#include <stdbool.h>

typedef struct watch_folders watch_folders;

typedef enum watch_change {
    WATCH_WRITTEN, ///< written and closed, or moved here
    WATCH_CREATED, ///< more is to come, unless it is a link
    WATCH_REMOVED,
    WATCH_LOST, ///< the folder itself; its number counts no more
    WATCH_OVERFLOW ///< anything may have changed, in any folder
} watch_change;

/// NULL: errno says why.
watch_folders *watch_folders_create(void);
void watch_folders_destroy(watch_folders *folders); ///< may be NULL

/// Returns the folder's number, the same for the same folder; -1 where there is none.
int watch_folders_add(watch_folders *folders, const char *path);
void watch_folders_remove(watch_folders *folders, int number);

/// Returns the descriptor to poll, or -1 when the folders must be looked at every *look_ms.
int watch_folders_poll(const watch_folders *folders, int *look_ms);
/// Calls `take` for each change since the last time. `name` is "" where the change is of the folder.
void watch_folders_read(watch_folders *folders, void (*take)(void *user, int number, const char *name, watch_change change),
                        void *user);

#endif
