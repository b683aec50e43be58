//@ prints: 5000
#include "KMotionDef.h"

main()
{
    int i;
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    for (i = 0; i < 1000; i++)
    {
        WaitNextTimeSlice();
        ch0->Dest += 5;
    }
    printf("%g\n", ch0->Dest);
}
