/// A mask: the coverage of each pixel of a rectangle. Internal.
#ifndef GLINT_TEXT_MASK_H
#define GLINT_TEXT_MASK_H

#include <stdint.h>

typedef struct glint_mask {
    int width, height;
    uint8_t *coverage; ///< 0 .. 255, top row first
} glint_mask;

#endif
