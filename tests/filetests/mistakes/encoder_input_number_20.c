//@ says: thread 1 at encoder_input_number_20.c:13:5 in `main`: EnableAxis: axis 0 has InputChan0 = 20: encoder inputs are numbered 0 to 7, and 8 to 15 on SnapAmps
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->P = 1;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->InputChan0 = 20;
    EnableAxis(0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
