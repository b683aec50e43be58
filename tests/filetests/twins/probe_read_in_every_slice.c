//@ args: --machine ../mistakes/parts/plate.toml
#include "KMotionDef.h"

main()
{
    ch2->InputMode = NO_INPUT_MODE;
    ch2->OutputMode = STEP_DIR_MODE;
    ch2->Vel = 10000;
    ch2->Accel = 100000;
    ch2->Jerk = 1e6;
    EnableAxisDest(2, 0);
    Jog(2, -10000);
    while (!ReadBit(137)) WaitNextTimeSlice();
    Jog(2, 0);
    while (!CheckDone(2)) WaitNextTimeSlice();
}
