//@ says: thread 1 at move_with_speed_0.c:12:5 in `main`: MoveAtVel: the speed 0 of axis 0 is not positive, so it does not move; the target decides the direction
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    MoveAtVel(0, 1000, 0);
}
