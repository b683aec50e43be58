//@ says: thread 1 at coordinated_moves_without_a_wait.c:14:5 in `main`: MoveXYZABC: the move of axis 0 to 5000 is replaced by one to 0 before it starts: wait with `while (!CheckDone(0));` in between
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    DefineCoordSystem(0, -1, -1, -1);
    MoveXYZABC(5000, 0, 0, 0, 0, 0);
    MoveXYZABC(0, 0, 0, 0, 0, 0);
    while (!CheckDoneXYZABC()) ;
}
