// cc67: run --for 5 --set persist.99=f:900 --set persist.98=1
//
// m4_ccw.c - M4: the spindle on, counterclockwise, also out of a run in the other direction.
//
//   cc67 run --for 5 c-programs/spindle/m4_ccw.c --set persist.99=f:900 --set persist.98=1
//
// A jog to the opposite speed reverses along the ramp of the axis. A spindle that must
// not be reversed under power is stopped first, as here.
//
// Expect the stop, then 900 turns per minute backwards.

#include "spindle_jog.c"

main()
{
    if (persist.UserData[STATE_VAR] == CW)
    {
        RunSpindle(OFF);
        WaitForAxis(SPINDLE_AXIS);
        printf("stopped before reversing\n");
    }
    RunSpindle(CCW);
    WaitForRamp();
    printf("%.0f rpm, state %d\n", MeasuredRpm(), persist.UserData[STATE_VAR]);
}
