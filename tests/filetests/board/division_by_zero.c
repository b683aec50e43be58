//@ exit: 3
//@ says: division_by_zero.c:10
//@ prints: before
#include "KMotionDef.h"

int zero;
main()
{
    printf("before\n");
    persist.UserData[0] = 5 / zero;
    printf("never\n");
}
//@ cycles: 1742
