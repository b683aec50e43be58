//@ args: check
//@ says: warning[parameter-copy]: `swap` has no effect: it changes only its own copies of `a` and `b`
//@ says: swap_of_copies.c:6:6
#include "KMotionDef.h"

void swap(int a, int b)
{
    int t = a;
    a = b;
    b = t;
}

main()
{
    int x = 1, y = 2;
    swap(x, y);
    printf("%d %d\n", x, y);
}
