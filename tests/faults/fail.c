// A library to preload. It counts a process's allocations or writes, and makes one of these calls fail, or that call
// and all later ones. From the environment: FAULT_KIND "alloc" or "write", FAULT_AT the number of the call, 0 for
// none, FAULT_ON to let later calls fail too, FAULT_FD the descriptor to write the count to at the end. Only glibc
// exports the functions behind malloc.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);

static atomic_long alloc_count, write_count;
static long at;
static bool goes_on, is_alloc, is_write;
static int count_fd = -1;

__attribute__((constructor)) static void read_environment(void)
{
    const char *kind = getenv("FAULT_KIND"), *number = getenv("FAULT_AT"), *fd = getenv("FAULT_FD");
    is_alloc = kind && strcmp(kind, "alloc") == 0;
    is_write = kind && strcmp(kind, "write") == 0;
    at = number ? atol(number) : 0;
    goes_on = getenv("FAULT_ON") != NULL;
    count_fd = fd ? atoi(fd) : -1;
    alloc_count = 0; // does not count the loader's allocations
}

__attribute__((destructor)) static void tell_count(void)
{
    char text[32];
    const int size = snprintf(text, sizeof text, "%ld\n", is_alloc ? (long)alloc_count : (long)write_count);
    ssize_t (*real)(int, const void *, size_t) = (ssize_t(*)(int, const void *, size_t))dlsym(RTLD_NEXT, "write");
    if (count_fd >= 0 && real && real(count_fd, text, (size_t)size) < 0)
        _exit(99);
}

static bool fails(atomic_long *count, bool counts)
{
    if (!counts)
        return false;
    const long number = atomic_fetch_add(count, 1) + 1;
    return at > 0 && (number == at || (goes_on && number > at));
}

static bool no_memory(void)
{
    if (!fails(&alloc_count, is_alloc))
        return false;
    errno = ENOMEM;
    return true;
}

void *malloc(size_t size) { return no_memory() ? NULL : __libc_malloc(size); }
void *calloc(size_t count, size_t size) { return no_memory() ? NULL : __libc_calloc(count, size); }
void *realloc(void *block, size_t size) { return size && no_memory() ? NULL : __libc_realloc(block, size); }
void *memalign(size_t boundary, size_t size) { return no_memory() ? NULL : __libc_memalign(boundary, size); }
void *aligned_alloc(size_t boundary, size_t size) { return no_memory() ? NULL : __libc_memalign(boundary, size); }

int posix_memalign(void **out, size_t boundary, size_t size)
{
    void *block = no_memory() ? NULL : __libc_memalign(boundary, size);
    if (block)
        *out = block;
    return block ? 0 : ENOMEM;
}

// ---- Calls that write a file ----

static bool no_space(void)
{
    if (!fails(&write_count, is_write))
        return false;
    errno = ENOSPC;
    return true;
}

#define REAL(type, name) type real = (type)dlsym(RTLD_NEXT, name)
typedef ssize_t (*write_function)(int, const void *, size_t);
typedef int (*file_function)(int);
typedef int (*rename_function)(const char *, const char *);
typedef int (*renameat_function)(int, const char *, int, const char *);

ssize_t write(int file, const void *data, size_t size)
{
    REAL(write_function, "write");
    return no_space() ? -1 : real(file, data, size);
}

int fsync(int file)
{
    REAL(file_function, "fsync");
    return no_space() ? -1 : real(file);
}

int rename(const char *from, const char *to)
{
    REAL(rename_function, "rename");
    return no_space() ? -1 : real(from, to);
}

int renameat(int from_folder, const char *from, int to_folder, const char *to)
{
    REAL(renameat_function, "renameat");
    return no_space() ? -1 : real(from_folder, from, to_folder, to);
}
