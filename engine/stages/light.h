// light: what one light does at each point, before shadows and colours. The geometry is real; what needs no more than
// float (square root, division, logarithm) follows in float over the whole group. Contract: stages.h.

typedef struct R(lit_group) {
    _Alignas(64) float along[GLINT_GROUP]; ///< n.l, in the light's units
    _Alignas(64) float distance2[GLINT_GROUP];
    _Alignas(64) float x[GLINT_GROUP], x_less_1[GLINT_GROUP]; ///< (r.v)^2 or (n.h)^2, and that less 1
    unsigned phong, blinn; ///< lanes by the highlight of their material
    unsigned lit, shiny; ///< out
} R(lit_group);

static inline rm R(phong)(vr nl, vr nv, vr lv, vr l2a, vr *x)
{
    vr rv = (r_set(2) * nl) * nv - lv;
    *x = r_min((rv * rv) / l2a, r_set(1));
    return r_lt(r_set(0), rv);
}

static inline rm R(blinn)(vr nl, vr nv, vr lv, vr l2, vr a, vr *x)
{
    vr w = r_sqrt(l2 * a);
    vr num = ((nl * nl) * a + (nv * nv) * l2) + ((r_set(2) * nl) * nv) * w;
    vr den = (r_set(2) * w) * (w + lv);
    *x = r_min(num / den, r_set(1));
    return rm_and(r_lt(r_set(0), num), r_lt(r_set(0), den));
}

/// The real part of one vector of lanes.
static inline void R(light_lanes)(const glint_light_args *args, R(group_place) place, R(group_directions) directions,
                                  int i, unsigned open, R(lit_group) * group)
{
    const size_t at = (size_t)place.g * GLINT_GROUP;
    const vr zero = r_set(0), scale = r_set(args->scale);
    vr n[3], l[3];
    for (int k = 0; k < 3; k++) {
        n[k] = r_load((const real *)args->normal[k] + at + i);
        l[k] = r_set(args->position[k]);
        if (!args->directional)
            l[k] = (l[k] - r_load((const real *)args->point[k] + at + i)) * scale;
    }
    vr l2 = DOT(l, l), nl = DOT(n, l);
    const unsigned lit = rm_bits(r_lt(zero, nl)) & open >> i & ((1u << VR) - 1);
    group->lit |= lit << i;
    if (!lit)
        return;
    r_store_f(group->along + i, nl);
    r_store_f(group->distance2 + i, l2);
    if (args->attenuated) {
        const vr c0 = r_set(args->coefficients[0]), c1 = r_set(args->coefficients[1]),
                 c2 = r_set(args->coefficients[2]);
        vr distance = r_sqrt(l2) / scale;
        r_store_f(args->attenuation + at + i, r_set(1) / (c0 + (c1 * distance + c2 * (distance * distance))));
    }
    const unsigned phong = group->phong >> i & lit, blinn = group->blinn >> i & lit;
    if (!(phong | blinn))
        return;
    vr d[3];
    R(load_direction)(directions, args->direction, at, i, d);
    vr a = DOT(d, d), nv = -DOT(n, d), lv = -DOT(l, d), x = r_set(1);
    rm some = rm_from_bits(0);
    if (phong)
        some = rm_and(rm_from_bits(phong), R(phong)(nl, nv, lv, l2 * a, &x));
    if (blinn) {
        vr xb;
        some = rm_or(some, rm_and(rm_from_bits(blinn), R(blinn)(nl, nv, lv, l2, a, &xb)));
        x = r_select(rm_from_bits(blinn), xb, x);
    }
    r_store_f(group->x + i, x);
    r_store_f(group->x_less_1 + i, x - r_set(1));
    group->shiny |= rm_bits(rm_and(some, r_le(r_set(0x1p-126), x))) << i;
}

/// The float part of one group.
static inline void R(finish_light)(const glint_light_args *args, size_t at, const R(lit_group) * group)
{
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm lit = fm_from_bits(group->lit >> i & ((1u << VF) - 1));
        vf cosine = f_load(group->along + i);
        if (!args->directional)
            cosine = cosine / f_sqrt(f_load(group->distance2 + i));
        f_store(args->cosine + at + i, f_select(lit, f_min(cosine, f_set(1)), f_set(0)));
        if (args->attenuated) {
            vf attenuation = f_min(f_load(args->attenuation + at + i), f_set(GLINT_ATTENUATION_MAX));
            f_store(args->attenuation + at + i, f_select(lit, attenuation, f_set(0)));
        }
        if (args->highlights) {
            const fm shiny = fm_from_bits(group->shiny >> i & ((1u << VF) - 1));
            vf log2 = f_log2(f_select(shiny, f_load(group->x + i), f_set(1)), f_load(group->x_less_1 + i));
            f_store(args->log2_specular + at + i, f_select(shiny, f_set(0.5f) * log2, f_set(GLINT_NO_SPECULAR)));
        }
    }
}

/// Lanes by the highlight of their material.
static inline void R(sort_highlights)(const glint_light_args *args, size_t at, unsigned left, R(lit_group) * group)
{
    group->phong = group->blinn = 0;
    while (args->highlights && left) {
        const uint32_t material = args->material[at + (unsigned)__builtin_ctz(left)];
        const unsigned lanes = lanes_equal(args->material + at, material);
        if (args->materials[material].highlight == GLINT_HIGHLIGHT_PHONG)
            group->phong |= lanes;
        else if (args->materials[material].highlight == GLINT_HIGHLIGHT_BLINN)
            group->blinn |= lanes;
        left &= ~lanes;
    }
}

static void R(light)(const glint_light_args *args)
{
    R(lit_group) group = { .lit = 0 };
    for (R(group_place) place = { 0 }; place.g < args->group_count; R(next_group)(args->camera, &place)) {
        const uint32_t g = place.g;
        const size_t at = (size_t)g * GLINT_GROUP;
        const unsigned open = args->hits[g] & ~(unsigned)args->dark[g];
        group.lit = group.shiny = 0;
        if (open) {
            const R(group_directions) directions = R(directions_of)(args->camera, place.x, place.y);
            R(sort_highlights)(args, at, open, &group);
            for (int i = 0; i < GLINT_GROUP; i += VR)
                R(light_lanes)(args, place, directions, i, open, &group);
        }
        args->lit[g] = (uint16_t)group.lit;
        if (group.lit)
            R(finish_light)(args, at, &group);
    }
}
