// A narrow unsigned bit-field is computed as `int`, unless a cast says otherwise.
//@ prints: -5 1 0
//@ prints: 0 1
#include "KMotionDef.h"

struct { unsigned low : 5; unsigned rest : 27; } bits;

main()
{
    int n = -5;
    bits.low = 7;
    printf("%d %d %d\n", n % bits.low, n < bits.low, n < (unsigned)bits.low); //~ negative-comparison
    printf("%d %d\n", (unsigned)bits.low - 8 < 0, bits.low - 8 < 0);  //~ constant-comparison
}
//@ cycles: 11365
