//@ args: --machine parts/ends.toml
//@ says: thread 1 at switch_that_is_inverted.c:17:5 in `main`: Jog(0, 0): axis 0 has not moved since Jog(0, -1000): bit 136 was already as the program waited for: its switch is 1 at ≤ -3000 (ends.toml:5), and the axis is at 0 (is the switch inverted, or at the other end?)
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->MaxOutput = 2000;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->P = 5;
    EnableAxis(0);
    Jog(0, -1000);
    while (ReadBit(136)) WaitNextTimeSlice();
    Jog(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Zero(0);
}
