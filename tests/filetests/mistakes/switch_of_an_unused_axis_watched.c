//@ args: --machine parts/other_home.toml
//@ says: thread 1 at switch_of_an_unused_axis_watched.c:15:5 in `main`: Jog(0, 0): the thread has watched bit 136 on the way, but that is a switch of axis 1, which rests: watch the switch of axis 0
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Jog(0, -3000);
    while (!ReadBit(136)) WaitNextTimeSlice();
    Jog(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Zero(0);
}
