// cc67: run
//
// bore.c - finding the centre of a bore with four touches.
//
//   cc67 run --machine c-programs/probing/bore.toml c-programs/probing/bore.c
//
// The probe is somewhere in the bore. Along X to the one wall and to the other; their
// middle is the centre in X, from where the same in Y is exact. The ball of the probe
// takes its diameter away from the bore, but not from the centre.
//
// Expect the centre at X 12.00 Y -3.00, a diameter of 43 mm with a ball of 3 mm, and the
// probe there at the end.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define X            0
#define Y            1
#define PROBE        138
#define STEPS_PER_MM 100.0
#define BALL         3.0            // mm
#define SEARCH       1000.0         // steps a second
#define BACK         2000.0f

// Where the wall in this direction is.
double Wall(int Axis, double Speed)
{
    double Where;

    Jog(Axis, Speed);
    while (!ReadBit(PROBE)) WaitNextTimeSlice();
    Where = chan[Axis].Dest;
    Jog(Axis, 0.0);
    WaitForAxis(Axis);
    return Where;
}

void GoTo(int Axis, double Position)
{
    MoveAtVel(Axis, Position, BACK);
    WaitForAxis(Axis);
}

// Goes to the middle of the two walls and returns the way between them.
double Centre(int Axis)
{
    double Start = chan[Axis].Dest, Low, High;

    High = Wall(Axis, SEARCH);
    GoTo(Axis, Start);
    Low = Wall(Axis, -SEARCH);
    GoTo(Axis, 0.5 * (Low + High));
    return High - Low;
}

main()
{
    double Way;

    SetupStepAxis(X, 20000.0f, 200000.0f, 4e6f);
    SetupStepAxis(Y, 20000.0f, 200000.0f, 4e6f);

    Centre(X);
    Way = Centre(Y);
    printf("centre: X %.2f Y %.2f mm\n", chan[X].Dest / STEPS_PER_MM, chan[Y].Dest / STEPS_PER_MM);
    printf("diameter: %.1f mm\n", Way / STEPS_PER_MM + BALL);
}
