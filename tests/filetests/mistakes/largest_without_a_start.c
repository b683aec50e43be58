//@ args: check
//@ says: warning[uninitialized]: `best` is read before it has a value
//@ says: largest_without_a_start.c:11:29
#include "KMotionDef.h"

main()
{
    int i, best;
    for (i = 0; i < 8; i++)
    {
        if (ADC(i) - 2048 > best) best = ADC(i) - 2048;
    }
    printf("%d\n", best);
}
