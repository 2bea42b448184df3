#include "engine/files/picture/npy.h"

#include "engine/files/picture/pfm.h"

#include <stdio.h>

#define HEAD_ALIGN 64 // The size of everything before the values is a multiple of this; bytes

bool glint_npy_encode(int width, int height, int channels, float *const plane[], glint_bytes *out)
{
    char head[2 * HEAD_ALIGN] = "\x93NUMPY\x01";
    const size_t fixed = 10, pixels = (size_t)width * (size_t)height;
    const int length =
        snprintf(head + fixed, sizeof head - fixed, "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d, %d), }",
                 height, width, channels);
    const size_t used = fixed + (size_t)length + 1, size = (used + HEAD_ALIGN - 1) / HEAD_ALIGN * HEAD_ALIGN;
    memset(head + fixed + length, ' ', size - fixed - (size_t)length);
    head[size - 1] = '\n';
    head[8] = (char)((size - fixed) & 0xff);
    head[9] = (char)((size - fixed) >> 8);
    if (!glint_bytes_reserve(out, size + pixels * (size_t)channels * sizeof(float)) ||
        !glint_bytes_append(out, head, size))
        return false;
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < channels; c++, out->size += sizeof(float)) {
            const float value = glint_pfm_value(channels, plane[c][i]);
            memcpy(out->data + out->size, &value, sizeof value); // only little-endian machines are supported
        }
    return true;
}
