// Between floating-point numbers and integers, where the processor has no instruction.

//@ __cc67_fixdl __cc67_fixdul __cc67_fixdu __cc67_fltlf __cc67_fltulf
typedef unsigned long long u64;

u64 __cc67_shl64(u64 a, int count);
u64 __cc67_shru64(u64 a, int count);

// The whole part modulo 2 to the 64th.
static u64 whole(double a)
{
    u64 bits = *(u64 *)&a, fraction;
    int exponent = ((unsigned)(bits >> 52) & 0x7FF) - 1075;
    if (exponent < -52 || exponent > 63) return 0;
    fraction = bits & 0xFFFFFFFFFFFFFull | 0x10000000000000ull;
    fraction = exponent < 0 ? __cc67_shru64(fraction, -exponent) : __cc67_shl64(fraction, exponent);
    return a < 0 ? -fraction : fraction;
}

u64 __cc67_fixdul(double a)
{
    return whole(a);
}

unsigned __cc67_fixdu(double a)
{
    return (unsigned)whole(a);
}

long long __cc67_fixdl(double a)
{
    if (a != a || a >= 9223372036854775808.0) return 0x7FFFFFFFFFFFFFFFll;
    if (a < -9223372036854775808.0) return 0x8000000000000000ull;
    return whole(a);
}

// Numbers of more than 53 bits lose some first, but not whether there were any.
float __cc67_fltulf(u64 a)
{
    if (a >> 53 == 0) return (float)(double)a;
    return (float)((double)(a >> 11 | (u64)((a & 0x7FF) != 0)) * 2048.0);
}

float __cc67_fltlf(long long a)
{
    return a < 0 ? -__cc67_fltulf(-a) : __cc67_fltulf(a);
}
