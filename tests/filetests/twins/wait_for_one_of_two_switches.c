//@ args: --machine parts/high.toml
//@ prints: one
#include "KMotionDef.h"

main()
{
    while (!ReadBit(136) && !ReadBit(137)) WaitNextTimeSlice();
    printf("one\n");
}
