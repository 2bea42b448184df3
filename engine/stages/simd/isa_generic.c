// The stages in the compiler's own vectors, for processors without a vocabulary of their own.
#include "engine/stages/simd/generic.h"

#define GLINT_STAGES_SYMBOL glint_stages_generic
#define GLINT_STAGES_NAME "generic"
#include "engine/stages/simd/isa.h"
