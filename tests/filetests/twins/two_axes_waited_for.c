//@ prints: back
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch1->InputMode = NO_INPUT_MODE;
    ch1->OutputMode = STEP_DIR_MODE;
    ch1->OutputChan0 = 1;
    ch1->Vel = 10000;
    ch1->Accel = 100000;
    ch1->Jerk = 1e6;
    EnableAxisDest(0, 0);
    EnableAxisDest(1, 0);
    Move(0, 1000);
    Move(1, 3000);
    while (!CheckDone(0)) ;
    while (!CheckDone(1)) ;
    Move(1, 0);
    while (!CheckDone(1)) ;
    printf("back\n");
}
