#include "engine/base/alloc.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#ifndef MAP_ANONYMOUS // in POSIX since 2024; older systems have MAP_ANON only
#define MAP_ANONYMOUS MAP_ANON
#endif

#define LARGE_PAGE ((size_t)2 << 20)

/// Returns the bytes of count * size, at least one, rounded up to a multiple of `alignment`; 0: too many.
static size_t whole_bytes(size_t count, size_t size, size_t alignment)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || bytes > SIZE_MAX - alignment)
        return 0;
    return bytes ? (bytes + alignment - 1) / alignment * alignment : alignment;
}

void *glint_alloc(size_t count, size_t size)
{
    const size_t bytes = whole_bytes(count, size, 64);
    void *memory = bytes ? aligned_alloc(64, bytes) : NULL;
    if (memory)
        memset(memory, 0, bytes);
    return memory;
}

/// Asks the system for large pages. The part after the last whole large page stays in small pages, and so does the
/// whole block if the system refuses.
static void want_large_pages(void *memory, size_t bytes)
{
#ifdef MADV_HUGEPAGE
    madvise(memory, bytes / LARGE_PAGE * LARGE_PAGE, MADV_HUGEPAGE);
#else
    (void)memory, (void)bytes;
#endif
}

void *glint_alloc_large(size_t count, size_t size)
{
    const size_t bytes = whole_bytes(count, size, 64);
    if (bytes < 2 * LARGE_PAGE)
        return bytes ? aligned_alloc(64, bytes) : NULL;
    const size_t whole = whole_bytes(count, size, LARGE_PAGE);
    void *memory = whole ? aligned_alloc(LARGE_PAGE, whole) : NULL;
    if (memory)
        // includes the last page if it is at least half full; stays within `whole`
        want_large_pages(memory, bytes + LARGE_PAGE / 2);
    return memory;
}

/// Blocks of at least this many bytes are mapped, because the C library may not return heap memory to the system.
#define PAGED_FROM ((size_t)256 << 10)

void *glint_scratch_resize(void *memory, size_t from, size_t to)
{
    if (to < PAGED_FROM)
        return from < PAGED_FROM ? realloc(memory, to ? to : 1) : memory;
    void *pages = mmap(NULL, to, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED)
        return NULL;
    if (to >= 2 * LARGE_PAGE)
        want_large_pages(pages, to);
    if (memory)
        memcpy(pages, memory, from < to ? from : to);
    glint_scratch_free(memory, from);
    return pages;
}

void glint_scratch_free(void *memory, size_t bytes)
{
    if (bytes < PAGED_FROM)
        free(memory);
    else if (memory)
        munmap(memory, bytes);
}

void glint_scratch_drop(void *memory, size_t bytes, size_t from, size_t to)
{
#ifdef MADV_DONTNEED
    const long page = sysconf(_SC_PAGESIZE);
    if (bytes < PAGED_FROM || page <= 0)
        return;
    // whole pages inside the range
    const size_t first = (from + (size_t)page - 1) / (size_t)page, last = to / (size_t)page;
    if (first < last)
        madvise((char *)memory + first * (size_t)page, (last - first) * (size_t)page, MADV_DONTNEED);
#else
    (void)memory, (void)bytes, (void)from, (void)to;
#endif
}
