// The reference of slope, arrival and eyes: the formulas of light, shade and facets on dual numbers.

static glint_dual dual_either(bool first, glint_dual a, glint_dual b) { return first ? a : b; }

static glint_dual dual_dot(const glint_dual a[3], const glint_dual b[3])
{
    return dual_add(dual_add(dual_mul(a[0], b[0]), dual_mul(a[1], b[1])), dual_mul(a[2], b[2]));
}

/// Returns x^s for x in 0 .. 1.
static glint_dual dual_power(glint_dual x, glint_dual s)
{
    if (!(x.value > 0))
        return dual(0, 0);
    const double base = x.value < 1 ? x.value : 1, log2 = op_log2(base), y = op_exp2(s.value * log2);
    return dual(y, y * ((s.value / base) * x.slope + (0x1.62e42fefa39efp-1 * log2) * s.slope));
}

/// The light that arrives at a lane.
typedef struct dual_shine {
    glint_dual direction[3], cosine, distance, weight;
    bool weighs;
} dual_shine;

static glint_dual dual_at(const double *value, const double *slope, int i) { return dual(value[i], slope ? slope[i] : 0); }

static glint_dual dual_cone(const glint_derivative_light *light, const glint_dual direction[3])
{
    const glint_dual c = dual_sub(dual(0, 0), dual_dot(light->axis, direction));
    glint_dual x = dual_mul(dual_sub(c, light->outer), light->inverse);
    if (light->inverse.value == HUGE_VAL)
        x = dual(light->outer.value < c.value ? 1 : 0, 0);
    if (!(x.value < 1))
        x = dual(1, 0);
    if (!(x.value > 0))
        x = dual(0, 0);
    const glint_dual step = dual_mul(dual_mul(x, x), dual_sub(dual(3, 0), dual_add(x, x)));
    const bool falls = light->exponent.value != 0 || light->exponent.slope != 0;
    return falls ? dual_mul(step, dual_power(c, light->exponent)) : step;
}

/// Computes the distance of a light with a position, and the effect of the distance on the weight. s->direction is
/// not normalised yet.
static void add_distance(const glint_derivative_source *source, dual_shine *s, int i)
{
    const glint_dual length2 = dual_dot(s->direction, s->direction);
    const double length = sqrt(length2.value), over = 1 / length;
    s->distance = dual(length, length > 0 ? (0.5 * length2.slope) * over : 0);
    if (source->radiant) {
        const glint_dual normal[3] = { dual(source->normal[0][i], 0), dual(source->normal[1][i], 0),
                                       dual(source->normal[2][i], 0) };
        glint_dual m = dual_sub(dual(0, 0), dual_dot(s->direction, normal));
        if (source->both && m.value < 0)
            m = dual_sub(dual(0, 0), m);
        s->weight = dual_mul(s->weight, dual_div(m, dual_mul(length2, s->distance)));
    }
    const glint_dual inverse = dual(over, -(over * s->distance.slope) * over);
    for (int c = 0; c < 3; c++)
        s->direction[c] = dual_mul(s->direction[c], inverse);
}

static dual_shine dual_shine_at(const glint_derivative_light *light, const glint_derivative_points *points,
                                const glint_derivative_source *source, int i)
{
    dual_shine s = { .distance = dual(HUGE_VAL, 0), .weight = dual(source->weight ? source->weight[i] : 1, 0) };
    glint_dual normal[3];
    s.weighs = source->weight || source->radiant || light->attenuated || light->is_spot;
    for (int c = 0; c < 3; c++) {
        s.direction[c] = dual(source->position[c][i], light->position[c].slope);
        if (!light->directional)
            s.direction[c] = dual_sub(s.direction[c], dual_at(points->point[c], points->slope[0][c], i));
        normal[c] = dual_at(points->normal[c], points->slope[1][c], i);
    }
    if (!light->directional)
        add_distance(source, &s, i);
    if (light->attenuated) {
        const glint_dual *a = light->coefficients;
        const glint_dual further = dual_mul(s.distance, dual_add(a[1], dual_mul(a[2], s.distance)));
        s.weight = dual_div(s.weight, dual_add(a[0], further));
    }
    if (light->is_spot)
        s.weight = dual_mul(s.weight, dual_cone(light, s.direction));
    s.cosine = dual_dot(s.direction, normal);
    return s;
}

// ---- Highlights ----------------------------------------------------------------------------------------------------

/// A lane's directions.
typedef struct dual_directions {
    glint_dual normal[3], eye[3], half[3];
} dual_directions;

