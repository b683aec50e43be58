// cc67: run
//
// path.c - a coordinated path that the program itself puts into the motion buffer.
//
//   cc67 run c-programs/motion/path.c
//
// Usually the PC plans the path. A program can do it too: each segment says how a
// parameter p runs from 0 to 1 with time (a cubic here, so that it starts and ends
// at rest), and where each axis is for a given p. Between the line and the circle
// is a special segment that sets a bit at that very instant.
//
// Expect the bit to rise at X 1000 Y 2000, a circle with a radius of 1000, and the
// end where the circle began.

#include "KMotionDef.h"
#include "step_axis.c"

#define UNUSED  255             // no axis
#define TOOL_ON 1040            // virtual bit that the path sets
#define SET_BIT 1               // what a special segment does

void FirstSegment(void)
{
    CoordSystem0 = NULL;
    ParametricIndex = 0;
    LastCoordSystem0 = &ParametricCoeffs[0];
}

// The next free segment, with nothing in it but the two axes.
PARAMETRIC_COEFF *NewSegment(int Mode)
{
    PARAMETRIC_COEFF *s = &ParametricCoeffs[ParametricIndex++];

    s->trajectory_mode = Mode;
    s->x_axis = 0;
    s->y_axis = 1;
    s->z_axis = s->a_axis = s->b_axis = s->c_axis = s->u_axis = s->v_axis = UNUSED;
    s->special_param = 0;
    s->t = s->a = s->b = s->c = s->d = 0.0;
    return s;
}

// p goes from 0 to 1 in T seconds, at rest at both ends: p = 3(t/T)^2 - 2(t/T)^3.
void SetTime(PARAMETRIC_COEFF *s, double T)
{
    s->t = T;
    s->a = -2.0 / (T * T * T);
    s->b = 3.0 / (T * T);
}

void Line(double X0, double Y0, double X1, double Y1, double T)
{
    PARAMETRIC_COEFF *s = NewSegment(TRAJECTORY_LINEAR);

    SetTime(s, T);
    s->X.c = X1 - X0;
    s->X.d = X0;
    s->Y.c = Y1 - Y0;
    s->Y.d = Y0;
}

// A full circle, clockwise from its highest point. X = c sin(a p + b) + d.
void Circle(double XC, double YC, double Radius, double T)
{
    PARAMETRIC_COEFF *s = NewSegment(TRAJECTORY_CIRCULAR);

    SetTime(s, T);
    s->X.a = s->Y.a = TWO_PI;
    s->X.b = 0.0;
    s->Y.b = 0.5 * PI;
    s->X.c = s->Y.c = Radius;
    s->X.d = XC;
    s->Y.d = YC;
}

void SwitchOn(int Bit)
{
    PARAMETRIC_COEFF *s = NewSegment(TRAJECTORY_SPECIAL);

    s->x_axis = SET_BIT;
    s->special_param = Bit;
}

void Execute(void)
{
    NewSegment(TRAJECTORY_OFF);
    CS0_t = 0.0;
    CS0_TimeExecuted = 0.0;
    CS0_TimeBase = CS0_TimeBaseDesired = TIMEBASE;
    CS0_Flushed = TRUE;                 // this is the whole path
    CoordSystem0 = LastCoordSystem0;
}

main()
{
    double X, Y, Radius, Least = 1e9, Most = 0.0;
    int WasOn = FALSE;

    SetupStepAxis(0, 40000.0f, 400000.0f, 4e6f);
    SetupStepAxis(1, 40000.0f, 400000.0f, 4e6f);
    DefineCoordSystem(0, 1, -1, -1);
    KLP = 0.0;
    ClearBit(TOOL_ON);

    FirstSegment();
    Line(0.0, 0.0, 1000.0, 2000.0, 1.0);
    SwitchOn(TOOL_ON);
    Circle(1000.0, 1000.0, 1000.0, 2.0);
    Execute();

    while (CheckDoneBuf() == 0)
    {
        WaitNextTimeSlice();
        if (!ReadBit(TOOL_ON)) continue;

        X = chan[0].Dest;
        Y = chan[1].Dest;
        if (!WasOn) printf("tool on at X %.0f Y %.0f\n", X, Y);
        WasOn = TRUE;

        Radius = sqrt((X - 1000.0) * (X - 1000.0) + (Y - 1000.0) * (Y - 1000.0));
        if (Radius < Least) Least = Radius;
        if (Radius > Most) Most = Radius;
    }

    printf("radius from %.1f to %.1f\n", Least, Most);
    printf("end: X %.1f Y %.1f, CheckDoneBuf %d\n", chan[0].Dest, chan[1].Dest, CheckDoneBuf());
}
