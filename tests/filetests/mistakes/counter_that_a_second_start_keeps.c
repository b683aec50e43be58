//@ args: check
//@ says: warning[kept-counter]: nothing sets `state` back when the program starts again
//@ says: counter_that_a_second_start_keeps.c:10:12
#include "KMotionDef.h"

int state = 0;

main()
{
    while (state < 3)
    {
        Move(0, 1000 * state);
        while (!CheckDone(0)) WaitNextTimeSlice();
        state++;
    }
}
