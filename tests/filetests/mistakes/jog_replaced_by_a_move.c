//@ says: thread 1 at jog_replaced_by_a_move.c:13:5 in `main`: Move: the jog of axis 0 at 5000 units/s is replaced by a move before it starts: wait in between, for a switch, a place or a time
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Jog(0, 5000);
    Move(0, 100);
    while (!CheckDone(0)) ;
}
