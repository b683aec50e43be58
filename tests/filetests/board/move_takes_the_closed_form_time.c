// Scenario 3 of the specification's list: V 40000, A 200000, J 4e6, 100000 counts take 2.75 s.
//@ prints: -1
//@ prints: 2.75
//@ prints: 100000.0 1
//@ says: Move: axis 0 has no OutputMode, so its Dest changes but no motor moves
#include "KMotionDef.h"

main()
{
    double start;
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = NO_OUTPUT_MODE;
    ch0->Vel = 40000; ch0->Accel = 200000; ch0->Jerk = 4e6;
    printf("%d\n", CheckDone(0));
    EnableAxisDest(0, 0.0);
    start = Time_sec();
    Move(0, 100000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    printf("%.2f\n", Time_sec() - start);
    printf("%.1f %d\n", ch0->Dest, CheckDone(0));
}
//@ cycles: 2296906
