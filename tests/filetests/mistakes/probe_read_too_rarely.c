//@ args: --machine parts/plate.toml
//@ says: thread 1 at probe_read_too_rarely.c:14:13 in `main`: ReadBit(137): axis 2 has moved 1001 units in the 100 ms since the read before, and its switch has changed in between: read more often, or move more slowly
#include "KMotionDef.h"

main()
{
    ch2->InputMode = NO_INPUT_MODE;
    ch2->OutputMode = STEP_DIR_MODE;
    ch2->Vel = 10000;
    ch2->Accel = 100000;
    ch2->Jerk = 1e6;
    EnableAxisDest(2, 0);
    Jog(2, -10000);
    while (!ReadBit(137)) Delay_sec(0.1);
    Jog(2, 0);
    while (!CheckDone(2)) WaitNextTimeSlice();
}
