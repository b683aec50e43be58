// cc67: run
//
// one_axis.c - the moves of one axis, and how long they take.
//
//   cc67 run c-programs/motion/one_axis.c
//
// A move is limited in speed, acceleration and jerk. A short one reaches neither
// its speed nor its acceleration, so a tenth of the way takes more than a tenth of
// the time.
//
// Expect 2.75 s for the long move, 0.19 s for the short one, and exact positions.

#include "KMotionDef.h"
#include "step_axis.c"

#define AXIS 0

double T0;

void Report(char *What)
{
    WaitForAxis(AXIS);
    printf("%-14s %8.1f after %.2f s\n", What, chan[AXIS].Dest, Time_sec() - T0);
}

main()
{
    SetupStepAxis(AXIS, 40000.0f, 200000.0f, 4e6f);

    T0 = Time_sec();
    Move(AXIS, 100000.0);
    Report("Move");

    T0 = Time_sec();
    MoveRel(AXIS, -800.0);
    Report("MoveRel");

    T0 = Time_sec();
    MoveAtVel(AXIS, 89200.0, 10000.0f);
    Report("MoveAtVel");

    T0 = Time_sec();
    MoveRelAtVel(AXIS, -9200.0, 10000.0f);
    Report("MoveRelAtVel");

    T0 = Time_sec();
    Jog(AXIS, -20000.0);
    Delay_sec(0.5);
    printf("jogging: CheckDone is %d\n", CheckDone(AXIS));
    Jog(AXIS, 0.0);
    WaitForAxis(AXIS);
    printf("jogged to about %.0f hundred\n", chan[AXIS].Dest / 100.0);

    DisableAxis(AXIS);
    printf("disabled: CheckDone is %d\n", CheckDone(AXIS));
}
