//@ args: --machine parts/spindle.toml
//@ prints: fast
#include "KMotionDef.h"

main()
{
    ConfigureSpindle(1, 3, 0.1, 0.05, 4096);
    DAC(0, 2000);
    while (Spindle.TrueSpeedRPS < 10) WaitNextTimeSlice();
    DAC(0, 0);
    printf("fast\n");
}
