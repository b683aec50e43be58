//@ args: --machine ../mistakes/parts/limits.toml
//@ prints: at 1000
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 5000;
    ch0->Accel = 50000;
    ch0->Jerk = 5e5;
    ch0->LimitSwitchNegBit = 136;
    ch0->LimitSwitchPosBit = 137;
    ch0->LimitSwitchOptions = 0x103;
    EnableAxisDest(0, 0);
    Move(0, 1000);
    while (!CheckDone(0))
        WaitNextTimeSlice();
    printf("at %.0f\n", ch0->Dest);
}
