//@ prints: 6000 5784
//@ says: thread 1 at slave_moved_beside_its_master.c:31:5 in `main`: Move: axis 1 follows axis 0 (MasterAxis), but not while it executes a motion of its own: what axis 0 moves until then is lost to it; wait for the end of one motion before the other
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
    Move(0, 6000);
    WaitFor(0);
    WaitFor(1);
    printf("%.0f %.0f\n", ch0->Dest, ch1->Dest);
}
