/// Memory for tables that kernels read. Internal.
#ifndef GLINT_BASE_ALLOC_H
#define GLINT_BASE_ALLOC_H

#include <stddef.h>

/// Zeroed memory, 64-byte aligned, of count * size bytes (at least one), checked for overflow; free() frees it.
void *glint_alloc(size_t count, size_t size);

#endif
