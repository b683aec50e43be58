//@ says: thread 1 at filter_that_passes_nothing.c:14:5 in `main`: Move: axis 0 has iir[0] or iir[1].B0, B1 and B2 = 0, so its output stays 0 and its motor does not move
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->P = 1;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->iir[0].B0 = 0;
    EnableAxis(0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
