// 8-bit pixel values.
#include "engine/render/stages/film/tone.h"

KERNEL(tone, glint_tone_args)
