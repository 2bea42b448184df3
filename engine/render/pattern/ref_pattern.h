// The reference of noise, cells, hash, parity and texels, a lane at a time. Included by ref.h.

// ---- the hash ----------------------------------------------------------------------------------------------------

static uint32_t fold(uint64_t x) { return (uint32_t)(x ^ x >> 32); }

static uint64_t product(uint32_t a, uint32_t b) { return (uint64_t)a * b; }

/// Hashes the unit cube at x, y, z, modulo 2^32.
static uint32_t hash_of_cube(uint32_t x, uint32_t y, uint32_t z, uint32_t seed)
{
    const uint32_t sum = fold(product(x, GLINT_HASH_X) + product(y, GLINT_HASH_Y) + product(z, GLINT_HASH_Z) +
                              product(seed, GLINT_HASH_SEED));
    return fold(product(sum, GLINT_HASH_A));
}

/// Returns an integer modulo 2^32; undefined beyond 2^51, and for NaN.
static uint32_t word_of(double whole) { return (uint32_t)bits_of_double(whole + GLINT_ROUNDER_DOUBLE); }

/// Returns the bits of x, after replacing -0 and every NaN by 0.
static uint64_t canonical_bits(double x) { return x == x ? bits_of_double(x + 0.0) : 0; }

static double op_hash(double x, double y, double z)
{
    const uint64_t bits[3] = { canonical_bits(x), canonical_bits(y), canonical_bits(z) };
    uint32_t h = GLINT_HASH_SEED;
    for (int k = 0; k < 3; k++) {
        h = fold(product(h ^ (uint32_t)bits[k], GLINT_HASH_A));
        h = fold(product(h ^ (uint32_t)(bits[k] >> 32), GLINT_HASH_B));
    }
    h = fold(product(h, GLINT_HASH_C));
    h = (uint32_t)product(h, GLINT_HASH_X);
    return (double)h * 0x1p-32;
}

static double parity_of(double x)
{
    x = floor(x);
    return x - 2 * floor(0.5 * x);
}

static double op_parity(double x, double y, double z)
{
    const double sum = (parity_of(x) + parity_of(y)) + parity_of(z);
    return sum - 2 * floor(0.5 * sum);
}

// ---- noise -------------------------------------------------------------------------------------------------------

static double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

static double fade_slope(double t) { return 30 * (t * t) * (t * (t - 2) + 1); }

static double between_two(double t, double a, double b) { return a + t * (b - a); }

/// Returns the dot product of a corner's gradient, from Perlin's table, and the vector d from the corner.
static double ramp_of(uint32_t hash, const double d[3], double gradient[3])
{
    const uint32_t h = (uint32_t)product(hash, GLINT_HASH_B) >> 28;
    const int u = h < 8 ? 0 : 1, v = h < 4 ? 1 : h == 12 || h == 14 ? 0 : 2;
    gradient[0] = gradient[1] = gradient[2] = 0;
    gradient[u] = h & 1 ? -1 : 1;
    gradient[v] = h & 2 ? -1 : 1;
    return gradient[u] * d[u] + gradient[v] * d[v];
}

/// Interpolates between values at the eight corners of a cube, x fastest.
static double between_corners(const double at[8], const double f[3])
{
    const double near = between_two(f[1], between_two(f[0], at[0], at[1]), between_two(f[0], at[2], at[3]));
    const double far = between_two(f[1], between_two(f[0], at[4], at[5]), between_two(f[0], at[6], at[7]));
    return between_two(f[2], near, far);
}

/// Returns the contribution of a step along one axis to the slope, interpolated along the other two axes.
static double across_corners(const double at[8], const double f[3], int axis)
{
    const int step = 1 << axis, a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    double edge[4];
    for (int k = 0; k < 4; k++) {
        const int corner = (k & 1) << a | (k >> 1) << b;
        edge[k] = at[corner + step] - at[corner];
    }
    return between_two(f[b], between_two(f[a], edge[0], edge[1]), between_two(f[a], edge[2], edge[3]));
}

