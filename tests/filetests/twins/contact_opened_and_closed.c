//@ args: --set inputs.idle_high=[140] --machine parts/home_switch.toml -R no-switch-overridden --stim parts/contacts.stim
//@ prints: stopped
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 20000);
    while (CheckDone(0) == 0)
    {
        if (!ReadBit(140)) DisableAxis(0);
        if (ReadBit(141) || ADC(0) > 500) printf("door\n");
        WaitNextTimeSlice();
    }
    printf("stopped\n");
    while (ReadBit(136)) WaitNextTimeSlice();
    Delay_sec(1);
}
