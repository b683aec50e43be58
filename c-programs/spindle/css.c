// cc67: run
//
// css.c - constant surface speed: the spindle turns faster as the radius shrinks.
//
//   cc67 run c-programs/spindle/css.c
//
// The PC stores the mode, the radius offset and factor, the surface speed and the
// speed limit in persist, as floats. A function that is called in every slice of
// the service loop does the rest. Here the program stores them itself and moves X
// from a radius of 2 inches to 0.1.
//
// Expect about 150 rpm at 2 inches, ten times that at 0.2, and the limit of 2000 rpm
// at the end. A new speed is commanded only while the spindle is on.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define X               0
#define SPINDLE         6
#define COUNTS_PER_INCH 10000.0
#define COUNTS_PER_TURN 1000.0
#define STATE           98              // persist: -1 ccw, 0 off, 1 cw
#define MODE_NORMAL     1
#define MODE_CSS        2
#define UPDATE          0.05            // seconds

float *XOffset = (float *)&persist.UserData[PC_COMM_CSS_X_OFFSET];
float *XFactor = (float *)&persist.UserData[PC_COMM_CSS_X_FACTOR];
float *Surface = (float *)&persist.UserData[PC_COMM_CSS_S];
float *MaxRpm  = (float *)&persist.UserData[PC_COMM_CSS_MAX_RPM];

double NextUpdate;
double Rpm;

double RpmAtRadius(double Radius)
{
    double TurnLength = TWO_PI * Radius;        // inches

    if (TurnLength * *MaxRpm <= *Surface * 60.0) return *MaxRpm;
    return *Surface * 60.0 / TurnLength;
}

void ServiceSurfaceSpeed(double Now)
{
    if (persist.UserData[PC_COMM_CSS_MODE] != MODE_CSS || Now < NextUpdate) return;
    NextUpdate = Now + UPDATE;

    Rpm = RpmAtRadius(fast_fabs((chan[X].Dest - *XOffset) * *XFactor));
    if (persist.UserData[STATE] != 0)
    {
        Jog(SPINDLE, Rpm / 60.0 * COUNTS_PER_TURN * persist.UserData[STATE]);
    }
}

void MoveAndServe(double Inches)
{
    double End;

    Move(X, Inches * COUNTS_PER_INCH);
    while (!CheckDone(X)) ServiceSurfaceSpeed(WaitNextTimeSlice());

    End = Time_sec() + 2 * UPDATE;          // one update at rest
    while (Time_sec() < End) ServiceSurfaceSpeed(WaitNextTimeSlice());
    printf("radius %.1f: %.0f rpm\n", Inches, Rpm);
}

main()
{
    SetupStepAxis(X, 20000.0f, 200000.0f, 4e6f);
    SetupStepAxis(SPINDLE, 100000.0f, 100000.0f, 4e6f);

    *XOffset = 0.0f;
    *XFactor = 1.0 / COUNTS_PER_INCH;
    *Surface = 31.416f;                     // inches/s
    *MaxRpm = 2000.0f;
    persist.UserData[STATE] = 1;
    persist.UserData[PC_COMM_CSS_MODE] = MODE_CSS;
    NextUpdate = 0.0;

    MoveAndServe(2.0);
    MoveAndServe(1.0);
    MoveAndServe(0.2);
    MoveAndServe(0.1);

    persist.UserData[PC_COMM_CSS_MODE] = MODE_NORMAL;
    persist.UserData[STATE] = 0;
    Jog(SPINDLE, 0.0);
    WaitForAxis(SPINDLE);
    printf("spindle stopped\n");
}
