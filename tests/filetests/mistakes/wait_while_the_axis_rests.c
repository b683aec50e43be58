//@ args: check
//@ says: warning[loop-condition]: this loop ends as soon as the axis moves
//@ says: wait_while_the_axis_rests.c:12:12
//@ says: 1 when the axis has arrived, 0 while it moves
//@ says: to wait until it has arrived, write `!` before `CheckDone`
#include "KMotionDef.h"

main()
{
    EnableAxis(0);
    Move(0, 1000);
    while (CheckDone(0)) ;
    printf("arrived\n");
}
