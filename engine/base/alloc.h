/// Memory for tables that kernels read. Internal.
#ifndef GLINT_BASE_ALLOC_H
#define GLINT_BASE_ALLOC_H

#include <stddef.h>

/// Returns zeroed memory, 64-byte aligned, of count * size bytes (at least one), checked for overflow; free() frees
/// it.
void *glint_alloc(size_t count, size_t size);
/// Returns the same memory as glint_alloc, but not zeroed, and in large pages where the system has them. For
/// megabytes that are written at once.
void *glint_alloc_large(size_t count, size_t size);

/// Resizes a block for short-lived data from `from` to `to` bytes; with `from` 0 it allocates a block. The memory is
/// not zeroed and is aligned to 16 bytes. A large block goes back to the system as soon as it is freed, so that it
/// does not add to the peak of later allocations. NULL: out of memory, and the old block stays.
void *glint_scratch_resize(void *memory, size_t from, size_t to);
/// Gives the pages between two bytes of a block back to the system; their contents are lost. bytes: the size of the
/// block since it was last resized.
void glint_scratch_drop(void *memory, size_t bytes, size_t from, size_t to);
void glint_scratch_free(void *memory, size_t bytes);

/// Prefetches memory that is read or written soon into the second-level cache, because the first level is full of
/// current data.
static inline void glint_prefetch(const void *memory, size_t bytes)
{
    for (size_t i = 0; i < bytes; i += 64)
        __builtin_prefetch((const char *)memory + i, 0, 2);
}

#endif