static glint_dual dual_strength(const glint_derivative_material *m, glint_dual power, const dual_shine *s,
                                const dual_directions *w)
{
    glint_dual x;
    if (m->highlight == GLINT_HIGHLIGHT_PHONG)
        x = dual_sub(dual_mul(s->cosine, dual_scale(dual_dot(w->normal, w->eye), 2)), dual_dot(s->direction, w->eye));
    else
        x = dual_div(dual_dot(w->half, w->normal), dual_sqrt(dual_dot(w->half, w->half)));
    const glint_dual strength = dual_power(x, power);
    return m->lobe == GLINT_LOBE_POWER_COSINE ? dual_mul(strength, s->cosine) : strength;
}

static glint_dual dual_mask(glint_dual alpha, glint_dual x)
{
    const glint_dual one = dual(1, 0), rest = dual_sub(one, dual_mul(x, x));
    const glint_dual s = dual_mul(alpha, dual_sqrt(dual_either(rest.value > 0, rest, dual(0, 0)))), q = dual_div(x, s);
    if (!(q.value < 1.6))
        return dual(0, 0);
    const glint_dual slow = dual_mul(dual_sub(dual_scale(q, 0.396), dual(1.259, 0)), q);
    return dual_div(dual_mul(s, dual_add(slow, one)), dual_add(dual_scale(q, 2.181), dual(3.535, 0)));
}

static glint_dual dual_ggx(glint_dual alpha, glint_dual sine2, glint_dual l, glint_dual v)
{
    const glint_dual aa = dual_mul(alpha, alpha), rest = dual_sub(dual(1, 0), aa);
    const glint_dual u = dual_div(alpha, dual_add(sine2, dual_mul(aa, dual_sub(dual(1, 0), sine2))));
    const glint_dual to_eye = dual_sqrt(dual_add(aa, dual_mul(rest, dual_mul(v, v))));
    const glint_dual to_light = dual_sqrt(dual_add(aa, dual_mul(rest, dual_mul(l, l))));
    const glint_dual d = dual_add(dual_mul(l, to_eye), dual_mul(v, to_light));
    return dual_mul(dual_mul(u, u), dual_div(dual_scale(l, 0.5), dual_either(d.value > 0x1p-126, d, dual(0x1p-126, 0))));
}

static glint_dual dual_beckmann(glint_dual alpha, glint_dual sine2, glint_dual l, glint_dual v)
{
    const glint_dual aa = dual_mul(alpha, alpha), cosine2 = dual_sub(dual(1, 0), sine2);
    const glint_dual c = dual_either(cosine2.value > 0x1p-40, cosine2, dual(0x1p-40, 0));
    const glint_dual y = dual_div(dual_scale(dual_div(sine2, c), -0x1.71547652b82fep+0), aa);
    const double e = op_exp2(y.value);
    const glint_dual spread = dual_div(dual_div(dual_div(dual(e, (e * 0x1.62e42fefa39efp-1) * y.slope), c), c), aa);
    const glint_dual masked = dual_add(dual_mul(v, dual_mask(alpha, l)), dual_mul(l, dual_mask(alpha, v)));
    const glint_dual d = dual_add(dual_mul(l, v), masked);
    return dual_mul(spread, dual_div(dual_scale(l, 0.25), dual_either(d.value > 0x1p-126, d, dual(0x1p-126, 0))));
}

/// Returns the microfacet term; *grazing: the term times Schlick's (1 - v.h)^5.
static glint_dual dual_lobe(const glint_derivative_material *m, glint_dual alpha, const dual_shine *s,
                            const dual_directions *w, glint_dual *grazing)
{
    const glint_dual one = dual(1, 0), zero = dual(0, 0), h2 = dual_dot(w->half, w->half);
    glint_dual across[3];
    *grazing = zero;
    if (!(h2.value > 0))
        return zero;
    for (int c = 0; c < 3; c++) {
        const int a = (c + 1) % 3, b = (c + 2) % 3;
        across[c] = dual_sub(dual_mul(w->half[b], w->normal[a]), dual_mul(w->half[a], w->normal[b]));
    }
    glint_dual sine2 = dual_div(dual_dot(across, across), h2), v = dual_dot(w->normal, w->eye);
    const glint_dual l = dual_either(s->cosine.value < 1, s->cosine, one);
    sine2 = dual_either(sine2.value < 1, sine2, one);
    v = dual_either(v.value < 1, v, one);
    v = dual_either(v.value > 0, v, zero);
    const glint_dual lobe = m->lobe == GLINT_LOBE_GGX ? dual_ggx(alpha, sine2, l, v) : dual_beckmann(alpha, sine2, l, v);
    glint_dual z = dual_scale(dual_add(one, dual_dot(s->direction, w->eye)), 0.5);
    z = dual_either(z.value < 1, z, one);
    const glint_dual rest = dual_sub(one, dual_sqrt(dual_either(z.value > 0, z, zero))), squared = dual_mul(rest, rest);
    *grazing = dual_mul(lobe, dual_mul(dual_mul(squared, squared), rest));
    return lobe;
}

