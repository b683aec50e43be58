//@ prints: 6000 6120
#include "KMotionDef.h"

void Setup(int axis)
{
    chan[axis].InputMode = NO_INPUT_MODE;
    chan[axis].OutputMode = STEP_DIR_MODE;
    chan[axis].OutputChan0 = axis;
    chan[axis].Vel = 2000;
    chan[axis].Accel = 20000;
    chan[axis].Jerk = 2e5;
    EnableAxisDest(axis, 0);
}

void WaitFor(int axis)
{
    while (!CheckDone(axis))
        WaitNextTimeSlice();
}

main()
{
    Setup(0);
    Setup(1);
    ch1->MasterAxis = 0;
    ch1->SlaveGain = 1;
    Move(0, 3000);
    WaitFor(0);
    Move(1, 3120);
    WaitFor(1);
    Move(0, 6000);
    WaitFor(0);
    WaitFor(1);
    printf("%.0f %.0f\n", ch0->Dest, ch1->Dest);
}
