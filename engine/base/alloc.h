/// Memory for tables that kernels read. Internal.
#ifndef GLINT_BASE_ALLOC_H
#define GLINT_BASE_ALLOC_H

#include <stddef.h>

/// Zeroed memory, 64-byte aligned, of count * size bytes (at least one), checked for overflow; free() frees it.
void *glint_alloc(size_t count, size_t size);
/// The same but not zeroed, and of large pages where the system has them: for megabytes that are written at once.
void *glint_alloc_large(size_t count, size_t size);

/// Memory for short-lived data, not zeroed, aligned for anything of 16 bytes; the system has it back at once where it is much, so
/// that what is made next does not come on top of it. Changes its size, from 0: there is none yet. NULL: out of memory, and the old block stays.
void *glint_scratch_resize(void *memory, size_t from, size_t to);
/// Gives the system back what lies between two of its bytes, which nothing reads from now on. bytes: as resized to last.
void glint_scratch_drop(void *memory, size_t bytes, size_t from, size_t to);
void glint_scratch_free(void *memory, size_t bytes);

/// Prefetches memory that is read or written soon into the second-level cache: the first level is full of current data.
static inline void glint_prefetch(const void *memory, size_t bytes)
{
    for (size_t i = 0; i < bytes; i += 64)
        __builtin_prefetch((const char *)memory + i, 0, 2);
}

#endif
