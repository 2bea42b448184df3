#include "tests/fuzz/fuzz.h"

#include <unistd.h>

static char path[64];

static void remove_file(void) { unlink(path); }

const char *fuzz_file(const uint8_t *data, size_t size)
{
    if (!*path) {
        snprintf(path, sizeof path, "/dev/shm/glint-fuzz-%ld", (long)getpid());
        atexit(remove_file);
    }
    FILE *file = fopen(path, "wb");
    FUZZ_CHECK(file && fwrite(data, 1, size, file) == size, "%s", path);
    fclose(file);
    return path;
}
