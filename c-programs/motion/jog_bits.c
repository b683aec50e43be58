// cc67: run also 2:jog_panel.c
//
// jog_bits.c - jogging an axis while a button is held.
//
//   cc67 run 1:c-programs/motion/jog_bits.c 2:c-programs/motion/jog_panel.c
//
// A jog is commanded only when the requested speed changes, not in every slice. Both
// buttons together, or none, mean stop. Thread 2 plays the operator's panel on
// virtual bits.
//
// Expect slow forward, fast forward, stop, slow backward, stop.

#include "KMotionDef.h"
#include "step_axis.c"
#include "jog_panel.h"

#define AXIS 0
#define SLOW 2000.0         // steps/s
#define FAST 10000.0

double WantedSpeed(void)
{
    int Plus = ReadBit(BUTTON_PLUS);
    int Minus = ReadBit(BUTTON_MINUS);
    double Speed = ReadBit(BUTTON_FAST) ? FAST : SLOW;

    if (Plus == Minus) return 0.0;
    return Plus ? Speed : -Speed;
}

main()
{
    double Speed, Last = 0.0;

    SetupStepAxis(AXIS, 40000.0f, 200000.0f, 4e6f);
    VirtualBitsEx[0] = 0;
    StartThread(2);

    while (!ReadBit(PANEL_END))
    {
        WaitNextTimeSlice();
        Speed = WantedSpeed();
        if (Speed != Last)
        {
            Jog(AXIS, Speed);
            printf("jog %.0f\n", Speed);
            Last = Speed;
        }
    }

    Jog(AXIS, 0.0);
    WaitForAxis(AXIS);
    printf("stopped %s the start\n", chan[AXIS].Dest > 0.0 ? "ahead of" : "behind");
}
