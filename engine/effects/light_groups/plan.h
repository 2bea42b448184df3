/// Which lights a frame's light passes hold. Internal.
#ifndef GLINT_LIGHT_GROUPS_PLAN_H
#define GLINT_LIGHT_GROUPS_PLAN_H

#include "engine/plan/plan.h"

#define GLINT_NO_GROUP UINT32_MAX
#define GLINT_LIGHT_REST "ambient" ///< the pass of the light that no lamp sends

/// Light is summed once more for each group of lights. Passes come first among the groups; where the rest is wanted, all lights
/// without a pass of their own are one more group.
struct glint_light_groups {
    uint32_t pass_count, count; ///< passes of the frame; groups
    uint32_t rest; ///< the pass that is the rest, whose group stays empty; GLINT_NO_GROUP: none is
    char (*name)[GLINT_NAME_SIZE]; ///< of each pass
    char *list; ///< these, divided by commas
    uint32_t *of_light; ///< the group of each light of the scene, or GLINT_NO_GROUP
    double (*ambient)[3]; ///< of each group, the share of the plan's ambient light that its lights bring
    bool has_ambient; ///< some share is above 0
};

/// Finds the groups that the plan's description names. Fails where a name is no group's of the scene.
glint_status glint_plan_find_light_groups(glint_plan *plan, const glint_scene *scene, glint_error *error);
void glint_light_groups_free(struct glint_light_groups *groups); ///< NULL: nothing
/// The group of a light of the scene; GLINT_NO_GROUP also in frames without light passes.
uint32_t glint_light_group_of(const glint_plan *plan, size_t light);
/// Continues a key with the names of the passes and the groups of all lights.
glint_key glint_light_groups_key(const glint_plan *plan, glint_key key);
/// Continues a key with which lights one of the passes holds: files of the same pass are the same whatever the others are.
glint_key glint_light_pass_key(const glint_plan *plan, uint32_t pass, glint_key key);
/// Whether two plans have the same passes, and no light has another group.
bool glint_light_groups_equal(const glint_plan *a, const glint_plan *b);

#endif
