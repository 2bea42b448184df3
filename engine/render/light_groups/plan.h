/// The lights of a frame's light passes. Internal.
#ifndef GLINT_LIGHT_GROUPS_PLAN_H
#define GLINT_LIGHT_GROUPS_PLAN_H

#include "engine/render/plan/plan.h"

#define GLINT_NO_GROUP UINT32_MAX
#define GLINT_LIGHT_REST "ambient" ///< the pass of the light that no lamp sends

/// Light is also summed for each group of lights. Passes come first among the groups. If the rest is requested, all
/// lights without a pass form one more group.
struct glint_light_groups {
    uint32_t pass_count, count; ///< number of passes of the frame; number of groups
    uint32_t rest; ///< the pass of the rest, whose group stays empty; GLINT_NO_GROUP: none
    char (*name)[GLINT_NAME_SIZE]; ///< name of each pass
    char *list; ///< the names, separated by commas
    uint32_t *of_light; ///< the group of each light of the scene, or GLINT_NO_GROUP
    double (*ambient)[3]; ///< for each group, its lights' share of the plan's ambient light
    bool has_ambient; ///< some share is above 0
};

/// Finds the groups named in the plan's description, and the group of each light.
glint_status glint_light_groups_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error);
void glint_light_groups_release(glint_plan *plan);
/// Continues a key with the names of the passes and the groups of all lights.
glint_key glint_light_groups_key(const glint_plan *plan, glint_key key);
/// Continues a key with the lights of a light pass. The file of a pass does not depend on the other passes.
glint_key glint_light_pass_key(const glint_plan *plan, int number, glint_key key);
/// Returns whether two plans have the same passes, and each light the same group.
bool glint_light_groups_equal(const glint_plan *a, const glint_plan *b);

#endif
