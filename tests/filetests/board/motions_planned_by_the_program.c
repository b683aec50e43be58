// Motions that a program plans by itself, and one that is dropped. A ramp with steps of acceleration takes
// L / V + V / A seconds: 1000 / 1000 + 1000 / 10000, and then it stands for a quarter of a second.
//@ says: StopMotion: 0x80000000 is not an axis structure
//@ prints: 6 states, 1000 after 1.35 s
//@ prints: stands at 500: 1
//@ prints: the integrator is 0
#include "KMotionDef.h"

main()
{
    double t, place;
    int n;

    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 1000;
    ch0->Accel = 10000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);

    SetupForMove(0, 1000, 1000, ch0, 0, TRUE, TRUE, FALSE, &n);
    SetupForMotionPause(1000, ch0, n, 0.25);
    SetupForMotionEnd(ch0, n + 1);
    t = WaitNextTimeSlice();
    StartMove(0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    printf("%d states, %.0f after %.2f s\n", n, ch0->Dest, Time_sec() - t);

    Zero(0);
    SetupForMove(0, 1000, 1000, ch0, 0, TRUE, TRUE, TRUE, 0);
    Delay_sec(0.55);
    StopMotion(ch0);
    place = ch0->Dest;
    Delay_sec(0.1);
    printf("stands at %.0f: %d\n", place, ch0->Dest == place);
    StopMotion((CHAN *)0x80000000);

    ch0->I = 1;
    ch0->integrator = 7;
    ResetFilters(0);
    printf("the integrator is %g\n", ch0->integrator);
    DisableAxis(0);
}
//@ cycles: 1157050
