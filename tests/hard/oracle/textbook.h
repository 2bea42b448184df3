// A textbook's ray tracer for one floating-point type. Define before including it: REAL, T(name), SQRT, POW, TAN, and
// EPSILON, the smallest t of an occluder on a shadow ray, whose whole length is 1.

typedef struct T(vec) {
    REAL x, y, z;
} T(vec);

static T(vec) T(vec_of)(const double v[3]) { return (T(vec)) { (REAL)v[0], (REAL)v[1], (REAL)v[2] }; }
static T(vec) T(add)(T(vec) a, T(vec) b) { return (T(vec)) { a.x + b.x, a.y + b.y, a.z + b.z }; }
static T(vec) T(sub)(T(vec) a, T(vec) b) { return (T(vec)) { a.x - b.x, a.y - b.y, a.z - b.z }; }
static T(vec) T(mul)(T(vec) a, REAL s) { return (T(vec)) { a.x * s, a.y * s, a.z * s }; }
static REAL T(dot)(T(vec) a, T(vec) b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static T(vec) T(unit)(T(vec) a) { return T(mul)(a, 1 / SQRT(T(dot)(a, a))); }

static T(vec) T(cross)(T(vec) a, T(vec) b)
{
    return (T(vec)) { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}

/// Returns the nearest root above `epsilon`; 0 for none.
static REAL T(meet)(const hard_sphere *sphere, T(vec) o, T(vec) d, REAL epsilon)
{
    const T(vec) f = T(sub)(o, T(vec_of)(sphere->c));
    const REAL a = T(dot)(d, d), b = 2 * T(dot)(d, f), c = T(dot)(f, f) - (REAL)sphere->r * (REAL)sphere->r;
    const REAL disc = b * b - 4 * a * c;
    if (!(disc >= 0))
        return 0;
    const REAL near = (-b - SQRT(disc)) / (2 * a), far = (-b + SQRT(disc)) / (2 * a);
    return near > epsilon ? near : far > epsilon ? far : 0;
}

static int T(nearest)(const hard_still *still, T(vec) o, T(vec) d, REAL *t)
{
    int object = 0;
    for (int i = 0; i < still->count; i++) {
        const REAL here = T(meet)(&still->spheres[i], o, d, 0);
        if (here > 0 && (!object || here < *t)) {
            *t = here;
            object = i + 1;
        }
    }
    return object;
}

static bool T(in_shadow)(const hard_still *still, T(vec) p, T(vec) to_light)
{
    for (int i = 0; i < still->count; i++) {
        const REAL t = T(meet)(&still->spheres[i], p, to_light, (REAL)EPSILON);
        if (t > 0 && t < 1)
            return true;
    }
    return false;
}

/// Returns the ray through the centre of a pixel; row 0 is at the top.
static T(vec) T(view_ray)(const hard_still *still, int width, int height, int x, int y)
{
    const T(vec) forward = T(unit)(T(sub)(T(vec_of)(still->at), T(vec_of)(still->eye)));
    const T(vec) right = T(unit)(T(cross)(forward, (T(vec)) { 0, 1, 0 })), up = T(cross)(right, forward);
    const REAL half = TAN((REAL)still->fov_y_rad / 2);
    const REAL u = half * (2 * (REAL)x + 1 - width) / height, v = half * (height - 2 * (REAL)y - 1) / height;
    return T(unit)(T(add)(forward, T(add)(T(mul)(right, u), T(mul)(up, v))));
}

still_pixel T(still_trace)(const hard_still *still, int width, int height, int x, int y)
{
    still_pixel out = { 0 };
    const T(vec) o = T(vec_of)(still->eye), d = T(view_ray)(still, width, height, x, y);
    REAL t = 0;
    out.object = T(nearest)(still, o, d, &t);
    if (!out.object) {
        for (int c = 0; c < 3; c++)
            out.color[c] = still->background[c];
        return out;
    }
    const hard_sphere *hit = &still->spheres[out.object - 1];
    const still_paint *paint = &still->paint[out.object - 1];
    const T(vec) p = T(add)(o, T(mul)(d, t)), to_light = T(sub)(T(vec_of)(still->light), p);
    T(vec) n = T(unit)(T(sub)(p, T(vec_of)(hit->c)));
    if (T(dot)(n, d) > 0)
        n = T(mul)(n, -1);
    const T(vec) l = T(unit)(to_light);
    const REAL nl = T(dot)(n, l), rv = 2 * nl * -T(dot)(n, d) + T(dot)(l, d);
    out.lit = nl > 0 && !T(in_shadow)(still, p, to_light);
    for (int c = 0; c < 3; c++) {
        REAL sum = (REAL)paint->diffuse[c] * (REAL)still->ambient;
        if (out.lit)
            sum += (REAL)paint->diffuse[c] * nl;
        if (out.lit && rv > 0)
            sum += (REAL)paint->specular * POW(rv, (REAL)paint->shininess);
        out.color[c] = (double)sum;
    }
    return out;
}

#undef REAL
#undef T
#undef SQRT
#undef POW
#undef TAN
#undef EPSILON
