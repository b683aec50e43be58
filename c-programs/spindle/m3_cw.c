// cc67: run --for 5 --set persist.99=f:1200
//
// m3_cw.c - M3: the spindle on, clockwise.
//
//   cc67 run --for 5 c-programs/spindle/m3_cw.c --set persist.99=f:1200
//
// The speed was set by an S word before. The program starts the jog and ends: the axis
// keeps turning by itself. Here it stays for a while to show the speed.
//
// Expect 1200 turns per minute, and the state that the next program finds.

#include "spindle_jog.c"

main()
{
    RunSpindle(CW);
    WaitForRamp();
    printf("%.0f rpm, state %d\n", MeasuredRpm(), persist.UserData[STATE_VAR]);
}
