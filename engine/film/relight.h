/// Pictures with other strengths and colours of their lights. Internal; see glint.h for the public part.
#ifndef GLINT_FILM_RELIGHT_H
#define GLINT_FILM_RELIGHT_H

#include "engine/film/image.h"

/// Makes what the light passes of an image leave of its beauty one more pass, "...", where that is more than rounding. The image has
/// no beauty then. half: passes are of 16 bits, as they were read.
glint_status glint_image_split_rest(glint_image *image, bool half, glint_error *error);

#endif
