/// Keys: XXH3-128 over exactly the bytes something reads. Internal.
#ifndef GLINT_BASE_HASH_H
#define GLINT_BASE_HASH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct glint_key {
    uint64_t high, low;
} glint_key;

/// Continues `key` with `size` bytes; start from (glint_key){ 0 }. The bytes must have no padding and no pointers.
glint_key glint_key_add(glint_key key, const void *bytes, size_t size);
glint_key glint_key_add_string(glint_key key, const char *string);
void glint_key_hex(glint_key key, char hex[33]);

static inline bool glint_key_equal(glint_key a, glint_key b) { return a.high == b.high && a.low == b.low; }

#endif
