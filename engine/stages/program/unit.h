// The stage `unit`: ways to lights and to the eye, as shaders read them. Contract: contract/program.h.

static void unit(const glint_unit_args *args)
{
    const size_t step = args->same ? 0 : ~(size_t)0;
    const double *across = NULL, *down = NULL;
    for (size_t group = 0; group < args->group_count * (size_t)GLINT_GROUP; group += GLINT_GROUP) {
        if (args->camera) {
            const uint32_t g = args->groups[group / GLINT_GROUP], columns = args->camera->groups_across;
            across = (const double *)args->camera->across + (size_t)3 * GLINT_GROUP * (g % columns);
            down = (const double *)args->camera->down + (size_t)3 * GLINT_GROUP * (g / columns);
        }
        for (size_t i = 0; i < GLINT_GROUP; i += VD) {
            vd d[3];
            for (int c = 0; c < 3 && args->camera; c++)
                d[c] = -(d_load(across + c * GLINT_GROUP + i) + d_load(down + c * GLINT_GROUP + i));
            for (int c = 0; c < 3 && !args->camera; c++) {
                d[c] = d_load(args->to[c] + (group & step) + i);
                if (args->from[0])
                    d[c] = d[c] - d_load(args->from[c] + group + i);
            }
            const vd length = d_sqrt((d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]);
            for (int c = 0; c < 3; c++)
                d_store(args->unit[c] + group + i, d[c] / length);
            d_store(args->length + group + i, length);
        }
    }
}
