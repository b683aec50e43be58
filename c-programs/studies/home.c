// cc67: run
//
// home.c - homing of a step axis against a switch, for the study of its tolerances.
//
// The axis goes slowly towards the switch, backs off until it is free, and takes that place as 0.
// UserData[20] says afterwards that it is homed.
//
// Expect "homed" after some seconds.

#include "KMotionDef.h"

#define AXIS   0
#define SWITCH 136
#define FAST   200.0
#define SLOW   10.0

void WaitFor(int Level)
{
    while (ReadBit(SWITCH) != Level) WaitNextTimeSlice();
    Jog(AXIS, 0);
    while (!CheckDone(AXIS)) WaitNextTimeSlice();
}

main()
{
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = FAST;
    ch0->Accel = 4000;
    ch0->Jerk = 1e6;
    EnableAxisDest(AXIS, 0);

    Jog(AXIS, -FAST);
    WaitFor(1);
    Jog(AXIS, SLOW);
    WaitFor(0);
    DisableAxis(AXIS);
    Zero(AXIS);
    EnableAxisDest(AXIS, 0);
    persist.UserData[20] = 1;
    printf("homed after %.2f s\n", Time_sec());
}
