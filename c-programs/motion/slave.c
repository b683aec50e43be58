// cc67: run
//
// slave.c - one axis that copies the motion of another one.
//
//   cc67 run c-programs/motion/slave.c
//
// A gantry has a motor on each side; the second one is slaved to the first. The
// slave takes every change of its master's destination times SlaveGain.
//
// Expect the slave at twice the way in the opposite direction at any time, and
// standing still once it has been released.

#include "KMotionDef.h"
#include "step_axis.c"

#define MASTER 0
#define SLAVE  1
#define GAIN   -2.0

main()
{
    double Error, Worst = 0.0;

    SetupStepAxis(MASTER, 10000.0f, 100000.0f, 1e6f);
    SetupStepAxis(SLAVE, 10000.0f, 100000.0f, 1e6f);
    chan[SLAVE].SlaveGain = GAIN;
    chan[SLAVE].MasterAxis = MASTER;

    Move(MASTER, 3000.0);
    while (!CheckDone(MASTER))
    {
        WaitNextTimeSlice();
        Error = fast_fabs(chan[SLAVE].Dest - GAIN * chan[MASTER].Dest);
        if (Error > Worst) Worst = Error;
    }
    printf("master %.0f, slave %.0f, %s\n", chan[MASTER].Dest, chan[SLAVE].Dest,
           Worst < 0.001 ? "together all the way" : "not together");

    chan[SLAVE].MasterAxis = -1;
    Move(MASTER, 0.0);
    WaitForAxis(MASTER);
    printf("released: master %.0f, slave %.0f\n", chan[MASTER].Dest, chan[SLAVE].Dest);
}
