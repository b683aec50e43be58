// cc67: run
//
// home.c - homing to a switch of the machine.
//
//   cc67 run --machine c-programs/machine/home.toml c-programs/machine/home.c
//
// The machine file beside this program puts a home switch at -3000 steps, and a hard
// stop beyond it. The axis runs to the switch, backs off slowly until it opens, takes
// that place as zero and moves clear.
//
// Expect the switch a little beyond -3000, because the axis needs some distance to stop, then
// at -3000, and 500 at the end.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define AXIS        0
#define HOME_SWITCH 136

double JogUntil(double Speed, int Level)
{
    Jog(AXIS, Speed);
    while (ReadBit(HOME_SWITCH) != Level) WaitNextTimeSlice();
    Jog(AXIS, 0.0);
    WaitForAxis(AXIS);
    return chan[AXIS].Dest;
}

main()
{
    SetupStepAxis(AXIS, 20000.0f, 200000.0f, 4e6f);

    printf("found at %.0f\n", JogUntil(-5000.0, 1));
    printf("left at  %.0f\n", JogUntil(200.0, 0));
    Zero(AXIS);
    Move(AXIS, 500.0);
    WaitForAxis(AXIS);
    printf("clear at %.0f, switch %s\n", chan[AXIS].Dest, ReadBit(HOME_SWITCH) ? "closed" : "open");
}
