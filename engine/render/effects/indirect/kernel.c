// The directions of indirect light.
#include "engine/render/effects/indirect/kernel_scatter.h"

#if GLINT_WITH(INDIRECT)
KERNEL(scatter, glint_scatter_args)
#endif