// ---- The stages ----------------------------------------------------------------------------------------------------

static glint_dual dual_plane(const glint_derivative_planes *planes, int which, int i, glint_dual own)
{
    return planes && planes->value[which] ? dual_at(planes->value[which], planes->slope[which], i) : own;
}

/// Returns the light of channel c that a material reflects to the eye.
static glint_dual dual_reflected_light(const glint_slope_args *args, const dual_shine *s, glint_dual specular,
                                       glint_dual grazing, int c, int i)
{
    const glint_derivative_light *light = args->light;
    const glint_derivative_material *m = args->material;
    const glint_dual one = dual(1, 0), ks = dual_plane(args->planes, GLINT_DERIVED_SPECULAR + c, i, one);
    glint_dual light_out = dual_mul(dual_mul(m->diffuse[c], light->diffuse[c]), s->cosine);
    light_out = dual_mul(light_out, dual_plane(args->planes, GLINT_DERIVED_DIFFUSE + c, i, one));
    glint_dual shiny = dual_mul(dual_mul(m->specular[c], light->specular[c]), specular);
    if (m->highlight == GLINT_HIGHLIGHT_FACETS)
        shiny = dual_add(shiny, dual_mul(dual_mul(m->grazing[c], light->specular[c]), grazing));
    if (m->highlight != GLINT_HIGHLIGHT_NONE)
        light_out = dual_add(light_out, dual_mul(shiny, ks));
    if (s->weighs)
        light_out = dual_mul(light_out, s->weight);
    if (args->source->tint[0])
        light_out = dual_mul(light_out, dual_at(args->source->tint[c], args->source->tint_slope[c], i));
    return light_out;
}

static void slope_lane(const glint_slope_args *args, int i)
{
    const glint_derivative_points *points = args->points;
    const glint_derivative_material *m = args->material;
    const dual_shine s = dual_shine_at(args->light, points, args->source, i);
    glint_dual specular = dual(0, 0), grazing = dual(0, 0);
    dual_directions w;
    for (int c = 0; c < 3; c++) {
        w.normal[c] = dual_at(points->normal[c], points->slope[1][c], i);
        w.eye[c] = dual_at(points->eye[c], points->slope[2][c], i);
        w.half[c] = dual_add(s.direction[c], w.eye[c]);
    }
    if (m->highlight == GLINT_HIGHLIGHT_FACETS)
        specular = dual_lobe(m, dual_plane(args->planes, GLINT_DERIVED_ALPHA, i, m->alpha), &s, &w, &grazing);
    else if (m->highlight != GLINT_HIGHLIGHT_NONE)
        specular = dual_strength(m, dual_plane(args->planes, GLINT_DERIVED_SHININESS, i, m->shininess), &s, &w);
    for (int c = 0; c < 3; c++) {
        const glint_dual light_out = dual_reflected_light(args, &s, specular, grazing, c, i);
        args->sum[c][i] += light_out.slope;
        if (args->whole[0])
            args->whole[c][i] += light_out.value;
    }
}

static void slope(const glint_slope_args *args)
{
    for (int i = 0; i < GLINT_GROUP; i++)
        if (args->lanes >> i & 1)
            slope_lane(args, i);
}

static void arrival(const glint_arrival_args *args)
{
    for (int i = 0; i < GLINT_GROUP; i++) {
        const glint_derivative_source *source = args->source;
        const dual_shine s = dual_shine_at(args->light, args->points, source, i);
        glint_dual all[GLINT_ARRIVAL_COUNT] = { s.direction[0], s.direction[1], s.direction[2] };
        for (int c = 0; c < 3; c++) {
            all[3 + c] = dual_mul(args->light->diffuse[c], s.weight);
            if (source->tint[0])
                all[3 + c] = dual_mul(all[3 + c], dual_at(source->tint[c], source->tint_slope[c], i));
        }
        all[6] = s.distance;
        for (int n = 0; n < GLINT_ARRIVAL_COUNT; n++) {
            if (args->value[n])
                args->value[n][i] = all[n].value;
            if (args->slope[n])
                args->slope[n][i] = all[n].slope;
        }
    }
}

static void eyes(const glint_eyes_args *args)
{
    for (int i = 0; i < GLINT_GROUP; i++) {
        double d[3];
        for (int c = 0; c < 3; c++)
            d[c] = args->direction[c * GLINT_GROUP + i];
        for (int c = 0; c < 3 && args->more; c++)
            d[c] += args->more[c * GLINT_GROUP + i];
        const double inverse = -1 / sqrt(dot_of(d, d));
        for (int c = 0; c < 3; c++)
            args->eye[c][i] = d[c] * inverse;
    }
}
