//@ args: check
//@ says: warning[returned-local]: the address of `limits` is returned, which ends with the function
//@ says: pointer_to_a_local_returned.c:12:12
#include "KMotionDef.h"

int *Limits(int axis)
{
    int limits[2];
    int *p = limits;
    limits[0] = -axis;
    limits[1] = axis;
    return p;
}

main()
{
    printf("%d\n", Limits(3)[1]);
}
