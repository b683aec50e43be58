//@ args: --machine ../mistakes/parts/index.toml
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Jog(0, 2000);
    while (!ReadBit(36)) ;
    Jog(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
