// cc67: run --for 5 --set persist.113=f:7500 --set persist.98=1
//
// s_speed.c - the S word: another speed, at once if the spindle is on.
//
//   cc67 run --for 5 c-programs/spindle/s_speed.c --set persist.113=f:7500 --set persist.98=1
//
// The PC stores the number after S as a float and starts this program. Without a
// running spindle it only keeps the number for the next M3 or M4.
//
// Expect a remark on the limit, and a spindle at 6000 turns per minute.

#include "spindle_jog.c"

main()
{
    SetSpeed(*(float *)&persist.UserData[S_VAR]);
    if (persist.UserData[STATE_VAR] == OFF)
    {
        printf("kept for later: %.0f rpm\n", GetSpeed());
        return;
    }
    RunSpindle(persist.UserData[STATE_VAR]);
    WaitForRamp();
    printf("%.0f rpm\n", MeasuredRpm());
}
