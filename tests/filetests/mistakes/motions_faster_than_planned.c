//@ says: thread 1 at motions_faster_than_planned.c:15:9 in `main`: MoveAtVel: axis 2 gets a new target within 1.8 ms, 50 times in a row. The board takes that long to plan a motion that replaces another, and the axis keeps its speed until then: no target ever takes effect. Call less often, or use MoveExp
#include "KMotionDef.h"

main()
{
    ch2->InputMode = NO_INPUT_MODE;
    ch2->OutputMode = STEP_DIR_MODE;
    ch2->Vel = 10000;
    ch2->Accel = 100000;
    ch2->Jerk = 1e6;
    int i;
    EnableAxisDest(2, 0);
    for (i = 0; i < 100; i++)
    {
        MoveAtVel(2, 1000, 5000);
        WaitNextTimeSlice();
    }
    DisableAxis(2);
}
