// The stage `unit`: ways to lights and to the eye, as shaders read them. Contract: contract/program.h.

/// Which ways a call finds: each is compiled by itself.
typedef enum unit_way { TO_EYE, TO_PLACE, TO_EACH } unit_way;

/// VD of them; across and down: the camera's axes, of these lanes.
INNER void unit_lanes(const glint_unit_args *args, const unit_way way, const double *across, const double *down,
                      size_t at)
{
    vd d[3];
    for (int c = 0; c < 3; c++) {
        if (way == TO_EYE)
            d[c] = -(d_load(across + c * GLINT_GROUP) + d_load(down + c * GLINT_GROUP));
        else
            d[c] = way == TO_PLACE ? d_set(args->place[c]) : d_load(args->to[c] + at);
        if (way != TO_EYE && args->from[0])
            d[c] = d[c] - d_load(args->from[c] + at);
    }
    const vd length = d_sqrt((d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]);
    for (int c = 0; c < 3; c++)
        d_store(args->unit[c] + at, d[c] / length);
    d_store(args->length + at, length);
}

INNER void unit_groups(const glint_unit_args *args, const unit_way way)
{
    const glint_unit_args call = *args; // stores may not change it
    const double *across = NULL, *down = NULL;
    for (size_t k = 0; k < call.group_count; k++) {
        if (way == TO_EYE) {
            const uint32_t g = call.groups[k], columns = call.camera->groups_across;
            across = (const double *)call.camera->across + (size_t)3 * GLINT_GROUP * (g % columns);
            down = (const double *)call.camera->down + (size_t)3 * GLINT_GROUP * (g / columns);
        }
        for (size_t i = 0; i < GLINT_GROUP; i += VD)
            unit_lanes(&call, way, across + i, down + i, k * GLINT_GROUP + i);
    }
}

static void unit(const glint_unit_args *args)
{
    if (args->camera)
        unit_groups(args, TO_EYE);
    else if (args->place)
        unit_groups(args, TO_PLACE);
    else
        unit_groups(args, TO_EACH);
}
