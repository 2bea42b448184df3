// view and facet: the inputs of materials with microfacets: the angle at which a point is seen, the angle between
// each light's half vector and the normal, and the Fresnel reflection at the half vector. Contract: contract.h.
#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/light/cone.h"
#include "engine/render/stages/light/light_sample.h"
#include "engine/render/stages/simd/real.h"

static void R(view)(const glint_view_args *args)
{
    _Alignas(64) float along[GLINT_GROUP], length2[GLINT_GROUP];
    for (R(group_cursor) cursor = { 0 }; cursor.g < args->group_count; R(next_group)(args->camera, &cursor)) {
        const size_t at = (size_t)cursor.g * GLINT_GROUP;
        if (!args->hits[cursor.g])
            continue;
        const R(group_directions) directions = R(directions_of)(args->camera, cursor.x, cursor.y);
        for (int i = 0; i < GLINT_GROUP; i += VR) {
            vr n[3], d[3];
            R(load3)(args->normal, at + i, n);
            R(load_direction)(directions, args->direction, at, i, d);
            r_store_f(along + i, -DOT(n, d));
            r_store_f(length2 + i, DOT(d, d));
        }
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            vf cosine = f_load(along + i) / f_sqrt(f_load(length2 + i));
            f_store(args->facing + at + i, f_min(f_max(cosine, f_set(0)), f_set(1)));
        }
    }
}

/// Returns whether lanes of `lit` have a material with microfacets.
static inline bool R(has_facets)(const glint_facet_args *args, size_t at, unsigned lit)
{
    while (lit) {
        const uint32_t material = args->material[at + (unsigned)__builtin_ctz(lit)];
        if (args->materials[material].highlight == GLINT_HIGHLIGHT_FACETS)
            return true;
        lit &= ~lanes_equal(args->material + at, material);
    }
    return false;
}

/// Computes the real part of one vector of lanes: the squared sine, and (v.h)^2. Returns the lanes in which the half
/// vector is defined.
static inline unsigned R(facet_lanes)(const vr n[3], const vr l[3], const vr d[3], float *sine2, float *square)
{
    const vr zero = r_set(0), one = r_set(1), two = r_set(2);
    const vr p = r_sqrt(DOT(l, l)), r = r_sqrt(DOT(d, d)), w = p * r;
    const vr h[3] = { l[0] * r - d[0] * p, l[1] * r - d[1] * p, l[2] * r - d[2] * p };
    const vr k[3] = { n[1] * h[2] - n[2] * h[1], n[2] * h[0] - n[0] * h[2], n[0] * h[1] - n[1] * h[0] };
    const vr h2 = DOT(h, h);
    r_store_f(sine2, r_min(DOT(k, k) / h2, one));
    r_store_f(square, r_max(r_min((w - DOT(l, d)) / (two * w), one), zero));
    return rm_bits(r_lt(zero, h2));
}

/// Computes one group of sample s; light_samples: NULL if it is not an area light.
static inline void R(facet_group)(const glint_facet_args *args, uint32_t s, const R(light_sample_set) * light_samples,
                                  size_t at, R(group_directions) directions)
{
    const bool cone = light_samples && R(is_cone)(args->light_sample[0]);
    _Alignas(64) float sine2[GLINT_GROUP], square[GLINT_GROUP];
    unsigned some = 0;
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        vr n[3], d[3], l[3], point[3];
        R(load3)(args->normal, at + i, n);
        R(load3)(args->point, at + i, point);
        R(load_direction)(directions, args->direction, at, i, d);
        for (int k = 0; k < 3; k++) {
            l[k] = light_samples ? r_load(light_samples->light_sample[s].position[k] + i) : r_set(args->position[k]);
            if (cone)
                l[k] = r_load(light_samples->direction[s][k] + i);
            else if (!args->directional)
                l[k] = (l[k] - point[k]) * r_set(args->scale);
        }
        some |= R(facet_lanes)(n, l, d, sine2 + i, square + i) << i;
    }
    some &= args->lit[s][at / GLINT_GROUP];
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(some >> i & ((1u << VF) - 1));
        const vf m = f_set(1) - f_sqrt(f_load(square + i)), m2 = m * m;
        f_store(args->sine2[s] + at + i, f_select(mask, f_load(sine2 + i), f_set(GLINT_NO_SPECULAR)));
        f_store(args->schlick[s] + at + i, f_select(mask, (m2 * m2) * m, f_set(0)));
    }
}

static void R(facet)(const glint_facet_args *args)
{
    R(light_sample_set) light_samples;
    const bool area = args->light_sample[0] != NULL;
    if (area)
        R(load_light_samples)(args->light_sample, args->sample_count, &light_samples);
    for (R(group_cursor) cursor = { 0 }; cursor.g < args->group_count; R(next_group)(args->camera, &cursor)) {
        const size_t at = (size_t)cursor.g * GLINT_GROUP;
        const R(group_directions) directions = R(directions_of)(args->camera, cursor.x, cursor.y);
        bool placed = !R(is_cone)(args->light_sample[0]);
        for (uint32_t s = 0; s < args->sample_count; s++) {
            if (!R(has_facets)(args, at, args->lit[s][cursor.g]))
                continue;
            if (!placed)
                R(place_in_cone)(args->light_sample, args->sample_count, args->scale, args->point, args->normal, at,
                                 &light_samples);
            placed = true;
            R(facet_group)(args, s, area ? &light_samples : NULL, at, directions);
        }
    }
}

#if GLINT_WITH(MICROFACET)
KERNEL(view, glint_view_args)
KERNEL(facet, glint_facet_args)
#endif