/// Returns noise, and its three derivatives unless `slope` is NULL.
static double op_noise(double x, double y, double z, uint32_t seed, double *slope)
{
    const double p[3] = { x, y, z };
    double t[3], f[3], ramp[8], g[8][3];
    uint32_t cube[3];
    for (int k = 0; k < 3; k++) {
        cube[k] = word_of(floor(p[k]));
        t[k] = p[k] - floor(p[k]);
        f[k] = fade(t[k]);
    }
    for (int c = 0; c < 8; c++) {
        const uint32_t i = c & 1, j = c >> 1 & 1, k = (uint32_t)c >> 2;
        const double d[3] = { t[0] - i, t[1] - j, t[2] - k };
        ramp[c] = ramp_of(hash_of_cube(cube[0] + i, cube[1] + j, cube[2] + k, seed), d, g[c]);
    }
    for (int axis = 0; slope && axis < 3; axis++) {
        double along[8];
        for (int c = 0; c < 8; c++)
            along[c] = g[c][axis];
        slope[axis] =
            GLINT_NOISE_SCALE * (between_corners(along, f) + fade_slope(t[axis]) * across_corners(ramp, f, axis));
    }
    return GLINT_NOISE_SCALE * between_corners(ramp, f);
}

// ---- cells -------------------------------------------------------------------------------------------------------

/// Computes the vector from the position to a cube's feature point. x: from the position to the cube's lower corner.
static void to_feature(const uint32_t cube[3], const double x[3], double d[3])
{
    static const uint32_t factor[3] = { GLINT_HASH_B, GLINT_HASH_C, GLINT_HASH_X };
    const uint32_t h = hash_of_cube(cube[0], cube[1], cube[2], 4);
    for (int k = 0; k < 3; k++)
        d[k] = x[k] + (double)(uint32_t)product(h, factor[k]) * 0x1p-32;
}

