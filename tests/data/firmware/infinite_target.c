// A move to an infinite place goes on without an end.
#include "KMotionDef.h"

double Zero0;

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 1 / Zero0);
    Delay_sec(0.5);
    printf("%.0f %d %.0f\n", ch0->Dest / 100, CheckDone(0), ch0->last_vel);
    Jog(0, 0);
    while (!CheckDone(0)) ;
    MoveRelAtVel(0, -1 / Zero0, 2000);
    Delay_sec(0.5);
    printf("%d %.0f\n", CheckDone(0), ch0->last_vel);
    Jog(0, 0);
    while (!CheckDone(0)) ;
    Jog(0, 1 / Zero0);
    Delay_sec(0.5);
    printf("%d %.0f\n", CheckDone(0), ch0->last_vel / 1000);
    DisableAxis(0);
}
