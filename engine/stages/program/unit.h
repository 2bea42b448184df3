// The stage `unit`: ways to lights and to the eye, as shaders read them. Contract: contract/program.h.

/// d / by, where `by` is d's length.
static inline void divide_each(const vd d[3], vd by, vd q[3])
{
    for (int c = 0; c < 3; c++)
        q[c] = d[c] / by;
}

#ifdef GLINT_D_FUSED
#ifdef GLINT_D_INVERSE
/// 1 / by within 2^-53 of itself, without the divider, which a square root keeps. Returns whether it is, in all lanes: where
/// |1 - y by| is below 2^-53 once rounded, it was before. by: a root of a sum of squares, and so at most 2^512.
static inline bool find_inverse(vd by, vd *y)
{
    const vd one = d_set(1), guess = d_inverse(by), r = d_fnma(by, guess, one);
    const vd near = d_fma(d_fma(r, r, r), guess, guess);
    *y = d_fma(d_fnma(by, near, one), near, near);
    return dm_bits(d_lt(d_abs(d_fnma(by, *y, one)), d_set(0x1p-53))) == D_ALL;
}
#else
static inline bool find_inverse(vd by, vd *y)
{
    *y = d_set(1) / by;
    return dm_bits(d_le(by, d_set(0x1p400))) == D_ALL;
}
#endif

/// The same bits without three divisions, where |1 - y by| < 2^-53. If q is a neighbour of d / by, q + (d - q by) y with both steps
/// fused is d / by rounded to nearest (after P. Markstein, IBM J. Res. Dev. 34(1), 1990): what is rounded last is off by less than
/// 2^-53 of q's own error, and d / by is 2^-54 of a last place or more from where rounding turns. The first step makes q a
/// neighbour. Within the bounds nothing over- or underflows.
static inline void divide_by_length(const vd d[3], vd by, vd q[3])
{
    const vd least = d_min(d_min(d_abs(d[0]), d_abs(d[1])), d_abs(d[2]));
    vd y;
    if (!find_inverse(by, &y) || dm_bits(d_le(d_set(0x1p-400), least)) != D_ALL) {
        divide_each(d, by, q);
        return;
    }
    for (int c = 0; c < 3; c++) {
        q[c] = d[c] * y;
        for (int step = 0; step < 2; step++)
            q[c] = d_fma(d_fnma(q[c], by, d[c]), y, q[c]);
    }
}
#else
static inline void divide_by_length(const vd d[3], vd by, vd q[3]) { divide_each(d, by, q); }
#endif

/// Which ways a call finds: each is compiled by itself.
typedef enum unit_way { TO_EYE, TO_PLACE, TO_EACH } unit_way;

/// VD of them; across and down: the camera's axes, of these lanes.
INNER void unit_lanes(const glint_unit_args *args, const unit_way way, const double *across, const double *down,
                      size_t at)
{
    vd d[3], q[3];
    for (int c = 0; c < 3; c++) {
        if (way == TO_EYE)
            d[c] = -(d_load(across + c * GLINT_GROUP) + d_load(down + c * GLINT_GROUP));
        else
            d[c] = way == TO_PLACE ? d_set(args->place[c]) : d_load(args->to[c] + at);
        if (way != TO_EYE && args->from[0])
            d[c] = d[c] - d_load(args->from[c] + at);
    }
    const vd length = d_sqrt((d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]);
    divide_by_length(d, length, q);
    for (int c = 0; c < 3; c++)
        d_store(args->unit[c] + at, q[c]);
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
