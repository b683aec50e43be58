//@ prints: Pos Limit Disabled Axis:0
//@ says: thread 1 at limit_switch_with_the_wrong_polarity_after_enabling.c:17:5 in `main`: Move: LimitSwitchNegBit of axis 0 is 136, which is 0 and so counts as active, but nothing presses the switch: change bit 2 of LimitSwitchOptions
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 2e6;
    ch0->LimitSwitchOptions = 0;
    EnableAxisDest(0, 0);
    ch0->LimitSwitchOptions = 0x11f;    // both on one input, which is 1 while nothing presses them
    ch0->LimitSwitchNegBit = 136;
    ch0->LimitSwitchPosBit = 136;
    Move(0, 3000);
    while (!CheckDone(0)) ;
}
