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
u64 __cc67_extremed(int exponent, u64 quotient, unsigned sign);

u64 __cc67_divd(u64 a, u64 b)
{
    unsigned high_a = (unsigned)(a >> 32), high_b = (unsigned)(b >> 32), fraction_a, fraction_b, high;
    int exponent, up, steps;
    u64 quotient, divisor, rest, size;

    if ((high_a >> 20 & 0x7FF) - 1 >= 0x7FE | (high_b >> 20 & 0x7FF) - 1 >= 0x7FE) return __cc67_speciald(a, b);
    quotient = _divd((u64)(high_a & 0xFFFFF | 0x3FF00000) << 32 | (unsigned)a,
                     (u64)(high_b & 0xFFFFF | 0x3FF00000) << 32 | (unsigned)b);
    fraction_a = high_a & 0xFFFFF;
    fraction_b = high_b & 0xFFFFF;
    // One more bit where the quotient is below 1.
    up = fraction_a < fraction_b | fraction_a == fraction_b & (unsigned)a < (unsigned)b;
    exponent = (int)(high_a >> 20 & 0x7FF) - (int)(high_b >> 20 & 0x7FF) + 1023 - up;
    divisor = (u64)(fraction_b | 0x100000) << 32 | (unsigned)b;
    // An integer of 53 bits; an estimate beyond the right exponent becomes the one next to it, or nearly.
    high = (unsigned)(quotient >> 32) - (unsigned)(1022 - up << 20);
    quotient = (u64)high << 32 | (unsigned)quotient;
    rest = ((u64)((unsigned)a << 20 + up) << 32) - quotient * divisor;
    size = rest;
    if ((int)(rest >> 32) < 0) size = -rest;
    size = size << 1;
    steps = (size > divisor) + (size > (divisor << 1) + divisor) + (size > (divisor << 2) + divisor);
    if ((int)(rest >> 32) < 0) steps = -steps;
    quotient += (long long)steps;
    if ((unsigned)(exponent - 1) >= 0x7FE) return __cc67_extremed(exponent, quotient, high_a ^ high_b);
    // The leading bit of the quotient adds one to the exponent.
    high = (unsigned)(quotient >> 32) + ((unsigned)(exponent - 1) << 20);
    return (u64)(high | (high_a ^ high_b) & 0x80000000u) << 32 | (unsigned)quotient;
}

//@ __cc67_extremed
typedef unsigned long long u64;

// A quotient whose exponent no number has; the first one may yet be rounded up to the least number.
u64 __cc67_extremed(int exponent, u64 quotient, unsigned sign)
{
    unsigned high = 0x7FF00000;
    if (exponent <= 0) high = exponent == 0 && quotient >= 0x1FFFFFFFFFFFFFull ? 0x100000 : 0;
    return (u64)(high | sign & 0x80000000u) << 32;
}

//@ __cc67_speciald
typedef unsigned long long u64;

// Where an operand is zero, infinite or no number.
u64 __cc67_speciald(u64 a, u64 b)
{
    unsigned high_a = (unsigned)(a >> 32) << 1, high_b = (unsigned)(b >> 32) << 1;
    unsigned sign = (unsigned)((a ^ b) >> 32) & 0x80000000u, high;
    int zero_a = high_a < 0x200000u, zero_b = high_b < 0x200000u;
    int infinite_a = high_a == 0xFFE00000u && (unsigned)a == 0;
    int infinite_b = high_b == 0xFFE00000u && (unsigned)b == 0;
    if (high_a >= 0xFFE00000u && !infinite_a || high_b >= 0xFFE00000u && !infinite_b) return 0x7FFFFFFFFFFFFFFFull;
    high = sign;
    if (infinite_a || zero_b) high = sign | 0x7FF00000;
    if (infinite_a && infinite_b || zero_a && zero_b) high = 0x7FF80000;
    if (infinite_b && !infinite_a) high = sign;
    return (u64)high << 32;
}
