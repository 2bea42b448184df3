/// The formulas of light and shade (stages/ref/light.h, shade.h, microfacets.h) on dual numbers, two lanes at a time and the same
/// on every instruction set.
#include "engine/tile/derivative/light.h"

#include "engine/stages/simd/generic.h"
#include "engine/stages/simd/elementary.h"
#include "engine/stages/program/coefficients.h"
// Of the operations of programs exp2 and log2 alone are called here.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "engine/stages/program/call.h"
#include "engine/stages/program/elementary.h"
#pragma GCC diagnostic pop

#define INLINE static inline __attribute__((always_inline))
#define LN_2 0x1.62e42fefa39efp-1
#define LOG2_E 0x1.71547652b82fep+0

typedef struct lanes {
    vd v, d; ///< values and slopes
} lanes;

INLINE lanes make(vd v, vd d) { return (lanes) { v, d }; }
INLINE lanes number(double x) { return make(d_set(x), d_set(0)); }
INLINE lanes of(glint_dual x) { return make(d_set(x.value), d_set(x.slope)); }
INLINE lanes add(lanes a, lanes b) { return make(a.v + b.v, a.d + b.d); }
INLINE lanes sub(lanes a, lanes b) { return make(a.v - b.v, a.d - b.d); }
INLINE lanes mul(lanes a, lanes b) { return make(a.v * b.v, a.d * b.v + a.v * b.d); }
INLINE lanes times(lanes a, vd b) { return make(a.v * b, a.d * b); }
INLINE lanes divide(lanes a, lanes b)
{
    const vd q = a.v / b.v;
    return make(q, (a.d - q * b.d) / b.v);
}
INLINE lanes root(lanes a)
{
    const vd r = d_sqrt(a.v), zero = d_set(0);
    return make(r, d_select(d_lt(zero, r), (d_set(0.5) * a.d) / r, zero));
}
INLINE lanes where(dm mask, lanes a, lanes b) { return make(d_select(mask, a.v, b.v), d_select(mask, a.d, b.d)); }
INLINE lanes dot(const lanes a[3], const lanes b[3])
{
    return add(add(mul(a[0], b[0]), mul(a[1], b[1])), mul(a[2], b[2]));
}
INLINE lanes dot_fixed(const lanes a[3], const vd b[3])
{
    return add(add(times(a[0], b[0]), times(a[1], b[1])), times(a[2], b[2]));
}

/// x^s of x 0 .. 1, 0 where x is not above 0.
INLINE lanes power(lanes x, lanes s)
{
    const vd zero = d_set(0), one = d_set(1);
    const dm there = d_lt(zero, x.v);
    const vd base = d_select(there, d_min(x.v, one), one), log2 = d_log2(base), y = d_exp2(s.v * log2);
    const vd slope = y * ((s.v / base) * x.d + (d_set(LN_2) * log2) * s.d);
    return make(d_select(there, y, zero), d_select(there, slope, zero));
}

/// What a group knows of a light at two of its lanes.
typedef struct shine {
    lanes way[3]; ///< unit, towards the light
    lanes cosine; ///< n.l
    lanes distance; ///< directional: infinite
    lanes weight; ///< by distance, cone and surface, and what of it reaches
} shine;

INLINE void load(const double *const from[3], int i, vd out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = d_load(from[c] + i);
}

/// A spot's cone; see spot_x and cone of stages/ref/light.h.
INLINE lanes cone(const glint_derivative_light *light, const lanes way[3])
{
    const lanes axis[3] = { of(light->axis[0]), of(light->axis[1]), of(light->axis[2]) };
    const lanes zero = number(0), one = number(1), c = sub(zero, dot(axis, way));
    lanes x = mul(sub(c, of(light->outer)), of(light->inverse));
    if (light->inverse.value == HUGE_VAL)
        x = where(d_lt(d_set(light->outer.value), c.v), one, zero);
    x = where(d_lt(x.v, one.v), x, one);
    x = where(d_lt(zero.v, x.v), x, zero);
    const lanes step = mul(mul(x, x), sub(number(3), add(x, x)));
    if (light->exponent.value == 0 && light->exponent.slope == 0)
        return step;
    return mul(step, power(c, of(light->exponent)));
}

