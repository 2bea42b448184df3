// The reference of solids, for one type of real; included by ref/real.h. It follows stages.h line by line.

typedef struct NAME(crossing) {
    REAL t;
    bool flat; ///< the crossing is on a flat face
    REAL face[3]; ///< the outward normal of that face
} NAME(crossing);

typedef struct NAME(passage) {
    bool hit;
    NAME(crossing) in, out;
    bool ends; ///< for an open form: the ray leaves through an open end
} NAME(passage);

static NAME(vec3) NAME(into_unit)(const glint_solid *solid, NAME(vec3) v)
{
    return NAME(vec)(NAME(dot)(NAME(rounded)(solid->inverse[0]), v), NAME(dot)(NAME(rounded)(solid->inverse[1]), v),
                     NAME(dot)(NAME(rounded)(solid->inverse[2]), v));
}

static REAL NAME(zero_within)(REAL x, REAL bound) { return NAME(abs)(x) <= bound ? 0 : x; }

/// Returns the height of a point over a face; 0 if it is on the face within rounding.
static REAL NAME(over_face)(const glint_face *face, NAME(vec3) point)
{
    NAME(vec3) n = NAME(rounded)(face->normal), q = NAME(sub)(point, NAME(rounded)(face->at));
    if (face->axis < 3)
        return NAME(component)(n, (int)face->axis) * NAME(component)(q, (int)face->axis);
    return NAME(zero_within)(NAME(dot)(n, q), NAME(ON_FACE) * (REAL)face->magnitude);
}

static REAL NAME(rise)(const glint_face *face, NAME(vec3) direction)
{
    NAME(vec3) n = NAME(rounded)(face->normal);
    if (face->axis < 3)
        return NAME(component)(n, (int)face->axis) * NAME(component)(direction, (int)face->axis);
    return NAME(dot)(n, direction);
}

/// Clips the passage to a slab. faces: the low face and the high face.
static void NAME(pass_slab)(NAME(passage) * p, const glint_face *faces, NAME(vec3) origin, NAME(vec3) direction,
                            int axis)
{
    REAL over_low = NAME(over_face)(&faces[0], origin), over_high = NAME(over_face)(&faces[1], origin);
    REAL d = NAME(rise)(faces, direction);
    if (d == 0) {
        p->hit = p->hit && !(over_low < 0) && !(over_high > 0);
        return;
    }
    REAL enter = -(d > 0 ? over_low : over_high) / d, leave = -(d > 0 ? over_high : over_low) / d;
    REAL outward = d > 0 ? 1 : -1;
    if (p->in.t < enter) {
        p->in = (NAME(crossing)) { .t = enter, .flat = true };
        p->in.face[axis] = -outward;
    }
    if (p->out.t > leave) {
        p->out = (NAME(crossing)) { .t = leave, .flat = true };
        p->out.face[axis] = outward;
    }
}

static NAME(passage) NAME(pass_round)(NAME(vec3) f, NAME(vec3) e, bool ball, double magnitude)
{
    REAL a = e.x * e.x + e.y * e.y, b = f.x * e.x + f.y * e.y, c = f.x * f.x + f.y * f.y;
    REAL z = f.x * e.y - f.y * e.x, across = z * z;
    if (ball) {
        a = NAME(length2)(e);
        b = NAME(dot)(f, e);
        c = NAME(length2)(f);
        across = NAME(length2)(NAME(cross)(f, e));
    }
    b = -b;
    c = NAME(zero_within)(c - 1, NAME(ON_FACE) * (REAL)magnitude);
    if (a == 0)
        return (NAME(passage)) { .hit = c <= 0, .in = { .t = -INFINITY }, .out = { .t = INFINITY } };
    REAL disc = b * b < a ? b * b - a * c : a - across;
    REAL s = NAME(square_root)(NAME(max)(disc, 0));
    REAL q = b >= 0 ? b + s : b - s, far = q / a, other = c / q;
    return (NAME(passage)) { .hit = disc >= 0, .in = { .t = NAME(min)(far, other) }, .out = { .t = NAME(max)(far, other) } };
}

