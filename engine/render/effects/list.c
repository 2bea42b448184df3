/// The table of the stages: the only file that names all of them.
#include "engine/render/effects/list.h"
#include "engine/render/plan/plan.h"

#define DECLARED(id, name) extern const glint_stage glint_stage_##name;
GLINT_STAGES(DECLARED)

#define ROW(id, name) [GLINT_STAGE_##id] = &glint_stage_##name,
const glint_stage *const glint_stage_table[GLINT_STAGE_COUNT] = { GLINT_STAGES(ROW) };
