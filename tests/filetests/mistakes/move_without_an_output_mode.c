//@ says: thread 1 at move_without_an_output_mode.c:8:5 in `main`: Move: axis 0 has no OutputMode, so its Dest changes but no motor moves (should an init program run first?)
#include "KMotionDef.h"

main()
{
    ch1->OutputMode = STEP_DIR_MODE;
    EnableAxis(0);
    Move(0, 100);
    while (!CheckDone(0)) ;
}
