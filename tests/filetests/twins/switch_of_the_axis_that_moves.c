//@ args: --machine ../mistakes/parts/two_homes.toml
//@ prints: homed
#include "KMotionDef.h"

main()
{
    double end = Time_sec() + 5;
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Jog(0, -1000);
    while (!ReadBit(136) && Time_sec() < end) ;
    Jog(0, 0);
    while (!CheckDone(0)) ;
    Zero(0);
    printf("homed\n");
}
