//@ args: check
//@ says: warning[gather-early]: `gather_buffer` is read while the recording has just begun
//@ says: recording_read_at_once.c:10:20
#include "KMotionDef.h"

main()
{
    SetupGatherAllOnAxis(0, 1000);
    TriggerGather();
    printf("%f\n", gather_buffer[999 * 6]);
}
