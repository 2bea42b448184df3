// The stages for SSE2.
#include "engine/stages/simd/sse2.h"

#define GLINT_STAGES_SYMBOL glint_stages_sse2
#define GLINT_STAGES_NAME "sse2"
#include "engine/stages/simd/isa.h"
