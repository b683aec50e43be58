// cc67: run
//
// first.c - moves axis 0 to a position and back, and says how long it took.

#include "KMotionDef.h"

#define AXIS 0

void MoveAndReport(double position)
{
    double start = Time_sec();

    Move(AXIS, position);
    while (!CheckDone(AXIS))
        WaitNextTimeSlice();
    printf("at %g after %.2f s\n", chan[AXIS].Dest, Time_sec() - start);
}

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;   // step generator 0: pulses on bit 8, direction on bit 9
    ch0->Vel = 1000;        // units a second
    ch0->Accel = 5000;      // units a second squared
    ch0->Jerk = 50000;      // units a second cubed
    EnableAxisDest(AXIS, 0);

    MoveAndReport(2000);
    MoveAndReport(0);

    DisableAxis(AXIS);
}
