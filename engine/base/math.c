/// Elementary functions made of + - * / sqrt and integer operations in a fixed order: the same bits on every machine.
///
/// Each result is an unevaluated sum of two doubles (`sum2`) with a relative error below 2^-60, rounded once. It is
/// within 0.51 ulp of the exact result (subnormal results are rounded twice: 0.76 ulp). Special cases follow C99,
/// annex F.
#include "engine/base/math.h"

#include "engine/base/math_tables.h"

#include <math.h>
#include <string.h>

#define HALF_PI_HIGH 0x1.921fb54442d18p+0
#define HALF_PI_LOW 0x1.1a62633145c07p-54

typedef struct sum2 {
    double high, low; ///< high is the rounded value of high + low
} sum2;

static uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/// Returns x 2^e; 2^e must be a normal number.
static double times_power(double x, int e)
{
    uint64_t bits = (uint64_t)(e + 1023) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return x * power;
}

static sum2 fast_two_sum(double a, double b) // |a| >= |b|, or a = 0
{
    double s = a + b;
    return (sum2) { s, b - (s - a) };
}

static sum2 two_sum(double a, double b)
{
    double s = a + b, v = s - a;
    return (sum2) { s, (a - (s - v)) + (b - v) };
}

static sum2 two_prod(double a, double b) // Dekker; |a|, |b| < 2^990 and no underflow of the error
{
    double p = a * b;
    double ta = 134217729.0 * a, ah = ta - (ta - a), al = a - ah;
    double tb = 134217729.0 * b, bh = tb - (tb - b), bl = b - bh;
    return (sum2) { p, ((ah * bh - p) + ah * bl + al * bh) + al * bl };
}

static sum2 add2(sum2 a, sum2 b)
{
    sum2 s = two_sum(a.high, b.high);
    return fast_two_sum(s.high, s.low + (a.low + b.low));
}

