// The quotient of singles, correctly rounded; the same way as that of doubles.

//@ __cc67_divf
float _divf(float a, float b);

float __cc67_divf(float a, float b)
{
    unsigned word_a = *(unsigned *)&a, word_b = *(unsigned *)&b, bits_a, bits_b, quotient, result;
    unsigned sign = (word_a ^ word_b) & 0x80000000u;
    int exponent_a = word_a >> 23 & 0xFF, exponent_b = word_b >> 23 & 0xFF, exponent, up, rest, divisor;
    float estimate;

    if (exponent_a == 0 || exponent_a == 0xFF || exponent_b == 0 || exponent_b == 0xFF) {
        if (a != a || b != b) return a + b;
        if (exponent_a == 0xFF ? exponent_b == 0xFF : exponent_a == 0 && exponent_b == 0) {
            result = 0x7FC00000;
        } else if (exponent_a == 0xFF || exponent_b == 0) {
            result = sign | 0x7F800000;
        } else {
            result = sign;
        }
        return *(float *)&result;
    }
    bits_a = word_a & 0x7FFFFF | 0x800000;
    bits_b = word_b & 0x7FFFFF | 0x800000;
    *(unsigned *)&a = word_a & 0x7FFFFF | 0x3F800000;
    *(unsigned *)&b = word_b & 0x7FFFFF | 0x3F800000;
    estimate = _divf(a, b);
    up = bits_a < bits_b;
    exponent = exponent_a - exponent_b + 127 - up;
    quotient = *(unsigned *)&estimate & 0x7FFFFF | 0x800000;
    switch ((int)(*(unsigned *)&estimate >> 23) - 127 + up) {
    case 1: quotient = quotient << 1; break;
    case -1: quotient = quotient >> 1; break;
    }
    if (up) bits_a = bits_a << 1;
    divisor = bits_b;
    rest = (bits_a << 23) - quotient * bits_b;
    while (rest < 0) {
        rest = rest + divisor;
        quotient = quotient - 1;
    }
    while (rest >= divisor) {
        rest = rest - divisor;
        quotient = quotient + 1;
    }
    if (rest + rest > divisor) quotient = quotient + 1;
    if (exponent <= 0 && !(exponent == 0 && quotient >= 0xFFFFFF)) {
        result = 0;
    } else if (exponent >= 0xFF) {
        result = 0x7F800000;
    } else {
        if (exponent == 0) quotient = 0x1000000;
        result = (exponent - 1 << 23) + quotient;
    }
    result = result | sign;
    return *(float *)&result;
}
