//@ args: --machine parts/disables.toml
//@ prints: zeroed
//@ says: thread 1 at axis_disabled_while_it_is_waited_for.c:15:13 in `main`: CheckDone(0) is -1: axis 0 was disabled before its motion ended, which `while (!CheckDone(0))` takes for its end
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 20000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Zero(0);
    printf("zeroed\n");
}
