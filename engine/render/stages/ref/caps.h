// The reference of caps, for one type of real; included by ref/real.h. It follows stages.h line by line.

/// Returns atan2(y, x) for y, x >= 0.
static REAL NAME(angle_of)(REAL y, REAL x)
{
    REAL t = y / (NAME(square_root)(x * x + y * y) + x);
    t = t / (1 + NAME(square_root)(1 + t * t));
    t = t / (1 + NAME(square_root)(1 + t * t));
    REAL sum = 0;
    for (int odd = 23; odd > 0; odd -= 2)
        sum = odd == 23 ? (REAL)(1.0 / 23) : sum * -(t * t) + (REAL)(1.0 / odd);
    return 8 * (t * sum);
}

typedef struct NAME(cap) {
    NAME(vec3) direction;
    REAL sine, cosine; ///< sine and cosine of half the cap's angular radius
} NAME(cap);

/// Returns the cap that a ball covers as seen from a point. offset: from the point to the ball's centre; power:
/// squared distance minus squared radius.
static NAME(cap) NAME(cap_of)(NAME(vec3) offset, REAL radius, REAL power)
{
    REAL distance = NAME(square_root)(NAME(length2)(offset));
    REAL full = NAME(square_root)(NAME(max)(power, 0)) / distance;
    REAL cosine = NAME(square_root)((REAL)0.5 + (REAL)0.5 * full);
    return (NAME(cap)) { NAME(over)(offset, distance), NAME(min)(radius / distance, 1) / (2 * cosine), cosine };
}

static REAL NAME(covered_part)(NAME(cap) s, NAME(cap) a)
{
    NAME(vec3) apart = NAME(sub)(s.direction, a.direction), along = NAME(add)(s.direction, a.direction);
    REAL sg = (REAL)0.5 * NAME(square_root)(NAME(length2)(apart));
    REAL cg = (REAL)0.5 * NAME(square_root)(NAME(length2)(along));
    REAL sum_s = a.sine * cg + a.cosine * sg, sum_c = a.cosine * cg - a.sine * sg;
    REAL less_s = sg * a.cosine - cg * a.sine, less_c = cg * a.cosine + sg * a.sine;
    REAL x0 = s.sine * sum_c + s.cosine * sum_s, x1 = s.cosine * sum_s - s.sine * sum_c;
    REAL x2 = s.sine * less_c + s.cosine * less_s, x3 = s.sine * less_c - s.cosine * less_s;
    if (x3 <= 0)
        return 0;
    if (x2 <= 0)
        return 1;
    if (x1 <= 0)
        return NAME(min)((a.sine / s.sine) * (a.sine / s.sine), 1);
    REAL at_light = 2 * NAME(angle_of)(NAME(square_root)(x1 * x3), NAME(square_root)(x0 * x2));
    REAL at_other = 2 * NAME(angle_of)(NAME(square_root)(x2 * x3), NAME(square_root)(x0 * x1));
    REAL edges = x0 * x3 + x1 * x2, product = (s.sine / s.cosine) * (a.sine / a.cosine);
    REAL sine = 2 * (NAME(square_root)(x0 * x3) * NAME(square_root)(x1 * x2)) / edges;
    REAL cosine = (x0 * x3 - x1 * x2) / edges;
    REAL excess = 2 * NAME(angle_of)(product * sine, 1 + product * cosine);
    REAL sector = at_other * (2 * (a.sine * a.sine));
    REAL lens = (at_light + (sector - excess) / s.sine / (2 * s.sine)) / (REAL)0x1.921fb54442d18p+1;
    return NAME(min)(NAME(max)(lens, 0), 1);
}

/// Returns the share of the light that a point sees past a primitive.
static REAL NAME(visible_share)(const glint_occlude_args *args, const glint_prim *prim, NAME(vec3) point, NAME(vec3) l,
                                bool own)
{
    const double radius = args->light_sample[0]->radius;
    double away[3], depth;
    for (int c = 0; c < 3; c++)
        away[c] = args->position[c] - prim->center[c];
    depth = prim->kind == GLINT_PRIM_PLANE ? dot_of(prim->normal, away) : prim->radius - sqrt(dot_of(away, away));
    double within = fmin(fmax((radius + depth) / (2 * radius), 0), 1);
    double behind = fmin(fmax((radius - depth) / (2 * radius), 0), 1);
    if (prim->kind == GLINT_PRIM_PLANE) {
        REAL h = NAME(over_plane)(prim, point, true);
        return h > 0 ? (REAL)within : h < 0 ? (REAL)behind : 1;
    }
    NAME(vec3) f = NAME(from_center)(point, prim);
    REAL c = NAME(exact_c)(f.x, f.y, f.z, prim), unit = (REAL)(args->scale / glint_sphere_scale(prim));
    if (own || c < 0)
        return (REAL)within;
    REAL r = (REAL)(radius * args->scale), d = NAME(square_root)(NAME(length2)(l)), power = (d - r) * (d + r);
    if (!((c * unit) * unit < power))
        return 1;
    return 1 - NAME(covered_part)(NAME(cap_of)(l, r, power),
                                  NAME(cap_of)(NAME(negated)(f), (REAL)(prim->radius * glint_sphere_scale(prim)), c));
}

static REAL NAME(share_seen)(const glint_occlude_args *args, uint32_t i)
{
    NAME(vec3) point = NAME(load)(args->point, i);
    NAME(vec3) l = NAME(times)(NAME(sub)(NAME(rounded)(args->position), point), (REAL)args->scale);
    REAL visible = 1;
    bool back = args->back[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
    if (!((REAL)(args->light_sample[0]->radius * args->scale) < NAME(square_root)(NAME(length2)(l))))
        return 1; // the point is inside the light
    for (uint32_t k = 0; k < args->geometry->prim_count; k++) {
        const glint_prim *prim = &args->geometry->prims[k];
        bool own = args->prim[i] == k;
        if (own && (prim->kind == GLINT_PRIM_PLANE || !back))
            continue;
        ++*args->overlaps;
        visible = visible * NAME(visible_share)(args, prim, point, l, own);
    }
    return visible;
}

static void NAME(occlude_caps)(const glint_occlude_args *args)
{
    for (uint32_t g = 0; g < args->group_count; g++)
        args->unoccluded[0][g] = 0;
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++) {
        args->visible[i] = 0;
        if (!(args->lit[0][i / GLINT_GROUP] >> i % GLINT_GROUP & 1))
            continue;
        REAL share = NAME(share_seen)(args, i);
        args->visible[i] = (float)share;
        if (share > 0)
            args->unoccluded[0][i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
    }
}
