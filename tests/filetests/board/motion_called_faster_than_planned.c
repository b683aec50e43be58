//@ says: axis 2 gets a new target within 1.8 ms, 50 times in a row
//@ prints: 1
#include "KMotionDef.h"

// A height control that corrects its axis in each slice; the board plans longer than that.
main()
{
    int i;

    ch2->OutputMode = STEP_DIR_MODE;
    ch2->InputMode = NO_INPUT_MODE;
    ch2->Vel = 20000;
    ch2->Accel = 200000;
    ch2->Jerk = 2e6;
    EnableAxisDest(2, 0);
    for (i = 0; i < 1000; i++) {
        MoveAtVel(2, 1000, 5000);
        WaitNextTimeSlice();
    }
    printf("%d\n", ch2->Dest < 1);
    DisableAxis(2);
}
//@ cycles: 5001102
