//@ args: check
//@ says: warning[unused-value]: this statement has no effect
//@ says: comparison_without_effect.c:9:5
#include "KMotionDef.h"

main()
{
    int n = 0;
    n == 1;
    printf("%d\n", n);
}
