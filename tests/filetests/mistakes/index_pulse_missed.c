//@ args: --machine parts/index.toml --for 1
//@ says: thread 1 at index_pulse_missed.c:16:13 in `main`: ReadBit(36): an index pulse of axis 0 has passed between two reads: it is 2 units wide, and the axis moves 3.6 units from read to read
//@ says: at the end, after 1.000 s of board time:
//@ says:   axis 0: enabled, Dest 19913.577, Position 0, moves at 0.133 units/s
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Jog(0, 60000);
    while (!ReadBit(36)) ;
    Jog(0, 0);
}
