// cc67: run
//
// approach.c - an exponential approach with MoveExp.
//
//   cc67 run c-programs/motion/approach.c
//
// Within one time constant the axis covers 63 % of the remaining way; it never
// quite arrives, and CheckDone stays 0 forever. MoveExp may be called again in
// every slice, which suits handwheels and axes that follow another one. A Move to
// the same place finishes the job.
//
// Expect the remaining way to shrink to about 37 % from line to line, then the
// exact position.

#include "KMotionDef.h"
#include "step_axis.c"

#define AXIS   0
#define TARGET 10000.0
#define TAU    0.1          // seconds

main()
{
    int i;
    double Rest, Last = 0.0;

    SetupStepAxis(AXIS, 1e6f, 1e7f, 1e9f);      // the limits shall not matter here

    MoveExp(AXIS, TARGET, TAU);
    Delay_sec(TAU);
    for (i = 0; i < 5; i++)
    {
        Rest = TARGET - chan[AXIS].Dest;
        if (i > 0) printf("remaining: %.0f %% of before\n", 100.0 * Rest / Last);
        Last = Rest;
        Delay_sec(TAU);
    }
    printf("MoveExp: CheckDone is %d\n", CheckDone(AXIS));

    Move(AXIS, TARGET);
    WaitForAxis(AXIS);
    printf("Move:    CheckDone is %d at %.3f\n", CheckDone(AXIS), chan[AXIS].Dest);
}
