//@ says: thread 1 at brushless_motor_without_its_cycle.c:11:5 in `main`: Move: axis 0 has invDistPerCycle = 0, so its motor is not commutated and does not turn
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = BRUSHLESS_3PH_MODE;
    ch0->OutputChan0 = 8;
    ch0->invDistPerCycle = 0;
    EnableAxis(0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
