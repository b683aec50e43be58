// The quotient of doubles, correctly rounded.
//
// The firmware's quotient is some units of the last place off, three at the most. It is taken for fractions between 1
// and 2, where nothing can overflow, as an estimate; what remains, an exact integer of few bits, says how far to go.
// Denormal numbers count as zero, as they do in the processor. Arguments and results are the bits of the numbers,
// which are in the same registers.

//@ __cc67_divd
typedef unsigned long long u64;

u64 _divd(u64 a, u64 b);

u64 __cc67_speciald(u64 a, u64 b);

u64 __cc67_divd(u64 a, u64 b)
{
    unsigned high_a = (unsigned)(a >> 32), high_b = (unsigned)(b >> 32), fraction_a, fraction_b, high;
    int exponent, up, own, twice, unit, steps;
    u64 estimate, quotient, divisor;
    long long rest;

    if ((high_a >> 20 & 0x7FF) - 1 >= 0x7FE || (high_b >> 20 & 0x7FF) - 1 >= 0x7FE) return __cc67_speciald(a, b);
    estimate = _divd((u64)(high_a & 0xFFFFF | 0x3FF00000) << 32 | (unsigned)a,
                     (u64)(high_b & 0xFFFFF | 0x3FF00000) << 32 | (unsigned)b);
    fraction_a = high_a & 0xFFFFF;
    fraction_b = high_b & 0xFFFFF;
    up = fraction_a < fraction_b | fraction_a == fraction_b & (unsigned)a < (unsigned)b;
    exponent = (int)(high_a >> 20 & 0x7FF) - (int)(high_b >> 20 & 0x7FF) + 1023 - up;
    divisor = (u64)(fraction_b | 0x100000) << 32 | (unsigned)b;
    // One more bit where the quotient is below 1; an estimate beyond that is next to it.
    high = (unsigned)(estimate >> 32);
    own = (int)(high >> 20) - 1023 + up;
    quotient = (u64)(high & 0xFFFFF | 0x100000) << 32 | (unsigned)estimate;
    if (own < 0) quotient = 0x10000000000000ull;
    if (own > 0) quotient = 0x1FFFFFFFFFFFFFull;
    rest = ((u64)((unsigned)a << 20 + up) << 32) - quotient * divisor;
    // The whole divisors in the rest, to the nearest as far as upper bits tell; then exactly.
    twice = (int)(rest >> 25);
    unit = (int)(divisor >> 26);
    steps = (twice > unit) + (twice > 3 * unit) + (twice > 5 * unit);
    steps -= (twice < -unit) + (twice < -3 * unit) + (twice < -5 * unit);
    rest = (rest - (long long)steps * (long long)divisor) * 2;
    steps += (rest > (long long)divisor) - (rest < -(long long)divisor);
    quotient += (long long)steps;
    high = (unsigned)(quotient >> 32);
    // The leading bit of the quotient adds one to the exponent.
    if (exponent <= 0) {
        high = exponent == 0 && quotient >= 0x1FFFFFFFFFFFFFull ? 0x100000 : 0;
        quotient = 0;
    } else if (exponent >= 0x7FF) {
        high = 0x7FF00000;
        quotient = 0;
    } else {
        high += (unsigned)(exponent - 1) << 20;
    }
    high |= (high_a ^ high_b) & 0x80000000u;
    return (u64)high << 32 | (unsigned)quotient;
}

//@ __cc67_speciald
typedef unsigned long long u64;

// Where an operand is zero, infinite or no number.
u64 __cc67_speciald(u64 a, u64 b)
{
    u64 sign = (a ^ b) & 0x8000000000000000ull, size_a = a << 1, size_b = b << 1;
    unsigned high_a = (unsigned)(size_a >> 32), high_b = (unsigned)(size_b >> 32);
    int zero_a = high_a < 0x200000u, zero_b = high_b < 0x200000u;
    if (size_a > 0xFFE0000000000000ull || size_b > 0xFFE0000000000000ull) return 0x7FFFFFFFFFFFFFFFull;
    if (high_a == 0xFFE00000u) {
        return high_b == 0xFFE00000u ? 0x7FF8000000000000ull : sign | 0x7FF0000000000000ull;
    }
    if (high_b == 0xFFE00000u) return sign;
    if (zero_b) return zero_a ? 0x7FF8000000000000ull : sign | 0x7FF0000000000000ull;
    return sign;
}
