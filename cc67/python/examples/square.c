#include "KMotionDef.h"
main()
{
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 1000; ch0->Accel = 5000; ch0->Jerk = 50000;
    EnableAxisDest(0, 0);
    Move(0, 2000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    printf("at %g after %.2f s\n", ch0->Dest, Time_sec());
}
