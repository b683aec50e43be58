//@ says: thread 1 at output_beyond_the_range_of_a_dac.c:14:5 in `main`: Move: axis 0 can output up to 20000 (MaxOutput, OutputGain, OutputOffset), but an analog output ends at 2047 and wraps to the other side: lower MaxOutput
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->P = 1;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->MaxOutput = 20000;
    EnableAxis(0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
