// The quotient of doubles, correctly rounded.
//
// The firmware's quotient is one or two units of the last place off. It is taken for fractions between 1 and 2,
// where nothing can overflow, as an estimate; what remains, an exact integer of few bits, says how far to go.
// Denormal numbers count as zero, as they do in the processor.

//@ __cc67_divd
typedef unsigned long long u64;

double _divd(double a, double b);

double __cc67_divd(double a, double b)
{
    unsigned high_a = ((unsigned *)&a)[1], high_b = ((unsigned *)&b)[1];
    unsigned sign = (high_a ^ high_b) & 0x80000000u;
    int exponent_a = high_a >> 20 & 0x7FF, exponent_b = high_b >> 20 & 0x7FF, exponent, up;
    u64 bits_a, bits_b, quotient, result;
    long long rest, divisor;
    double estimate;

    if (exponent_a == 0 || exponent_a == 0x7FF || exponent_b == 0 || exponent_b == 0x7FF) {
        if (a != a || b != b) return a + b;
        if (exponent_a == 0x7FF ? exponent_b == 0x7FF : exponent_a == 0 && exponent_b == 0) {
            result = 0x7FF8000000000000ull;
        } else if (exponent_a == 0x7FF || exponent_b == 0) {
            result = (u64)(sign | 0x7FF00000u) << 32;
        } else {
            result = (u64)sign << 32;
        }
        return *(double *)&result;
    }
    ((unsigned *)&a)[1] = high_a & 0xFFFFF | 0x3FF00000;
    ((unsigned *)&b)[1] = high_b & 0xFFFFF | 0x3FF00000;
    bits_a = *(u64 *)&a & 0xFFFFFFFFFFFFFull | 0x10000000000000ull;
    bits_b = *(u64 *)&b & 0xFFFFFFFFFFFFFull | 0x10000000000000ull;
    estimate = _divd(a, b);
    // One more bit where the quotient is below 1.
    up = bits_a < bits_b;
    exponent = exponent_a - exponent_b + 1023 - up;
    quotient = *(u64 *)&estimate & 0xFFFFFFFFFFFFFull | 0x10000000000000ull;
    switch ((int)(((unsigned *)&estimate)[1] >> 20) - 1023 + up) {
    case 1: quotient = quotient << 1; break;
    case -1: quotient = quotient >> 1; break;
    }
    if (up) bits_a = bits_a << 1;
    divisor = bits_b;
    rest = (bits_a << 52) - quotient * bits_b;
    while (rest < 0) {
        rest = rest + divisor;
        quotient = quotient - 1;
    }
    while (rest >= divisor) {
        rest = rest - divisor;
        quotient = quotient + 1;
    }
    if (rest + rest > divisor) quotient = quotient + 1;
    if (exponent <= 0 && !(exponent == 0 && quotient >= 0x1FFFFFFFFFFFFFull)) {
        result = 0;
    } else if (exponent >= 0x7FF) {
        result = 0x7FF0000000000000ull;
    } else {
        // The leading bit of the quotient adds one to the exponent.
        if (exponent == 0) quotient = 0x20000000000000ull;
        result = ((u64)(unsigned)(exponent - 1 << 20) << 32) + quotient;
    }
    result = result | (u64)sign << 32;
    return *(double *)&result;
}
