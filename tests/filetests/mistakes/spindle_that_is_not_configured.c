//@ args: --for 1 --machine parts/relay_spindle.toml
//@ says: thread 1 at spindle_that_is_not_configured.c:9:
//@ says: `Spindle.TrueSpeedRPS` (now 0 turns a second), which stays so until a program calls ConfigureSpindle, in `Spindle.TrueSpeedRPS < 20`
#include "KMotionDef.h"

main()
{
    SetBit(154);
    while (Spindle.TrueSpeedRPS < 20) WaitNextTimeSlice();
}
