/// Pictures with other strengths and colours of their lights. Internal; the public part is in glint_files.h.
#ifndef GLINT_FILM_RELIGHT_H
#define GLINT_FILM_RELIGHT_H

#include "engine/film/image.h"

/// Turns the part of the beauty that is in no light pass into one more pass, "...", unless it is only rounding. The
/// image then has no beauty. half: the file stores the passes as half floats.
glint_status glint_image_split_rest(glint_image *image, bool half, glint_error *error);

#endif
