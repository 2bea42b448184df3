#include "tests/fuzz/fuzz.h"

#include <string.h>
#include <unistd.h>

#define PATHS 8

static char paths[PATHS][64];

static void remove_files(void)
{
    for (int i = 0; i < PATHS && *paths[i]; i++)
        unlink(paths[i]);
}

const char *fuzz_file_as(const char *ending, const uint8_t *data, size_t size)
{
    char path[64];
    int i = 0;
    snprintf(path, sizeof path, "/dev/shm/glint-fuzz-%ld%s", (long)getpid(), ending);
    while (i < PATHS && *paths[i] && strcmp(paths[i], path) != 0)
        i++;
    FUZZ_CHECK(i < PATHS, "%s", ending);
    if (!*paths[0])
        atexit(remove_files);
    memcpy(paths[i], path, sizeof path);
    FILE *file = fopen(path, "wb");
    FUZZ_CHECK(file && fwrite(data, 1, size, file) == size, "%s", path);
    fclose(file);
    return paths[i];
}

const char *fuzz_file(const uint8_t *data, size_t size) { return fuzz_file_as("", data, size); }
