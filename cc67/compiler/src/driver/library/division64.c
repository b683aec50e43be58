// Quotients and remainders of 64 bits, which the processor does not have.

//@ __cc67_div64 __cc67_divu64 __cc67_rem64 __cc67_remu64
typedef unsigned long long u64;

// The quotient; the remainder goes to `rest`.
static u64 divide(u64 a, u64 b, u64 *rest)
{
    u64 quotient = 0, left = 0;
    int i, carry;
    if ((unsigned)(a >> 32) == 0 && (unsigned)(b >> 32) == 0) {
        *rest = (unsigned)a % (unsigned)b;
        return (unsigned)a / (unsigned)b;
    }
    for (i = 0; i < 64; i++) {
        carry = (int)(left >> 63);
        left = left << 1 | a >> 63;
        a = a << 1;
        quotient = quotient << 1;
        if (carry || left >= b) {
            left = left - b;
            quotient = quotient | 1;
        }
    }
    *rest = left;
    return quotient;
}

u64 __cc67_divu64(u64 a, u64 b)
{
    u64 rest;
    return divide(a, b, &rest);
}

u64 __cc67_remu64(u64 a, u64 b)
{
    u64 rest;
    divide(a, b, &rest);
    return rest;
}

long long __cc67_div64(long long a, long long b)
{
    u64 rest, quotient = divide(a < 0 ? -a : a, b < 0 ? -b : b, &rest);
    return (a < 0) != (b < 0) ? -quotient : quotient;
}

long long __cc67_rem64(long long a, long long b)
{
    u64 rest;
    divide(a < 0 ? -a : a, b < 0 ? -b : b, &rest);
    return a < 0 ? -rest : rest;
}
