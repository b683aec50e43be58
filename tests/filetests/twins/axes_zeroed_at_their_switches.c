//@ args: --machine ../mistakes/parts/two_homes.toml
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch1->InputMode = NO_INPUT_MODE;
    ch1->OutputMode = STEP_DIR_MODE;
    ch1->Vel = 10000;
    ch1->Accel = 100000;
    ch1->Jerk = 1e6;
    Zero(2);
    EnableAxisDest(0, 0);
    EnableAxisDest(1, 0);
    Jog(0, -1000);
    while (!ReadBit(136)) WaitNextTimeSlice();
    Jog(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Zero(1);
    Zero(0);
}
