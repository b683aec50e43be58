//@ says: thread 1 at servo_without_an_input_mode.c:15:5 in `main`: Move: axis 0 has InputMode = 0, so its Position never changes (ENCODER_MODE is 1)
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->MaxOutput = 2000;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->P = 1;
    ch0->InputMode = NO_INPUT_MODE;
    EnableAxis(0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
