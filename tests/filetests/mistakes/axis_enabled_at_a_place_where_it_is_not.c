//@ args: --machine parts/pushed.toml
//@ says: thread 1 at axis_enabled_at_a_place_where_it_is_not.c:17:5 in `main`: EnableAxisDest: axis 0 is at 3000 and is enabled at 0, so its motor leaps there: EnableAxis(0) begins where the axis is
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->OutputChan0 = 0;
    ch0->P = 0.3;
    ch0->MaxOutput = 2047;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->MaxFollowingError = 1e9;
    Delay_sec(0.2);
    EnableAxisDest(0, 0);
    Delay_sec(0.5);
}
