// cc67: run --for 2
//
// idle_off.c - a service loop that switches the amplifiers off when nothing moves.
//
//   cc67 run c-programs/motion/idle_off.c --for 2
//
// Such a loop runs forever, usually at the end of the start-up program. Here a
// move is made first, so that there is something to see.
//
// Expect the amplifiers on at the first step and off again half a second after the
// last one; --for ends the run.

#include "KMotionDef.h"
#include "step_axis.c"

#define AXES          3
#define AMPLIFIER_BIT 45
#define IDLE_TIME     0.5       // seconds; a real machine takes minutes

double LastDest[AXES];
double LastMotion;

int Moving(void)
{
    int i, Any = FALSE;

    for (i = 0; i < AXES; i++)
    {
        if (chan[i].Dest != LastDest[i])
        {
            LastDest[i] = chan[i].Dest;
            Any = TRUE;
        }
    }
    return Any;
}

void SwitchAmplifiers(int On)
{
    if (ReadBit(AMPLIFIER_BIT) == On) return;
    SetStateBit(AMPLIFIER_BIT, On);
    printf("amplifiers %s\n", On ? "on" : "off");
}

void ServiceAmplifiers(double Now)
{
    if (Moving())
    {
        LastMotion = Now;
        SwitchAmplifiers(TRUE);
    }
    else if (Now > LastMotion + IDLE_TIME)
    {
        SwitchAmplifiers(FALSE);
    }
}

main()
{
    int i;

    SetBitDirection(AMPLIFIER_BIT, 1);
    for (i = 0; i < AXES; i++)
    {
        SetupStepAxis(i, 10000.0f, 100000.0f, 1e6f);
        LastDest[i] = chan[i].Dest;
    }

    Move(1, 5000.0);
    for (;;)
    {
        ServiceAmplifiers(WaitNextTimeSlice());
    }
}
