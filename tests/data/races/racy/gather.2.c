#include "KMotionDef.h"

main()
{
    SetupGatherAllOnAxis(1, 100);  // <-
    TriggerGather();
    while (!CheckDoneGather())
        ;
}
