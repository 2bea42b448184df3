// The reference of vertex, for one type of real; included by ref.c after ref/real.h.

static void NAME(vertex)(const glint_vertex_args *args)
{
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++) {
        if (!(args->wanted[i / GLINT_GROUP] >> i % GLINT_GROUP & 1))
            continue;
        const glint_prim *prim = &args->prims[args->prim[i]];
        const uint32_t *at = args->shading_points[prim->shading_points].at;
        const glint_shading_point_light *light = args->light[args->back[i / GLINT_GROUP] >> i % GLINT_GROUP & 1];
        NAME(vec3) corner[3], origin = args->camera ? NAME(rounded)(args->camera->eye) : NAME(load)(args->origin, i);
        NAME(relative_corners)(prim, origin, args->scale, corner);
        NAME(ray_edges) seen = NAME(make_ray_edges)(corner, NAME(direction_of)(args->camera, args->direction, i));
        REAL inverse = 1 / NAME(sum_of_edges)(seen), w[3];
        for (int j = 0; j < 3; j++)
            w[j] = seen.e[j] * inverse;
        for (int term = 0; term < 2; term++)
            for (int c = 0; c < 3 && args->sum[term][c]; c++) {
                double x[3];
                for (int j = 0; j < 3; j++)
                    x[j] = light[at[j]].term[term][c];
                double between = ((double)w[0] * x[0] + (double)w[1] * x[1]) + (double)w[2] * x[2];
                args->sum[term][c][i] += at[0] == at[1] && at[0] == at[2] ? x[0] : between;
            }
    }
}
