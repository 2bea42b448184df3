// lit_surface: surface and the light of one plain lamp, a group at a time, so that a point and its normal need not go
// through memory. The arithmetic is theirs. Contract: stages.h.

/// A group that shows one primitive in every lane, and that from where it is not dark: the common case. Returns whether
/// it is one.
INNER bool R(lit_whole)(const glint_surface_args *surface, const glint_light_args *light, R(surface_walk) * walk,
                        R(group_place) place, R(lit_point) * point, R(lit_group) * group)
{
    const size_t at = (size_t)place.g * GLINT_GROUP;
    if ((surface->hits[place.g] & light->hits[place.g]) != 0xffff)
        return false;
    const uint32_t id = surface->only ? *surface->only : surface->prim[at];
    if (!surface->only && lanes_equal(surface->prim + at, id) != 0xffff)
        return false;
    R(look_at)(surface, walk, id);
    const glint_prim *prim = walk->seen.prim;
    if (!prim->two_sided)
        return false;
    const uint32_t highlight = light->highlights ? light->materials[prim->material].highlight : GLINT_HIGHLIGHT_NONE;
    unsigned back = 0;
    point->phong = highlight == GLINT_HIGHLIGHT_PHONG ? 0xffff : 0;
    point->blinn = highlight == GLINT_HIGHLIGHT_BLINN ? 0xffff : 0;
    point->directions = R(directions_of)(surface->camera, place.x, place.y);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        R(found) found;
        R(find_lanes)(surface, &walk->seen, point->directions, at, i, false, &found);
        if (surface->box)
            R(enclose)(&walk->box, found.point, true, rm_from_bits(0));
        back |= rm_bits(found.back) << i;
        for (int k = 0; k < 3; k++) {
            r_store((real *)surface->point[k] + at + i, found.point[k]);
            point->point[k] = found.point[k];
            point->normal[k] = found.normal[k];
            point->direction[k] = found.direction[k];
        }
        point->aimed = true;
        point->viewed = highlight != GLINT_HIGHLIGHT_NONE;
        if (point->viewed) {
            point->a = DOT(found.direction, found.direction);
            point->nv = r_select(found.back, found.away, -found.away);
        }
        R(light_lanes)(light, LIGHT_PLAIN, 0, NULL, at, i, 0xffff, point, group);
    }
    lanes_put(surface->material + at, 0xffff, prim->material);
    surface->back[place.g] = (uint16_t)back;
    surface->dark[place.g] = 0;
    walk->turned = walk->turned || back;
    return true;
}

static void R(lit_surface)(const glint_surface_args *surface, const glint_light_args *light)
{
    R(surface_walk) walk;
    R(lit_point) point = { 0 };
    R(lit_group) group;
    R(begin_walk)(&walk);
    group.brightest = f_set(GLINT_NO_SPECULAR);
    for (R(group_place) place = { 0 }; place.g < surface->group_count; R(next_group)(surface->camera, &place)) {
        const uint32_t g = place.g;
        group.lit = group.shiny = 0;
        if (!surface->hits[g]) {
            surface->back[g] = surface->dark[g] = 0;
        } else if (!R(lit_whole)(surface, light, &walk, place, &point, &group)) {
            R(surface_group)(surface, &walk, place, false);
            R(light_group)(light, LIGHT_PLAIN, 1, NULL, place, &point, &group);
        }
        light->lit[0][g] = (uint16_t)group.lit;
        if (group.lit)
            R(finish_light)(light, LIGHT_PLAIN, 0, (size_t)g * GLINT_GROUP, &group);
    }
    R(end_walk)(surface, &walk);
    R(say_brightest)(light, 0, &group);
}
