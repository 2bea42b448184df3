/// A list of pointers with a hash table of their positions. Internal.
#ifndef GLINT_BASE_LIST_H
#define GLINT_BASE_LIST_H

#include "engine/glint_types.h"

/// Start from { 0 }. `slots` is an open-addressing table of index + 1; 0 is free.
typedef struct glint_list {
    void **items;
    size_t count, capacity;
    uint32_t *slots;
    size_t slot_count; ///< number of slots: a power of two, at least twice `capacity`
} glint_list;

/// Returns the index of `object`, or list->count if it is not in the list.
size_t glint_list_find(const glint_list *list, const void *object);
/// Appends an object that is not there yet.
glint_status glint_list_add(glint_list *list, void *object, glint_error *error);
void glint_list_remove(glint_list *list, size_t index);
void glint_list_free(glint_list *list);

#endif
