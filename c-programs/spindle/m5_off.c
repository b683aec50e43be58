// cc67: run --set persist.99=f:3000
//
// m5_off.c - M5: the spindle off, and how long it takes.
//
//   cc67 run c-programs/spindle/m5_off.c --set persist.99=f:3000
//
// The G code must not continue before the spindle has stopped: the PC waits until this program
// has ended. It runs up first, because nobody has switched the spindle on here.
//
// Expect about one and a half seconds for 3000 turns per minute.

#include "spindle_jog.c"

main()
{
    double Start;

    RunSpindle(CW);
    WaitForRamp();
    printf("%.0f rpm\n", MeasuredRpm());

    Start = Time_sec();
    RunSpindle(OFF);
    WaitForAxis(SPINDLE_AXIS);
    printf("stopped after %.1f s, state %d\n", Time_sec() - Start, persist.UserData[STATE_VAR]);
    DisableAxis(SPINDLE_AXIS);
}
