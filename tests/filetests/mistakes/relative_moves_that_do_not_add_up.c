//@ says: thread 1 at relative_moves_that_do_not_add_up.c:13:5 in `main`: MoveRel: axis 0 has only come to 0 on its way to 1000, and 1000 more from there is 1000: the distances do not add up. Wait with `while (!CheckDone(0));` in between
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    MoveRel(0, 1000);
    MoveRel(0, 1000);
    while (!CheckDone(0)) ;
}
