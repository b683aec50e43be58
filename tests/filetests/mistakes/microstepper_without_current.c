//@ says: thread 1 at microstepper_without_current.c:12:5 in `main`: Move: axis 0 has StepperAmplitude = 0, so the coils of its motor have no current
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = MICROSTEP_MODE;
    ch0->OutputChan0 = 8;
    ch0->OutputChan1 = 9;
    ch0->StepperAmplitude = 0;
    EnableAxisDest(0, 0);
    Move(0, 100);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
