//@ prints: 2000 0
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    MoveRel(0, 1000);
    while (!CheckDone(0)) ;
    MoveRel(0, 1000);
    while (!CheckDone(0)) ;
    printf("%d ", (int)(ch0->Dest + 0.5));
    Move(0, 5000);
    while (ch0->Dest < 3000) ;
    Move(0, 0);
    while (!CheckDone(0)) ;
    printf("%d\n", (int)(ch0->Dest + 0.5));
    Jog(0, 1000);
    Delay_sec(0.5);
    Jog(0, 0);
    while (!CheckDone(0)) ;
    DisableAxis(0);
}
