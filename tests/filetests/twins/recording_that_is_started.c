//@ prints: recorded
#include "KMotionDef.h"

main()
{
    SetupGatherAllOnAxis(0, 100);
    TriggerGather();
    while (!CheckDoneGather()) WaitNextTimeSlice();
    printf("recorded\n");
}