static NAME(passage) NAME(pass_cone)(NAME(vec3) from, NAME(vec3) e, double magnitude)
{
    REAL toward = NAME(dot)(from, e), away2 = NAME(length2)(from),
         side = (from.x * from.x + from.y * from.y) - from.z * from.z;
    REAL off = NAME(POINT_SLACK) * away2 + (NAME(ON_FACE) * (REAL)magnitude) * from.z;
    bool far_off = away2 > 16, on = from.z > 0 && NAME(abs)(side) <= off && !far_off;
    bool anew = far_off || (toward * toward > (REAL)0.875 * (away2 * NAME(length2)(e)) && !on);
    REAL move = anew ? -toward / NAME(dot)(e, e) : 0;
    NAME(vec3) f = NAME(add)(from, NAME(times)(e, move));
    REAL a = (e.x * e.x + e.y * e.y) - e.z * e.z, c = on ? 0 : (f.x * f.x + f.y * f.y) - f.z * f.z;
    REAL b = f.z * e.z - (f.x * e.x + f.y * e.y);
    NAME(vec3) across = NAME(cross)(f, e);
    REAL disc = (across.x * across.x + across.y * across.y) - across.z * across.z;
    REAL s = NAME(square_root)(NAME(max)(disc, 0));
    REAL q = b >= 0 ? b + s : b - s, far = q / a, other = q == 0 ? far : c / q;
    REAL low = NAME(min)(far, other), high = NAME(max)(far, other);
    if (a < 0 || a == 0) {
        REAL end = a == 0 ? c / (2 * b) : e.z > 0 ? high : low;
        return (NAME(passage)) { .hit = a < 0 || (e.z > 0 ? b > 0 : b < 0),
                                 .in = { .t = (e.z > 0 ? end : -INFINITY) + move },
                                 .out = { .t = (e.z > 0 ? INFINITY : end) + move } };
    }
    return (NAME(passage)) { .hit = disc >= 0, .in = { .t = low + move }, .out = { .t = high + move } };
}

static NAME(passage) NAME(pass_disk)(NAME(vec3) f, NAME(vec3) e, REAL t)
{
    NAME(crossing) at = { .t = t, .flat = true, .face = { 0, 0, 1 } };
    REAL x = f.x + at.t * e.x, y = f.y + at.t * e.y;
    return (NAME(passage)) { .hit = x * x + y * y <= 1, .in = at, .out = at };
}

static NAME(passage)
    NAME(pass_prim)(const glint_solid *solid, const glint_prim *prim, NAME(vec3) origin, NAME(vec3) direction)
{
    NAME(vec3) f = NAME(into_unit)(solid, NAME(sub)(origin, NAME(rounded)(prim->center)));
    NAME(vec3) e = NAME(into_unit)(solid, direction);
    NAME(passage) p = { .hit = true, .in = { .t = -INFINITY }, .out = { .t = INFINITY } };
    bool cylinder = solid->form == GLINT_FORM_CYLINDER || solid->form == GLINT_FORM_TUBE;
    bool cone = solid->form == GLINT_FORM_CONE || solid->form == GLINT_FORM_FUNNEL;
    if (solid->form == GLINT_FORM_BALL || cylinder)
        p = NAME(pass_round)(f, e, solid->form == GLINT_FORM_BALL, solid->magnitude);
    else if (cone)
        p = NAME(pass_cone)(f, e, solid->magnitude);
    else if (solid->form == GLINT_FORM_DISK)
        p = NAME(pass_disk)(f, e, -NAME(over_face)(solid->faces, origin) / NAME(rise)(solid->faces, direction));
    if (cylinder || cone)
        NAME(pass_slab)(&p, solid->faces, origin, direction, 2);
    for (int axis = 0; axis < 3 && solid->form == GLINT_FORM_BOX; axis++)
        NAME(pass_slab)(&p, solid->faces + 2 * axis, origin, direction, axis);
    p.hit = p.hit && p.in.t <= p.out.t;
    if (solid->form != GLINT_FORM_TUBE && solid->form != GLINT_FORM_FUNNEL)
        return p;
    p.ends = p.out.flat;
    p.hit = p.hit && !(p.in.flat && p.out.flat);
    if (p.in.flat)
        p.in = p.out;
    else if (p.out.flat)
        p.out = p.in;
    return p;
}

/// Returns the vector from the solid's centre to a point, in the space of the unit shape.
static NAME(vec3) NAME(unit_point)(const glint_solid *solid, const glint_prim *prim, NAME(vec3) point)
{
    return NAME(into_unit)(solid, NAME(sub)(point, NAME(rounded)(prim->center)));
}

/// Returns the distance at which a ray hits a solid; 0: a miss.
static REAL NAME(solid_t)(const glint_solid *solid, const glint_prim *prim, NAME(vec3) origin, NAME(vec3) direction)
{
    if (solid->form == GLINT_FORM_TORUS)
        return NAME(torus_t)(solid, NAME(unit_point)(solid, prim, origin), NAME(into_unit)(solid, direction), false,
                             false);
    NAME(passage) p = NAME(pass_prim)(solid, prim, origin, direction);
    REAL t = p.in.t > 0 ? p.in.t : p.out.t;
    return p.hit && t > 0 ? t : 0;
}

/// Projects a point next to the curved side onto it. Returns the outward normal there.
static NAME(vec3) NAME(onto_side)(uint32_t form, NAME(vec3) * k)
{
    REAL round = k->x * k->x + k->y * k->y;
    if (form == GLINT_FORM_BALL) {
        *k = NAME(over)(*k, NAME(square_root)(round + k->z * k->z));
        return *k;
    }
    bool cone = form == GLINT_FORM_CONE || form == GLINT_FORM_FUNNEL;
    REAL length = NAME(square_root)(round), radius = cone ? k->z : 1;
    NAME(vec3) g = NAME(vec)(0, 0, cone ? -1 : 0);
    if (length > 0) {
        g.x = k->x / length;
        g.y = k->y / length;
    }
    *k = NAME(vec)(g.x * radius, g.y * radius, k->z);
    return g;
}

