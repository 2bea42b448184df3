#include "engine/base/list.h"
#include "engine/base/status.h"

#include <stdlib.h>
#include <string.h>

static size_t hash_pointer(const void *object)
{
    return (size_t)(((uintptr_t)object >> 4) * UINT64_C(0x9e3779b97f4a7c15) >> 32);
}

/// Returns the slot that holds `object`, or the free slot where it would go.
static size_t find_slot(const glint_list *list, const void *object)
{
    size_t slot = hash_pointer(object) & (list->slot_count - 1);
    while (list->slots[slot] && list->items[list->slots[slot] - 1] != object)
        slot = (slot + 1) & (list->slot_count - 1);
    return slot;
}

static void fill_slots(glint_list *list)
{
    memset(list->slots, 0, list->slot_count * sizeof *list->slots);
    for (size_t i = 0; i < list->count; i++)
        list->slots[find_slot(list, list->items[i])] = (uint32_t)(i + 1);
}

/// Makes space for one more item.
static glint_status grow(glint_list *list, glint_error *error)
{
    if (list->count < list->capacity)
        return GLINT_OK;
    const size_t capacity = list->capacity ? 2 * list->capacity : 8;
    void **items = realloc(list->items, capacity * sizeof *items);
    if (!items)
        return glint_fail_nomem(error);
    list->items = items;
    uint32_t *slots = malloc(2 * capacity * sizeof *slots);
    if (!slots)
        return glint_fail_nomem(error);
    free(list->slots);
    list->slots = slots;
    list->slot_count = 2 * capacity;
    list->capacity = capacity;
    fill_slots(list);
    return GLINT_OK;
}

size_t glint_list_find(const glint_list *list, const void *object)
{
    const uint32_t slot = list->count ? list->slots[find_slot(list, object)] : 0;
    return slot ? slot - 1 : list->count;
}

glint_status glint_list_add(glint_list *list, void *object, glint_error *error)
{
    glint_status status = grow(list, error);
    if (status)
        return status;
    list->items[list->count++] = object;
    list->slots[find_slot(list, object)] = (uint32_t)list->count;
    return GLINT_OK;
}

void glint_list_remove(glint_list *list, size_t index)
{
    memmove(list->items + index, list->items + index + 1, (list->count - index - 1) * sizeof *list->items);
    list->count--;
    fill_slots(list);
}

void glint_list_free(glint_list *list)
{
    free(list->items);
    free(list->slots);
    *list = (glint_list) { 0 };
}