/// Computes the two nearest feature points of all cubes in which they may be. If distances are equal, the first point
/// counts, in the order from the position's own cube outwards.
static void op_cell(const double p[3], double *distance, double *slope)
{
    double d2[2] = { INFINITY, INFINITY }, to[2][3] = { { NAN, NAN, NAN }, { NAN, NAN, NAN } };
    for (int c = 0; c < 3 * 125; c++) {
        const int offset[3] = { c % 5 - 2, c / 5 % 5 - 2, c / 25 % 5 - 2 };
        const bool inner = abs(offset[0]) < 2 && abs(offset[1]) < 2 && abs(offset[2]) < 2;
        const bool own = !offset[0] && !offset[1] && !offset[2];
        uint32_t cube[3];
        if ((own ? 0 : inner ? 1 : 2) != c / 125)
            continue;
        double x[3], d[3];
        for (int k = 0; k < 3; k++) {
            cube[k] = word_of(floor(p[k])) + (uint32_t)offset[k];
            x[k] = offset[k] - (p[k] - floor(p[k]));
        }
        to_feature(cube, x, d);
        const double length2 = (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
        if (length2 < d2[0]) {
            d2[1] = d2[0];
            memcpy(to[1], to[0], sizeof d);
            d2[0] = length2;
            memcpy(to[0], d, sizeof d);
        } else if (length2 < d2[1]) {
            d2[1] = length2;
            memcpy(to[1], d, sizeof d);
        }
    }
    for (int n = 0; n < 2; n++) {
        const double length = sqrt(d2[n]);
        if (distance)
            distance[n] = length;
        for (int k = 0; slope && k < 3; k++)
            slope[3 * n + k] = -to[n][k] / length;
    }
}

// ---- texels ------------------------------------------------------------------------------------------------------

/// Returns whether a picture repeats horizontally, or, with `down`, vertically.
static bool repeats(glint_wrap wrap, bool down)
{
    return wrap == GLINT_WRAP_REPEAT || (wrap == GLINT_WRAP_AROUND && !down);
}

/// Wraps or clamps a coordinate to 0 .. 1 of a picture's side; NaN gives 0.
static double wrapped(bool repeat, double u)
{
    if (repeat)
        u = u - floor(u);
    u = u > 0 ? u : 0;
    return u < 1 ? u : 1;
}

/// Computes the two texels around x on a side of n texels.
static void neighbours(bool repeat, double x, uint32_t n, uint32_t at[2])
{
    const double first = floor(x);
    at[0] = first < 0 ? (repeat ? n - 1 : 0) : (uint32_t)first;
    at[1] = first + 1 < n ? (uint32_t)(first + 1) : repeat ? 0 : n - 1;
}

/// Computes, for one level, the colour and the derivatives with respect to u and v; NULL: not wanted.
static void texel_of_level(const glint_texture_table *texture, uint32_t level, double u, double v, double color[4],
                           double *slope)
{
    const glint_texture_level *l = &texture->levels[level];
    const double w = l->width, h = l->height;
    const bool across = repeats(texture->wrap, false), down = repeats(texture->wrap, true);
    const double x = wrapped(across, u) * w - 0.5, y = (1 - wrapped(down, v)) * h - 0.5;
    const double fx = x - floor(x), fy = y - floor(y);
    uint32_t i[2], j[2];
    neighbours(across, x, l->width, i);
    neighbours(down, y, l->height, j);
    for (int c = 0; c < 4; c++) {
        double t[2][2];
        for (int k = 0; k < 4; k++)
            t[k >> 1][k & 1] = (double)l->texels[4 * ((size_t)j[k >> 1] * l->width + i[k & 1]) + (size_t)c];
        const double top = between_two(fx, t[0][0], t[0][1]), bottom = between_two(fx, t[1][0], t[1][1]);
        if (color)
            color[c] = between_two(fy, top, bottom);
        if (slope) {
            slope[c] = w * between_two(fy, t[0][1] - t[0][0], t[1][1] - t[1][0]);
            slope[4 + c] = -(h * (bottom - top));
        }
    }
}

static void nearest_texel(const glint_texture_table *texture, double u, double v, double *color)
{
    const glint_texture_level *l = &texture->levels[0];
    const double x = floor(wrapped(repeats(texture->wrap, false), u) * l->width);
    const double y = floor((1 - wrapped(repeats(texture->wrap, true), v)) * l->height);
    const size_t i = (size_t)(x < l->width ? x : l->width - 1), j = (size_t)(y < l->height ? y : l->height - 1);
    for (size_t c = 0; c < 4; c++)
        color[c] = (double)l->texels[4 * (j * l->width + i) + c];
}

/// Reads a level and, if `level` is not whole, the next one.
static void texel_of_levels(const glint_texture_table *texture, double level, double u, double v, double *color, double *slope)
{
    const uint32_t k = (uint32_t)level;
    double next[GLINT_RESULTS_MAX], *out = color ? color : slope;
    texel_of_level(texture, k, u, v, color, slope);
    if (!(level > k))
        return;
    texel_of_level(texture, k + 1, u, v, color ? next : NULL, color ? NULL : next);
    for (int c = 0; c < (color ? 4 : 8); c++)
        out[c] = between_two(level - k, out[c], next[c]);
}

/// Reads a texture. in: u, v, footprints along u and v. `color` or `slope` is NULL. A pixel's longer side is covered by
/// several squares as wide as its shorter side.
static void op_texel(const glint_texture_table *texture, const double in[4], double *color, double *slope)
{
    double *out = color ? color : slope, next[GLINT_RESULTS_MAX];
    const int count = color ? 4 : 8;
    if (texture->filter == GLINT_FILTER_NEAREST) {
        memset(next, 0, sizeof next);
        if (color)
            nearest_texel(texture, in[0], in[1], next);
        memcpy(out, next, (size_t)count * sizeof *next);
        return;
    }
    const glint_texture_level *whole = &texture->levels[0];
    const double across = in[2] * whole->width, down = in[3] * whole->height;
    const double longer = across < down ? down : across, shorter = across < down ? across : down;
    double size = shorter > 1 ? shorter : 1;
    size = size > longer / GLINT_TEXEL_PROBES ? size : longer / GLINT_TEXEL_PROBES;
    double level = size > 1 ? op_log2(size) : 0;
    level = level < texture->level_count - 1 ? level : texture->level_count - 1;
    const double probes = ceil(longer / size - GLINT_TEXEL_SLACK);
    if (!(probes > 1)) {
        texel_of_levels(texture, level, in[0], in[1], color, slope);
        return;
    }
    const double spread = (longer - size) / (across < down ? whole->height : whole->width);
    for (int c = 0; c < count; c++)
        out[c] = 0;
    for (int i = 0; i < (int)probes; i++) {
        const double offset = spread * (i / (probes - 1) - 0.5);
        const double u = in[0] + (across < down ? 0 : offset), v = in[1] + (across < down ? offset : 0);
        texel_of_levels(texture, level, u, v, color ? next : NULL, color ? NULL : next);
        for (int c = 0; c < count; c++)
            out[c] += next[c];
    }
    for (int c = 0; c < count; c++)
        out[c] /= probes;
}
