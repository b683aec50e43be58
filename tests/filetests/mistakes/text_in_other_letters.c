//@ args: --for 1 --stim parts/ready.stim
//@ exit: 5
//@ prints: ready for start
//@ says: never happened: parts/ready.stim:1:1: once printed "Ready" (a line contains "ready")
//@ says: parts/ready.stim:2:1: at 1.00008 s no line contains "READY", expected one (one contains "ready")
//@ says: thread 1 at text_in_other_letters.c:12:27 in `main` has waited since 0.000 s for bit 140 (now 0)
#include "KMotionDef.h"

main()
{
    printf("ready for start\n");
    while (!ReadBit(140)) WaitNextTimeSlice();
}
