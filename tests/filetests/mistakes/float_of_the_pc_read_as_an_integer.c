//@ args: --set persist.10=f:1.5
//@ prints: P is 1069547520
//@ says: thread 1 at float_of_the_pc_read_as_an_integer.c:9:5 in `main`: printf: 1069547520 is the bits of the float 1.5, which is in persist.UserData[10]: read it as *(float *)&persist.UserData[10]
#include "KMotionDef.h"

main()
{
    int p = persist.UserData[10];
    printf("P is %d\n", p);
}
