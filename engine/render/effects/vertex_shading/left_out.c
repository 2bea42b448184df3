#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(vertex_shading, "vertex_shading", "mesh.shading", "flat and Gouraud shading",
               glint_plan_is_lit(plan) && plan->geometry->table.shading_point_count > 0)
