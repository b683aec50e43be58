//@ args: --stim parts/door.stim
//@ prints: open
//@ prints: closed
#include "KMotionDef.h"

main()
{
    while (ReadBit(136)) WaitNextTimeSlice();
    printf("open\n");
    while (!ReadBit(136)) WaitNextTimeSlice();
    printf("closed\n");
}
