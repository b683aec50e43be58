#include "KMotionDef.h"

int count, total;

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = NO_OUTPUT_MODE;
    ch0->Vel = 1000;
    ch0->Accel = 5000;
    ch0->Jerk = 50000;
    EnableAxisDest(0, 0);
    for (count = 0; count < 5; count++)
    {
        total = total + count;
        WaitNextTimeSlice();
    }
    printf("total %d\n", total);
    Move(0, 100);
    while (!CheckDone(0))
        WaitNextTimeSlice();
    printf("at %.0f\n", ch0->Dest);
    *(int *)4 = total;
}
