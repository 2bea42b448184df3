/// Keys: XXH3-128 over exactly the bytes that something depends on. Internal.
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

/// Combines two keys in a few instructions. Both must be hashes already. For a given `key`, different parts give
/// different results.
static inline glint_key glint_key_mix(glint_key key, glint_key part)
{
    const uint64_t low = (key.low ^ part.low) * UINT64_C(0x9e3779b97f4a7c15);
    const uint64_t high = (key.high ^ part.high) * UINT64_C(0xc2b2ae3d27d4eb4f);
    const uint64_t folded = low + (high << 31 | high >> 33);
    return (glint_key) { .high = high ^ (folded << 17 | folded >> 47), .low = folded };
}

static inline bool glint_key_equal(glint_key a, glint_key b) { return a.high == b.high && a.low == b.low; }

#endif
