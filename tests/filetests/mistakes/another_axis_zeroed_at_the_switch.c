//@ args: --machine parts/two_homes.toml
//@ says: thread 1 at another_axis_zeroed_at_the_switch.c:23:5 in `main`: Zero(1): the thread has moved axis 0 to its switch, but zeroes axis 1, which it never moves
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
    EnableAxisDest(0, 0);
    EnableAxisDest(1, 0);
    Jog(0, -1000);
    while (!ReadBit(136)) WaitNextTimeSlice();
    Jog(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Zero(1);
}
