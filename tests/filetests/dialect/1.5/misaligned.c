//@ exit: 3
//@ says: which is not aligned
#include "KMotionDef.h"

main()
{
    int *p = (int *)((char *)gather_buffer + 2);
    *p = 5;
}
//@ cycles: 6
