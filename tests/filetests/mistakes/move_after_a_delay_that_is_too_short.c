//@ says: thread 1 at move_after_a_delay_that_is_too_short.c:14:5 in `main` calls Move for axis 0, which is at 4000 on its way to 10000 (by thread 1 at move_after_a_delay_that_is_too_short.c:12:5 in `main`): it goes to 0 from here and never arrives at 10000. Wait for it with `while (!CheckDone(0));`
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 10000);
    Delay_sec(0.5);
    Move(0, 0);
    while (!CheckDone(0)) ;
}
