// cc67: run
//
// tap.c - rigid tapping: Z follows the turning of the spindle.
//
//   cc67 run c-programs/spindle/tap.c
//
// The thread is cut in several bites, each followed by a short way back to break the
// chip. While the spindle turns, Z is sent in every slice to the depth that belongs
// to its angle; MoveExp smooths the steps between the slices.
//
// Expect the bites to reach 0.10, 0.16, 0.22, 0.28 and 0.30 inches, and Z back at its start.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define Z               2
#define SPINDLE         6
#define Z_PER_INCH      -20000.0        // counts; down is negative
#define COUNTS_PER_TURN 4000.0
#define TAU             0.001           // seconds

#define PITCH   20.0                    // turns per inch
#define DEPTH   0.3                     // inches, all numbers below too
#define FORWARD 0.1                     // a bite
#define BACK    0.04                    // the way back after it
#define CUT     0.5                     // inches/s
#define RETRACT 1.0

double ZStart, SpindleStart;

double ZForSpindle(void)
{
    double Turns = (chan[SPINDLE].Dest - SpindleStart) / COUNTS_PER_TURN;

    return ZStart + Turns / PITCH * Z_PER_INCH;
}

// Turns the spindle by a number of inches of thread, with Z in its grip.
void Thread(double Inches, double Speed)
{
    double Counts = PITCH * COUNTS_PER_TURN;    // per inch

    MoveRelAtVel(SPINDLE, Inches * Counts, Speed * Counts);
    while (!CheckDone(SPINDLE))
    {
        MoveExp(Z, ZForSpindle(), TAU);
        WaitNextTimeSlice();
    }
}

double ZDepth(void)
{
    return (chan[Z].Dest - ZStart) / Z_PER_INCH;
}

void Tap(void)
{
    double Done = 0.0;
    double Bite;

    while (Done < DEPTH)
    {
        Bite = FORWARD;
        if (Done + Bite > DEPTH - 0.0001) Bite = DEPTH - Done;

        Thread(Bite, CUT);
        printf("bite to %.2f\n", ZDepth());
        Done += Bite;
        if (Done > DEPTH - 0.0001) break;

        Thread(-BACK, RETRACT);
        Done -= BACK;
    }
    Thread(-Done, RETRACT);
}

main()
{
    SetupStepAxis(SPINDLE, 100000.0f, 1e6f, 2e7f);
    SetupStepAxis(Z, 40000.0f, 1e6f, 2e7f);

    ZStart = chan[Z].Dest;
    SpindleStart = chan[SPINDLE].Dest;
    Tap();

    Move(Z, ZStart);                    // ends the last approach exactly
    WaitForAxis(Z);
    printf("tapped, Z back at %.3f\n", chan[Z].Dest);
}
