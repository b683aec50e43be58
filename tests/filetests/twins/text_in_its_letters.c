//@ args: --stim parts/ready.stim
//@ prints: Ready
//@ prints: ready for start
#include "KMotionDef.h"

main()
{
    printf("Ready\n");
    printf("ready for start\n");
    while (!ReadBit(140)) WaitNextTimeSlice();
}
