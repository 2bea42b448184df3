/// Affine maps.
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/glint_math.h"
#include "engine/render/scene/objects.h"

glint_transform glint_transform_identity(void)
{
    return (glint_transform) { { { 1, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, 1, 0 } } };
}

glint_transform glint_transform_product(const glint_transform *outer, const glint_transform *inner)
{
    if (!outer || !inner)
        return glint_transform_identity();
    glint_transform out;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            out.m[i][j] = (outer->m[i][0] * inner->m[0][j] + outer->m[i][1] * inner->m[1][j]) +
                          (outer->m[i][2] * inner->m[2][j] + (j == 3 ? outer->m[i][3] : 0));
    return out;
}

glint_transform glint_transform_translate(const double by[3])
{
    if (!by)
        return glint_transform_identity();
    glint_transform out = glint_transform_identity();
    for (int i = 0; i < 3; i++)
        out.m[i][3] = by[i];
    return out;
}

glint_transform glint_transform_scale(const double by[3])
{
    if (!by)
        return glint_transform_identity();
    glint_transform out = glint_transform_identity();
    for (int i = 0; i < 3; i++)
        out.m[i][i] = by[i];
    return out;
}

/// Computes sine and cosine; both are exact for quarter turns.
static void turn(double degrees, double *sine, double *cosine)
{
    static const double quarter[4][2] = { { 0, 1 }, { 1, 0 }, { 0, -1 }, { -1, 0 } };
    double rest = fmod(degrees, 360);
    rest = rest < 0 ? rest + 360 : rest;
    if (fmod(rest, 90) == 0) {
        *sine = quarter[(int)(rest / 90) % 4][0];
        *cosine = quarter[(int)(rest / 90) % 4][1];
        return;
    }
    *sine = glint_sin(rest * (0x1.921fb54442d18p+1 / 180));
    *cosine = glint_cos(rest * (0x1.921fb54442d18p+1 / 180));
}

glint_transform glint_transform_rotate_deg(const double axis[3], double degrees)
{
    if (!axis)
        return glint_transform_identity();
    double a[3], s, c;
    glint_transform out = glint_transform_identity();
    vec_normalize(a, axis);
    turn(degrees, &s, &c);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int k = 3 - i - j; // for i != j, the third axis
            const double across = i == j ? c : (j == (i + 1) % 3 ? -1 : 1) * a[k] * s;
            out.m[i][j] = a[i] * a[j] * (1 - c) + across;
        }
    return out;
}

bool glint_transform_is_identity(const glint_transform *t)
{
    const glint_transform identity = glint_transform_identity();
    for (int i = 0; i < 12; i++)
        if (t->m[i / 4][i % 4] != identity.m[i / 4][i % 4])
            return false;
    return true;
}

void glint_transform_linear(const glint_transform *t, double out[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = t->m[i][j];
}

/// Returns a b - c d with a relative error of at most 2^-52, even under cancellation (Kahan; Jeannerod, Louvet,
/// Muller, Math. Comp. 82, 2013).
static double difference_of_products(double a, double b, double c, double d)
{
    const double product = c * d, lost = fma(-c, d, product);
    return fma(a, b, -product) + lost;
}

/// Plainly rounded differences would have errors in proportion to the square of the largest entry. For a map that
/// flattens in two directions, these errors are far larger than its condition number implies.
double glint_linear_cofactors(double m[3][3], double out[3][3])
{
    for (int i = 0; i < 3; i++) {
        const double *u = m[(i + 1) % 3], *v = m[(i + 2) % 3];
        for (int c = 0; c < 3; c++)
            out[i][c] = difference_of_products(u[(c + 1) % 3], v[(c + 2) % 3], u[(c + 2) % 3], v[(c + 1) % 3]);
    }
    return vec_dot(m[0], out[0]);
}

/// Returns the determinant of the matrix with columns of length 1: 0 if they lie in one plane.
static double openness(const glint_transform *t)
{
    double columns[3][3], cofactors[3][3];
    for (int j = 0; j < 3; j++) {
        for (int i = 0; i < 3; i++)
            columns[j][i] = t->m[i][j];
        if (vec_max_abs(columns[j]) == 0)
            return 0;
        vec_normalize(columns[j], columns[j]);
    }
    return glint_linear_cofactors(columns, cofactors);
}

glint_status glint_check_transform(const char *name, const glint_transform *t, glint_error *error)
{
    for (int i = 0; i < 12; i++)
        if (!isfinite(t->m[i / 4][i % 4]))
            return glint_fail(error, GLINT_ERR_INVALID, "%s: finite numbers expected, got %.15g", name,
                              t->m[i / 4][i % 4]);
    if (!(fabs(openness(t)) > 1e-12))
        return glint_fail(error, GLINT_ERR_INVALID,
                          "%s: an invertible transform expected, got one that flattens space", name);
    return GLINT_OK;
}

bool glint_transform_similar(const glint_transform *t, double *factor)
{
    double gram[3][3], mean = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double a[3] = { t->m[0][i], t->m[1][i], t->m[2][i] }, b[3] = { t->m[0][j], t->m[1][j], t->m[2][j] };
            gram[i][j] = vec_dot(a, b);
        }
    mean = (gram[0][0] + gram[1][1] + gram[2][2]) / 3;
    for (int i = 0; i < 9; i++)
        if (!(fabs(gram[i / 3][i % 3] - (i % 4 == 0 ? mean : 0)) <= 0x1p-47 * mean))
            return false;
    *factor = sqrt(mean);
    return true;
}

void glint_transform_point(const glint_transform *t, const double p[3], double out[3])
{
    const double v[3] = { p[0], p[1], p[2] };
    for (int i = 0; i < 3; i++)
        out[i] = (t->m[i][0] * v[0] + t->m[i][1] * v[1]) + (t->m[i][2] * v[2] + t->m[i][3]);
}
