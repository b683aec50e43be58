//@ exit: 3
//@ says: thread 1 stopped at pointer_that_points_nowhere.c:8:5 in `main`: write of the unmapped address 0x00000000
#include "KMotionDef.h"

main()
{
    int *p = (int *)persist.UserData[8];
    *p = 1;
}
