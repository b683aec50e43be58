//@ prints: before
//@ exit: 3
//@ says: division by zero
#include "KMotionDef.h"

int zero;

main()
{
    printf("before\n");
    persist.UserData[0] = 5 / zero;
    printf("after\n");
}
//@ cycles: 1742
