// An axis that was disabled on its way is enabled where it is, or homed again; a relative move needs no zero.
#include "KMotionDef.h"

void Stop(void)
{
    while (!CheckDone(0) && ch0->Dest < 10000) WaitNextTimeSlice();
    DisableAxis(0);
}

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 30000);
    Stop();
    EnableAxisDest(0, ch0->Dest);
    Move(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Move(0, 30000);
    Stop();
    EnableAxisDest(0, 0);
    Jog(0, -1000);
    Delay_sec(0.5);
    Jog(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Zero(0);
    Move(0, 500);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Move(0, 30000);
    Stop();
    EnableAxisDest(0, 0);
    MoveRel(0, 500);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
