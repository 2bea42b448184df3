/// Shared by the fuzzers. libFuzzer calls LLVMFuzzerTestOneInput with bytes of its own making; a crash, a sanitizer's
/// report, a false FUZZ_CHECK or an input of more than ten seconds is a finding, and its bytes are saved.
#ifndef GLINT_TESTS_FUZZ_H
#define GLINT_TESTS_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define FUZZ_CHECK(good, ...) \
    do { \
        if (!(good)) { \
            fprintf(stderr, "%s:%d: %s does not hold: ", __FILE__, __LINE__, #good); \
            fprintf(stderr, __VA_ARGS__); \
            fputc('\n', stderr); \
            abort(); \
        } \
    } while (0)

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t room, unsigned seed);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t room); ///< libFuzzer's own

/// Writes the bytes to a file of this process in memory, for readers that take a path. Returns the path.
const char *fuzz_file(const uint8_t *data, size_t size);
/// The same with an ending of its name, ".ply".
const char *fuzz_file_as(const char *ending, const uint8_t *data, size_t size);

#endif
