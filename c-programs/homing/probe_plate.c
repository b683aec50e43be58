// cc67: part of probe.c
//
// probe_plate.c - plays a plate that the tool touches.

#include "KMotionDef.h"

#define Z         2
#define PLATE     -432.0    // position of the surface
#define PROBE_BIT 1024
#define END_BIT   1031

main()
{
    while (!ReadBit(END_BIT))
    {
        SetStateBit(PROBE_BIT, chan[Z].Dest <= PLATE);
        WaitNextTimeSlice();
    }
}
