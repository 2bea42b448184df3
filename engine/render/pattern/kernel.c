// Patterns and shaders.
#include "engine/render/pattern/kernel_program.h"
#include "engine/render/pattern/kernel_unit.h"

#if GLINT_WITH(PROGRAM)
KERNEL(program, glint_program_args)
KERNEL(unit, glint_unit_args)
KERNEL(choose, glint_choose_args)
#endif
