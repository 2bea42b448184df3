/// Changes of files in folders: from inotify on Linux, elsewhere from comparing two checks.
#ifndef GLINT_WATCH_FOLDERS_H
#define GLINT_WATCH_FOLDERS_H

#include <stdbool.h>

typedef struct watch_folders watch_folders;

typedef enum watch_change {
    WATCH_WRITTEN, ///< written and closed, or moved here
    WATCH_CREATED, ///< incomplete, unless it is a link
    WATCH_REMOVED,
    WATCH_LOST, ///< the folder itself is gone; its number is no longer valid
    WATCH_OVERFLOW ///< anything may have changed, in any folder
} watch_change;

/// NULL: errno gives the reason.
watch_folders *watch_folders_create(void);
void watch_folders_destroy(watch_folders *folders); ///< may be NULL

/// Returns the folder's number, the same for every path to the folder; -1: it does not exist.
int watch_folders_add(watch_folders *folders, const char *path);
void watch_folders_remove(watch_folders *folders, int number);

/// Returns the descriptor to poll, or -1 if the folders must be checked every *look_ms.
int watch_folders_poll(const watch_folders *folders, int *look_ms);
/// Calls `take` for each change since the last call. `name` is "" for a change of the folder itself.
void watch_folders_read(watch_folders *folders, void (*take)(void *user, int number, const char *name, watch_change change),
                        void *user);

#endif
