//@ args: check
//@ says: warning[uninitialized]: `sum` is read before it has a value
//@ says: sum_without_a_start.c:9:29
#include "KMotionDef.h"

main()
{
    int i, sum;
    for (i = 0; i < 3; i++) sum += i;
    printf("%d\n", sum);
}
