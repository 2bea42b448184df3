// The reference of spread, for one type of real; included by ref.c after ref/real.h.

/// Returns the normal of the facet at a point of the disk, along the basis in which the eye is at e.
static NAME(vec3) NAME(drawn_facet)(NAME(vec3) e, REAL alpha, REAL x, REAL y)
{
    REAL sx = alpha * e.x, sy = alpha * e.y, length = NAME(square_root)((sx * sx + sy * sy) + e.z * e.z);
    REAL u = NAME(min)(x * x + y * y, 1), top = 1 + e.z / length;
    REAL stretch = NAME(square_root)(NAME(max)(top * (2 - u * top), 0));
    NAME(vec3) f = NAME(vec)(alpha * (x * stretch + sx / length), alpha * (y * stretch + sy / length), (1 - u) * top);
    REAL size = NAME(square_root)(NAME(length2)(f));
    return size > 0 ? NAME(over)(f, size) : NAME(vec)(0, 0, 1);
}

static void NAME(spread_sample)(const glint_spread_args *args, uint32_t i)
{
    NAME(vec3) n = NAME(load)(args->normal, i), v = NAME(load)(args->ray, i);
    REAL alpha = ((const REAL *)args->alpha)[i], aa = alpha * alpha;
    NAME(vec3) tangent, bitangent;
    NAME(tangents_of)(n, &tangent, &bitangent);
    REAL up = NAME(min)(NAME(max)(0 - NAME(dot)(n, v), 0), 1);
    NAME(vec3) e = NAME(vec)(0 - NAME(dot)(tangent, v), 0 - NAME(dot)(bitangent, v), up);
    NAME(vec3) facet = NAME(drawn_facet)(e, alpha, ((const REAL *)args->disk[0])[i], ((const REAL *)args->disk[1])[i]);
    REAL cosine = NAME(min)(NAME(dot)(e, facet), 1);
    NAME(vec3) out = NAME(sub)(NAME(times)(facet, 2 * cosine), e);
    REAL a = NAME(square_root)(e.z * e.z + aa * (1 - e.z * e.z));
    REAL b = NAME(square_root)(out.z * out.z + aa * NAME(max)(1 - out.z * out.z, 0));
    double r = 1 - (double)cosine;
    args->grazing[i] = (r * r) * (r * r) * r;
    double part = args->weight[i] = 0 < out.z ? (out.z * (e.z + a)) / (out.z * a + e.z * b) : 0;
    for (int c = 0; c < 3 && args->ray_weight[0]; c++) {
        double weight = args->head_on[c][i] * part + args->added[c][i] * (args->grazing[i] * part);
        args->ray_weight[c][i] = weight < GLINT_WEIGHT_MAX ? weight : GLINT_WEIGHT_MAX;
    }
    ((REAL *)args->direction[0])[i] = (out.x * tangent.x + out.y * bitangent.x) + out.z * n.x;
    ((REAL *)args->direction[1])[i] = (out.x * tangent.y + out.y * bitangent.y) + out.z * n.y;
    ((REAL *)args->direction[2])[i] = (out.x * tangent.z + out.y * bitangent.z) + out.z * n.z;
}

static void NAME(spread)(const glint_spread_args *args)
{
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
        if (args->wanted[i / GLINT_GROUP])
            NAME(spread_sample)(args, i);
}
