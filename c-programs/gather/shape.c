// cc67: run
//
// shape.c - recording a move in every servo tick and checking its shape.
//
//   cc67 run c-programs/gather/shape.c
//
// The gather facility copies a list of variables into a large buffer, once a tick.
// From the positions follow speed, acceleration and jerk as differences from sample
// to sample; none may exceed the limits of the axis.
//
// Expect 800 steps covered, too few to reach full speed, and all three limits kept.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define AXIS    0
#define SAMPLES 3000            // 0.27 s
#define VEL     40000.0
#define ACCEL   200000.0
#define JERK    4e6

void RecordDest(int Samples)
{
    gather.Inject = FALSE;
    gather.list[0].type = GATHER_DOUBLE_TYPE;
    gather.list[0].addr = &chan[AXIS].Dest;
    gather.list[1].type = GATHER_END_TYPE;

    gather.bufptr = (double *)0xfffffffc;       // beyond the end: idle
    gather.endptr = gather_buffer + Samples;
    TriggerGather();
}

// Difference of order n at sample i, per second to the power of n.
double Difference(double *x, int i, int n)
{
    if (n == 0) return x[i];
    return (Difference(x, i, n - 1) - Difference(x, i - 1, n - 1)) / TIMEBASE;
}

double Largest(double *x, int n)
{
    int i;
    double d, Max = 0.0;

    for (i = n; i < SAMPLES; i++)
    {
        d = fast_fabs(Difference(x, i, n));
        if (d > Max) Max = d;
    }
    return Max;
}

void Check(char *What, double Is, double Limit)
{
    printf("%-13s %s\n", What, Is <= Limit ? "within its limit" : "BEYOND ITS LIMIT");
}

main()
{
    SetupStepAxis(AXIS, VEL, ACCEL, JERK);

    RecordDest(SAMPLES);
    Move(AXIS, 800.0);
    while (!CheckDoneGather()) WaitNextTimeSlice();

    printf("from %.1f to %.1f\n", gather_buffer[0], gather_buffer[SAMPLES - 1]);
    printf("highest speed: %.0f hundred steps/s\n", Largest(gather_buffer, 1) / 100.0);
    Check("speed:", Largest(gather_buffer, 1), VEL * 1.001);
    Check("acceleration:", Largest(gather_buffer, 2), ACCEL * 1.001);
    Check("jerk:", Largest(gather_buffer, 3), JERK * 1.01);
}
