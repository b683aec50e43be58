//@ prints: recorded
//@ says: thread 1 at recording_that_nobody_starts.c:8:13 in `main`: CheckDoneGather is 1, because no recording was started after SetupGatherAllOnAxis: call TriggerGather()
#include "KMotionDef.h"

main()
{
    SetupGatherAllOnAxis(0, 100);
    while (!CheckDoneGather()) WaitNextTimeSlice();
    printf("recorded\n");
}