/// Number `what` of points->slope: 0 where nothing bends.
INLINE void load_dual(bool bends, const glint_derivative_points *points, int what, int i, lanes out[3])
{
    const double *const *from = what == 0 ? points->point : what == 1 ? points->normal : points->eye;
    for (int c = 0; c < 3; c++)
        out[c] = make(d_load(from[c] + i), bends ? d_load(points->slope[what][c] + i) : d_set(0));
}

/// The product with a vector that has slopes if `bends`, a constant.
INLINE lanes dot_bent(bool bends, const lanes a[3], const lanes b[3])
{
    const vd fixed[3] = { b[0].v, b[1].v, b[2].v };
    return bends ? dot(a, b) : dot_fixed(a, fixed);
}

INLINE shine find_shine(bool bends, const glint_derivative_light *light, const glint_derivative_points *points,
                        const glint_derivative_source *source, int i)
{
    shine s;
    lanes point[3], normal[3];
    vd place[3];
    lanes distance = number(1);
    load_dual(bends, points, 0, i, point);
    load_dual(bends, points, 1, i, normal);
    load(source->position, i, place);
    s.weight = make(source->weight ? d_load(source->weight + i) : d_set(1), d_set(0));
    for (int c = 0; c < 3; c++) {
        const lanes to = make(place[c], d_set(light->position[c].slope));
        s.way[c] = light->directional ? to : bends ? sub(to, point[c]) : make(to.v - point[c].v, to.d);
    }
    if (!light->directional) {
        const lanes length2 = dot(s.way, s.way);
        distance = root(length2);
        if (source->radiant) {
            vd surface[3];
            load(source->normal, i, surface);
            lanes m = sub(number(0), dot_fixed(s.way, surface));
            if (source->both)
                m = where(d_lt(m.v, d_set(0)), sub(number(0), m), m);
            s.weight = mul(s.weight, divide(m, mul(length2, distance)));
        }
        const lanes inverse = divide(number(1), distance);
        for (int c = 0; c < 3; c++)
            s.way[c] = mul(s.way[c], inverse);
    }
    if (light->attenuated) {
        const lanes further = mul(distance, add(of(light->coefficients[1]), mul(of(light->coefficients[2]), distance)));
        s.weight = divide(s.weight, add(of(light->coefficients[0]), further));
    }
    if (light->is_spot)
        s.weight = mul(s.weight, cone(light, s.way));
    s.cosine = dot_bent(bends, s.way, normal);
    s.distance = light->directional ? number(HUGE_VAL) : distance;
    return s;
}

/// What a program gives of number `which`, or `own`.
INLINE lanes take_plane(const glint_derivative_planes *planes, int which, int i, lanes own)
{
    if (!planes || !planes->value[which])
        return own;
    return make(d_load(planes->value[which] + i), planes->slope[which] ? d_load(planes->slope[which] + i) : d_set(0));
}

/// S of Phong and Blinn-Phong.
INLINE lanes find_power(bool bends, const glint_derivative_material *material, lanes shininess, const shine *s,
                        const lanes normal[3], const lanes eye[3])
{
    lanes x;
    if (material->highlight == GLINT_HIGHLIGHT_PHONG) {
        const lanes facing = dot_bent(bends, normal, eye), twice = times(facing, d_set(2));
        x = sub(bends ? mul(s->cosine, twice) : times(s->cosine, twice.v), dot_bent(bends, s->way, eye));
    } else {
        lanes h[3];
        for (int c = 0; c < 3; c++)
            h[c] = add(s->way[c], eye[c]);
        x = divide(dot_bent(bends, h, normal), root(dot(h, h)));
    }
    const lanes strength = power(x, shininess);
    return material->lobe == GLINT_LOBE_POWER_COSINE ? mul(strength, s->cosine) : strength;
}

/// Smith's masking for Beckmann's distribution, Lambda times x; see stages/ref/shade.h.
INLINE lanes beckmann_mask(lanes alpha, lanes x)
{
    const lanes zero = number(0), one = number(1), rest = sub(one, mul(x, x));
    const lanes s = mul(alpha, root(where(d_lt(zero.v, rest.v), rest, zero))), q = divide(x, s);
    const lanes up = mul(s, add(mul(sub(times(q, d_set(0.396)), number(1.259)), q), one));
    const lanes down = add(times(q, d_set(2.181)), number(3.535));
    return where(d_lt(q.v, d_set(1.6)), divide(up, down), zero);
}

