//@ args: --stim parts/not_in_order.stim --for 3
//@ prints: open
//@ says: not_in_order.stim:3:1: bit 136 was 1 already (times count from power-up: this moment is before that of line 2): this action changes nothing
#include "KMotionDef.h"

main()
{
    while (!ReadBit(136)) WaitNextTimeSlice();
    while (ReadBit(136)) WaitNextTimeSlice();
    printf("open\n");
    while (!ReadBit(136)) WaitNextTimeSlice();
}
