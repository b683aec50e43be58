// The quotient of singles, correctly rounded; the same way as that of doubles.
//
// Arguments and results are the words of the numbers, which are in the same registers.

//@ __cc67_divf
unsigned _divf(unsigned a, unsigned b);
unsigned __cc67_specialf(unsigned a, unsigned b);

unsigned __cc67_divf(unsigned a, unsigned b)
{
    int exponent, up, twice, size, divisor, steps;
    unsigned quotient, result;

    if ((a >> 23 & 0xFF) - 1 >= 0xFE | (b >> 23 & 0xFF) - 1 >= 0xFE) return __cc67_specialf(a, b);
    quotient = _divf(a & 0x7FFFFF | 0x3F800000, b & 0x7FFFFF | 0x3F800000);
    divisor = b & 0x7FFFFF | 0x800000;
    result = a & 0x7FFFFF | 0x800000;
    // One more bit where the quotient is below 1.
    up = (int)result < divisor;
    exponent = (int)(a >> 23 & 0xFF) - (int)(b >> 23 & 0xFF) + 127 - up;
    // An integer of 24 bits; an estimate beyond the right exponent becomes the one next to it, or nearly.
    quotient = quotient - (unsigned)(126 - up << 23);
    twice = (int)((result << 23 + up) - quotient * divisor) * 2;
    size = twice < 0 ? -twice : twice;
    steps = (size > divisor) + (size > 3 * divisor) + (size > 5 * divisor);
    if (twice < 0) steps = -steps;
    quotient += steps;
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
    unsigned sign = (a ^ b) & 0x80000000u, size_a = a << 1, size_b = b << 1, result = sign;
    int zero_a = size_a < 0x1000000u, zero_b = size_b < 0x1000000u;
    int infinite_a = size_a == 0xFF000000u, infinite_b = size_b == 0xFF000000u;
    if (size_a > 0xFF000000u || size_b > 0xFF000000u) return 0x7FFFFFFF;
    if (infinite_a || zero_b) result = sign | 0x7F800000;
    if (infinite_a && infinite_b || zero_a && zero_b) result = 0x7FC00000;
    if (infinite_b && !infinite_a) result = sign;
    return result;
}
