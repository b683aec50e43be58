//@ args: --machine parts/ends.toml
//@ says: thread 1 at limit_switches_swapped.c:18:5 in `main`: Move: LimitSwitchNegBit of axis 0 is 137, a switch that is active at ≥ 3000, at the other end
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
    ch0->LimitSwitchOptions = 0x103;
    ch0->LimitSwitchNegBit = 137;
    ch0->LimitSwitchPosBit = 136;
    EnableAxis(0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
