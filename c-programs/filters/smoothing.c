// cc67: run
//
// smoothing.c - the low-pass filter after the coordinated path.
//
//   cc67 run c-programs/filters/smoothing.c
//
// KLP = exp(-TIMEBASE/Tau) smooths the path of all axes of the coordinate system; 0
// switches it off. The price is a lag of speed times Tau. The path here starts and
// stops at full speed, as no real path should, to show what the filter does.
//
// Expect no lag without the filter, and with it a lag that agrees with the formula
// and a first step that is smaller than the path's own.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define SPEED   10000.0         // steps/s
#define TIME    0.2             // seconds
#define SAMPLES 2000
#define ITEMS   2

void LoadLine(double From, double To)
{
    PARAMETRIC_COEFF *s = &ParametricCoeffs[0];

    CoordSystem0 = NULL;
    s->trajectory_mode = TRAJECTORY_LINEAR;
    s->x_axis = 0;
    s->y_axis = 1;
    s->z_axis = s->a_axis = s->b_axis = s->c_axis = s->u_axis = s->v_axis = 255;
    s->t = TIME;
    s->a = s->b = s->d = 0.0;
    s->c = 1.0 / TIME;                  // p from 0 to 1 at constant speed
    s->X.c = To - From;
    s->X.d = From;
    s->Y.c = 0.0;
    s->Y.d = 0.0;
    s[1].trajectory_mode = TRAJECTORY_OFF;
}

void RunLine(void)
{
    CS0_t = 0.0;
    CS0_TimeExecuted = 0.0;
    CS0_TimeBase = CS0_TimeBaseDesired = TIMEBASE;
    CS0_Flushed = TRUE;
    LastCoordSystem0 = &ParametricCoeffs[0];
    CoordSystem0 = LastCoordSystem0;
}

void Record(void)
{
    gather.Inject = FALSE;
    gather.list[0].type = GATHER_DOUBLE_TYPE;
    gather.list[0].addr = &ch0->UnfilteredDest;
    gather.list[1].type = GATHER_DOUBLE_TYPE;
    gather.list[1].addr = &ch0->Dest;
    gather.list[2].type = GATHER_END_TYPE;
    gather.bufptr = (double *)0xfffffffc;
    gather.endptr = gather_buffer + ITEMS * SAMPLES;
    TriggerGather();
}

double MiddleLag(void)
{
    double *Sample = gather_buffer + ITEMS * (SAMPLES / 2);

    return Sample[0] - Sample[1];
}

double FirstStep(void)
{
    int i;
    double Step;

    for (i = 1; i < SAMPLES; i++)
    {
        Step = gather_buffer[ITEMS * i + 1] - gather_buffer[ITEMS * (i - 1) + 1];
        if (Step != 0.0) return Step;
    }
    return 0.0;
}

void Try(char *What, double Tau)
{
    EnableAxisDest(0, 0.0);
    EnableAxisDest(1, 0.0);
    KLP = Tau > 0.0 ? exp(-TIMEBASE / Tau) : 0.0;
    TauKLP = Tau;               // the path ends in a spline that takes a multiple of it

    LoadLine(0.0, SPEED * TIME);
    Record();
    RunLine();
    while (!CheckDoneGather() || !CheckDoneBuf()) WaitNextTimeSlice();

    printf("%-10s KLP %.6f, lag %.2f by formula %.2f, first step %s\n", What, KLP, MiddleLag(),
           SPEED * TIMEBASE * KLP / (1.0 - KLP), FirstStep() < 0.5 ? "soft" : "hard");
}

main()
{
    SetupStepAxis(0, 40000.0f, 400000.0f, 4e6f);
    SetupStepAxis(1, 40000.0f, 400000.0f, 4e6f);
    DefineCoordSystem(0, 1, -1, -1);

    Try("off:", 0.0);
    Try("Tau 1 ms:", 0.001);
    Try("Tau 5 ms:", 0.005);

    KLP = 0.0;
}
