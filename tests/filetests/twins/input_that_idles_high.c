//@ args: --set inputs.idle_high=[136]
//@ prints: free
#include "KMotionDef.h"

main()
{
    while (!ReadBit(136)) WaitNextTimeSlice();
    printf("free\n");
}