/// D G / (4 n.v) of pi D F G / (4 n.v) n.l, as stages/ref/shade.h has it; `sine2` is between n and h.
INLINE lanes find_facets(const glint_derivative_material *material, lanes alpha, lanes sine2, lanes l, lanes v)
{
    const lanes one = number(1), aa = mul(alpha, alpha);
    const lanes floor = number(0x1p-126), cosine2 = sub(one, sine2);
    if (material->lobe == GLINT_LOBE_GGX) {
        const lanes b = sub(one, aa), u = divide(alpha, add(sine2, mul(aa, cosine2)));
        const lanes d = add(mul(l, root(add(aa, mul(b, mul(v, v))))), mul(v, root(add(aa, mul(b, mul(l, l))))));
        return mul(mul(u, u), divide(times(l, d_set(0.5)), where(d_lt(floor.v, d.v), d, floor)));
    }
    const lanes least = number(0x1p-40), c = where(d_lt(least.v, cosine2.v), cosine2, least);
    const lanes y = divide(times(divide(sine2, c), d_set(-LOG2_E)), aa);
    const vd e = d_exp2(y.v);
    const lanes spread = make(e, (e * d_set(LN_2)) * y.d);
    const lanes d = add(mul(l, v), add(mul(v, beckmann_mask(alpha, l)), mul(l, beckmann_mask(alpha, v))));
    return mul(divide(divide(divide(spread, c), c), aa),
               divide(times(l, d_set(0.25)), where(d_lt(floor.v, d.v), d, floor)));
}

/// S of microfacets, and that times Schlick's (1 - v.h)^5.
INLINE void find_lobe(bool bends, const glint_derivative_material *material, lanes alpha, const shine *s,
                      const lanes normal[3], const lanes eye[3], lanes *specular, lanes *grazing)
{
    const lanes zero = number(0), one = number(1);
    lanes h[3], across[3];
    for (int c = 0; c < 3; c++)
        h[c] = add(s->way[c], eye[c]);
    for (int c = 0; c < 3; c++) {
        const int a = (c + 1) % 3, b = (c + 2) % 3;
        across[c] = sub(mul(h[b], normal[a]), mul(h[a], normal[b]));
    }
    const lanes h2 = dot(h, h);
    lanes sine2 = divide(dot(across, across), h2);
    sine2 = where(d_lt(sine2.v, one.v), sine2, one);
    const lanes facing = dot_bent(bends, normal, eye);
    const lanes l = where(d_lt(s->cosine.v, one.v), s->cosine, one), least = where(d_lt(facing.v, one.v), facing, one);
    const lanes v = where(d_lt(zero.v, least.v), least, zero); // a bumped normal may face away; see stages/ref/microfacets.h
    *specular = find_facets(material, alpha, sine2, l, v);
    lanes z = times(add(one, dot_bent(bends, s->way, eye)), d_set(0.5));
    z = where(d_lt(z.v, one.v), z, one);
    const lanes m = sub(one, root(where(d_lt(zero.v, z.v), z, zero))), mm = mul(m, m);
    *grazing = mul(*specular, mul(mul(mm, mm), m));
    const dm there = d_lt(zero.v, h2.v);
    *specular = where(there, *specular, zero);
    *grazing = where(there, *grazing, zero);
}

void glint_derive_eyes(double direction[3][GLINT_GROUP], double *const eye[3])
{
    for (int i = 0; i < GLINT_GROUP; i += VD) {
        const vd x = d_load(direction[0] + i), y = d_load(direction[1] + i), z = d_load(direction[2] + i);
        const vd inverse = d_set(-1) / d_sqrt((x * x + y * y) + z * z);
        d_store(eye[0] + i, x * inverse);
        d_store(eye[1] + i, y * inverse);
        d_store(eye[2] + i, z * inverse);
    }
}

