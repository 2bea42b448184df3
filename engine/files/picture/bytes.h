/// A growing buffer of bytes. Internal.
#ifndef GLINT_IMAGE_BYTES_H
#define GLINT_IMAGE_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/// {0} is empty. The owner calls free(bytes.data).
typedef struct glint_bytes {
    uint8_t *data;
    size_t size, capacity;
} glint_bytes;

/// Reserves space for `extra` more bytes. False: out of memory; the bytes are unchanged.
static inline bool glint_bytes_reserve(glint_bytes *bytes, size_t extra)
{
    if (extra <= bytes->capacity - bytes->size)
        return true;
    if (extra > SIZE_MAX / 4 || bytes->size > SIZE_MAX / 4)
        return false;
    size_t capacity = bytes->capacity + bytes->capacity / 2;
    if (capacity < bytes->size + extra)
        capacity = bytes->size + extra;
    uint8_t *data = realloc(bytes->data, capacity);
    if (!data)
        return false;
    bytes->data = data;
    bytes->capacity = capacity;
    return true;
}

static inline bool glint_bytes_append(glint_bytes *bytes, const void *data, size_t size)
{
    if (!glint_bytes_reserve(bytes, size))
        return false;
    if (size)
        memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
    return true;
}

#endif
