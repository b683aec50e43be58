// `ll` takes a whole long long; one `l` prints what the board prints: 40 bits of two words.
//@ args: -Wno-format
//@ prints: -5000000000 18446744073709551615 ffffffffffffffff 7
//@ prints: [           -3] [000000000042]
//@ prints: -1 3 8589934593
#include "KMotionDef.h"

main()
{
    printf("%lld %llu %llx %d\n", -5000000000LL, ~0ULL, -1LL, 7);
    printf("[%13lld] [%012lld]\n", -3LL, 42LL);
    printf("%ld %d %ld\n", -1L, -1, 3, 0, 1L, 2);
}
