// The stage `unit`: ways to lights and to the eye, as shaders read them. Contract: contract/program.h.

/// d / by, where `by` is d's length.
static inline void divide_each(const vd d[3], vd by, vd q[3])
{
    for (int c = 0; c < 3; c++)
        q[c] = d[c] / by;
}

#ifdef GLINT_D_FUSED
/// 1 / by, where by is the root of length2.
static inline vd find_inverse(vd by, vd length2)
{
#ifdef GLINT_D_INVERSE_ROOT
    // without the divider, which the root keeps; while that is found, one of Newton's steps comes within 2^-26
    const vd guess = d_inverse_root(length2), half = d_set(0.5);
    const vd near = d_fma(guess, d_fnma(length2 * guess, half * guess, half), guess), r = d_fnma(by, near, d_set(1));
    return d_fma(d_fma(r, r, r), near, near);
#else
    (void)length2;
    return d_set(1) / by;
#endif
}

/// The same bits without three divisions, where |1 - y by| < 2^-53 (y: find_inverse), which it is where it is so once rounded. If q is
/// a neighbour of d / by, q + (d - q by) y with both steps fused is d / by rounded to nearest (after P. Markstein, IBM J. Res. Dev.
/// 34(1), 1990): what is rounded last is off by less than 2^-53 of q's own error, and d / by is 2^-54 of a last place or more from
/// where rounding turns. d y + d rest, fused, is within 2^-104 of d / by before it is rounded, and so a neighbour after.
/// Within the bounds, where by is at most 2^512 as a root is, nothing that counts over- or underflows.
static inline void divide_by_length(const vd d[3], vd by, vd length2, vd q[3])
{
    const vd y = find_inverse(by, length2), less_1 = d_fnma(by, y, d_set(1)), rest = less_1 * y;
    const vd least = d_least_size(d_least_size(d[0], d[1]), d[2]);
    const dm good = dm_and(d_lt(d_abs(less_1), d_set(0x1p-53)), d_le(d_set(0x1p-400), least));
    if (dm_bits(good) != D_ALL) {
        divide_each(d, by, q);
        return;
    }
    for (int c = 0; c < 3; c++) {
        const vd near = d_fma(d[c], y, d[c] * rest);
        q[c] = d_fma(d_fnma(near, by, d[c]), y, near);
    }
}
#else
static inline void divide_by_length(const vd d[3], vd by, vd length2, vd q[3])
{
    (void)length2;
    divide_each(d, by, q);
}
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
    const vd length2 = (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2], length = d_sqrt(length2);
    divide_by_length(d, length, length2, q);
    for (int c = 0; c < 3; c++)
        d_store(args->unit[c] + at, q[c]);
    if (args->length)
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
