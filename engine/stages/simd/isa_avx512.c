// The stages for AVX-512.
#include "engine/stages/simd/avx512.h"

#define GLINT_STAGES_SYMBOL glint_stages_avx512
#define GLINT_STAGES_NAME "avx512"
#include "engine/stages/simd/isa.h"
