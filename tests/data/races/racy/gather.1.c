// race-shared: the gather buffer
#include "KMotionDef.h"

main()
{
    SetupGatherAllOnAxis(0, 200);  // <-
    TriggerGather();               // <-
    while (!CheckDoneGather())
        ;
    persist.UserData[95] = ((int *)gather_buffer)[0];
}
