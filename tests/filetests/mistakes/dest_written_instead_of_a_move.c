//@ says: thread 1 at dest_written_instead_of_a_move.c:13:5 in `main`: Dest of axis 0 is changed from 0 to 5000 at once, which no motor follows: use Move, which accelerates and decelerates (noticed at this call)
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    ch0->Dest = 5000;
    Delay_sec(0.1);
}