/// `bends` is a constant.
INLINE void derive_lanes(bool bends, const glint_derivative_light *light, const glint_derivative_material *material,
                         const glint_derivative_planes *planes, const glint_derivative_points *points, const glint_derivative_source *source, unsigned which,
                         double *const sum[3], double *const whole[3])
{
    const vd zero = d_set(0);
    const bool weighs = source->weight || source->radiant || light->attenuated || light->is_spot; // else the weight is 1
    lanes kd[3], ks[3], kg[3];
    for (int c = 0; c < 3; c++) {
        kd[c] = mul(of(material->diffuse[c]), of(light->diffuse[c]));
        ks[c] = mul(of(material->specular[c]), of(light->specular[c]));
        kg[c] = mul(of(material->grazing[c]), of(light->specular[c]));
    }
    for (int i = 0; i < GLINT_GROUP; i += VD) {
        const dm reached = dm_from_bits(which >> i & ((1u << VD) - 1));
        lanes specular = number(0), grazing = number(0);
        lanes normal[3], eye[3];
        if (!(which >> i & ((1u << VD) - 1)))
            continue;
        const shine s = find_shine(bends, light, points, source, i);
        load_dual(bends, points, 1, i, normal);
        load_dual(bends, points, 2, i, eye);
        if (material->highlight == GLINT_HIGHLIGHT_FACETS)
            find_lobe(bends, material, take_plane(planes, GLINT_DERIVED_ALPHA, i, of(material->alpha)), &s, normal, eye,
                      &specular, &grazing);
        else if (material->highlight != GLINT_HIGHLIGHT_NONE)
            specular = find_power(bends, material, take_plane(planes, GLINT_DERIVED_SHININESS, i, of(material->shininess)),
                                  &s, normal, eye);
        for (int c = 0; c < 3; c++) {
            const lanes one = number(1);
            lanes light_left = mul(kd[c], s.cosine);
            if (planes)
                light_left = mul(light_left, take_plane(planes, GLINT_DERIVED_DIFFUSE + c, i, one));
            if (material->highlight != GLINT_HIGHLIGHT_NONE) {
                lanes shiny = mul(ks[c], specular);
                if (material->highlight == GLINT_HIGHLIGHT_FACETS)
                    shiny = add(shiny, mul(kg[c], grazing));
                light_left = add(light_left, planes ? mul(shiny, take_plane(planes, GLINT_DERIVED_SPECULAR + c, i, one)) : shiny);
            }
            if (weighs)
                light_left = mul(light_left, s.weight);
            if (source->tint[0])
                light_left = mul(light_left, make(d_load(source->tint[c] + i), d_load(source->tint_slope[c] + i)));
            d_store(sum[c] + i, d_load(sum[c] + i) + d_select(reached, light_left.d, zero));
            if (whole[0])
                d_store(whole[c] + i, d_load(whole[c] + i) + d_select(reached, light_left.v, zero));
        }
    }
}

void glint_derive_light(const glint_derivative_light *light, const glint_derivative_material *material,
                        const glint_derivative_planes *planes, const glint_derivative_points *points, const glint_derivative_source *source, unsigned which,
                        double *const sum[3], double *const whole[3])
{
    if (points->slope[0][0])
        derive_lanes(true, light, material, planes, points, source, which, sum, whole);
    else
        derive_lanes(false, light, material, planes, points, source, which, sum, whole);
}

void glint_derive_arrival(const glint_derivative_light *light, const glint_derivative_points *points,
                          const glint_derivative_source *source, glint_derivative_arrival *out)
{
    const bool bends = points->slope[0][0];
    for (int i = 0; i < GLINT_GROUP; i += VD) {
        const shine s = find_shine(bends, light, points, source, i);
        lanes all[GLINT_ARRIVAL_COUNT] = { s.way[0], s.way[1], s.way[2], number(0), number(0), number(0), s.distance };
        for (int c = 0; c < 3; c++) {
            all[3 + c] = mul(of(light->diffuse[c]), s.weight);
            if (source->tint[0])
                all[3 + c] = mul(all[3 + c], make(d_load(source->tint[c] + i), d_load(source->tint_slope[c] + i)));
        }
        for (int k = 0; k < GLINT_ARRIVAL_COUNT; k++) {
            d_store(out->value[k] + i, all[k].v);
            d_store(out->slope[k] + i, all[k].d);
        }
    }
}
