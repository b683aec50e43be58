//@ prints: arrived
//@ says: thread 1 at no_output_mode_set_at_all.c:9:5 in `main`: Move: axis 0 has no OutputMode, so its Dest changes but no motor moves (should an init program run first?)
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    EnableAxisDest(0, 0);
    Move(0, 500);
    while (!CheckDone(0)) WaitNextTimeSlice();
    printf("arrived\n");
}
