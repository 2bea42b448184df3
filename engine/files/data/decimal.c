/// Exact conversion of decimal text to double.
///
/// Up to 19 digits with an exponent of -19 .. 19 are converted with 128-bit integers: the quotient or product is exact,
/// and it is rounded once. Longer texts are converted twice, rounded down and up, which nearly always gives one double.
/// The rest goes to strtod in the locale "C".
#include "engine/files/data/decimal.h"

#include "engine/base/number.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define DIGITS_MAX 19 ///< decimal digits that always fit 64 bits
#define EXPONENT_MAX 99999 ///< larger exponents give 0 or infinity for any text that fits a line
#define TEXT_MAX 800 ///< characters that are passed to strtod

typedef struct decimal {
    uint64_t digits; ///< the first DIGITS_MAX digits
    long exponent; ///< of ten
    bool negative;
    bool cut; ///< digits other than 0 were cut off
} decimal;

static const char *read_exponent(const char *at, const char *end, long *exponent)
{
    long value = 0;
    const bool negative = at < end && *at == '-';
    if (at < end && (*at == '-' || *at == '+'))
        at++;
    if (at == end)
        return NULL;
    for (; at < end; at++) {
        if (*at < '0' || *at > '9')
            return NULL;
        value = value < EXPONENT_MAX ? 10 * value + (*at - '0') : value;
    }
    *exponent += negative ? -value : value;
    return at;
}

/// Reads more than DIGITS_MAX digits before the exponent.
static void read_many(const char *at, const char *end, decimal *d)
{
    int count = 0;
    bool has_point = false;
    d->digits = 0;
    for (; at < end; at++) {
        const unsigned digit = (unsigned)(*at - '0');
        if (digit > 9) {
            has_point = true;
            continue;
        }
        d->exponent -= has_point;
        if (count < DIGITS_MAX) {
            d->digits = 10 * d->digits + digit;
            count += d->digits != 0;
        } else {
            d->cut = d->cut || digit != 0;
            d->exponent++;
        }
    }
}

/// Reads the digits before the exponent. Returns the position after them; NULL: there are none.
static const char *read_digits(const char *at, const char *end, decimal *d)
{
    const char *const first = at, *point = NULL;
    for (; at < end; at++) {
        const unsigned digit = (unsigned)(*at - '0');
        if (digit <= 9)
            d->digits = 10 * d->digits + digit;
        else if (*at == '.' && !point)
            point = at;
        else
            break;
    }
    const ptrdiff_t count = at - first - (point != NULL);
    if (count > DIGITS_MAX)
        read_many(first, at, d);
    else if (point)
        d->exponent = -(long)(at - point - 1);
    return count > 0 ? at : NULL;
}

/// Reads the whole text. Fortran's exponents may begin with D or d, or with their sign.
static bool read_decimal(const char *text, const char *end, decimal *d)
{
    const char *at = text;
    if (at < end && (*at == '-' || *at == '+'))
        d->negative = *at++ == '-';
    at = read_digits(at, end, d);
    if (!at || at == end)
        return at != NULL;
    if (*at == 'e' || *at == 'E' || *at == 'd' || *at == 'D')
        return read_exponent(at + 1, end, &d->exponent) != NULL;
    return (*at == '-' || *at == '+') && read_exponent(at, end, &d->exponent) != NULL;
}

#ifdef __SIZEOF_INT128__
__extension__ typedef unsigned __int128 wide;

// clang-format off: one line each for so many numbers would be long
static const uint64_t POWERS[DIGITS_MAX + 1] = {
    1u, 10u, 100u, 1000u, 10000u, 100000u, 1000000u, 10000000u, 100000000u, 1000000000u, 10000000000u, 100000000000u,
    1000000000000u, 10000000000000u, 100000000000000u, 1000000000000000u, 10000000000000000u, 100000000000000000u,
    1000000000000000000u, 10000000000000000000u,
};
// clang-format on

/// Rounds an integer > 0 to the nearest double, ties to even. inexact: a fraction follows the integer.
static double round_wide(wide value, bool inexact, int scale)
{
    const uint64_t high = (uint64_t)(value >> 64);
    const int length = high ? 128 - __builtin_clzll(high) : 64 - __builtin_clzll((uint64_t)value);
    const int shift = length - 54; // one bit more than a double has
    uint64_t top = shift > 0 ? (uint64_t)(value >> shift) : (uint64_t)value << -shift;
    const bool rest = inexact || (shift > 0 && (value & (((wide)1 << shift) - 1)) != 0);
    const bool up = (top & 1) && (rest || (top & 2));
    top = (top >> 1) + up;
    return ldexp((double)top, shift + 1 + scale);
}

static bool convert(uint64_t digits, long exponent, double *out)
{
    if (digits == 0) {
        *out = 0;
        return true;
    }
    if (exponent < -DIGITS_MAX || exponent > DIGITS_MAX)
        return false;
    if (digits < (uint64_t)1 << 53 && exponent <= 0) { // powers up to 10^19 are exact as double
        *out = (double)digits / (double)POWERS[-exponent];
        return true;
    }
    if (exponent >= 0) {
        *out = round_wide((wide)digits * POWERS[exponent], false, 0);
        return true;
    }
    const int shift = 64 + __builtin_clzll(digits);
    const wide numerator = (wide)digits << shift, quotient = numerator / POWERS[-exponent];
    *out = round_wide(quotient, quotient * POWERS[-exponent] != numerator, -shift);
    return true;
}
#else
static bool convert(uint64_t digits, long exponent, double *out)
{
    *out = (double)digits;
    return digits < (uint64_t)1 << 53 && exponent == 0;
}
#endif

static bool convert_slowly(const char *text, size_t length, double *out)
{
    char copy[TEXT_MAX + 2], *end;
    bool has_exponent = false;
    size_t count = 0;
    if (length > TEXT_MAX)
        return false;
    for (size_t i = 0; i < length; i++) {
        const char c = text[i];
        const bool is_letter = c == 'e' || c == 'E' || c == 'd' || c == 'D';
        if (!has_exponent && i > 0 && (is_letter || c == '-' || c == '+')) {
            has_exponent = true;
            copy[count++] = 'e';
            if (is_letter)
                continue;
        }
        copy[count++] = c;
    }
    copy[count] = '\0';
    *out = glint_read_double(copy, &end);
    return end == copy + count;
}

bool glint_read_decimal(const char *text, size_t length, double *out)
{
    decimal d = { 0 };
    double above;
    if (!read_decimal(text, text + length, &d))
        return false;
    if (!convert(d.digits, d.exponent, out) || (d.cut && (!convert(d.digits + 1, d.exponent, &above) || above != *out)))
        return convert_slowly(text, length, out);
    if (d.negative)
        *out = -*out;
    return true;
}
