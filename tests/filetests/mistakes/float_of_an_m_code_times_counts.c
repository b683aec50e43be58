//@ args: --set persist.0=f:1.5 --for 0.1
//@ says: MoveRel: 106954752000 is 100 times 1069547520, the bits of the float 1.5, which is in persist.UserData[0]
//@ says: float_of_an_m_code_times_counts.c:18:5
#include "KMotionDef.h"

main()
{
    // The PC stores the word P as a float.
    double mm = persist.UserData[0];

    ch2->InputMode = NO_INPUT_MODE;
    ch2->OutputMode = STEP_DIR_MODE;
    ch2->OutputChan0 = 2;
    ch2->Vel = 5000;
    ch2->Accel = 50000;
    ch2->Jerk = 500000;
    EnableAxisDest(2, 0);
    MoveRel(2, mm * 100);
    while (!CheckDone(2)) WaitNextTimeSlice();
}
