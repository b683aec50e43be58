//@ args: --machine ../mistakes/parts/home.toml
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    MoveAtVel(0, -3200.1, 500);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Jog(0, 500);
    while (ReadBit(12)) WaitNextTimeSlice();
    Jog(0, 0);
}
