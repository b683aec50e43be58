// cc67: run
//
// pendant.c - a hand wheel with a selector for the axis and one for the step.
//
//   cc67 run --stim c-programs/mpg/pendant.stim c-programs/mpg/pendant.c
//
// The wheel gives four counts a click. What it turns goes to the axis that is selected,
// times the factor. With the selector off the wheel does nothing, and what it has turned
// meanwhile is forgotten: an axis must not jump when it is selected.
//
// A wheel that is turned faster than the axis can follow would make it run on for a long
// time after the hand has stopped; so no more than LEAD counts are owed at any time.
//
// MoveExp may be called in every slice. A Move that is called while the axis moves is
// planned for 1.8 ms first, at the speed that the axis has: it would hardly get on.
//
// The file beside this program is the operator. Expect X at 100 and Z at -1000.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define WHEEL     3
#define PER_CLICK 4.0
#define SELECTORS 136               // X, Y, Z: one bit each
#define TIMES10   140
#define TIMES100  141
#define AXES      3
#define LEAD      2000.0            // steps
#define TAU       0.02              // seconds for 63 percent of the way

// The selected axis, or -1.
int Selected(void)
{
    int i;

    for (i = 0; i < AXES; i++)
    {
        if (ReadBit(SELECTORS + i)) return i;
    }
    return -1;
}

double Factor(void)
{
    if (ReadBit(TIMES100)) return 100.0;
    return ReadBit(TIMES10) ? 10.0 : 1.0;
}

double Limited(double Value, double Low, double High)
{
    if (Value < Low) return Low;
    return Value > High ? High : Value;
}

main()
{
    int i, Axis, Before = -1;
    double Now, Last, Turned, Target = 0.0, Report = 1.0;

    for (i = 0; i < AXES; i++) SetupStepAxis(i, 20000.0f, 200000.0f, 4e6f);
    chan[WHEEL].InputMode = ENCODER_MODE;
    Last = chan[WHEEL].Position;

    while (Report < 3.5)
    {
        Now = WaitNextTimeSlice();
        Turned = chan[WHEEL].Position - Last;
        Last += Turned;

        Axis = Selected();
        if (Axis >= 0 && Axis != Before) Target = chan[Axis].Dest;
        Before = Axis;
        if (Axis >= 0 && Turned != 0.0)
        {
            Target += Turned / PER_CLICK * Factor();
            Target = Limited(Target, chan[Axis].Dest - LEAD, chan[Axis].Dest + LEAD);
            MoveExp(Axis, Target, TAU);
        }
        if (Now >= Report)
        {
            printf("%.0f s: X %.0f Y %.0f Z %.0f\n", Report, chan[0].Dest, chan[1].Dest, chan[2].Dest);
            Report += 1.0;
        }
    }
    for (i = 0; i < AXES; i++) DisableAxis(i);
}
