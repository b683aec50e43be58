//@ args: --for 0.5
//@ says: at the end, after 0.500 s of board time:
//@ says:   axis 0: enabled, Dest 48.806, Position 0, moves at 100 units/s
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Jog(0, 100);
}
