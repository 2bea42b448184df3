#include "engine/base/hash.h"

#include <stdio.h>
#include <string.h>
#define XXH_INLINE_ALL // the renderer needs no library but C's
#include <xxhash.h>

glint_key glint_key_add(glint_key key, const void *bytes, size_t size)
{
    const XXH128_hash_t part = XXH3_128bits_withSeed(bytes, size, key.low);
    // The seed of the hash of `part` carries the low half of the key; a second, short hash folds in the high half and
    // the length.
    const uint64_t chain[5] = { key.high, key.low, part.high64, part.low64, size };
    const XXH128_hash_t sum = XXH3_128bits(chain, sizeof chain);
    return (glint_key) { sum.high64, sum.low64 };
}

glint_key glint_key_add_string(glint_key key, const char *string) { return glint_key_add(key, string, strlen(string)); }

void glint_key_hex(glint_key key, char hex[33])
{
    snprintf(hex, 33, "%016llx%016llx", (unsigned long long)key.high, (unsigned long long)key.low);
}
