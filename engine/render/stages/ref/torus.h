// The reference of the torus, for one type of real; included by ref/real.h. It follows stages.h line by line.
//
// A line is p + s u, with u unit and p the point nearest to the centre. The surface is at Q(s) = 0, a quartic without
// a cubic term. Q' / 4 = s^3 + bend s - lean has up to three roots, the turning points of Q, between which Q is
// monotonic. So there are four stretches, falling and rising in turn, with at most one root each. A stretch has a
// root if its ends are on different sides of the surface. The side of a point follows from its distance from the
// circle in the middle of the tube, not from the coefficients of Q.

/// Returns the factor of Q that has a different sign inside of the torus (below 0) and outside. *beyond: the other
/// factor, which is above 0 everywhere.
static REAL NAME(torus_gap)(NAME(vec3) k, REAL tube, REAL *beyond)
{
    REAL round = NAME(square_root)(k.x * k.x + k.y * k.y), near = round - 1, far = round + 1, level = k.z * k.z;
    *beyond = (far * far + level) - tube * tube;
    return (near * near + level) - tube * tube;
}

typedef struct NAME(torus_line) {
    REAL tube;
    NAME(vec3) p, u;
    REAL from, per, length, begin; ///< t = from + s per, with per = 1 / length; begin: s at t = 0
    REAL reach; ///< there are no roots beyond -reach .. reach
    REAL bend, lean;
    bool near; ///< the line comes near the torus
    REAL turn[3], gap[3], beyond[3]; ///< s of the turning points, in order, and the factors of torus_gap there; if
        ///< there is only one turning point, the others are at infinity, outside
    REAL begin_gap;
    bool on, inward; ///< on: the ray starts on the surface; inward: it also goes inside
    int stretch; ///< the stretch in which the ray starts, 0 .. 3
} NAME(torus_line);

/// Returns the largest x with x^3 + bend x = lean; lean >= 0.
static REAL NAME(last_turn)(REAL bend, REAL lean)
{
    REAL r = NAME(square_root)(NAME(max)(-bend, 0));
    REAL x = r + NAME(min)(lean / (bend < 0 ? -2 * bend : bend), (2 + lean) * (REAL)0.34);
    for (int n = 0; n < GLINT_TURN_STEPS; n++) {
        REAL value = (x * x + bend) * x - lean, slope = 3 * (x * x) + bend;
        REAL step = value * slope / (slope * slope - value * (3 * x));
        x = x - step;
        if (NAME(abs)(step) <= (REAL)GLINT_TURN_NEAR)
            break;
    }
    return x;
}

static void NAME(find_turns)(NAME(torus_line) * l)
{
    REAL last = NAME(last_turn)(l->bend, NAME(abs)(l->lean));
    REAL rest = -l->bend - (REAL)0.75 * (last * last), half = NAME(square_root)(NAME(max)(rest, 0));
    REAL low = (REAL)-0.5 * last - half, high = (REAL)-0.5 * last + half;
    bool three = rest >= 0, turned = l->lean < 0;
    l->turn[0] = turned ? -last : three ? low : last;
    l->turn[1] = !three ? INFINITY : turned ? -high : high;
    l->turn[2] = !three ? INFINITY : turned ? -low : last;
    for (int i = 0; i < 3; i++) {
        NAME(vec3) k = NAME(add)(l->p, NAME(times)(l->u, i == 0 || three ? l->turn[i] : 0));
        l->gap[i] = NAME(torus_gap)(k, l->tube, &l->beyond[i]);
        if (i > 0 && !three)
            l->gap[i] = 1;
    }
}

/// Computes the stretch in which the ray starts. leaves: the ray certainly starts on the surface.
static void NAME(begin_on_torus)(NAME(torus_line) * l, const glint_solid *solid, NAME(vec3) f, NAME(vec3) e,
                                 bool leaves, bool inward)
{
    REAL beyond, within = NAME(ON_FACE) * (REAL)solid->magnitude;
    REAL round = NAME(square_root)(f.x * f.x + f.y * f.y);
    l->begin_gap = NAME(torus_gap)(f, l->tube, &beyond);
    l->on = leaves || NAME(abs)(l->begin_gap) <= within * (2 * l->tube + within);
    l->inward = leaves ? inward : ((round - 1) / round) * (f.x * e.x + f.y * e.y) + f.z * e.z < 0;
    if (!l->on) {
        l->stretch = (l->begin >= l->turn[0]) + (l->begin >= l->turn[1]) + (l->begin >= l->turn[2]);
        return;
    }
    const REAL *turn = l->inward ? l->turn : l->turn + 1;
    l->stretch = (l->inward ? 0 : 1) + (l->begin < (REAL)0.5 * turn[0] + (REAL)0.5 * turn[1] ? 0 : 2);
    REAL *next =
        l->stretch < 3 ? &l->gap[l->stretch] : NULL; // the ray starts on the correct side, even if rounding has moved
            // the next turning point
    if (next && l->inward && *next > 0)
        *next = 0;
    if (next && !l->inward && *next <= 0)
        *next = 1;
}

