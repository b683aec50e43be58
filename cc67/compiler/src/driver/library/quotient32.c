// The quotient of singles, correctly rounded; the same way as that of doubles.
//
// Arguments and results are the words of the numbers, which are in the same registers.

//@ __cc67_divf
unsigned _divf(unsigned a, unsigned b);

unsigned __cc67_specialf(unsigned a, unsigned b);

unsigned __cc67_divf(unsigned a, unsigned b)
{
    int exponent_a = a >> 23 & 0xFF, exponent_b = b >> 23 & 0xFF, exponent, up, twice, divisor, own;
    unsigned estimate, quotient, result;

    if ((unsigned)(exponent_a - 1) >= 0xFE || (unsigned)(exponent_b - 1) >= 0xFE) return __cc67_specialf(a, b);
    estimate = _divf(a & 0x7FFFFF | 0x3F800000, b & 0x7FFFFF | 0x3F800000);
    divisor = b & 0x7FFFFF | 0x800000;
    result = a & 0x7FFFFF | 0x800000;
    up = (int)result < divisor;
    exponent = (int)(a >> 23 & 0xFF) - (int)(b >> 23 & 0xFF) + 127 - up;
    // One more bit where the quotient is below 1; an estimate beyond that is next to it.
    own = (int)(estimate >> 23) - 127 + up;
    quotient = estimate & 0x7FFFFF | 0x800000;
    if (own < 0) quotient = 0x800000;
    if (own > 0) quotient = 0xFFFFFF;
    twice = (int)((result << 23 + up) - quotient * divisor) * 2;
    quotient += (twice > divisor) + (twice > 3 * divisor) + (twice > 5 * divisor);
    quotient -= (twice < -divisor) + (twice < -3 * divisor) + (twice < -5 * divisor);
    // The leading bit of the quotient adds one to the exponent.
    result = ((unsigned)(exponent - 1) << 23) + quotient;
    if (exponent <= 0) result = exponent == 0 && quotient >= 0xFFFFFF ? 0x800000 : 0;
    if (exponent >= 0xFF) result = 0x7F800000;
    return result | (a ^ b) & 0x80000000u;
}

//@ __cc67_specialf
// Where an operand is zero, infinite or no number.
unsigned __cc67_specialf(unsigned a, unsigned b)
{
    unsigned sign = (a ^ b) & 0x80000000u, size_a = a << 1, size_b = b << 1;
    int zero_a = size_a < 0x1000000u, zero_b = size_b < 0x1000000u;
    if (size_a > 0xFF000000u || size_b > 0xFF000000u) return 0x7FFFFFFF;
    if (size_a == 0xFF000000u) return size_b == 0xFF000000u ? 0x7FC00000 : sign | 0x7F800000;
    if (size_b == 0xFF000000u) return sign;
    if (zero_b) return zero_a ? 0x7FC00000 : sign | 0x7F800000;
    return sign;
}