static sum2 mul2(sum2 a, sum2 b)
{
    sum2 p = two_prod(a.high, b.high);
    return fast_two_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

// ---- Angles -------------------------------------------------------------------------------------------------------

/// Reads 192 bits of 2/pi from binary digit `start` (>= -64, may be negative), most significant word first.
static void digits_of_two_over_pi(int start, uint64_t window[3])
{
    unsigned at = (unsigned)(start + 64), word = at / 64, shift = at % 64;
    for (int i = 0; i < 3; i++) {
        uint64_t upper = two_over_pi[word + i], lower = two_over_pi[word + i + 1];
        window[i] = shift ? upper << shift | lower >> (64 - shift) : upper;
    }
}

/// Computes m * window mod 2^192.
static void multiply_window(uint64_t m, uint64_t w[3])
{
    __extension__ typedef unsigned __int128 uint128;
    uint128 low = (uint128)m * w[2];
    uint128 mid = (uint128)m * w[1] + (uint64_t)(low >> 64);
    w[0] = m * w[0] + (uint64_t)(mid >> 64);
    w[1] = (uint64_t)mid;
    w[2] = (uint64_t)low;
}

/// Returns the fraction 0.w (192 bits, not zero, w[0] < 2^63) times 4 as a sum.
static sum2 fraction_to_sum(const uint64_t w[3])
{
    uint64_t a = w[0], b = w[1], c = w[2];
    int down = 0;
    while (a == 0) { // at most once for any double
        a = b, b = c, c = 0;
        down += 64;
    }
    int shift = __builtin_clzll(a);
    if (shift) {
        a = a << shift | b >> (64 - shift);
        b = b << shift | c >> (64 - shift);
    }
    double high = (double)(a >> 11); // 53 bits, exact
    double low = (double)((a & 2047) << 53 | b >> 11);
    return fast_two_sum(times_power(high, 2 - 53 - down - shift), times_power(low, 2 - 117 - down - shift));
}

/// Reduces a finite x to quadrant * pi/2 + r, |r| <= pi/4. Payne and Hanek's method with integers: x 2/pi mod 4 to
/// 2^-137.
static sum2 reduce_angle(double x, unsigned *quadrant)
{
    if (fabs(x) <= HALF_PI_HIGH / 2) {
        *quadrant = 0;
        return (sum2) { x, 0 };
    }
    uint64_t bits = bits_of(x), w[3];
    uint64_t m = (bits & 0xfffffffffffff) | 0x10000000000000;
    int e = (int)(bits >> 52 & 0x7ff) - 1075;
    digits_of_two_over_pi(e - 2, w); // digits above are multiples of 4
    multiply_window(m, w);
    unsigned q = (unsigned)(w[0] >> 62);
    w[0] &= 0x3fffffffffffffff;
    bool negative = w[0] >> 61 != 0; // nearer to the next quadrant: 2^190 - w
    if (negative) {
        q++;
        w[0] = 0x4000000000000000 - w[0] - 1;
        w[1] = ~w[1];
        w[2] = ~w[2];
    }
    sum2 r = mul2(fraction_to_sum(w), (sum2) { HALF_PI_HIGH, HALF_PI_LOW });
    if (negative != (x < 0))
        r = (sum2) { -r.high, -r.low };
    *quadrant = (x < 0 ? 0u - q : q) & 3;
    return r;
}

/// Returns sin r for |r| <= pi/4: r - r^3/6 as sums, the rest of the series (to r^19) in double.
static sum2 sine_series(sum2 r)
{
    if (fabs(r.high) < 0x1p-54)
        return r;
    sum2 z = mul2(r, r), cube = mul2(z, r);
    double x = z.high;
    double p = -1.0 / 121645100408832000.0;
    p = p * x + 1.0 / 355687428096000.0;
    p = p * x - 1.0 / 1307674368000.0;
    p = p * x + 1.0 / 6227020800.0;
    p = p * x - 1.0 / 39916800.0;
    p = p * x + 1.0 / 362880.0;
    p = p * x - 1.0 / 5040.0;
    p = p * x + 1.0 / 120.0;
    sum2 third = mul2(cube, (sum2) { -0x1.5555555555555p-3, -0x1.5555555555555p-57 });
    return add2(r, add2(third, (sum2) { cube.high * x * p, 0 }));
}

/// Returns cos r for |r| <= pi/4: 1 - r^2/2 + r^4/24 as sums, the rest (to r^20) in double.
static sum2 cosine_series(sum2 r)
{
    if (fabs(r.high) < 0x1p-54)
        return (sum2) { 1, 0 };
    sum2 z = mul2(r, r), fourth = mul2(z, z);
    double x = z.high;
    double p = 1.0 / 2432902008176640000.0;
    p = p * x - 1.0 / 6402373705728000.0;
    p = p * x + 1.0 / 20922789888000.0;
    p = p * x - 1.0 / 87178291200.0;
    p = p * x + 1.0 / 479001600.0;
    p = p * x - 1.0 / 3628800.0;
    p = p * x + 1.0 / 40320.0;
    p = p * x - 1.0 / 720.0;
    sum2 tail = mul2(fourth, (sum2) { 0x1.5555555555555p-5, 0x1.5555555555555p-59 });
    tail = add2(tail, (sum2) { fourth.high * x * p, 0 });
    return add2(add2((sum2) { 1, 0 }, (sum2) { -0.5 * z.high, -0.5 * z.low }), tail);
}

static double sine_of_quadrant(sum2 r, unsigned quadrant)
{
    sum2 s = quadrant & 1 ? cosine_series(r) : sine_series(r);
    return quadrant & 2 ? -s.high : s.high;
}

double glint_sin(double radians)
{
    if (!isfinite(radians))
        return NAN;
    if (fabs(radians) < 0x1p-27) // r^3/6 is below half an ulp; keeps -0 and subnormals
        return radians;
    unsigned quadrant;
    sum2 r = reduce_angle(radians, &quadrant);
    return sine_of_quadrant(r, quadrant);
}

double glint_cos(double radians)
{
    if (!isfinite(radians))
        return NAN;
    unsigned quadrant;
    sum2 r = reduce_angle(radians, &quadrant);
    return sine_of_quadrant(r, (quadrant + 1) & 3);
}

double glint_tan(double radians)
{
    if (!isfinite(radians))
        return NAN;
    if (fabs(radians) < 0x1p-27)
        return radians;
    unsigned quadrant;
    sum2 r = reduce_angle(radians, &quadrant);
    sum2 s = sine_series(r), c = cosine_series(r);
    if (quadrant & 1) {
        sum2 swap = s;
        s = c;
        c = (sum2) { -swap.high, -swap.low };
    }
    double q = s.high / c.high;
    sum2 product = two_prod(q, c.high);
    double rest = ((s.high - product.high) - product.low) + (s.low - q * c.low);
    return q + rest / c.high;
}

double glint_tan_half(double angle_rad) { return angle_rad == HALF_PI_HIGH ? 1.0 : glint_tan(0.5 * angle_rad); }

// ---- Exponential and logarithm ------------------------------------------------------------------------------------

/// Returns e^x, rounded; |x| <= about 800. x = k ln2/64 + r, |r| <= 0.0055; 2^(k/64) from the table, e^r by its
/// series.
static double exp_of_sum(sum2 x)
{
    double k = floor(x.high * 0x1.71547652b82fep+6 + 0.5);
    sum2 r = two_sum(x.high, -k * 0x1.62e42fefap-7); // the products are exact: 17 bits by 36
    r = add2(r, two_sum(-k * 0x1.cf79abc9ep-46, x.low));
    r.low -= k * 0x1.d9cc01f97b57ap-85;
    double f = r.high, p = 1.0 / 40320;
    p = p * f + 1.0 / 5040;
    p = p * f + 1.0 / 720;
    p = p * f + 1.0 / 120;
    p = p * f + 1.0 / 24;
    p = p * f + 1.0 / 6;
    sum2 square = mul2(r, r);
    sum2 series = add2(r, (sum2) { 0.5 * square.high, 0.5 * square.low });
    series = add2(series, (sum2) { square.high * f * p, 0 });
    int n = (int)k, j = n & 63, e = (n - j) / 64;
    sum2 base = { exp2_table[j][0], exp2_table[j][1] };
    sum2 y = add2(base, mul2(base, series));
    if (e > 1023)
        return times_power(times_power(y.high, 1023), e - 1023);
    if (e < -1022)
        return times_power(times_power(y.high, e + 200), -200);
    return times_power(y.high, e);
}

/// Returns log x as a sum, relative error below 2^-74; x finite, > 0. x = 2^e m; c is near 1/m, from the table; m
/// c = 1 + f.
static sum2 log_to_sum(double x)
{
    int e = 0;
    if (x < 0x1p-1022) {
        x *= 0x1p54;
        e = -54;
    }
    uint64_t bits = bits_of(x);
    e += (int)(bits >> 52) - 1023;
    unsigned j = bits >> 45 & 127;
    bits = (bits & 0xfffffffffffff) | 0x3ff0000000000000;
    double m;
    memcpy(&m, &bits, sizeof m);
    if (j >= 53) {
        m *= 0.5;
        e++;
    }
    sum2 f = two_prod(m, log_table[j][0]);
    f = fast_two_sum(f.high - 1, f.low);
    double h = f.high, p = 1.0 / 11;
    p = p * h - 1.0 / 10;
    p = p * h + 1.0 / 9;
    p = p * h - 1.0 / 8;
    p = p * h + 1.0 / 7;
    p = p * h - 1.0 / 6;
    p = p * h + 1.0 / 5;
    p = p * h - 1.0 / 4;
    sum2 square = mul2(f, f), cube = mul2(square, f);
    sum2 y = mul2(cube, (sum2) { 0x1.5555555555555p-2, 0x1.5555555555555p-56 });
    y = add2(y, (sum2) { square.high * square.high * p, 0 });
    y = add2((sum2) { -0.5 * square.high, -0.5 * square.low }, y);
    y = add2(f, y);
    y = add2((sum2) { log_table[j][1], log_table[j][2] }, y);
    sum2 powers = two_sum(e * 0x1.62e42fefa4p-1, e * -0x1.8432a1b0e2p-43); // exact: 11 bits by 41
    powers.low -= e * 0x1.8cff81a12a17ep-85;
    return add2(powers, y);
}

double glint_exp(double x)
{
    if (isnan(x))
        return x;
    if (x > 710)
        return INFINITY;
    if (x < -746)
        return 0;
    if (fabs(x) < 0x1p-54)
        return 1;
    return exp_of_sum((sum2) { x, 0 });
}

double glint_log(double x)
{
    if (isnan(x))
        return x;
    if (x == 0)
        return -INFINITY;
    if (x < 0)
        return NAN;
    if (isinf(x))
        return x;
    return log_to_sum(x).high;
}

// ---- Power --------------------------------------------------------------------------------------------------------

/// Returns 0: y is not an integer; 1: odd; 2: even.
static int integer_kind(double y)
{
    double size = fabs(y);
    if (size >= 0x1p53)
        return 2;
    if (size != floor(size))
        return 0;
    return (uint64_t)size & 1 ? 1 : 2;
}

/// Returns x^y if x is 0 or if x or y is infinite. Neither is NaN, x is not 1 and y is not 0.
static double power_of_special(double x, double y)
{
    if (isinf(y)) {
        double size = fabs(x);
        if (size == 1)
            return 1;
        return (size > 1) == (y > 0) ? INFINITY : 0;
    }
    bool big = isinf(x) != 0;
    double size = big == (y > 0) ? INFINITY : 0;
    return signbit(x) && integer_kind(y) == 1 ? -size : size;
}

double glint_pow(double x, double y)
{
    if (x == 1 || y == 0)
        return 1;
    if (isnan(x) || isnan(y))
        return NAN;
    if (x == 0 || isinf(x) || isinf(y))
        return power_of_special(x, y);
    int kind = integer_kind(y);
    if (x < 0 && kind == 0)
        return NAN;
    double sign = x < 0 && kind == 1 ? -1 : 1;
    if (fabs(x) == 1)
        return sign;
    sum2 logarithm = log_to_sum(fabs(x));
    double estimate = y * logarithm.high;
    if (estimate > 710)
        return sign * INFINITY;
    if (estimate < -746)
        return sign * 0.0;
    if (fabs(estimate) < 0x1p-60)
        return sign;
    return sign * exp_of_sum(mul2(logarithm, (sum2) { y, 0 }));
}
