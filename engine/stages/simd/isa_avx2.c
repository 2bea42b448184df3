// The stages for AVX2.
#include "engine/stages/simd/avx2.h"

#define GLINT_STAGES_SYMBOL glint_stages_avx2
#define GLINT_STAGES_NAME "avx2"
#include "engine/stages/simd/isa.h"
