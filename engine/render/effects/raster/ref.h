// The reference of raster, for one type of real; included by ref.c after ref/real.h.

static void NAME(raster)(const glint_raster_args *args)
{
    const glint_cast_args *cast = &args->cast;
    const glint_prim *prims = cast->geometry->prims;
    bool eye = !cast->camera->orthographic;
    for (uint32_t group = 0; group < cast->group_count; group++)
        cast->hits[group] = 0;
    for (uint32_t i = 0; i < cast->group_count * GLINT_GROUP; i++) {
        REAL best = INFINITY;
        uint32_t best_prim = GLINT_MISS;
        bool active = cast->active[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
        NAME(vec3) direction = NAME(direction_of)(eye ? cast->camera : NULL, cast->direction, i);
        NAME(vec3) origin = eye ? NAME(rounded)(cast->camera->eye) : NAME(load)(cast->origin, i);
        for (uint32_t k = 0; active && k < args->entry_count; k++) {
            uint32_t prim = args->entries[k].prim;
            REAL t = NAME(triangle_t)(cast->geometry, &prims[prim], origin, direction, false);
            note_test(cast->tests);
            bool first = t == best && best_prim != GLINT_MISS && prims[prim].id < prims[best_prim].id;
            if (t > 0 && t < INFINITY && (t < best || first)) {
                best = t;
                best_prim = prim;
            }
        }
        ((REAL *)cast->t)[i] = best;
        cast->prim[i] = best_prim;
        if (best_prim != GLINT_MISS)
            cast->hits[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
    }
}
