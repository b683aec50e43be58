// cc67: run
//
// soft_limits.c - limits of travel without switches, and how a program finds out.
//
//   cc67 run c-programs/motion/soft_limits.c
//
// After homing the board itself knows where the axis may go. A jog that crosses a limit
// becomes a feedhold of everything: the axis comes to rest a little beyond the limit, and
// nothing moves until the hold is cleared. A program that takes its targets from a person
// checks them before, as here, because a move that ends somewhere else is found too late.
//
// Expect a refused target, a jog that is held beyond the limit, and the way back free.

#include "KMotionDef.h"
#include "step_axis.c"

#define AXIS 0
#define LOW  (-500.0)
#define HIGH 8000.0

int MoveChecked(double To)
{
    CHAN *ch = &chan[AXIS];

    if (To < ch->SoftLimitNeg || To > ch->SoftLimitPos)
    {
        printf("%.0f is outside %.0f to %.0f\n", To, ch->SoftLimitNeg, ch->SoftLimitPos);
        return FALSE;
    }
    Move(AXIS, To);
    WaitForAxis(AXIS);
    printf("at %.0f\n", ch->Dest);
    return TRUE;
}

main()
{
    double End;

    SetupStepAxis(AXIS, 10000.0f, 100000.0f, 1e6f);
    chan[AXIS].SoftLimitNeg = LOW;
    chan[AXIS].SoftLimitPos = HIGH;

    MoveChecked(9000.0);
    MoveChecked(5000.0);

    Jog(AXIS, 5000.0);
    End = Time_sec() + 2.0;
    while (Time_sec() < End) WaitNextTimeSlice();
    printf("jogged to %.0f, %s\n", chan[AXIS].Dest, CS0_StoppingState ? "held" : "free");

    ClearStopImmediately();
    MoveChecked(0.0);
}
