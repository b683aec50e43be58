//@ args: --machine parts/droop.toml --stim parts/droop.stim
//@ prints: free 50
//@ prints: loaded 42
#include "KMotionDef.h"

main()
{
    ConfigureSpindle(1, 7, 0.1, 0.1, 4096);
    DAC(0, 2047);
    Delay_sec(0.9);
    printf("free %.0f\n", Spindle.TrueSpeedRPS);
    Delay_sec(1);
    printf("loaded %.0f\n", Spindle.TrueSpeedRPS);
}
