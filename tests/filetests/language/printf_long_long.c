// `ll` takes a whole long long; one `l` prints what the board prints.
//@ prints: -5000000000 18446744073709551615 ffffffffffffffff 7
//@ prints: 4294967295 [           -3] [000000000042]
#include "KMotionDef.h"

main()
{
    printf("%lld %llu %llx %d\n", -5000000000LL, ~0ULL, -1LL, 7);
    printf("%ld [%13lld] [%012lld]\n", -1L, -3LL, 42LL);
}