static NAME(torus_line)
    NAME(along_torus)(const glint_solid *solid, NAME(vec3) f, NAME(vec3) e, bool leaves, bool inward)
{
    NAME(torus_line) l = { .tube = (REAL)solid->tube };
    REAL ee = NAME(length2)(e), first = -NAME(dot)(f, e) / ee;
    NAME(vec3) q = NAME(add)(f, NAME(times)(e, first));
    REAL again = -NAME(dot)(q, e) / ee, around = (REAL)1.0001 * (1 + l.tube);
    l.p = NAME(add)(q, NAME(times)(e, again));
    l.from = first + again;
    l.length = NAME(square_root)(ee);
    l.per = 1 / l.length;
    l.begin = -l.from * l.length;
    l.u = NAME(times)(e, l.per);
    REAL away2 = NAME(length2)(l.p), half2 = around * around - away2;
    l.near = half2 > 0;
    l.reach = NAME(square_root)(NAME(max)(half2, 0));
    l.bend = ((away2 + 1) - l.tube * l.tube) - 2 * (l.u.x * l.u.x + l.u.y * l.u.y);
    l.lean = -2 * (l.p.z * l.u.z);
    if (!l.near)
        return l;
    NAME(find_turns)(&l);
    NAME(begin_on_torus)(&l, solid, f, e, leaves, inward);
    return l;
}

/// Returns whether a ray that leaves the torus at f, and does not go inside, certainly never hits it again: the
/// tangent planes of the outer half of the tube have the whole torus on one side.
static bool NAME(leaves_torus)(NAME(vec3) f, NAME(vec3) e)
{
    REAL round = NAME(square_root)(f.x * f.x + f.y * f.y);
    return round >= 1 && ((round - 1) / round) * (f.x * e.x + f.y * e.y) + f.z * e.z >= 0;
}

/// Returns whether there is a root in a stretch.
static bool NAME(torus_crosses)(const NAME(torus_line) * l, int stretch)
{
    const REAL *gap = l->gap;
    return l->near && (stretch == 0   ? gap[0] <= 0
                       : stretch == 1 ? gap[0] <= 0 && gap[1] > 0
                       : stretch == 2 ? gap[1] > 0 && gap[2] <= 0
                                      : gap[2] <= 0);
}

/// Returns whether the root of a stretch is ahead of the ray's origin.
static bool NAME(torus_ahead)(const NAME(torus_line) * l, int stretch)
{
    if (stretch != l->stretch || l->on)
        return stretch > l->stretch;
    return stretch % 2 ? l->begin_gap < 0 : l->begin_gap > 0;
}

/// Returns t of the root of a stretch that has one.
static REAL NAME(torus_root)(const NAME(torus_line) * l, int stretch)
{
    int least = stretch < 2 ? 0 : 2;
    bool rising = stretch % 2;
    REAL low = stretch == 0 ? -l->reach : l->turn[stretch - 1], high = stretch == 3 ? l->reach : l->turn[stretch];
    low = NAME(max)(low, -l->reach);
    high = NAME(min)(high, l->reach);
    if (stretch == l->stretch && !l->on)
        low = NAME(max)(low, l->begin);
    REAL middle = l->turn[least], curve = 12 * (middle * middle) + 4 * l->bend;
    REAL off = NAME(square_root)(NAME(max)(-2 * (l->gap[least] * l->beyond[least]) / curve, 0));
    REAL s = rising ? middle + off : middle - off;
    if (!(low <= s && s <= high))
        s = (REAL)0.5 * low + (REAL)0.5 * high;
    for (int n = 0; n < GLINT_ROOT_STEPS; n++) {
        REAL beyond, gap = NAME(torus_gap)(NAME(add)(l->p, NAME(times)(l->u, s)), l->tube, &beyond);
        if ((gap <= 0) == rising)
            low = s;
        else
            high = s;
        REAL value = gap * beyond, slope = 4 * ((s * s + l->bend) * s - l->lean);
        REAL half = 6 * (s * s) + 2 * l->bend, bound = (6 * (s * s) + 2 * NAME(abs)(l->bend)) + (2 + NAME(abs)(slope));
        REAL next = s - value * slope / (slope * slope - value * half);
        if (!(low <= next && next <= high))
            next = (REAL)0.5 * low + (REAL)0.5 * high;
        REAL moved = NAME(abs)(next - s);
        s = next;
        if (moved * moved * moved * (bound * bound) <= NAME(ON_FACE) * (slope * slope) || moved <= NAME(ON_FACE))
            break; // convergence is cubic: the remaining error is below rounding
    }
    REAL t = l->from + s * l->per;
    return t > 0 ? t : (REAL)GLINT_LEAST_T;
}

