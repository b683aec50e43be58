// Ranges of a 64-bit switch beyond 32 and 63 bits, signed and unsigned.
//@ prints: 1 2 3 4 5 0
//@ prints: 1 2 3 4 5 0
#include "KMotionDef.h"

int large(unsigned long long n)
{
    switch (n) {
    case 5 ... 9: return 1;
    case 0x100000000ULL ... 0x1ffffffffULL: return 2;
    case 0x7fffffffffffffffULL ... 0x8000000000000000ULL: return 3;
    case 0x9000000000000000ULL: return 4;
    case 0xfffffffffffffff0ULL ... 0xffffffffffffffffULL: return 5;
    }
    return 0;
}

int near(long long n)
{
    switch (n) {
    case -0x7fffffffffffffffLL - 1 ... -0x100000000LL: return 1;
    case -4 ... -1: return 2;
    case 0: return 3;
    case 1 ... 3: return 4;
    case 0x100000000LL ... 0x7fffffffffffffffLL: return 5;
    }
    return 0;
}

main()
{
    printf("%d %d %d %d %d %d\n", large(7), large(0x123456789ULL), large(0x8000000000000000ULL),
           large(0x9000000000000000ULL), large(-1), large(0x9000000000000001ULL));
    printf("%d %d %d %d %d %d\n", near(-0x123456789LL), near(-1), near(0), near(3), near(0x123456789LL), near(-5));
}
//@ cycles: 25758
