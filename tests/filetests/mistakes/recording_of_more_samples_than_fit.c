//@ says: thread 1 at recording_of_more_samples_than_fit.c:6:5 in `main`: SetupGatherAllOnAxis: 200000 samples of 6 values do not fit in the gather buffer: it has room for 166666
#include "KMotionDef.h"

main()
{
    SetupGatherAllOnAxis(0, 200000);
    TriggerGather();
}
