//@ prints: 500
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 1000);
    Delay_sec(1);
    Move(0, 0);
    while (!CheckDone(0)) ;
    Move(0, 5000);
    while (ch0->Dest < 2000) WaitNextTimeSlice();
    Move(0, 500);
    while (!CheckDone(0)) ;
    printf("%g\n", ch0->Dest);
}