/// Sets the exact coordinate of a point on a face perpendicular to an axis of the world.
static NAME(vec3) NAME(onto_plane)(const glint_face *face, NAME(vec3) point)
{
    NAME(vec3) at = NAME(rounded)(face->at);
    return NAME(vec)(face->axis == 0 ? at.x : point.x, face->axis == 1 ? at.y : point.y,
                     face->axis == 2 ? at.z : point.z);
}

/// Projects a point next to a face onto it.
static NAME(vec3) NAME(onto_face)(uint32_t form, NAME(vec3) k, const REAL face[3])
{
    if (form == GLINT_FORM_DISK || (form == GLINT_FORM_CONE && face[2] < 0))
        return NAME(vec)(k.x, k.y, 0);
    return NAME(vec)(face[0] != 0 ? face[0] : k.x, face[1] != 0 ? face[1] : k.y, face[2] != 0 ? face[2] : k.z);
}

static NAME(vec3) NAME(solid_point)(const glint_solid *solid, const glint_prim *prim, NAME(vec3) origin,
                                    NAME(vec3) direction, REAL t, NAME(vec3) * normal)
{
    const bool torus = solid->form == GLINT_FORM_TORUS;
    NAME(vec3) f = NAME(unit_point)(solid, prim, origin), e = NAME(into_unit)(solid, direction);
    NAME(crossing) at = { .t = t };
    if (!torus) {
        NAME(passage) p = NAME(pass_prim)(solid, prim, origin, direction);
        at = p.in.t == t ? p.in : p.out;
    }
    NAME(vec3) k = NAME(add)(f, NAME(times)(e, at.t)), g = NAME(vec)(at.face[0], at.face[1], at.face[2]);
    if (torus)
        g = NAME(onto_torus)((REAL)solid->tube, &k);
    else if (at.flat)
        k = NAME(onto_face)(solid->form, k, at.face);
    else
        g = NAME(onto_side)(solid->form, &k);
    REAL n[3], offset[3];
    for (int c = 0; c < 3; c++) {
        const double column[3] = { solid->inverse[0][c], solid->inverse[1][c], solid->inverse[2][c] };
        n[c] = NAME(dot)(NAME(rounded)(column), g);
        offset[c] = NAME(dot)(NAME(rounded)(solid->forward[c]), k);
    }
    *normal = NAME(vec)(n[0], n[1], n[2]);
    *normal = NAME(over)(*normal, NAME(square_root)(NAME(length2)(*normal)));
    NAME(vec3) point = NAME(add)(NAME(rounded)(prim->center), NAME(vec)(offset[0], offset[1], offset[2]));
    if (!at.flat)
        return point;
    int axis = at.face[0] != 0 ? 0 : at.face[1] != 0 ? 1 : 2;
    bool high = at.face[axis] > 0;
    return NAME(onto_plane)(&solid->faces[(solid->form == GLINT_FORM_BOX ? 2 * axis : 0) + high], point);
}

/// Returns whether the torus blocks the segment. own: the segment starts on the torus; back: it also goes inside.
/// inside: the light is inside.
static bool NAME(torus_blocks)(const glint_occlude_args *args, const glint_prim *prim, NAME(vec3) position,
                               NAME(vec3) point, bool inside, bool own, bool back)
{
    const glint_solid *solid = &args->geometry->solids[prim->item];
    NAME(vec3) d = args->directional ? position : NAME(times)(NAME(sub)(position, point), (REAL)args->scale);
    REAL end = args->directional ? (REAL)INFINITY : 1 / (REAL)args->scale;
    return NAME(torus_parts)(solid, NAME(unit_point)(solid, prim, point), NAME(into_unit)(solid, d), end, inside, own,
                             back);
}

/// Returns whether the solid blocks the segment. `own`: the segment starts on the solid and goes inside.
static bool NAME(solid_blocks)(const glint_occlude_args *args, const glint_prim *prim, NAME(vec3) position,
                               NAME(vec3) point, bool own)
{
    NAME(vec3) d = args->directional ? position : NAME(times)(NAME(sub)(position, point), (REAL)args->scale);
    NAME(passage) p = NAME(pass_prim)(&args->geometry->solids[prim->item], prim, point, d);
    REAL unit = args->directional ? 1 : (REAL)args->scale, end = args->directional ? (REAL)INFINITY : 1;
    bool in = p.in.t > 0 && p.in.t * unit<end, out = p.out.t> 0 && p.out.t * unit < end;
    return p.hit && (own ? out && !p.ends : in || out);
}
