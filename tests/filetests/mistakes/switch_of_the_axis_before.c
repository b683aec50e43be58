//@ args: --machine parts/two_homes.toml
//@ says: thread 1 at switch_of_the_axis_before.c:27:5 in `main`: Jog(1, 0): the thread has watched bit 136 on the way, but that is a switch of axis 0, which rests: watch the switch of axis 1
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
    ch1->OutputChan0 = 1;
    ch1->Vel = 10000;
    ch1->Accel = 100000;
    ch1->Jerk = 1e6;
    EnableAxisDest(0, 0);
    EnableAxisDest(1, 0);
    Jog(0, -2000);
    while (!ReadBit(136)) ;
    Jog(0, 0);
    while (!CheckDone(0)) ;
    Zero(0);
    Jog(1, -2000);
    while (!ReadBit(136)) ;
    Jog(1, 0);
    while (!CheckDone(1)) ;
    Zero(1);
}