/// Returns the distance at which a ray hits a torus; 0: a miss. leaves: the ray starts on the torus; inward: it also
/// goes inside.
static REAL NAME(torus_t)(const glint_solid *solid, NAME(vec3) f, NAME(vec3) e, bool leaves, bool inward)
{
    if (leaves && !inward && NAME(leaves_torus)(f, e))
        return 0;
    NAME(torus_line) l = NAME(along_torus)(solid, f, e, leaves, inward);
    for (int stretch = 0; stretch < 4; stretch++)
        if (NAME(torus_crosses)(&l, stretch) && NAME(torus_ahead)(&l, stretch))
            return NAME(torus_root)(&l, stretch);
    return leaves && inward ? (REAL)GLINT_LEAST_T : 0;
}

/// Computes the intervals inside the torus, from ends[0] to ends[1] and from ends[2] to ends[3]. A ray that does not
/// come out in between has one interval, from the first root to the last. -inf: there is no such interval, or the ray
/// starts inside the interval.
static void NAME(torus_ends)(const glint_solid *solid, NAME(vec3) f, NAME(vec3) e, bool leaves, bool inward, REAL ends[4])
{
    NAME(torus_line) l = NAME(along_torus)(solid, f, e, leaves, inward);
    for (int stretch = 0; stretch < 4; stretch++)
        ends[stretch] = NAME(torus_crosses)(&l, stretch) && NAME(torus_ahead)(&l, stretch) ? NAME(torus_root)(&l, stretch)
                                                                                           : (REAL)-INFINITY;
    if (!(l.near && l.gap[1] > 0))
        ends[2] = ends[0];
    if (leaves && inward && !(ends[1] > 0) && !(ends[3] > 0))
        ends[3] = (REAL)GLINT_LEAST_T;
}

/// Projects a point next to the surface onto it. Returns the outward normal there.
static NAME(vec3) NAME(onto_torus)(REAL tube, NAME(vec3) * k)
{
    REAL round = NAME(square_root)(k->x * k->x + k->y * k->y), x = round > 0 ? k->x / round : 0;
    REAL y = round > 0 ? k->y / round : 0, w = round - 1, away = NAME(square_root)(w * w + k->z * k->z);
    REAL out = away > 0 ? w / away : 1, up = away > 0 ? k->z / away : 0, radius = 1 + tube * out;
    *k = NAME(vec)(radius * x, radius * y, tube * up);
    return NAME(vec)(out * x, out * y, up);
}

/// Returns whether a segment from f crosses the surface before it ends at t = end. end_inside: whether that end is
/// inside. leaves: the segment starts on the torus; inward: it also goes inside.
static bool NAME(torus_parts)(const glint_solid *solid, NAME(vec3) f, NAME(vec3) e, REAL end, bool end_inside,
                              bool leaves, bool inward)
{
    if (leaves && !inward && NAME(leaves_torus)(f, e))
        return end_inside;
    NAME(torus_line) l = NAME(along_torus)(solid, f, e, leaves, inward);
    REAL beyond;
    if (!l.near)
        return (leaves ? inward : NAME(torus_gap)(f, l.tube, &beyond) < 0) != end_inside;
    bool inside = l.on ? l.inward : l.begin_gap < 0, parted = inside != end_inside;
    REAL last = (end - l.from) * l.length;
    for (int i = l.stretch; i < 3 && last >= l.turn[i]; i++)
        parted = parted || (l.gap[i] <= 0) != inside;
    return parted;
}
